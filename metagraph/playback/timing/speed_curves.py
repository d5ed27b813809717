"""How fast what an action moves goes, over its clip: of its hands, its head, its trunk, or of any joint."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.graph import anatomy
from metagraph.graph.checks.end_gaps import get_action_motion
from metagraph.graph.model import Action, Project
from metagraph.motion import features
from metagraph.motion.clip import Clip

Array = NDArray[Any]

UNIT = "m/s"
CHESTS = ("upper_chest", "chest", "spine")
BODY = ("hips", "head", "left_foot", "right_foot")
OFFERED = ("left_hand", "right_hand", "head", *CHESTS, "hips", "left_foot", "right_foot")


@dataclass(frozen=True, eq=False)
class SpeedCurve:
    """name: of what. seen_from: of what it is seen from, "" for the ground. speeds `[F]`: metres a second, a
    frame of the clip each.
    """

    name: str
    seen_from: str
    speeds: Array

    @property
    def words(self) -> str:
        """What it is a curve of, with its unit."""
        return f"{self.name}, {UNIT}" + (f", seen from {self.seen_from}" if self.seen_from else "")


def measure_action_speed(project: Project, action: Action) -> tuple[Array, str]:
    """Return the speed over an action's clip `[F]`, metres a second, of the fastest of what it moves, and in
    words what of; nothing and "" if there is no motion on the project's skeleton.
    """
    motion = get_action_motion(project, action)
    if motion is None:
        return np.zeros(0), ""
    joints, ground = _movers(project, motion, action.layer, action.limb)
    part = {"arms": "hand", "head": "head"}.get(action.layer, "body")
    return features.measure_speed(motion, joints, ground), f"{part} speed"


def find_curves(project: Project, action: Action, joint: str = "") -> tuple[SpeedCurve, ...]:
    """Return an action's curves; none if there is no motion on the project's skeleton. joint: of which, by
    name; "" for what its layer moves, a curve for each hand.
    """
    motion = get_action_motion(project, action)
    if motion is None:
        return ()
    roles = anatomy.project_roles(project)
    names = motion.skeleton.names
    if joint in motion.skeleton:
        place = motion.skeleton.index(joint)
        ground = _ground(roles, place)
        joints = _ends(motion, place) if place == roles.get("head") else [place]
        return (_curve(motion, joint, joints, ground, names),)
    if action.layer == "arms":
        sides = ("left", "right") if action.limb == "both" else (action.limb,)
        hands = [(f"{side} hand", roles[f"{side}_hand"]) for side in sides if f"{side}_hand" in roles]
        ground = _first(roles, CHESTS)
        if hands:
            return tuple(_curve(motion, name, [place], ground, names) for name, place in hands)
    found, ground = _movers(project, motion, action.layer, action.limb)
    return (_curve(motion, "head" if action.layer == "head" else "body", found, ground, names),)


def list_offered_joints(project: Project) -> tuple[tuple[str, str], ...]:
    """Return the joints whose curve can be asked for, (name, words): those that tell most first."""
    if project.skeleton is None:
        return ()
    names, roles = project.skeleton.names, anatomy.project_roles(project)
    first = [(names[roles[r]], r.replace("_", " ")) for r in OFFERED if r in roles]
    known = {name for name, _ in first}
    return (*first, *((name, name) for name in names if name not in known))


def _curve(
    motion: Clip, name: str, joints: Sequence[int], ground: int | None, names: Sequence[str]
) -> SpeedCurve:
    return SpeedCurve(
        name, names[ground] if ground is not None else "", features.measure_speed(motion, joints, ground)
    )


def _movers(project: Project, motion: Clip, layer: str, limb: str) -> tuple[list[int], int | None]:
    """Return the joints that a layer is about, and the one they are seen from."""
    roles = anatomy.project_roles(project)
    if layer == "arms":
        sides = ("left", "right") if limb == "both" else (limb,)
        return [roles[f"{s}_hand"] for s in sides if f"{s}_hand" in roles], _first(roles, CHESTS)
    if layer == "head":
        head = roles.get("head")
        return ([] if head is None else _ends(motion, head)), roles.get("neck")
    return [roles[r] for r in BODY if r in roles], None


def _ends(motion: Clip, head: int) -> list[int]:
    """A turning head's joint stays in place: its eyes or what else hangs on it tell."""
    return [i for i in range(len(motion.skeleton)) if motion.skeleton.parents[i] == head] or [head]


def _ground(roles: dict[str, int] | Any, place: int) -> int | None:
    """Return what a joint is seen from: the chest; for trunk and legs, the ground."""
    trunk = {roles.get(r) for r in ("hips", "spine", "chest", "upper_chest")}
    legs = {i for r, i in roles.items() if any(w in r for w in ("foot", "leg", "toe"))}
    return None if place in trunk or place in legs else _first(roles, CHESTS)


def _first(roles: Any, names: Sequence[str]) -> int | None:
    return next((roles[n] for n in names if n in roles), None)
