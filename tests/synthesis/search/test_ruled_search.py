"""Paths that jump only where it is worth it: away from where they would go on, not too often, at a price."""

from __future__ import annotations

import gc
import weakref
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from metagraph.graph.conversation.model import Segment
from metagraph.synthesis.constraints import ALL, HeardStates, find_heard_at, list_wanted
from metagraph.synthesis.graph import MotionGraph
from metagraph.synthesis.search.path_quality import measure_quality
from metagraph.synthesis.search.ruled_search import FREE, JUMP_RULES, JumpRules, apply_rules, find_path
from metagraph.synthesis.states import SynthesisError
from tests.synthesis.test_search import graph_of


def anything(graph: MotionGraph) -> HeardStates:
    count = len(graph.states)
    return HeardStates(np.full(count, ALL, np.uint8), np.zeros(count, bool))


def moving(frames: int, takes: list[int], links: dict[tuple[int, int], float]) -> MotionGraph:
    """A graph of takes in which every frame but the last ten of each is 3 cm from the one before."""
    graph = graph_of(frames, takes, links)
    places = np.zeros((frames, 1, 3), np.float32)
    places[:, 0, 0] = 0.03 * np.arange(frames)
    return replace(graph, states=replace(graph.states, places=places))


def test_a_path_does_not_stand_still_where_a_frame_resembles_itself() -> None:
    links = {(n, n): 0.001 for n in range(200)} | {(n, (n + 90) % 200): 0.2 for n in range(0, 200, 5)}
    graph = moving(200, [0, 200], links)
    asked = list_wanted([], 12.0, use=())
    frozen = find_path(graph, anything(graph), asked, rules=FREE)
    looks = measure_quality(graph.states, frozen)
    assert looks.stands_still and looks.frozen > 3 and looks.repeated > 0.3
    path = find_path(graph, anything(graph), asked)
    looks = measure_quality(graph.states, path)
    assert not looks.stands_still and looks.repeated == 0.0 and looks.jumps < 0.5


@given(st.data())
@settings(max_examples=40, deadline=None)
def test_what_rules_leave_is_what_they_say(data: st.DataObject) -> None:
    frames = data.draw(st.integers(4, 160))
    split = data.draw(st.integers(1, frames - 1))
    state = st.integers(0, frames - 1)
    pairs = st.tuples(state, state).filter(lambda e: e[1] != e[0] + 1)
    links = data.draw(st.dictionaries(pairs, st.floats(0.125, 2, width=32), max_size=60))
    graph = graph_of(frames, [0, split, frames], links)
    rules = JumpRules(
        run=0.3,
        apart=data.draw(st.sampled_from([0.0, 0.5, 1.0])),
        price=data.draw(st.sampled_from([0.0, 0.3])),
        recent=data.draw(st.sampled_from([0.0, 3.0])),
        again=0.8,
    )
    out = apply_rules(graph, rules)
    left = {}
    for source in range(frames):
        for place in range(out.starts[source], out.starts[source + 1]):
            left[source, int(out.targets[place])] = float(out.costs[place])
    for (source, target), cost in links.items():
        same, away = (source < split) == (target < split), target - source - 1
        if same and abs(away) < 30 * rules.apart:
            assert (source, target) not in left
            continue
        price = cost + rules.price
        if same and away < 0 and rules.recent:
            price += rules.again * max(0.0, 1 + away / 90)
        assert left.pop((source, target)) == pytest.approx(price, abs=1e-5)
    assert not left


def test_transitions_are_as_far_apart_as_rules_say_and_cost_what_they_look_like() -> None:
    chance = np.random.default_rng(3)
    links = {(int(a), int(b)): 0.1 for a, b in chance.integers(0, 300, (4000, 2)) if b != a + 1}
    graph = moving(300, [0, 100, 200, 300], links)
    for search in ("exact", "greedy"):
        path = find_path(graph, anything(graph), list_wanted([], 20.0, use=()), search)  # type: ignore[arg-type]
        assert len(path.jumps) >= 4 and (np.diff(path.jumps) >= JUMP_RULES.frames).all()
        assert path.cost == pytest.approx(0.1 * len(path.jumps), abs=1e-5)
        assert path.price >= path.cost + JUMP_RULES.price * len(path.jumps) - 1e-4


def test_where_rules_leave_no_way_the_remedy_is_named() -> None:
    graph = moving(40, [0, 40], {(n, n - 8): 0.1 for n in range(8, 40)})
    with pytest.raises(SynthesisError, match="or let it jump as often as it likes"):
        find_path(graph, anything(graph), list_wanted([], 10.0, use=()))
    assert len(find_path(graph, anything(graph), list_wanted([], 10.0, use=()), rules=FREE).states) == 300


def test_two_clauses_do_not_pass_as_one() -> None:
    graph = graph_of(120, [0, 120], {})
    two = [Segment("clause", 1.0, 2.0, 1.5), Segment("clause", 2.0, 3.0, 2.5)]
    one = [Segment("clause", 1.0, 3.0, 1.5)]
    spoken, asked_one = find_heard_at(graph.states, [two]), list_wanted(one, 3.5)
    with pytest.raises(SynthesisError):
        find_path(graph, spoken, asked_one)
    loose = find_path(graph, spoken, list_wanted(one, 3.5, edges=False))
    assert not len(loose.jumps)
    assert not len(find_path(graph, spoken, list_wanted(two, 3.5)).jumps)
    with pytest.raises(SynthesisError):  # nor one as two
        find_path(graph, find_heard_at(graph.states, [one]), list_wanted(two, 3.5))


def test_a_clause_does_not_begin_with_the_middle_of_another() -> None:
    graph = graph_of(200, [0, 100, 200], {(20, 130): 0.1})
    long = [[], [Segment("clause", 0.5, 3.0, 1.6)]]  # frames 115 to 190: 130 lies within
    asked = list_wanted([Segment("clause", 0.7, 2.7, 1.3)], 2.9)
    spoken = find_heard_at(graph.states, long)
    with pytest.raises(SynthesisError):
        find_path(graph, spoken, asked, rules=FREE)
    loose = list_wanted([Segment("clause", 0.7, 2.7, 1.3)], 2.5, edges=False)
    assert find_path(graph, spoken, loose, rules=FREE).jumps.tolist() == [21]


@pytest.mark.nightly
@pytest.mark.parametrize("rules", [FREE, JUMP_RULES])
def test_a_graph_that_was_searched_is_let_go(rules: JumpRules) -> None:
    graph = moving(200, [0, 200], {(n, (n + 90) % 200): 0.2 for n in range(0, 200, 5)})
    find_path(graph, anything(graph), list_wanted([], 2.0, use=()), rules=rules)
    gone = weakref.ref(graph)
    del graph
    gc.collect()
    assert gone() is None
