"""Where a person's head is turned, as points for the character to look at."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.mimicry.keypoint_layouts import PLACE

Array = NDArray[Any]

STEP = np.radians(8.0)  # by how much the head turns before the gaze follows
EVERY = 0.3  # seconds between two looks, at least
FAR = 2.0  # metres to what is looked at
WIDE, LONG, LOW = (
    0.15,
    0.125,
    0.028,
)  # metres: ear to ear, ears to nose, nose below the ears; of a usual face looking ahead
MOST = np.radians(60.0)  # beyond which a head is not taken to be turned


class HeadFollower:
    """Follows one head. points `[17, 3]`: of the character, looking ahead."""

    def __init__(self, points: Array) -> None:
        self.eyes = (points[PLACE["left_eye"]] + points[PLACE["right_eye"]]) * 0.5
        self._last: tuple[float, float, float] | None = None  # seconds, turn, pitch

    def feed(
        self, seconds: float, points: Array, trust: Array, dims: int
    ) -> tuple[float, float, float] | None:
        """Return the point to look at from now on, metres; None while the head stays as it was, or is not
        seen.
        """
        found = measure_head_turn(points, trust, dims)
        if found is None:
            return None
        turn, pitch = found
        if self._last is not None:
            before, last_turn, last_pitch = self._last
            if seconds - before < EVERY or np.hypot(turn - last_turn, pitch - last_pitch) < STEP:
                return None
        self._last = (seconds, turn, pitch)
        away = np.array([np.sin(turn) * np.cos(pitch), np.sin(pitch), np.cos(turn) * np.cos(pitch)])
        x, y, z = (round(float(v), 3) for v in self.eyes + FAR * away)
        return x, y, z


def measure_head_turn(points: Array, trust: Array, dims: int) -> tuple[float, float] | None:
    """Return how far a head is turned to the picture's right and upwards, radians; None if ears or nose are
    not seen.
    """
    if min(trust[PLACE["nose"]], trust[PLACE["left_ear"]], trust[PLACE["right_ear"]]) <= 0:
        return None
    across = points[PLACE["left_ear"]] - points[PLACE["right_ear"]]
    ahead = points[PLACE["nose"]] - (points[PLACE["left_ear"]] + points[PLACE["right_ear"]]) * 0.5
    if dims == 3:
        turn, pitch = (
            np.arctan2(ahead[0], ahead[2]),
            np.arctan2(ahead[1], np.hypot(ahead[0], ahead[2])) + np.arctan2(LOW, LONG),
        )
    else:
        turn = np.arctan2(ahead[0] / LONG, max(across[0], 0.0) / WIDE)
        size = float(np.hypot(across[0] / WIDE, ahead[0] / LONG))
        if size <= 0:
            return None
        pitch = np.arcsin(np.clip((ahead[1] / size + LOW) / LONG, -1.0, 1.0))
    if not (np.isfinite(turn) and abs(turn) <= MOST and abs(pitch) <= MOST):
        return None
    return float(turn), float(pitch)
