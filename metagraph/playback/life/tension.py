"""What of a body tightens, and what is kept close: collar bones rise or come forward, arms leave the sides or
stay at them, elbows bend, hands close.

Degrees at a tension, or a closeness, of 1 (`mood.Bearing`); ours. Hot anger brings fists, raised shoulders
and arms held ready (Wallbott 1998; Dael et al. 2012). Who keeps close has round shoulders, and arms at the
body. Elbows bend no farther for that: hands that are on their way round each other would be thrown.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.graph.face.rig import SIDES
from metagraph.motion.joint_map import FINGERS

Array = NDArray[Any]


@dataclass(frozen=True)
class ArmDegrees:
    """How far joints turn, in degrees. collar: bones rise; forward: they come forward. aside, ahead: upper
    arms leave the sides, and go ahead. elbow: elbows bend. curls: the first and second joints of fingers but
    the thumb.
    """

    collar: float
    forward: float
    aside: float
    ahead: float
    elbow: float
    curls: tuple[float, float]


TENSE = ArmDegrees(4.0, 0.0, 1.5, 9.0, 18.0, (34.0, 42.0))
CLOSED = ArmDegrees(0.0, 9.0, -4.0, 0.0, 0.0, (24.0, 30.0))


def find_tension(
    roles: Mapping[str, int],
    at: Array,
    axes: Array,
    local: Callable[[int, Array], Array],
    degrees: ArmDegrees,
) -> dict[int, Array]:
    """Return for each joint that turns its rotation vector at 1, in its own space. at: where joints are in
    the base pose; axes `[3, 3]`: the character's left, up and
    ahead.
    """
    left, up, ahead = axes
    out: dict[int, Array] = {}
    for side, sign in zip(SIDES, (1.0, -1.0), strict=True):
        arm = [roles.get(f"{side}_{part}") for part in ("upper_arm", "lower_arm", "hand")]
        if roles.get(f"{side}_shoulder") is not None:
            collar = roles[f"{side}_shoulder"]
            turn = np.radians(degrees.collar) * ahead - np.radians(degrees.forward) * up
            out[collar] = sign * local(collar, turn)
        upper, lower, hand = arm
        if upper is None or lower is None or hand is None:
            continue
        bone, fore = _way(at, upper, lower), _way(at, lower, hand)
        lifted = np.radians(degrees.aside) * np.cross(bone, sign * left)
        lifted = lifted + np.radians(degrees.ahead) * np.cross(bone, ahead)
        out[upper] = local(upper, lifted)
        hinge = np.cross(fore, ahead)
        out[lower] = np.radians(degrees.elbow) * local(lower, hinge)
        first = [roles.get(f"{side}_{finger}_1") for finger in FINGERS[1:]]
        if first[0] is None or first[-1] is None:
            continue
        across = at[first[0]] - at[first[-1]]
        for finger in FINGERS[1:]:
            line = [roles.get(f"{side}_{finger}_{n}") for n in (1, 2, 3)]
            for (joint, beyond), curl in zip(pairwise(line), degrees.curls, strict=True):
                if joint is None or beyond is None:
                    continue
                along = _way(at, joint, beyond)
                palm = sign * np.cross(along, across)
                axis = np.cross(along, palm)
                size = float(np.linalg.norm(axis))
                if size > 1e-9:
                    out[joint] = np.radians(curl) * local(joint, axis / size)
    return out


def _way(at: Array, a: int, b: int) -> Array:
    way = at[b] - at[a]
    return np.asarray(way / max(1e-9, float(np.linalg.norm(way))))
