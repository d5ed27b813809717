"""The parts of a body as capsules, fixed to its joints: of the measures of its skeleton, or of its mesh."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import pairwise
from typing import Annotated, Any

import numpy as np
from msgspec import Meta, Struct
from numpy.typing import NDArray

from metagraph.motion import rotation
from metagraph.motion.character_mesh import CharacterMesh
from metagraph.motion.joint_map import find_known_roles
from metagraph.motion.skeleton import Pose, Skeleton

Array = NDArray[Any]

SIDES = ("left", "right")
FINGERS = ("index", "middle", "ring", "little", "thumb")
TRUNK = ("hips", "spine", "chest", "upper_chest")
# Radii where no mesh tells them: of the arm from shoulder to wrist, of the leg, of half the shoulders'
# breadth, of the height. People's, from the mannequin's and other characters' meshes.
UPPER_ARM, LOWER_ARM, PALM, FINGER = 0.08, 0.062, 0.03, 0.018
THIGH, NECK, SKULL, JAW = 0.085, 0.032, 0.046, 0.028
WIDTH, DEPTH = 0.8, 0.52
LEAST = 12  # vertices that a part's measures are taken from


class BodyPart(Struct, frozen=True, omit_defaults=True, forbid_unknown_fields=True):
    """A part of the body as a capsule. joint, to: the names of the joints its line's ends are fixed to; a, b:
    where, in those joints' own spaces, metres. radius: metres.
    """

    joint: str
    to: str
    a: tuple[float, float, float]
    b: tuple[float, float, float]
    radius: Annotated[float, Meta(gt=0, le=1e3)]


class _Standing:
    """A figure that parts are made on: its joints by role, in the character's space."""

    def __init__(self, skeleton: Skeleton, roles: Mapping[str, int], pose: Pose, axes: Array) -> None:
        self.skeleton, self.roles, self.axes = skeleton, roles, np.asarray(axes, float)
        turned, at = skeleton.globals(pose)
        self.turned, self.at = np.asarray(turned, float), np.asarray(at, float)
        self.rest_turned, self.rest_at = skeleton.globals(skeleton.rest)

    def length(self, *roles: str) -> float:
        found = [self.at[self.roles[r]] for r in roles if r in self.roles]
        return float(sum(np.linalg.norm(b - a) for a, b in pairwise(found)))

    def part(self, joint: int, to: int, a: Array, b: Array, radius: float) -> BodyPart:
        """Return a capsule between two points in the character's space."""
        names = self.skeleton.names
        ends = [
            rotation.rotate_vectors(rotation.conjugate(self.turned[j]), p - self.at[j]).round(5).tolist()
            for j, p in ((joint, a), (to, b))
        ]
        return BodyPart(names[joint], names[to], tuple(ends[0]), tuple(ends[1]), round(radius, 5))


def make_body_capsules(
    skeleton: Skeleton,
    roles: Mapping[str, int],
    pose: Pose,
    axes: Array,
    character: CharacterMesh | None = None,
) -> tuple[BodyPart, ...]:
    """Return the parts of a body; none of one without two arms, hips and a head.

    pose `[J]`: how it stands. axes `[3, 3]`: its left, up and ahead. character: its mesh, on the same
    skeleton.
    """
    needed = {"hips", "head", *(f"{s}_{p}" for s in SIDES for p in ("upper_arm", "lower_arm", "hand"))}
    if not needed <= roles.keys():
        return ()
    body = _Standing(skeleton, {**roles, **find_known_roles(skeleton, roles)}, pose, axes)
    mesh = None if character is None or character.skeleton != skeleton else _Mesh(body, character)
    found = [part for side in SIDES for part in _arm(body, mesh, side)]
    return (*found, *_legs(body, mesh), *_trunk(body, mesh), *_head(body, mesh))


def _arm(body: _Standing, mesh: _Mesh | None, side: str) -> list[BodyPart]:
    roles, at = body.roles, body.at
    upper, lower, hand = (roles[f"{side}_{p}"] for p in ("upper_arm", "lower_arm", "hand"))
    arm = body.length(f"{side}_upper_arm", f"{side}_lower_arm", f"{side}_hand")
    out = []
    for a, b, share in ((upper, lower, UPPER_ARM), (lower, hand, LOWER_ARM)):
        owners = [j for j in body.skeleton.descendants(a) if j not in body.skeleton.descendants(b)]
        radius = share * arm if mesh is None else mesh.radius(owners, at[a], at[b], share * arm)
        out.append(body.part(a, b, at[a], at[b], radius))
    knuckles = [roles[f"{side}_{f}_1"] for f in FINGERS[:4] if f"{side}_{f}_1" in roles]
    palm = PALM * arm if mesh is None else mesh.thickness(hand, knuckles, PALM * arm)
    if not knuckles:
        tip = (
            at[hand]
            + 0.3
            * (at[hand] - at[lower])
            * arm
            / max(1e-6, body.length(f"{side}_lower_arm", f"{side}_hand"))
            * 0.9
        )
        return [*out, body.part(hand, hand, at[hand], tip, palm)]
    for knuckle in dict.fromkeys((knuckles[0], knuckles[-1])):
        out.append(body.part(hand, hand, at[hand], at[knuckle], palm))
    fingers = [f for f in ("index", "ring", "thumb") if f"{side}_{f}_1" in roles] or [
        f for f in FINGERS if f"{side}_{f}_1" in roles
    ][:2]
    for finger in fingers:
        chain = [roles[f"{side}_{finger}_{n}"] for n in (1, 2, 3, 4) if f"{side}_{finger}_{n}" in roles]
        first, last = chain[0], chain[-1]
        if len(chain) > 1:
            tip = at[last] + 0.8 * (at[last] - at[chain[-2]])
        else:
            tip = at[last] + 0.6 * (at[last] - at[hand])
        owners = [j for c in chain for j in body.skeleton.descendants(c)]
        radius = FINGER * arm if mesh is None else mesh.radius(owners, at[first], tip, FINGER * arm)
        out.append(body.part(first, last, at[first], tip, radius))
    return out


def _legs(body: _Standing, mesh: _Mesh | None) -> list[BodyPart]:
    out = []
    for side in SIDES:
        chain = [body.roles.get(f"{side}_{p}") for p in ("upper_leg", "lower_leg", "foot")]
        if None in chain:
            continue
        hip, knee, _ = (j for j in chain if j is not None)
        leg = body.length(f"{side}_upper_leg", f"{side}_lower_leg", f"{side}_foot")
        owners = [j for j in body.skeleton.descendants(hip) if j not in body.skeleton.descendants(knee)]
        a, b = body.at[hip], body.at[knee]
        radius = THIGH * leg if mesh is None else mesh.radius(owners, a, b, THIGH * leg)
        out.append(body.part(hip, knee, a + 0.15 * (b - a), b, radius))
    return out


def _trunk(body: _Standing, mesh: _Mesh | None) -> list[BodyPart]:
    roles = body.roles
    left = body.axes[0]
    half = float(np.linalg.norm(body.at[roles["left_upper_arm"]] - body.at[roles["right_upper_arm"]])) / 2
    there = [r for r in TRUNK if r in roles]
    tops = [*(roles[r] for r in there[1:]), roles.get("neck", roles["head"])]
    out = []
    for role, top in zip(there, tops, strict=True):
        joint = roles[role]
        middle = body.at[joint] + 0.5 * (body.at[top] - body.at[joint])
        if role == "hips":
            middle = body.at[joint]
        wide, deep = WIDTH * half, DEPTH * half
        if mesh is not None:
            limbs = {
                j
                for s in SIDES
                for p in ("upper_arm", "upper_leg")
                for j in body.skeleton.descendants(roles[f"{s}_{p}"])
            }
            owners = [j for j in body.skeleton.descendants(joint) if j not in limbs]
            middle, wide, deep = mesh.slice(owners, middle, wide, deep)
        reach = max(0.0, wide - deep)
        out.append(body.part(joint, joint, middle + reach * left, middle - reach * left, deep))
    return out


def _head(body: _Standing, mesh: _Mesh | None) -> list[BodyPart]:
    roles, (_, up, ahead) = body.roles, body.axes
    head, tall = roles["head"], float(np.ptp(body.at @ up))
    out = []
    middle, half = body.at[head] + SKULL * 1.05 * tall * up + 0.01 * tall * ahead, 0.3 * SKULL * tall
    radius = SKULL * tall
    if mesh is not None:
        middle, half, radius = mesh.skull(head, middle, half, radius)
    out.append(body.part(head, head, middle - half * up, middle + half * up, radius))
    jaw, least = body.at[head] + 0.004 * tall * up + 0.032 * tall * ahead, JAW * tall
    if mesh is not None:
        jaw, least = mesh.jaw(head, jaw, least)
    out.append(body.part(head, head, jaw, jaw, least))
    if "neck" in roles:
        neck = roles["neck"]
        radius = (
            NECK * tall if mesh is None else mesh.radius([neck], body.at[neck], body.at[head], NECK * tall)
        )
        out.append(body.part(neck, head, body.at[neck], body.at[head], radius))
    return out


class _Mesh:
    """A character's vertices as the figure stands, and the joint that moves each most."""

    def __init__(self, body: _Standing, character: CharacterMesh) -> None:
        self.axes, self.at = body.axes, body.at
        self.below = {j: body.skeleton.descendants(j) for j in [body.roles["head"]]}
        back = rotation.conjugate(body.rest_turned)
        turn = rotation.multiply(body.turned, back)  # [J, 4]
        points = np.zeros_like(np.asarray(character.positions, float))
        for k in range(character.joints.shape[1]):
            j = character.joints[:, k]
            moved = body.at[j] + rotation.rotate_vectors(turn[j], character.positions - body.rest_at[j])
            points += character.weights[:, k, None] * moved
        used = np.unique(character.triangles)
        self.points = points[used]
        self.owner = character.joints[used, np.argmax(character.weights[used], 1)]

    def of(self, joints: list[int]) -> Array:
        return np.asarray(self.points[np.isin(self.owner, joints)])

    def radius(self, joints: list[int], a: Array, b: Array, usual: float) -> float:
        """Return how far the skin of some joints is from a line: the median."""
        points, line = self.of(joints), b - a
        share = (points - a) @ line / max(float(line @ line), 1e-12)
        points, share = points[(share > 0.05) & (share < 0.95)], share[(share > 0.05) & (share < 0.95)]
        if len(points) < LEAST:
            return usual
        away = np.linalg.norm(points - a - share[:, None] * line, axis=1)
        return float(np.median(away))

    def thickness(self, hand: int, knuckles: list[int], usual: float) -> float:
        """Return half of how thick a palm is, across the plane of its wrist and knuckles."""
        if len(knuckles) < 2:
            return usual
        first, last = self.at[knuckles[0]] - self.at[hand], self.at[knuckles[-1]] - self.at[hand]
        across, points = np.cross(first, last), self.of([hand]) - self.at[hand]
        along = (points @ first) / max(float(first @ first), 1e-12)
        points = points[(along > 0.3) & (along < 0.8)]
        if len(points) < LEAST or np.linalg.norm(across) < 1e-9:
            return usual
        high, low = np.percentile(points @ across / np.linalg.norm(across), (90, 10))
        return float(high - low) / 2

    def slice(self, joints: list[int], middle: Array, wide: float, deep: float) -> tuple[Array, float, float]:
        """Return the middle of the trunk at a height, and half its width and depth there."""
        left, up, ahead = self.axes
        points = self.of(joints) - middle
        points = points[np.abs(points @ up) < 0.35 * deep]
        if len(points) < LEAST:
            return middle, wide, deep
        x, z = points @ left, points @ ahead
        low, high = np.percentile(z, (6, 94))
        return middle + (low + high) / 2 * ahead, float(np.percentile(np.abs(x), 90)), float(high - low) / 2

    def skull(self, head: int, middle: Array, half: float, radius: float) -> tuple[Array, float, float]:
        """Return the middle of the head, half the length of its line, and its radius: half its breadth."""
        left, up, ahead = self.axes
        points = self.of([head]) - middle
        if len(points) < LEAST:
            return middle, half, radius
        y, z = points @ up, points @ ahead
        low, high = np.percentile(y, (3, 99))
        near, far = np.percentile(z, (5, 95))
        radius = float(np.percentile(np.abs(points @ left), 85))
        centre = middle + (low + high) / 2 * up + (near + far) / 2 * ahead
        return centre, max(0.0, float(high - low) / 2 - radius), radius

    def jaw(self, head: int, middle: Array, radius: float) -> tuple[Array, float]:
        """Return the middle and the radius of a ball in the chin."""
        left, up, ahead = self.axes
        points = self.of(list(self.below[head])) - middle
        points = points[(np.abs(points @ left) < radius) & (np.abs(points @ up) < radius)]
        if len(points) < LEAST:
            return middle, radius
        front = float(np.percentile(points @ ahead, 97))
        return middle + (front - radius) * ahead, radius
