"""Recordings of a face alone, on a project's character: its head turns, its eyes look, its blend shapes move;
the rest of the body is in the base pose, and what plays it moves the face alone.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.graph import anatomy
from metagraph.graph.face.rig import find_body_axes
from metagraph.graph.model import Project
from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.motion.joint_map import RetargetError, make_fingerprint
from metagraph.motion.skeleton import Skeleton

Array = NDArray[Any]

FACE_SKELETON = Skeleton(
    ("FaceCaptureHead", "FaceCaptureLeftEye", "FaceCaptureRightEye"),
    np.array([-1, 0, 0]),
    np.tile([0.0, 0.0, 0.0, 1.0], (3, 1)),
    np.array([[0.0, 0.0, 0.0], [0.032, 0.07, 0.08], [-0.032, 0.07, 0.08]]),
)
FACE_TAKE = make_fingerprint(FACE_SKELETON)
_LOOKS = ("eyeLookUp", "eyeLookDown", "eyeLookIn", "eyeLookOut")


def is_face_take(clip: Clip) -> bool:
    """Whether a clip, as it was read, is of a face alone."""
    return clip.skeleton == FACE_SKELETON


def put_on_body(project: Project, clip: Clip) -> Clip:
    """Return a face's recording on the project's skeleton. Raises RetargetError if it has no head.

    Eyes that are joints turn by the recorded angles, and then not by the shapes that say the same.
    """
    skeleton = project.skeleton
    roles = anatomy.project_roles(project)
    if skeleton is None or "head" not in roles:
        raise RetargetError("a face alone needs a character with a head: import a clip of its body first")
    base = anatomy.get_base_pose(project)
    turned, at = skeleton.globals(base)
    axes = find_body_axes(skeleton, roles, at)
    frame = rotation.from_matrix(axes.T)  # from a character that looks along +Z to this one
    rotations = np.repeat(np.asarray(base.rotations, np.float64)[None], clip.frames, 0)
    morphs, weights = clip.morphs, clip.weights
    assert weights is not None
    for n, role in enumerate(("head", "left_eye", "right_eye")):
        joint = roles.get(role)
        own = np.asarray(clip.rotations[:, n], np.float64)
        if joint is None or (n and bool((np.abs(own[:, 3]) > 1 - 1e-9).all())):
            continue
        turn = rotation.multiply(rotation.multiply(frame, own), rotation.conjugate(frame))
        parent = int(skeleton.parents[joint])
        above = turned[parent] if parent >= 0 else rotation.IDENTITY
        local = rotation.multiply(rotation.multiply(rotation.conjugate(above), turn), above)
        rotations[:, joint] = rotation.multiply(local, rotations[:, joint])
        if n:
            side = "Left" if n == 1 else "Right"
            kept = [k for k, name in enumerate(morphs) if name not in {f"{w}{side}" for w in _LOOKS}]
            morphs, weights = tuple(morphs[k] for k in kept), weights[:, kept]
    moved = np.abs(np.asarray(base.translations) - skeleton.rest_translations).max(-1) > 1e-5
    places = tuple(sorted({0, *np.flatnonzero(moved).tolist()}))
    return replace(
        clip,
        skeleton=skeleton,
        rotations=rotation.make_continuous(rotation.normalize(rotations)),
        translations=np.repeat(np.asarray(base.translations)[None, list(places)], clip.frames, 0),
        translated=places,
        morphs=morphs,
        weights=weights,
        brought_from=FACE_TAKE,
    )


def find_face_joints(project: Project) -> tuple[str, ...]:
    """Return the names of the joints that a face's recording moves: the head, and all of the face."""
    if project.skeleton is None:
        return ()
    head = anatomy.project_roles(project).get("head")
    return tuple(
        name
        for j, (name, part) in enumerate(
            zip(project.skeleton.names, anatomy.project_parts(project), strict=True)
        )
        if part == "face" or j == head
    )
