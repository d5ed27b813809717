"""Write motion as SMPL-H parameters in the way of AMASS, for programs that learn from them or show them.

The motion is retargeted to the figure that `smpl` reads such files on. `trans` is where the hips are, less
where the models have them at rest: 0.22 m below their origin. Z is up, as in AMASS. No model's file is
needed, and none is written.
"""

from __future__ import annotations

import io
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.formats.atomic import write_atomically
from metagraph.formats.smpl import make_smpl_figure
from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.motion.joint_map import propose_joint_map
from metagraph.motion.retarget import retarget

Array = NDArray[Any]

JOINTS = 52  # of SMPL-H: 22 of the body, 15 of each hand
_PELVIS = np.array([0.0, -0.22, 0.03])  # of the models' neutral body at rest, metres, about
_Z_UP = np.array([np.sqrt(0.5), 0.0, 0.0, np.sqrt(0.5)])  # a quarter turn about X: Y to Z


def write_smpl(clip: Clip, path: str | Path) -> None:
    """Write a clip as an .npz file: `poses` `[F, 156]` rotation vectors, radians, `trans` `[F, 3]` metres,
    `mocap_framerate`, `gender` and `betas`, all of them 0.

    Faces are lost. Raises RetargetError where the clip's skeleton has not what SMPL-H needs, and FileError.
    """
    figure = make_smpl_figure(JOINTS)
    motion = retarget(clip, figure, propose_joint_map(clip.skeleton, figure))
    local = motion.poses().rotations.astype(float)
    turns = np.broadcast_to(_Z_UP, (len(local), 4))
    local[:, 0] = rotation.multiply(turns, local[:, 0])
    out = io.BytesIO()
    np.savez_compressed(
        out,
        poses=_to_vectors(local).reshape(len(local), 3 * JOINTS),
        trans=rotation.rotate_vectors(turns, motion.root.astype(float)) - _PELVIS,
        mocap_framerate=np.array(clip.fps),
        gender=np.array("neutral"),
        betas=np.zeros(16),
    )
    write_atomically(Path(path), out.getvalue())


def _to_vectors(turns: Array) -> Array:
    """Return rotation vectors `[..., 3]`, axis times angle up to pi, of quaternions `[..., 4]`."""
    q = np.where(turns[..., 3:] < 0, -turns, turns)
    size = np.linalg.norm(q[..., :3], axis=-1, keepdims=True)
    angle = 2 * np.arctan2(size, q[..., 3:])
    return np.asarray(q[..., :3] * np.where(size > 1e-9, angle / np.maximum(size, 1e-12), 2.0))
