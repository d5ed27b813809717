"""Measure how far a clip's ends are from the stances it leaves and enters, and how far they may be. All
warnings of visible jumps use these distances.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any, Literal
from weakref import ref

import numpy as np
from numpy.typing import NDArray

from metagraph.common.wording import phrase
from metagraph.graph import anatomy
from metagraph.graph.expand import find_end_stance
from metagraph.graph.model import PARTS, Action, MetaGraph, Part, Project
from metagraph.graph.repeating import cycle_of
from metagraph.motion.clip import Clip
from metagraph.motion.features import measure_pose_distance
from metagraph.motion.rig_controls import find_rig_controls
from metagraph.motion.skeleton import Skeleton

Array = NDArray[Any]
Edge = Literal["begins", "ends"]

TALL = 1.6  # metres: height of the figure that the other constants are for
FAR = 0.08  # metres a joint may be from the stance at a clip's ends before it shows
OPEN_LOOP = 0.05  # metres a loop may be open if its seam is not blended
LONG = 0.4  # seconds: a longer blend is a movement of its own, not a hidden seam
UNHURRIED = 1.0  # metres a second: how fast, on average, the farthest joint may move in such a blend
SHARE_SEEN = 0.38  # of what a gesture or fidget plays, that one blend may take, so that it is seen
BRISK = 1.4  # times as far for what repeats: an arm that comes up to wave is a movement that is meant


@dataclass(frozen=True)
class EndGap:
    """The gap between an end of a clip and a stance.

    `edge` is the end of the clip, `stance` the stance's id, `metres` the distance of the farthest joint,
    `most` the distance in metres that does not show with a blend of `blend` seconds.
    """

    edge: Edge
    stance: str
    metres: float
    most: float
    blend: float

    @property
    def far(self) -> bool:
        return self.metres > self.most

    @property
    def slow(self) -> bool:
        """Return whether a long blend covers the gap at an unhurried pace."""
        return self.blend >= LONG and not self.far


def describe_gap(gap: EndGap, stance: str) -> str:
    """Describe a gap in the words that all warnings use. `stance` is the stance's name."""
    far = gap.metres * 100
    if gap.edge == "begins":
        return phrase("begins {far:.0f} cm from stance '{stance}'", far=far, stance=stance)
    return phrase("ends {far:.0f} cm from stance '{stance}'", far=far, stance=stance)


def measure_hidden_gap(height: float, blend: float) -> float:
    """Return how many metres a blend of `blend` seconds covers without a visible jump. `height` is the
    skeleton's.
    """
    return max(FAR, UNHURRIED * blend if blend >= LONG else 0.0) * height / TALL


def blend_for(height: float, metres: float) -> float:
    """Return the shortest blend, in seconds, that covers a distance at an unhurried pace."""
    return max(LONG, metres * TALL / height / UNHURRIED)


def find_slow_distances(metres: Array, height: float, blend: float) -> Array:
    """Return where a long blend of `blend` seconds covers distances, in metres, at an unhurried pace."""
    return np.asarray((blend >= LONG) & (metres <= measure_hidden_gap(height, blend)))


def measure_distances_to_stance(project: Project, action: Action, times: Array) -> tuple[Array, Array]:
    """Return how far the pose at each of `times` `[F]`, seconds of an action's clip, is from the stance it
    leaves and from the one it enters, metres `[F]`; infinite if that cannot be measured.
    """
    motion = get_action_motion(project, action)
    graph, out = project.graphs[action.layer], []
    for stance in (action.stance, find_end_stance(action)):
        loop = next(iter(graph.of(stance, "stance")), None) if stance else None
        target = get_action_motion(project, loop)
        if motion is None or loop is None or target is None:
            out.append(np.full(len(times), np.inf))
            continue
        there = target.pose_at(np.full(len(times), project.span(loop)[0]))
        joints = find_reached_joints(project, graph, action)
        out.append(measure_pose_distance(motion.skeleton, motion.pose_at(times), there, joints))
    return out[0], out[1]


def find_end_gaps(project: Project, graph: MetaGraph, action: Action) -> list[EndGap]:
    """Return the gaps at both ends of an action that is not a loop, on the joints its layer moves. Gaps that
    cannot be measured are left out.
    """
    motion = get_action_motion(project, action)
    if motion is None or project.skeleton is None or action.kind == "stance":
        return []
    joints, height = find_reached_joints(project, graph, action), project.skeleton.height
    start, end = project.span(action)
    t, out = action.timing, []
    ends: tuple[tuple[Edge, str | None, float, float], ...] = (
        ("begins", action.stance, start, t.blend_in),
        ("ends", find_end_stance(action), end, t.blend_out),
    )
    for edge, stance, moment, blend in ends:
        loop = next(iter(graph.of(stance, "stance")), None) if stance else None
        target = get_action_motion(project, loop)
        if stance is not None and loop is not None and target is not None:
            metres = _gap(motion, moment, target, project.span(loop)[0], joints)
            most = measure_hidden_gap(height, blend) * (
                BRISK if cycle_of(action.kind, t, start, end) > 0 else 1.0
            )
            out.append(EndGap(edge, stance, metres, most, blend))
    return out


def measure_slides(project: Project, graph: MetaGraph, action: Action) -> dict[Edge, float]:
    """Return how many metres the hips have to go over the floor at each end of an action, from and to the
    loop of its stance; nothing on a layer that leaves the legs alone.
    """
    motion = get_action_motion(project, action)
    if motion is None or action.kind == "stance" or graph.weight("legs") <= 0:
        return {}
    hips, out = anatomy.project_roles(project).get("hips", 0), {}
    start, end = project.span(action)
    ends: tuple[tuple[Edge, str | None, float], ...] = (
        ("begins", action.stance, start),
        ("ends", find_end_stance(action), end),
    )
    for edge, stance, moment in ends:
        loop = next(iter(graph.of(stance, "stance")), None) if stance else None
        target = get_action_motion(project, loop)
        if loop is not None and target is not None:
            poses = (motion.pose_at(moment), target.pose_at(project.span(loop)[0]))
            here, there = (motion.skeleton.globals(pose)[1][hips] for pose in poses)
            out[edge] = float(np.hypot(here[0] - there[0], here[2] - there[2]))
    return out


def measure_seam(project: Project, graph: MetaGraph, loop: Action) -> EndGap | None:
    """Return the gap between a loop's ends, on the joints its layer moves, with the distance that shows if it
    is not blended; None if it cannot be measured.
    """
    motion = get_action_motion(project, loop)
    if motion is None or project.skeleton is None:
        return None
    start, end = project.span(loop)
    metres = _gap(motion, start, motion, end, find_reached_joints(project, graph, loop))
    return EndGap("ends", loop.stance, metres, OPEN_LOOP * project.skeleton.height / TALL, 0.0)


def get_action_motion(project: Project, action: Action | None) -> Clip | None:
    """Return an action's clip if it is loaded and has the project's skeleton, else None."""
    entry = project.clips.get(action.clip) if action is not None else None
    motion = entry.motion if entry is not None else None
    return motion if motion is not None and motion.skeleton == project.skeleton else None


def find_reached_joints(project: Project, graph: MetaGraph, action: Action) -> tuple[int, ...]:
    """Return the joints that an action's layer moves and its mask leaves in, without those that only control
    others.
    """
    moved = anatomy.make_action_mask(project, action)
    weighty = tuple(part for part in PARTS if part != "face" and graph.weight(part) > 0)
    reached = _reached_by(project.skeleton, anatomy.project_parts(project), weighty)
    if moved is None:
        return reached
    moves = moved.tolist()
    return tuple(j for j in reached if moves[j] > 0)


@lru_cache(maxsize=64)
def _reached_by(
    skeleton: Skeleton | None, parts: tuple[Part, ...], weighty: tuple[Part, ...]
) -> tuple[int, ...]:
    """Return the joints of the body parts that a layer moves, without those that only control others."""
    controls = find_rig_controls(skeleton) if skeleton is not None else ()
    return tuple(j for j, part in enumerate(parts) if part in weighty and j not in controls)


def _gap(one: Clip, seconds: float, other: Clip, there: float, joints: tuple[int, ...]) -> float:
    """Return the largest distance of the joints in metres, without the root. The first clip remembers it, so
    other edits take no time, and holds the other by `ref`, so that those of a closed project are freed.
    """
    return one.measured(
        ("gap", seconds, ref(other), there, joints),
        lambda: float(
            measure_pose_distance(one.skeleton, one.pose_at(seconds), other.pose_at(there), joints)
        ),
    )
