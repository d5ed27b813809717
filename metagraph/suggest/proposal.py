"""Define what is proposed for clips: values made from name, motion and labels together, which a person
corrects and accepts.
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
    """A moment of a clip that is still enough to stand in.

    `start` and `end` are seconds of the clip; they are equal if a single frame is held. `reason` is in words.
    """

    clip: str
    start: float
    end: float
    reason: str


@dataclass(frozen=True)
class StancePlace:
    """A stance that clips may belong to.

    `key` is the project's id, or a key of its own for a stance that does not exist yet; `there` says whether
    it exists. `shape` is what it looks like, if known. `loop` is a clip of another layer that rests in it, as
    one of the whole body rests in a stance of each. `rest` is where it can be seen if no clip rests in it.
    """

    key: str
    layer: Layer
    name: str
    there: bool = False
    shape: Shape | None = None
    loop: str | None = None
    rest: RestMoment | None = None


@dataclass(frozen=True)
class Proposal:
    """What a clip seems to be.

    `stance` and `end_stance` are keys of `StancePlace`s. `conflicts` say in words where sources firmly
    disagree. `timing` has fields of `Timing` that the motion gives. `good` says whether neither its beginning
    nor its end would jump, None if unknown. `details` has what else is known of the action, by its name in
    the model: the fields of `timing`, `mask` (names of the only joints it moves, empty for all), `stroke`
    (seconds, for gestures) and `likelihood`. `said` says whether its name says its kind, `cycle` whether its
    clip is one cycle of a gesture, which repeats. `seen` is how likely its motion alone makes it this kind,
    None if nobody looked at it. `disputed` is the share of the clips proposed with it of which sources firmly
    disagree.
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
    cycle: bool = False
    seen: float | None = None
    disputed: float = 0.0

    @property
    def confidence(self) -> float:
        """Return the confidence of the whole: that of its least certain part that decides where it goes."""
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
    """What a skipped clip would be. `places` has the stances of the proposal, by key."""

    proposal: Proposal
    places: Mapping[str, StancePlace]


@dataclass(frozen=True)
class Proposals:
    """Proposals by clip, and their stances by key.

    `aside` says for each skipped clip why it is none of the four kinds: walks, turns, exercises. `whole` says
    whether one layer plays the whole body (see `whole_body`). `spare` has for each skipped clip what it would
    be if it were used after all.
    """

    proposals: Mapping[str, Proposal]
    places: Mapping[str, StancePlace]
    aside: Mapping[str, str] = field(default_factory=dict)
    whole: bool = False
    spare: Mapping[str, Spare] = field(default_factory=dict)

    @property
    def doubtful(self) -> list[Proposal]:
        """Return the proposals, the least certain first."""
        return sorted(self.proposals.values(), key=lambda p: (p.confidence, p.clip))


def name_words(name: str) -> tuple[str, ...]:
    """Return the distinct words of a name, in order, in lower case."""
    return tuple(dict.fromkeys(split_clip_name(name, _USUAL).words))


def simplify_stance_name(name: str) -> str:
    """Return a stance's name without case, order of words or separators."""
    return " ".join(sorted(split_clip_name(name, _USUAL).words))
