"""Bring a clip onto a different character: turns carried over, hands and feet kept on height.

Turns are taken relative to a standing pose of either figure, mostly the rest pose. Where these differ (arms
out, arms down) the bones' directions reconcile them; the roll about a bone is the one the shortest way
between them leaves, and hands with fingers have their own. Then two-bone limbs are solved, so that wrists and
ankles come to the source's places, scaled. All is reckoned in the character's axes: +X to its left, +Y up, +Z
ahead.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.motion.joint_map import (
    ARM,
    FINGERS,
    LEG,
    NEEDED,
    SIDES,
    TRUNK,
    JointMap,
    JointPair,
    RetargetError,
    fingerprint,
)
from metagraph.motion.roles import find_roles
from metagraph.motion.skeleton import Pose, Skeleton

Array = NDArray[Any]

MOVED = 1e-4  # metres: below this a joint keeps its rest translation
BACKWARD = np.radians(
    100
)  # a neck or spine turned further than this in every frame does not start from its rest pose
LOWEST = 0.25  # of the leg: how far hips may be lowered so that legs of other proportions reach
STRAIGHT = (
    0.9  # of the arm: from here on it stretches ever less for a place that only wider shoulders put so far
)
ASIDE = np.radians(50)  # how far at most a foot turned from the hips' heading is followed in setting it apart
UPTURNED, LIFTED = 0.5, 0.3  # 1 - cosine of the sole's tilt, and of the leg: from there a foot bears no weight
# Beside the trunk, of the left side: directions whose opposites no hand and no foot comes near.
OUTWARDS = {"upper_arm": np.array([0.6, -0.3, 0.75]), "upper_leg": np.array([0.0, -1, 0])}
FLOATING = 0.25  # of the leg: a rest pose this far off the ground is not standing on it


# --- standing poses


def stands(skeleton: Skeleton, roles: Mapping[str, int] | None = None) -> bool:
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


def standing_pose(clip: Clip, roles: Mapping[str, int] | None = None) -> Pose:
    """Return the rest pose where it stands and looks ahead, else the clip's frame that stands best: upright,
    limbs straight, feet down.

    Some files rest with every bone along one axis, or with the head back to front; their motion tells.
    """
    skeleton = clip.skeleton
    roles = find_roles(skeleton) if roles is None else roles
    if not all(r in roles for r in NEEDED):
        return skeleton.rest
    if stands(skeleton, roles):
        trunk = [roles[r] for r in TRUNK[1:] if r in roles]
        turned = rotation.angle_between(
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


class _Figure:
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
            (rotation.angle_between(pose.rotations, skeleton.rest_rotations)[limbs] < 1e-3).all()
        ) and stands(skeleton, roles)
        # Axes are those of the file, turned by quarters: a figure that looks a little aside does look aside.
        quarter = np.round(np.arctan2(across[2], across[0]) / (np.pi / 2)) * np.pi / 2
        self.turn = rotation.from_axis_angle(np.array([0, 1.0, 0]), quarter)
        self.rotations, self.positions = (
            rotation.multiply(self.turn, rotations),
            rotation.rotate(self.turn, positions),
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


def _aligned(source: _Figure, target: _Figure, roles: Sequence[str]) -> dict[str, Array]:
    """Return for each role the turn `[4]` that brings the target's standing pose to the source's."""
    level = rotation.IDENTITY
    if not (source.natural and target.natural):
        level = rotation.multiply(source.frame(), rotation.conjugate(target.frame()))
    known = set(roles)
    out: dict[str, Array] = dict.fromkeys(roles, level)

    def bone(figure: _Figure, role: str, *tips: str) -> Array:
        return np.asarray(np.mean([figure.at(t) for t in tips], 0) - figure.at(role))

    def follow(role: str, before: Array, *tips: str) -> Array:
        tips = tuple(t for t in tips if t in known)
        out[role] = before
        if tips:
            wanted, own = bone(source, role, *tips), bone(target, role, *tips)
            if min(np.linalg.norm(wanted), np.linalg.norm(own)) > 1e-4:
                out[role] = rotation.multiply(rotation.between(rotation.rotate(before, own), wanted), before)
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


def _heading(source: _Figure, target: _Figure, side: str) -> Array:
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


# --- the motion


def retarget(
    clip: Clip,
    target: Skeleton,
    joint_map: JointMap,
    *,
    source_pose: Pose | None = None,
    target_pose: Pose | None = None,
) -> Clip:
    """Return the clip on `target`. Joints that nothing maps to keep their rest pose and follow their parents.

    source_pose, target_pose: standing poses to take turns from, by default the rest poses (for a source whose
    rest pose does not stand, the frame that does). Hips and feet are scaled by the legs' length, so planted
    feet stay planted; wrists by the arms'. Raises RetargetError when too little is mapped.
    """
    roles = _checked(clip, target, joint_map)
    ours = {role: clip.skeleton.index(pair.source) for role, pair in roles.items()}
    theirs = {role: target.index(pair.target) for role, pair in roles.items()}
    if target_pose is None and not stands(target, theirs):
        raise RetargetError(
            f"'{clip.name}': the rest pose of the project's skeleton does not stand; give a pose of it that "
            "does"
        )
    source = _Figure(clip.skeleton, ours, standing_pose(clip, ours) if source_pose is None else source_pose)
    figure = _Figure(target, theirs, target.rest if target_pose is None else target_pose)
    work = _Work(clip, source, figure, joint_map, roles)
    work.turn_joints()
    work.move_hips()
    for side in SIDES:
        work.reach([f"{side}_{part}" for part in LEG], work.foot_goal(side), np.array([0, 0, 1.0]))
        work.reach_hand(side)
    return work.finished()


def _checked(clip: Clip, target: Skeleton, joint_map: JointMap) -> dict[str, JointPair]:
    """Return the map's pairs by role. Raises RetargetError."""
    for pair in joint_map.pairs:
        for name, skeleton, whose in ((pair.source, clip.skeleton, "clip"), (pair.target, target, "project")):
            if name not in skeleton:
                raise RetargetError(
                    f"'{clip.name}': the joint map names '{name}', which the {whose}'s skeleton does not have"
                )
    missing = joint_map.missing
    if missing:
        more = f" and {len(missing) - 3} more" if len(missing) > 3 else ""
        raise RetargetError(
            f"'{clip.name}' cannot be brought onto this character: {', '.join(missing[:3])}{more}"
        )
    return {pair.role: pair for pair in joint_map.pairs if pair.role}


class _Work:
    """One clip on its way: `turns [F, J, 4]` and `places [F, J, 3]` of the target's joints in the character's
    axes.
    """

    def __init__(
        self,
        clip: Clip,
        source: _Figure,
        target: _Figure,
        joint_map: JointMap,
        roles: Mapping[str, JointPair],
    ) -> None:
        self.clip, self.source, self.target, self.map, self.roles = clip, source, target, joint_map, roles
        turns, places = clip.skeleton.globals(clip.poses())
        self.from_turns = rotation.multiply(source.turn.astype(np.float32), turns)
        self.from_places = rotation.rotate(source.turn.astype(np.float32), places)
        self.align = _aligned(source, target, list(roles))
        self.level = rotation.IDENTITY if source.natural and target.natural else source.frame()
        self.chest = next(r for r in ("upper_chest", "chest", "spine", "hips") if r in roles)
        self.scale = target.leg / source.leg
        self.parents = self._parents()
        self.levels = _levels(self.parents)
        inner = self.parents >= 0
        above = np.where(inner, self.parents, 0)
        back = np.where(inner[:, None], rotation.conjugate(target.rotations[above]), rotation.IDENTITY)
        self.local_r = rotation.multiply(back, target.rotations).astype(np.float32)
        offset = np.where(inner[:, None], target.positions - target.positions[above], target.positions)
        offset = rotation.rotate(back, offset).astype(np.float32)
        self.local_t = np.broadcast_to(offset, (clip.frames, len(above), 3)).copy()
        self.shifted: set[int] = set()
        self.turns = np.empty((clip.frames, len(above), 4), np.float32)
        self.places = np.empty((clip.frames, len(above), 3), np.float32)
        self.ground()

    def _parents(self) -> Array:
        """Return the target's parents, with limbs that its file keeps apart (IK feet, several roots) hung on
        the body.
        """
        skeleton, roles = self.target.skeleton, self.target.roles
        parents = np.array(skeleton.parents)
        for side in SIDES:
            chains = (
                (f"{side}_upper_leg", "hips"),
                (f"{side}_lower_leg", f"{side}_upper_leg"),
                (f"{side}_foot", f"{side}_lower_leg"),
            )
            arms = (
                (f"{side}_upper_arm", "hips"),
                (f"{side}_lower_arm", f"{side}_upper_arm"),
                (f"{side}_hand", f"{side}_lower_arm"),
            )
            for role, over in (*chains, *arms):
                joint, wanted = roles[role], roles[over]
                if wanted not in skeleton.chain(joint) and joint not in skeleton.chain(wanted):
                    parents[joint] = (
                        wanted
                        if not role.endswith("upper_arm")
                        else roles.get("upper_chest", roles.get("spine", wanted))
                    )
        return parents

    def ground(self) -> None:
        """Find the ankles' heights that correspond: those of figures standing on the ground, whatever height
        a rest pose has.
        """
        ankles = self.from_places[:, [self.source.roles["left_foot"], self.source.roles["right_foot"]], 1]
        self.from_ankle = self.source.ankle
        if self.source.natural and abs(float(ankles.min()) - self.from_ankle) > FLOATING * self.source.leg:
            low = self.source.positions[:, 1].min()  # the rest pose floats or hangs: stand it on the ground
            self.from_ankle -= float(low)
        self.to_ankle = self.target.ankle
        low = float(self.target.positions[:, 1].min())
        if self.target.natural and abs(low) > FLOATING * self.target.leg:
            self.to_ankle -= low

    def turn_joints(self) -> None:
        """Carry the turns of mapped joints over, spread them on joints between those of the trunk, let the
        others follow.
        """
        source, target = self.source.skeleton, self.target.skeleton
        a = np.array([source.index(p.source) for p in self.map.pairs])
        b = np.array([target.index(p.target) for p in self.map.pairs])
        align = np.array([self.align.get(p.role, rotation.IDENTITY) for p in self.map.pairs])
        fixed = rotation.multiply(
            rotation.multiply(rotation.conjugate(self.source.rotations[a]), align), self.target.rotations[b]
        )
        given = rotation.multiply(self.from_turns[:, a], fixed.astype(np.float32))
        self.given = np.zeros(len(target), bool)
        self.given[b] = True
        self.turns[:, b] = given
        line = [self.target.roles[r] for r in TRUNK if r in self.target.roles]
        for low, high in pairwise(line):
            chain = target.chain(high)
            between = (
                [j for j in chain[chain.index(low) + 1 : -1] if not self.given[j]] if low in chain else []
            )
            first = rotation.multiply(
                self.turns[:, low], rotation.conjugate(self.target.rotations[low]).astype(np.float32)
            )
            last = rotation.multiply(
                self.turns[:, high], rotation.conjugate(self.target.rotations[high]).astype(np.float32)
            )
            for n, joint in enumerate(between, 1):
                part = rotation.slerp(first, last, np.float32(n / (len(between) + 1)))
                self.turns[:, joint] = rotation.multiply(
                    part, self.target.rotations[joint].astype(np.float32)
                )
                self.given[joint] = True
        self.shift_named()
        self.walk()

    def shift_named(self) -> None:
        """Carry over what joints paired by name are shifted by, as faces are, scaled by the characters'
        heights.
        """
        moved = {self.clip.skeleton.names[j]: j for j in self.clip.translated}
        scale = self.target.skeleton.height / self.source.skeleton.height
        poses = None
        for pair in self.map.pairs:
            if pair.role or pair.source not in moved:
                continue
            a, b = moved[pair.source], self.target.skeleton.index(pair.target)
            above, over = int(self.clip.skeleton.parents[a]), int(self.parents[b])
            if above < 0 or over < 0:
                continue
            if poses is None:
                poses = self.clip.poses()
            shift = poses.translations[:, a] - self.clip.skeleton.rest_translations[a]
            turn = rotation.multiply(
                rotation.conjugate(self.target.rotations[over]), self.source.rotations[above]
            )
            self.shifted.add(b)
            self.local_t[:, b] += scale * rotation.rotate(turn.astype(np.float32), shift)

    def walk(self) -> None:
        """Forward kinematics: the turns of joints that are not given, and all places."""
        for depth, joints in enumerate(self.levels):
            if depth == 0:
                free = joints[~self.given[joints]]
                self.turns[:, free] = self.local_r[free]
                self.places[:, joints] = self.local_t[:, joints]
                continue
            above = self.parents[joints]
            free = joints[~self.given[joints]]
            self.turns[:, free] = rotation.multiply(self.turns[:, self.parents[free]], self.local_r[free])
            self.places[:, joints] = self.places[:, above] + rotation.rotate(
                self.turns[:, above], self.local_t[:, joints]
            )

    def placed(self, points: Array) -> Array:
        """Return where places `[F, 3]` near the source's legs come to: scaled, the ankles of a standing
        figure on the ground.
        """
        origin = np.array([self.source.hip[0], self.from_ankle, self.source.hip[2]], np.float32)
        goal = np.array([self.target.hip[0], self.to_ankle, self.target.hip[2]], np.float32)
        return np.asarray(goal + np.float32(self.scale) * (points - origin))

    def move_hips(self) -> None:
        """Put hips (and a root above them) where the source's are, scaled by leg length, as low as both legs
        need to reach.
        """
        source, target = self.source.roles, self.target.roles
        if "root" in self.roles:
            root, above = target["root"], source["root"]
            way = self.from_places[:, above] - self.source.positions[above].astype(np.float32)
            self.local_t[:, root] = self.target.positions[root] + self.scale * way
            self.walk()
        legs, ours = ([roles[f"{side}_upper_leg"] for side in SIDES] for roles in (source, target))
        shift = self.placed(self.from_places[:, legs].mean(1)) - self.places[:, ours].mean(1)
        drop = np.zeros(self.clip.frames)
        for side, joint in zip(SIDES, ours, strict=True):
            away = self.foot_goal(side) - self.places[:, joint] - shift
            length = self.target.length(*(f"{side}_{part}" for part in LEG))
            room = np.sqrt(np.maximum(0, length**2 - away[:, 0] ** 2 - away[:, 2] ** 2))
            drop = np.maximum(drop, -away[:, 1] - room)
        hips = target["hips"]
        goal = self.places[:, hips] + shift
        goal[:, 1] -= np.minimum(drop, LOWEST * self.target.leg)
        above = int(self.parents[hips])
        if above >= 0:
            goal = rotation.rotate(rotation.conjugate(self.turns[:, above]), goal - self.places[:, above])
        self.local_t[:, hips] = goal
        self.walk()

    def foot_goal(self, side: str) -> Array:
        """Return where an ankle goes, `[F, 3]`. Wider hips set it further out: a foot flat on the ground as it
        points, so that it stays there while the hips turn; any other with the hips, as the leg itself goes.
        """
        above, legs = self.source.roles[f"{side}_foot"], [self.source.roles[f"{s}_upper_leg"] for s in SIDES]
        wide = (1 if side == "left" else -1) * (self.target.half_hips - self.scale * self.source.half_hips)
        # Halfway between how either stands with toes out: the same way there and back.
        half = rotation.power(self.align[f"{side}_foot"], 0.5)
        turned = rotation.multiply(
            self.from_turns[:, above],
            rotation.multiply(rotation.conjugate(self.source.rotations[above]), half).astype(np.float32),
        )
        hips = self.from_places[:, legs[0]] - self.from_places[:, legs[1]]
        hips = hips / np.maximum(np.linalg.norm(hips, axis=-1, keepdims=True), 1e-9)
        body, foot = np.arctan2(-hips[:, 2], hips[:, 0]), 2 * np.arctan2(turned[:, 1], turned[:, 3])
        aside = (foot - body + np.pi) % (2 * np.pi) - np.pi
        heading = body + np.sign(aside) * ASIDE * _eased(np.abs(aside) / ASIDE, np.full(len(aside), 0.6))
        flat = np.stack([np.cos(heading), 0 * heading, -np.sin(heading)], -1)
        tilt = 1 - 2 * (turned[:, 0] ** 2 + turned[:, 2] ** 2)  # of the sole: 1 flat, 0 upright
        high = np.abs(self.from_places[:, above, 1] - self.from_ankle) / self.source.leg
        planted = (_faded((1 - tilt) / UPTURNED) * _faded(high / LIFTED))[:, None]
        out = planted * flat + (1 - planted) * hips * [1, 0, 1]  # an ankle keeps its height
        return self.placed(self.from_places[:, above]) + np.float32(wide) * out.astype(np.float32)

    def reach_hand(self, side: str) -> None:
        """Bring a wrist where it was from its shoulder, scaled by arm length; towards the middle by the
        shoulders' width.
        """
        upper, hand = self.source.roles[f"{side}_upper_arm"], self.source.roles[f"{side}_hand"]
        arm = [f"{side}_{part}" for part in ARM]
        scale, sign = self.target.length(*arm) / self.source.length(*arm), 1 if side == "left" else -1
        away = self.from_places[:, hand] - self.from_places[:, upper]
        joint = self.source.roles[self.chest]
        turned = rotation.multiply(
            self.from_turns[:, joint], rotation.conjugate(self.source.rotations[joint]).astype(np.float32)
        )
        level = rotation.rotate(turned, np.array([1, 0, 0], np.float32)) * np.array([1, 0, 1], np.float32)
        length = np.linalg.norm(level, axis=-1, keepdims=True)
        level = level / np.maximum(length, 0.3)
        from_half, to_half = self.source.half_shoulders, self.target.half_shoulders
        out = sign * np.einsum("fi,fi->f", away, level) + from_half
        inside = np.clip(out, -from_half, from_half)
        extra = (to_half / from_half - scale) * (inside - from_half)
        away, inwards = scale * away, (sign * extra)[:, None] * level
        # As far inwards as the arm is long enough for: a hand that cannot come to the middle stays in front.
        length = self.target.length(*(f"{side}_{part}" for part in ARM))
        free = np.maximum(np.linalg.norm(away, axis=-1) / length, STRAIGHT)
        reach = _eased(np.linalg.norm(away + inwards, axis=-1) / length, free) * length
        room = reach**2 - np.einsum("fi,fi->f", away, away)
        along, square = (
            np.einsum("fi,fi->f", away, inwards),
            np.maximum(np.einsum("fi,fi->f", inwards, inwards), 1e-12),
        )
        most = np.clip(
            (np.sqrt(np.maximum(0, along**2 + square * np.maximum(0, room))) - along) / square, 0, 1
        )
        goal = self.places[:, self.target.roles[f"{side}_upper_arm"]] + away + most[:, None] * inwards
        self.reach([f"{side}_{part}" for part in ARM], goal, np.array([0, 0, -1.0]))

    def reach(self, names: Sequence[str], goal: Array, side: Array) -> None:
        """Turn the two bones of a limb so that its end comes to `goal [F, 3]`, bending where it bends, or
        towards `side` when straight.
        """
        upper, lower, end = (self.target.roles[name] for name in names)
        root = self.places[:, upper].astype(np.float64)
        knee, tip = self.places[:, lower] - root, self.places[:, end] - root
        one = float(np.linalg.norm(self.target.positions[lower] - self.target.positions[upper]))
        two = float(np.linalg.norm(self.target.positions[end] - self.target.positions[lower]))
        goal = _within(goal - root, abs(one - two) + 1e-3 * (one + two), one + two)
        far = np.linalg.norm(goal, axis=-1, keepdims=True)
        ahead = goal / far
        bent = self.bend(names, ahead)
        joint = self.source.roles[names[0]]
        turned = rotation.multiply(
            self.from_turns[:, joint].astype(np.float64), rotation.conjugate(self.source.rotations[joint])
        )
        pole = rotation.rotate(turned, side)
        pole = pole - ahead * np.einsum("fi,fi->f", pole, ahead)[:, None]
        straight = np.maximum(0, 0.02 - np.linalg.norm(bent, axis=-1, keepdims=True))
        bent = bent + straight * pole
        bent = bent / np.maximum(np.linalg.norm(bent, axis=-1, keepdims=True), 1e-9)
        along = (one**2 + far**2 - two**2) / (2 * far)
        new = ahead * along + bent * np.sqrt(np.maximum(0, one**2 - along**2))
        self.turns[:, upper] = rotation.multiply(rotation.between(knee, new), self.turns[:, upper])
        self.turns[:, lower] = rotation.multiply(
            rotation.between(tip - knee, goal - new), self.turns[:, lower]
        )

    def bend(self, names: Sequence[str], ahead: Array) -> Array:
        """Return where a limb bends to, `[F, 3]` square to its new direction `ahead [F, 3]`, in lengths of its
        upper bone: turned about that direction as the source's is about its own, beside the trunk.

        The turn about a direction is reckoned from where the shortest way from OUTWARDS brings it, so that it
        is the same there and back.
        """
        trunk = "hips" if names[0].endswith("leg") else self.chest
        upper, lower, end = (self.from_places[:, self.source.roles[n]].astype(np.float64) for n in names)
        joint = self.source.roles[trunk]
        turned = rotation.multiply(
            self.from_turns[:, joint].astype(np.float64),
            rotation.multiply(rotation.conjugate(self.source.rotations[joint]), self.level),
        )
        sign = np.array([1.0 if names[0].startswith("left") else -1.0, 1, 1])
        start = rotation.rotate(turned, sign * OUTWARDS[names[0].split("_", 1)[1]])
        way = end - upper
        way = way / np.maximum(np.linalg.norm(way, axis=-1, keepdims=True), 1e-9)
        knee = lower - upper
        knee = knee / np.maximum(np.linalg.norm(knee, axis=-1, keepdims=True), 1e-9)
        knee = knee - way * np.einsum("fi,fi->f", knee, way)[:, None]
        back = rotation.conjugate(rotation.between(start, way))
        return rotation.rotate(rotation.between(start, ahead), rotation.rotate(back, knee))

    def finished(self) -> Clip:
        """Return the clip in the target's own hierarchy and axes."""
        self.walk()
        target, figure = self.target.skeleton, self.target
        back = rotation.conjugate(figure.turn).astype(np.float32)
        inner = np.flatnonzero(target.parents >= 0)
        above = target.parents[inner]
        rotations = rotation.multiply(back, self.turns)
        over = rotation.conjugate(rotations[:, above])
        rotations[:, inner] = rotation.multiply(over, rotations[:, inner])
        stay = np.abs(figure.pose.translations - target.rest_translations).max(-1) < MOVED
        may = {
            0,
            figure.roles["hips"],
            *self.shifted,
            *np.flatnonzero(~stay),
            *np.flatnonzero(self.parents != target.parents),
        }
        joints = sorted(int(j) for j in may)
        places = rotation.rotate(back, self.places)
        moves = places[:, joints]
        for n, joint in enumerate(joints):
            parent = int(target.parents[joint])
            if parent >= 0:
                turn = rotation.conjugate(rotation.multiply(back, self.turns[:, parent]))
                moves[:, n] = rotation.rotate(turn, moves[:, n] - places[:, parent])
        kept = [
            n
            for n, j in enumerate(joints)
            if j == 0 or np.abs(moves[:, n] - target.rest_translations[j]).max() > MOVED
        ]
        idle = sum(1 for j in range(len(target)) if not self.given[j])
        note = (
            f"brought over from a skeleton of {len(self.clip.skeleton)} joints: {len(self.map.pairs)} "
            "are "
            "mapped"
        )
        return replace(
            self.clip,
            skeleton=target,
            rotations=rotation.continuous(rotation.normalize(rotations)),
            translations=moves[:, kept],
            translated=tuple(joints[n] for n in kept),
            notes=(*self.clip.notes, note + (f", {idle} follow their parents" if idle else "")),
            brought_from=fingerprint(self.clip.skeleton),
        )


def _levels(parents: Array) -> list[Array]:
    """Return joints by depth, for parents in any order."""
    depth = np.zeros(len(parents), int)
    for joint in range(len(parents)):
        above = int(parents[joint])
        while above >= 0:
            depth[joint] += 1
            above = int(parents[above])
    return [np.flatnonzero(depth == d) for d in range(depth.max() + 1)]


def _eased(reach: Array, free: Array) -> Array:
    """Return `reach [F]`, of a limb's length, slowed down from `free` on so that it never quite gets to 1: no
    elbow snaps straight.
    """
    left = np.maximum(1 - free, 1e-6)
    return np.where(reach > free, free + left * (1 - np.exp(-np.maximum(0, reach - free) / left)), reach)


def _faded(amount: Array) -> Array:
    """Return 1 for `amount` up to 0.5, 0 from 1 on, smoothly less between."""
    x = np.clip(2 - 2 * amount, 0, 1)
    return np.asarray(x * x * (3 - 2 * x))


def _within(goal: Array, least: float, most: float) -> Array:
    """Return `[F, 3]` moved into reach sideways, so that the height stays."""
    goal = goal.copy()
    goal[:, 1] = np.clip(goal[:, 1], -most, most)
    flat = np.linalg.norm(goal[:, [0, 2]], axis=-1)
    room = np.sqrt(np.maximum(0, most**2 - goal[:, 1] ** 2))
    goal[:, [0, 2]] *= np.minimum(1, room / np.maximum(flat, 1e-9))[:, None]
    flat = np.linalg.norm(goal[:, [0, 2]], axis=-1)
    goal[flat < 1e-6, 2] = flat[flat < 1e-6] = 1e-6  # straight above or below: out to the front
    out = np.sqrt(np.maximum(0, least**2 - goal[:, 1] ** 2))
    goal[:, [0, 2]] *= np.maximum(1, out / flat)[:, None]
    return goal
