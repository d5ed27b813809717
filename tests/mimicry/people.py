"""People for tests of mimicry: the toy made into somebody whose stances are known, and what a camera sees of
them.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from metagraph.graph import edits
from metagraph.graph.model import Life, Project
from metagraph.mimicry.keypoint_layouts import swap
from metagraph.mimicry.signatures import BodySignature
from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.motion.skeleton import Skeleton

# Where the hands are held in each stance: turn of the left upper arm and forearm about z and about y,
# degrees; the right mirrors it.
ARMS = {
    "down": ((-80, 0), (0, 0)),
    "hips": ((-45, 0), (-80, 0)),
    "raised": ((40, 0), (40, 0)),
    "ahead": ((-20, -70), (0, -40)),
}


def still(
    skeleton: Skeleton, name: str, turns: dict[str, tuple[float, float, float]], seconds: float = 2.0
) -> Clip:
    """A clip in which nothing moves. turns: joint -> degrees about x, y, z from the rest pose."""
    one = skeleton.rest_rotations.copy()
    for joint, degrees in turns.items():
        one[skeleton.index(joint)] = rotation.from_euler(
            np.radians(np.array(degrees, float)[[2, 1, 0]]), "ZYX"
        )
    frames = round(seconds * 30) + 1
    return Clip(
        name,
        skeleton,
        30,
        np.tile(one, (frames, 1, 1)),
        np.tile(skeleton.rest_translations[:1], (frames, 1, 1)),
    )


def arms(kind: str) -> dict[str, tuple[float, float, float]]:
    (up, ahead), (bend, inward) = ARMS[kind]
    left = {"LeftUpperArm": (0.0, ahead, up), "LeftLowerArm": (0.0, inward, bend)}
    return {**left, "RightUpperArm": (0.0, -ahead, -up), "RightLowerArm": (0.0, -inward, -bend)}


def somebody(skeleton: Skeleton) -> Project:
    """A project with stances of the arms (ARMS), and of the head: straight, left, right (tilted by 14
    degrees), all joined.
    """
    clips = [still(skeleton, f"arms {kind}", arms(kind)) for kind in ARMS]
    base = arms("down")
    tilts = {"straight": 0.0, "left": -14.0, "right": 14.0}
    clips += [still(skeleton, f"head {name}", {**base, "Head": (0, 0, tilt)}) for name, tilt in tilts.items()]
    names = {"arms": list(ARMS), "head": list(tilts)}
    ways = [(layer, a, b) for layer, some in names.items() for a in some for b in some if a != b]
    clips += [
        still(skeleton, f"{layer} {a} to {b}", arms(b) if layer == "arms" else base, 0.5)
        for layer, a, b in ways
    ]
    project = edits.add_clips(
        Project("somebody", life=Life(on=False)), [(f"{c.name}.glb", 0, "", c) for c in clips]
    )
    clip = {entry.name: entry.id for entry in project.clips.values()}
    for layer, some in names.items():
        for name in some:
            project = edits.add_stance(project, layer, name, [clip[f"{layer} {name}"]])  # type: ignore[arg-type]
    stance = {(layer, s.name): s.id for layer in names for s in project.graphs[layer].stances.values()}  # type: ignore[index]
    for layer, a, b in ways:
        project = edits.place_clips(
            project, [clip[f"{layer} {a} to {b}"]], layer, "transition", stance[layer, a], stance[layer, b]
        )  # type: ignore[arg-type]
    return edits.set_base(project, clip["arms down"])


def standing(project: Project, kind: str, tilt: float = 0.0, other: bool = False) -> Any:
    """The POINTS `[17, 3]` of somebody in a stance of the arms. other: left and right changed over."""
    assert project.skeleton is not None
    pose = still(project.skeleton, "now", {**arms(kind), "Head": (0, 0, tilt)}).pose_at(0.0)
    body = BodySignature(project)
    points = body.points(pose)
    return swap(points, body.confidence)[0] if other else points


def stance(project: Project, layer: str, name: str) -> str:
    """Id of a stance."""
    return next(s.id for s in project.graphs[layer].stances.values() if s.name == name)  # type: ignore[index]
