"""The flow: there and back, its determinant, its density."""

from __future__ import annotations

import numpy as np
import pytest

from metagraph.generation.flow import FlowDrawing, FlowWeights, build_flow_matrix
from metagraph.generation.initial import make_initial_weights
from metagraph.generation.networks import Control, FlowSizes, make_sizes
from tests.generation.makers import shaken

SIZES = FlowSizes(pose=8, control=Control(width=4), code="none", dims=8, steps=3, units=10, layers=2)


def _given(frames: int, sizes: FlowSizes, seed: int = 3, batch: tuple[int, ...] = ()):
    chance = np.random.default_rng(seed)
    codes = chance.standard_normal((*batch, frames, sizes.dims))
    return codes, chance.standard_normal((*batch, frames, sizes.control.context(sizes.pose)))


@pytest.mark.parametrize(
    ("dtype", "by", "within"), [(np.float32, 0.0, 1e-5), (np.float32, 0.3, 1e-4), (np.float64, 0.3, 1e-12)]
)
@pytest.mark.parametrize("dims", [7, 8, 24])
def test_codes_come_back_from_their_noise(dtype, by, within, dims):
    sizes = FlowSizes(pose=8, dims=dims, steps=6, units=32)
    flow = FlowWeights(shaken(sizes, by, dtype=dtype) if by else make_initial_weights(sizes), sizes, dtype)
    codes, context = _given(50, sizes)
    noise, _, _ = flow.forward(codes, context)
    back, _ = flow.inverse(noise, context)
    assert noise.dtype == back.dtype == dtype
    assert np.abs(noise - codes).max() > 0.1
    assert np.abs(back - codes).max() < within


def test_of_the_papers_size_codes_come_back():
    sizes = make_sizes("flow-vae", "paper", 54)
    assert isinstance(sizes, FlowSizes)
    flow = FlowWeights(make_initial_weights(sizes), sizes)
    codes, context = _given(4, sizes)
    back, _ = flow.inverse(flow.forward(codes, context)[0], context)
    assert np.abs(back - codes).max() < 1e-5


@pytest.mark.parametrize(
    "control", [Control(width=4), Control(width=4, past=0), Control(kind="window", past=2)]
)
@pytest.mark.parametrize("dims", [1, 7, 8])
def test_moment_by_moment_is_the_whole_sequence(dims, control):
    sizes = FlowSizes(pose=dims, control=control, code="none", dims=dims, steps=3, units=10, layers=2)
    w = shaken(sizes, dtype=np.float64)
    codes, context = _given(12, sizes)
    whole, _ = FlowWeights(w, sizes, np.float64).inverse(codes, context)
    drawing, past = FlowDrawing(w, sizes, np.float64), control.of_past(dims)
    told = drawing.told(context[:, past:])
    for _ in range(2):
        for t in range(12):
            one = drawing.draw(codes[t], context[t, :past], told[t])
            assert np.abs(one - whole[t]).max() < 1e-9
        drawing.reset()


def test_a_sequence_goes_on_from_where_it_was_cut():
    flow = FlowWeights(shaken(SIZES, dtype=np.float64), SIZES, np.float64)
    codes, context = _given(12, SIZES)
    whole, logs, _ = flow.forward(codes, context)
    first, first_logs, state = flow.forward(codes[:5], context[:5])
    then, then_logs, _ = flow.forward(codes[5:], context[5:], state)
    assert np.abs(np.concatenate([first, then]) - whole).max() < 1e-12
    assert np.abs(np.concatenate([first_logs, then_logs]) - logs).max() < 1e-12
    assert np.abs(flow.forward(codes[5:], context[5:])[0] - whole[5:]).max() > 1e-3  # the state matters


def test_sequences_at_once_are_each_by_itself():
    flow = FlowWeights(shaken(SIZES, dtype=np.float64), SIZES, np.float64)
    codes, context = _given(6, SIZES, batch=(3,))
    together = flow.log_likelihood(codes, context)
    for n in range(3):
        assert np.abs(flow.log_likelihood(codes[n], context[n]) - together[n]).max() < 1e-12


def test_the_determinant_is_that_of_the_whole_sequences_jacobian():
    flow = FlowWeights(shaken(SIZES, dtype=np.float64), SIZES, np.float64)
    codes, context = _given(7, SIZES)
    numbers = codes.size
    jacobian, step = np.empty((numbers, numbers)), 1e-5
    for n in range(numbers):
        values = []
        for sign in (2, 1, -1, -2):
            moved = codes.copy().reshape(-1)
            moved[n] += sign * step
            values.append(flow.forward(moved.reshape(codes.shape), context)[0].reshape(-1))
        jacobian[:, n] = (-values[0] + 8 * values[1] - 8 * values[2] + values[3]) / (12 * step)
    logs = flow.forward(codes, context)[1].sum()
    assert abs(np.linalg.slogdet(jacobian)[1] - logs) < 1e-8


def test_the_density_of_one_number_sums_to_one():
    sizes = FlowSizes(pose=1, control=Control(width=4), code="none", dims=1, steps=4, units=6)
    flow = FlowWeights(shaken(sizes, dtype=np.float64), sizes, np.float64)
    context = _given(1, sizes)[1]
    at = np.linspace(-60, 60, 60001)
    density = np.exp(flow.log_likelihood(at[:, None, None], np.repeat(context[None], len(at), 0)))[:, 0]
    assert abs(density.sum() * (at[1] - at[0]) - 1) < 1e-3
    assert density.max() > 2 * density[0]


def test_begun_anew_a_flow_only_turns():
    weights = make_initial_weights(SIZES)
    flow = FlowWeights(weights, SIZES, np.float64)
    matrix = build_flow_matrix(weights, "flow.steps.0.linear")
    assert np.abs(matrix @ matrix.T - np.eye(8)).max() < 1e-5
    codes, context = _given(3, SIZES)
    scale = np.log(1 / (1 + np.exp(-2.0)) + 1e-6)
    assert np.allclose(flow.forward(codes, context)[1], 3 * 4 * scale, atol=1e-5)


def test_what_is_below_the_diagonal_of_the_upper_matrix_does_not_count():
    weights = shaken(SIZES)
    before = build_flow_matrix(weights, "flow.steps.1.linear")
    weights["flow.steps.1.linear.upper"] += np.tril(np.ones((8, 8), np.float32))
    weights["flow.steps.1.linear.lower"] += np.triu(np.ones((8, 8), np.float32))
    assert (build_flow_matrix(weights, "flow.steps.1.linear") == before).all()
