"""Paths that go with speech: the exact search finds the cheapest of all, whenever there is one; the greedy
never finds a cheaper.
"""

from __future__ import annotations

import threading
from contextlib import closing, suppress
from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from metagraph.graph.conversation.model import SOUNDS, Segment
from metagraph.synthesis.constraints import (
    ALL,
    EDGE,
    STRESS,
    HeardStates,
    WantedSegment,
    find_change_states,
    find_heard_at,
    list_wanted,
)
from metagraph.synthesis.graph import MotionGraph, Threshold
from metagraph.synthesis.search.exact_search import ExactSearch, find_best_path
from metagraph.synthesis.search.frame_costs import FrameCost, FrameCosts, join_costs
from metagraph.synthesis.search.greedy_search import search_greedily
from metagraph.synthesis.search.path import Path
from metagraph.synthesis.states import States, SynthesisError

IDLE, CLAUSE, RESPONSE = (1 << SOUNDS.index(k) for k in ("idle", "clause", "response"))


def graph_of(frames: int, takes: list[int], links: dict[tuple[int, int], float]) -> MotionGraph:
    states = States(
        np.zeros((frames, 1, 3), np.float32),
        np.zeros((frames, 1, 3), np.float32),
        np.ones(1, np.float32),
        np.array(takes),
        1.0,
    )
    sources = sorted(links)
    starts = np.concatenate([[0], np.cumsum(np.bincount([s for s, _ in sources], minlength=frames))])
    targets = np.array([t for _, t in sources], np.int32)
    costs = np.array([links[e] for e in sources], np.float32)
    limit = Threshold(3, 0.95, np.zeros(0), None, 1.0, 1.0)
    return MotionGraph(states, limit, np.arange(frames), starts, targets, costs, np.ones(frames, bool))


def cheapest(
    graph: MotionGraph,
    sound: HeardStates,
    want: WantedSegment,
    run: int = 1,
    charged: FrameCosts | None = None,
) -> float | None:
    """What the cheapest path costs, with what its frames cost, by trying all."""
    last = graph.states.last

    def paid(t: int, state: int) -> float:
        row = charged.row(t) if charged is not None else None
        return 0.0 if row is None else float(row[state])

    @cache
    def onward(t: int, state: int, met: bool, since: int) -> float:
        return paid(t, state) + after(t, state, met, since)

    def after(t: int, state: int, met: bool, since: int) -> float:
        if not graph.kept[state] or not sound.kinds[state] & want.allowed[t]:
            return np.inf
        if want.bars(t) and sound.happens(want.bars(t))[state]:
            return np.inf
        if t in want.only and not want.only[t][state]:
            return np.inf
        met = (met or bool(sound.happens(want.event(t))[state])) if want.window[t] >= 0 else False
        ends = want.window[t] >= 0 and (t + 1 == len(want) or want.window[t + 1] != want.window[t])
        if ends and not met:
            return np.inf
        if t + 1 == len(want):
            return 0.0
        met = met and not ends
        ways = [] if last[state] else [onward(t + 1, state + 1, met, min(run, since + 1))]
        for place in range(graph.starts[state], graph.starts[state + 1]) if since >= run else ():
            ways.append(float(graph.costs[place]) + onward(t + 1, int(graph.targets[place]), met, 1))
        return min(ways, default=np.inf)

    found = min(onward(0, s, False, run) for s in range(len(graph.states)))
    return None if found == np.inf else found


def check(
    graph: MotionGraph,
    sound: HeardStates,
    want: WantedSegment,
    path: Path,
    run: int = 1,
    charged: FrameCosts | None = None,
) -> None:
    """A path is one, has what is wanted, and costs what it says."""
    total = sum(charged.paid(path.states).values()) if charged is not None else 0.0
    assert len(path.states) == len(want)
    for t, state in enumerate(path.states):
        assert sound.kinds[state] & want.allowed[t]
        assert not sound.happens(want.bars(t))[state]
        assert t not in want.only or want.only[t][state]
        if t and state != path.states[t - 1] + 1:
            before = int(path.states[t - 1])
            places = range(graph.starts[before], graph.starts[before + 1])
            total += next(float(graph.costs[p]) for p in places if graph.targets[p] == state)
            assert t in path.jumps
    assert (np.diff(path.jumps) >= run).all()
    for number in set(want.window[want.window >= 0].tolist()):
        inside = want.window == number
        assert sound.happens(want.event(int(np.flatnonzero(inside)[0])))[path.states[inside]].any()
    assert path.cost == pytest.approx(total, abs=1e-4)


@st.composite
def costs_of_frames(draw: st.DrawFn, name: str, frames: int, length: int) -> FrameCost:
    """What frames cost, at some moments."""
    count = draw(st.integers(1, 3))
    price = st.floats(0, 2, width=32)
    rows = draw(st.lists(st.lists(price, min_size=frames, max_size=frames), min_size=count, max_size=count))
    at = draw(st.lists(st.integers(-1, count - 1), min_size=length, max_size=length))
    return FrameCost(name, np.array(at, np.int32), np.array(rows, np.float32))


@pytest.mark.nightly
@given(st.data())
@settings(max_examples=60, deadline=None)
def test_the_best_path_is_the_cheapest_of_all_and_is_found_whenever_there_is_one(data: st.DataObject) -> None:
    frames = data.draw(st.integers(4, 14))
    split = data.draw(st.integers(1, frames - 1))
    pairs = st.tuples(st.integers(0, frames - 1), st.integers(0, frames - 1)).filter(
        lambda e: e[1] != e[0] + 1
    )
    links = data.draw(st.dictionaries(pairs, st.floats(0.125, 2, width=32), max_size=20))
    graph = graph_of(frames, [0, split, frames], links)
    sound = HeardStates(
        np.array(
            data.draw(st.lists(st.sampled_from([IDLE, CLAUSE, RESPONSE]), min_size=frames, max_size=frames)),
            np.uint8,
        ),
        np.array(data.draw(st.lists(st.booleans(), min_size=frames, max_size=frames))),
        np.array(data.draw(st.lists(st.booleans(), min_size=frames, max_size=frames))),
    )
    length = data.draw(st.integers(1, 10))
    allowed = data.draw(
        st.lists(st.sampled_from([IDLE, IDLE | CLAUSE, CLAUSE, ALL]), min_size=length, max_size=length)
    )
    window, events = np.full(length, -1, np.int32), np.full(length, STRESS, np.uint8)
    for number in range(data.draw(st.integers(0, 2))):
        a = data.draw(st.integers(0, length - 1))
        b = a + data.draw(st.integers(1, 4))
        window[a:b], events[a:b] = number, data.draw(st.sampled_from([STRESS, EDGE]))
    if (np.diff(window) < 0).any() and len(set(window.tolist())) == 3:
        window[: int(np.argmin(window))] = -1  # the second is not to lie inside of the first
    bits = st.sampled_from([0, 0, 0, STRESS, EDGE, STRESS | EDGE])
    barred = data.draw(st.lists(bits, min_size=length, max_size=length))
    some = st.lists(st.booleans(), min_size=frames, max_size=frames).map(np.array)
    only = data.draw(st.dictionaries(st.integers(0, length - 1), some, max_size=2))
    want = WantedSegment(np.array(allowed, np.uint8), window, events, np.array(barred, np.uint8), only)
    run = data.draw(st.integers(1, 5))
    kinds = data.draw(st.sampled_from(["", "a", "ab"]))
    charged = join_costs([data.draw(costs_of_frames(kind, frames, length)) for kind in kinds])
    wanted_cost = cheapest(graph, sound, want, run, charged)
    if wanted_cost is None:
        with pytest.raises(SynthesisError, match="no motion"):
            find_best_path(graph, sound, want, run=run, charged=charged)
        return
    path = find_best_path(graph, sound, want, run=run, charged=charged)
    check(graph, sound, want, path, run, charged)
    assert path.cost == pytest.approx(wanted_cost, abs=1e-4)
    try:
        other = search_greedily(
            graph, sound, want, seed=data.draw(st.integers(0, 9)), run=run, charged=charged
        )
    except SynthesisError:
        return
    check(graph, sound, want, other, run, charged)
    assert other.cost >= path.cost - 1e-4


def test_starts_ends_and_stresses_may_be_a_tenth_of_a_second_off() -> None:
    want = list_wanted([Segment("clause", 1.0, 2.0, 1.5)], 3.0)
    assert len(want) == 90
    either = np.flatnonzero(want.allowed == (IDLE | CLAUSE))
    assert either.tolist() == [*range(27, 33), *range(57, 63)]
    stress = (want.window >= 0) & (want.events == STRESS)
    assert np.flatnonzero(stress).tolist() == list(range(42, 49))
    edges = (want.window >= 0) & (want.events == EDGE)
    assert np.flatnonzero(edges).tolist() == [*range(27, 34), *range(57, 64)]
    assert ((want.barred & STRESS == 0) == stress).all()
    assert ((want.barred & EDGE == 0) == edges).all()
    loose = list_wanted([Segment("clause", 1.0, 2.0, 1.5)], 3.0, edges=False)
    assert np.flatnonzero(loose.window >= 0).tolist() == list(range(42, 49)) and not loose.barred.any()
    exact = list_wanted([Segment("clause", 1.0, 2.0, 1.5)], 3.0, tolerance=0)
    assert (exact.allowed == CLAUSE).sum() == 30 and (exact.window >= 0).sum() == 3


def test_a_kind_that_is_left_out_lets_anything_go() -> None:
    segments = [Segment("clause", 0.5, 1.0, 0.7), Segment("response", 1.5, 2.0)]
    want = list_wanted(segments, 2.5, use=("idle", "clause"))
    assert (want.allowed[45:60] == ALL).all() and (want.window >= 0).any()
    other = list_wanted(segments, 2.5, use=("idle", "response"))
    assert set(np.flatnonzero(other.window >= 0).tolist()) == {*range(42, 49), *range(57, 64)}
    assert (other.events[other.window >= 0] == EDGE).all()
    free = list_wanted(segments, 2.5, use=())
    assert (free.allowed == ALL).all() and not free.barred.any() and (free.window < 0).all()


def test_what_was_heard_is_told_take_by_take() -> None:
    states = graph_of(60, [0, 30, 60], {}).states
    sound = find_heard_at(states, [[Segment("clause", 0.2, 0.5, 0.3)], [Segment("response", 0.9, 5.0)]])
    assert np.flatnonzero(sound.kinds == CLAUSE).tolist() == list(range(6, 15)) and np.flatnonzero(
        sound.peaks
    ).tolist() == [9]
    assert np.flatnonzero(sound.kinds == RESPONSE).tolist() == list(range(57, 60))
    assert find_change_states(states, [[Segment("clause", 0.2, 0.5, 0.3)], []]) == [6, 9, 15]
    with pytest.raises(SynthesisError, match="2 takes have states, but 1"):
        find_heard_at(states, [[]])
    with pytest.raises(SynthesisError, match="end after it starts"):
        find_heard_at(states, [[Segment("clause", 1.0, 1.0)], []])


def test_a_search_that_would_not_fit_in_memory_is_refused() -> None:
    graph = graph_of(40, [0, 40], {})
    want = WantedSegment(np.full(20_000_000, ALL, np.uint8), np.full(20_000_000, -1, np.int32))
    with pytest.raises(SynthesisError, match="greedy"):
        find_best_path(graph, HeardStates(np.full(40, ALL, np.uint8), np.zeros(40, bool)), want)


def test_the_best_path_is_the_same_whatever_bound_it_is_searched_within() -> None:
    found = 0
    for seed in range(12):
        chance = np.random.default_rng(seed)
        pairs = {(int(a), int(b)) for a, b in chance.integers(0, 60, (300, 2)) if b != a + 1}
        graph = graph_of(60, [0, 25, 60], {e: float(chance.uniform(0.1, 2)) for e in pairs})
        sound = HeardStates(chance.choice([IDLE, CLAUSE], 60).astype(np.uint8), chance.random(60) < 0.3)
        want = WantedSegment(
            chance.choice([IDLE, CLAUSE, ALL], 25).astype(np.uint8), np.full(25, -1, np.int32)
        )
        try:
            path = find_best_path(graph, sound, want)
        except SynthesisError:
            continue
        found += 1
        with closing(ExactSearch(graph, sound, want)) as search:
            for bound in (float("inf"), path.cost + 1e-5, 10 * path.cost + 1.0):
                assert search.within(bound).cost == pytest.approx(path.cost, abs=1e-5)
            assert path.cost > 0
            with pytest.raises(SynthesisError):
                search.within(path.cost * 0.99)
    assert found >= 4


@pytest.mark.parametrize("charged", [False, True])
def test_the_best_path_is_the_same_wherever_the_first_guess_leaves_somebody_out(
    monkeypatch: pytest.MonkeyPatch, charged: bool
) -> None:
    module = "metagraph.synthesis.search.exact_search"
    found = went_on = 0
    for seed in range(8):
        chance = np.random.default_rng(100 + seed)
        pairs = {(int(a), int(b)) for a, b in chance.integers(0, 300, (6000, 2)) if b != a + 1}
        graph = graph_of(300, [0, 150, 300], {e: float(chance.integers(1, 20)) / 8 for e in pairs})
        sound = HeardStates(chance.choice([IDLE, CLAUSE], 300).astype(np.uint8), chance.random(300) < 0.3)
        want = WantedSegment(
            chance.choice([IDLE, CLAUSE, ALL], 25).astype(np.uint8), np.repeat([-1, 0, -1, 1, -1], 5)
        )
        rows = chance.integers(0, 4, (3, 300)).astype(np.float32) / 16
        costs = join_costs([FrameCost("a", np.arange(25, dtype=np.int32) // 9, rows)]) if charged else None
        paths = []
        for narrow, drawn, ordered in ((10**9, 8, 1), (2, 8, 16), (40, 0, 3), (90, 10**9, 10**9)):
            monkeypatch.setattr(f"{module}.NARROW", narrow)
            monkeypatch.setattr(f"{module}_sweep.DRAWN", drawn)
            monkeypatch.setattr(f"{module}_sweep.SORTED", ordered)
            run = 1 + seed % 3
            with closing(ExactSearch(graph, sound, want, run, costs)) as search:
                search.guessed()
                went_on += search._exact is not None
                with suppress(SynthesisError):
                    paths += [search.within(bound) for bound in (20.0, 40.0)]
            with suppress(SynthesisError):
                paths.append(find_best_path(graph, sound, want, run=run, charged=costs))
        found += len(paths) == 12
        assert len(paths) in (0, 12)
        for path in paths:
            check(graph, sound, want, path, 1 + seed % 3, costs)
            assert path.cost == paths[0].cost
            assert charged or path.states.tolist() == paths[0].states.tolist()
    assert found >= 4 and went_on > 10


def test_a_search_that_is_given_up_after_its_first_guess_ends_its_threads() -> None:
    graph = graph_of(60, [0, 60], {(n, (7 * n) % 60): 0.5 for n in range(1, 60)})
    sound = HeardStates(np.full(60, CLAUSE, np.uint8), np.zeros(60, bool))
    want = WantedSegment(np.full(2000, CLAUSE, np.uint8), np.full(2000, -1, np.int32))
    before = threading.active_count()
    with closing(ExactSearch(graph, sound, want)) as search:
        assert np.isfinite(search.guessed())
    assert threading.active_count() == before


@pytest.mark.parametrize("charged", [False, True])
def test_the_best_path_is_the_same_from_whichever_side_jumps_are_looked_for_and_wherever_the_halves_meet(
    monkeypatch: pytest.MonkeyPatch, charged: bool
) -> None:
    module = "metagraph.synthesis.search.exact_search"
    found = 0
    for seed in range(6):
        chance = np.random.default_rng(seed)
        pairs = {(int(a), int(b)) for a, b in chance.integers(0, 400, (8000, 2)) if b != a + 1}
        graph = graph_of(400, [0, 150, 400], {e: float(chance.integers(1, 20)) / 8 for e in pairs})
        sound = HeardStates(chance.choice([IDLE, CLAUSE], 400).astype(np.uint8), chance.random(400) < 0.3)
        want = WantedSegment(
            chance.choice([IDLE, CLAUSE, ALL], 25).astype(np.uint8), np.repeat([-1, 0, -1, 1, -1], 5)
        )
        rows = chance.integers(0, 4, (3, 400)).astype(np.float32) / 16
        costs = join_costs([FrameCost("a", np.arange(25, dtype=np.int32) // 9, rows)]) if charged else None
        paths = []
        for drawn, half in ((0, 0.45), (10**9, 0.45), (0, 0.0), (10**9, 0.9), (8, 1.5)):
            monkeypatch.setattr(f"{module}_sweep.DRAWN", drawn)
            monkeypatch.setattr(f"{module}.HALF", half)
            try:
                paths.append(find_best_path(graph, sound, want, run=1 + seed % 3, charged=costs))
            except SynthesisError:
                assert not paths
                break
        found += len(paths) > 0
        for path in paths:
            check(graph, sound, want, path, 1 + seed % 3, costs)
            assert path.cost == paths[0].cost
            assert charged or path.states.tolist() == paths[0].states.tolist()
    assert found >= 3


def test_a_second_search_goes_by_the_transitions_of_the_first_where_the_same_was_heard() -> None:
    chance = np.random.default_rng(3)
    pairs = {(int(a), int(b)) for a, b in chance.integers(0, 90, (900, 2)) if b != a + 1}
    graph = graph_of(90, [0, 40, 90], {e: float(chance.uniform(0.1, 2)) for e in pairs})
    want = WantedSegment(np.full(30, CLAUSE, np.uint8), np.full(30, -1, np.int32))
    sounds = [
        HeardStates(chance.choice([IDLE, CLAUSE], 90, p=[0.2, 0.8]).astype(np.uint8), np.zeros(90, bool))
        for _ in range(2)
    ]
    for sound in (sounds[0], sounds[0], sounds[1], sounds[0]):
        fresh = graph_of(90, [0, 40, 90], dict(_links(graph)))
        path = find_best_path(graph, sound, want)
        check(graph, sound, want, path)
        assert path.states.tolist() == find_best_path(fresh, sound, want).states.tolist()


def _links(graph: MotionGraph) -> list[tuple[tuple[int, int], float]]:
    sources = np.repeat(np.arange(len(graph.states)), np.diff(graph.starts)).tolist()
    return [
        ((s, t), c) for s, t, c in zip(sources, graph.targets.tolist(), graph.costs.tolist(), strict=True)
    ]


@pytest.mark.parametrize("exact", [True, False])
def test_a_search_that_is_cancelled_ends_soon_and_says_so(exact: bool) -> None:
    graph = graph_of(40, [0, 40], {(n, 0): 0.5 for n in range(1, 40)})
    sound = HeardStates(np.full(40, IDLE, np.uint8), np.zeros(40, bool))
    want = list_wanted([], 600.0)
    asked = 0

    def cancelled() -> bool:
        nonlocal asked
        asked += 1
        return asked > 5

    with pytest.raises(SynthesisError, match="the search was cancelled"):
        find_best_path(graph, sound, want, cancelled) if exact else search_greedily(
            graph, sound, want, cancelled=cancelled
        )
    assert asked < 20
