"""What somebody sits on: a seat under the body's stance whose hips are low and whose thighs lie level, or the
floor.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from metagraph.graph import anatomy
from metagraph.graph.checks.end_gaps import get_action_motion
from metagraph.graph.face.rig import gather_face_parts
from metagraph.graph.model import Action, Project
from metagraph.graph.remembered import Remembered

# Ours, from the sample's figures: who sits has the hips no higher than this part of how they stand, no lower,
LOW, LYING = 0.75, 0.3
LEVEL = 0.5  # and thighs that rise or fall by no more than this part of their length
UPRIGHT = 0.8  # and, on the floor, a trunk of whose length this part rises
ROUND = 2.0  # thighs: the radius of who sits on the floor, legs included
THICK, WIDE = 0.19, 0.42  # of a thigh's length: from its joint down to the seat, and the seat's radius


@dataclass(frozen=True)
class Seat:
    """A round seat, or a place on the floor. at: the middle of its top, metres, Y up. radius: metres. turn:
    where who sits there faces, radians about +Y. stance: the id of the stance that sits there.
    """

    at: tuple[float, float, float]
    radius: float
    turn: float = 0.0
    floor: bool = False
    stance: str = ""


_known: Remembered[Seat | None] = Remembered(gather_face_parts)


def find_seat(project: Project) -> Seat | None:
    """Return what a project's body sits on in its first stance that sits, None if it never does."""
    if project.skeleton is None:
        return None
    loops = [a for a in project.graphs["body"].actions.values() if a.kind == "stance"]
    return _known.of(project, (project.base, tuple(a.id for a in loops)), lambda: _found(project, loops))


def _found(project: Project, loops: list[Action]) -> Seat | None:
    roles, skeleton = anatomy.project_roles(project), project.skeleton
    names = [f"{side}_{part}" for part in ("upper_leg", "lower_leg") for side in ("left", "right")]
    if skeleton is None or not {"hips", *names} <= roles.keys():
        return None
    hips, *legs = (roles[name] for name in ("hips", *names))
    _, standing = skeleton.globals(anatomy.get_base_pose(project))
    for loop in loops:
        motion = get_action_motion(project, loop)
        if motion is None:
            continue
        _, at = skeleton.globals(motion.pose_at(project.span(loop)[0]))
        at = np.asarray(at, float)
        upper, lower = at[legs[:2]].mean(0), at[legs[2:]].mean(0)
        thigh = float(np.linalg.norm(at[legs[:2]] - at[legs[2:]], axis=1).mean())
        low = LYING < at[hips, 1] / max(float(standing[hips, 1]), 1e-6) < LOW
        if low and abs(upper[1] - lower[1]) < LEVEL * thigh and upper[1] > THICK * thigh:
            ahead = 0.08 * (lower - upper)
            place = (float(upper[0] + ahead[0]), float(upper[1]) - THICK * thigh, float(upper[2] + ahead[2]))
            ways = lower - upper
            return Seat(place, WIDE * thigh, math.atan2(ways[0], ways[2]), stance=loop.id)
        trunk = at[roles["head"]] - at[hips] if "head" in roles else np.zeros(3)
        rises = float(trunk[1]) > UPRIGHT * float(np.linalg.norm(trunk)) > 0
        if at[hips, 1] <= LYING * max(float(standing[hips, 1]), 1e-6) and rises:
            legs_middle = (upper + lower) / 2
            return Seat(
                (float(legs_middle[0]), 0.0, float(legs_middle[2])), ROUND * thigh, floor=True, stance=loop.id
            )
    return None
