"""What the domain tells apart by a word, marked for translation: whoever shows one says `tr(word)`."""

from __future__ import annotations

from app.translation import tr_noop

LAYERS = (
    *(tr_noop("body"), tr_noop("arms"), tr_noop("head")),
    *(tr_noop("Body"), tr_noop("Arms"), tr_noop("Head")),
)
KINDS = (
    *(tr_noop("stance"), tr_noop("gesture"), tr_noop("fidget"), tr_noop("transition")),
    *(tr_noop("Stance"), tr_noop("Gesture"), tr_noop("Fidget"), tr_noop("Transition")),
)
LIMBS = (tr_noop("left"), tr_noop("right"), tr_noop("both"))
PHASES = (tr_noop("preparation"), tr_noop("stroke"), tr_noop("hold"), tr_noop("retraction"))
TAGS = (tr_noop("positive"), tr_noop("negative"), tr_noop("Positive"), tr_noop("Negative"))
MODES = (tr_noop("idle"), tr_noop("listening"), tr_noop("talking"))
