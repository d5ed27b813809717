"""Place cameras in a conversation: over a shoulder, close, or all speakers from three quarters.

All cameras are on one side of the line between two speakers, so that the one who looks to the right does so
in every picture (the rule of 180 degrees). Sizes and angles are the usual ones of filmed conversations: over
the shoulder from the hips up, so that gestures are seen, close from the shoulders up, all from the waist up,
as shares of a figure's height. A face is large enough to read in each of them: of two speakers, no head is
lower than 0.22 of a picture of 16:9. The numbers are our own.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from preview.camera import Camera

Array = NDArray[Any]
Shot = Literal["over", "two", "close"]

# Metres behind and above the head over whose shoulder the camera looks, and from this head to the line of
# sight that passes it; for a figure of 1.75 m. From so far behind, the head in front is not twice as large.
BEHIND, BESIDE, ABOVE = 1.5, 0.38, 0.08
USUAL = 1.75  # metres; the height of the figure for which those hold
OVER_TALL, CLOSE_TALL = 0.58, 0.34
OVER_ROOM, OVER_UP = 0.07, 0.155
CLOSE_FOV, TWO_FOV = math.radians(22.0), math.radians(16.0)
# Of the height: from the head to the ends of the picture of all, below, above and on the sides.
TWO_BELOW, TWO_ABOVE, TWO_BESIDE = 0.33, 0.08, 0.11
WIDE = 1.6  # width divided by height of a picture above which heads must be large
NARROW_BESIDE = 0.17  # in others: whoever leans back stays in the picture
CLOSE_TURN = math.radians(24.0)  # between the line of sight and a close camera beside it
LOOKING = 0.03  # of the height; how much more room there is before a face than behind it
TWO_TURN = math.radians(16.0)  # between the middle and the camera that shows all


def place_camera(eye: ArrayLike, target: ArrayLike, fov: float) -> Camera:
    """Return a camera at `eye [3]` that looks at `target [3]`."""
    away = np.asarray(eye, float) - np.asarray(target, float)
    distance = max(0.05, float(np.linalg.norm(away)))
    x, y, z = np.asarray(target, float)
    return Camera(
        (float(x), float(y), float(z)),
        math.atan2(away[0], away[2]),
        math.asin(max(-1.0, min(1.0, away[1] / distance))),
        distance,
        fov,
    )


def find_camera_side(heads: Array) -> Array:
    """Return the direction `[3]` from the line between the speakers to the cameras: level, towards the
    viewer.
    """
    along = heads[-1] - heads[0]
    if len(heads) > 2:  # in a circle: the two farthest to the viewer's left and right
        along = heads[int(np.argmax(heads[:, 0]))] - heads[int(np.argmin(heads[:, 0]))]
    beside = np.array([-along[2], 0.0, along[0]])
    length = float(np.linalg.norm(beside))
    if length < 1e-6:
        return np.array([0.0, 0.0, 1.0])
    beside /= length
    return -beside if beside[2] < 0 or (beside[2] == 0 and beside[0] < 0) else beside


def choose_shown_partner(heads: Array, side: int) -> int:
    """Return over whose shoulder a speaker is seen: of several, the one farthest away on the ground."""
    others = [n for n in range(len(heads)) if n != side]
    return max(others, key=lambda n: float(np.linalg.norm((heads[n] - heads[side])[[0, 2]])), default=side)


def make_shot_camera(shot: Shot, side: int, heads: Array, heights: Sequence[float], aspect: float) -> Camera:
    """Return the camera of a shot.

    `side` is who is seen. `heads` are the middles of the heads `[N, 3]` in metres, `heights` the heights of
    the figures. `aspect` is width divided by height.
    """
    side = min(side, len(heads) - 1)
    if shot == "two" or len(heads) < 2:
        return _all(heads, heights, aspect)
    beside, other = find_camera_side(heads), choose_shown_partner(heads, side)
    sight = heads[other] - heads[side]
    sight[1] = 0.0
    sight /= max(1e-6, float(np.linalg.norm(sight)))
    across = np.array([-sight[2], 0.0, sight[0]])  # level, across the line of sight, on the cameras' side
    across = -across if float(across @ beside) < 0 else across
    if shot == "close":
        angle = CLOSE_TURN if float(np.cross(sight, beside)[1]) > 0 else -CLOSE_TURN
        turned = np.array(
            [
                sight[0] * math.cos(angle) + sight[2] * math.sin(angle),
                0.0,
                sight[2] * math.cos(angle) - sight[0] * math.sin(angle),
            ]
        )
        height = heights[side]
        target = heads[side] + height * (LOOKING * sight - np.array([0.0, 0.045, 0.0]))
        tall = CLOSE_TALL * height * max(1.0, 1.0 / aspect)
        return place_camera(
            target + turned * (tall / 2 / math.tan(CLOSE_FOV / 2)) + (0, 0.02 * height, 0), target, CLOSE_FOV
        )
    scale = heights[other] / USUAL
    apart = max(0.3, float(np.linalg.norm((heads[other] - heads[side])[[0, 2]])))
    aside = BESIDE * (apart + BEHIND * scale) / apart  # so that the line to the face passes the head
    eye = heads[other] + scale * (BEHIND * sight + aside * across + np.array([0.0, ABOVE, 0.0]))
    height = heights[side]
    target = heads[side] + height * (OVER_ROOM * across - np.array([0.0, OVER_UP, 0.0]))
    tall = OVER_TALL * height * max(1.0, 1.5 / aspect)
    return place_camera(eye, target, 2 * math.atan(tall / 2 / float(np.linalg.norm(eye - target))))


def is_lamp_on_right(camera: Camera, shot: Shot, side: int, heads: Array) -> bool:
    """Return whether the lamp of a shot stands on the camera's right, not on its left: it lights the side of
    a face that is turned from the camera, as the light of a filmed conversation does.
    """
    if shot == "two" or len(heads) < 2:
        return False
    side = min(side, len(heads) - 1)
    return bool(camera.axes[0] @ (heads[choose_shown_partner(heads, side)] - heads[side]) > 0)


def _all(heads: Array, heights: Sequence[float], aspect: float) -> Camera:
    """Return the camera that shows all speakers from the waist up, from three quarters."""
    beside, height = find_camera_side(heads), float(max(heights))
    camera = Camera(fov=TWO_FOV).facing(math.atan2(beside[0], beside[2]) - TWO_TURN, math.radians(4.0))
    low, high = heads.min(axis=0), heads.max(axis=0)
    room = height * (TWO_BESIDE if aspect > WIDE else NARROW_BESIDE)
    return camera.frame(
        (low - (room, height * TWO_BELOW, room), high + (room, height * TWO_ABOVE, room)), aspect, 1.0
    )
