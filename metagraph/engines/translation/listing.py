"""What is translated, and where to."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

RUNTIMES = Path(__file__).parents[1] / "runtimes"


@dataclass(frozen=True)
class Translated:
    """A Python module. word: of the file it becomes, in the style of the language. only: the parts that
    are translated, all where empty: the others stay native.
    """

    module: str
    word: str
    only: tuple[str, ...] = ()


LISTING = (
    Translated("metagraph.graph.model", "model", ("Markov", "Settings")),
    Translated("metagraph.playback.choice", "choice"),
    Translated(
        "metagraph.playback.plan",
        "meta_plan",
        ("ASKED", "WRITTEN", "MetaRequest", "Cursor", "MetaAction", "Report"),
    ),
    Translated(
        "metagraph.playback.markov", "markov", ("write", "_row", "performs", "length", "KINDS", "BEGIN")
    ),
    Translated("metagraph.playback.replan", "replan"),
)

# Modules that each runtime has of its own, with what translated ones take from them.
NATIVE = {
    "metagraph.playback.hashing": "hashing",  # integers of 32 bits, which languages have differently
    "metagraph.graph.words": "words",  # the words layers, kinds and modes are told apart by
}
