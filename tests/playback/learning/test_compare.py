"""What was seen beside what is generated: the same within what chance allows, and found out where it is
not.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from metagraph.graph.model import LAYERS, Layer, Markov
from metagraph.playback.learning.compare import (
    SURE,
    compare_model,
    compute_quantiles,
    compute_share_deviation,
    compute_stationary_shares,
    count_act_sequences,
    generate,
)
from metagraph.playback.learning.learn import Act, learn_model, list_model_states
from metagraph.playback.planning.markov import DEFAULTS, write

HOUR = 3600.0
GESTURE, FIDGET = ("both", "gesture", ""), ("both", "fidget", "")


def act(start: float, end: float, kind: str = "gesture", *tags: str) -> Act:
    return Act(start, end, "both", kind, tags)  # type: ignore[arg-type]


# --- counting


def test_nothing_is_counted_as_nothing() -> None:
    found = count_act_sequences([], [GESTURE], False)
    assert (found.count, found.rate, found.seconds) == (0, 0.0, 0)
    assert found.shares().tolist() == [0.0]
    assert np.isnan(compute_quantiles(found.lengths[0])).all()
    assert count_act_sequences([[]], [], False).count == 0


def test_acts_moves_lengths_and_rests_are_counted() -> None:
    found = count_act_sequences(
        [
            [act(0, 1), act(2, 5), act(5, 6, "fidget")],
            [act(0, 2, "fidget"), act(1, 3, "transition"), act(4, 5)],
        ],
        [GESTURE, FIDGET],
        False,
    )
    assert found.visits.tolist() == [3, 2]
    assert found.moves.tolist() == [[1, 1], [0, 0]], (
        "what comes by way of a state that is not asked for does not count"
    )
    assert [x.tolist() for x in found.lengths] == [[1, 1, 3], [1, 2]]
    assert found.rests.tolist() == [0, 0, 1, 1]
    assert found.seconds == 11
    assert found.rate == pytest.approx(5 / 11 * 60)


def test_meaning_counts_where_it_is_part_of_the_states() -> None:
    acts = [[act(0, 1, "gesture", "positive"), act(1, 2)]]
    assert count_act_sequences(acts, [GESTURE, ("both", "gesture", "positive")], True).visits.tolist() == [
        1,
        1,
    ]
    assert count_act_sequences(acts, [GESTURE], False).visits.tolist() == [2]


# --- the long run


@given(st.lists(st.lists(st.floats(0, 1), min_size=4, max_size=4), min_size=4, max_size=4))
def test_the_long_run_is_left_as_it_is_by_another_step(rows: list[list[float]]) -> None:
    matrix = np.array(rows) + 1e-3
    matrix /= matrix.sum(axis=1, keepdims=True)
    pi = compute_stationary_shares(matrix.tolist())
    assert pi.sum() == pytest.approx(1) and pi.min() >= 0
    assert np.allclose(pi @ matrix, pi, atol=1e-9)


def test_chains_that_go_in_circles_or_stay_for_ever_have_a_long_run_too() -> None:
    assert np.allclose(compute_stationary_shares([[0, 1], [1, 0]]), [0.5, 0.5])
    assert np.allclose(compute_stationary_shares([[1, 0], [0, 1]]), [0.5, 0.5])
    assert np.allclose(compute_stationary_shares([[1, 0], [0.5, 0.5]]), [1, 0])
    assert np.allclose(compute_stationary_shares([[0, 0], [1, 0]]), [2 / 3, 1 / 3]), (
        "a row of zeros is drawn from all alike"
    )
    assert np.isfinite(compute_share_deviation([[1, 0], [0, 1]], np.array([0.5, 0.5]), 10)).all()


def test_a_chain_without_memory_is_off_as_a_coin_is() -> None:
    pi = np.array([0.2, 0.3, 0.5])
    assert np.allclose(compute_share_deviation([pi.tolist()] * 3, pi, 400), np.sqrt(pi * (1 - pi) / 400))


def test_a_chain_that_lingers_is_further_off_and_one_that_alternates_never() -> None:
    half = np.array([0.5, 0.5])
    coin = compute_share_deviation([[0.5, 0.5]] * 2, half, 100)
    assert (compute_share_deviation([[0.9, 0.1], [0.1, 0.9]], half, 100) > 2 * coin).all()
    assert np.allclose(compute_share_deviation([[0, 1], [1, 0]], half, 100), 0)


@pytest.mark.nightly
def test_the_deviation_is_that_of_many_performances() -> None:
    off = np.array([compare_model(DEFAULTS["arms"], None, HOUR, seed).surprises() for seed in range(60)])
    assert np.abs(off.mean(axis=0)).max() < 0.7  # 60 draws of mean 0: more than 5 deviations off
    assert (off.std(axis=0) > 0.7).all() and (off.std(axis=0) < 1.4).all()


# --- the model and what it generates


@pytest.mark.parametrize("layer", LAYERS)
def test_an_hour_of_a_model_agrees_with_its_matrix_within_sampling_error(layer: Layer) -> None:
    found = compare_model(DEFAULTS[layer], None, HOUR, seed=5)
    assert found.observed is None
    assert found.generated.count > 300
    assert np.abs(found.surprises()).max() < 4
    assert np.abs(found.move_surprises()).max() < 4.5
    assert not found.generated.moves[np.array(DEFAULTS[layer].matrix) == 0].any()


def test_an_hour_learned_anew_is_the_model_it_came_from() -> None:
    model = replace(DEFAULTS["head"], lengths=((1.2, 0.4), (2.0, 1.0), (0.9, 0.2)))
    acts = generate(model, 10 * HOUR, seed=3)
    again = learn_model("head", [acts])
    assert again.states == model.states
    assert np.allclose(again.matrix, model.matrix, atol=0.03)
    assert np.allclose(again.lengths, model.lengths, rtol=0.1)
    assert again.gap == pytest.approx(model.gap, rel=0.03)
    assert again.positive == pytest.approx(model.positive, abs=0.02) and again.negative == pytest.approx(
        model.negative, abs=0.02
    )
    found = compare_model(again, [acts], HOUR)
    assert found.observed is not None
    assert np.abs(found.generated.shares() - found.observed.shares()).max() < 4 * found.deviation.max()
    for seen, made in zip(found.observed.lengths, found.generated.lengths, strict=True):
        assert np.allclose(compute_quantiles(seen), compute_quantiles(made), rtol=0.25)


def test_what_another_model_made_is_found_out() -> None:
    model = DEFAULTS["head"]
    other = replace(model, matrix=((0.2, 0.4, 0.4),) * 3)
    found = compare_model(model, None, HOUR)
    swapped = replace(
        found, generated=count_act_sequences([generate(other, HOUR)], list_model_states(model), False)
    )
    assert np.abs(swapped.surprises()).max() > 2 * SURE
    assert np.abs(swapped.move_surprises()).max() > 2 * SURE


def test_a_move_that_cannot_be_is_as_surprising_as_can_be() -> None:
    model = Markov("head", (("both", "gesture"), ("both", "fidget")), ((0.0, 1.0), (1.0, 0.0)))
    found = compare_model(model, None, 60)
    assert not found.move_surprises().any() and not found.surprises().any()
    wrong = replace(
        found,
        generated=count_act_sequences(
            [[act(0, 1), act(2, 3), act(4, 5, "fidget")]], list_model_states(model), False
        ),
    )
    assert np.isinf(wrong.move_surprises()[0, 0])


def test_generating_is_writing() -> None:
    model = DEFAULTS["arms"]
    assert [(a.start, a.limb, a.kind) for a in generate(model, 60, 4)] == [
        (m.start, m.request.limb, m.request.kind) for m in write(model, 4, 60)[0]
    ]
    assert {a.kind for a in generate(model, 200, 4, ("fidget",))} == {"fidget"}
