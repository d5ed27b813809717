"""How far joints move while they are being chosen, with the steps back."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from metagraph.graph import anatomy
from metagraph.graph.manual.machine import State
from metagraph.graph.model import Action, Project
from metagraph.motion.skeleton import Skeleton


class MaskWeights:
    """Weights 0..1 of all of a skeleton's joints, by name; every change is one step that can be undone."""

    def __init__(self, project: Project, of: Action | State | None) -> None:
        self._project = project
        self._now = _weights_of(project.skeleton, of)
        self._undone: list[dict[str, float]] = []
        self._done: list[dict[str, float]] = []

    @property
    def now(self) -> Mapping[str, float]:
        return self._now

    @property
    def can_undo(self) -> bool:
        return bool(self._done)

    @property
    def can_redo(self) -> bool:
        return bool(self._undone)

    def change(self, weights: Mapping[str, float]) -> None:
        """Give joints other weights; of joints that are not there nothing is kept."""
        new = {name: _kept(weights.get(name, weight)) for name, weight in self._now.items()}
        if new != self._now:
            self._done.append(self._now)
            self._now, self._undone = new, []

    def add(self, joints: Iterable[str], amount: float) -> None:
        """Let joints move farther, or less far."""
        self.change({name: self._now.get(name, 0.0) + amount for name in joints})

    def soften(self, over: int) -> None:
        """Let weights rise over so many joints where the mask begins (`anatomy.make_soft_edge`)."""
        skeleton = self._project.skeleton
        if skeleton is not None:
            self.change(
                anatomy.make_soft_edge(skeleton, anatomy.project_parts(self._project), self._now, over)
            )

    def undo(self) -> None:
        if self._done:
            self._undone.append(self._now)
            self._now = self._done.pop()

    def redo(self) -> None:
        if self._undone:
            self._done.append(self._now)
            self._now = self._undone.pop()

    def fields(self) -> dict[str, Any]:
        """Return an action's, or state's, fields that say this."""
        skeleton = self._project.skeleton
        return anatomy.as_joint_mask(skeleton, self._now) if skeleton is not None else {}

    @property
    def empty(self) -> bool:
        """Whether nothing moves."""
        return not any(self._now.values())


def _weights_of(skeleton: Skeleton | None, of: Action | State | None) -> dict[str, float]:
    if skeleton is None:
        return {}
    named = set(of.joints) if of is not None else set()
    soft = dict(of.joint_weights) if of is not None else {}
    return {name: soft.get(name, 1.0) if not named or name in named else 0.0 for name in skeleton.names}


def _kept(weight: float) -> float:
    return min(1.0, max(0.0, round(weight, 3)))
