"""Temperaments: how much a character does by itself, as one choice."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType

import msgspec

from metagraph.common.wording import Phrase, phrase
from metagraph.graph.life import Life
from metagraph.graph.model import LAYERS, Layer, Markov, Project


@dataclass(frozen=True)
class Temperament:
    """A preset. rests: factor of the rests between acts; variety: as in `Settings`; others: as in `Life`."""

    title: Phrase
    tip: Phrase
    rests: float
    variety: float
    valence: float
    arousal: float
    aversion_rate: float
    blinks: float


TEMPERAMENTS: Mapping[str, Temperament] = MappingProxyType({
    "neutral": Temperament(phrase("Neutral"), phrase("The defaults"), 1.0, 1.0, 0.0, 0.0, 12.0, 17.0),
    "presenter": Temperament(
        phrase("Calm presenter"), phrase("Few acts, long rests and a steady look"),
        1.5, 1.5, 0.1, -0.1, 8.0, 15.0,
    ),
    "friend": Temperament(
        phrase("Lively friend"), phrase("Many acts, quick and cheerful"), 0.6, 0.7, 0.45, 0.35, 12.0, 18.0
    ),
    "candidate": Temperament(
        phrase("Nervous candidate"), phrase("Short rests, a look that wanders, many blinks"),
        0.5, 0.5, -0.2, 0.3, 20.0, 26.0,
    ),
    "receptionist": Temperament(
        phrase("Composed receptionist"), phrase("Still and friendly, with an attentive look"),
        2.2, 1.5, 0.3, -0.15, 7.0, 14.0,
    ),
})  # fmt: skip


def set_temperament(project: Project, name: str, usual: Mapping[Layer, Markov]) -> Project:
    """Return the project with a temperament. usual: the models' defaults by layer, whose rests are scaled; a
    model that was learned stays as it is. Raises KeyError for a name that is none.
    """
    of = TEMPERAMENTS[name]
    project = set_rest_scale(project, of.rests, usual)
    life: Life = msgspec.structs.replace(
        project.life,
        valence=of.valence,
        arousal=of.arousal,
        aversion_rate=of.aversion_rate,
        blinks=of.blinks,
    )
    return replace(project, life=life, settings=replace(project.settings, variety=of.variety))


def set_rest_scale(project: Project, scale: float, usual: Mapping[Layer, Markov]) -> Project:
    """Return the project with the rests of its models so many times the usual ones. usual: the models'
    defaults by layer; a model that was learned stays as it is.
    """
    markov = dict(project.markov)
    for layer in LAYERS:
        own = markov.pop(layer, usual[layer])
        if _is_learned(own, usual[layer]):
            markov[layer] = own
        elif scale != 1.0:
            markov[layer] = replace(usual[layer], gap=round(usual[layer].gap * scale, 3))
    return replace(project, markov=markov)


def find_rest_scale(project: Project, usual: Mapping[Layer, Markov]) -> float | None:
    """Return how many times the usual ones the rests of a project's models are: of the first layer whose
    model was not learned; None if all were.
    """
    for layer in LAYERS:
        own = project.markov.get(layer, usual[layer])
        if not _is_learned(own, usual[layer]) and usual[layer].gap > 0:
            return round(own.gap / usual[layer].gap, 3)
    return None


def _is_learned(own: Markov, usual: Markov) -> bool:
    return replace(own, gap=usual.gap) != usual


def find_temperament(project: Project, usual: Mapping[Layer, Markov]) -> str | None:
    """Return which temperament a project has, None for one of its own."""
    for name in TEMPERAMENTS:
        if set_temperament(project, name, usual) == project:
            return name
    return None
