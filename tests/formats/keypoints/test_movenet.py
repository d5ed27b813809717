"""MoveNet's raw output has y first; whoever stands in it stands."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from metagraph.formats.keypoints.movenet import NOTE
from metagraph.formats.keypoints.reader import read_keypoints
from metagraph.mimicry.keypoint_layouts import PLACE, KeypointTrack
from tests.formats.keypoints.test_reader import picture


def shares() -> list[list[float]]:
    """Somebody who stands, as x, y and confidence in shares of a picture of 800 by 600."""
    return [[x / 800, y / 600, sure] for x, y, sure in picture("coco")]


def y_first() -> list[list[float]]:
    return [[y, x, sure] for x, y, sure in shares()]


def read(tmp_path: Path, data: Any) -> KeypointTrack:
    path = tmp_path / "talk.json"
    path.write_text(json.dumps(data), "utf-8")
    return read_keypoints(path, 30.0, (800.0, 600.0))


@pytest.mark.parametrize(
    "frame",
    [
        y_first(),
        [y_first()],
        [[y_first()]],
        [[[n for p in y_first() for n in p] + [0.0, 0.2, 0.9, 0.6, 0.8]]],
    ],
    ids=["rows", "one person", "1 x 1 x 17 x 3", "MultiPose"],
)
def test_raw_points_with_y_first_are_those_with_x_first(tmp_path: Path, frame: Any) -> None:
    track = read(tmp_path, [frame, frame])
    usual = read(tmp_path, [shares(), shares()])
    np.testing.assert_allclose(track.points, usual.points, atol=1e-9)
    np.testing.assert_allclose(track.confidence, 0.9)
    assert NOTE in track.notes and NOTE not in usual.notes


def test_a_person_who_lies_in_pixels_is_left_lying(tmp_path: Path) -> None:
    """Pixels are not MoveNet's."""
    lying = [[y, x, sure] for x, y, sure in picture("coco")]
    track = read(tmp_path, [lying, lying])
    nose, hip = track.points[0, PLACE["nose"]], track.points[0, PLACE["left_hip"]]
    assert abs(nose[0] - hip[0]) > abs(nose[1] - hip[1])
    assert NOTE not in track.notes


def test_a_person_who_stands_most_of_the_time_and_lies_once_keeps_x_first(tmp_path: Path) -> None:
    track = read(tmp_path, [shares(), shares(), shares(), y_first()])
    assert NOTE not in track.notes


def test_points_that_were_not_found_do_not_decide(tmp_path: Path) -> None:
    unseen = [[y, x, 0.0] for y, x, _ in y_first()]
    track = read(tmp_path, [unseen, y_first(), y_first()])
    assert NOTE in track.notes
    assert not track.confidence[0].any()
