"""Move feet to where they should stand, with two-bone legs whose knees keep their direction. The hips move
along and sink, so that no leg snaps straight.

Rotations are quaternions xyzw, lengths metres. The code computes one pose at a time, with plain numbers, the
same in all languages. All amounts are ours, chosen by eye.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import sqrt

from metagraph.motion.contact_solve import ContactPose, bring, spread
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
    unit_turn,
)
from metagraph.motion.weight_solve import GIVE, WeightRig, hips_sink, stands_by

NEAR = 0.0001  # metres that a foot may be away before it is brought
NEARLY = 0.001  # radians that it may be turned away
FOLLOWS = 0.7  # of the feet's way the hips come along
LEANS = 0.1  # of the way to the foot that stands, while the other is
HIGH = 0.05  # metres in the air
TURNING = 0.15  # metres that a turn of a radian counts as way


@dataclass(frozen=True)
class FootGoal:
    """Where a foot's joint should be, in the character's space. planted: how firmly it stands there, 0..1.
    lift: height of a step above that, metres.
    """

    at: Vector
    turn: Quaternion
    planted: float
    lift: float


def foot_way(a: FootGoal, b: FootGoal) -> float:
    """Return the distance between two places of a foot, in metres; a rotation counts as a distance, too."""
    ax, ay, az, aw = a.turn
    bx, by, bz, bw = b.turn
    along = abs(ax * bx + ay * by + az * bz + aw * bw)
    turn = 2.0 * sqrt(max(0.0, 2.0 - 2.0 * along))
    return length(minus(b.at, a.at)) + TURNING * turn


def plant_feet(rig: WeightRig, pose: ContactPose, goals: Sequence[FootGoal], strength: float) -> bool:
    """Move feet to their goals, as far as these are planted; return whether anything moved. goals: left and
    right, or none. strength: the user's dial. You need not call `spread` first.
    """
    if len(goals) != 2 or strength <= 0.0:
        return False
    body = rig.body
    spread(body, pose)
    strength = strength * stands_by(rig, pose)
    if strength <= 0.0:
        return False
    feet = [pose.at[leg.hand] for leg in body.arms]
    soles = [pose.turned[leg.hand] for leg in body.arms]
    reaches = [length(minus(pose.at[leg.hand], pose.at[leg.upper])) for leg in body.arms]
    hips = rig.bends[0].place
    middle = pose.at[hips]
    shift = (0.0, 0.0, 0.0)
    size = 0.0
    moved = False
    for side in range(2):
        goal = goals[side]
        part = strength * goal.planted
        way = minus(plus(goal.at, scaled(rig.up, goal.lift)), feet[side])
        far = length(way)
        if far > NEAR and part > 0.0:
            way = scaled(way, part * (far - NEAR) / far)
            lean = LEANS * part * goal.lift / HIGH
            shift = plus(shift, plus(scaled(way, 0.5 * FOLLOWS), scaled(minus(feet[1 - side], middle), lean)))
            feet[side] = plus(feet[side], way)
            size += length(way)
            moved = True
        x, y, z, w = times(goal.turn, back(soles[side]))
        turn = 2.0 * sqrt(x * x + y * y + z * z)
        if turn > NEARLY and part > 0.0:
            k = part * (turn - NEARLY) / turn
            along = -k if w < 0.0 else k  # the shorter way
            turned = unit_turn((x * along, y * along, z * along, 1.0 - k + abs(w) * k))
            soles[side] = times(turned, soles[side])
            moved = True
    if not moved:
        return False
    shift = minus(shift, scaled(rig.up, dot(shift, rig.up)))
    above = body.parents[hips]
    space = (0.0, 0.0, 0.0, 1.0) if above < 0 else back(pose.turned[above])
    pose.moved[hips] = plus(pose.moved[hips], rotated(space, shift))
    spread(body, pose)
    soft = GIVE * (size + length(shift))
    low = 0.0
    for side in range(2):
        low = max(low, hips_sink(rig, pose, side, feet[side], reaches[side], soft))
    if low > 0.0:
        pose.moved[hips] = plus(pose.moved[hips], rotated(space, scaled(rig.up, -low)))
        spread(body, pose)
    for side in range(2):
        bring(body, pose, side, feet[side], soles[side], rig.knees[side])
    return True
