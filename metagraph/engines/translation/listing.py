"""What is translated, and where to."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

RUNTIMES = Path(__file__).parents[1] / "runtimes"


@dataclass(frozen=True)
class Translated:
    """A Python module. word: of the file it becomes, in the style of the language. only: the parts that
    are translated, all where empty: the others stay native. more: parts that are translated to C++ alone,
    which has nothing of its own yet. without: methods that stay native ("Cue.last"). languages: which it is
    translated to, all where empty.
    """

    module: str
    word: str
    only: tuple[str, ...] = ()
    more: tuple[str, ...] = ()
    without: tuple[str, ...] = ()
    languages: tuple[str, ...] = ()


LISTING = (
    Translated("metagraph.graph.model", "model", ("Markov", "Settings"), ("Timing", "Action", "Stance")),
    Translated("metagraph.playback.choice", "choice"),
    Translated(
        "metagraph.playback.plan",
        "meta_plan",
        ("ASKED", "WRITTEN", "MetaRequest", "Cursor", "MetaAction", "Report"),
        ("Cue", "Rest", "Past"),
        ("Cue.clip_seconds", "Cue.last"),
    ),
    Translated(
        "metagraph.playback.markov", "markov", ("write", "_row", "performs", "length", "KINDS", "BEGIN")
    ),
    Translated("metagraph.playback.replan", "replan"),
    Translated("metagraph.playback.phases", "phases", ("LEAST_BLEND", "Phases"), languages=("cpp",)),
    Translated("metagraph.playback.sampling", "sampling", languages=("cpp",)),
    Translated("metagraph.playback.life.mouth", "mouth"),
    Translated("metagraph.playback.life.graphemes", "graphemes"),
    Translated("metagraph.playback.life.line_timing", "line_timing"),
)

# Modules that each runtime has of its own, with what translated ones take from them.
NATIVE = {
    "metagraph.playback.hashing": "hashing",  # integers of 32 bits, which languages have differently
    "metagraph.graph.words": "words",  # the words layers, kinds and modes are told apart by
    "metagraph.graph.face_names": "words",  # and mouth shapes
    "metagraph.playback.life.alphabet": "alphabet",  # what Unicode says of letters
}
