"""Layouts of keypoints: the same person, whatever counts the points."""

from __future__ import annotations

import numpy as np
import pytest

from metagraph.mimicry.keypoint_layouts import BY_COUNT, LAYOUTS, POINTS, KeypointTrack, choose_points, swap


@pytest.mark.parametrize("layout", LAYOUTS)
def test_every_layout_has_all_points_once_and_a_number_of_its_own(layout: str) -> None:
    names = LAYOUTS[layout]
    assert len(set(names)) == len(names)
    missing = {"nose", *(f"{s}_{p}" for s in ("left", "right") for p in ("eye", "ear"))}
    assert set(POINTS) - (missing if layout == "openpose mpi" else set()) <= set(names)
    assert BY_COUNT[len(names)] == layout


def test_openpose_and_mediapipe_count_as_they_say() -> None:
    assert (len(LAYOUTS["openpose body_25"]), len(LAYOUTS["openpose coco"]), len(LAYOUTS["mediapipe"])) == (
        25,
        18,
        33,
    )
    assert LAYOUTS["openpose body_25"][8] == "hips" and LAYOUTS["openpose body_25"][4] == "right_wrist"
    assert LAYOUTS["openpose coco"][7] == "left_wrist" and LAYOUTS["openpose coco"][16] == "right_ear"
    assert LAYOUTS["mediapipe"][15] == "left_wrist" and LAYOUTS["mediapipe"][24] == "right_hip"


@pytest.mark.parametrize("layout", LAYOUTS)
def test_choosing_keeps_each_point_its_place(layout: str) -> None:
    names = LAYOUTS[layout]
    points = np.array([[hash(name) % 97, n] for n, name in enumerate(names)], float)
    chosen, sure = choose_points(points, np.arange(len(names)) / 50)
    for n, name in enumerate(POINTS):
        if name not in names:
            assert sure[n] == 0
            continue
        assert chosen[n, 0] == hash(name) % 97
        assert sure[n] == names.index(name) / 50


def test_a_number_of_points_that_no_layout_has_is_refused_with_those_known() -> None:
    with pytest.raises(
        ValueError,
        match=r"21 points .* 17 \(coco\), 18 \(openpose coco\), 25 \(.*, 33 \(mediapipe\)",
    ):
        choose_points(np.zeros((21, 2)), np.zeros(21))


def test_a_mirror_changes_left_and_right_over_and_back() -> None:
    points, sure = np.random.default_rng(1).normal(size=(17, 3)), np.linspace(0, 1, 17)
    once, sure_once = swap(points, sure)
    left, right = POINTS.index("left_wrist"), POINTS.index("right_wrist")
    assert (once[left] == points[right] * [-1, 1, 1]).all() and sure_once[left] == sure[right]
    assert (once[0] == points[0] * [-1, 1, 1]).all()
    twice, sure_twice = swap(once, sure_once)
    assert (twice == points).all() and (sure_twice == sure).all()


def test_recordings_mirror_as_their_points_do() -> None:
    points, sure = (
        np.random.default_rng(2).normal(size=(4, 33, 3)),
        np.random.default_rng(3).uniform(size=(4, 33)),
    )
    seen = KeypointTrack(np.arange(4.0), points, sure, LAYOUTS["mediapipe"], 3)
    a, b = seen.mirrored().canonical, swap(*seen.canonical)
    assert (a[0] == b[0]).all() and (a[1] == b[1]).all()
    assert len(seen) == 4 and seen.seconds == 3.0


def test_points_a_recording_does_not_have_are_not_found() -> None:
    seen = KeypointTrack(np.zeros(1), np.ones((1, 2, 3)), np.ones((1, 2)), ("nose", "left_wrist"), 2)
    points, sure = seen.canonical
    assert (
        sure.sum() == 2
        and points[0, POINTS.index("left_wrist"), 0] == 1
        and points[0, POINTS.index("left_hip"), 0] == 0
    )
