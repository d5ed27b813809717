"""What a clip reports how its skeleton stands: its ground, its soles and its shoulders."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from metagraph.formats.clips import read_clips
from metagraph.motion import rotation
from metagraph.motion.fitting.footing import find_footing
from tests.label_zoo.rigs import Figure, on
from tests.preview.conftest import chain

CLIP = Path(__file__).parents[3] / "sample_clips" / "clips" / "body_weight_both__stance.glb"


def idle(**changes):
    return on(read_clips(CLIP)[0], Figure(**changes))


def foot_of(clip):
    return clip.skeleton.index("LeftFoot")


def test_ankles_are_as_high_as_they_are_while_the_character_stands():
    clip = idle()
    _, at = clip.skeleton.globals(clip.poses())
    assert find_footing(clip).ankle == pytest.approx(float(at[:, foot_of(clip), 1].min()), abs=0.005)


def test_a_step_and_a_hop_do_not_lift_the_ground():
    clip = idle()
    up = clip.translations.copy()
    up[len(up) // 2 :, 0, 1] += 0.3
    hop = replace(clip, translations=up)
    assert find_footing(hop).ankle == pytest.approx(find_footing(clip).ankle, abs=0.005)


@pytest.mark.parametrize("away", [-0.8, 0.4])
def test_a_clip_that_is_not_on_the_ground_tells_no_height(away):
    clip = idle()
    moved = clip.translations.copy()
    moved[:, 0, 1] += away
    footing = find_footing(replace(clip, translations=moved))
    assert footing.ankle is None and footing.ups == (None, None)


@pytest.mark.parametrize("axes", ["world", "random", "none"])
def test_what_points_up_in_a_planted_foot_points_up(axes):
    clip = idle(axes=axes, seed=4)
    turned, _ = clip.skeleton.globals(clip.poses())
    up = find_footing(clip).ups[0]
    assert up is not None
    assert rotation.rotate_vectors(turned[:, foot_of(clip)], up)[:, 1].min() > 0.99


def test_shoulders_are_as_they_are_carried_and_not_as_the_t_pose_raises_them():
    clip = idle(rest="T")
    shoulder = clip.skeleton.index("LeftShoulder")
    lowered = clip.rotations.copy()
    turn = rotation.from_axis_angle(np.array([0.0, 0, 1]), -0.3).astype(np.float32)
    lowered[:, shoulder] = rotation.multiply(turn, lowered[:, shoulder])
    carried = find_footing(replace(clip, rotations=lowered)).pose.rotations[shoulder]
    assert rotation.measure_angle_between(carried, lowered[0, shoulder]) < 0.05
    assert np.allclose(find_footing(clip).pose.translations, clip.skeleton.rest_translations)


def test_one_frame_and_no_person_are_answered():
    clip = idle()
    one = replace(clip, rotations=clip.rotations[:1], translations=clip.translations[:1], weights=None)
    assert find_footing(one).ankle == pytest.approx(find_footing(clip).ankle, abs=0.01)
    skeleton = chain("a", "b", "c")
    nobody = replace(
        clip,
        skeleton=skeleton,
        rotations=np.tile(np.float32([0, 0, 0, 1]), (3, 3, 1)),
        translations=np.zeros((3, 1, 3)),
        morphs=(),
        weights=None,
    )
    assert find_footing(nobody).ankle is None
