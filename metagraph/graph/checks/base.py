"""Find problems of the base pose."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from metagraph.common.wording import phrase
from metagraph.graph import anatomy
from metagraph.graph.checks import end_gaps
from metagraph.graph.model import LAYERS, Action, ClipEntry, Layer, Project
from metagraph.graph.problem import Problem
from metagraph.motion import rotation
from metagraph.motion.features import measure_pose_distance
from metagraph.motion.skeleton import Skeleton

FLOATS = 0.06  # of the height: how far the base pose's feet may be from the feet of the stances
TWISTED = np.radians(50)  # how far the base pose's hips may be turned away from the stance's


def check_base(project: Project) -> Iterator[Problem]:
    """Yield the problems of the base pose: it is missing, or far from how the character stands."""
    if project.skeleton is None:
        return
    if project.base.clip is not None:
        entry = project.clips.get(project.base.clip)
        if entry is None or entry.motion is None:
            yield Problem(
                "error",
                "base-missing",
                phrase("the clip of the base pose is missing"),
                phrase("Choose another base pose."),
                clip=project.base.clip,
            )
            return
        if project.base.frame >= entry.frames:
            yield _past_the_end(project.base.frame, entry)
    elif any(project.graphs[layer].actions for layer in LAYERS):
        yield from _rest_pose(project, project.skeleton)
    yield from _beside_stance(project, project.skeleton)


def _past_the_end(frame: int, entry: ClipEntry) -> Problem:
    last = entry.frames - 1
    return Problem(
        "error",
        "base-frame",
        phrase(
            "the base pose is frame {frame} of '{name}', but that clip ends at frame {last}",
            frame=frame,
            name=entry.name,
            last=last,
        ),
        phrase("Choose a frame inside the clip."),
        clip=entry.id,
    )


def _rest_pose(project: Project, skeleton: Skeleton) -> Iterator[Problem]:
    """Yield a problem if the rest pose, which is the base pose if none is chosen, is far from the stances."""
    first = _first_pose(project, _start_loop(project, "body") or _start_loop(project, "arms"))
    if first is None:
        return
    if float(measure_pose_distance(skeleton, first, anatomy.get_base_pose(project))) > 0.25 * skeleton.height:
        yield Problem(
            "warning",
            "base-rest",
            phrase(
                "the base pose is the skeleton's rest pose, far from the character's stances; adding "
                "the layers twists the pose"
            ),
            phrase(
                "Find a frame with the hands at the sides, right-click its clip and choose 'Use this "
                "frame as base pose'."
            ),
        )


def _beside_stance(project: Project, skeleton: Skeleton) -> Iterator[Problem]:
    """Yield problems if the base pose is lower, higher or turned, compared with the stance that the body
    begins in.
    """
    loop = _start_loop(project, "body")
    stance = _first_pose(project, loop)
    if loop is None or stance is None:
        return
    rests = get_stance_name(project, loop.stance)
    base = anatomy.get_base_pose(project)
    height = skeleton.height
    base_r, base_p = skeleton.globals(base)
    stance_r, stance_p = skeleton.globals(stance)
    roles = anatomy.project_roles(project)
    feet = [roles[r] for r in ("left_foot", "right_foot", "left_toes", "right_toes") if r in roles]
    lift = float(base_p[feet, 1].min() - stance_p[feet, 1].min()) if feet else 0.0
    if abs(lift) > FLOATS * height:
        way = phrase("above") if lift > 0 else phrase("below")
        yield Problem(
            "warning",
            "base-floats",
            phrase(
                "the base pose is {far:.0f} cm {way} stance '{rests}'; the character will not stay on "
                "the ground",
                far=abs(lift) * 100,
                way=way,
                rests=rests,
            ),
            phrase("Choose a base pose from a clip in which the character stands as in its stances."),
            clip=project.base.clip,
        )
    hips = roles.get("hips", 0)
    turn = float(rotation.measure_angle_between(base_r[hips], stance_r[hips]))
    if turn > TWISTED:
        yield Problem(
            "warning",
            "base-twisted",
            phrase(
                "the hips of the base pose are turned {degrees:.0f}° away from stance '{rests}'; the "
                "character will twist",
                degrees=np.degrees(turn),
                rests=rests,
            ),
            phrase("Choose a base pose from a clip that faces the same way."),
            clip=project.base.clip,
        )


def _start_loop(project: Project, layer: Layer) -> Action | None:
    graph = project.graphs[layer]
    return next(iter(graph.of(graph.start, "stance")), None) if graph.start else None


def _first_pose(project: Project, loop: Action | None) -> Any:
    motion = end_gaps.get_action_motion(project, loop)
    return motion.pose_at(project.span(loop)[0]) if motion is not None and loop is not None else None


def get_stance_name(project: Project, stance: str | None) -> str:
    """Return a stance's name, "?" if it does not exist."""
    found = project.stance(stance)
    return found.name if found is not None else "?"
