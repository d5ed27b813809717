"""A path through a motion graph that is extended while it plays: what was shown stays, what is about to be
shown within a moment stays, the rest is searched again when something new is heard.

Time goes by in frames, and a search is bounded by the work it does, not by how long that takes: the same news
at the same frames make the same path on any machine.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.suggest.tracks import RATE
from metagraph.synthesis.constraints import EDGE, STRESS, HeardStates
from metagraph.synthesis.extending.speech_so_far import LATE, SpeechNews, SpeechSoFar
from metagraph.synthesis.graph import MotionGraph
from metagraph.synthesis.search.lookups import CHEAPEST
from metagraph.synthesis.search.path import Path
from metagraph.synthesis.search.ruled_search import JumpRules, apply_rules
from metagraph.synthesis.states import States, SynthesisError, compute_cost_terms

Array = NDArray[Any]
Told = tuple[int, SpeechNews]  # the frame before which something became known

FADE = 10  # frames after a transition in which what was shown fades; as many as `assemble` blends in all
WAYS_OUT = 8  # where a take ends and no transition leads on: the most alike it goes on with
BEHIND = 6.0  # seconds for which what is known of speech is kept
SEEN = 40.0  # seconds for which it is known what was shown
LONG_AGO = 0.25  # of the price of what was shown a moment ago: what was shown in all that time
NOISE = 0.05  # of the threshold: what chance may make a transition dearer by
LOOK, AHEAD = (
    30,
    0.4,
)  # frames a way should go on at its end, and what one less costs, of the threshold, a second
MISSING = 0.5  # of the threshold, a frame: what a way that ends too early leaves out
NODES = 4096
SOONER = JumpRules(run=0.3, price=0.5)  # who has to answer at once jumps again sooner; it costs more instead


@dataclass(frozen=True)
class ExtendingRules:
    """How a path is extended. lock: frames ahead of what is shown that are not changed any more; horizon:
    frames that are planned beyond; every: frames between two searches, at least. work: frames a search looks
    at, at most. wrong: the price of a frame with what is not heard; stress, edge: of one that does not come;
    bar: of one that should not; again: of a frame that was shown within `jumps.recent`, less of one
    that was shown within SEEN seconds: of the threshold.
    jumps: `ruled_search.JumpRules`.
    """

    lock: int = 2
    horizon: int = 60
    every: int = 3
    work: int = 150_000
    wrong: float = 0.15
    stress: float = 3.0
    edge: float = 0.5
    bar: float = 0.5
    again: float = 0.1
    jumps: JumpRules = SOONER


@dataclass(frozen=True, eq=False)
class DriverGraph:
    """A motion graph made ready to be extended through. graph: with ways out; heard: at its states; ruled:
    with transitions at their prices. stops `[F]`: the first state behind a run that goes through each.
    """

    graph: MotionGraph
    heard: HeardStates
    ruled: MotionGraph
    stops: Array
    rules: ExtendingRules

    @property
    def states(self) -> States:
        return self.graph.states


def make_driver_graph(
    graph: MotionGraph, heard: HeardStates, rules: ExtendingRules | None = None
) -> DriverGraph:
    """Return a graph made ready: no way through it comes to an end. Raises SynthesisError if nothing is left
    of it to move with.
    """
    from metagraph.synthesis.search.greedy_search_kernels import find_next_marked

    rules = ExtendingRules() if rules is None else rules
    if not len(graph.keys) or graph.kept.sum() < 2:
        raise SynthesisError("the graph has no two states to go between: give longer takes")
    if len(heard.kinds) != len(graph.states):
        raise SynthesisError(
            f"the graph is of {len(graph.states)} frames, but what was heard is told of {len(heard.kinds)}"
        )
    last = graph.states.last.copy()
    last[:-1] |= graph.kept[:-1] & ~graph.kept[1:]
    stops = (find_next_marked(last) + 1).astype(np.int32)
    return DriverGraph(graph, heard, _ways_out(apply_rules(graph, rules.jumps), last), stops, rules)


def _ways_out(graph: MotionGraph, last: Array) -> MotionGraph:
    """Return a graph with transitions from states that nothing else leads on from: to those of key states
    that are most alike, whatever the threshold says.
    """
    states, kept = graph.states, graph.kept
    stuck = np.flatnonzero(last & kept & (np.diff(graph.starts) == 0))
    if not len(stuck):
        return graph
    first = np.zeros(len(states), bool)
    first[states.starts[:-1]] = True
    into = graph.keys[~first[graph.keys] & kept[graph.keys] & ~last[graph.keys]]
    if not len(into):
        into = np.flatnonzero(kept & ~first & ~last)
    if not len(into):
        raise SynthesisError("no take has three frames one after another: give longer takes")
    before = compute_cost_terms(states, into - 1)
    sources, targets, costs = [], [], []
    for state in stuck.tolist():
        apart = np.linalg.norm(before - compute_cost_terms(states, np.array([state])), axis=-1).sum(-1)
        near = np.argsort(apart, kind="stable")[:WAYS_OUT]
        sources += [state] * len(near)
        targets += into[near].tolist()
        costs += apart[near].tolist()
    own = np.repeat(np.arange(len(states)), np.diff(graph.starts))
    source = np.concatenate([own, sources])
    target = np.concatenate([graph.targets, np.array(targets, graph.targets.dtype)])
    order = np.lexsort((target, source))
    counts = np.bincount(source, minlength=len(states))
    price = np.concatenate([graph.costs, np.array(costs, graph.costs.dtype)])
    return replace(
        graph, starts=np.concatenate([[0], np.cumsum(counts)]), targets=target[order], costs=price[order]
    )


class PathExtender:
    """One path through a graph while it plays. frame: the one that is shown now, -1 before the first. found:
    how many searches there were; spent: the frames that the last one looked at. seed: of chance.
    """

    def __init__(self, graph: DriverGraph, seed: int = 1) -> None:
        from metagraph.synthesis.extending.extension_kernels import KnownStates
        from metagraph.synthesis.search.greedy_search_kernels import Links, find_cheapest

        self.graph, self.rules, self.seed = graph, graph.rules, seed
        self.speech = SpeechSoFar()
        self.frame, self.found, self.spent = -1, 0, 0
        self._limit = np.float32(graph.graph.threshold.limit)
        paid = graph.ruled
        self._links = Links(
            paid.starts, paid.targets, paid.costs, *find_cheapest(paid.starts, paid.costs, CHEAPEST // 2)
        )
        events = STRESS * graph.heard.happens(STRESS) | EDGE * graph.heard.happens(EDGE)
        self._events = events.astype(np.uint8)
        self._recent = np.zeros(len(graph.states), np.float32)
        self._shown = KnownStates(graph.heard.kinds, self._events, graph.stops, self._recent)
        self._lines = np.full(len(graph.states) + self.rules.horizon + 1, np.inf, np.float32)
        self._searched = -(10**6)
        self._first = 0  # the frame of the first state that is kept
        self._way: list[int] = [self._beginning()]

    def _beginning(self) -> int:
        """Return a state to begin in: of those in silence that go on longest by themselves."""
        graph = self.graph
        left = np.where(graph.graph.kept, graph.stops - np.arange(len(graph.stops)), 0)
        idle = np.where(graph.heard.kinds & 1, np.minimum(left, self.rules.horizon), 0)
        left = idle if idle.max() > 1 else np.minimum(left, self.rules.horizon)
        best = np.flatnonzero(left == left.max())
        return int(best[np.random.default_rng(self.seed).integers(len(best))])

    @property
    def end(self) -> int:
        """The frame behind the last that is planned."""
        return self._first + len(self._way)

    def at(self, frame: int) -> int:
        """Return the state of a frame; of one that is forgotten, or not planned, the nearest that is."""
        return self._way[min(max(frame - self._first, 0), len(self._way) - 1)]

    def states(self, first: int, after: int) -> list[int]:
        """Return the states of frames, those that are neither forgotten nor beyond what is planned."""
        return self._way[max(0, first - self._first) : max(0, after - self._first)]

    def step(self, news: Iterable[SpeechNews] = ()) -> None:
        """Go one frame on, having heard what became known since the last."""
        for one in news:
            self.speech.tell(one)
        self.frame += 1
        rules, lock = self.rules, self.frame + self.rules.lock
        due = self.speech.changed and self.frame - self._searched >= rules.every
        if due or self.end - 1 < lock or self.end - lock < rules.horizon - rules.horizon // 3:
            self._search(lock + 1)
        if self.frame % round(RATE) == 0:
            self._forget()

    def _search(self, first: int) -> None:
        """Plan again from a frame on, or from where the plan ends before."""
        from metagraph.synthesis.extending.extension_kernels import Prices, extend_path

        first = max(self._first + 1, min(first, self.end))
        self._searched, self.speech.changed = self.frame, False
        rules, limit = self.rules, self._limit
        before = self.states(first - round(3 * RATE), first)
        state, since = before[-1], 1
        while since < len(before) and before[-1 - since] == state - since:
            since += 1
        if since == len(before):
            since = max(since, rules.jumps.frames)  # where it came from is forgotten, or it began there
        want = self.speech.expected(
            first, rules.horizon, self._events[before[-round(2 * LATE * RATE) :]].tolist(), self.frame
        )
        waits = np.where(want.waits == STRESS, rules.stress, rules.edge).astype(np.float32)
        prices = Prices(
            want.allowed,
            rules.wrong * limit * want.sure,
            want.window,
            want.waits,
            want.unmet * waits * limit,
            want.barred,
            rules.bar * limit * want.sure,
        )
        shown = np.array(self.states(self._first, first), np.int64)
        recent = round(rules.jumps.recent * RATE)
        self._recent[shown] = LONG_AGO
        self._recent[shown[max(0, len(shown) - recent) :]] = 1.0
        numbers = np.array(
            [rules.again * limit, MISSING * limit, AHEAD * limit / RATE, LOOK, NOISE * limit], np.float32
        )
        random = np.uint64((self.seed * 0x9E3779B97F4A7C15 + self.found * 0xD1342543DE82EF95) & (2**64 - 1))
        way, _, self.spent, _ = extend_path(
            state,
            since,
            False,
            self._links,
            self._shown,
            prices,
            numbers,
            rules.jumps.frames,
            CHEAPEST // 4,
            rules.work,
            random,
            self._lines,
            NODES,
        )
        self._recent[shown] = 0.0
        self.found += 1
        del self._way[first - self._first :]
        self._way += way.tolist()

    def _forget(self) -> None:
        over = self.frame - round(SEEN * RATE) - self._first
        if over > 0:
            del self._way[:over]
            self._first += over
        self.speech.forget((self.frame / RATE) - BEHIND)


def replay_path(graph: DriverGraph, told: Sequence[Told], frames: int, seed: int = 1) -> Path:
    """Return the path that was extended so far when this was reported: the same, frame by frame. told: by
    frame; frames: how many were shown.
    """
    extender, place = PathExtender(graph, seed), 0
    out = np.empty(frames, np.int64)
    for frame in range(frames):
        after = place
        while after < len(told) and told[after][0] <= frame:
            after += 1
        extender.step(news for _, news in told[place:after])
        place = after
        out[frame] = extender.at(frame)
    jumps = np.flatnonzero(np.diff(out) != 1) + 1
    return Path(out, 0.0, jumps)
