"""The layers of a plan at a time or at many, composed by the compiled loops that crowds are posed with.

Of a plan no more is laid out than is looked at, and a little ahead: it may be hours long, and another a
moment later.
"""

from __future__ import annotations

import contextlib
from bisect import bisect_right
from typing import Any
from weakref import ref

import numpy as np
from numpy.typing import NDArray

from metagraph.compiling import Loops, plain
from metagraph.graph.model import LAYERS, Layer, Project
from metagraph.motion.skeleton import Pose
from metagraph.playback.composer import ComposerRig
from metagraph.playback.laying import Layout, Line, layout
from metagraph.playback.plan import Cue, LayerPlan, Plan, Rest

Array = NDArray[Any]

COMPILED = Loops("metagraph.playback.crowd_kernels")
AHEAD = 15.0  # seconds laid out beyond what is looked at
MOST = 180.0  # seconds that are laid out because they were looked at before
KEPT = 4  # plans


def composed(plan: Plan, project: Project, frame: ComposerRig, times: Array) -> Pose | None:
    """Return what the layers compose at `times [N]`, rotations `[N, J, 4]` and translations `[N, J, 3]`, to
    1e-5 as `ComposerRig.compose` does; None while the loops are not loaded.
    """
    if COMPILED.now is None or not len(times):
        return None
    first = last = float(times[0])
    if len(times) > 1:
        first, last = float(times.min()), float(times.max())
    for known in tuple(_lately):
        if known.first <= first and last <= known.last and known.is_of(plan, project, frame):
            return known.poses(times)
    last += AHEAD
    for known in tuple(_lately):  # who looks here and there is spared the most of it
        if known.is_of(plan, project, frame):
            both = min(first, known.first), max(last, known.last)
            first, last = both if both[1] - both[0] <= MOST else (first, last)
            with contextlib.suppress(ValueError):  # another thread was faster
                _lately.remove(known)
    made = _LaidPlan(plan, project, frame, first, last)
    _lately.insert(0, made)
    del _lately[KEPT:]
    return made.poses(times)


class _LaidPlan:
    """The part of a plan between two times, laid out."""

    def __init__(self, plan: Plan, project: Project, frame: ComposerRig, first: float, last: float) -> None:
        self.plan, self.project, self.frame = ref(plan), ref(project), ref(frame)
        self.first, self.last = first, last
        of: Layout = layout(frame)
        lines: dict[Layer, list[Line]] = {name: [_between(plan.layers[name], first, last)] for name in LAYERS}
        self.given = of.lay(project, lines), of.base, of.travels, of.places
        self.parents = of.parents
        self.joints = len(of.places)
        self.alone = np.zeros(1, np.int64)

    def is_of(self, plan: Plan, project: Project, frame: ComposerRig) -> bool:
        return self.plan() is plan and self.project() is project and self.frame() is frame

    def poses(self, times: Array) -> Pose:
        count = len(times)
        which = self.alone if count == 1 else np.zeros(count, np.int64)
        rotations = np.empty((count, self.joints, 4), np.float32)
        translations = np.empty((count, self.joints, 3), np.float32)
        COMPILED.now.pose(
            *(0, count, plain(times), which, *self.given, rotations, translations),
            *(self.parents, _NO_TURNS, _NO_PLACES),
        )
        return Pose(rotations, translations)


_lately: list[_LaidPlan] = []
_NO_TURNS = np.empty((0, 0, 4), np.float32)
_NO_PLACES = np.empty((0, 0, 3), np.float32)


def _between(plan: LayerPlan, first: float, last: float) -> Line:
    """Return the rests and cues that matter between two times, both included."""
    cues, rests = plan.cues, plan.rests
    cue = max(0, bisect_right(cues, first, key=_begins) - 1)
    rest = max(0, bisect_right(rests, first, key=_fades) - 2)  # the one before may still fade
    return (
        rests[rest : bisect_right(rests, last, key=_fades)] or rests[:1],
        cues[cue : bisect_right(cues, last, key=_begins)],
    )


def _begins(cue: Cue) -> float:
    return cue.start


def _fades(rest: Rest) -> float:
    return rest.fade_start
