"""What is proposed for clips: values that name, motion and labels together give, that a person corrects, and
that are taken over.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from metagraph.graph.model import Kind, Layer, Limb
from metagraph.suggest.estimate import Belief
from metagraph.suggest.stances.known import Shape
from metagraph.suggest.words.names import Patterns
from metagraph.suggest.words.tokens import split_clip_name

_USUAL = Patterns()


@dataclass(frozen=True)
class RestMoment:
    """A moment of a clip that is still enough to stand in. start, end: seconds of the clip. reason: in
    words.
    """

    clip: str
    start: float
    end: float
    reason: str


@dataclass(frozen=True)
class StancePlace:
    """A stance clips may belong to. key: the project's id, or one of its own for a stance that is not there
    yet. shape: what it looks like, where that is known. rest: where it can be seen, when no clip rests in it.
    """

    key: str
    layer: Layer
    name: str
    there: bool = False
    shape: Shape | None = None
    rest: RestMoment | None = None


@dataclass(frozen=True)
class Proposal:
    """What a clip is taken for. stance, end_stance: of a `Place`, by key. conflicts: where sources disagree
    firmly, in words. timing: as `Timing` has it, where the motion says; good: whether neither its beginning
    nor its end would jump, None where nobody knows. details: what else an action has, by its name in the
    model, where something is known: each of `timing`, `mask` (names of the only joints it moves, none for
    all), `stroke` (seconds, of gestures) and `likelihood`. said: whether its name says its kind.
    """

    clip: str
    kind: Belief[Kind]
    layer: Belief[Layer]
    stance: Belief[str] | None
    end_stance: Belief[str] | None
    limb: Belief[Limb]
    tags: Belief[tuple[str, ...]] | None = None
    conflicts: tuple[str, ...] = ()
    timing: Mapping[str, Any] = field(default_factory=dict)
    timing_reason: str = ""
    good: bool | None = None
    details: Mapping[str, Belief[Any]] = field(default_factory=dict)
    said: bool = False

    @property
    def confidence(self) -> float:
        """How sure it is as a whole: as its least sure part that decides where it goes."""
        parts = [
            self.kind.confidence,
            self.layer.confidence,
            self.stance.confidence if self.stance is not None else 0.0,
        ]
        if self.kind.value == "transition":
            parts.append(self.end_stance.confidence if self.end_stance is not None else 0.0)
        return min(parts)


@dataclass(frozen=True)
class Spare:
    """What a clip that is left aside would be taken for. places: the stances this speaks of, by key."""

    proposal: Proposal
    places: Mapping[str, StancePlace]


@dataclass(frozen=True)
class Proposals:
    """Proposals by clip, and the stances they speak of, by key. aside: clip -> why it is none of the four
    kinds: walks, turns, exercises. whole: whether one layer plays the whole body (see `whole_body`). spare:
    for each clip that is left aside, what it would be if somebody wanted it all the same.
    """

    proposals: Mapping[str, Proposal]
    places: Mapping[str, StancePlace]
    aside: Mapping[str, str] = field(default_factory=dict)
    whole: bool = False
    spare: Mapping[str, Spare] = field(default_factory=dict)

    @property
    def doubtful(self) -> list[Proposal]:
        """The proposals, the least certain first."""
        return sorted(self.proposals.values(), key=lambda p: (p.confidence, p.clip))


def name_words(name: str) -> tuple[str, ...]:
    """Return the distinct words of a name, in their order, small letters."""
    return tuple(dict.fromkeys(split_clip_name(name, _USUAL).words))


def plain_stance_name(name: str) -> str:
    """Return a stance's name without case, order of words or separators."""
    return " ".join(sorted(split_clip_name(name, _USUAL).words))
