"""Clips: what makes one, and sampling between and beyond its frames."""

from __future__ import annotations

import pickle
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from metagraph.motion import rotation
from metagraph.motion.clip import MEASURES, Clip, ClipError
from metagraph.motion.skeleton import Skeleton

TWO = Skeleton(
    ("a", "b"), np.array([-1, 0]), np.tile([0.0, 0, 0, 1], (2, 1)), np.array([[0, 1.0, 0], [0, 0.5, 0]])
)


def clip(frames: int = 3, **changes: Any) -> Clip:
    angles = np.linspace(0, 1, frames) if frames > 1 else np.zeros(frames)
    rotations = (
        np.tile(rotation.from_axis_angle([0.0, 0, 1], angles[:, None])[:, :1], (1, 2, 1)).reshape(
            frames, 2, 4
        )
        if frames
        else np.zeros((0, 2, 4))
    )
    fields: dict[str, Any] = {
        "name": "wave", "skeleton": TWO, "fps": 10.0, "rotations": rotations,
        "translations": np.stack([angles, 0 * angles, 0 * angles], -1)[:, None],
    }  # fmt: skip
    return Clip(**{**fields, **changes})


def test_no_frames_are_refused() -> None:
    with pytest.raises(ClipError, match="'wave' has no frames"):
        clip(0)


def test_one_frame_is_a_clip_of_no_duration() -> None:
    one = clip(1)
    assert one.frames == 1 and one.duration == 0
    for at in (-1.0, 0.0, 5.0):
        assert np.array_equal(one.pose_at(at).rotations, one.rotations[0])
    assert one.pose_at(np.zeros((2, 3))).rotations.shape == (2, 3, 2, 4)


@pytest.mark.parametrize("bad", [np.nan, np.inf])
@pytest.mark.parametrize("field", ["rotations", "translations"])
def test_a_value_that_is_not_a_number_is_refused(field: str, bad: float) -> None:
    array = np.array(getattr(clip(), field))
    array[1, 0, 0] = bad
    with pytest.raises(ClipError, match="not a number"):
        clip(**{field: array})


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"rotations": np.zeros((3, 1, 4))}, "rotations are"),
        ({"translations": np.zeros((2, 1, 3))}, "translations are"),
        ({"translated": ()}, "begin with joint 0"),
        ({"translated": (1,)}, "begin with joint 0"),
        ({"translated": (0, 1, 1), "translations": np.zeros((3, 3, 3))}, "ascend"),
        ({"translated": (0, 2), "translations": np.zeros((3, 2, 3))}, "translations are"),
        ({"fps": 0.0}, "frames per second"),
        ({"fps": -30.0}, "frames per second"),
        ({"fps": np.inf}, "frames per second"),
        ({"fps": np.nan}, "frames per second"),
        ({"morphs": ("smile",), "weights": np.zeros((2, 1))}, "morph weights"),
        ({"morphs": ("smile",), "weights": np.full((3, 1), np.nan)}, "finite"),
    ],
)
def test_numbers_that_do_not_fit_together_are_refused(changes: dict[str, Any], words: str) -> None:
    with pytest.raises(ClipError, match=words):
        clip(**changes)


def test_its_arrays_are_single_precision_and_cannot_be_changed() -> None:
    assert clip().rotations.dtype == np.float32
    with pytest.raises(ValueError, match="read-only"):
        clip().rotations[0] = 0


def test_sampling_is_clamped_to_the_clip() -> None:
    c = clip(3)
    assert np.array_equal(c.pose_at(-5).root, c.root[0])
    assert np.array_equal(c.pose_at(99).root, c.root[-1])
    assert np.allclose(c.pose_at(c.duration).rotations, c.rotations[-1])


@given(st.floats(0, 0.2))
def test_between_frames_translations_go_straight_and_rotations_stay_unit(seconds: float) -> None:
    pose = clip(3).pose_at(seconds)
    assert pose.root[0] == pytest.approx(seconds / 0.2, abs=1e-6)
    assert np.allclose(np.linalg.norm(pose.rotations, axis=-1), 1, atol=1e-6)


def test_one_time_and_many_give_the_same() -> None:
    c = clip(4)
    times = np.array([[0.0, 0.01, 0.13], [0.299, 0.3, 1]])
    many = c.pose_at(times)
    for place, at in np.ndenumerate(times):
        assert np.array_equal(many.rotations[place], c.pose_at(at).rotations)
        assert np.array_equal(many.translations[place], c.pose_at(at).translations)


def test_joints_that_do_not_move_keep_their_rest_translation() -> None:
    assert np.allclose(clip().poses().translations[:, 1], [0, 0.5, 0])
    assert np.allclose(clip().pose_at(0.1).translations[1], [0, 0.5, 0])


def test_trimming_keeps_fields_and_refuses_to_leave_nothing() -> None:
    c = clip(5, morphs=("smile",), weights=np.arange(5.0)[:, None])
    part = c.trimmed(1, 4)
    assert part.frames == 3 and part.weights is not None and part.weights[:, 0].tolist() == [1, 2, 3]
    assert part.renamed("b").name == "b"
    with pytest.raises(ClipError, match="no frames"):
        c.trimmed(4, 4)


def test_a_clip_remembers_what_was_measured_of_it_and_of_no_other() -> None:
    one = clip()
    for n in range(MEASURES + 1):
        assert one.measured(("n", n), partial(float, n)) == n
    assert one.measured(("n", MEASURES), lambda: -1.0) == MEASURES
    assert replace(one).measured(("n", MEASURES), lambda: -1.0) == -1.0


def test_a_clip_is_sent_to_another_process_without_what_is_remembered_of_it(toy):
    """Another thread may be measuring it at that moment."""
    clip = toy.clip("wave", 1.0)
    plain = len(pickle.dumps(clip))
    assert clip.dense.frames > clip.frames
    assert len(pickle.dumps(clip)) == plain
    again = pickle.loads(pickle.dumps(clip))
    assert (again.rotations == clip.rotations).all() and again.dense.frames == clip.dense.frames
