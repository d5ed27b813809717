"""Hand shapes: how far each finger curls, as degrees an animator would type.

A finger is (knuckle, middle, tip, spread): the first three curl into the palm, spread goes towards the
thumb's side. The thumb is (oppose, abduct, middle, tip): oppose swings it in front of the palm, abduct takes
it away from the index.
"""

from __future__ import annotations

import numpy as np

from metagraph.motion import rotation
from sample_clips.make.mannequin_rig import ARM_AXIS, PALM, THUMB_SIDE, Array, about
from sample_clips.make.mannequin_skeleton import FINGERS

Finger = tuple[float, float, float, float]

_CURL_AXIS = np.cross(ARM_AXIS, PALM)  # turning about it curls a left finger into the palm
_THUMB = ARM_AXIS * 0.72 + THUMB_SIDE * 0.69
_THUMB_CURL = np.cross(_THUMB, 0.6 * PALM + 0.8 * (0.69 * ARM_AXIS - 0.72 * THUMB_SIDE))

#          thumb              index              middle             ring               little
SHAPES: dict[str, tuple[Finger, Finger, Finger, Finger, Finger]] = {
    "relaxed": ((24, -8, 14, 18), (14, 22, 12, 1), (20, 27, 15, 0), (25, 31, 17, -1), (28, 33, 18, -3)),
    "hanging": ((28, -12, 16, 20), (20, 26, 14, 1), (27, 31, 17, 0), (32, 34, 19, -1), (35, 36, 20, -2)),
    "open": ((16, -10, 6, 10), (4, 9, 5, 5), (7, 11, 6, 1), (9, 14, 8, -3), (8, 16, 9, -9)),
    "flat": ((14, -24, 8, 8), (1, 4, 2, 1), (2, 4, 2, 0), (3, 5, 3, 0), (3, 6, 4, -1)),
    "spread": ((6, 6, 0, 2), (-6, 6, 4, 11), (-4, 7, 5, 2), (-3, 9, 6, -8), (-6, 10, 7, -19)),
    "cupped": ((34, 6, 12, 16), (26, 24, 13, 3), (29, 26, 14, 1), (32, 28, 15, -2), (34, 29, 16, -5)),
    "fist": ((46, -10, 38, 40), (74, 92, 52, 0), (78, 96, 54, 0), (80, 97, 54, 0), (80, 94, 52, 0)),
    "soft_fist": ((40, -6, 26, 28), (46, 62, 34, 1), (54, 68, 37, 0), (58, 72, 39, -1), (60, 72, 39, -2)),
    "point": ((46, -8, 38, 34), (2, 7, 4, 0), (66, 84, 46, 0), (74, 90, 50, 0), (74, 88, 48, 0)),
    "loose_point": ((34, -4, 20, 20), (6, 14, 8, 1), (40, 54, 30, 0), (50, 62, 34, -1), (54, 62, 34, -2)),
    "pinch": ((69, 11, 24, 28), (52, 60, 30, 0), (30, 36, 20, 1), (22, 28, 16, -2), (16, 24, 14, -8)),
    "ring": ((72, 13, 26, 28), (56, 63, 28, 3), (14, 22, 12, 2), (8, 16, 10, -2), (4, 14, 10, -9)),
    "pluck": ((50, 25, 7, 18), (38, 42, 20, 2), (50, 50, 26, 0), (46, 46, 25, -1), (54, 52, 28, -2)),
    "firm_fist": ((42, -6, 30, 32), (60, 74, 42, 1), (66, 80, 44, 0), (68, 82, 45, -1), (68, 82, 45, -2)),
    "on_neck": ((14, -25, 8, 10), (13, 19, 10, 1), (14, 20, 10, 0), (10, 16, 8, 0), (18, 24, 12, -1)),
    "thumbs_up": ((-18, 32, -8, -16), (70, 92, 50, 0), (76, 95, 52, 0), (78, 96, 52, 0), (78, 93, 50, 0)),
    "count_one": ((48, -8, 40, 36), (0, 4, 3, 1), (72, 92, 50, 0), (76, 94, 51, 0), (76, 92, 50, 0)),
    "count_two": ((52, -10, 42, 40), (-2, 4, 3, 8), (0, 5, 3, -5), (72, 92, 50, 0), (74, 90, 50, -2)),
    "count_three": ((54, -10, 44, 42), (-3, 4, 3, 9), (-2, 5, 3, 0), (2, 7, 4, -10), (64, 84, 46, -4)),
    "quotes": ((46, -6, 36, 32), (8, 26, 16, 7), (10, 28, 17, -4), (66, 86, 48, 0), (68, 86, 48, 0)),
    "quotes_curled": ((46, -6, 36, 32), (34, 62, 36, 5), (36, 64, 37, -3), (68, 88, 49, 0), (70, 88, 49, 0)),
    "hold_arm": ((30, -20, 14, 20), (26, 40, 24, 1), (32, 44, 25, 0), (38, 46, 26, 0), (43, 48, 27, 0)),
    "on_hip": ((-14, 18, 10, 12), (14, 22, 14, 1), (17, 25, 15, 0), (21, 28, 16, -1), (26, 31, 17, -2)),
    "on_lap": ((16, -6, 8, 10), (18, 18, 9, 2), (18, 17, 9, 0), (14, 12, 6, -2), (22, 19, 10, -4)),
    "chin": ((34, 4, 14, 20), (40, 60, 34, 2), (62, 80, 44, 0), (66, 86, 46, -1), (68, 86, 46, -2)),
    "tucked": ((8, -24, 6, 6), (5, 13, 7, 3), (8, 15, 8, 1), (11, 17, 9, -2), (13, 18, 10, -5)),
    "cradle": ((10, 4, 10, 14), (40, 44, 26, 0), (44, 48, 26, 0), (46, 46, 25, 0), (48, 46, 26, -1)),
    "clasp_over": ((44, 2, 24, 28), (40, 46, 26, 0), (42, 48, 26, 0), (44, 48, 26, 0), (46, 48, 26, 0)),
    "clasp_under": ((34, -7, 20, 22), (48, 46, 26, 0), (52, 50, 28, 0), (56, 52, 28, 0), (58, 52, 28, -1)),
}


def mixed(first: str, second: str, part: float) -> tuple[Finger, ...]:
    """Return the shape `part` of the way from one named shape to another."""
    a, b = np.array(SHAPES[first]), np.array(SHAPES[second])
    return tuple(tuple(row) for row in (a + (b - a) * part).tolist())


def finger_rotations(shape: str | tuple[Finger, ...]) -> dict[str, Array]:
    """Return the left hand's local rotations by joint name without its side ("Index1")."""
    rows = SHAPES[shape] if isinstance(shape, str) else shape
    out: dict[str, Array] = {}
    for finger, (a, b, c, d) in zip(FINGERS, rows, strict=True):
        if finger == "Thumb":
            out["Thumb1"] = rotation.multiply(about(ARM_AXIS, a), about(PALM, b))
            out["Thumb2"], out["Thumb3"] = about(_THUMB_CURL, c), about(_THUMB_CURL, d)
        else:
            out[finger + "1"] = rotation.multiply(about(PALM, d), about(_CURL_AXIS, a))
            out[finger + "2"], out[finger + "3"] = about(_CURL_AXIS, b), about(_CURL_AXIS, c)
    return out
