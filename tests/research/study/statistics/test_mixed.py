"""Mixed models beside textbooks, closed forms, and figures that other programs gave for the same numbers."""

from __future__ import annotations

from math import sqrt

import numpy as np
import pytest

from metagraph.research.study.statistics import mixed as stats_mixed
from metagraph.research.study.statistics.distributions import compute_t_quantile
from metagraph.research.study.statistics.mixed import fit_mixed

# Davies and Goldsmith, "Statistical Methods in Research and Production", 4th ed., table 6.3: yields of dyestuff,
# five of each of six batches.
YIELDS = (
    1545, 1440, 1440, 1520, 1580, 1540, 1555, 1490, 1560, 1495, 1595, 1550, 1605, 1510, 1560,
    1445, 1440, 1595, 1465, 1545, 1595, 1630, 1515, 1635, 1625, 1520, 1455, 1450, 1480, 1445,
)  # fmt: skip
BATCHES = np.repeat(list("ABCDEF"), 5).tolist()


def test_too_few_rows_give_nothing() -> None:
    assert fit_mixed([1.0], {"one": [1]}, {}) is None
    assert fit_mixed([], {"one": []}, {"who": []}) is None
    assert (
        fit_mixed([1.0, 2.0, 1.0, 2.0], {"one": [1] * 4, "x": [0, 1, 0, 1]}, {"who": [0, 0, 1, 1]}) is None
    ), "exactly"


def test_the_textbooks_batches_by_restricted_and_by_plain_likelihood() -> None:
    found, plain = (fit_mixed(YIELDS, {"one": [1] * 30}, {"batch": BATCHES}, reml) for reml in (True, False))
    assert found is not None and plain is not None
    # Between batches 11271.5 and within 2451.25 (mean squares): (11271.5 - 2451.25) / 5 = 42.0^2.
    assert found.deviations == {
        "batch": pytest.approx(sqrt((11271.5 - 2451.25) / 5), rel=1e-4),
        "rest": pytest.approx(sqrt(2451.25), rel=1e-5),
    }
    assert (found.effects["one"].value, found.df["one"]) == (
        pytest.approx(1527.5),
        pytest.approx(5, rel=1e-3),
    )
    half = 2.570581835636314 * sqrt(11271.5 / 30)
    assert found.effects["one"].high == pytest.approx(1527.5 + half, rel=1e-5)
    assert found.deviance == pytest.approx(319.6543, abs=1e-3), "as lme4 gives it"
    assert plain.deviance == pytest.approx(327.3271, abs=1e-3)
    assert plain.deviations["batch"] == pytest.approx(37.26, abs=0.01)


def test_without_groups_it_is_ordinary_regression() -> None:
    x, y = [1.0, 2.0, 3.0, 4.0], [1.1, 1.9, 3.2, 3.8]
    found = fit_mixed(y, {"one": [1] * 4, "x": x}, {})
    assert found is not None
    assert found.effects["x"].value == pytest.approx(np.polyfit(x, y, 1)[0])
    assert found.df["x"] == 2 and found.deviations.keys() == {"rest"}


def test_a_balanced_cross_over_is_that_of_its_closed_form() -> None:
    """Condition, sitting and people: the ratio of both orders alike, with n - 2 degrees of freedom."""
    rng = np.random.default_rng(4)
    logs = rng.normal(4, 0.3, 12)[:, None] + rng.normal(0, 0.2, (12, 2)) + [0.0, 0.83]
    above_first = np.arange(12) % 2 == 0
    logs[above_first, 0] -= 0.2
    logs[~above_first, 1] -= 0.2
    gaps = logs[:, 1] - logs[:, 0]
    one, other = gaps[above_first], gaps[~above_first]
    adjusted, second = (one.mean() + other.mean()) / 2, (other.mean() - one.mean()) / 2
    half = compute_t_quantile(0.975, 10) * sqrt((one.var(ddof=1) + other.var(ddof=1)) / 2 / 3) / 2
    found = fit_mixed(
        logs.ravel().tolist(),
        {
            "one": [1] * 24,
            "by hand": [0, 1] * 12,
            "second": [float(second) for first in above_first for second in (first, not first)],
        },
        {"person": np.repeat(np.arange(12), 2).tolist()},
    )
    assert found is not None
    by_hand = found.effects["by hand"]
    assert (by_hand.value, by_hand.low, by_hand.high) == tuple(
        pytest.approx(v, rel=1e-3) for v in (adjusted, adjusted - half, adjusted + half)
    )
    assert found.effects["second"].value == pytest.approx(second)
    assert found.df["by hand"] == pytest.approx(10, rel=1e-2)


def test_an_unbalanced_model_of_two_sorts_of_groups_agrees_with_another_program() -> None:
    """statsmodels 0.15 MixedLM of the same numbers: groups of people, conditions of people within."""
    who, cond, task, y = unbalanced()
    found = fit_mixed(
        y,
        {"one": [1] * len(y), "by hand": cond, "task": task},
        {"person": who, "person and condition": [f"{a} {b}" for a, b in zip(who, cond, strict=True)]},
    )
    assert found is not None
    assert [found.effects[k].value for k in ("one", "by hand", "task")] == [
        pytest.approx(v, abs=2e-4) for v in STATSMODELS[:3]
    ]
    assert [*found.deviations.values()] == [pytest.approx(v, abs=1e-3) for v in STATSMODELS[3:6]]
    assert found.deviance == pytest.approx(-2 * STATSMODELS[6], abs=1e-3)


STATSMODELS = (4.003653, 0.713379, 0.437173, 0.264148, 0.264272, 0.103357, -4.178214)


def unbalanced() -> tuple[list[int], list[float], list[float], list[float]]:
    """Ten people, both conditions, two tasks, some of them missing."""
    rng = np.random.default_rng(11)
    who, cond, task, y = [], [], [], []
    for p in range(10):
        own, more = rng.normal(0, 0.4), rng.normal(0, 0.25, 2)
        for c in range(2):
            for t in range(2):
                value = 4 + own + more[c] + 0.8 * c + 0.5 * t + rng.normal(0, 0.15)
                if (p + 2 * c + 3 * t) % 7:
                    who.append(p)
                    cond.append(float(c))
                    task.append(float(t))
                    y.append(float(value))
    return who, cond, task, y


def test_what_others_say_already_and_groups_of_one_row_are_left_out() -> None:
    found = fit_mixed(
        [1.0, 2.0, 3.0, 5.0],
        {"one": [1] * 4, "x": [0, 1, 0, 1], "twice x": [0, 2, 0, 2], "never": [0] * 4},
        {"row": [1, 2, 3, 4], "all": [1, 1, 1, 1]},
    )
    assert found is not None
    assert found.left_out == ("twice x", "never") and found.deviations.keys() == {"rest"}


def test_groups_that_do_not_differ_have_no_deviation() -> None:
    y = [1.0, 2.0, 2.1, 1.1, 1.2, 1.9]
    found = fit_mixed(y, {"one": [1] * 6}, {"pair": [0, 0, 1, 1, 2, 2]})
    assert found is not None and found.deviations["pair"] == 0
    assert found.df["one"] == pytest.approx(5), "then it is an ordinary mean"


def test_many_rows_of_few_groups_give_what_their_covariances_give(monkeypatch: pytest.MonkeyPatch) -> None:
    rng = np.random.default_rng(4)
    people, items = np.repeat(np.arange(12), 9), np.tile(np.arange(9), 12)
    y = 0.4 + rng.normal(0, 0.8, 12)[people] + rng.normal(0, 0.5, 9)[items] + rng.normal(0, 1, 108)
    y, people, items = y[:-3], people[:-3], items[:-3]  # somebody left early
    effects = {"one": np.ones(105), "place": rng.normal(0, 1, 105)}
    groups = {"people": people, "items": items}
    by_sums = stats_mixed.fit_mixed(y, effects, groups)
    monkeypatch.setattr(stats_mixed, "FEW_ROWS", 10_000)
    by_rows = stats_mixed.fit_mixed(y, effects, groups)
    assert by_sums is not None and by_rows is not None
    assert by_sums.deviance == pytest.approx(by_rows.deviance, abs=1e-8)
    assert [*by_sums.deviations.values()] == pytest.approx([*by_rows.deviations.values()], abs=1e-4)
    assert [*by_sums.df.values()] == pytest.approx([*by_rows.df.values()], rel=1e-2)
    for one, other in zip(by_sums.effects.values(), by_rows.effects.values(), strict=True):
        assert (one.value, one.low, one.high) == pytest.approx((other.value, other.low, other.high), abs=1e-3)
