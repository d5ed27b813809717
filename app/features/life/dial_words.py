"""The dials of life in the window's language: what `graph.life` says of them, marked for translation."""

from __future__ import annotations

from app.translation import tr, tr_noop
from metagraph.graph.life import Dial

GROUPS = (
    tr_noop("Mood"),
    tr_noop("Breathing"),
    tr_noop("Gaze"),
    tr_noop("Eyes"),
    tr_noop("Blinks"),
    tr_noop("Lips"),
    tr_noop("Weight"),
    tr_noop("Face"),
)
LABELS = (
    tr_noop("Stillness"),
    tr_noop("Valence"),
    tr_noop("Arousal"),
    tr_noop("Intensity"),
    tr_noop("Depth"),
    tr_noop("Breaths"),
    tr_noop("Look-at"),
    tr_noop("Head share"),
    tr_noop("Looks away"),
    tr_noop("Time away"),
    tr_noop("Angle away"),
    tr_noop("Eye darts"),
    tr_noop("Darts"),
    tr_noop("Lids follow"),
    tr_noop("Blinks"),
    tr_noop("On stressed words"),
    tr_noop("Closing"),
    tr_noop("Opening"),
    tr_noop("Lip sync"),
    tr_noop("Smoothing"),
    tr_noop("Follow-through"),
    tr_noop("Shoulders"),
    tr_noop("Planted feet"),
    tr_noop("Expressions"),
    tr_noop("Brows on stress"),
)
UNITS = (tr_noop("/ min"),)
TIPS = (
    tr_noop("Calms everything at once; at 1, only the lips and requested actions move."),
    tr_noop("Valence: from unpleasant to pleasant; 0 plays the clips as they are."),
    tr_noop("Arousal: from tired to excited; 0 plays the clips as they are."),
    tr_noop("How large gestures play; 1 is as in the clips."),
    tr_noop("How far chest and shoulders rise."),
    tr_noop("People at rest: 12 to 20."),
    tr_noop("How far the eyes and head turn towards the gaze target."),
    tr_noop("How much of a wide turn the head makes; the eyes do the rest."),
    tr_noop("How often the gaze leaves the conversation partner for a moment."),
    tr_noop("How long the gaze stays away."),
    tr_noop("How far from the partner's face the gaze goes."),
    tr_noop("Size of the small jumps that the eyes make while they look."),
    tr_noop("How often the eyes jump."),
    tr_noop("How far the eyelids follow the eyes down and up."),
    tr_noop("Spontaneous blinks; people at rest: 17."),
    tr_noop("Which share of the stressed syllables triggers a blink."),
    tr_noop("How long the lids take to close."),
    tr_noop("How long the lids take to open again."),
    tr_noop("How far the mouth opens and changes shape in speech."),
    tr_noop("Higher values give softer lip motion; too much looks like mumbling."),
    tr_noop("How far hips, spine and legs react to the weight of the arms. The feet stay where they are."),
    tr_noop("How far the collarbones rise with raised arms, if the clip does not move them."),
    tr_noop(
        "How firmly planted feet stay in place during blends. They step if the poses need them elsewhere."
    ),
    tr_noop("How much the brows and the smile move; at 0, the face of a mood stays still."),
    tr_noop("Which share of the stressed syllables raises the brows."),
    tr_noop("Breathing depth in this mode."),
    tr_noop("Breaths per minute in this mode."),
    tr_noop("How often the gaze leaves the conversation partner in this mode."),
    tr_noop("How long the gaze stays away in this mode."),
    tr_noop("How far from the partner's face the gaze goes in this mode."),
    tr_noop("Size of the small eye jumps in this mode."),
    tr_noop("How often the eyes jump in this mode."),
    tr_noop("Blinks per minute in this mode."),
)


def put_in_sentence(dial: Dial) -> str:
    """Return a dial's label inside a sentence: small in English; other languages keep it as it is."""
    label = tr(dial.label)
    return label.lower() if label == dial.label else label
