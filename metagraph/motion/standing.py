"""How a figure stands: the pose that turns are computed from, its measures, and what brings one figure's
standing pose to another's.

All is in the character's axes: +X to its left, +Y up, +Z ahead.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.motion.joint_map import ARM, FINGERS, LEG, NEEDED, SIDES, TRUNK
from metagraph.motion.roles import find_roles
from metagraph.motion.skeleton import Pose, Skeleton

Array = NDArray[Any]

BACKWARD = np.radians(
    100
)  # a neck or spine turned further than this in every frame does not start from its rest pose


def is_standing(skeleton: Skeleton, roles: Mapping[str, int] | None = None) -> bool:
    """Whether the rest pose is a standing figure. In some files all bones lie along one axis, and only the
    motion stands up.
    """
    roles = find_roles(skeleton) if roles is None else roles
    _, p = skeleton.globals(skeleton.rest)
    return all(r in roles for r in NEEDED) and bool(_upright(p[None], roles)[0] > 0.5)


def _upright(p: Array, roles: Mapping[str, int]) -> Array:
    """Return `[F]` how upright figures are, -1..1: the least of trunk and legs."""
    lines = [p[:, roles["head"]] - p[:, roles["hips"]]]
    lines += [p[:, roles[f"{side}_upper_leg"]] - p[:, roles[f"{side}_foot"]] for side in SIDES]
    return np.asarray(np.min([v[:, 1] / np.maximum(np.linalg.norm(v, axis=-1), 1e-6) for v in lines], 0))


def find_standing_pose(clip: Clip, roles: Mapping[str, int] | None = None) -> Pose:
    """Return the rest pose where it stands and looks ahead, else the clip's frame that stands best: upright,
    limbs straight, feet down.

    Some files rest with every bone along one axis, or with the head back to front; their motion tells.
    """
    skeleton = clip.skeleton
    roles = find_roles(skeleton) if roles is None else roles
    if not all(r in roles for r in NEEDED):
        return skeleton.rest
    if is_standing(skeleton, roles):
        trunk = [roles[r] for r in TRUNK[1:] if r in roles]
        turned = rotation.measure_angle_between(
            clip.rotations[:, trunk], skeleton.rest_rotations[trunk].astype(np.float32)
        ).min(0)
        return _faced(skeleton, [j for j, angle in zip(trunk, turned, strict=True) if angle > BACKWARD])
    poses = clip.poses()
    _, p = skeleton.globals(poses)
    worth = 2 * _upright(p, roles)
    for side in SIDES:
        for upper, lower, end in (ARM, LEG):
            a, b, c = (p[:, roles[f"{side}_{part}"]] for part in (upper, lower, end))
            length = np.linalg.norm(b - a, axis=-1) + np.linalg.norm(c - b, axis=-1)
            worth = worth + np.linalg.norm(c - a, axis=-1) / np.maximum(length, 1e-6)
    feet = p[:, [roles["left_foot"], roles["right_foot"]], 1]
    worth = worth - np.ptp(feet, axis=1) / skeleton.height
    best = int(np.argmax(worth))
    return Pose(poses.rotations[best].astype(np.float64), poses.translations[best].astype(np.float64))


def _faced(skeleton: Skeleton, joints: Sequence[int]) -> Pose:
    """Return the rest pose with `joints` turned about the vertical by half a turn."""
    if not joints:
        return skeleton.rest
    model, _ = skeleton.globals(skeleton.rest)
    local = skeleton.rest_rotations.copy()
    for j in joints:
        above = model[skeleton.parents[j]]
        local[j] = rotation.multiply(
            rotation.conjugate(above), rotation.multiply(np.array([0, 1.0, 0, 0]), model[j])
        )
        model, _ = skeleton.globals(Pose(local, skeleton.rest_translations))
    return Pose(local, skeleton.rest_translations)


class StandingFigure:
    """A skeleton in its standing pose, in the character's axes, by role. `ankle` is the ankles' height when
    it stands on the ground.
    """

    def __init__(self, skeleton: Skeleton, roles: Mapping[str, int], pose: Pose) -> None:
        self.skeleton, self.roles, self.pose = skeleton, roles, pose
        rotations, positions = skeleton.globals(pose)
        across = sum(
            positions[roles[f"left_{r}"]] - positions[roles[f"right_{r}"]] for r in ("upper_leg", "upper_arm")
        )
        limbs = [roles[f"{s}_{part}"] for s in SIDES for part in (*ARM, *LEG)]
        self.natural = bool(
            (rotation.measure_angle_between(pose.rotations, skeleton.rest_rotations)[limbs] < 1e-3).all()
        ) and is_standing(skeleton, roles)
        # Axes are those of the file, turned by quarters: a figure that looks a little aside does look aside.
        quarter = np.round(np.arctan2(across[2], across[0]) / (np.pi / 2)) * np.pi / 2
        self.turn = rotation.from_axis_angle(np.array([0, 1.0, 0]), quarter)
        self.rotations, self.positions = (
            rotation.multiply(self.turn, rotations),
            rotation.rotate_vectors(self.turn, positions),
        )
        self.leg = float(
            np.mean([self.length(f"{s}_upper_leg", f"{s}_lower_leg", f"{s}_foot") for s in SIDES])
        )
        self.arm = float(
            np.mean([self.length(f"{s}_upper_arm", f"{s}_lower_arm", f"{s}_hand") for s in SIDES])
        )
        self.hip = self.middle("upper_leg")
        self.ankle = float(self.middle("foot")[1])
        self.half_hips, self.half_shoulders = self.half("upper_leg"), self.half("upper_arm")

    def at(self, role: str) -> Array:
        return np.asarray(self.positions[self.roles[role]])

    def middle(self, part: str) -> Array:
        return np.asarray((self.at(f"left_{part}") + self.at(f"right_{part}")) / 2)

    def half(self, part: str) -> float:
        return max(1e-3, float(np.linalg.norm(self.at(f"left_{part}") - self.at(f"right_{part}"))) / 2)

    def length(self, *roles: str) -> float:
        return max(1e-3, sum(float(np.linalg.norm(self.at(a) - self.at(b))) for a, b in pairwise(roles)))

    def frame(self) -> Array:
        """Return the turn of the trunk: its own left, up and ahead."""
        up = self.at("head") - self.at("hips")
        left = self.at("left_upper_leg") - self.at("right_upper_leg")
        return _turn_of(up, left)


def _turn_of(first: Array, second: Array) -> Array:
    """Return the turn `[4]` whose Y lies along `first` and whose X as near as can be along `second`."""
    y = first / np.linalg.norm(first)
    x = second - y * (second @ y)
    x = x / max(1e-9, float(np.linalg.norm(x)))
    return rotation.from_matrix(np.stack([x, y, np.cross(x, y)], -1))


def align_standing(source: StandingFigure, target: StandingFigure, roles: Sequence[str]) -> dict[str, Array]:
    """Return for each role the turn `[4]` that brings the target's standing pose to the source's."""
    level = rotation.IDENTITY
    if not (source.natural and target.natural):
        level = rotation.multiply(source.frame(), rotation.conjugate(target.frame()))
    known = set(roles)
    out: dict[str, Array] = dict.fromkeys(roles, level)

    def bone(figure: StandingFigure, role: str, *tips: str) -> Array:
        return np.asarray(np.mean([figure.at(t) for t in tips], 0) - figure.at(role))

    def follow(role: str, before: Array, *tips: str) -> Array:
        tips = tuple(t for t in tips if t in known)
        out[role] = before
        if tips:
            wanted, own = bone(source, role, *tips), bone(target, role, *tips)
            if min(np.linalg.norm(wanted), np.linalg.norm(own)) > 1e-4:
                out[role] = rotation.multiply(
                    rotation.find_rotation_between(rotation.rotate_vectors(before, own), wanted), before
                )
        return out[role]

    for side in SIDES:
        turn = level
        for (upper, lower, end), ahead in ((ARM, False), (LEG, True)):
            turn = follow(f"{side}_{upper}", level, f"{side}_{lower}")
            turn = follow(f"{side}_{lower}", turn, f"{side}_{end}")
            if ahead:
                out[f"{side}_foot"] = _heading(source, target, side) if f"{side}_toes" in known else level
                out[f"{side}_toes"] = out[f"{side}_foot"]
                continue
            knuckles = [f"{side}_{f}_1" for f in FINGERS[1:] if f"{side}_{f}_1" in known]
            turn = follow(f"{side}_{end}", turn, *knuckles)
            if len(knuckles) > 1:
                a, b = (
                    _turn_of(bone(f, f"{side}_{end}", *knuckles), f.at(knuckles[0]) - f.at(knuckles[-1]))
                    for f in (source, target)
                )
                turn = out[f"{side}_{end}"] = rotation.multiply(a, rotation.conjugate(b))
            for finger in FINGERS:
                hand = turn
                for n in (1, 2, 3):
                    if f"{side}_{finger}_{n}" in known:
                        hand = follow(f"{side}_{finger}_{n}", hand, f"{side}_{finger}_{n + 1}")
    for role in roles:
        if "_twist_" in role:
            out[role] = out[role.split("_twist_")[0]]
    return out


def _heading(source: StandingFigure, target: StandingFigure, side: str) -> Array:
    """Return the turn about the vertical from where the target's foot points to where the source's does;
    soles stay flat.
    """
    angles = []
    for figure in (source, target):
        ahead = figure.at(f"{side}_toes") - figure.at(f"{side}_foot")
        if np.hypot(ahead[0], ahead[2]) < 1e-3:
            return rotation.IDENTITY
        angles.append(np.arctan2(ahead[0], ahead[2]))
    return rotation.from_axis_angle(np.array([0, 1.0, 0]), angles[0] - angles[1])
