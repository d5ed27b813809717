"""Let hands rest on the tops of props and feet stand on steps: what standing props do to evaluated poses.

What a top does to a hand sets in and fades over time, found from the plan thirty times a second. So a hand
that comes over a desk, or leaves it, does not jump; where it is over the desk, each pose says itself how far
it is lifted. Cost: a pose is computed once more, without life, for each thirtieth of a second.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.graph import anatomy
from metagraph.graph.model import Project
from metagraph.graph.remembered import Remembered
from metagraph.motion import rotation
from metagraph.motion.contact_solve import ContactPose, ContactRig
from metagraph.motion.joint_map import find_known_roles
from metagraph.motion.prop_solve import (
    HandPoint,
    HandRest,
    RestingRig,
    lift_feet,
    put_hands_on_tops,
    set_carried,
)
from metagraph.motion.prop_tops import PropTop
from metagraph.motion.skeleton import Pose, Skeleton
from metagraph.motion.weight_solve import WeightRig
from metagraph.playback.evaluator import Evaluator, Poses
from metagraph.playback.posing.clip_evaluators import GeneratedEvaluator, MovedEvaluator
from metagraph.playback.posing.contacts import find_body_parts, make_contact_rig
from metagraph.playback.posing.rigs import get_rigs

Array = NDArray[Any]
Faces = list[dict[str, float]]

SIDES = ("left", "right")
RATE = 30.0  # samples a second
BLOCK = 32  # samples found at once
KEPT = 256  # blocks that are kept
HANDS, FEET = 11, 7  # samples over which what a top does to them sets in, half as long as it takes
ARM = 0.6  # of the height: from the hips to stretched fingers, and a step
REACH = 0.22  # metres below a top up to which a hand is brought onto it
NEAR, FAR = 0.03, 0.07  # metres above a top: a hand comes to rest, and does not
SLOW, QUICK = 0.12, 0.35  # metres a second: it does, and does not
MOST_PITCH, MOST_ROLL = 0.7, 0.5  # radians by which a hand is laid flat
UPRIGHT = 0.25  # cosine of a roll: a hand that is rolled so far stays rolled
DEEP = 0.05  # metres below a top from which on a hand is laid flat on it
STEP = 0.3  # metres: what is higher is no step
LEAST = 1e-4  # of what a top does: less does nothing
# Of a forearm's radius the wrist's half thickness; a knuckle's and a finger tip's, of the height.
WRIST, KNUCKLE, TIP = 0.7, 0.009, 0.005
GROWS = 0.7  # of a finger's last bone but one: how long the last is
PALM = 0.45  # of a forearm: how long a hand without fingers is

Carried = Mapping[str, tuple[tuple[float, float, float], ...]]  # joint -> corners in its space


def find_resting_rig(project: Project, carried: Carried | None = None) -> RestingRig | None:
    """Return the arms that rest on props, None without two. carried: the corners of the boxes round the props
    that joints carry, in the joints' own spaces, metres.
    """
    skeleton, roles = project.skeleton, anatomy.project_roles(project)
    arms = [[roles.get(f"{s}_{p}") for p in ("upper_arm", "lower_arm", "hand")] for s in SIDES]
    if skeleton is None or any(j is None for arm in arms for j in arm):
        return None
    known = {**roles, **find_known_roles(skeleton, roles)}
    fingers = [_list_fingers(skeleton, known, side) for side in SIDES]
    names = [skeleton.names[j] for lines in fingers for line in lines for j in line]
    names += [name for name in carried or () if name in skeleton]
    whole = [[j for j in arm if j is not None] for arm in arms]
    body = make_contact_rig(skeleton, whole, (), names, project)
    if body is None:
        return None
    radii = {part.joint: part.radius for part in find_body_parts(project)}
    turned, rest = (np.asarray(x, float) for x in skeleton.globals(skeleton.rest))
    forearms, points, ahead, across = [], [], [], []
    for (_, lower, hand), lines in zip(whole, fingers, strict=True):
        forearm = radii.get(skeleton.names[lower], 0.02 * skeleton.height)
        forearms.append(forearm)
        points.append(tuple(_list_points(body, skeleton, (lower, hand), lines, WRIST * forearm)))
        knuckles = [rest[line[0]] for line in lines]
        way = np.mean(knuckles, 0) - rest[hand] if lines else rest[hand] - rest[lower]
        ahead.append(_find_direction(turned[hand], way))
        across.append(_find_direction(turned[hand], knuckles[0] - knuckles[-1] if lines else np.zeros(3)))
    rig = RestingRig(body, tuple(points), tuple(forearms), tuple(ahead), tuple(across))
    held = [_list_carried(skeleton, body, arm[2], carried or {}) for arm in whole]
    return set_carried(rig, held) if any(held) else rig


_reaches: Remembered[float] = Remembered(lambda project: (project.clips, project.skeleton))


def measure_reach(project: Project) -> float:
    """Return how far from where it stands a character comes in its clips, with arms stretched, metres."""
    return _reaches.of(project, (), lambda: _measure_reach(project))


def _measure_reach(project: Project) -> float:
    far = 0.0
    for entry in project.clips.values():
        if entry.motion is not None and entry.motion.skeleton == project.skeleton and entry.motion.frames:
            root = np.asarray(entry.motion.pose_at(np.arange(0, entry.motion.duration + 1e-6, 0.5)).root)
            far = max(far, float(np.hypot(root[:, 0], root[:, 2]).max()))
    return far + ARM * (project.skeleton.height if project.skeleton is not None else 0.0)


def _find_direction(turned: Array, way: Array) -> tuple[float, float, float]:
    """Return where a way of the rest pose points, in the space of a joint that is turned there."""
    own = rotation.rotate_vectors(rotation.conjugate(turned), way)
    return _to_vector(own / max(float(np.linalg.norm(own)), 1e-9))


def _to_vector(of: Array) -> tuple[float, float, float]:
    x, y, z = np.asarray(of, float).tolist()
    return x, y, z


def _list_fingers(skeleton: Skeleton, roles: Mapping[str, int], side: str) -> list[list[int]]:
    """Return the joints of the fingers of a hand that reach beyond the others, the index finger first."""
    lines = [
        [roles[name] for n in (1, 2, 3) if (name := f"{side}_{finger}_{n}") in roles]
        for finger in ("index", "middle", "little")
    ]
    return [line for line in lines if line]


def _list_points(
    body: ContactRig, skeleton: Skeleton, arm: tuple[int, int], fingers: list[list[int]], wrist: float
) -> list[HandPoint]:
    """Return the points of a hand that are kept above tops. arm: forearm and hand."""
    lower, hand = arm
    at = body.joints.index(hand)
    tall = skeleton.height
    out = [HandPoint(at, (0.0, 0.0, 0.0), wrist)]
    rest = skeleton.rest.translations
    for line in fingers:
        out.append(HandPoint(body.joints.index(line[0]), (0.0, 0.0, 0.0), KNUCKLE * tall))
        beyond = GROWS * np.asarray(rest[line[-1]], float) if len(line) > 1 else np.zeros(3)
        out.append(HandPoint(body.joints.index(line[-1]), _to_vector(beyond), TIP * tall, far=True))
    if not fingers:
        turned, places = skeleton.globals(skeleton.rest)
        way = PALM * np.asarray(places[hand] - places[lower], float)
        turn = rotation.conjugate(np.asarray(turned[hand], float))
        out.append(HandPoint(at, _to_vector(rotation.rotate_vectors(turn, way)), KNUCKLE * tall, far=True))
    return out


def _list_carried(skeleton: Skeleton, body: ContactRig, hand: int, carried: Carried) -> tuple[HandPoint, ...]:
    below = {skeleton.names[j] for j in skeleton.descendants(hand)}
    return tuple(
        HandPoint(body.places[name], corner, 0.0)
        for name, corners in carried.items()
        if name in below and name in body.places
        for corner in corners
    )


@dataclass(frozen=True, eq=False)
class _Samples:
    """What tops do at samples. hands `[N, 2, T, 4]`: of each top, as `HandRest` has them.
    lifts `[N, 2]`: of feet, metres.
    """

    hands: Array
    lifts: Array


UNKNOWN = _Samples(np.zeros(0), np.zeros(0))


@dataclass(frozen=True, eq=False)
class RestingStage:
    """Rests hands and feet of a plan on tops. sample: the poses before life at times `[N]`."""

    skeleton: Skeleton
    tops: tuple[PropTop, ...]
    rig: RestingRig | None
    legs: WeightRig | None
    sample: Callable[[Array], Pose]
    _raw: dict[int, _Samples] = field(default_factory=dict)
    _smooth: dict[int, _Samples | None] = field(default_factory=dict)

    def run(self, pose: Pose, times: Array) -> Pose:
        """Return poses `[N, J]` at `times [N]` with hands and feet on tops; the same arrays if none is
        near.
        """
        if not self.tops or (self.rig is None and self.legs is None):
            return pose
        found = self._find(times)
        if found is None:
            return pose
        busy_hands = np.asarray((found.hands[..., :2] > LEAST).any((1, 2, 3)))
        busy_feet = np.asarray((found.lifts > LEAST).any(1))
        busy = np.flatnonzero(busy_hands | busy_feet)
        if not len(busy):
            return pose
        rotations, translations = np.array(pose.rotations), np.array(pose.translations)
        for n in busy.tolist():
            if busy_feet[n] and self.legs is not None:
                one = _pick(self.legs.body, rotations[n], translations[n])
                if lift_feet(self.legs, one, found.lifts[n].tolist()):
                    _put(self.legs.body, one, rotations[n], translations[n])
            if busy_hands[n] and self.rig is not None:
                one = _pick(self.rig.body, rotations[n], translations[n])
                if put_hands_on_tops(self.rig, one, self._list_rests(found, n)):
                    _put(self.rig.body, one, rotations[n], None)
        return Pose(rotations, translations)

    def _list_rests(self, found: _Samples, n: int) -> list[list[HandRest]]:
        return [
            [
                HandRest(top.meet, *shares)
                for top, shares in zip(self.tops, side, strict=True)
                if max(shares[:2]) > LEAST
            ]
            for side in found.hands[n].tolist()
        ]

    def _find(self, times: Array) -> _Samples | None:
        """Return what tops do at times; None if they do nothing."""
        if len(times) == 1:
            now = float(times[0]) * RATE
            one, n = self._smoothed(int(now // BLOCK)), int(now // 1) % BLOCK
            if one is None:
                return None
            k = now - now // 1
            two = slice(n, n + 2)
            (a, b), (c, d) = one.hands[two], one.lifts[two]
            return _Samples((a + k * (b - a))[None], (c + k * (d - c))[None])
        at = np.asarray(times, float) * RATE
        first = np.floor(at).astype(np.int64)
        blocks, places = np.divmod(first, BLOCK)
        which, of = np.unique(blocks, return_inverse=True)
        found = [self._smoothed(int(block)) for block in which]
        if all(one is None for one in found):
            return None
        none = _Samples(np.zeros((BLOCK + 1, 2, len(self.tops), 4)), np.zeros((BLOCK + 1, 2)))
        kept = [none if one is None else one for one in found]
        place, part = of * (BLOCK + 1) + places, at - first
        return _Samples(
            _between(np.concatenate([one.hands for one in kept]), place, part[:, None, None, None]),
            _between(np.concatenate([one.lifts for one in kept]), place, part[:, None]),
        )

    def _smoothed(self, block: int) -> _Samples | None:
        """Return what tops do over a block, with the first sample after it; None if they do nothing."""
        found = self._smooth.get(block, UNKNOWN)
        if found is UNKNOWN:
            some = [self._sampled(block + n) for n in (-1, 0, 1)]
            hands, lifts = np.concatenate([o.hands for o in some]), np.concatenate([o.lifts for o in some])
            hands[..., 0] = _highest(hands[..., 0], HANDS)
            here = slice(BLOCK, 2 * BLOCK + 1)
            found = None
            if hands.any() or lifts.any():
                found = _Samples(_average(hands, HANDS)[here], _average(_highest(lifts, FEET), FEET)[here])
            if len(self._smooth) >= KEPT:
                self._smooth.clear()
            self._smooth[block] = found
        return found

    def _sampled(self, block: int) -> _Samples:
        found = self._raw.get(block)
        if found is None:
            times = (block * BLOCK + np.arange(-1, BLOCK)) / RATE
            pose = self.sample(times)
            turned, at = self.skeleton.globals(pose)
            if len(self._raw) >= KEPT:
                self._raw.clear()
            found = self._raw[block] = self._judge(np.asarray(turned, float), np.asarray(at, float))
        return found

    def _judge(self, turned: Array, at: Array) -> _Samples:
        """Return what tops want of poses; the first pose only tells how fast the second moves."""
        count, tops = len(at) - 1, len(self.tops)
        hands, lifts = np.zeros((count, 2, tops, 4)), np.zeros((count, 2))
        for side in range(2 if self.rig is not None else 0):
            assert self.rig is not None
            points = self.rig.points[side]
            joints = [self.rig.body.joints[p.place] for p in points]
            offsets = np.array([p.at for p in points])
            placed = at[:, joints] + rotation.rotate_vectors(turned[:, joints], offsets)
            speed = np.linalg.norm(np.diff(placed[:, 0], axis=0), axis=1) * RATE
            slow = _fade((QUICK - speed) / (QUICK - SLOW))
            own = [n for n, p in enumerate(points) if p.radius > 0]  # of the hand, not of what it carries
            radii = np.array([p.radius for p in points])
            placed = placed[1:]
            for n, top in enumerate(self.tops):
                over = top.contains(placed).any(1)
                if over.any():
                    depths = top.find_heights(placed) + radii - placed[..., 1]
                    over &= depths[:, own].max(1) <= REACH
                    depth = depths.max(1)
                    hands[:, side, n, 0] = over
                    hands[:, side, n, 1] = over * slow * _fade((FAR + depth) / (FAR - NEAR))
                    level = np.maximum(over * _fade(depth / DEEP), hands[:, side, n, 1])
                    hands[:, side, n, 2:] = level[:, None] * self._find_level(top, side, turned[1:], placed)
        for side in range(2 if self.legs is not None else 0):
            assert self.legs is not None
            foot = self.legs.body.joints[self.legs.body.arms[side].hand]
            soles = at[1:, [foot, *self.skeleton.children[foot]]]
            for top in self.tops:
                if top.height <= STEP:
                    over = top.contains(soles).any(1)
                    high = top.find_heights(soles).max(1)
                    lifts[:, side] = np.maximum(lifts[:, side], over * np.maximum(0.0, high))
        return _Samples(hands, lifts)

    def _find_level(self, top: PropTop, side: int, turned: Array, placed: Array) -> Array:
        """Return the pitch and roll `[N, 2]` that lay a hand flat on a top. placed `[N, P, 3]`: its
        points.
        """
        assert self.rig is not None
        points = self.rig.points[side]
        far = [n for n, point in enumerate(points) if point.far]
        hand = turned[:, self.rig.body.joints[self.rig.body.arms[side].hand]]
        ahead, across = (
            rotation.rotate_vectors(hand, np.array(way[side])) for way in (self.rig.ahead, self.rig.across)
        )
        tip, wrist = placed[:, far].mean(1), placed[:, 0]
        size = np.maximum(np.linalg.norm(tip - wrist, axis=1), 1e-6)
        thick = np.mean([points[n].radius for n in far]) - points[0].radius
        rises = top.find_heights(tip) - top.find_heights(wrist) + thick
        now = np.arcsin(np.clip((tip - wrist)[:, 1] / size, -1, 1))
        pitch = np.clip(np.arcsin(np.clip(rises / size, -0.7, 0.7)) - now, -MOST_PITCH, MOST_PITCH)
        # Laid flat it points ahead as seen from above, and its thumb's side is as high as the other.
        flat = ahead * (1, 0, 1)
        flat = flat / np.maximum(np.linalg.norm(flat, axis=1), 1e-6)[:, None]
        aside = across - flat * np.einsum("ni,ni->n", across, flat)[:, None]
        level = flat[:, 2] * aside[:, 0] - flat[:, 0] * aside[:, 2]
        keep = _fade((np.abs(level) - UPRIGHT) / (1 - 2 * UPRIGHT))
        roll = np.clip(np.arctan2(aside[:, 1], np.abs(level)), -MOST_ROLL, MOST_ROLL) * keep
        return np.stack([pitch, np.where(level < 0, roll, -roll)], 1)


def _between(of: Array, place: Array, part: Array) -> Array:
    return np.asarray(of[place] + part * (of[place + 1] - of[place]))


def _fade(x: Array) -> Array:
    x = np.clip(x, 0, 1)
    return np.asarray(x * x * (3 - 2 * x))


def _highest(values: Array, around: int) -> Array:
    """Return the highest of the values `[N, ...]` up to so many samples away."""
    out = values.copy()
    for n in range(1, around + 1):
        out[n:] = np.maximum(out[n:], values[:-n])
        out[:-n] = np.maximum(out[:-n], values[n:])
    return out


def _average(values: Array, around: int) -> Array:
    """Return the mean of the values `[N, ...]` up to so many samples away, the nearest counting most."""
    weights = 1 + np.cos(np.pi * np.arange(-around, around + 1) / (around + 1))
    out = np.zeros_like(values)
    for n, weight in zip(range(-around, around + 1), weights / weights.sum(), strict=True):
        out[max(0, -n) : len(values) - max(0, n)] += weight * values[max(0, n) : len(values) + min(0, n)]
    return out


def _pick(rig: ContactRig, rotations: Array, translations: Array) -> ContactPose:
    joints = list(rig.joints)
    return ContactPose(
        list(map(tuple, rotations[joints].tolist())), list(map(tuple, translations[joints].tolist()))
    )


def _put(rig: ContactRig, pose: ContactPose, rotations: Array, translations: Array | None) -> None:
    """Write a solved pose of a rig's joints into a pose `[J]`."""
    joints = list(rig.joints)
    rotations[joints] = rotation.normalize(np.array(pose.local))
    if translations is not None:
        translations[joints] = np.array(pose.moved)


class RestingEvaluator:
    """Plays what another evaluator plays, with hands and feet on the tops of props."""

    def __init__(
        self, inner: Poses, project: Project, tops: Sequence[PropTop], carried: Carried | None = None
    ) -> None:
        """tops: in the character's space. carried: as `find_resting_rig` has it."""
        self.inner = inner
        by_clip = isinstance(inner, (MovedEvaluator, GeneratedEvaluator))
        self._planned = isinstance(inner, Evaluator) and not by_clip
        assert project.skeleton is not None
        reach = measure_reach(project)
        tops = [top for top in tops if top.distance <= reach]
        steps = any(top.height <= STEP for top in tops)
        self.stage = RestingStage(
            project.skeleton,
            tuple(tops),
            find_resting_rig(project, carried) if tops else None,
            get_rigs(project).weight.rig if steps else None,
            self._sample,
        )

    def _sample(self, times: Array) -> Pose:
        inner: Any = self.inner
        pose: Pose = inner.before_life(times) if self._planned else inner.at(times, alive=False)
        return pose

    def at(self, seconds: Any) -> Pose:
        """Return the pose at `seconds`, a number or an array `[...]`."""
        pose = self.inner.at(seconds)
        shape = pose.rotations.shape
        one = Pose(pose.rotations.reshape(-1, *shape[-2:]), pose.translations.reshape(-1, shape[-2], 3))
        out = self.stage.run(one, np.asarray(seconds, float).reshape(-1))
        if out is one:
            return pose
        return Pose(out.rotations.reshape(shape), out.translations.reshape(*shape[:-1], 3))

    def morphs_at(self, seconds: float) -> dict[str, float]:
        """Return morph target weights, 0..1, at one time."""
        return self.inner.morphs_at(seconds)

    def faces_at(self, times: Array) -> Faces:
        """Return morph target weights, 0..1, at each of `times [N]`."""
        return self.inner.faces_at(times)
