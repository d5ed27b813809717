"""How a standing body reacts to its arms: the hips give way, spine and legs compensate, and the feet stay.

Rotations are quaternions xyzw, lengths metres; a place is an index into a rig's list of joints. The code
computes one pose at a time, with plain numbers, the same in all languages.

How much: a standing person keeps the centre of mass over the feet, so the hips move back as far as the arms
move it ahead. The weight of each segment is from de Leva 1996. That trunk and legs move against a raised arm
is from Bouisset and Zattara 1987. The other amounts are ours, chosen by eye on the sample.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import cos, sin, sqrt

from metagraph.motion.contact_solve import REACHED, ContactPose, ContactRig, bring, spread
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
)

BALANCE = 1.4  # factor of the arms' shift of the centre of mass by which the hips compensate
HASTE = 0.12  # seconds of the arms' speed that are added to the shift
DIP = 0.05  # seconds: arms that rise this fast press the body down, half as far at most
SPIN = 30.0  # seconds: how far the pelvis turns against what arms turn about the vertical
ROLL = 3.0  # radians that the pelvis rolls for a shift to a side of its own height, and
PITCH = 2.0  # bends for one ahead or back
MOST_SHIFT = 0.02  # of the height
MOST_TURN = 0.1  # radians
SITTING = 0.75  # how high a hip is above its ankle, of the leg's length: below this it does not stand
STANDING = 0.15  # and this much above it stands altogether
GIVE = 0.5  # of a shift: over so much a leg's full length makes itself felt


@dataclass(frozen=True)
class WeightBend:
    """A joint that turns. left, up, ahead: the character's directions in its own space. share: of the hips'
    rotation, below 0 for the opposite direction.
    """

    place: int
    left: Vector
    up: Vector
    ahead: Vector
    share: float


@dataclass(frozen=True)
class WeightCollar:
    """A collar bone. upper: the place of its arm. axis: what lifts it, in its own space. side: 0 left, 1
    right.
    """

    place: int
    upper: int
    axis: Vector
    side: int


@dataclass(frozen=True)
class WeightRig:
    """The part of a skeleton that reacts to its arms. body: its joints; its `arms` are the legs, left and
    right, its `hands` the names of the hands. bends: from the hips up. knees: the direction in which straight
    legs bend, in the upper legs' own spaces. levers: how far the arms are to the left and ahead of the hips.
    up: the character's up direction. height: of the figure, metres. strength: how much of the arms' layer
    counts, 0..1.
    """

    body: ContactRig
    bends: tuple[WeightBend, ...]
    collars: tuple[WeightCollar, ...]
    knees: tuple[Vector, ...]
    levers: tuple[tuple[float, float], ...]
    up: Vector
    height: float
    strength: float


def moves_body(drive: Sequence[float]) -> bool:
    """Return whether there is anything to react to."""
    return any(x != 0.0 for x in drive)


def answer_arms(
    rig: WeightRig, pose: ContactPose, drive: Sequence[float], follow: float, lift: float
) -> bool:
    """Change a pose of the rig's joints in reaction to its arms; return whether it changed.

    drive: as `posing.follow_through.driven` returns it. follow, lift: the user's dials. You need not call
    `spread` first.
    """
    follow = follow * rig.strength
    lift = lift * rig.strength
    if (follow <= 0.0 and lift <= 0.0) or not moves_body(drive):
        return False
    for collar in rig.collars:
        turn = _turn(collar.axis, lift * drive[6 + collar.side])
        pose.local[collar.place] = times(pose.local[collar.place], turn)
        pose.local[collar.upper] = times(back(turn), pose.local[collar.upper])
    if follow <= 0.0:
        return True
    spread(rig.body, pose)
    follow = follow * stands_by(rig, pose)
    if follow <= 0.0:
        return True
    _give_way(rig, pose, drive, follow)
    return True


def stands_by(rig: WeightRig, pose: ContactPose) -> float:
    """Return how much a figure stands: 0 if it sits or lies, 1 on straight legs."""
    least = 1.0
    for leg in rig.body.arms:
        hip, knee, ankle = pose.at[leg.upper], pose.at[leg.lower], pose.at[leg.hand]
        whole = length(minus(knee, hip)) + length(minus(ankle, knee))
        if whole > 1e-6:
            least = min(least, dot(minus(hip, ankle), rig.up) / whole)
    x = min(max((least - SITTING) / STANDING, 0.0), 1.0)
    return x * x * (3.0 - 2.0 * x)


def _give_way(rig: WeightRig, pose: ContactPose, drive: Sequence[float], follow: float) -> None:
    """Shift and rotate the hips, undo that in the spine, and move the legs so that the feet stay."""
    body = rig.body
    vx, vy, vz = drive[8] + drive[11], drive[9] + drive[12], drive[10] + drive[13]
    spin = 0.0
    for side, lever in enumerate(rig.levers):
        lx, lz = lever
        spin += lz * drive[8 + 3 * side] - lx * drive[10 + 3 * side]
    most = MOST_SHIFT * rig.height
    x = _soft(-follow * BALANCE * (drive[0] + drive[3] + HASTE * vx), most)
    y = _soft(-follow * DIP * vy, 0.5 * most)
    z = _soft(-follow * BALANCE * (drive[2] + drive[5] + HASTE * vz), most)
    yaw = _soft(-follow * SPIN * spin / (rig.height * rig.height), MOST_TURN)
    roll = ROLL * x / rig.height
    pitch = -PITCH * z / rig.height
    feet = [pose.at[leg.hand] for leg in body.arms]
    soles = [pose.turned[leg.hand] for leg in body.arms]
    reaches = [length(minus(pose.at[leg.hand], pose.at[leg.upper])) for leg in body.arms]
    hips = rig.bends[0]
    shift = plus(plus(scaled(hips.left, x), scaled(hips.up, y)), scaled(hips.ahead, z))
    shift = rotated(pose.turned[hips.place], shift)
    for bend in rig.bends:
        axis = plus(plus(scaled(bend.left, pitch), scaled(bend.up, yaw)), scaled(bend.ahead, roll))
        pose.local[bend.place] = times(pose.local[bend.place], _turn(axis, bend.share))
    above = body.parents[hips.place]
    space = (0.0, 0.0, 0.0, 1.0) if above < 0 else back(pose.turned[above])
    pose.moved[hips.place] = plus(pose.moved[hips.place], rotated(space, shift))
    spread(body, pose)
    size = length((x, y, z)) + 0.1 * rig.height * length((yaw, roll, pitch))
    low = 0.0
    for side in range(len(feet)):
        low = max(low, hips_sink(rig, pose, side, feet[side], reaches[side], GIVE * size))
    if low > 0.0:
        down = rotated(space, scaled(rig.up, -low))
        pose.moved[hips.place] = plus(pose.moved[hips.place], down)
        spread(body, pose)
    for side in range(len(feet)):
        bring(body, pose, side, feet[side], soles[side], rig.knees[side])


def hips_sink(rig: WeightRig, pose: ContactPose, side: int, foot: Vector, reach: float, soft: float) -> float:
    """Return how far the hips have to sink so that the leg reaches the foot. It sets in gently, a little
    before the limit. reach: the distance of hip and foot before.
    """
    leg = rig.body.arms[side]
    hip, knee, ankle = pose.at[leg.upper], pose.at[leg.lower], pose.at[leg.hand]
    whole = length(minus(knee, hip)) + length(minus(ankle, knee))
    most = max(REACHED * whole, reach)
    way = minus(hip, foot)
    high = dot(way, rig.up)
    aside = dot(way, way) - high * high
    if high <= 0.0 or aside >= most * most or soft <= 0.0:
        return 0.0
    over = high - sqrt(most * most - aside)
    if over >= soft:
        return over
    return 0.0 if over <= -soft else (over + soft) * (over + soft) / (4.0 * soft)


def _soft(x: float, most: float) -> float:
    """Return a number limited smoothly to below `most`; small numbers stay almost as they are."""
    return x / sqrt(1.0 + (x / most) * (x / most))


def _turn(axis: Vector, angle: float) -> Quaternion:
    """Return the rotation about an axis by its length times an angle, radians."""
    x, y, z = axis
    size = length(axis)
    if size <= 0.0:
        return (0.0, 0.0, 0.0, 1.0)
    half = 0.5 * size * angle
    k = sin(half) / size
    return (x * k, y * k, z * k, cos(half))
