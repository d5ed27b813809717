"""The domain's own names - layers, kinds, colours - as the window says them."""

from __future__ import annotations

from app.translation import make_lazy_texts, tr, tr_noop
from metagraph.common.studio import get_studio

KIND_TITLES = make_lazy_texts(
    lambda: {
        "stance": tr("Stance"),
        "gesture": tr("Gesture"),
        "fidget": tr("Fidget"),
        "transition": tr("Transition"),
    }
)
KIND_MEANINGS = make_lazy_texts(
    lambda: {
        "stance": tr(
            "A stance is a resting pose that the layer loops in. Gestures and fidgets start and end in it."
        ),
        "gesture": tr("A gesture accompanies speech or tells something."),
        "fidget": tr("A fidget is a small action without meaning, such as a scratch or a shift of weight."),
        "transition": tr("A transition leaves one stance and ends in another."),
    }
)
MANY_OF_KIND = make_lazy_texts(
    lambda: {
        "stance": tr("Stances"),
        "gesture": tr("Gestures"),
        "fidget": tr("Fidgets"),
        "transition": tr("Transitions"),
    }
)
LAYER_TITLES = make_lazy_texts(lambda: {"body": tr("Body"), "arms": tr("Arms"), "head": tr("Head")})
LAYER_LONG_TITLES = make_lazy_texts(
    lambda: {"body": tr("Body layer"), "arms": tr("Arms layer"), "head": tr("Head layer")}
)
COLOR_TITLES = make_lazy_texts(
    lambda: (
        {
            "": "",
            "red": tr("Red"),
            "orange": tr("Orange"),
            "yellow": tr("Yellow"),
            "green": tr("Green"),
            "blue": tr("Blue"),
            "purple": tr("Purple"),
        }
        | dict(get_studio().colours)
    )
)
COLOR_LABELS = make_lazy_texts(
    lambda: (
        {
            "red": tr("Red label"),
            "orange": tr("Orange label"),
            "yellow": tr("Yellow label"),
            "green": tr("Green label"),
            "blue": tr("Blue label"),
            "purple": tr("Purple label"),
        }
        | dict(get_studio().colours)
    )
)

# What stands in sentences and lists as the domain writes it: whoever shows one says `tr(word)`.
WORDS = (
    *(tr_noop("body"), tr_noop("arms"), tr_noop("head")),
    *(tr_noop("stance"), tr_noop("gesture"), tr_noop("fidget"), tr_noop("transition")),
    *(tr_noop("left"), tr_noop("right"), tr_noop("both")),
    *(tr_noop("preparation"), tr_noop("stroke"), tr_noop("hold"), tr_noop("retraction")),
    *(tr_noop("positive"), tr_noop("negative"), tr_noop("Positive"), tr_noop("Negative")),
    *(tr_noop("idle"), tr_noop("listening"), tr_noop("talking")),
    *(tr_noop("thinking"), tr_noop("reacting")),
)
