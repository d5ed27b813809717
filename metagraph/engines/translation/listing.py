"""What is translated, and where to."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

RUNTIMES = Path(__file__).parents[1] / "runtimes"


@dataclass(frozen=True)
class Translated:
    """A Python module. word: of the file it becomes, in the style of the language. only: the parts that
    are translated, all where empty: the others stay native. more: parts that are translated to C++ alone,
    which has nothing of its own yet. without: methods that stay native ("Cue.last").
    """

    module: str
    word: str
    only: tuple[str, ...] = ()
    more: tuple[str, ...] = ()
    without: tuple[str, ...] = ()


LISTING = (
    Translated("metagraph.graph.model", "model", ("Timing", "Stance", "Markov", "Settings"), ("Action",)),
    Translated(
        "metagraph.graph.repeating",
        "repeating",
        ("LEAST_CYCLE", "MOST_TIMES", "LONGEST_REPEAT", "cycle_of", "times_played", "seconds_played"),
    ),
    Translated("metagraph.motion.plain_vectors", "plain_vectors"),
    Translated("metagraph.motion.contact_spans", "contact_spans"),
    Translated("metagraph.motion.contact_solve", "contact_solve"),
    Translated("metagraph.playback.posing.cue_times", "cue_times"),
    Translated("metagraph.playback.posing.contact_goals", "contact_goals"),
    Translated("metagraph.motion.weight_solve", "weight_solve"),
    Translated("metagraph.playback.posing.follow_through", "follow_through"),
    Translated("metagraph.motion.feet_solve", "feet_solve"),
    Translated("metagraph.playback.posing.planted_feet", "planted_feet"),
    Translated("metagraph.playback.planning.choice", "choice"),
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
            "Cue.once",
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
        "metagraph.playback.planning.markov",
        "markov",
        ("write", "_row", "performs", "length", "rest_length", "KINDS", "LISTENS", "BEGIN", "RESTS"),
    ),
    Translated("metagraph.playback.planning.mood", "mood"),
    Translated("metagraph.playback.planning.director", "director"),
    Translated("metagraph.playback.planning.replan", "replan"),
    Translated("metagraph.playback.timing.phase_times", "phase_times"),
    Translated("metagraph.playback.planning.bounds", "bounds"),
    Translated("metagraph.playback.planning.remembering", "remembering"),
    Translated("metagraph.playback.planning.cue_shapes", "cue_shapes"),
    Translated("metagraph.playback.planning.layer_state", "layer_state"),
    Translated("metagraph.playback.planning.routes", "routes"),
    Translated("metagraph.playback.planning.manner", "manner"),
    Translated("metagraph.playback.planning.directing", "directing"),
    Translated("metagraph.playback.planning.drawing", "drawing"),
    Translated("metagraph.playback.planning.punctuality", "punctuality"),
    Translated("metagraph.playback.planning.leaving", "leaving"),
    Translated("metagraph.playback.planning.steps", "steps"),
    Translated("metagraph.playback.planning.sampling", "sampling"),
    Translated("metagraph.playback.planning.layer_planning", "layer_planning"),
    Translated("metagraph.playback.life.mouth", "mouth"),
    Translated("metagraph.playback.life.graphemes", "graphemes"),
    Translated("metagraph.playback.life.line_timing", "line_timing"),
    Translated("metagraph.playback.life.streamed_voice", "streamed_voice"),
    Translated("metagraph.playback.life.lane", "lane", ("Lane",), without=("Lane.starts", "Lane.values")),
    Translated("metagraph.playback.life.items", "items"),
    Translated(
        "metagraph.playback.life.track", "track", ("HUSHED", "Track"), without=("Track.items", "Track.plus")
    ),
    Translated("metagraph.playback.life.utterances", "utterances"),
    Translated("metagraph.playback.life.speech_watch", "speech_watch"),
    Translated("metagraph.playback.life.wanted", "wanted"),
    Translated("metagraph.playback.life.expressions", "expressions"),
    Translated("metagraph.playback.life.sympathy", "sympathy"),
    Translated("metagraph.playback.life.schedule", "schedule"),
    Translated("metagraph.playback.planning.hearing", "hearing"),
    Translated("metagraph.playback.planning.finding", "finding"),
    Translated("metagraph.playback.planning.meaning", "meaning"),
    Translated("metagraph.speech.word_gestures", "word_gestures"),
    Translated("metagraph.speech.spoken_so_far", "spoken_so_far"),
    Translated("metagraph.engines.single_rules", "single_rules"),
)

# Modules that each runtime has of its own, with what translated ones take from them.
NATIVE = {
    "metagraph.playback.timing.phases": "phases",  # found from motion; exports tell them
    "metagraph.playback.planning.vigour": "vigour",  # as are phases
    "metagraph.playback.planning.prominence": "prominence",  # as are phases
    "metagraph.playback.planning.hashing": "hashing",  # integers of 32 bits, which languages have differently
    "metagraph.graph.words": "words",  # the words layers, kinds and modes are distinguished by
    "metagraph.graph.face.names": "words",  # and mouth shapes
    "metagraph.graph.life": "life",  # the life layers' settings
    "metagraph.playback.life.spots": "spots",  # names or points
    "metagraph.playback.life.voice": "voice",  # how lines sound
    "metagraph.playback.life.alphabet": "alphabet",  # what Unicode says of letters
}
