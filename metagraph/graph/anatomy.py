"""A project's skeleton as the graph sees it: roles and body parts with the user's corrections, and the base
pose.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import lru_cache
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

from metagraph.graph.manual.machine import State
from metagraph.graph.model import Action, Part, Project
from metagraph.motion.roles import assign_body_parts, find_joint_sides, find_roles
from metagraph.motion.skeleton import Pose, Skeleton

Array = NDArray[Any]


@lru_cache(maxsize=32)
def _roles(skeleton: Skeleton, corrections: tuple[tuple[str, str], ...]) -> Mapping[str, int]:
    found = dict(find_roles(skeleton))
    for role, joint in corrections:
        if joint in skeleton:
            found[role] = skeleton.index(joint)
        else:
            found.pop(role, None)
    return found


@lru_cache(maxsize=32)
def _parts(
    skeleton: Skeleton, roles: tuple[tuple[str, str], ...], corrections: tuple[tuple[str, Part], ...]
) -> tuple[Part, ...]:
    found = list(assign_body_parts(skeleton, dict(_roles(skeleton, roles))))
    for joint, part in corrections:
        if joint in skeleton:
            found[skeleton.index(joint)] = part
    return tuple(cast(Part, part) for part in found)


@lru_cache(maxsize=32)
def _sides(skeleton: Skeleton, roles: tuple[tuple[str, str], ...]) -> tuple[str, ...]:
    return tuple(find_joint_sides(skeleton, dict(_roles(skeleton, roles))))


def project_roles(project: Project) -> Mapping[str, int]:
    """Return role -> joint: found from names and hierarchy, corrected by the user."""
    return _roles(project.skeleton, tuple(sorted(project.roles.items()))) if project.skeleton else {}


def project_parts(project: Project) -> tuple[Part, ...]:
    """Return each joint's body part."""
    if project.skeleton is None:
        return ()
    return _parts(
        project.skeleton, tuple(sorted(project.roles.items())), tuple(sorted(project.parts.items()))
    )


def project_sides(project: Project) -> tuple[str, ...]:
    """Return each joint's side: left, right or centre."""
    return _sides(project.skeleton, tuple(sorted(project.roles.items()))) if project.skeleton else ()


def make_action_mask(project: Project, action: Action) -> Array | None:
    """Return `[J]` float32, 1 where the action moves a joint, 0 where its stance shows, and between where it
    moves it in part; None when it moves all of all.

    A one-armed action leaves the other arm alone; `joints`, if any, names the only joints it moves.
    """
    if project.skeleton is None or not (action.limb != "both" or action.joints or action.joint_weights):
        return None
    return _mask(
        project.skeleton,
        project_parts(project),
        project_sides(project),
        action.limb,
        action.joints,
        action.joint_weights,
    )


def as_joint_mask(skeleton: Skeleton, weights: Mapping[str, float]) -> dict[str, Any]:
    """Return an action's `joints` and `joint_weights` for weights 0..1 of joints by name, 1 for those not
    named; both empty if it moves all of all.
    """
    of = {name: min(1.0, max(0.0, round(weights.get(name, 1.0), 3))) for name in skeleton.names}
    moving = tuple(name for name, weight in of.items() if weight > 0)
    return {
        "joints": moving if len(moving) < len(of) else (),
        "joint_weights": tuple((name, weight) for name, weight in of.items() if 0 < weight < 1),
    }


def make_soft_edge(
    skeleton: Skeleton, part: Sequence[Part], weights: Mapping[str, float], over: int
) -> dict[str, float]:
    """Return weights of joints 0..1 that rise evenly over so many joints, 1 or more, where a mask begins: at
    joints that move on one that does not, and at the foot of the spine; over fewer where fewer follow.

    Engines call it the depth of a blend: over three joints of a spine, 0.25, 0.5 and 0.75. Legs keep what
    they have, and so does what hangs on joints that do not move.
    """
    moves = [weights.get(name, 1.0) > 0 for name in skeleton.names]
    below: dict[int, tuple[int, int]] = {}  # joint -> where the mask it is in begins, and how far below that
    for joint, parent in enumerate(skeleton.parents.tolist()):
        if not moves[joint] or part[joint] == "legs":
            continue
        foot = part[joint] == "spine" and (parent < 0 or part[parent] == "legs")
        if parent in below:
            below[joint] = below[parent][0], below[parent][1] + 1
        elif foot or (parent >= 0 and not moves[parent]):
            below[joint] = joint, 0
    deepest: dict[int, int] = {}
    for begin, steps in below.values():
        deepest[begin] = max(steps, deepest.get(begin, 0))
    out = dict(weights)
    for joint, (begin, steps) in below.items():
        out[skeleton.names[joint]] = min(1.0, (steps + 1) / (min(over, deepest[begin]) + 1))
    return out


def list_unknown_joints(skeleton: Skeleton | None, of: Action | State) -> list[str]:
    """Return the joints that a mask names and the skeleton does not have; none without a skeleton."""
    if skeleton is None:
        return []
    return [name for name in (*of.joints, *(name for name, _ in of.joint_weights)) if name not in skeleton]


@lru_cache(maxsize=4096)
def _mask(
    skeleton: Skeleton,
    part: tuple[Part, ...],
    side: tuple[str, ...],
    limb: str,
    joints: tuple[str, ...],
    weights: tuple[tuple[str, float], ...],
) -> Array:
    out = np.ones(len(skeleton), np.float32)
    for name, weight in weights:
        if name in skeleton:
            out[skeleton.index(name)] = min(1.0, max(0.0, weight))
    if limb != "both":
        other = "right" if limb == "left" else "left"
        out[[i for i in range(len(out)) if part[i] == "arms" and side[i] == other]] = 0
    if joints:
        named = {skeleton.index(name) for name in joints if name in skeleton}
        out[[i for i in range(len(out)) if i not in named]] = 0
    out.setflags(write=False)
    return out


def find_joint_scales(project: Project) -> Array:
    """Return `[2, J]` float32: which joints turn farther from the stance, and which less far, where an
    action is played larger or smaller than made (`Cue.extent`), 1 or 0. Hands keep their shape, and elbows,
    which bend one way, are not bent on.
    """
    if project.skeleton is None:
        return np.ones((2, 0), np.float32)
    return _scales(project.skeleton, tuple(sorted(project.roles.items())))


@lru_cache(maxsize=32)
def _scales(skeleton: Skeleton, corrections: tuple[tuple[str, str], ...]) -> Array:
    found = _roles(skeleton, corrections)
    out = np.ones((2, len(skeleton)), np.float32)
    hands = {found[r] for r in ("left_hand", "right_hand") if r in found}
    inside = set(hands)
    for joint, parent in enumerate(skeleton.parents.tolist()):
        if parent in inside:
            inside.add(joint)
    out[:, sorted(inside - hands)] = 0
    out[0, [found[r] for r in ("left_lower_arm", "right_lower_arm") if r in found]] = 0
    out.setflags(write=False)
    return out


def get_base_pose(project: Project) -> Pose:
    """Return the base pose `[J, ...]`, float32; the rest pose while its clip is missing. Raises ValueError
    without a skeleton.
    """
    if project.skeleton is None:
        raise ValueError("a project without clips has no base pose")
    entry = project.clips.get(project.base.clip) if project.base.clip else None
    motion = entry.motion if entry is not None else None
    if motion is None or motion.skeleton != project.skeleton:
        rest = project.skeleton.rest
        return Pose(rest.rotations.astype(np.float32), rest.translations.astype(np.float32))
    return motion.pose_at(min(project.base.frame, motion.frames - 1) / motion.fps)
