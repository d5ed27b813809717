"""Retarget a clip onto a different character: turns are carried over, hands and feet stay at their height.

Turns are relative to a standing pose of either figure, usually the rest pose. Where these poses differ (arms
out, arms down), the bones' directions align them; the roll about a bone is the one that the shortest rotation
between them leaves, and hands with fingers have their own. Then two-bone limbs are solved, so that wrists and
ankles reach the source's positions, scaled. All computation is in the character's axes: +X to its left, +Y
up, +Z ahead.
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
    LEG,
    SIDES,
    TRUNK,
    JointMap,
    JointPair,
    RetargetError,
    make_fingerprint,
)
from metagraph.motion.limb_goals import LimbGoals
from metagraph.motion.limbs import solve_limb
from metagraph.motion.own_contact import OwnContact, meet
from metagraph.motion.skeleton import Pose, Skeleton
from metagraph.motion.standing import StandingFigure, find_standing_pose, is_standing

Array = NDArray[Any]

MOVED = 1e-4  # metres: below this a joint keeps its rest translation
LOWEST = 0.25  # of the leg: how far hips may be lowered so that legs of other proportions reach
BACKWARDS = np.array([0, 0, -1.0])  # the direction in which straight arms bend


def retarget(
    clip: Clip,
    target: Skeleton,
    joint_map: JointMap,
    *,
    source_pose: Pose | None = None,
    target_pose: Pose | None = None,
) -> Clip:
    """Return the clip on `target`. Joints that nothing is mapped to keep their rest pose and follow their
    parents.

    `source_pose` and `target_pose` are standing poses that turns are relative to, by default the rest poses;
    for a source whose rest pose does not stand, the frame that does. Hips and feet are scaled by the legs'
    length, so planted feet stay planted; wrists by the arms' length. Raises RetargetError if too little is
    mapped.
    """
    roles = _checked(clip, target, joint_map)
    ours = {role: clip.skeleton.index(pair.source) for role, pair in roles.items()}
    theirs = {role: target.index(pair.target) for role, pair in roles.items()}
    if target_pose is None and not is_standing(target, theirs):
        raise RetargetError(
            f"'{clip.name}': the rest pose of the project's skeleton does not stand; give a pose of it that "
            "does"
        )
    source = StandingFigure(
        clip.skeleton, ours, find_standing_pose(clip, ours) if source_pose is None else source_pose
    )
    figure = StandingFigure(target, theirs, target.rest if target_pose is None else target_pose)
    work = _Work(clip, source, figure, joint_map, roles)
    work.turn_joints()
    work.move_hips()
    for side in SIDES:
        work.reach([f"{side}_{part}" for part in LEG], work.foot_goal(side), np.array([0, 0, 1.0]))
        arm = [f"{side}_{part}" for part in ARM]
        work.reach(arm, work.places[:, work.target.roles[arm[0]]] + work.hand_goal(side), BACKWARDS)
    if joint_map.contacts:
        work.meet()
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


class _Work(LimbGoals):
    """A clip that is being retargeted: `turns [F, J, 4]` and `places [F, J, 3]` of the target's joints in the
    character's axes.
    """

    def __init__(
        self,
        clip: Clip,
        source: StandingFigure,
        target: StandingFigure,
        joint_map: JointMap,
        roles: Mapping[str, JointPair],
    ) -> None:
        super().__init__(clip, source, target, list(roles))
        self.map, self.roles = joint_map, roles
        self.parents = self._parents()
        self.levels = _levels(self.parents)
        inner = self.parents >= 0
        above = np.where(inner, self.parents, 0)
        back = np.where(inner[:, None], rotation.conjugate(target.rotations[above]), rotation.IDENTITY)
        self.local_r = rotation.multiply(back, target.rotations).astype(np.float32)
        offset = np.where(inner[:, None], target.positions - target.positions[above], target.positions)
        offset = rotation.rotate_vectors(back, offset).astype(np.float32)
        self.local_t = np.broadcast_to(offset, (clip.frames, len(above), 3)).copy()
        self.shifted: set[int] = set()
        self.turns = np.empty((clip.frames, len(above), 4), np.float32)
        self.places = np.empty((clip.frames, len(above), 3), np.float32)

    def _parents(self) -> Array:
        """Return the target's parents, with limbs that are separate in its file (IK feet, several roots)
        attached to the body.
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
                # Legs below the spine, as in bipeds of 3ds Max, follow the hips, too.
                lumbar = role.endswith("upper_leg") and roles.get("spine") in skeleton.chain(joint)
                if lumbar or (wanted not in skeleton.chain(joint) and joint not in skeleton.chain(wanted)):
                    parents[joint] = (
                        wanted
                        if not role.endswith("upper_arm")
                        else roles.get("upper_chest", roles.get("spine", wanted))
                    )
        return parents

    def turn_joints(self) -> None:
        """Carry over the turns of mapped joints and spread them on joints between those of the trunk. The
        other joints follow.
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
        """Carry over the shifts of joints that are paired by name, as in faces, scaled by the characters'
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
            self.local_t[:, b] += scale * rotation.rotate_vectors(turn.astype(np.float32), shift)

    def walk(self) -> None:
        """Compute forward kinematics: the turns of joints that are not given, and all positions."""
        for depth, joints in enumerate(self.levels):
            if depth == 0:
                free = joints[~self.given[joints]]
                self.turns[:, free] = self.local_r[free]
                self.places[:, joints] = self.local_t[:, joints]
                continue
            above = self.parents[joints]
            free = joints[~self.given[joints]]
            self.turns[:, free] = rotation.multiply(self.turns[:, self.parents[free]], self.local_r[free])
            self.places[:, joints] = self.places[:, above] + rotation.rotate_vectors(
                self.turns[:, above], self.local_t[:, joints]
            )

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
            goal = rotation.rotate_vectors(
                rotation.conjugate(self.turns[:, above]), goal - self.places[:, above]
            )
        self.local_t[:, hips] = goal
        self.walk()

    def reach(self, names: Sequence[str], goal: Array, side: Array) -> tuple[Array, Array]:
        """Turn the two bones of a limb so that its end reaches `goal [F, 3]`. The limb bends as the source's
        does, or towards `side` if it is straight. Return where middle and end arrive, `[F, 3]` each.
        """
        upper, lower, end = (self.target.roles[name] for name in names)
        above = tuple(self.from_places[:, self.source.roles[name]] for name in names)
        root = self.places[:, upper].astype(np.float64)
        knee, tip = self.places[:, lower] - root, self.places[:, end] - root
        one, two = (self.target.length(*pair) for pair in pairwise(names))
        pole = rotation.rotate_vectors(self.turned(names[0]), side)
        new, goal = solve_limb(
            goal - root, one, two, self.outwards(names[0]), (above[0], above[1], above[2]), pole
        )
        first, second = (
            rotation.find_rotation_between(knee, new),
            rotation.find_rotation_between(tip - knee, goal - new),
        )
        self.turns[:, upper] = rotation.multiply(first, self.turns[:, upper])
        self.turns[:, lower] = rotation.multiply(second, self.turns[:, lower])
        return root + new, root + goal

    def meet(self) -> None:
        """Bring hands that touch their own body to the place they touch. Everything else stays the same to
        the bit.
        """
        contact = OwnContact(self.source, self.target, self.from_turns, self.from_places)
        if not any(contact.places.values()):
            return
        self.walk()
        before = self.turns.copy()

        def reach(side: str, goal: Array) -> tuple[Array, Array]:
            names = [f"{side}_{part}" for part in ARM]
            for joint in (self.target.roles[name] for name in names[:2]):
                self.turns[:, joint] = before[:, joint]
            return self.reach(names, goal, BACKWARDS)

        touched = meet(contact, contact.target.points(self.turns, self.places), reach, self.clip.fps)
        for side, frames in touched.items():
            for joint in (self.target.roles[f"{side}_{part}"] for part in ARM[:2]):
                self.turns[~frames, joint] = before[~frames, joint]

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
        places = rotation.rotate_vectors(back, self.places)
        moves = places[:, joints]
        for n, joint in enumerate(joints):
            parent = int(target.parents[joint])
            if parent >= 0:
                turn = rotation.conjugate(rotation.multiply(back, self.turns[:, parent]))
                moves[:, n] = rotation.rotate_vectors(turn, moves[:, n] - places[:, parent])
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
            rotations=rotation.make_continuous(rotation.normalize(rotations)),
            translations=moves[:, kept],
            translated=tuple(joints[n] for n in kept),
            notes=(*self.clip.notes, note + (f", {idle} follow their parents" if idle else "")),
            brought_from=make_fingerprint(self.clip.skeleton),
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
