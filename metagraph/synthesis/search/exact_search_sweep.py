"""One sweep of the exact search over all frames: dynamic programming from the first frame on or, backwards,
from the last one.

A jump and the frames after it are one step, so that how long ago the last one was need not be part of where
one is.
"""

from __future__ import annotations

import copy
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.synthesis.search.exact_search_links import SearchLinks
from metagraph.synthesis.search.exact_search_problem import SearchProblem
from metagraph.synthesis.search.frame_costs import PaidAlong
from metagraph.synthesis.search.lookups import is_due_at
from metagraph.synthesis.search.path import Cancelled, check_cancelled, describe_stuck
from metagraph.synthesis.states import SynthesisError

Array = NDArray[Any]

SPARE = 8  # steps of costs above those who jump, where few do, within which they land
LOW = np.float32(0.5)  # steps of costs within which somebody is as cheap as the cheapest
SORTED = 16  # frames after which those who are somewhere are put in order again
DRAWN = 8  # looks for a cheap way to a state cost as much, each, as so many ways that are followed


@dataclass(frozen=True, eq=False)
class Foresight:
    """What ways cost from where one lands to the end, found backwards. within: they are known up to that.
    reached: of each frame, counted from the last, where (as the loops count it, backwards) somebody comes
    from, and for what; of frames that nobody came as far as there is nothing.
    """

    within: Any
    reached: Sequence[tuple[Array, Array]]


class Sweep:
    """One sweep within a bound. cost `[2 F]`: of the cheapest way to where somebody is; alive: if that is, as
    the loops count it. through: what some way all through costs that was come upon, infinite without. exact:
    the sweep as it was when it first left somebody out for others were cheaper; None before.
    """

    exact: Sweep | None = None

    def __init__(
        self,
        problem: SearchProblem,
        links: SearchLinks,
        opposite: SearchLinks,
        bound: float,
        slack: float,
        foresight: Foresight | None = None,
        narrow: int = 0,
        cancelled: Cancelled = None,
    ) -> None:
        """links: the transitions; opposite: the same turned round. bound: what no way may cost more than,
        with what it costs to go on as far as it is foreseen.
        """
        self._problem, self._links, self._opposite, self._cancelled = problem, links, opposite, cancelled
        self._slack, self._narrow = np.float32(slack), narrow
        self._bound = np.float32(bound) * self._slack
        self._run = problem.run
        self._paid = PaidAlong(problem.charged, problem.first) if problem.charged is not None else None
        places = 2 * len(problem.first)
        self.cost, self._then = np.full((2, places), np.inf, np.float32)
        self._whole = np.full(places, np.inf, np.float32) if self._paid is not None else self.cost
        self._foresee_by(foresight)
        self._alive, self._living, self._back = np.empty((3, places), np.int32)
        self._number = 0
        self._landed = np.full((self._run, places), np.inf, np.float32)
        self._sources = np.empty((self._run, places), np.int32)
        self._reached = [np.empty(0, np.int32)] * self._run
        self._room = np.empty(places, np.int32)
        self.runs = np.zeros(places, np.int32)
        self._spare = np.float32(SPARE * links.width)
        self.through = np.float32(np.inf)
        self._frame = 0  # that it has come to
        self._last = -1  # frame that somebody was in a state at who was not on the way from a jump
        self._ways: list[tuple[Array, Array]] = []

    def _foresee_by(self, foresight: Foresight | None) -> None:
        self._foresight, self._unknown = foresight, np.float32(0)
        if foresight is not None:
            self._unknown = np.nextafter(np.float32(foresight.within), np.float32(np.inf))
        self._ahead = np.full(2 * len(self._problem.first) + 1, self._unknown)

    def limit(self, bound: float) -> None:
        """Follow no ways any more that cost more; may be called from another thread."""
        self._bound = min(self._bound, np.float32(bound) * self._slack)

    def within(self, bound: float, slack: float, foresight: Foresight | None) -> Sweep:
        """Return a sweep that goes on from where this one is, leaving nobody out but by a bound."""
        out = self._copied()
        out._slack, out._narrow = np.float32(slack), 0
        out._bound = np.float32(bound) * out._slack
        out._foresee_by(foresight)
        return out

    def _copied(self) -> Sweep:
        out = copy.copy(self)
        for name, value in vars(self).items():
            if isinstance(value, np.ndarray):
                setattr(out, name, value.copy())
        if self._paid is None:
            out._whole = out.cost
        out._ways, out._reached = [*self._ways], [*self._reached]
        out._paid = self._paid.copied() if self._paid is not None else None
        return out

    @property
    def alive(self) -> Array:
        return self._alive[: self._number]

    def forwards(self) -> list[tuple[Array, Array]]:
        """Sweep up to the last frame, where cost is with what frames cost; return of each frame where
        somebody is, and where the way there comes from. Raises SynthesisError if none comes as far, or when
        it was cancelled.
        """
        frames = len(self._problem.wanted)
        if not self._frame:
            self._begin()
            self._ways, self._frame = [(self.alive.copy(), self._back[:0])], 1
        for t in range(self._frame, frames):
            self._frame = t
            if self._step(t):
                self._last = t - 1
            elif t - 1 - self._last >= self._run:  # nobody is on the way from a jump either
                break
            self._ways.append((self.alive.copy(), self._back[self.alive]))
        if not self._number:
            raise SynthesisError(describe_stuck(self._last + 1))
        self._pay()
        if not self._number:  # runs that came along since they were looked at
            raise SynthesisError(describe_stuck(frames - 1))
        self.cost = self._whole
        return self._ways

    def backwards(self) -> Foresight:
        """Sweep as far as anybody comes. Raises SynthesisError when it was cancelled."""
        reached: list[tuple[Array, Array]] = []
        last = -1
        self._begin()
        for t in range(1, len(self._problem.wanted) + 1):
            self._pay()
            reached.append((self.alive.copy(), self._whole[self.alive]))
            if t == len(self._problem.wanted):
                break
            if self._step(t):
                last = t - 1
            elif t - 1 - last >= self._run:
                break
        return Foresight(self._bound, reached)

    def _begin(self) -> None:
        """Come to the first frame."""
        of, fits = self._problem.classes.of_state, self._problem.ahead[0] > 0
        codes = np.flatnonzero(fits) + len(of) * self._problem.classes.meets[0][of[fits]]
        self._number = len(codes)
        self._alive[: self._number] = codes
        self.cost[codes] = 0
        self._close(0)

    def _pay(self) -> None:
        """Add what was paid along takes, and leave only those alive that are within the bound."""
        from metagraph.synthesis.search.exact_search_kernels import with_paid

        if self._paid is not None:
            self._whole.fill(np.inf)
            self._number = with_paid(self.cost, self.alive, self._paid.now, self._bound, self._whole)

    def _step(self, t: int) -> bool:
        """Come from the frame before to frame t; return whether anybody was there."""
        from metagraph.synthesis.search.exact_search_kernels import arrive, follow_takes, land

        check_cancelled(self._cancelled)
        problem, run, frames = self._problem, self._run, len(self._problem.wanted)
        self._pay()
        some, place = self._number > 0, t % run
        self._leap(t, place)
        if self._paid is not None:
            self._paid.go_on(t)
            land(self._landed[place], self._reached[place], self._paid.before)
        self._number = follow_takes(
            self.cost,
            self.alive,
            self._then,
            self._living,
            self._back,
            problem.ahead[t],
            problem.classes.meets[t],
            problem.classes.of_state,
            problem.first,
            self._bound,
        )
        if self._paid is None:
            self._whole = self._then
        self.cost, self._then = self._then, self.cost
        self._alive, self._living = self._living, self._alive
        # at the end a run may be cut short
        for ago in range(1 if t == frames - 1 else run, min(run, t) + 1):
            landed = (t - ago + 1) % run
            if len(self._reached[landed]):
                self._number = arrive(
                    self._landed[landed],
                    self._sources[landed],
                    self._reached[landed],
                    ago,
                    self.cost,
                    self._alive,
                    self._number,
                    self._back,
                    self.runs,
                    problem.pieces(t - ago + 1, t),
                    problem.upcoming,
                )
        self._close(t)
        if t % SORTED == 0:
            self.alive.sort()  # what is near in memory is looked at together
        return some

    def _leap(self, t: int, place: int) -> None:
        """Jump to arrive at frame t."""
        from metagraph.synthesis.search.exact_search_kernels import (
            draw_leap,
            find_least,
            leap,
            undo_foresight,
            weigh,
        )

        problem, classes = self._problem, self._problem.classes
        landed, sources = self._landed[place], self._sources[place]
        landed[self._reached[place]] = np.inf
        codes, floor = self._foresee(t)
        reach = self._bound - floor
        work, low = weigh(self._whole, self.alive, self._links.starts, reach, LOW * self._links.width)
        ahead = (problem.ahead[t], min(self._run, len(problem.ahead) - t), self._ahead)
        number = 0
        if work > DRAWN * len(self._opposite.leaving) * len(self._links.leaving) / max(low, 1):
            lowest = find_least(self._whole, self.alive, classes.of_state, classes.count)
            number, through = draw_leap(
                self._whole,
                lowest,
                landed,
                sources,
                self._room,
                self._links.entered,
                *self._opposite.arranged,
                classes.fitting[t - 1],
                classes.count,
                ahead[0],
                problem.first,
                *ahead[1:],
                self._bound,
                self._links.width,
                self._links.cheapest,
            )
        elif work:
            alive, reach = self._narrowed(reach)
            number, through = leap(
                self._whole,
                alive,
                landed,
                sources,
                self._room,
                *self._links.arranged,
                classes.fitting[t],
                classes.count,
                *ahead,
                len(codes) > 0,
                reach,
                self._bound,
                self._links.width,
            )
        if work and through < self.through:
            self.through = through
            self._bound = min(self._bound, through * self._slack)
        self._reached[place] = self._room[:number].copy()
        if len(codes):
            undo_foresight(codes, self._unknown, self._ahead)

    def _narrowed(self, reach: Any) -> tuple[Array, Any]:
        """Return who jumps, and what nobody may cost more than by then."""
        if not 0 < self._narrow < self._number:
            return self.alive, reach
        if self.exact is None:
            self.exact = self._copied()
        costs = self._whole[self.alive]
        dear = np.partition(costs, self._narrow)[self._narrow]
        return self.alive[costs <= dear], min(reach, dear + self._spare)

    def _foresee(self, t: int) -> tuple[Array, Any]:
        """Look up what it costs to go on for who jumps to arrive at frame t; return if that is known, and the
        least.
        """
        from metagraph.synthesis.search.exact_search_kernels import foresee

        place = len(self._problem.wanted) - 1 - t
        if self._foresight is None or place >= len(self._foresight.reached):
            return np.empty(0, np.int32), self._unknown
        codes, costs = self._foresight.reached[place]
        window = self._problem.wanted.window
        crossing = window[t] >= 0 and window[t] == window[t - 1]
        return codes, foresee(codes, costs, crossing, self._unknown, self._ahead)

    def _close(self, t: int) -> None:
        """Forget ways on which the event was not met whose window ends; the others begin again."""
        from metagraph.synthesis.search.exact_search_kernels import close

        if is_due_at(self._problem.wanted, t):
            self._number = close(self.cost, self.alive, self._back, self.runs)
