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
    tr_noop("Head's share"),
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
    tr_noop("Calms everything at once; at 1 only lips and what is asked for move."),
    tr_noop("From unpleasant to pleasant; 0 as made."),
    tr_noop("From tired to excited; 0 as made."),
    tr_noop("How large gestures are played; 1 as made."),
    tr_noop("How far chest and shoulders rise."),
    tr_noop("People at rest: 12 to 20."),
    tr_noop("How far eyes and head turn to what is looked at."),
    tr_noop("How much of a wide turn the head takes; the eyes do the rest."),
    tr_noop("How often the gaze leaves the partner for a moment."),
    tr_noop("How long it stays away."),
    tr_noop("How far beside the partner's face it goes."),
    tr_noop("Size of the small jumps that the eyes make while they look."),
    tr_noop("How often the eyes jump."),
    tr_noop("How far the lids go down and up with the eyes."),
    tr_noop("Those that come of themselves; people at rest: 17."),
    tr_noop("How many of the stressed syllables bring a blink."),
    tr_noop("How long the lids take to close."),
    tr_noop("How long the lids take to open again."),
    tr_noop("How far the mouth opens and shapes itself in speech."),
    tr_noop("More is softer; too much mumbles."),
    tr_noop("How far hips, spine and legs answer the arms' weight; feet stay where they are."),
    tr_noop("How far collar bones that a clip leaves still rise with raised arms."),
    tr_noop("How far feet that stand are held in blends, and step where the poses have them elsewhere."),
    tr_noop("How far brows and smiles come and go; at 0 a mood's face stands still."),
    tr_noop("How many of the stressed syllables raise the brows."),
    tr_noop("Depth of breath in this mode."),
    tr_noop("Breaths a minute in this mode."),
    tr_noop("How often the gaze leaves the partner in this mode."),
    tr_noop("How long it stays away in this mode."),
    tr_noop("How far it goes in this mode."),
    tr_noop("Size of the eyes' jumps in this mode."),
    tr_noop("How often the eyes jump in this mode."),
    tr_noop("Blinks a minute in this mode."),
)


def in_sentence(dial: Dial) -> str:
    """Return a dial's label inside a sentence: small in English; other languages keep it as it is."""
    label = tr(dial.label)
    return label.lower() if label == dial.label else label
