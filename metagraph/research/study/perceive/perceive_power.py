"""How many people a forced choice needs: by exact binomials, which take answers for independent, and by
simulated studies in which people and items differ.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import isfinite

import numpy as np

from metagraph.research.study.perceive import binomial, crossed
from metagraph.research.study.perceive.crossed import NOTHING
from metagraph.research.study.statistics.small_samples import Estimate

WIDEST = 400  # people of a simulated study


@dataclass(frozen=True)
class Expected:
    """What is assumed of a pair. share: of choices by all people and items together, 0.5..1. people, items:
    standard deviations of log odds.
    """

    share: float
    people: float = 0.5
    items: float = 0.3

    def __post_init__(self) -> None:
        if not 0 < self.share < 1:
            raise ValueError(f"a share lies between 0 and 1, not at {self.share:g}")
        for name in ("people", "items"):
            value = getattr(self, name)
            if not (isfinite(value) and 0 <= value <= 5):
                raise ValueError(f"{name} should be a deviation of 0 to 5 log odds, not {value:g}")

    @cached_property
    def log_odds(self) -> float:
        """Return the log odds in the middle that give the share; by bisection."""
        spread, low, high = float(np.hypot(self.people, self.items)), -20.0, 20.0
        for _ in range(60):
            middle = (low + high) / 2
            below = crossed.compute_overall_share(middle, spread) < self.share
            low, high = (middle, high) if below else (low, middle)
        return (low + high) / 2


def draw_study(
    expected: Expected, people: int, items: int, each: int, rng: np.random.Generator
) -> tuple[list[float], list[float], list[int], list[int]]:
    """Return one study: choices, sides (-0.5, 0.5), whose, about which item. each: answers of a person."""
    u, v = rng.normal(0, expected.people, people), rng.normal(0, expected.items, items)
    who = np.repeat(np.arange(people), each)
    what = (np.tile(np.arange(each), people) + np.repeat(np.arange(people) * each, each)) % items
    side = np.where((np.tile(np.arange(each), people) + who) % 2, 0.5, -0.5)
    odds = expected.log_odds + u[who] + v[what]
    chosen = rng.random(len(who)) < 1 / (1 + np.exp(-odds))
    return chosen.astype(float).tolist(), side.tolist(), who.tolist(), what.tolist()


def simulate_power(
    expected: Expected,
    people: int,
    items: int,
    each: int,
    alpha: float = 0.05,
    studies: int = 200,
    seed: int = 1,
) -> Estimate:
    """Return the share of simulated studies whose mixed model finds the preference, in its direction, with an
    exact interval. items: in all; each: answers of a person about the pair, up to twice the items. Raises
    ValueError.
    """
    if not (2 <= people <= WIDEST and 1 <= items <= 1000 and 1 <= each <= 2 * items and studies >= 1):
        raise ValueError(
            f"a simulated study has 2 to {WIDEST} people, 1 to 1000 items, and a person answers from once to "
            "twice about each"
        )
    rng = np.random.default_rng(seed)
    hits = 0
    for _ in range(studies):
        chosen, _, who, what = draw_study(expected, people, items, each, rng)
        found = crossed.fit_crossed(chosen, {"preference": [1.0] * len(chosen)}, who, what)
        if found is None:  # everybody agreed: the exact test is what is left
            k, n = round(sum(chosen)), len(chosen)
            p, up = binomial.compute_two_sided_p(k, n) or 1.0, 2 * k > n
        else:
            p, up = found.p["preference"], found.effects["preference"].value > 0
        hits += p < alpha and (up == (expected.share > 0.5) or expected.share == 0.5)
    return binomial.estimate_exact_share(hits, studies)


def estimate_people(expected: Expected, items: int, each: int, chance: float, alpha: float) -> int | None:
    """Return about how many people are needed, to begin simulating from: the exact count of answers, more by
    what people and items add to the variance of their mean. None if items alone are too few.
    """
    answers = binomial.count_needed_answers(expected.share, chance, alpha)
    if answers is None:
        return None
    p = expected.share
    weigh = p * (1 - p)  # from log odds to shares
    single = weigh + (weigh * expected.people) ** 2 * (each - 1)
    goal = weigh / answers  # variance of the share that is enough
    left = goal - (weigh * expected.items) ** 2 / items
    if left <= goal / 50:
        return None
    return max(2, round(single / each / left))


def count_raters_needed(
    expected: Expected,
    items: int,
    each: int,
    chance: float = 0.8,
    alpha: float = 0.05,
    studies: int = 200,
    seed: int = 1,
) -> tuple[int | None, Estimate | None]:
    """Return the fewest people, among steps of a tenth, with whom simulated studies find a preference often
    enough, and how often they do; (None, what the most people give) where none are enough.
    """
    n = estimate_people(expected, items, each, chance, alpha)
    people = min(WIDEST, max(4, n if n is not None else WIDEST))
    found = simulate_power(expected, people, items, each, alpha, studies, seed)
    if found.value >= chance:
        while people > 4:
            fewer = max(4, people - max(1, people // 10))
            less = simulate_power(expected, fewer, items, each, alpha, studies, seed)
            if less.value < chance:
                break
            people, found = fewer, less
        return people, found
    while people < WIDEST:
        people = min(WIDEST, people + max(1, people // 8))
        found = simulate_power(expected, people, items, each, alpha, studies, seed)
        if found.value >= chance:
            return people, found
    return None, found


def compute_design_effect(expected: Expected, each: int) -> float:
    """Return how many times as many answers people who differ make necessary, whatever items do."""
    if expected.people < NOTHING:
        return 1.0
    return 1 + expected.share * (1 - expected.share) * expected.people**2 * (each - 1)
