"""The domain's words as the window shows them: kinds, layers, limbs, parts, phases and moods are keys of the
project, English in every language, and are looked up where they are shown.
"""

from __future__ import annotations

from app.translation import tr, tr_noop

KINDS = (tr_noop("stance"), tr_noop("gesture"), tr_noop("fidget"), tr_noop("transition"))
TITLES = (tr_noop("Stance"), tr_noop("Gesture"), tr_noop("Fidget"), tr_noop("Transition"))
LAYERS = (tr_noop("body"), tr_noop("arms"), tr_noop("head"))
LAYER_TITLES = (tr_noop("Body"), tr_noop("Arms"), tr_noop("Head"))
LIMBS = (tr_noop("left"), tr_noop("right"), tr_noop("both"))
LIMB_TITLES = (tr_noop("Left"), tr_noop("Right"), tr_noop("Both"))
PARTS = (tr_noop("legs"), tr_noop("spine"), tr_noop("face"))
PART_TITLES = (tr_noop("Legs"), tr_noop("Spine"), tr_noop("Face"))
PHASES = (tr_noop("preparation"), tr_noop("stroke"), tr_noop("hold"), tr_noop("retraction"))
HANDLES = (
    *(tr_noop("start"), tr_noop("end"), tr_noop("exit"), tr_noop("blend in"), tr_noop("blend out")),
    *(tr_noop("ready"), tr_noop("relax")),
)
KEPT_TO = (tr_noop("base pose"), tr_noop("likelihood"), tr_noop("mask"))
MOODS = (
    *(tr_noop("neutral"), tr_noop("calm"), tr_noop("content"), tr_noop("warm"), tr_noop("happy")),
    *(tr_noop("excited"), tr_noop("tense"), tr_noop("angry"), tr_noop("afraid"), tr_noop("sad")),
    *(tr_noop("bored"), tr_noop("tired")),
)
MOOD_TITLES = (
    *(tr_noop("Neutral"), tr_noop("Calm"), tr_noop("Content"), tr_noop("Warm"), tr_noop("Happy")),
    *(tr_noop("Excited"), tr_noop("Tense"), tr_noop("Angry"), tr_noop("Afraid"), tr_noop("Sad")),
    *(tr_noop("Bored"), tr_noop("Tired")),
)
JOINS = (tr_noop("to"), tr_noop("from"))
OTHERS = (tr_noop("Likelihood"), tr_noop("Mask"), tr_noop("Stroke"), tr_noop("User"))


def get_vocabulary_word(key: str) -> str:
    """Return how a key is called within a sentence; what is none stays as it is."""
    return tr(key)


def get_vocabulary_title(key: str) -> str:
    """Return how a key is called where it stands alone."""
    return tr(key.capitalize())
