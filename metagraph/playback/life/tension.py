"""What of a body tightens: collar bones rise, elbows bend and leave the sides, hands close.

Degrees at a tension of 1 (`mood.Bearing.tension`); ours. Hot anger brings fists, raised shoulders and arms
held ready (Wallbott 1998; Dael et al. 2012).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.graph.face.rig import SIDES
from metagraph.motion.joint_map import FINGERS

Array = NDArray[Any]

COLLAR = 4.0
ASIDE = 1.5  # upper arms
AHEAD = 9.0
ELBOW = 18.0
CURLS = (34.0, 42.0)  # the first and second joints of fingers but the thumb


def find_tension(
    roles: Mapping[str, int],
    at: Array,
    axes: Array,
    local: Callable[[int, Array], Array],
) -> dict[int, Array]:
    """Return for each joint that tightens its rotation vector at 1, in its own space. at: where joints are in
    the base pose; axes `[3, 3]`: the character's left, up and
    ahead.
    """
    left, _, ahead = axes
    out: dict[int, Array] = {}
    for side, sign in zip(SIDES, (1.0, -1.0), strict=True):
        arm = [roles.get(f"{side}_{part}") for part in ("upper_arm", "lower_arm", "hand")]
        if roles.get(f"{side}_shoulder") is not None:
            collar = roles[f"{side}_shoulder"]
            out[collar] = np.radians(COLLAR) * sign * local(collar, ahead)
        upper, lower, hand = arm
        if upper is None or lower is None or hand is None:
            continue
        bone, fore = _way(at, upper, lower), _way(at, lower, hand)
        lifted = np.radians(ASIDE) * np.cross(bone, sign * left) + np.radians(AHEAD) * np.cross(bone, ahead)
        out[upper] = local(upper, lifted)
        hinge = np.cross(fore, ahead)
        out[lower] = np.radians(ELBOW) * local(lower, hinge)
        first = [roles.get(f"{side}_{finger}_1") for finger in FINGERS[1:]]
        if first[0] is None or first[-1] is None:
            continue
        across = at[first[0]] - at[first[-1]]
        for finger in FINGERS[1:]:
            line = [roles.get(f"{side}_{finger}_{n}") for n in (1, 2, 3)]
            for (joint, beyond), degrees in zip(pairwise(line), CURLS, strict=True):
                if joint is None or beyond is None:
                    continue
                along = _way(at, joint, beyond)
                palm = sign * np.cross(along, across)
                axis = np.cross(along, palm)
                size = float(np.linalg.norm(axis))
                if size > 1e-9:
                    out[joint] = np.radians(degrees) * local(joint, axis / size)
    return out


def _way(at: Array, a: int, b: int) -> Array:
    way = at[b] - at[a]
    return np.asarray(way / max(1e-9, float(np.linalg.norm(way))))
