"""What a Flow-VAE draws is brought to the lengths of the takes that it has learned from."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from metagraph.generation import calibration
from metagraph.generation.calibration import fit_lengths, measure_drawn_lengths, measure_true_lengths
from metagraph.generation.networks import KNOTS, Control, FlowSizes
from metagraph.generation.stored import Model
from metagraph.generation.takes import Take, TakeSource
from metagraph.generation.vae import Lengths
from tests.generation.makers import tiny, untrained

SIZES = FlowSizes(
    code="pca",
    dims=6,
    steps=2,
    units=6,
    control=Control(width=8, past=2),
    span=4,
    guess=True,
    guided=True,
    knots=KNOTS,
)


def lengths() -> Lengths:
    return Lengths(np.array([1.0, 2.0, 4.0]), np.array([1.0, 3.0, 8.0]))


def own_model(by: float = 0.02) -> Model:
    """A model that has drawn nothing yet."""
    made = untrained("flow-vae", by, SIZES)
    still = {"guess.drawn": np.zeros(KNOTS, np.float32), "guess.true": np.zeros(KNOTS, np.float32)}
    wide = {"guess.spread": np.eye(6, dtype=np.float32), "guess.weight": 0 * made.weights["guess.weight"]}
    return replace(made, weights={**made.weights, **still, **wide})


def make_lively_take(model: Model, size: float, seconds: int = 80) -> Take:
    """A take of somebody who moves now more, now less."""
    chance = np.random.default_rng(3)
    frames = 25 * seconds
    far = np.repeat(np.exp(0.7 * chance.standard_normal(frames // 20)), 20)[:, None]
    poses = model.poses.undo((size * far * chance.standard_normal((frames, 78))).astype(np.float32))
    told = np.zeros((frames, 31), np.float32)
    told[:, :27] = chance.normal(-5, 3, (frames, 27))
    told[:, 30] = 1
    return Take(TakeSource("lively"), poses.astype(np.float32), told)


@pytest.mark.parametrize(("drawn", "true"), [(0.5, 0.5), (1.0, 1.0), (1.5, 2.0), (3.0, 5.5), (6.0, 12.0)])
def test_a_length_is_brought_to_between_those_of_its_neighbours(drawn: float, true: float) -> None:
    assert drawn * lengths().find_share(drawn) == pytest.approx(true)


def test_without_knots_nothing_is_brought_anywhere() -> None:
    for unknown in (Lengths(np.zeros(0), np.zeros(0)), Lengths(np.zeros(3), np.zeros(3))):
        assert unknown.find_share(2.0) == 1.0
        back, logs = unknown.undo(np.ones((2, 3)))
        assert (back == 1).all() and (logs == 0).all()
    assert lengths().find_share(0.0) == 1.0


@pytest.mark.parametrize("long", [0.4, 1.3, 2.9, 5.0, 20.0])
def test_the_way_back_and_its_determinant(long: float) -> None:
    """The determinant is that of the Jacobian, number by number."""
    own, chance = lengths(), np.random.default_rng(1)
    at = chance.standard_normal(4)
    at *= long / np.linalg.norm(at)
    back, logs = own.undo(at)
    assert np.allclose(back * own.find_share(float(np.linalg.norm(back))), at)
    step = 1e-6
    columns = [(own.undo(at + step * e)[0] - own.undo(at - step * e)[0]) / (2 * step) for e in np.eye(4)]
    assert float(logs) == pytest.approx(np.linalg.slogdet(np.array(columns))[1], abs=1e-6)


def test_longer_lengths_become_those_of_the_takes_learned_from() -> None:
    model = own_model()
    take = make_lively_take(model, 0.8)
    before = measure_drawn_lengths(model, take, 7)
    found = fit_lengths(model, [take])
    true = measure_true_lengths(model, take)
    used = Lengths(found.weights["guess.drawn"], found.weights["guess.true"])
    drawn = measure_drawn_lengths(found, take, 7)
    after = np.array([x * used.find_share(float(x)) for x in drawn])
    assert abs(np.quantile(after, 0.99) / np.quantile(true, 0.99) - 1) < 0.15
    shorter = drawn[drawn < np.quantile(drawn, 0.5)]  # what rests stays as it is
    assert all(used.find_share(float(x)) == pytest.approx(1, abs=0.01) for x in shorter)
    assert abs(np.quantile(before, 0.99) / np.quantile(true, 0.99) - 1) > 0.25  # so the test can fail
    assert (np.diff(found.weights["guess.drawn"]) > 0).all() and (
        np.diff(found.weights["guess.true"]) > 0
    ).all()


def test_takes_that_are_too_short_or_a_model_without_knots_leave_it_as_it_is() -> None:
    model = own_model()
    short = make_lively_take(model, 0.3).part(0, 12)
    assert not Lengths(*(fit_lengths(model, [short]).weights[f"guess.{n}"] for n in ("drawn", "true"))).used
    assert len(calibration.LEVELS) == KNOTS
    plain = untrained("moglow", 0.02, tiny("moglow"))
    assert fit_lengths(plain, [short]) is plain
