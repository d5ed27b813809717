"""What can be measured on a clip: speed of the hands and head, stroke, how well a loop closes, how far two
poses are apart.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.motion.clip import Clip
from metagraph.motion.rig_controls import find_rig_controls
from metagraph.motion.skeleton import Pose, Skeleton

Array = NDArray[Any]


def measure_positions(clip: Clip, reference: int = 0) -> Array:
    """Return joint positions `[F, J, 3]` in metres, with the first frame's `reference` joint above the
    origin.
    """
    _, out = clip.skeleton.globals(clip.poses())
    return np.asarray(out - out[:1, reference : reference + 1] * np.array([1, 0, 1], np.float32))


def measure_speed(clip: Clip, joints: Sequence[int], frame_of: int | None = None) -> Array:
    """Return `[F]` the fastest of `joints`' speeds, metres a second, relative to joint `frame_of` (the
    shoulders' parent, say).

    Central differences; one-frame clips have speed 0.
    """
    if clip.frames < 2 or not joints:
        return np.zeros(clip.frames, np.float32)
    _, where = clip.skeleton.globals(clip.poses())
    chosen = where[:, list(joints)]
    if frame_of is not None:
        chosen = chosen - where[:, frame_of : frame_of + 1]
    velocity = np.gradient(chosen, 1 / clip.fps, axis=0)
    return np.asarray(np.linalg.norm(velocity, axis=-1).max(axis=-1))


def find_stroke(speeds: Array, fps: float) -> float:
    """Return the time in seconds of the largest speed: a gesture's most telling moment."""
    return float(np.argmax(speeds)) / fps if len(speeds) else 0.0


def measure_pose_distance(skeleton: Skeleton, a: Pose, b: Pose, joints: Sequence[int] | None = None) -> Array:
    """Return `[...]` the largest distance in metres of any of `joints` between poses, both with joint 0 at
    the origin. joints: all but a rig's controls where it is left out.
    """
    if a.rotations.ndim == 2 and _alike(a, b):  # one pose costs as much as two
        both = Pose(np.stack((a.rotations, b.rotations)), np.stack((a.translations, b.translations)))
        pa, pb = skeleton.globals(both)[1]
    else:
        pa, pb = skeleton.globals(a)[1], skeleton.globals(b)[1]
    chosen = (
        sorted(set(range(len(skeleton))) - find_rig_controls(skeleton)) if joints is None else list(joints)
    )
    if not chosen:
        return np.zeros(pa.shape[:-2])
    d = (pa - pa[..., :1, :])[..., chosen, :] - (pb - pb[..., :1, :])[..., chosen, :]
    return np.asarray(np.linalg.norm(d, axis=-1).max(axis=-1))


def _alike(a: Pose, b: Pose) -> bool:
    """Whether two poses lie in arrays of the same shapes and types."""
    return all(
        x.shape == y.shape and x.dtype == y.dtype
        for x, y in ((a.rotations, b.rotations), (a.translations, b.translations))
    )


def measure_loop_error(clip: Clip, start: float = 0.0, end: float | None = None) -> float:
    """Return in metres how far the pose at `end` is from the pose at `start` (seconds)."""
    ends = clip.pose_at(np.array([start, clip.duration if end is None else end]))
    return float(measure_pose_distance(clip.skeleton, ends[0], ends[1]))
