"""How often a timing study of so many people finds what is there, by simulating studies and analysing each as
the report does: for power, for how wide intervals are, and for how often they hold the truth.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from statistics import median

from metagraph.research.study.perceive.binomial import estimate_exact_share
from metagraph.research.study.simulation.people import Truth, simulate_times
from metagraph.research.study.statistics.comparison import compare_conditions
from metagraph.research.study.statistics.small_samples import Estimate

PEOPLE = (8, 10, 12, 16, 20, 24, 28, 32, 36, 40)
TASKS: Mapping[str, tuple[str, ...]] = {
    name: tuple(f"{name} {n}" for n in range(count)) for name, count in (("six", 6), ("eight", 8))
}  # as the pilot's


@dataclass(frozen=True)
class SimulatedPower:
    """people: how many. found: the share of studies whose test finds the planted ratio, in its direction.
    held: of 95 % intervals, the share that holds it. false: the share of studies that find a ratio where
    there is none. factor: by which the interval reaches beyond the estimate, the median.
    """

    people: int
    found: Estimate
    held: Estimate
    false: Estimate
    factor: float


def simulate_study_power(
    truth: Truth, people: Sequence[int] = PEOPLE, studies: int = 1000, alpha: float = 0.05
) -> Iterator[SimulatedPower]:
    """Yield what studies of each size find. truth: what is planted; its number of participants and its seed
    are set here. alpha: two-sided. Raises ValueError for fewer than 4 people, or no study.
    """
    if min(people) < 4 or studies < 1:
        raise ValueError("a simulated study has 4 people at least, and there is one study at least")
    for count in people:
        found = held = false = 0
        factors = []
        for seed in range(studies):
            for ratio in (truth.ratio, 1.0):
                one = replace(truth, participants=count, seed=seed, ratio=ratio)
                time = compare_conditions(simulate_times(one, TASKS).rows, "task")
                assert time is not None and time.test.p is not None and time.ratio.high is not None
                shown = time.test.p < alpha
                if ratio == 1.0:
                    false += shown
                if ratio == truth.ratio:
                    found += shown and (time.ratio.value > 1) == (truth.ratio > 1)
                    held += time.ratio.holds(truth.ratio)
                    factors.append(time.ratio.high / time.ratio.value)
                if truth.ratio == 1.0:
                    break
        yield SimulatedPower(
            count,
            estimate_exact_share(found, studies),
            estimate_exact_share(held, studies),
            estimate_exact_share(false, studies),
            median(factors),
        )
