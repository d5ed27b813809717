"""What each stance of a project looks like: its loops posed alone on the base pose, as keypoints, as
measures.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.graph import anatomy
from metagraph.graph.model import LAYERS, Layer, Project
from metagraph.mimicry.keypoint_layouts import PLACE, POINTS, swap
from metagraph.mimicry.pose_measures import measure_body_frame, measure_pose
from metagraph.motion import rotation
from metagraph.motion.skeleton import Pose, Skeleton
from metagraph.playback.evaluator import Evaluator
from metagraph.playback.plan import LayerPlan, Plan, Rest
from metagraph.playback.posing.composer import find_playable_motion

Array = NDArray[Any]

FRAMES = 9  # of each loop, averaged
SWAPPED = 0.3  # what it costs a stance of the arms to be recognised with left and right changed over
# Where ears, eyes and nose are beside the middle of the eyes: out, up, forwards; metres of a face on a torso
# of TORSO metres.
FACE = {"ear": (0.075, -0.012, -0.1), "eye": (0.032, 0.0, 0.0), "nose": (0.0, -0.04, 0.025)}
EYES = (0.0, 0.075, 0.085)  # the middle of the eyes beside the head's joint, where the character has none
TORSO = 0.48  # metres from hips to shoulders of somebody 1.75 m tall
_ROLES = {
    "shoulder": "upper_arm",
    "elbow": "lower_arm",
    "wrist": "hand",
    "hip": "upper_leg",
    "knee": "lower_leg",
    "ankle": "foot",
}


@dataclass(frozen=True, eq=False)
class Signature:
    """A layer's stances. stances: their ids, S. measures `[T, N, 3]` of what they look like, of each loop,
    for the arms of its mirror image, too; of `[T]` which stance it is; extra `[T]` how much farther it
    counts.
    """

    stances: tuple[str, ...]
    measures: Array
    of: Array
    extra: Array


class BodySignature:
    """Keypoints of a project's character. Raises ValueError if a project has no humanoid character."""

    def __init__(self, project: Project) -> None:
        if project.skeleton is None:
            raise ValueError("the project has no clips, so that there is no character to mimic with")
        roles = anatomy.project_roles(project)
        needed = {
            f"{side}_{_ROLES[part]}"
            for part in ("shoulder", "elbow", "wrist", "hip")
            for side in ("left", "right")
        } | {"head"}
        missing = sorted(needed - set(roles))
        if missing:
            raise ValueError(
                f"the character cannot mimic: nothing is known to be its {', '.join(missing)}. Set the roles "
                "of its skeleton."
            )
        self.skeleton: Skeleton = project.skeleton
        self.head = roles["head"]
        self.places, self.joints = [], []
        for part, role in _ROLES.items():
            for side in ("left", "right"):
                if f"{side}_{role}" in roles:
                    self.places.append(PLACE[f"{side}_{part}"])
                    self.joints.append(roles[f"{side}_{role}"])
        self.confidence = np.zeros(len(POINTS))
        self.confidence[
            [
                *self.places,
                *(n for n, name in enumerate(POINTS) if name == "nose" or name.endswith(("_eye", "_ear"))),
            ]
        ] = 1.0
        self._face = self._in_the_head(anatomy.get_base_pose(project), roles)

    def _in_the_head(self, base: Pose, roles: Mapping[str, int]) -> dict[int, Array]:
        """Return where the points of the face are in the space of the head's joint, from a pose that looks
        ahead.
        """
        turns, places = self.skeleton.globals(base)
        at = {name: places[j].astype(float) for name, j in roles.items()}
        across = (at["left_upper_arm"] - at["right_upper_arm"]) * [1, 0, 1]
        across /= max(float(np.linalg.norm(across)), 1e-9)
        ahead = np.array([-across[2], 0.0, across[0]])
        torso = (
            at["left_upper_arm"] + at["right_upper_arm"] - at["left_upper_leg"] - at["right_upper_leg"]
        ) / 2
        scale = float(np.linalg.norm(torso)) / TORSO

        def away(out: float, up: float, forwards: float) -> Array:
            return np.asarray((across * out + np.array([0.0, up, 0.0]) + ahead * forwards) * scale)

        head = at["head"]
        eyes = (
            (at["left_eye"] + at["right_eye"]) / 2
            if "left_eye" in at and "right_eye" in at
            else head + away(*EYES)
        )
        out = {}
        for name, place in PLACE.items():
            side, _, part = name.rpartition("_")
            if part in FACE:
                x, y, z = FACE[part]
                out[place] = eyes + away(-x if side == "right" else x, y, z) - head
        back = rotation.conjugate(turns[self.head].astype(float))
        return {place: rotation.rotate_vectors(back, v) for place, v in out.items()}

    def points(self, pose: Pose) -> Array:
        """Return the POINTS `[..., 17, 3]` of poses, metres; zeros if there is no such joint (`confidence
        [17]` says which).
        """
        turns, places = self.skeleton.globals(pose)
        out = np.zeros((*places.shape[:-2], len(POINTS), 3))
        out[..., self.places, :] = places[..., self.joints, :]
        for place, inside in self._face.items():
            out[..., place, :] = places[..., self.head, :] + rotation.rotate_vectors(
                turns[..., self.head, :], inside
            )
        return out


def compute_signatures(
    project: Project, body: BodySignature, layers: Collection[Layer] = LAYERS
) -> tuple[dict[Layer, Signature], float]:
    """Return what the stances of each layer look like, and the shoulders' width in torso lengths. Stances
    whose clips are missing are not among them, nor layers without any.
    """
    width = _width(body, anatomy.get_base_pose(project))
    out = {}
    for layer in LAYERS:
        if layer not in layers:
            continue
        stances: list[str] = []
        rows, of, extra = [], [], []
        for stance in project.graphs[layer].stances.values():
            loops = [
                x
                for x in project.graphs[layer].of(stance.id, "stance")
                if find_playable_motion(project, x) is not None
            ]
            seen = [
                s
                for loop in loops
                if (s := _seen(project, body, layer, Rest(stance.id, loop, 0.0, 0.0, 0.0))) is not None
            ]
            for points in seen:
                for other, cost in ((False, 0.0), (True, SWAPPED)):
                    if other and layer != "arms":
                        continue
                    shown, sure = swap(points, body.confidence) if other else (points, body.confidence)
                    frame = measure_body_frame(shown, sure, 3, width)
                    if frame is not None:
                        rows.append(measure_pose(layer, shown, frame))
                        of.append(len(stances))
                        extra.append(cost)
            if seen:
                stances.append(stance.id)
        if rows:
            out[layer] = Signature(tuple(stances), np.array(rows), np.array(of), np.array(extra))
    return out, width


def _width(body: BodySignature, pose: Pose) -> float:
    frame = measure_body_frame(body.points(pose), body.confidence, 3, 0.7)
    return frame.width if frame is not None else 0.7


def _seen(project: Project, body: BodySignature, layer: Layer, rest: Rest) -> Array | None:
    """Return the POINTS `[17, 3]` of a loop, averaged; None if they make no figure."""
    start, end = project.span(rest.action)
    layers = {x: LayerPlan(x, rests=(rest,)) if x == layer else LayerPlan(x) for x in LAYERS}
    times = np.linspace(0.0, max(0.0, end - start - rest.action.timing.blend_in), FRAMES, endpoint=False)
    pose = Evaluator(Plan(0, end - start, layers), project).at(times, alive=False)
    points = np.asarray(body.points(pose).mean(0))
    return points if np.isfinite(points).all() else None
