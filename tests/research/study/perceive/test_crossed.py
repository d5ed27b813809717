"""Crossed logistic models: a published answer, brute force, and how often they err."""

from __future__ import annotations

import numpy as np
import pytest

from metagraph.research.study.perceive.crossed import Crossed, compute_overall_share, fit_crossed
from tests.thorough import many

# Contagious bovine pleuropneumonia in 15 herds (Lesnoff et al. 2004, "Within-herd spread of contagious bovine
# pleuropneumonia in Ethiopian highlands", Preventive Veterinary Medicine 64): herd, cases, size, period.
HERDS = (
    "1,2,14,1 1,3,12,2 1,4,9,3 1,0,5,4 2,3,22,1 2,1,18,2 2,1,21,3 3,8,22,1 3,2,16,2 3,0,16,3 3,2,20,4 4,2,10,1 "
    "4,0,10,2 4,2,9,3 4,0,6,4 5,5,18,1 5,0,25,2 5,0,24,3 5,1,4,4 6,3,17,1 6,0,17,2 6,0,18,3 6,1,20,4 7,8,16,1 "
    "7,1,10,2 7,3,9,3 7,0,5,4 8,12,34,1 9,2,9,1 9,0,6,2 9,0,8,3 9,0,6,4 10,1,22,1 10,1,22,2 10,0,18,3 10,2,22,4 "
    "11,0,25,1 11,5,27,2 11,3,22,3 11,1,22,4 12,2,10,1 12,1,8,2 12,0,6,3 12,0,5,4 13,1,21,1 13,2,24,2 13,0,19,3 "
    "13,0,23,4 14,11,19,1 14,0,2,2 14,0,3,3 14,0,2,4 15,1,19,1 15,1,15,2 15,1,15,3 15,0,15,4"
)


def test_the_published_model_of_herds_is_found() -> None:
    """The answer printed in lme4's documentation for Laplace's approximation."""
    rows = [tuple(map(int, row.split(","))) for row in HERDS.split()]
    effects = {"one": [1.0] * len(rows), **{f"p{k}": [float(r[3] == k) for r in rows] for k in (2, 3, 4)}}
    herds, cases, sizes = [r[0] for r in rows], [r[1] for r in rows], [r[2] for r in rows]
    found = fit_crossed(cases, effects, herds, [0] * len(rows), sizes)
    assert found is not None
    assert [e.value for e in found.effects.values()] == pytest.approx(
        [-1.3983, -0.9919, -1.1282, -1.5797], abs=2e-3
    )
    assert [*found.errors.values()] == pytest.approx([0.2312, 0.3032, 0.3228, 0.4220], rel=0.02)
    assert found.deviations["participants"] == pytest.approx(0.6421, abs=2e-3)
    assert found.deviations["items"] == 0 and found.deviance == pytest.approx(184.05, abs=0.01)


def drawn(
    seed: int, people: int, items: int, middle: float, spread: tuple[float, float], side: float = 0.0
) -> tuple[list[float], list[float], list[int], list[int]]:
    rng = np.random.default_rng(seed)
    u, v = rng.normal(0, spread[0], people), rng.normal(0, spread[1], items)
    who, what = np.repeat(np.arange(people), items), np.tile(np.arange(items), people)
    sides = np.where((who + what) % 2, 0.5, -0.5)
    chosen = rng.random(people * items) < 1 / (1 + np.exp(-(middle + u[who] + v[what] + side * sides)))
    return chosen.astype(float).tolist(), sides.tolist(), who.tolist(), what.tolist()


def fitted(rows: tuple[list[float], list[float], list[int], list[int]]) -> Crossed | None:
    chosen, sides, who, what = rows
    return fit_crossed(chosen, {"preference": [1.0] * len(chosen), "side": sides}, who, what)


@pytest.mark.nightly
def test_crossed_deviations_are_those_that_a_plain_minimiser_finds() -> None:
    from scipy.optimize import minimize

    chosen, sides, who, what = drawn(3, 14, 9, 0.4, (0.9, 0.8), 0.5)
    y, s, a, b = np.array(chosen), np.array(sides), np.array(who), np.array(what)

    def deviance(at: np.ndarray) -> float:
        z = np.zeros((len(y), 23))
        z[np.arange(len(y)), a], z[np.arange(len(y)), 14 + b] = at[2], at[3]
        u = np.zeros(23)
        for _ in range(50):
            p = 1 / (1 + np.exp(-(at[0] + at[1] * s + z @ u)))
            h = z.T @ (z * (p * (1 - p))[:, None]) + np.eye(23)
            step = np.linalg.solve(h, z.T @ (y - p) - u)
            u = u + step
            if abs(step).max() < 1e-12:
                break
        eta = at[0] + at[1] * s + z @ u
        return float(-2 * (y * eta - np.logaddexp(0, eta)).sum() + u @ u + np.linalg.slogdet(h)[1])

    theirs = minimize(
        deviance, [0.1, 0.1, 0.5, 0.5], method="Nelder-Mead", options={"xatol": 1e-5, "fatol": 1e-8}
    )
    ours = fitted((chosen, sides, who, what))
    assert ours is not None and ours.deviance == pytest.approx(theirs.fun, abs=1e-4)
    found = [*(e.value for e in ours.effects.values()), *ours.deviations.values()]
    assert found == pytest.approx([*theirs.x[:2], *np.abs(theirs.x[2:])], abs=5e-3)


def test_without_deviations_it_is_plain_logistic_regression() -> None:
    found = fit_crossed([1, 1, 1, 0], {"preference": [1.0] * 4}, [0, 0, 0, 0], [1, 1, 1, 1])
    assert found is not None and found.effects["preference"].value == pytest.approx(np.log(3), abs=1e-4)
    assert found.errors["preference"] == pytest.approx(np.sqrt(4 / 3), rel=1e-3)
    assert found.share.value == pytest.approx(0.75, abs=1e-4) and found.deviations == {
        "participants": 0,
        "items": 0,
    }


def test_what_has_no_end_or_says_the_same_twice_has_no_model() -> None:
    assert fit_crossed([], {"preference": []}, [], []) is None
    assert fit_crossed([1.0] * 6, {"preference": [1.0] * 6}, range(6), [0] * 6) is None
    assert fit_crossed([0.0] * 6, {"preference": [1.0] * 6}, range(6), [0] * 6) is None
    twice = {"preference": [1.0] * 6, "again": [2.0] * 6}
    assert fit_crossed([1, 0, 1, 0, 1, 1], twice, [0, 0, 1, 1, 2, 2], [0, 1] * 3) is None
    divided = {"preference": [1.0] * 8, "side": [0.5, -0.5] * 4}
    assert fit_crossed([1, 0] * 4, divided, [0, 0, 1, 1, 2, 2, 3, 3], [0, 1] * 4) is None


@pytest.mark.nightly
@pytest.mark.parametrize(("people", "items", "spread"), [(24, 10, (0.6, 0.3)), (20, 16, (0.0, 0.0))])
def test_of_studies_without_a_preference_about_one_in_twenty_finds_one(
    people: int, items: int, spread: tuple[float, float]
) -> None:
    studies, most = many(30, 120), many(5, 13)
    found = [fitted(drawn(seed, people, items, 0.0, spread, 0.3)) for seed in range(studies)]
    hits = sum(f is not None and f.p["preference"] < 0.05 for f in found)
    assert hits <= most, hits  # of 30 or 120 with 5 % each, more are less likely than 1 in 100


@pytest.mark.nightly
def test_intervals_hold_what_was_planted_about_as_often_as_they_say() -> None:
    studies, planted = many(20, 80), 0.7
    held = 0
    for seed in range(studies):
        found = fitted(drawn(seed + 500, 24, 10, planted, (0.5, 0.3), -0.4))
        held += found is not None and found.effects["preference"].holds(planted)
    assert held >= many(16, 69), held  # of 20 or 80 with 95 % each, fewer are less likely than 1 in 300


def test_people_who_differ_make_an_interval_wider_than_as_many_independent_answers_would() -> None:
    found = fitted(drawn(9, 12, 12, 0.5, (1.5, 0.0)))
    alike = fitted(drawn(9, 12, 12, 0.5, (0.0, 0.0)))
    assert found is not None and alike is not None
    assert found.errors["preference"] > 1.5 * alike.errors["preference"]
    assert found.df["preference"] < 20 < alike.df["preference"]


def test_shares_of_all_are_nearer_to_a_half_the_more_people_differ() -> None:
    assert compute_overall_share(1.0, 0.0) == pytest.approx(1 / (1 + np.exp(-1)))
    assert (
        0.5
        < compute_overall_share(1.0, 2.0)
        < compute_overall_share(1.0, 0.5)
        < compute_overall_share(1.0, 0.0)
    )
    assert compute_overall_share(0.0, 3.0) == pytest.approx(0.5)
