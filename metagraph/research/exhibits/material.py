"""What exhibits are made of: a project, and conversations of two with the motion of both. Where nobody gives
any, they are made up: two synthetic voices, performed by the project as conversations are.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import msgspec

from metagraph.formats.corpora import Recorded
from metagraph.graph.conversation.model import (
    Conversation,
    Rates,
    Segment,
    get_side_name,
    list_segments_heard_by,
)
from metagraph.graph.model import Project
from metagraph.motion.clip import Clip
from metagraph.playback.bake import bake
from metagraph.playback.evaluator import Evaluator
from metagraph.playback.planning.choice import key32
from metagraph.research.exhibits.published import TABLE_1
from metagraph.research.generation.planted_speech import make_planted_speech
from metagraph.speech.drive import drive
from metagraph.suggest.tracks import RATE

if TYPE_CHECKING:
    from metagraph.generation.stored import Model

QUICK = (5, 45.0)  # conversations, seconds of each
WHOLE = (17, 105.0)  # as many as were recorded, about half an hour
SEED = 20_200  # of what is said: no model was trained on it


@dataclass(frozen=True, eq=False)
class ExhibitActor:
    """One of two in all conversations. clips: its takes; speech: what it moves with in each,
    `list_segments_heard_by`.
    """

    name: str
    clips: tuple[Clip, ...]
    speech: tuple[tuple[Segment, ...], ...]

    @property
    def minutes(self) -> float:
        return sum(c.duration for c in self.clips) / 60


@dataclass(frozen=True, eq=False)
class ExhibitMaterial:
    """project: whose actions are exhibited. given: somebody's own conversations; made up if there are none.
    told: what these are called in words. model: of the third paper's exhibits, None if there is none. full:
    as much as the papers have, if that can be made.
    """

    project: Project
    given: tuple[Recorded, ...] = ()
    told: str = ""
    model: Path | None = None
    full: bool = False
    notes: list[str] = field(default_factory=list)

    @property
    def made_up(self) -> bool:
        """Whether nobody recorded what is looked at."""
        return not self.given

    @cached_property
    def conversations(self) -> tuple[Recorded, ...]:
        """All conversations. Raises ValueError if the project cannot perform."""
        if self.given:
            return self.given
        count, seconds = WHOLE if self.full else QUICK
        return make_conversations(self.project, count, seconds)

    @cached_property
    def actors(self) -> tuple[ExhibitActor, ...]:
        """Those who have takes, of the skeleton that most of their takes have, first side first."""
        out = []
        for side in (0, 1):
            found = [(r.clips[side], r.conversation) for r in self.conversations]
            some = [(c, t) for c, t in found if c is not None and c.frames > 1]
            if not some:
                continue
            skeletons = [c.skeleton for c, _ in some]
            usual = max(skeletons, key=skeletons.count)
            kept = [(c, t) for c, t in some if c.skeleton == usual]
            if len(kept) < len(some):
                self.notes.append(
                    f"{len(some) - len(kept)} takes of side {side + 1} have another skeleton: left out"
                )
            names = {get_side_name(t, side) for _, t in kept}
            name = names.pop() if len(names) == 1 else f"side {side + 1}"
            out.append(
                ExhibitActor(
                    name, tuple(c for c, _ in kept), tuple(list_segments_heard_by(t, side) for _, t in kept)
                )
            )
        if not out:
            raise ValueError("none of these conversations has motion: nothing can be exhibited of it")
        return tuple(out)

    @property
    def about(self) -> str:
        """What the conversations are, in words."""
        minutes = sum(r.conversation.length for r in self.conversations) / 60
        if self.given:
            count = len(self.given)
            return f"{self.told}: {count} conversations, {minutes:.1f} min; unseen when this was made"
        return (
            f"{len(self.conversations)} made-up conversations of "
            f"{self.conversations[0].conversation.length:g} s: synthetic voices, performed by the project "
            "with the paper's rates. Who made them made what is measured: they show that the measure "
            "works, not how people are"
        )

    @cached_property
    def learned(self) -> Model | None:
        """The learned generator, None if there is none. Raises FileError for one that cannot be read."""
        from metagraph.generation.stored import read_model

        return None if self.model is None else read_model(self.model)


def make_conversations(
    project: Project,
    count: int,
    seconds: float,
    seed: int = SEED,
    rates: Sequence[Rates] | None = None,
    fps: float = RATE,
) -> tuple[Recorded, ...]:
    """Return made-up conversations. rates: of both sides, else the paper's two actors'. Raises ValueError if
    the project has no skeleton, or conversations would be too short.
    """
    out = []
    both = list_actors_rates() if rates is None else tuple(rates)
    for n in range(count):
        name = f"made-up {n + 1}"
        spoken = make_planted_speech(
            seconds, key32(seed, "speech", str(n)), key32(seed, "moves", str(n)), name
        )
        talk = with_rates(spoken.conversation, both)
        clips = tuple(find_side_motion(project, talk, side, fps) for side in (0, 1))
        out.append(Recorded(name, (clips[0], clips[1]), talk, samples=spoken.samples))
    return tuple(out)


def find_side_motion(project: Project, talk: Conversation, side: int, fps: float = RATE) -> Clip:
    """Return how a project moves a side."""
    _, plan = drive(talk, side, project)
    return replace(
        bake(Evaluator(plan, project), project, talk.length, fps),
        name=f"{talk.name}, {talk.sides[side].name}",
    )


def with_rates(talk: Conversation, rates: Sequence[Rates]) -> Conversation:
    """Return a conversation in which both move as often as is said."""
    sides: Any = tuple(msgspec.structs.replace(s, rates=r) for s, r in zip(talk.sides, rates, strict=True))
    return msgspec.structs.replace(talk, sides=sides)


def list_actors_rates() -> tuple[Rates, Rates]:
    """Return the rates of the paper's two actors (table 1)."""
    shares = {(r.actor, r.hypothesis): r.matched / r.total for r in TABLE_1}
    female, male = (
        Rates(
            clause=shares[actor, "clause with either hand"],
            response=shares[actor, "response with a nod"],
            hesitation=shares[actor, "partner's hesitation with a nod"],
        )
        for actor in ("female", "male")
    )
    return female, male
