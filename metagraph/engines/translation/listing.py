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
    Translated("metagraph.graph.model", "model", ("Timing", "Stance", "Markov", "Settings"), ("Action",)),
    Translated("metagraph.playback.choice", "choice"),
    Translated(
        "metagraph.playback.plan",
        "meta_plan",
        (
            "ASKED",
            "WRITTEN",
            "TEMPORAL",
            "MetaRequest",
            "Cursor",
            "MetaAction",
            "Cue",
            "Rest",
            "Report",
            "Past",
            "LayerPlan",
        ),
        without=(
            "Cue.clip_seconds",
            "Cue.last",
            "LayerPlan.starts",
            "LayerPlan.ends",
            "LayerPlan.full_from",
            "LayerPlan.full_to",
            "LayerPlan.fade_starts",
            "LayerPlan.fade_ends",
            "LayerPlan.cue_at",
            "LayerPlan.stance_at",
        ),
    ),
    Translated(
        "metagraph.playback.markov", "markov", ("write", "_row", "performs", "length", "KINDS", "BEGIN")
    ),
    Translated("metagraph.playback.replan", "replan"),
    Translated("metagraph.playback.phase_times", "phase_times"),
    Translated("metagraph.playback.bounds", "bounds"),
    Translated("metagraph.playback.remembering", "remembering"),
    Translated("metagraph.playback.sampling", "sampling"),
    Translated("metagraph.playback.layer_planning", "layer_planning"),
    Translated("metagraph.playback.life.mouth", "mouth"),
    Translated("metagraph.playback.life.graphemes", "graphemes"),
    Translated("metagraph.playback.life.line_timing", "line_timing"),
)

# Modules that each runtime has of its own, with what translated ones take from them.
NATIVE = {
    "metagraph.playback.phases": "phases",  # found from motion; exports tell them
    "metagraph.playback.hashing": "hashing",  # integers of 32 bits, which languages have differently
    "metagraph.graph.words": "words",  # the words layers, kinds and modes are told apart by
    "metagraph.graph.face_names": "words",  # and mouth shapes
    "metagraph.playback.life.alphabet": "alphabet",  # what Unicode says of letters
}
