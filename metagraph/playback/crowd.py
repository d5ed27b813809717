"""Many characters at once: the player's poses for a crowd, each with a plan and a time of its own, in compiled loops."""

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
from metagraph.graph.model import LAYERS, Action, Project
from metagraph.motion.clip import Clip
from metagraph.motion.skeleton import Pose
from metagraph.playback.composer import Rig, rig
from metagraph.playback.plan import LayerPlan, Plan
from metagraph.playback.player import playable

Array = NDArray[Any]

CLIP = np.dtype([("rotations", "i8"), ("translations", "i8"), ("moved", "i8"), ("moves", "i8"), ("frames", "i8"), ("fps", "f8")])
REST = np.dtype([(n, "f8") for n in ("start", "fade_start", "fade", "first", "length", "seam", "period")] + [("clip", "i8")])
CUE = np.dtype([(n, "f8") for n in ("start", "end", "entry", "blend_in", "blend_out")] + [("clip", "i8"), ("mask", "i8")])

SHARED = 128  # characters a thread should have at least, for a second thread to pay


class Crowd:
    """The characters of one project, one plan each; plans may be shared. Everything is laid out once, when it is made.

    Poses agree with `pose_at` to 1e-5. The first call in a process imports numba, the first ever compiles (seconds).
    Raises ValueError when the project has no skeleton.
    """

    def __init__(self, project: Project, plans: Sequence[Plan]) -> None:
        self.skeleton = project.skeleton
        self._rig = rig(project)
        unique = {id(plan): plan for plan in plans}
        places = {ident: n for n, ident in enumerate(unique)}
        self._plan_of = np.array([places[id(plan)] for plan in plans], np.int64)
        self._local: Pose | None = None  # memory for the poses on the way to model space
        self._tables = _Tables(project, self._rig, list(unique.values())).arrays()

    def __len__(self) -> int:
        return len(self._plan_of)

    def poses(self, seconds: Any, out: Pose | None = None) -> Pose:
        """Return each character's pose at its time, `seconds [C]` or one for all: rotations `[C, J, 4]`, translations `[C, J, 3]`.

        out: float32 poses to write into, such as an earlier frame's; new memory costs as much as the poses do.
        """
        from metagraph.playback.crowd_kernels import evaluate

        times = np.array(np.broadcast_to(np.asarray(seconds, np.float64), (len(self),)))
        base = self._rig.ground.base
        count, joints = len(self), len(base.rotations)
        pose = out or Pose(np.empty((count, joints, 4), np.float32), np.empty((count, joints, 3), np.float32))
        base_r, base_t = base.rotations.astype(np.float32), base.translations.astype(np.float32)

        def some(first: int, last: int) -> None:
            evaluate(first, last, times, self._plan_of, *self._tables, base_r, base_t, pose.rotations, pose.translations)

        _share(some, count)
        return pose

    def globals(self, seconds: Any, out: tuple[Array, Array] | None = None) -> tuple[Array, Array]:
        """Return model-space rotations `[C, J, 4]` and positions `[C, J, 3]`, metres. out: float32 arrays to write into."""
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
    if parts == 1:
        work(0, count)
        return
    edges = [count * n // parts for n in range(parts + 1)]
    jobs = [_pool().submit(work, a, b) for a, b in pairwise(edges[1:])]
    work(edges[0], edges[1])
    for job in jobs:
        job.result()


class _Tables:
    """Plans and clips laid out flat: what the loops read."""

    def __init__(self, project: Project, frame: Rig, plans: Sequence[Plan]) -> None:
        self.project, self.rig = project, frame
        self.clips: list[tuple[int, int, int, int, int, float]] = []
        self.rotations: list[Array] = []
        self.translations: list[Array] = []
        self.moved: list[Array] = []
        self.sizes = [0, 0, 0]  # numbers laid out so far: rotations, translations, moved
        self.known: dict[tuple[int, Clip], int] = {}
        self.masks: list[Array] = []
        self.mask_of: dict[int, int] = {}
        self.rests: list[tuple[float | int, ...]] = []
        self.cues: list[tuple[float | int, ...]] = []
        self.rest_at, self.cue_at = [0], [0]
        for plan in plans:
            for layer, name in enumerate(LAYERS):
                self._lay(layer, plan.layers[name])

    def _lay(self, layer: int, plan: LayerPlan) -> None:
        for rest in plan.rests:
            first, end = self.project.span(rest.action)
            length = end - first
            seam = min(max(0.0, rest.action.timing.blend_in), length / 2)
            self.rests.append((rest.start, rest.fade_start, rest.fade, first, length, seam, length - seam, self._clip(layer, rest.action)))
        for cue in plan.cues:
            clip, mask = self._clip(layer, cue.action), self._mask(cue.action)
            self.cues.append((cue.start, cue.end, cue.entry, cue.blend_in, cue.blend_out, clip, mask))
        self.rest_at.append(len(self.rests))
        self.cue_at.append(len(self.cues))

    def _clip(self, layer: int, action: Action) -> int:
        motion = playable(self.project, action)
        if motion is None:
            return -1
        place = self.known.get((layer, motion))
        if place is None:
            offsets = self.rig.ground.offsets(motion, self.rig.reach[LAYERS[layer]])
            place = self.known[layer, motion] = len(self.clips)
            self.clips.append((*self.sizes, len(offsets.moved), motion.frames, motion.fps))  # type: ignore[arg-type]
            for n, (rows, array) in enumerate(
                ((self.rotations, offsets.rotations), (self.translations, offsets.translations), (self.moved, offsets.moved))
            ):
                rows.append(array.ravel())
                self.sizes[n] += array.size
        return place

    def _mask(self, action: Action) -> int:
        mask = anatomy.mask(self.project, action)
        if mask is None:
            return -1
        if id(mask) not in self.mask_of:
            self.mask_of[id(mask)] = len(self.masks)
            self.masks.append(mask)
        return self.mask_of[id(mask)]

    def arrays(self) -> tuple[Array, ...]:
        """Return what `crowd_kernels.evaluate` takes, in its order."""
        rests, cues = np.array(self.rests, REST), np.array(self.cues, CUE)
        reach = [self.rig.reach[layer] for layer in LAYERS]
        ones = [np.ones(len(r.joints), np.float32) if r.weights is None else r.weights[:, 0] for r in reach]
        joints = len(self.rig.ground.skeleton)
        return (
            rests,
            np.ascontiguousarray(rests["fade_start"]),
            np.array(self.rest_at, np.int64),
            cues,
            np.ascontiguousarray(cues["start"]),
            np.array(self.cue_at, np.int64),
            np.array(self.clips, CLIP),
            _joined(self.rotations, np.float32),
            _joined(self.translations, np.float32),
            _joined(self.moved, np.int64),
            np.array(self.masks, np.float32).reshape(-1, joints),
            _joined([r.joints for r in reach], np.int64),
            np.cumsum([0, *(len(r.joints) for r in reach)]),
            _joined(ones, np.float32),
            np.array([r.weights is not None for r in reach]),
        )


def _joined(parts: Sequence[Array], dtype: Any) -> Array:
    return np.concatenate(parts).astype(dtype) if parts else np.empty(0, dtype)
