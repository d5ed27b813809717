"""Bring hands out of the tops of props and to rest on them, and feet onto steps, by arms and legs of two
bones.

Rotations are quaternions xyzw, lengths metres, Y up. The code computes one pose at a time, with plain
numbers. All amounts are ours, chosen by eye.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from math import cos, sin, sqrt

from metagraph.motion.contact_solve import STRAIGHT, ContactPose, ContactRig, bring, spread
from metagraph.motion.plain_vectors import (
    Quaternion,
    Vector,
    back,
    dot,
    length,
    minus,
    plus,
    rotated,
    scaled,
    times,
    unit,
)
from metagraph.motion.weight_solve import WeightRig, hips_sink, stands_by

SOFT = 0.01  # metres below a top and above it over which the push sets in
MOST_LIFT, CARRYING = 0.24, 0.34  # metres that a hand is lifted by, and one that carries something
HANGS = 0.7  # of a hand's length: one that is not as long from above hangs, or points upwards
CLASPED, FREE = 0.12, 0.25  # metres between wrists: hands that hold each other, and that do not
REST = 0.07  # metres above a top from which a hand comes to rest
SWING = 0.9  # radians that an elbow is moved outwards by
STEEP = 0.35  # of the radius on which it moves: an elbow rises by no less for a radian
THIN = 0.7  # of a forearm's radius: the wrist's half thickness
PARTS = 12  # of a forearm, in which the edge is looked for
NEAR = 0.1  # of a forearm: an edge that is nearer to the wrist moves the elbow less
GIVE = 0.5  # of a lift: over so much a leg's full length makes itself felt
Height = Callable[[float, float], tuple[float, float]]  # of x and z: a top's height, and how far inside it is


@dataclass(frozen=True)
class HandPoint:
    """A point of a hand. at: in the space of the joint at `place`. radius: of what is round it. far: whether
    it is at the end of a finger.
    """

    place: int
    at: Vector
    radius: float
    far: bool = False


@dataclass(frozen=True)
class RestingRig:
    """The arms that rest on props. body: their joints. points: of the left and the right hand, the wrist
    first. forearms: their radii. ahead: where the hands' fingers point, across: from the little
    finger to the index finger, directions in the hands' own spaces. carries: whether each hand carries a
    prop, which is not levelled.
    """

    body: ContactRig
    points: tuple[tuple[HandPoint, ...], ...]
    forearms: tuple[float, ...]
    ahead: tuple[Vector, ...]
    across: tuple[Vector, ...]
    carries: tuple[bool, ...] = (False, False)


@dataclass(frozen=True)
class HandRest:
    """What a top does to a hand. height: of the top. push: how much the hand is kept above it, settle: how
    much it is brought down to it, 0..1. pitch, roll: radians by which its fingers and the side of its thumb
    rise, so that it lies flat.
    """

    height: Height
    push: float
    settle: float
    pitch: float = 0.0
    roll: float = 0.0


def put_hands_on_tops(rig: RestingRig, pose: ContactPose, rests: Sequence[Sequence[HandRest]]) -> bool:
    """Move hands onto tops; return whether any moved. rests: for the left and the right hand. You need not
    call `spread` first.
    """
    if not any(rests):
        return False
    spread(rig.body, pose)
    wrists = [pose.at[arm.hand] for arm in rig.body.arms]
    apart = (length(minus(wrists[0], wrists[1])) - CLASPED) / (FREE - CLASPED)
    free = min(max(apart, 0.0), 1.0)
    free = free * free * (3.0 - 2.0 * free)  # hands that hold each other move as one
    ways = [_find_way(rig, pose, side, rests[side], free) for side in range(2)]
    both = max(ways[0][0], ways[1][0])
    moved = False
    for side, (lift, turn) in enumerate(ways):
        lift = both + (lift - both) * free if both > 0.0 else lift
        if abs(lift) < 1e-6 and abs(turn[3]) > 1.0 - 1e-9:
            continue
        arm = rig.body.arms[side]
        goal = plus(wrists[side], (0.0, lift, 0.0))
        bring(rig.body, pose, side, goal, times(turn, pose.turned[arm.hand]), STRAIGHT)
        moved = True
    for side in range(2):
        for rest in rests[side]:
            if rest.push > 0.0 and _swing_elbow(rig, pose, side, rest):
                moved = True
    return moved


def _find_way(
    rig: RestingRig, pose: ContactPose, side: int, rests: Sequence[HandRest], free: float
) -> tuple[float, Quaternion]:
    """Return how far a hand is lifted, metres, and how it is turned."""
    points = [
        (plus(pose.at[p.place], rotated(pose.turned[p.place], p.at)), p.radius) for p in rig.points[side]
    ]
    wrist = points[0][0]
    turn = (0.0, 0.0, 0.0, 1.0)
    raised, lowered = 0.0, 0.0
    for rest in rests:
        if not rig.carries[side] and free > 0.0 and (rest.pitch != 0.0 or rest.roll != 0.0):
            level = _level(rig, pose, side, rest, free)
            turn = times(level, turn)
            points = [(plus(wrist, rotated(level, minus(at, wrist))), radius) for at, radius in points]
        need = _find_need(rest, points)
        raised = max(raised, rest.push * _limit(_soften(need), CARRYING if rig.carries[side] else MOST_LIFT))
        lowered = max(lowered, rest.settle * _soften(min(-need, REST)))
    return raised - lowered, turn


def _find_need(rest: HandRest, points: Sequence[tuple[Vector, float]]) -> float:
    """Return how far the lowest of a hand's points is below where it lies on a top, metres."""
    return max(rest.height(at[0], at[2])[0] + radius - at[1] for at, radius in points)


def _soften(x: float) -> float:
    """Return a number without what is below 0, softly."""
    if x <= -SOFT:
        return 0.0
    return x if x >= SOFT else (x + SOFT) * (x + SOFT) / (4.0 * SOFT)


def _limit(x: float, most: float) -> float:
    """Return a lift that is never more than so much."""
    by = x / most
    by = by * by * by * by
    return x / sqrt(sqrt(sqrt(1.0 + by * by)))


def _fade(x: float) -> float:
    """Return 0 up to 0, 1 from 1 on, smoothly more between."""
    x = min(max(x, 0.0), 1.0)
    return x * x * (3.0 - 2.0 * x)


def _level(rig: RestingRig, pose: ContactPose, side: int, rest: HandRest, free: float) -> Quaternion:
    """Return the turn about the wrist that lays a hand flat."""
    hand = rig.body.arms[side].hand
    way = rotated(pose.turned[hand], rig.ahead[side])
    flat = sqrt(way[0] * way[0] + way[2] * way[2])
    free = free * _fade(flat / HANGS)  # one that hangs has no direction
    flat = max(flat, 1e-6)
    turn = _about((-way[2] / flat, 0.0, way[0] / flat), free * rest.pitch)
    return times(_about(rotated(turn, way), free * rest.roll), turn)


def _about(axis: Vector, angle: float) -> Quaternion:
    """Return the rotation about an axis of length 1 by an angle, radians."""
    k = sin(0.5 * angle)
    return (axis[0] * k, axis[1] * k, axis[2] * k, cos(0.5 * angle))


def _swing_elbow(rig: RestingRig, pose: ContactPose, side: int, rest: HandRest) -> bool:
    """Move an elbow outwards, as far as its forearm cuts the edge of a top; return whether it moved."""
    arm = rig.body.arms[side]
    root, elbow, wrist = pose.at[arm.upper], pose.at[arm.lower], pose.at[arm.hand]
    rise = rest.push * _find_rise(rest, elbow, wrist, rig.forearms[side])
    if rise <= 0.0:
        return False
    ahead = unit(minus(wrist, root))
    bone = minus(elbow, root)
    aside = minus(bone, scaled(ahead, dot(bone, ahead)))
    out = 1.0 if side == 0 else -1.0
    round_ = length(aside)
    if round_ < 1e-6:
        return False
    over = out * (ahead[2] * aside[0] - ahead[0] * aside[2])
    angle = min(rise / max(over, STEEP * round_), SWING)
    turn = _about(ahead, out * angle)
    above = rig.body.parents[arm.upper]
    space = (0.0, 0.0, 0.0, 1.0) if above < 0 else pose.turned[above]
    hand = pose.turned[arm.hand]
    pose.local[arm.upper] = times(back(space), times(turn, pose.turned[arm.upper]))
    below = rig.body.parents[arm.hand]
    pose.local[arm.hand] = times(back(times(turn, pose.turned[below])), hand)
    return True


def _find_rise(rest: HandRest, elbow: Vector, wrist: Vector, radius: float) -> float:
    """Return how far an elbow has to rise so that its forearm does not cut the edge of a top, metres."""
    high, before = rest.height(wrist[0], wrist[2])
    if before < 0.5:
        return 0.0
    share = _fade(2.0 * before - 1.0)  # a forearm along the edge comes over it little by little
    below = max(0.0, high + radius * THIN - wrist[1])  # what is not lifted out altogether
    way = minus(elbow, wrist)
    for n in range(1, PARTS + 1):
        part = n / PARTS
        high, inside = rest.height(wrist[0] + part * way[0], wrist[2] + part * way[2])
        if inside < 0.5:
            part -= (0.5 - inside) / (before - inside) / PARTS  # where it crosses the edge
            break
        before = inside
    cut = high + radius * (THIN + (1.0 - THIN) * part) - wrist[1] - part * way[1] - below
    return share * max(0.0, cut) / (part + NEAR)


def lift_feet(rig: WeightRig, pose: ContactPose, lifts: Sequence[float]) -> bool:
    """Lift feet by the heights of the steps below them, and a standing body by the lower of both; return
    whether anything moved. You need not call `spread` first.
    """
    if max(lifts) < 1e-6:
        return False
    body = rig.body
    spread(body, pose)
    stands = stands_by(rig, pose)
    feet = [plus(pose.at[leg.hand], scaled(rig.up, lifts[n])) for n, leg in enumerate(body.arms)]
    soles = [pose.turned[leg.hand] for leg in body.arms]
    reaches = [length(minus(pose.at[leg.hand], pose.at[leg.upper])) for leg in body.arms]
    hips = rig.bends[0].place
    above = body.parents[hips]
    space = (0.0, 0.0, 0.0, 1.0) if above < 0 else back(pose.turned[above])
    rise = stands * min(lifts)
    pose.moved[hips] = plus(pose.moved[hips], rotated(space, scaled(rig.up, rise)))
    spread(body, pose)
    soft = GIVE * (max(lifts) - min(lifts))
    low = max(hips_sink(rig, pose, side, feet[side], reaches[side], soft) for side in range(2))
    if low > 0.0:
        pose.moved[hips] = plus(pose.moved[hips], rotated(space, scaled(rig.up, -low)))
        spread(body, pose)
    for side in range(2):
        bring(body, pose, side, feet[side], soles[side], rig.knees[side])
    return True


def set_carried(rig: RestingRig, points: Sequence[Sequence[HandPoint]]) -> RestingRig:
    """Return a rig whose hands carry things, whose points are kept above tops as well."""
    return replace(
        rig,
        points=tuple((*own, *more) for own, more in zip(rig.points, points, strict=True)),
        carries=tuple(bool(more) for more in points),
    )
