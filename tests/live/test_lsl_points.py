"""Channels of LSL streams as keypoints: by their names, or by how many there are."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from metagraph.common.lab_streaming import StreamChannel
from metagraph.graph.model import Project
from metagraph.live.lsl_out import plan_outlets
from metagraph.live.lsl_points import Upright, find_point_channels, name_point
from metagraph.mimicry.keypoint_layouts import LAYOUTS, PLACE, POINTS


@pytest.mark.parametrize("points", [17, 18, 25, 33])
@pytest.mark.parametrize("dims", [2, 3, 4])
def test_a_stream_without_names_is_told_by_its_number_of_channels(points: int, dims: int) -> None:
    found = find_point_channels((), points * dims)
    names = next(names for names in LAYOUTS.values() if len(names) == points)
    sample = [float(10 * n + axis) if axis < 3 else 0.5 for n in range(points) for axis in range(dims)]
    read, sure = found.read(sample)
    assert read.shape == (17, min(dims, 3))
    for name in ("left_wrist", "right_hip"):
        assert read[PLACE[name], 1] == 10 * names.index(name) + 1
        assert sure[PLACE[name]] == (0.5 if dims == 4 else 1.0)


def test_no_two_layouts_have_the_same_number_of_channels() -> None:
    counts = sorted(points * dims for points in (17, 18, 25, 26, 33) for dims in (2, 3, 4))
    assert all(a < b for a, b in pairwise(counts))


def test_a_number_that_is_none_makes_a_point_that_is_not_seen() -> None:
    sample = np.ones(51)
    sample[3 * PLACE["left_wrist"]] = np.nan
    points, sure = find_point_channels((), 51).read(sample)
    assert sure[PLACE["left_wrist"]] == 0 and sure.sum() == 16 and np.isfinite(points).all()


def test_channels_that_are_no_body_are_refused_with_what_would_be_right() -> None:
    with pytest.raises(
        ValueError, match=r"its 32 channels are no keypoints: name them after joints, or send 17"
    ):
        find_point_channels(tuple(StreamChannel(f"EEG {n}", "EEG", "microvolts") for n in range(32)), 32)


def test_named_channels_are_found_in_any_order() -> None:
    labels = [f"{name}_{axis}" for axis in "xy" for name in reversed(POINTS)]
    found = find_point_channels([StreamChannel(label) for label in labels], len(labels))
    points, sure = found.read([float(n) for n in range(len(labels))])
    assert found.dims == 2 and sure.all()
    assert points[PLACE["nose"]].tolist() == [16.0, 33.0]


def test_markers_with_confidence_are_read() -> None:
    channels = [
        StreamChannel(f"{name} {axis}", kind, object=name)
        for name in POINTS
        for axis, kind in (("a", "PositionX"), ("b", "PositionY"), ("c", "PositionZ"), ("d", "Confidence"))
    ]
    points, sure = find_point_channels(channels, len(channels)).read([0.25] * len(channels))
    assert points.shape == (17, 3) and set(sure) == {0.25}


def test_the_pose_of_another_character_has_points(sample: Project) -> None:
    channels = plan_outlets(sample)["pose"].channels
    found = find_point_channels(channels, len(channels))
    names = {
        PLACE[x]
        for x in POINTS
        if x.partition("_")[2] in ("shoulder", "elbow", "wrist", "hip", "knee", "ankle")
    }
    assert {n for n in range(17) if found.places[n, 0] >= 0} >= names
    skeleton = sample.skeleton
    _, places = skeleton.globals(skeleton.rest)
    sample_of = np.concatenate([places, np.zeros((len(places), 4))], axis=1).reshape(-1)
    points, _ = found.read(sample_of)
    at = dict(zip(skeleton.names, places, strict=True))
    np.testing.assert_allclose(points[PLACE["left_wrist"]], at["LeftHand"], atol=1e-6)
    np.testing.assert_allclose(points[PLACE["left_shoulder"]], at["LeftUpperArm"], atol=1e-6)


@pytest.mark.parametrize(
    ("joint", "point"),
    [
        ("mixamorig:LeftForeArm", "left_elbow"),
        ("RightUpLeg", "right_hip"),
        ("l_ankle", "left_ankle"),
        ("nose", "nose"),
        ("LeftHandThumb1", ""),
        ("left_foot_index", ""),
        ("Spine", ""),
    ],
)
def test_joints_have_the_names_of_points(joint: str, point: str) -> None:
    assert name_point(joint)[0] == point


BODY = np.zeros((17, 3))
for _name, _at in {
    "left_shoulder": (0.2, 1.4, 0.0), "right_shoulder": (-0.2, 1.4, 0.0), "left_hip": (0.1, 0.9, 0.0),
    "right_hip": (-0.1, 0.9, 0.0), "left_wrist": (0.3, 1.2, 0.4),
}.items():  # fmt: skip
    BODY[PLACE[_name]] = _at
CAMERA = BODY * [1, -1, -1]


@pytest.mark.parametrize(
    "points",
    [BODY, CAMERA, BODY[:, [0, 2, 1]] * [1, -1, 1], BODY[:, [0, 2, 1]] * [1, 1, -1]],
    ids=["y up", "y down", "z up", "z down"],
)
def test_whichever_axis_is_up_the_body_stands_upright_and_its_hands_are_what_they_are(
    points: np.ndarray,
) -> None:
    np.testing.assert_allclose(Upright().turn(points, np.ones(17)), CAMERA, atol=1e-9)


def test_a_picture_whose_y_goes_up_is_turned_over() -> None:
    np.testing.assert_allclose(Upright().turn(BODY[:, :2], np.ones(17)), CAMERA[:, :2])
    np.testing.assert_allclose(Upright().turn(CAMERA[:, :2], np.ones(17)), CAMERA[:, :2])


def test_who_bows_is_not_turned_over() -> None:
    upright = Upright()
    upright.turn(BODY, np.ones(17))
    np.testing.assert_allclose(upright.turn(CAMERA, np.ones(17)), CAMERA * [1, -1, -1])
