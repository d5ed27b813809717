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

from metagraph.graph.model import LAYERS, Project
from metagraph.motion.skeleton import Pose
from metagraph.playback.composer import rig
from metagraph.playback.laid_plan import COMPILED
from metagraph.playback.laying import layout
from metagraph.playback.plan import Plan

Array = NDArray[Any]

SHARED = 128  # characters a thread should have at least, for a second thread to pay


class Crowd:
    """The characters of one project, one plan each; plans may be shared. Everything is laid out once, when it
    is made.

    Poses agree with `pose_at` without life layers, contacts and the guard to 1e-5. The first call in a
    process loads the loops: their object code where that is kept, or numba, which the first time ever
    compiles (seconds). A crowd is for one thread at a time. Raises ValueError when the project has no
    skeleton.
    """

    def __init__(self, project: Project, plans: Sequence[Plan]) -> None:
        self.skeleton = project.skeleton
        frame = self._frame = rig(project)
        unique = {id(plan): plan for plan in plans}
        places = {ident: n for n, ident in enumerate(unique)}
        self._plan_of = np.array([places[id(plan)] for plan in plans], np.int64)
        self._layout = layout(frame)
        each = [plan.layers for plan in unique.values()]
        lines = {layer: [(of[layer].rests, of[layer].cues) for of in each] for layer in LAYERS}
        self._layers = self._layout.lay(project, lines)

    def __len__(self) -> int:
        return len(self._plan_of)

    def poses(self, seconds: Any, out: Pose | None = None) -> Pose:
        """Return each character's pose at its time, `seconds [C]` or one for all: rotations `[C, J, 4]`,
        translations `[C, J, 3]`.

        out: float32 poses in one piece to write into, such as an earlier frame's; new memory costs nearly as
        much as the poses do.
        """
        found = out or self._empty()
        self._posed(seconds, found, _NOTHING)
        return found

    def globals(self, seconds: Any, out: tuple[Array, Array] | None = None) -> tuple[Array, Array]:
        """Return model-space rotations `[C, J, 4]` and positions `[C, J, 3]`, metres. out: float32 arrays
        in one piece to write into.
        """
        made = self._empty() if out is None else Pose(*out)
        self._posed(seconds, _NOTHING, made)
        return made.rotations, made.translations

    def _empty(self) -> Pose:
        count, joints = len(self), len(self._layout.places)
        return Pose(np.empty((count, joints, 4), np.float32), np.empty((count, joints, 3), np.float32))

    def _posed(self, seconds: Any, out: Pose, model: Pose) -> None:
        COMPILED.load()
        pose = COMPILED.now.pose
        times = np.array(np.broadcast_to(np.asarray(seconds, np.float64), (len(self),)))
        of = self._layout
        base = of.base, of.travels, of.places

        def some(first: int, last: int) -> None:
            pose(
                *(first, last, times, self._plan_of, self._layers, *base),
                *(out.rotations, out.translations, of.parents, model.rotations, model.translations),
            )

        _share(some, len(self))


_NOTHING = Pose(np.empty((0, 0, 4), np.float32), np.empty((0, 0, 3), np.float32))


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
