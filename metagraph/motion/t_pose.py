"""A figure in a T: arms held out to its sides, legs straight down, all else as in its rest pose."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from metagraph.motion import rotation
from metagraph.motion.skeleton import Pose, Skeleton

_ARM, _LEG = ("upper_arm", "lower_arm", "hand"), ("upper_leg", "lower_leg", "foot")


def make_t_pose(skeleton: Skeleton, roles: Mapping[str, int], left: NDArray[np.float64]) -> Pose:
    """Return the T `[J]`. left: the direction to the figure's left `[3]`. Limbs that have no roles stay."""
    rotations = np.array(skeleton.rest_rotations)
    translations = np.array(skeleton.rest_translations)
    for side, way in (("left", 1.0), ("right", -1.0)):
        for bones, towards in ((_ARM, way * np.asarray(left)), (_LEG, np.array([0.0, -1.0, 0.0]))):
            for upper, lower in pairwise(bones):
                joint, end = roles.get(f"{side}_{upper}"), roles.get(f"{side}_{lower}")
                if joint is None or end is None:
                    continue
                turned, at = skeleton.globals(Pose(rotations, translations))
                swing = rotation.find_rotation_between(at[end] - at[joint], towards)
                parent = int(skeleton.parents[joint])
                above = turned[parent] if parent >= 0 else rotation.IDENTITY
                made = rotation.multiply(swing, turned[joint])
                rotations[joint] = rotation.normalize(rotation.multiply(rotation.conjugate(above), made))
    return Pose(rotations, translations)
