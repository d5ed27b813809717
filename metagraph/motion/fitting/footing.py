"""How a skeleton stands, told by one of its clips: what the default body cannot know from the rest pose."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.motion.joint_map import NEEDED, SIDES
from metagraph.motion.roles import find_roles
from metagraph.motion.skeleton import Pose, Skeleton
from metagraph.motion.standing import find_standing_pose, is_standing

Array = NDArray[Any]

LOOKED_AT = 90  # frames of a clip
USUAL = 10  # per cent of the frames; as low as that an ankle is while its foot is on the ground
# Shares of the leg: how high ankles are above the ground, and the lowest joints of feet, in clips whose
# ground is at 0. In the clips of nine studios these are 0.06-0.15 and -0.01-0.08.
ANKLE, LOWEST = (0.05, 0.17), (-0.03, 0.10)
PLANTED = 0.01  # metres by which an ankle may be higher than usual while its foot is on the ground
ALIKE = 0.985  # the least length of the mean of a planted foot's directions: they differ by ten degrees
LEVEL = 0.77  # the cosine of the most by which a foot is turned where it stands: forty degrees
BEGINS = 0.9  # how upright the first frame of a clip is that begins in a stance
HANGING = -0.7  # the height of an arm's direction below which it hangs
UP = np.array([0.0, 1, 0])


@dataclass(frozen=True, eq=False)
class Footing:
    """`pose` is one in which the skeleton stands. `ankle` is how high an ankle is above the ground while its
    foot is on it, metres. `ups` are unit vectors `[3]` in the spaces of the left and the right foot that
    point up then. None if the clip does not tell.
    """

    pose: Pose
    ankle: float | None = None
    ups: tuple[Array | None, Array | None] = (None, None)


def choose_footing(clips: Iterable[Clip | None], skeleton: Skeleton) -> Footing | None:
    """Return how a skeleton stands, as the first of some clips that is on it tells; None if none is."""
    clip = next((c for c in clips if c is not None and c.skeleton == skeleton), None)
    return find_footing(clip) if clip is not None else None


def find_footing(clip: Clip) -> Footing:
    """Return how a clip's skeleton stands."""
    frames = np.unique(np.linspace(0, clip.frames - 1, LOOKED_AT).round().astype(int))
    some = replace(
        clip,
        rotations=clip.rotations[frames],
        translations=clip.translations[frames],
        morphs=(),
        weights=None,
    )
    roles = find_roles(clip.skeleton)
    pose = find_standing_pose(some, roles)
    if any(role not in roles for role in NEEDED):
        return Footing(pose)
    turned, at = some.skeleton.globals(some.poses())
    if not is_standing(some.skeleton, roles) and _upright(at[0], roles) > BEGINS:
        first = some.poses()[
            0
        ]  # there heads are straight, which they need not be where limbs are straightest
        pose = Pose(first.rotations.astype(float), first.translations.astype(float))
    pose = _shoulders_carried(pose, some, roles, at)
    ankle = _ankle(some.skeleton, roles, at)
    if ankle is None:
        return Footing(pose)
    rest, _ = some.skeleton.globals(pose)
    ups = [_up(turned[:, foot], at[:, foot, 1], rest[foot]) for foot in _feet(roles)]
    return Footing(pose, ankle, (ups[0], ups[1]))


def _upright(at: Array, roles: Mapping[str, int]) -> float:
    """Return how upright trunk and legs are in one pose, -1..1: the least of them. `at` `[J, 3]`."""
    lines = [at[roles["head"]] - at[roles["hips"]]]
    lines += [at[roles[f"{side}_upper_leg"]] - at[roles[f"{side}_foot"]] for side in SIDES]
    return float(min(line[1] / max(1e-9, float(np.linalg.norm(line))) for line in lines))


def _shoulders_carried(pose: Pose, clip: Clip, roles: Mapping[str, int], at: Array) -> Pose:
    """Return a pose with the shoulders as the clip carries them while arms hang: rest poses raise them with
    the arms. `at` `[F, J, 3]` are the joints' places.
    """
    local = np.array(pose.rotations, float)
    for side in SIDES:
        arm = at[:, roles[f"{side}_lower_arm"]] - at[:, roles[f"{side}_upper_arm"]]
        hanging = arm[:, 1] < HANGING * np.linalg.norm(arm, axis=-1)
        shoulder = roles.get(f"{side}_shoulder")
        if shoulder is not None and hanging.any():
            turns = clip.rotations[hanging, shoulder].astype(float)
            turns *= np.where(turns @ turns[:1].T < 0, -1, 1)
            local[shoulder] = rotation.normalize(turns.mean(0))
    return Pose(local, pose.translations)


def _feet(roles: Mapping[str, int]) -> list[int]:
    return [roles[f"{side}_foot"] for side in SIDES]


def _up(turned: Array, high: Array, rest: Array) -> Array | None:
    """Return what points up in a foot's space while it is on the ground, None if it is never level.

    turned `[F, 4]`: its rotations. high `[F]`: its ankle's heights. rest `[4]`: its rotation as it stands.
    """
    down = high < np.percentile(high, USUAL) + PLANTED
    ups = rotation.rotate_vectors(rotation.conjugate(turned[down]), UP)
    middle = ups.mean(0)
    if np.linalg.norm(middle) < ALIKE:
        return None
    middle /= np.linalg.norm(middle)
    return middle if float(rotation.rotate_vectors(rest, middle)[1]) > LEVEL else None


def _ankle(skeleton: Skeleton, roles: Mapping[str, int], at: Array) -> float | None:
    """Return how high an ankle is above the ground, of joints `at [F, J, 3]`."""
    feet = _feet(roles)
    below = sorted({j for foot in feet for j in skeleton.descendants(foot)})
    ankle, lowest = (float(np.percentile(at[:, joints, 1].min(1), USUAL)) for joints in (feet, below))
    line = [roles[f"left_{part}"] for part in ("upper_leg", "lower_leg", "foot")]
    leg = float(np.linalg.norm(np.diff(at[0, line], axis=0), axis=1).sum())
    known = ANKLE[0] * leg < ankle < ANKLE[1] * leg and LOWEST[0] * leg < lowest < LOWEST[1] * leg
    return ankle if known else None
