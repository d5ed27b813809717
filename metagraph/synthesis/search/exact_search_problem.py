"""What the exact search asks of states and frames, seen forwards or backwards.

Backwards, states and frames are numbered from the last on. Whatever is asked is the same then: how long a run
is, that an event is met in its window, what frames cost.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.synthesis.constraints import EDGE, STRESS, HeardStates, WantedSegment
from metagraph.synthesis.graph import MotionGraph
from metagraph.synthesis.search.frame_costs import FrameCosts
from metagraph.synthesis.search.lookups import EVENTS

Array = NDArray[Any]


@dataclass(frozen=True, eq=False)
class SearchProblem:
    """wanted: what is to be heard. classes: of states. first `[F]`: whether a state is the first of its take.
    happening `[2, F]`: which states are which of EVENTS. run: frames between two transitions, at least.
    charged: what frames cost.
    """

    wanted: WantedSegment
    classes: StateClasses
    first: Array
    happening: Array
    run: int
    charged: FrameCosts | None

    @classmethod
    def of(
        cls,
        graph: MotionGraph,
        heard: HeardStates,
        wanted: WantedSegment,
        run: int = 1,
        charged: FrameCosts | None = None,
    ) -> SearchProblem:
        first = np.zeros(len(graph.states), bool)
        first[graph.states.starts[:-1]] = True
        happening = np.stack([heard.happens(what) for what in EVENTS])
        run = min(run, max(1, len(wanted) - 1))
        return cls(wanted, StateClasses.of(graph, heard, wanted), first, happening, run, charged)

    def turned(self) -> SearchProblem:
        """Return the same seen backwards."""
        last = np.append(self.first[1:], True)
        happening = np.ascontiguousarray(self.happening[:, ::-1])
        charged = self.charged
        if charged is not None:
            charged = FrameCosts(
                tuple(replace(kind, at=kind.at[::-1], rows=kind.rows[:, ::-1]) for kind in charged.kinds)
            )
        return replace(
            self,
            wanted=_turned(self.wanted),
            classes=self.classes.turned(),
            first=last[::-1].copy(),
            happening=happening,
            charged=charged,
        )

    @cached_property
    def ahead(self) -> Array:
        """`[T, F]` for how many frames a state's take fits from a frame on, at most as long as a run is."""
        frames, states = len(self.wanted), len(self.first)
        kind = np.uint8 if self.run < 256 else np.min_scalar_type(self.run)
        out = np.zeros((frames, states), kind)
        goes_on = (~self.first[1:]).astype(kind)
        known: dict[bytes, Array] = {}  # which states fit, of frames that ask the same
        for t in range(frames - 1, -1, -1):
            row, now = self.classes.fits[t], out[t]
            if (fits := known.get(row.tobytes())) is None:
                fits = known[row.tobytes()] = np.append(row, False)[self.classes.of_state].astype(kind)
            if t + 1 < frames:
                np.minimum(out[t + 1, 1:], self.run - 1, out=now[:-1])
                now[:-1] *= goes_on
            now += 1
            now *= fits
            if t in self.wanted.only:
                now *= self.wanted.only[t]
        return out

    @cached_property
    def upcoming(self) -> Array:
        """`[2, F]` the next state that is such an event, from each on."""
        from metagraph.synthesis.search.greedy_search_kernels import find_next_marked

        return np.stack([find_next_marked(row) for row in self.happening])

    @cached_property
    def spans(self) -> list[tuple[int, int, int]]:
        """The first and last frame of each window, and which of EVENTS it waits for."""
        edges = np.flatnonzero(np.diff(self.wanted.window)) + 1
        begins = [0, *edges.tolist()]
        return [
            (a, b - 1, EVENTS.index(self.wanted.event(a)))
            for a, b in zip(begins, [*begins[1:], len(self.wanted)], strict=True)
            if self.wanted.window[a] >= 0
        ]

    def pieces(self, first: int, last: int) -> Array:
        """Return, as `arrive` has them, the windows among the frames first .. last."""
        rows = [
            (max(a, first) - first, min(b, last) - first, row, a < first)
            for a, b, row in self.spans
            if a <= last and b >= first
        ]
        return np.array(rows, np.int64).reshape(-1, 4)


def _turned(wanted: WantedSegment) -> WantedSegment:
    frames = len(wanted)
    return WantedSegment(
        wanted.allowed[::-1],
        wanted.window[::-1],
        None if wanted.events is None else wanted.events[::-1],
        None if wanted.barred is None else wanted.barred[::-1],
        {frames - 1 - t: some[::-1].copy() for t, some in wanted.only.items() if t < frames},
    )


@dataclass(frozen=True, eq=False)
class StateClasses:
    """States of which frames ask the same. of_state `[F]` int32: which class a state is of, -1 for one of no
    path. fits `[T, C]`: which classes may come at a frame, except for which states alone may; meets `[T, C]`:
    which are the event its window waits for.
    """

    of_state: Array
    fits: Array
    meets: Array

    @classmethod
    def of(cls, graph: MotionGraph, heard: HeardStates, wanted: WantedSegment) -> StateClasses:
        events = heard.happens(STRESS) * STRESS + heard.happens(EDGE) * EDGE
        each, of = np.unique(heard.kinds.astype(np.int32) << 2 | events, return_inverse=True)
        kinds, happening = each >> 2, each & 3
        barred = np.array([wanted.bars(t) for t in range(len(wanted))])
        awaited = np.array([wanted.event(t) if wanted.window[t] >= 0 else 0 for t in range(len(wanted))])
        fits = ((wanted.allowed[:, None] & kinds) != 0) & ((barred[:, None] & happening) == 0)
        meets = (awaited[:, None] & happening) != 0
        return cls(np.where(graph.kept, of.reshape(-1), -1).astype(np.int32), fits, meets)

    def turned(self) -> StateClasses:
        """Return the same of what is seen backwards."""
        of_state, fits, meets = (
            np.ascontiguousarray(x[::-1]) for x in (self.of_state, self.fits, self.meets)
        )
        return StateClasses(of_state, fits, meets)

    @property
    def count(self) -> int:
        return int(self.fits.shape[1])

    @cached_property
    def fitting(self) -> list[Array]:
        """Of each frame the numbers of the classes that fit."""
        return [np.flatnonzero(row) for row in self.fits]
