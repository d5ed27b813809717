"""How sure the conversation paper's user study may be: its own test, and an exact one.

Each of its tests has one number: how many of n answers preferred the first of two videos. The published
values of chi-square come of holding that share against its own complement, as if those were two samples of n
answers, which counts every answer twice. The exact test of one share against a half is the binomial one.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from math import comb, erfc, sqrt

from metagraph.research.exhibits.published import FIGURE_6, PublishedRating
from metagraph.research.study.statistics.small_samples import apply_holm
from metagraph.synthesis.cooccurrence import compute_wilson_interval


@dataclass(frozen=True, slots=True)
class Preference:
    """A row of the study's figure 6. chi, p: of two independent samples, as published. exact: p of the
    binomial test, two-sided; corrected: the same by Holm over all rows. share: 0..1; low, high: its 95 %
    interval (Wilson).
    """

    rating: PublishedRating
    chi: float
    p: float
    exact: float
    corrected: float
    share: float
    low: float
    high: float

    @property
    def holds(self) -> bool:
        """Whether what the paper says of it, significant or not, is what the exact test says at 5 %."""
        return self.rating.starred == (self.exact < 0.05)


def compare_two_samples(a: int, b: int, n: int) -> tuple[float, float]:
    """Return chi-square with Yates' correction, of one degree of freedom, and its p: a of n beside b of n, as
    though those were independent. Raises ValueError for counts outside 0..n, or no answers.
    """
    if not (n > 0 and 0 <= a <= n and 0 <= b <= n):
        raise ValueError(f"{a} and {b} of {n}: counts are 0 to all of one answer or more")
    expected = (a + b) / 2
    if expected in (0, n):
        return 0.0, 1.0
    off = abs(a - expected)
    off -= min(0.5, off)
    chi = 2 * off * off * (1 / expected + 1 / (n - expected))
    return chi, erfc(sqrt(chi / 2))


def compute_binomial_p(chosen: int, n: int) -> float:
    """Return the two-sided p of so many of n where either answer is as likely. Raises ValueError for counts
    outside 0..n, or no answers.
    """
    if not (n > 0 and 0 <= chosen <= n):
        raise ValueError(f"{chosen} of {n}: a count is 0 to all of one answer or more")
    fewer = min(chosen, n - chosen)
    tail = sum(comb(n, k) for k in range(fewer + 1))
    return min(1.0, float(Fraction(2 * tail, 1 << n)))


def list_preferences() -> tuple[Preference, ...]:
    """Return the study's four rows with both tests."""
    exact = [compute_binomial_p(r.chosen, r.answers) for r in FIGURE_6]
    out = []
    for rating, one, several in zip(FIGURE_6, exact, apply_holm(exact), strict=True):
        n = rating.answers
        chi, p = compare_two_samples(rating.chosen, n - rating.chosen, n)
        low, high = compute_wilson_interval(rating.chosen, n)
        out.append(Preference(rating, chi, p, one, several or one, rating.chosen / n, low, high))
    return tuple(out)
