"""A project's skeleton as the graph sees it: roles and body parts with the user's corrections, and the base
pose.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

from metagraph.graph.model import Action, Part, Project
from metagraph.motion.roles import body_parts, find_roles, joint_sides
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
    found = list(body_parts(skeleton, dict(_roles(skeleton, roles))))
    for joint, part in corrections:
        if joint in skeleton:
            found[skeleton.index(joint)] = part
    return tuple(cast(Part, part) for part in found)


@lru_cache(maxsize=32)
def _sides(skeleton: Skeleton, roles: tuple[tuple[str, str], ...]) -> tuple[str, ...]:
    return tuple(joint_sides(skeleton, dict(_roles(skeleton, roles))))


def roles(project: Project) -> Mapping[str, int]:
    """Return role -> joint: found from names and hierarchy, corrected by the user."""
    return _roles(project.skeleton, tuple(sorted(project.roles.items()))) if project.skeleton else {}


def parts(project: Project) -> tuple[Part, ...]:
    """Return each joint's body part."""
    if project.skeleton is None:
        return ()
    return _parts(
        project.skeleton, tuple(sorted(project.roles.items())), tuple(sorted(project.parts.items()))
    )


def sides(project: Project) -> tuple[str, ...]:
    """Return each joint's side: left, right or centre."""
    return _sides(project.skeleton, tuple(sorted(project.roles.items()))) if project.skeleton else ()


def mask(project: Project, action: Action) -> Array | None:
    """Return `[J]` float32, 1 where the action moves a joint and 0 where its stance shows; None when it moves
    all.

    A one-armed action leaves the other arm alone; `joints`, if any, names the only joints it moves.
    """
    if project.skeleton is None or (action.limb == "both" and not action.joints):
        return None
    return _mask(project.skeleton, parts(project), sides(project), action.limb, action.joints)


@lru_cache(maxsize=4096)
def _mask(
    skeleton: Skeleton, part: tuple[Part, ...], side: tuple[str, ...], limb: str, joints: tuple[str, ...]
) -> Array:
    out = np.ones(len(skeleton), np.float32)
    if limb != "both":
        other = "right" if limb == "left" else "left"
        out[[i for i in range(len(out)) if part[i] == "arms" and side[i] == other]] = 0
    if joints:
        named = {skeleton.index(name) for name in joints if name in skeleton}
        out[[i for i in range(len(out)) if i not in named]] = 0
    out.setflags(write=False)
    return out


def scales(project: Project) -> Array:
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


def base_pose(project: Project) -> Pose:
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
