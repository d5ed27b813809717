"""Bring a skeleton into the pose in which a body was made, whatever its rest pose is."""

from __future__ import annotations

import itertools
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.motion import rotation
from metagraph.motion.fitting.footing import Footing
from metagraph.motion.joint_map import ARM, FINGERS, LEG, NEEDED, SIDES, find_known_roles
from metagraph.motion.roles import find_roles
from metagraph.motion.skeleton import Skeleton

Array = NDArray[Any]

UPRIGHT = 0.5  # the least cosine of trunk and legs with the vertical in a pose that stands
SHRUG = np.radians(40)  # shoulders turned further than this from the sculpted ones are raised, not built so
LEVEL = np.array([1.0, 0, 1.0])
UP = np.array([0.0, 1, 0])
SHORTEST = 0.02  # of its height: legs, trunks and arms that are shorter are none


@dataclass(frozen=True)
class Bind:
    """A skeleton as the body was made: facing +Z, its limbs as the body's.

    `roles` are its joints by role, also of fingers. `rotations` `[J, 4]` and `positions` `[J, 3]` are global.
    """

    roles: Mapping[str, int]
    rotations: Array
    positions: Array

    def at(self, role: str) -> Array:
        return np.asarray(self.positions[self.roles[role]])

    def middle(self, part: str) -> Array:
        return np.asarray((self.at(f"left_{part}") + self.at(f"right_{part}")) / 2)


def bind_pose(skeleton: Skeleton, at: Mapping[str, Array], footing: Footing | None = None) -> Bind | str:
    """Return the skeleton in the pose of a body whose joints are `at` places, by role; or in words why that
    cannot be done.

    `footing` says how it stands; by default it stands as it rests.
    """
    roles = find_roles(skeleton)
    missing = [role.replace("_", " ") for role in NEEDED if role not in roles]
    if missing:
        return f"the skeleton has no {missing[0]}"
    known = find_known_roles(skeleton, roles)
    turned, places = skeleton.globals(skeleton.rest if footing is None else footing.pose)
    if (why := explain_no_standing(places, known)) is not None:
        return why
    turned, places = turn_to_front(turned, places, known)
    levels = {
        side: rotation.find_rotation_between(rotation.rotate_vectors(turned[known[f"{side}_foot"]], up), UP)
        for side, up in zip(SIDES, (None, None) if footing is None else footing.ups, strict=True)
        if up is not None
    }
    swings = _swings(skeleton, known, places, at, levels)
    out = np.array(places)
    for joint, parent in enumerate(skeleton.parents):
        if parent >= 0:
            out[joint] = out[parent] + rotation.rotate_vectors(swings[parent], places[joint] - places[parent])
    return Bind(known, rotation.multiply(swings, turned), out)


def explain_no_standing(places: Array, roles: Mapping[str, int]) -> str | None:
    """Return why a pose is none of a standing person, None if it is one."""
    lines = [("hips", "head")] + [(f"{side}_foot", f"{side}_upper_leg") for side in SIDES]
    for low, high in lines:
        line = places[roles[high]] - places[roles[low]]
        if line[1] < UPRIGHT * np.linalg.norm(line) or not line[1] > 0:
            return "no pose is known in which the skeleton stands"
    tall = float(np.ptp(places[:, 1]))
    for side in SIDES:
        for upper, lower, end in (ARM, LEG):
            a, b, c = (places[roles[f"{side}_{part}"]] for part in (upper, lower, end))
            if min(np.linalg.norm(b - a), np.linalg.norm(c - b)) < SHORTEST * tall:
                return f"the skeleton's {side} {lower.replace('_', ' ')} has no length"
    return None


def turn_to_front(turned: Array, places: Array, roles: Mapping[str, int]) -> tuple[Array, Array]:
    """Return a pose turned about the vertical so that the character's left is at +X."""
    across = sum(places[roles[f"left_{r}"]] - places[roles[f"right_{r}"]] for r in ("upper_leg", "upper_arm"))
    turn = rotation.from_axis_angle(np.array([0.0, 1, 0]), np.arctan2(across[2], across[0]))
    return rotation.multiply(turn, turned), rotation.rotate_vectors(turn, places)


def _swings(
    skeleton: Skeleton,
    roles: Mapping[str, int],
    places: Array,
    at: Mapping[str, Array],
    levels: Mapping[str, Array],
) -> Array:
    """Return how each joint is turned from the standing pose into the sculpted one, `[J, 4]`. `levels` are
    the turns that bring soles to the ground.
    """
    ways = _ways(roles, places, at)
    aligned = {roles[role]: way for role, way in ways.items()}
    hands = {roles[f"{side}_hand"]: side for side in SIDES}
    feet = {roles[f"{side}_foot"]: side for side in SIDES}
    shoulders = {roles[role] for role in (f"{side}_shoulder" for side in SIDES) if role in roles}
    out = np.tile(rotation.IDENTITY, (len(skeleton), 1))
    for joint, parent in enumerate(skeleton.parents):
        swing = out[parent] if parent >= 0 else rotation.IDENTITY
        if joint in feet:
            level = levels.get(feet[joint], rotation.IDENTITY)  # whatever the legs did
            swing = _heading(roles, places, at, feet[joint], level)
        elif joint in hands and (turn := _hand_turn(roles, places, at, hands[joint])) is not None:
            swing = turn
        elif joint in aligned:
            own, wanted = aligned[joint]
            carried = rotation.rotate_vectors(swing, own)
            if joint not in shoulders or _angle(carried, wanted) > SHRUG:
                swing = rotation.multiply(rotation.find_rotation_between(carried, wanted), swing)
        out[joint] = swing
    return out


def _ways(roles: Mapping[str, int], places: Array, at: Mapping[str, Array]) -> dict[str, tuple[Array, Array]]:
    """Return each bone of limbs and fingers: its direction in the standing pose and in the sculpted one."""
    bones = [
        (f"{s}_{a}", f"{s}_{b}") for s in SIDES for limb in (ARM, LEG) for a, b in itertools.pairwise(limb)
    ]
    bones += [(f"{s}_shoulder", f"{s}_upper_arm") for s in SIDES]
    bones += [(f"{s}_{f}_{n}", f"{s}_{f}_{n + 1}") for s in SIDES for f in FINGERS for n in (1, 2)]
    bones += [(f"{s}_hand", f"{s}_{f}_1") for s in SIDES for f in ("index", "middle")]
    out: dict[str, tuple[Array, Array]] = {}
    for role, to in bones:
        if role in roles and to in roles and role in at and to in at:
            own = places[roles[to]] - places[roles[role]]
            if np.linalg.norm(own) > 1e-6:
                out[role] = own, at[to] - at[role]
    return out


def _angle(a: Array, b: Array) -> float:
    return float(np.arccos(np.clip(a @ b / max(1e-12, float(np.linalg.norm(a) * np.linalg.norm(b))), -1, 1)))


def _hand_turn(roles: Mapping[str, int], places: Array, at: Mapping[str, Array], side: str) -> Array | None:
    """Return the turn that brings a hand's knuckles in line, None if fewer than two are known."""
    knuckles = [k for k in (f"{side}_{f}_1" for f in FINGERS[1:]) if k in roles and k in at]
    if len(knuckles) < 2:
        return None
    hand = f"{side}_hand"
    frames = []
    for place in ({r: places[roles[r]] for r in (hand, *knuckles)}, at):
        along = np.mean([place[k] for k in knuckles], 0) - place[hand]
        frames.append(_frame(along, place[knuckles[0]] - place[knuckles[-1]]))
    if any(frame is None for frame in frames):
        return None
    return rotation.multiply(frames[1], rotation.conjugate(frames[0]))


def _frame(along: Array, across: Array) -> Array | None:
    """Return the turn whose X lies along one direction and whose Y as near as can be along another."""
    x = along / max(1e-12, float(np.linalg.norm(along)))
    y = across - x * (x @ across)
    if np.linalg.norm(along) < 1e-6 or np.linalg.norm(y) < 1e-6:
        return None
    y /= np.linalg.norm(y)
    return rotation.from_matrix(np.stack([x, y, np.cross(x, y)], -1))


def _heading(
    roles: Mapping[str, int], places: Array, at: Mapping[str, Array], side: str, level: Array
) -> Array:
    """Return the turn that lets a foot point where the sculpted one does, after it was turned level."""
    foot, toes = f"{side}_foot", f"{side}_toes"
    if toes not in roles or toes not in at:
        return level
    own = rotation.rotate_vectors(level, places[roles[toes]] - places[roles[foot]]) * LEVEL
    if np.linalg.norm(own) < 1e-4:
        return level
    return rotation.multiply(rotation.find_rotation_between(own, (at[toes] - at[foot]) * LEVEL), level)
