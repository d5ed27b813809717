"""Many characters at once: the player's poses for a crowd, each with a plan and a time of its own, in
compiled loops.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import lru_cache
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.graph import anatomy
from metagraph.graph.model import LAYERS, Action, Layer, Project
from metagraph.motion.clip import Clip
from metagraph.motion.skeleton import Pose
from metagraph.playback.composer import ComposerRig, Offsets, rig
from metagraph.playback.plan import Cue, Plan, Rest
from metagraph.playback.player import playable

Array = NDArray[Any]

# Records of what the loops read; a clip's `first` is its first row in the layer's tables.
CLIP = np.dtype([("first", "i8"), ("frames", "i8"), ("fps", "f8")])
REST = np.dtype(
    [(n, "f8") for n in ("start", "fade_start", "fade", "first", "length", "seam", "period")]
    + [("clip", "i8")]
)
_TIMES = ("start", "end", "entry", "blend_in", "blend_out", "extent", "tempo", "held", "hold", "rate")
CUE = np.dtype([(n, "f8") for n in _TIMES] + [("clip", "i8"), ("mask", "i8")])

LANES = 16  # joints in a block; crowd_kernels.LANES, which is not imported before it is needed
SHARED = 128  # characters a thread should have at least, for a second thread to pay


class Crowd:
    """The characters of one project, one plan each; plans may be shared. Everything is laid out once, when it
    is made.

    Poses agree with `pose_at` without life layers, contacts and the guard to 1e-5. The first call in a
    process imports numba, the first ever compiles (seconds). A crowd is for one thread at a time. Raises
    ValueError when the project has no skeleton.
    """

    def __init__(self, project: Project, plans: Sequence[Plan]) -> None:
        self.skeleton = project.skeleton
        frame = rig(project)
        unique = {id(plan): plan for plan in plans}
        places = {ident: n for n, ident in enumerate(unique)}
        self._plan_of = np.array([places[id(plan)] for plan in plans], np.int64)
        blocks = _Blocks(frame)
        self._tables = [_Tables(project, frame, layer, blocks).of(list(unique.values())) for layer in LAYERS]
        self._base, self._places, self._travels = (
            blocks.base(),
            blocks.places,
            frame.ground.base.translations.astype(np.float32),
        )
        # Memory for what is worked out on the way.
        self._blocked = np.empty((len(plans), *self._base.shape), np.float32)
        self._local: Pose | None = None

    def __len__(self) -> int:
        return len(self._plan_of)

    def poses(self, seconds: Any, out: Pose | None = None) -> Pose:
        """Return each character's pose at its time, `seconds [C]` or one for all: rotations `[C, J, 4]`,
        translations `[C, J, 3]`.

        out: float32 poses to write into, such as an earlier frame's; new memory costs nearly as much as the
        poses do.
        """
        from metagraph.playback.crowd_kernels import add_layer, to_joints

        times = np.array(np.broadcast_to(np.asarray(seconds, np.float64), (len(self),)))
        count, joints = len(self), len(self._places)
        pose = out or Pose(np.empty((count, joints, 4), np.float32), np.empty((count, joints, 3), np.float32))

        def some(first: int, last: int) -> None:
            self._blocked[first:last] = self._base
            pose.translations[first:last] = self._travels
            for tables in self._tables:
                add_layer(first, last, times, self._plan_of, *tables, self._blocked, pose.translations)
            to_joints(first, last, self._blocked, self._places, pose.rotations)

        _share(some, count)
        return pose

    def globals(self, seconds: Any, out: tuple[Array, Array] | None = None) -> tuple[Array, Array]:
        """Return model-space rotations `[C, J, 4]` and positions `[C, J, 3]`, metres. out: float32 arrays to
        write into.
        """
        from metagraph.playback.crowd_kernels import to_globals

        pose = self._local = self.poses(seconds, self._local)
        assert self.skeleton is not None
        parents = self.skeleton.parents
        rotations, positions = out or (np.empty_like(pose.rotations), np.empty_like(pose.translations))

        def some(first: int, last: int) -> None:
            to_globals(first, last, parents, pose.rotations, pose.translations, rotations, positions)

        _share(some, len(self))
        return rotations, positions


@lru_cache(maxsize=1)
def _pool() -> ThreadPoolExecutor:
    return ThreadPoolExecutor(os.cpu_count() or 1, "crowd")


def _share(work: Callable[[int, int], None], count: int) -> None:
    """Do the work on as many threads as pay; the loops do not hold the interpreter's lock."""
    parts = max(1, min(os.cpu_count() or 1, count // SHARED))
    edges = [count * n // parts for n in range(parts + 1)]
    jobs = [_pool().submit(work, a, b) for a, b in pairwise(edges[1:])]
    work(edges[0], edges[1])
    for job in jobs:
        job.result()


class _Blocks:
    """Joints in blocks of 16 that the same layers reach, so that a layer's joints are whole blocks. places
    `[J]`: of each joint's x.
    """

    def __init__(self, frame: ComposerRig) -> None:
        self.rotations = frame.ground.base.rotations
        reached = np.zeros(len(self.rotations), int)
        for n, layer in enumerate(LAYERS):
            reached[frame.reach[layer].joints] += 1 << n
        self.places = np.zeros(len(reached), np.int64)
        self.kinds: list[int] = []  # of each block, which layers reach it
        for kind in np.unique(reached):
            joints = np.flatnonzero(reached == kind)
            lane = np.arange(len(joints))
            self.places[joints] = (len(self.kinds) + lane // LANES) * 4 * LANES + lane % LANES
            self.kinds += [int(kind)] * (-(-len(joints) // LANES))

    def base(self) -> Array:
        """Return the base pose's rotations `[B, 64]`."""
        return np.asarray(self.spread(self.rotations[None], np.arange(len(self.rotations)))[0])

    def of(self, layer: Layer) -> Array:
        """Return the blocks a layer reaches."""
        return np.array([b for b, kind in enumerate(self.kinds) if kind >> LAYERS.index(layer) & 1], np.int64)

    def spread(self, rotations: Array, joints: Array) -> Array:
        """Return rotations `[F, n, 4]` of joints `[n]` in all blocks `[F, B, 64]`, no rotation elsewhere."""
        out = np.zeros((len(rotations), len(self.kinds), 4, LANES), np.float32)
        out[:, :, 3] = 1
        block, lane = np.divmod(self.places[joints], 4 * LANES)
        out[:, block, :, lane] = rotations.swapaxes(0, 1)
        return out.reshape(len(rotations), -1, 4 * LANES)

    def lanes(self, values: Array, joints: Array, otherwise: float) -> Array:
        """Return a number for each joint, `values [n]`, in all blocks `[B, 16]`."""
        out = np.full((len(self.kinds), LANES), otherwise, np.float32)
        block, lane = np.divmod(self.places[joints], 4 * LANES)
        out[block, lane] = values
        return out


def _held(cue: Cue) -> tuple[float, float, float]:
    """Return clip seconds before the hold, seconds of it, and clip seconds a second in it."""
    return (
        (cue.hold_from - cue.entry, cue.hold, (cue.hold_to - cue.hold_from) / cue.hold)
        if cue.hold > 0
        else (0.0, 0.0, 1.0)
    )


class _Tables:
    """One layer of the plans, and the clips they play, laid out flat: what the loops read."""

    def __init__(self, project: Project, frame: ComposerRig, layer: Layer, blocks: _Blocks) -> None:
        self.project, self.ground, self.reach, self.layer, self.blocks = (
            project,
            frame.ground,
            frame.reach[layer],
            layer,
            blocks,
        )
        self.known: dict[Clip, int] = {}
        self.clips: list[tuple[int, int, float]] = []
        self.offsets: list[Offsets] = []
        self.rows = 0
        self.masks: list[Array] = []
        self.mask_of: dict[bytes, int] = {}

    def of(self, plans: Sequence[Plan]) -> tuple[Any, ...]:
        """Return what `crowd_kernels.add_layer` takes between plan_of and out, in its order."""
        rests: list[tuple[float, ...]] = []
        cues: list[tuple[float, ...]] = []
        rest_at, cue_at = [0], [0]
        for plan in plans:
            lane = plan.layers[self.layer]
            rests += [self._rest(rest) for rest in lane.rests]
            for cue in lane.cues:
                clip, mask = self._clip(cue.action), self._mask(cue.action)
                times = (cue.start, cue.end, cue.entry, cue.blend_in, cue.blend_out, cue.extent, cue.tempo)
                cues.append((*times, *_held(cue), clip, mask))
            rest_at.append(len(rests))
            cue_at.append(len(cues))
        rest_table, cue_table = np.array(rests, REST), np.array(cues, CUE)
        return (
            *(rest_table, rest_table["fade_start"].copy(), np.array(rest_at)),
            *(cue_table, cue_table["start"].copy(), np.array(cue_at)),
            *self._motion(),
        )

    def _motion(self) -> tuple[Any, ...]:
        joints, own = self.reach.joints, self.blocks.of(self.layer)
        weights = np.ones(len(joints), np.float32) if self.reach.weights is None else self.reach.weights[:, 0]
        moved = np.unique(np.concatenate([np.empty(0, np.int64), *(o.moved for o in self.offsets)]))
        turns = np.zeros((self.rows, len(own), 4 * LANES), np.float32)
        ways = np.zeros((self.rows, len(moved), 3), np.float32)
        for (first, frames, _), offsets in zip(self.clips, self.offsets, strict=True):
            turns[first : first + frames] = self.blocks.spread(offsets.rotations, joints)[:, own]
            ways[first : first + frames, np.searchsorted(moved, offsets.moved)] = offsets.translations
        masks = np.zeros((len(self.masks), len(own), LANES), np.float32)
        for n, mask in enumerate(self.masks):
            masks[n] = self.blocks.lanes(mask, joints, 1)[own]
        return (
            *(np.array(self.clips, CLIP), turns, ways, own),
            *(
                joints[moved],
                weights[moved],
                self.blocks.lanes(weights, joints, 1)[own],
                self.reach.weights is not None,
            ),
            *(masks, np.array(self.masks, np.float32).reshape(-1, len(joints))[:, moved]),
            *self._scales(moved),
        )

    def _scales(self, moved: Array) -> tuple[Array, Array]:
        """Return which joints turn farther and less far where a cue is larger or smaller, and which
        movers.
        """
        joints, own = self.reach.joints, self.blocks.of(self.layer)
        scales = anatomy.scales(self.project)[:, joints]
        lanes = np.array([self.blocks.lanes(row, joints, 0)[own] for row in scales])
        return lanes, np.ascontiguousarray(scales[:, moved])

    def _rest(self, rest: Rest) -> tuple[float, ...]:
        first, end = self.project.span(rest.action)
        length = end - first
        seam = min(max(0.0, rest.action.timing.blend_in), length / 2)
        return (
            rest.start,
            rest.fade_start,
            rest.fade,
            first,
            length,
            seam,
            length - seam,
            self._clip(rest.action),
        )

    def _clip(self, action: Action) -> int:
        motion = playable(self.project, action)
        if motion is None:
            return -1
        if motion not in self.known:
            self.known[motion] = len(self.clips)
            self.clips.append((self.rows, motion.frames, motion.fps))
            self.offsets.append(self.ground.offsets(motion, self.reach))
            self.rows += motion.frames
        return self.known[motion]

    def _mask(self, action: Action) -> int:
        mask = anatomy.mask(self.project, action)
        shown = mask[self.reach.joints] if mask is not None else None
        if shown is None or (shown == 1).all():
            return -1
        if shown.tobytes() not in self.mask_of:
            self.mask_of[shown.tobytes()] = len(self.masks)
            self.masks.append(shown)
        return self.mask_of[shown.tobytes()]
