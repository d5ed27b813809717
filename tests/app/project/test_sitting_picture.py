"""The picture of a sitting that is offered after a crash."""

from __future__ import annotations

import numpy as np

from app.project.recovering import SittingPicture
from metagraph.graph.model import Project
from metagraph.motion.clip import Clip
from metagraph.motion.skeleton import Skeleton
from preview import joints
from sample_clips.make.mannequin_skeleton import mannequin_skeleton


def standing(skeleton: Skeleton) -> Clip:
    return Clip("stand", skeleton, 30.0, skeleton.rest_rotations[None], skeleton.rest_translations[None, :1])


def test_the_picture_has_the_bones_of_the_preview_and_none_of_the_face(drive):
    skeleton = mannequin_skeleton()
    bones = SittingPicture(Project(), standing(skeleton))._figure
    shown = joints.find_drawn_joints(skeleton)
    assert bones is not None and bones.shape[1:] == (2, 2)
    assert (
        len(bones)
        == int((shown & (joints.find_nearest_above(skeleton, shown) >= 0)).sum())
        < int(shown.sum())
    )
    assert 1.0 < np.ptp(bones[..., 1]) < 2.2  # from the feet to the head, and nothing far away


def test_a_clip_with_nothing_to_draw_leaves_the_picture_to_its_layers(drive):
    one = Skeleton(("Hips",), np.array([-1]), np.array([[0.0, 0, 0, 1]]), np.zeros((1, 3)))
    picture = SittingPicture(Project(), standing(one))
    assert picture._figure is None
    assert not picture.grab().isNull()
