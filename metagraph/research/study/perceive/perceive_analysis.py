"""What the answers of a perceptual study show: shares of choices and differences of ratings, each with its
interval, and what they cannot show.

Answers of one person, and about one item, are alike; the exact binomial takes them for independent, the mixed
model does not. The model's p values are those that are judged by, where there is a model.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations
from math import sqrt
from typing import Literal

import numpy as np

from metagraph.research.study.perceive import binomial, crossed
from metagraph.research.study.perceive.crossed import Crossed
from metagraph.research.study.perceive.mismatched import list_mismatched_systems
from metagraph.research.study.perceive.perceive_data import Answers, Rated, RaterChoice
from metagraph.research.study.perceive.perceive_plan import PerceivePlan
from metagraph.research.study.statistics import mixed as stats_mixed
from metagraph.research.study.statistics import small_samples as stats
from metagraph.research.study.statistics.distributions import compute_t_quantile, compute_t_two_sided
from metagraph.research.study.statistics.small_samples import LEVEL, Estimate

FEW_PEOPLE, FEW_ITEMS = 12, 8  # below which deviations are hardly known
MOST_ROWS = 50_000  # of differences, beyond which people's means are compared instead
Verdict = Literal["preferred", "not preferred", "no difference that matters", "not told", "no answers"]


@dataclass(frozen=True)
class ComparedPair:
    """A pair of conditions. share: of answers for the first, exact interval. p: the exact binomial's. people:
    of those who chose one more often than the other, the share who chose the first; people_p: its sign test.
    model: None if there is none. together: the p value that is judged by, corrected for all that was asked
    (Holm); exact: the binomial's, in the same way. by_item: item -> share. halves: the shares of the first
    half of people's sessions and of the second; halves_p: of both being the same (Fisher). unfiltered: with
    nobody excluded.
    """

    pair: tuple[str, str]
    share: Estimate | None
    p: float | None = None
    people: Estimate | None = None
    people_p: float | None = None
    model: Crossed | None = None
    together: float | None = None
    exact: float | None = None
    by_item: Mapping[str, Estimate] | None = None
    halves: tuple[Estimate, Estimate] | None = None
    halves_p: float | None = None
    unfiltered: Estimate | None = None
    verdict: Verdict = "no answers"

    @property
    def best(self) -> Estimate | None:
        """Return the share that is reported first: the model's where there is one."""
        return self.model.share if self.model is not None else self.share

    @property
    def alone(self) -> float | None:
        """Return the p value that is judged by, before it is corrected."""
        return self.model.p["preference"] if self.model is not None else self.p


@dataclass(frozen=True)
class RatedPair:
    """A question and a pair of conditions. difference: first less second, points. by: what it was computed
    with, in words. p: two-sided; together: corrected (Holm).
    """

    question: str
    pair: tuple[str, str]
    difference: Estimate
    by: str
    p: float | None
    together: float | None = None
    deviations: Mapping[str, float] | None = None


@dataclass(frozen=True)
class ComparedSystems:
    """Two systems of the mismatched-speech protocol. difference: how much better the first one's own sound is
    recognised, log odds. p: two-sided; together: corrected for all pairs of systems (Holm).
    """

    systems: tuple[str, str]
    difference: Estimate
    p: float
    together: float | None = None

    @property
    def better(self) -> str | None:
        """Return the system whose motion belongs to its sound more visibly; None if that is not shown."""
        if self.together is None or self.together >= 1 - LEVEL:
            return None
        return self.systems[0] if self.difference.value > 0 else self.systems[1]


@dataclass(frozen=True)
class PerceiveResults:
    """Everything a report tells. left: the share of choices of the left side, and its p; same: of pairs of
    the same video. means: question -> condition -> mean of people's means. cautions: in words. systems: those
    of the mismatched-speech protocol beside each other.
    """

    answers: Answers
    pairs: tuple[ComparedPair, ...] = ()
    rated: tuple[RatedPair, ...] = ()
    means: Mapping[str, Mapping[str, Estimate]] | None = None
    left: tuple[Estimate, float | None] | None = None
    same: tuple[Estimate, float | None] | None = None
    cautions: tuple[str, ...] = ()
    systems: tuple[ComparedSystems, ...] = ()


def analyse_answers(answers: Answers) -> PerceiveResults:
    """Return what the answers show."""
    plan = answers.study.plan
    pairs = [_compared(answers, pair) for pair in plan.pairs] if plan.choice is not None else []
    rated = _rated(answers)
    asked = [c.alone for c in pairs] + [r.p for r in rated]
    together = stats.apply_holm(asked)
    exact = stats.apply_holm([c.p for c in pairs])
    pairs = [
        replace(c, together=p, exact=e, verdict=_verdict(c, p, plan.smallest))
        for c, p, e in zip(pairs, together, exact, strict=False)
    ]
    rated = [replace(r, together=p) for r, p in zip(rated, together[len(pairs) :], strict=True)]
    lefts = [c.first == c.left for c in answers.choices]
    return PerceiveResults(
        answers,
        tuple(pairs),
        tuple(rated),
        _means(answers),
        _share(lefts),
        _share(list(answers.same)),
        tuple(_cautions(answers, pairs, lefts)),
        tuple(compare_systems(plan, pairs)),
    )


def compare_systems(plan: PerceivePlan, pairs: Sequence[ComparedPair]) -> list[ComparedSystems]:
    """Return how much better one system's own sound is recognised than another's, of each two systems: the
    difference of their models' preferences, with Welch's degrees of freedom.

    Nothing is taken from the same people having judged both, so that intervals are rather too wide.
    """
    models = {pair.pair: pair.model for pair in pairs}
    found = []
    for (a, one), (b, other) in combinations(list_mismatched_systems(plan).items(), 2):
        both = [(m.effects["preference"], m.df["preference"]) for m in (models[one], models[other]) if m]
        if len(both) == 2:
            value, (error, df) = both[0][0].value - both[1][0].value, _add_errors(both)
            half = compute_t_quantile((1 + LEVEL) / 2, df) * error
            difference = Estimate(value, value - half, value + half, sum(e.n for e, _ in both))
            found.append(ComparedSystems((a, b), difference, compute_t_two_sided(value / error, df)))
    together = stats.apply_holm([each.p for each in found])
    return [replace(each, together=p) for each, p in zip(found, together, strict=True)]


def _add_errors(found: Sequence[tuple[Estimate, float]]) -> tuple[float, float]:
    """Return the standard error of a difference of estimates, each with its degrees of freedom, and its
    own.
    """
    variances = []
    for e, df in found:
        assert e.low is not None and e.high is not None
        variances.append(((e.high - e.low) / 2 / compute_t_quantile((1 + LEVEL) / 2, df)) ** 2)
    total = sum(variances)
    return sqrt(total), total**2 / sum(v * v / df for v, (_, df) in zip(variances, found, strict=True))


def _share(values: Sequence[bool]) -> tuple[Estimate, float | None] | None:
    if not values:
        return None
    return binomial.estimate_exact_share(sum(values), len(values)), binomial.compute_two_sided_p(
        sum(values), len(values)
    )


def _compared(answers: Answers, pair: tuple[str, str]) -> ComparedPair:
    rows = [c for c in answers.choices if c.pair == pair]
    every = [c.first for c in answers.all_choices if c.pair == pair]
    unfiltered = binomial.estimate_exact_share(sum(every), len(every)) if every else None
    if not rows:
        return ComparedPair(pair, None, unfiltered=unfiltered)
    k, n = sum(c.first for c in rows), len(rows)
    more = []
    for who in dict.fromkeys(c.participant for c in rows):
        mine = [c.first for c in rows if c.participant == who]
        if 2 * sum(mine) != len(mine):
            more.append(2 * sum(mine) > len(mine))
    people = _share(more)
    early, late = _halves(rows)
    by_item = {
        i.id: binomial.estimate_exact_share(sum(mine), len(mine))
        for i in answers.study.plan.items
        if (mine := [c.first for c in rows if c.item == i.id])
    }
    return ComparedPair(
        pair,
        binomial.estimate_exact_share(k, n),
        binomial.compute_two_sided_p(k, n),
        people[0] if people is not None else None,
        people[1] if people is not None else None,
        fit_choices(rows),
        by_item=by_item,
        halves=None
        if not early or not late
        else (
            binomial.estimate_exact_share(sum(early), len(early)),
            binomial.estimate_exact_share(sum(late), len(late)),
        ),
        halves_p=binomial.compute_fisher_p(sum(early), len(early), sum(late), len(late)),
        unfiltered=unfiltered,
    )


def fit_choices(rows: Sequence[RaterChoice]) -> Crossed | None:
    """Return the mixed model of choices: a preference, what the left side gains, people and items."""
    if len(rows) < 4:
        return None
    side = [0.5 if c.left else -0.5 for c in rows]
    effects: dict[str, Sequence[float]] = {"preference": [1.0] * len(rows)}
    if len(set(side)) > 1:
        effects["side"] = side
    return crossed.fit_crossed(
        [float(c.first) for c in rows], effects, [c.participant for c in rows], [c.item for c in rows]
    )


def _halves(rows: Sequence[RaterChoice]) -> tuple[list[bool], list[bool]]:
    """Return the choices of the first half of each person's session, and of the second."""
    last: dict[str, int] = {}
    for c in rows:
        last[c.participant] = max(last.get(c.participant, 0), c.place)
    early = [c.first for c in rows if 2 * c.place < last[c.participant]]
    return early, [c.first for c in rows if 2 * c.place >= last[c.participant]]


def _verdict(found: ComparedPair, together: float | None, smallest: float | None) -> Verdict:
    best = found.best
    if best is None:
        return "no answers"
    if together is not None and together < 1 - LEVEL:
        return "preferred" if best.value > 0.5 else "not preferred"
    within = smallest is not None and best.low is not None and best.high is not None
    if within and 1 - smallest < best.low and best.high < smallest:  # type: ignore[operator]
        return "no difference that matters"
    return "not told"


# --- ratings


def _rated(answers: Answers) -> list[RatedPair]:
    plan = answers.study.plan
    if plan.rating is None:
        return []
    out = []
    for question in plan.rating.questions:
        rows = [r for r in answers.ratings if r.question == question.id]
        for pair in plan.pairs:
            found = _difference(question.id, pair, rows)
            if found is not None:
                out.append(found)
    return out


def _difference(question: str, pair: tuple[str, str], rows: Sequence[Rated]) -> RatedPair | None:
    """Return how much higher one condition is rated: differences of the same person about the same item,
    which deviate by person and by item.
    """
    by = {(r.participant, r.item, r.condition): r.value for r in rows}
    both = [(who, item) for who, item, c in by if c == pair[0] and (who, item, pair[1]) in by]
    if not both:
        return None
    gaps = [by[w, i, pair[0]] - by[w, i, pair[1]] for w, i in both]
    if len(gaps) <= MOST_ROWS:
        groups = {"participants": [w for w, _ in both], "items": [i for _, i in both]}
        found = stats_mixed.fit_mixed(gaps, {"difference": [1.0] * len(gaps)}, groups)
        if found is not None:
            e, df = found.effects["difference"], found.df["difference"]
            return RatedPair(question, pair, e, "mixed model", _p_of(e, df), deviations=found.deviations)
    people = {w: [g for g, (v, _) in zip(gaps, both, strict=True) if v == w] for w, _ in both}
    means = [float(np.mean(v)) for v in people.values()]
    test = stats.compute_paired_t(means, [0.0] * len(means))
    return RatedPair(question, pair, stats.mean(means), "people's means", test.p)


def _p_of(found: Estimate, df: float) -> float | None:
    if found.low is None or found.high is None or df <= 0:
        return None
    error = (found.high - found.low) / 2 / compute_t_quantile((1 + LEVEL) / 2, df)
    return compute_t_two_sided(found.value / error, df) if error > 0 else None


def _means(answers: Answers) -> dict[str, dict[str, Estimate]]:
    plan = answers.study.plan
    out: dict[str, dict[str, Estimate]] = {}
    for question in plan.rating.questions if plan.rating is not None else ():
        for condition in plan.conditions:
            people: dict[str, list[float]] = {}
            for r in answers.ratings:
                if r.question == question.id and r.condition == condition:
                    people.setdefault(r.participant, []).append(r.value)
            if people:
                means = [float(np.mean(v)) for v in people.values()]
                out.setdefault(question.id, {})[condition] = stats.mean(means)
    return out


# --- words


def _cautions(answers: Answers, pairs: Sequence[ComparedPair], lefts: Sequence[bool]) -> list[str]:
    out = []
    people, items = len(answers.counting), len(answers.study.plan.items)
    if not people:
        return ["Nobody counts: nothing is said."]
    if people < FEW_PEOPLE:
        out.append(
            f"{people} people are few: how much people differ is hardly known, and nothing is said of others."
        )
    if items < FEW_ITEMS:
        out.append(
            f"{items} {'item is' if items == 1 else 'items are'} few: what is found holds for these, hardly "
            "for other stretches of motion. With so few the model finds differences that are not there more "
            "often than in 5 of 100 studies."
        )
    out += [
        f"{'-'.join(c.pair)}: no mixed model, since all chose the same or too little is known. The exact "
        "test takes answers for independent, which those of one person are not."
        for c in pairs
        if c.share is not None and c.model is None
    ]
    side = _share(lefts)
    if side is not None and side[1] is not None and side[1] < 0.05:
        more = "left" if side[0].value > 0.5 else "right"
        out.append(
            f"The {more} side was chosen more often ({max(side[0].value, 1 - side[0].value):.0%}): sides are "
            "balanced, so that no condition gains by it, but differences look smaller than they are."
        )
    excluded = sum(p.why == "missed checks" for p in answers.people)
    if excluded > people:
        out.append("More people were excluded than count.")
    return out
