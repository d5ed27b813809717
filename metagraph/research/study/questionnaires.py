"""Questionnaires: what they ask, and what their answers amount to.

SUS: John Brooke, "SUS: a quick and dirty usability scale", in Jordan et al. (eds.), Usability Evaluation in
Industry, Taylor and Francis
1996. NASA-TLX: Sandra G. Hart and Lowell E. Staveland, "Development of NASA-TLX (Task Load Index): results of
      empirical and theoretical
research", in Hancock and Meshkati (eds.), Human Mental Workload, North-Holland 1988. The wording is theirs.
"""

from __future__ import annotations

from collections.abc import Mapping
from itertools import combinations
from typing import Annotated, Any, Literal

import msgspec
from msgspec import Meta, Struct

When = Literal["after_task", "after_condition", "after_study"]
Name = Annotated[str, Meta(pattern="^[A-Za-z0-9][A-Za-z0-9_-]*$", max_length=60)]
BUTTONS = 11  # a scale of more points than this is a slider


class Scale(Struct, frozen=True, forbid_unknown_fields=True):
    """Numbers from one to another. left, right: what the ends mean. step: between two numbers that can be
    chosen.
    """

    lowest: int = msgspec.field(name="from")
    highest: int = msgspec.field(name="to")
    left: str = ""
    right: str = ""
    step: Annotated[int, Meta(ge=1)] = 1

    @property
    def points(self) -> tuple[int, ...]:
        return tuple(range(self.lowest, self.highest + 1, self.step))


class Item(Struct, frozen=True, forbid_unknown_fields=True):
    """A question, answered on a scale, by one of some choices, or in words. title: a short name above the
    question. optional: it may be left open; words always may.
    """

    id: Name
    text: str
    scale: Scale | None = None
    choices: tuple[str, ...] = ()
    words: bool = False
    title: str = ""
    optional: bool = False

    @property
    def needed(self) -> bool:
        return not (self.optional or self.words)


class Questionnaire(Struct, frozen=True, forbid_unknown_fields=True):
    """Items in their order. when: None as the study says."""

    id: Name
    items: Annotated[tuple[Item, ...], Meta(min_length=1)]
    title: str = ""
    instructions: str = ""
    when: When | None = None


_AGREE = Scale(1, 5, "Strongly disagree", "Strongly agree")
_SUS = (
    "I think that I would like to use this system frequently.",
    "I found the system unnecessarily complex.",
    "I thought the system was easy to use.",
    "I think that I would need the support of a technical person to be able to use this system.",
    "I found the various functions in this system were well integrated.",
    "I thought there was too much inconsistency in this system.",
    "I would imagine that most people would learn to use this system very quickly.",
    "I found the system very cumbersome to use.",
    "I felt very confident using the system.",
    "I needed to learn a lot of things before I could get going with this system.",
)
SUS = Questionnaire(
    "sus",
    tuple(Item(f"sus{n}", text, _AGREE) for n, text in enumerate(_SUS, 1)),
    "System Usability Scale",
    "Say how far you agree, for the editor you have just worked with. Do not think long about any of them; "
    "if you cannot decide, choose the middle.",
)

_LOAD = Scale(0, 100, "Very low", "Very high", 5)
TLX_SCALES = {
    "mental": ("Mental demand", "How mentally demanding was the task?", _LOAD),
    "physical": ("Physical demand", "How physically demanding was the task?", _LOAD),
    "temporal": ("Temporal demand", "How hurried or rushed was the pace of the task?", _LOAD),
    "performance": (
        "Performance",
        "How successful were you in accomplishing what you were asked to do?",
        Scale(0, 100, "Perfect", "Failure", 5),
    ),
    "effort": ("Effort", "How hard did you have to work to accomplish your level of performance?", _LOAD),
    "frustration": (
        "Frustration",
        "How insecure, discouraged, irritated, stressed, and annoyed were you?",
        _LOAD,
    ),
}
TLX_PAIRS = tuple(combinations(TLX_SCALES, 2))
TLX = Questionnaire(
    "tlx",
    tuple(Item(key, text, scale, title=title) for key, (title, text, scale) in TLX_SCALES.items()),
    "NASA Task Load Index",
    "Put each mark where it says best how the work was for you.",
)
TLX_WEIGHTED = Questionnaire(
    "tlx_weighted",
    (
        *TLX.items,
        *(
            Item(
                f"{a}-{b}",
                "Which of the two contributed more to the load of the work?",
                choices=(TLX_SCALES[a][0], TLX_SCALES[b][0]),
            )
            for a, b in TLX_PAIRS
        ),
    ),
    TLX.title,
    TLX.instructions,
)
BUILT_IN: Mapping[str, Questionnaire] = {q.id: q for q in (SUS, TLX, TLX_WEIGHTED)}


def compute_sus_score(answers: Mapping[str, Any]) -> float:
    """Return 0..100: odd items give their place on the scale less 1, even ones 5 less it; the sum times 2.5
    (Brooke 1996).

    answers: sus1..sus10, each 1..5. Raises ValueError if one is missing or no such number.
    """
    total = 0.0
    for n, item in enumerate(SUS.items, 1):
        value = _value(answers, item)
        total += value - 1 if n % 2 else 5 - value
    return total * 2.5


def compute_tlx_raw(answers: Mapping[str, Any]) -> float:
    """Return 0..100: the mean of the six scales ("raw TLX"). Raises ValueError as `compute_sus_score`
    does.
    """
    return sum(_value(answers, item) for item in TLX.items) / len(TLX.items)


def compute_weighted_tlx(answers: Mapping[str, Any]) -> float:
    """Return 0..100: the mean of the six scales, weighted by how often each was chosen in the 15 pairs (Hart
    and Staveland 1988).

    answers: the scales by name, and for each pair "mental-physical" the title that was chosen. Raises
    ValueError as `compute_sus_score` does.
    """
    titles = {title: key for key, (title, _, _) in TLX_SCALES.items()}
    weights = dict.fromkeys(TLX_SCALES, 0)
    for a, b in TLX_PAIRS:
        chosen = titles.get(str(answers.get(f"{a}-{b}")))
        if chosen not in (a, b):
            raise ValueError(
                f"the pair '{a}-{b}' of the weighted TLX should be answered with '{TLX_SCALES[a][0]}' or "
                f"'{TLX_SCALES[b][0]}'"
            )
        weights[chosen] += 1
    return sum(weights[item.id] * _value(answers, item) for item in TLX.items) / len(TLX_PAIRS)


def _value(answers: Mapping[str, Any], item: Item) -> float:
    scale = item.scale
    assert scale is not None
    value = answers.get(item.id)
    if (
        isinstance(value, bool)
        or not isinstance(value, int | float)
        or not scale.lowest <= value <= scale.highest
    ):
        said = "is not answered" if value is None else f"is answered with {value!r}"
        raise ValueError(f"'{item.id}' {said}; it should be a number from {scale.lowest} to {scale.highest}")
    return float(value)
