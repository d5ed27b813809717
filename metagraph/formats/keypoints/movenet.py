"""MoveNet's raw output: COCO's 17 points as y, x and score, in shares of the picture."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from metagraph.formats.keypoints.frames import KeypointFrame, is_json_number
from metagraph.mimicry.keypoint_layouts import POINTS

_NUMBERS = 56  # of a person of MultiPose: y, x and score of 17 points, then a box and its score
_SHARES = (-0.5, 1.5)  # coordinates that are shares of a picture lie here, even of points beside it
_LYING = 1.5  # how many times as far across as down a trunk is that lies
_MOST = 0.8  # of the people who lie, in a file whose points have y first
NOTE = "its points were read as y, x and score, as MoveNet writes them; as x and y everybody would lie"


def unpack_people(item: Any) -> Any:
    """Return a frame of MoveNet's, `[1, 1, 17, 3]` or `[1, N, 56]`, as the rows of one person or a list of
    several people's rows; anything else as it is.
    """
    while isinstance(item, list) and len(item) == 1 and isinstance(item[0], list) and _depth(item) > 2:
        item = item[0]
    if isinstance(item, list) and item and all(_is_multi_pose(one) for one in item):
        return [[one[n : n + 3] for n in range(0, 51, 3)] for one in item]
    return item


def _depth(item: Any) -> int:
    """Return how many lists of one entry or more stand in each other, first entries only."""
    depth = 0
    while isinstance(item, list) and item and depth < 8:
        item, depth = item[0], depth + 1
    return depth


def _is_multi_pose(one: Any) -> bool:
    return isinstance(one, list) and len(one) == _NUMBERS and all(map(is_json_number, one))


def put_x_first(frames: Sequence[KeypointFrame]) -> bool:
    """Exchange x and y of flat points where nearly everybody would lie otherwise, take the third number for
    the confidence where there is one, and return whether that was done. Only shares of a picture with 17
    points are looked at: MoveNet gives no other sign.
    """
    people = [p for frame in frames for p in frame.flat]
    if (
        not people
        or any(frame.space for frame in frames)
        or any(len(p.points) != len(POINTS) for p in people)
    ):
        return False
    seen = [p.points[p.confidence > 0, :2] for p in people]
    if not any(map(len, seen)):
        return False
    every = np.concatenate(seen)
    if every.min() < _SHARES[0] or every.max() > _SHARES[1]:
        return False
    shoulders, hips = (
        [POINTS.index(f"{side}_{name}") for side in ("left", "right")] for name in ("shoulder", "hip")
    )
    trunks = [
        np.abs(p.points[shoulders, :2].mean(0) - p.points[hips, :2].mean(0))
        for p in people
        if (p.confidence[shoulders + hips] > 0).all()
    ]
    lying = [across > _LYING * down for across, down in trunks]
    if not lying or np.mean(lying) < _MOST:
        return False
    scored = any(person.points[:, 2].any() for person in people)
    for person in people:
        person.points[:, :2] = person.points[:, 1::-1]
        if scored:
            person.confidence[:] = np.clip(person.points[:, 2], 0.0, 1.0)
            person.points[:, 2] = 0.0
    return True
