"""The motion graph: costs as the equations say, the same edges as counting them one by one, and nobody gets
stuck.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from metagraph.synthesis.graph import (
    MotionGraph,
    Threshold,
    build_graph,
    find_largest_component,
    find_threshold,
)
from metagraph.synthesis.states import (
    States,
    SynthesisError,
    compute_costs_apart,
    key_states,
    list_pairs_apart,
    with_velocity,
)


def made(
    frames: int = 240, joints: int = 5, takes: int = 3, seed: int = 1, velocity: float | None = None
) -> States:
    """Smooth motion that comes back to where it was."""
    chance = np.random.default_rng(seed)
    t = np.arange(frames)[:, None, None] / 30
    places = sum(
        chance.normal(0, 0.2, (1, joints, 3)) * np.sin(t * w + chance.uniform(0, 6, (1, joints, 3)))
        for w in (0.7, 1.9, 3.1)
    )
    places = np.asarray(places, np.float32)
    starts = np.linspace(0, frames, takes + 1).astype(int)
    velocities = np.concatenate([np.gradient(places[a:b], 1 / 30, axis=0) for a, b in pairwise(starts)])
    return with_velocity(
        States(places, velocities.astype(np.float32), np.ones(joints, np.float32), starts, 0.0), velocity
    )


def cost(states: States, i: int, j: int) -> float:
    """Equations 3 and 4, word by word."""
    p = sum(
        states.weights[b] * np.linalg.norm(states.places[i, b].astype(float) - states.places[j - 1, b])
        for b in range(len(states.weights))
    )
    v = sum(
        states.weights[b]
        * np.linalg.norm(states.velocities[i, b].astype(float) - states.velocities[j - 1, b])
        for b in range(len(states.weights))
    )
    return float(p + states.velocity * v)


def of_limit(limit: float) -> Threshold:
    return Threshold(3, 0.95, np.zeros(0), None, limit, limit)


def edges(graph: MotionGraph) -> dict[tuple[int, int], float]:
    sources = np.repeat(np.arange(len(graph.starts) - 1), np.diff(graph.starts))
    return {(int(s), int(t)): float(c) for s, t, c in zip(sources, graph.targets, graph.costs, strict=True)}


def test_a_cost_is_the_sum_of_distances_of_places_and_velocities() -> None:
    places = np.array([[[0, 0, 0]], [[3, 4, 0]], [[3, 4, 12]], [[0, 0, 0]]], np.float32)
    velocities = np.array([[[0, 0, 0]], [[0, 0, 1]], [[0, 0, 3]], [[0, 0, 0]]], np.float32)
    states = States(places, velocities, np.array([2.0], np.float32), np.array([0, 4]), 0.5)
    # c_(i, i+2) sets frame i beside frame i + 1.
    assert compute_costs_apart(states, 2) == pytest.approx(
        [2 * 5 + 0.5 * 2 * 1, 2 * 12 + 0.5 * 2 * 2, 2 * 13 + 0.5 * 2 * 3]
    )
    # c_(i, i+1) is nothing.
    assert compute_costs_apart(states, 1) == pytest.approx([0, 0, 0, 0])


def test_pairs_stay_within_their_take() -> None:
    near, later = list_pairs_apart(made(30, takes=3), 4)
    assert len(near) == 3 * (10 - 4) and all(a // 10 == b // 10 for a, b in zip(near, later, strict=True))


@given(st.integers(1, 5), st.integers(20, 60), st.integers(1, 9), st.floats(0.05, 1.5), st.integers(0, 99))
@settings(max_examples=25, deadline=None)
def test_the_edges_are_those_that_counting_one_by_one_finds(
    takes: int, frames: int, joints: int, limit: float, seed: int
) -> None:
    states = made(max(frames, 3 * takes), joints, takes, seed)
    keys = key_states(states, 0.4)
    graph = build_graph(states, of_limit(limit), keys, connected=False)
    first = set(states.starts[:-1].tolist())
    wanted = {
        (int(i), int(j)): c
        for i in keys for j in keys
        if j not in first and j != i + 1 and (c := cost(states, i, j)) <= limit
    }  # fmt: skip
    found = edges(graph)
    border = {e for e in set(found) ^ set(wanted) if abs(cost(states, *e) - limit) > 1e-4}
    assert not border
    assert all(found[e] == pytest.approx(wanted[e], abs=1e-4) for e in set(found) & set(wanted))
    assert (np.diff(graph.starts) >= 0).all() and graph.starts[-1] == len(graph.targets)


def test_joints_without_weight_do_not_count() -> None:
    states = made(120, 6)
    light = replace(states, weights=np.array([1, 1, 1, 0, 0, 0], np.float32))
    few = replace(
        states, places=states.places[:, :3], velocities=states.velocities[:, :3], weights=states.weights[:3]
    )
    keys = key_states(states)
    assert edges(build_graph(light, of_limit(0.4), keys, connected=False)) == edges(
        build_graph(few, of_limit(0.4), keys, connected=False)
    )


def test_the_threshold_is_the_level_of_what_the_takes_show() -> None:
    states = made(3000, takes=2)
    found = find_threshold(states)
    assert len(found.costs) == 3000 - 2 * 2
    assert found.limit == pytest.approx(found.observed, rel=0.25)
    assert [find_threshold(states, k).limit for k in (2, 3, 4)] == sorted(
        find_threshold(states, k).limit for k in (2, 3, 4)
    )


def test_takes_that_do_not_move_have_no_distribution() -> None:
    still = States(
        np.zeros((20, 2, 3), np.float32),
        np.zeros((20, 2, 3), np.float32),
        np.ones(2, np.float32),
        np.array([0, 20]),
        1.0,
    )
    found = find_threshold(still)
    assert found.distribution is None and found.limit == 0


def test_takes_too_short_to_tell_a_jump_are_refused() -> None:
    short = States(
        np.zeros((4, 1, 3), np.float32),
        np.zeros((4, 1, 3), np.float32),
        np.ones(1, np.float32),
        np.array([0, 2, 4]),
        1.0,
    )
    with pytest.raises(SynthesisError, match="longer takes"):
        find_threshold(short)


def test_key_states_are_closer_where_more_moves_and_about_as_many_as_wanted() -> None:
    states = made(3000, takes=2)
    keys = key_states(states, 0.2225, changes=[777])
    assert abs(len(keys) / 3000 - 0.2225) < 0.01 and 777 in keys
    assert {0, 1499, 1500, 2999} <= set(keys.tolist())
    speed = np.linalg.norm(states.velocities, axis=-1).max(-1)
    assert speed[keys].mean() > speed.mean()
    assert len(key_states(states, 1.0)) == 3000


def reaches(graph: MotionGraph, start: int) -> set[int]:
    last, seen, queue = graph.states.last, {start}, [start]
    for state in queue:
        after = graph.targets[graph.starts[state] : graph.starts[state + 1]].tolist() + (
            [] if last[state] else [state + 1]
        )
        queue += [t for t in after if t not in seen]
        seen.update(after)
    return seen


@given(st.integers(0, 200), st.floats(0.1, 0.9))
@settings(max_examples=20, deadline=None)
def test_what_is_kept_is_the_largest_set_in_which_every_state_reaches_every_other(
    seed: int, limit: float
) -> None:
    states = made(60, 3, 3, seed)
    keys = key_states(states, 0.5)
    whole = build_graph(states, of_limit(limit), keys, connected=False)
    out = [reaches(whole, s) for s in range(60)]
    sets = {frozenset(t for t in out[s] if s in out[t]) for s in range(60)}
    largest = max(len(s) for s in sets)
    if largest < 2:
        with pytest.raises(SynthesisError, match="the level"):
            build_graph(states, of_limit(limit), keys)
        return
    kept = build_graph(states, of_limit(limit), keys)
    assert frozenset(np.flatnonzero(kept.kept).tolist()) in {s for s in sets if len(s) == largest}
    assert all(kept.kept[s] and kept.kept[t] for s, t in edges(kept))


@pytest.mark.parametrize("limit", [0.6, 2.0])  # of the first, less than half is kept
def test_what_is_cut_from_a_graph_leaves_the_graph_as_it_was_but_where_it_is_spent(limit: float) -> None:
    states = made(900, 4, 6)
    whole = build_graph(states, of_limit(limit), key_states(states, 0.3), connected=False)
    before = edges(whole)
    kept = find_largest_component(whole)
    assert edges(whole) == before and len(kept.targets) < len(whole.targets)
    wanted = {(s, t): c for (s, t), c in before.items() if kept.kept[s] and kept.kept[t]}
    assert edges(kept) == wanted == edges(find_largest_component(whole, spent=True))


def test_only_the_cheapest_of_each_state_are_kept_when_memory_is_short() -> None:
    states = made(200)
    keys = key_states(states, 0.5)
    whole = edges(build_graph(states, of_limit(0.8), keys, connected=False))
    few = edges(build_graph(states, of_limit(0.8), keys, most=4, connected=False))
    for state in {s for s, _ in whole}:
        mine = sorted(c for (s, _), c in whole.items() if s == state)[:4]
        assert sorted(c for (s, _), c in few.items() if s == state) == pytest.approx(mine)


def test_it_can_be_cancelled_and_tells_how_far_it_is() -> None:
    states = made(200)
    seen: list[tuple[int, int]] = []
    build_graph(states, of_limit(0.8), progress=lambda n, total: seen.append((n, total)))
    assert seen[-1][0] == seen[-1][1]
    with pytest.raises(SynthesisError, match="cancelled"):
        build_graph(states, of_limit(0.8), cancelled=lambda: True)


def test_components_are_those_an_independent_library_finds() -> None:
    pytest.importorskip("scipy")
    from scipy.sparse import csr_matrix
    from scipy.sparse.csgraph import connected_components

    states = made(900, 4, 6)
    keys = key_states(states, 0.3)
    whole = build_graph(states, of_limit(0.5), keys, connected=False)
    sources = np.repeat(np.arange(900), np.diff(whole.starts))
    follows = np.flatnonzero(~states.last)
    rows, columns = np.concatenate([sources, follows]), np.concatenate([whole.targets, follows + 1])
    _, labels = connected_components(
        csr_matrix((np.ones(len(rows)), (rows, columns)), shape=(900, 900)), True, "strong"
    )
    largest = np.bincount(labels).argmax()
    assert (build_graph(states, of_limit(0.5), keys).kept == (labels == largest)).all()
