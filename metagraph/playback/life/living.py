"""Life for arrays of poses: its compiled loops, once those are loaded."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.compiling import Loops
from metagraph.graph.face import UPPER_FOLLOWS, UPPER_LID_SHUT, FaceRig
from metagraph.motion.skeleton import Pose
from metagraph.playback.life.body import Body
from metagraph.playback.life.gaze import Moves
from metagraph.playback.life.solve import FaceLids, LifeDials, LifeNow

Array = NDArray[Any]

MORPH_FOLLOWS = UPPER_FOLLOWS / np.radians(
    UPPER_LID_SHUT
)  # how far a morph target shuts for an eye that looks down a radian
COMPILED = Loops("metagraph.playback.life.life_kernels")


def lids_of(face: FaceRig) -> FaceLids:
    """Return a face's lids as `enlivened` takes them; where none is a joint, how far morph targets follow."""
    joints = [joint >= 0 for joint in face.lid_joints.tolist()]
    follows = face.follows.tolist() if any(joints) else [MORPH_FOLLOWS, MORPH_FOLLOWS, 0.0, 0.0]
    return FaceLids(joints, follows, face.shut_by.tolist())


def compiled(pose: Pose) -> bool:
    """Whether the loops are loaded, and are for poses of this kind."""
    return COMPILED.now is not None and pose.rotations.dtype == pose.translations.dtype == np.float32


def brought_to_life(
    pose: Pose,
    body: Body,
    dials: LifeDials,
    now: Sequence[LifeNow],
    moves: Sequence[Moves],
    looks: bool,
    channels: Array,
) -> Pose:
    """Return poses `[N, J]` with what happens to each added, as `solve.enlivened` says, and the face's
    channels `[N, C]`, of which those of lids and blinks are filled in. looks: whether moves count.
    """
    at, aims = np.zeros(len(moves) + 1, np.int64), _NO_AIMS
    if looks:
        rows = [(*a.at, a.amount, a.asked, eyes, head) for m in moves for a, eyes, head in m.parts]
        aims = np.array(rows, np.float64).reshape(-1, 7)
        at[1:] = np.array([len(m.parts) for m in moves]).cumsum()
    asides = np.array([(*m.eyes, *m.head) for m in moves], np.float64)
    rotations, translations = np.array(pose.rotations, order="C"), np.array(pose.translations, order="C")
    COMPILED.now.bring_to_life(
        *_laid_out(body),
        *(np.array(dials, np.float64), np.array(now, np.float64), at, aims, asides, looks),
        *(channels, rotations, translations),
    )
    return Pose(rotations, translations)


_NO_AIMS = np.zeros((0, 7))


@lru_cache(maxsize=8)
def _laid_out(body: Body) -> tuple[Any, ...]:
    """Return a body as `life_kernels` takes it."""
    face, lids = body.face, lids_of(body.face)
    shut = zip(lids.joints, lids.follows, lids.shut_by, strict=True)
    bends = [(*axis, angle) for axis, angle in body.breath]
    eyes = [(*e.at, *e.left, *e.up, *e.ahead, e.joint, *e.turn_left, *e.turn_up, *e.down) for e in body.eyes]
    return (
        body.chain.astype(np.int64),
        body.joints.astype(np.int64),
        body.read.astype(np.int64),
        np.array([body.left, body.up, body.ahead, body.trunk_ahead, body.head_ahead], np.float64),
        np.column_stack([np.array(bends, np.float64).reshape(-1, 4), body.bowed, body.thrust]).copy(),
        np.array([(*a, *b) for a, b in zip(body.shoulders, body.tense, strict=True)]).reshape(-1, 6),
        np.array([(x.place, x.share) for x in body.lookers], np.float64).reshape(-1, 2),
        body.trunk,
        np.array(eyes, np.float64),
        np.array([(joint, follows, *row) for joint, follows, row in shut], np.float64),
        np.array(face.turns, np.float64, order="C"),
        np.array(face.shifts[:, face.shifted], np.float64, order="C"),
        face.joints[face.shifted].astype(np.int64),
    )
