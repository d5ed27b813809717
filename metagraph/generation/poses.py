"""Poses as numbers: of each joint of the upper body two rows of its rotation's matrix, relative to a base
pose.

Joints are found by role, so any humanoid will do. What lies between two of them (a spine of six, a twist in
an arm) counts to the lower one: its turn is that of the whole line from the joint above.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.motion.roles import find_roles
from metagraph.motion.skeleton import Skeleton

Array = NDArray[Any]

NUMBERS = 6  # a joint
LEAST = 0.02  # deviation of a number: less is a joint that hardly moves
FURTHEST = 8.0  # standardised
NEEDED = (
    "spine",
    "head",
    *(f"{s}_{p}" for s in ("left", "right") for p in ("upper_arm", "lower_arm", "hand")),
)
JOINTS = (
    *("spine", "chest", "upper_chest", "neck", "head"),
    *(f"{s}_{p}" for s in ("left", "right") for p in ("shoulder", "upper_arm", "lower_arm", "hand")),
)


class PoseError(ValueError):
    """A skeleton or motion that cannot be told in numbers; the message says why."""


@dataclass(frozen=True, eq=False)
class PoseRig:
    """The joints that count. roles, joints: of each, in JOINTS' order. lines: of each the joints from below
    the one above that counts (or the hips) down to itself. base: local rotations `[J, 4]` of all joints that
    poses are relative to.
    """

    skeleton: Skeleton
    roles: tuple[str, ...]
    joints: tuple[int, ...]
    lines: tuple[tuple[int, ...], ...]
    base: Array

    @property
    def numbers(self) -> int:
        """Numbers of a pose."""
        return NUMBERS * len(self.joints)


def find_rig(
    skeleton: Skeleton, roles: Mapping[str, int] | None = None, base: Array | None = None
) -> PoseRig:
    """Return the joints that count of a skeleton. roles: as found unless given. base: local rotations `[J,
    4]`, the rest pose unless given. Raises PoseError if a joint is missing without which nobody gestures.
    """
    found = find_roles(skeleton) if roles is None else roles
    missing = [role.replace("_", " ") for role in NEEDED if role not in found]
    if missing:
        raise PoseError(
            f"the skeleton has no {', no '.join(missing)} that can be told by name or shape. "
            "Correct its roles, or leave its takes out"
        )
    chosen = {role: found[role] for role in JOINTS if role in found}
    taken = {*chosen.values(), found.get("hips", 0), 0}
    lines = []
    for joint in chosen.values():
        line = [joint]
        while (above := int(skeleton.parents[line[-1]])) >= 0 and above not in taken:
            line.append(above)
        lines.append(tuple(reversed(line)))
    held = skeleton.rest_rotations if base is None else np.asarray(base, np.float64)
    if held.shape != (len(skeleton), 4) or not np.isfinite(held).all():
        raise PoseError(f"the base pose is {held.shape}, expected ({len(skeleton)}, 4) finite numbers")
    return PoseRig(skeleton, tuple(chosen), tuple(chosen.values()), tuple(lines), rotation.normalize(held))


def encode_rotations(rig: PoseRig, rotations: Array) -> Array:
    """Return poses `[..., 6 n]`, float32, of local rotations `[..., J, 4]`."""
    rotations = np.asarray(rotations, np.float64)
    turns = np.stack([_line(rotations, line) for line in rig.lines], -2)
    base = np.stack([_line(rig.base, line) for line in rig.lines])
    rows = rotation.to_matrix(rotation.multiply(rotation.conjugate(base), turns))[..., :2, :]
    return np.asarray(rows.reshape(*rows.shape[:-3], rig.numbers), np.float32)


def decode_poses(rig: PoseRig, poses: Array) -> Array:
    """Return the local rotations `[..., n, 4]` of the rig's joints, float64, of poses `[..., 6 n]`: what lies
    between them is in the base pose. Rows need neither be of length 1 nor at a right angle.
    """
    rows = np.reshape(poses, (*np.shape(poses)[:-1], len(rig.joints), 2, 3))
    relative = rotation.from_matrix(orthonormalise_rows(rows))
    return rotation.multiply(rig.base[list(rig.joints)], relative)


def _line(rotations: Array, line: tuple[int, ...]) -> Array:
    """Return the turn of a line of joints `[..., 4]`, from the top."""
    out = rotations[..., line[0], :]
    for joint in line[1:]:
        out = rotation.multiply(out, rotations[..., joint, :])
    return np.asarray(out)


def orthonormalise_rows(rows: Array) -> Array:
    """Return rotation matrices `[..., 3, 3]`, float64, whose first two rows are nearest to `rows [..., 2,
    3]`: the first keeps its direction. Rows of length 0, or in one line, give some rotation.
    """
    rows = np.asarray(rows, np.float64)
    first, second = rows[..., 0, :], rows[..., 1, :]
    first = _unit(first, lambda: np.array([1.0, 0, 0]))

    def aside() -> Array:
        """Return any direction at a right angle."""
        side = np.where(np.abs(first[..., 1:2]) < 0.9, np.array([0.0, 1, 0]), np.array([0.0, 0, 1]))
        side = side - np.einsum("...i,...i->...", first, side)[..., None] * first
        return _unit(side, lambda: np.array([0.0, 1, 0]))

    second = second - np.einsum("...i,...i->...", first, second)[..., None] * first
    second = _unit(second, aside)
    out = np.empty((*first.shape[:-1], 3, 3))
    out[..., 0, :], out[..., 1, :] = first, second
    for a, b, c in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        out[..., 2, c] = first[..., a] * second[..., b] - first[..., b] * second[..., a]
    return out


def _unit(v: Array, otherwise: Callable[[], Array]) -> Array:
    """Return vectors `[..., 3]` of length 1. otherwise: asked for those of length 0, which are rare."""
    length = np.sqrt(np.einsum("...i,...i->...", v, v))[..., None]
    fine = length > 1e-6
    if fine.all():
        return np.asarray(v / length)
    return np.asarray(np.where(fine, v / np.maximum(length, 1e-6), otherwise()))


def resample_rotations(clip: Clip, fps: float, joints: tuple[int, ...] | None = None) -> Array:
    """Return the local rotations `[T, n, 4]` of a clip's joints, or of all, at another rate, by slerp,
    float64. T: as many frames as its duration has.
    """
    chosen = slice(None) if joints is None else list(joints)
    times = np.arange(int(np.floor(clip.duration * fps + 1e-6)) + 1) / fps
    low, high, part = clip.locate(times)
    every = clip.rotations[:, chosen].astype(np.float64)
    return rotation.normalize(rotation.slerp(every[low], every[high], part[:, None].astype(np.float64)))


def encode_clip(rig: PoseRig, clip: Clip, fps: float) -> Array:
    """Return a clip's poses `[T, 6 n]`, float32, at a rate. Raises PoseError for another skeleton's clip."""
    if clip.skeleton != rig.skeleton:
        raise PoseError(f"'{clip.name}' has another skeleton: retarget it, or leave it out")
    return encode_rotations(rig, resample_rotations(clip, fps))


@dataclass(frozen=True, eq=False)
class Standardisation:
    """What standardises numbers: their means and deviations `[X]`, float32."""

    mean: Array
    deviation: Array

    def apply(self, numbers: Array) -> Array:
        """Return numbers `[..., X]` standardised, float32."""
        return np.asarray((numbers - self.mean) / self.deviation, np.float32)

    def undo(self, numbers: Array) -> Array:
        """Return numbers of standardised ones `[..., X]`, none further than FURTHEST."""
        return np.asarray(np.clip(numbers, -FURTHEST, FURTHEST) * self.deviation + self.mean, np.float32)


def scale_of(rows: Array, least: float = LEAST) -> Standardisation:
    """Return means and deviations of rows `[T, X]`; deviations are at least `least`."""
    if not len(rows):
        raise PoseError("there is nothing to take means of")
    rows = np.asarray(rows, np.float64)
    deviation = np.maximum(rows.std(0), least)
    return Standardisation(rows.mean(0).astype(np.float32), deviation.astype(np.float32))
