"""Nine points of the upper body, as the paper measures them: the hips fixed, metres."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.generation.poses import PoseError, PoseRig, decode_poses
from metagraph.motion import rotation
from metagraph.motion.skeleton import Pose, Skeleton

Array = NDArray[Any]

LANDMARKS = (
    *("sternum", "left_shoulder", "right_shoulder", "left_elbow", "right_elbow"),
    *("left_wrist", "right_wrist", "head", "nose"),
)
WRISTS = (LANDMARKS.index("left_wrist"), LANDMARKS.index("right_wrist"))
HEAD, NOSE = LANDMARKS.index("head"), LANDMARKS.index("nose")
BEFORE = 0.12  # metres the nose is before the head's joint
_AT_ONCE = 4096  # frames


@dataclass(frozen=True, eq=False)
class _Small:
    """The joints that landmarks hang on, without the others."""

    skeleton: Skeleton
    base: Pose
    places: tuple[int, ...]  # of the rig's joints, in the small skeleton; -1 where it carries no landmark
    at: dict[str, tuple[int, ...]]  # landmark -> the joints in whose middle it is
    nose: Array  # before the head, in the head's space


@lru_cache(maxsize=16)
def _small(rig: PoseRig) -> _Small:
    role = dict(zip(rig.roles, rig.joints, strict=True))
    arms = role["left_upper_arm"], role["right_upper_arm"]
    # Collar bones begin at the sternum; without them it is between the arms.
    collars = role.get("left_shoulder", arms[0]), role.get("right_shoulder", arms[1])
    at = {"sternum": collars, "head": (role["head"],), "nose": (role["head"],)}
    for side in ("left", "right"):
        parts = (("shoulder", "upper_arm"), ("elbow", "lower_arm"), ("wrist", "hand"))
        at |= {f"{side}_{mark}": (role[f"{side}_{part}"],) for mark, part in parts}
    whole = rig.skeleton
    keep = sorted({k for joints in at.values() for j in joints for k in whole.chain(j)})
    place = {joint: n for n, joint in enumerate(keep)}
    small = Skeleton(
        tuple(whole.names[j] for j in keep),
        np.array([place.get(int(whole.parents[j]), -1) for j in keep], np.int32),
        whole.rest_rotations[keep],
        whole.rest_translations[keep],
    )
    turns, points = whole.globals(Pose(rig.base, whole.rest_translations))
    across = points[arms[0]] - points[arms[1]]
    trunk = points[role["head"]] - points[rig.lines[0][0]]
    # Somebody who stands or sits looks level, however far the head is before the trunk.
    lying = abs(trunk[1]) < 0.7 * float(np.linalg.norm(trunk))
    before = np.cross(across, trunk if lying else np.array([0.0, trunk[1], 0.0]))
    length = float(np.linalg.norm(before))
    if length < 1e-9:
        raise PoseError("the head is not above the arms in the base pose: nobody can tell what is before it")
    nose = rotation.rotate_vectors(rotation.conjugate(turns[role["head"]]), before / length * BEFORE)
    return _Small(
        small,
        Pose(rig.base[keep], whole.rest_translations[keep]),
        tuple(place.get(j, -1) for j in rig.joints),
        {name: tuple(place[j] for j in joints) for name, joints in at.items()},
        nose,
    )


def place_landmarks(rig: PoseRig, poses: Array) -> Array:
    """Return where the LANDMARKS are `[T, 9, 3]`, metres. poses: `[T, X]`, not standardised."""
    small = _small(rig)
    used = [n for n, place in enumerate(small.places) if place >= 0]
    places = [small.places[n] for n in used]
    out = np.empty((len(poses), len(LANDMARKS), 3))
    for first in range(0, len(poses), _AT_ONCE):
        some = poses[first : first + _AT_ONCE]
        rotations = np.repeat(small.base.rotations[None], len(some), 0)
        rotations[:, places] = decode_poses(rig, some)[:, used]
        still = np.repeat(small.base.translations[None], len(some), 0)
        turns, points = small.skeleton.globals(Pose(rotations, still))
        for n, name in enumerate(LANDMARKS):
            out[first : first + len(some), n] = points[:, list(small.at[name])].mean(1)
        head = small.at["head"][0]
        out[first : first + len(some), NOSE] += rotation.rotate_vectors(turns[:, head], small.nose)
    return out
