"""What the data of a study show: the ratio of times with its interval, learning, mistakes, ratings, and what
cannot be said from them.

People are the units: each counts once, by the mean over their tasks, however many tasks there are.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from math import exp, inf, log

import numpy as np

from metagraph.research.study.analysis.reading import TOTALS, AnalysisRow, Data
from metagraph.research.study.logs.gaps import Vanished, count_vanished
from metagraph.research.study.plan.planning import Equivalence, judge_equivalence
from metagraph.research.study.scores.machines import WORDS, Score, What
from metagraph.research.study.scores.tasks import SPENT
from metagraph.research.study.scores.uses import USES
from metagraph.research.study.statistics import small_samples as stats
from metagraph.research.study.statistics.comparison import (
    ABOVE,
    BELOW,
    PAIR,
    ConditionComparison,
    compare_conditions,
)
from metagraph.research.study.statistics.sensitivity import Sensitivity, analyse_sensitivity
from metagraph.research.study.statistics.small_samples import Estimate, Test

__all__ = [
    "ABOVE",
    "BELOW",
    "MISTAKES",
    "TITLES",
    "ConditionComparison",
    "Results",
    "StudyMeasure",
    "analyse_study",
    "compare_conditions",
]

TITLES: Mapping[str, str] = {
    "meta": "meta-graph",
    "manual": "state machine by hand",
    "unreal": "Unreal Engine",
    "unity": "Unity",
    "godot": "Godot",
    "blender": "Blender",
}


@dataclass(frozen=True)
class StudyMeasure:
    """Something counted or rated under both conditions. means: by condition, with t intervals. difference: of
    pairs, ABOVE less BELOW.
    """

    name: str
    means: Mapping[str, Estimate]
    difference: Estimate | None
    test: Test | None
    effect: Estimate | None = None


@dataclass(frozen=True)
class Curve:
    """How people got quicker. slope: of log seconds over log of the clip's number, the mean over people (of
    one person, the line's own). seconds: geometric means of the first, second ... clip, each over those who
    came so far.
    """

    slope: Estimate
    first: float
    seconds: tuple[float, ...]


@dataclass(frozen=True)
class Predicted:
    """Observed seconds beside those the keystroke-level model predicts. observed, model: geometric means a
    task. share: their ratio.
    """

    observed: Estimate
    model: Estimate
    share: Estimate


@dataclass(frozen=True)
class Results:
    """Everything a report tells. by_task: task -> its ratio. others: further conditions beside the
    meta-graph. together: what was asked of these people, name, test, and p corrected for how many questions
    those are (Holm); there are no other p values. vanished: by condition, gaps that no time counts. by_site:
    site -> its ratio. by_names: how clips were called (shown, hidden) -> its ratio. names_ratio: the ratio
    with numbers over that with names, of people who did both.
    """

    data: Data
    time: ConditionComparison | None = None
    by_task: Mapping[str, Estimate] = field(default_factory=dict)
    curves: Mapping[str, Curve] = field(default_factory=dict)
    spent: Mapping[str, Mapping[str, float]] = field(default_factory=dict)
    predicted: Mapping[str, Predicted] = field(default_factory=dict)
    mistakes: tuple[StudyMeasure, ...] = ()
    ratings: tuple[StudyMeasure, ...] = ()
    together: tuple[tuple[str, Test, float | None], ...] = ()
    sensitivity: Sensitivity | None = None
    vanished: Mapping[str, Vanished] = field(default_factory=dict)
    others: tuple[ConditionComparison, ...] = ()
    by_site: Mapping[str, Estimate] = field(default_factory=dict)
    equivalence: Equivalence | None = None
    by_names: Mapping[str, Estimate] = field(default_factory=dict)
    names_ratio: Estimate | None = None


def analyse_study(data: Data) -> Results:
    """Return what the data show."""
    done = [r for r in data.rows if r.done]
    time = compare_conditions(done, data.unit)
    ratios = {t: compare_conditions([r for r in done if r.run.task == t]) for t in data.tasks}
    conditions = [c for c in data.conditions if any(r.run.condition == c for r in done)]
    by = {c: [r for r in done if r.run.condition == c] for c in conditions}
    mistakes = tuple(
        m
        for name, get in MISTAKES.items()
        if (m := _measure(name, _scored(done, get), 0.0, 100.0 if name.endswith("%") else inf))
    )
    names = list(dict.fromkeys(r.measure for r in data.ratings))
    ratings = tuple(
        m
        for name in names
        if (m := _measure(name, _rated(data, name), *((0.0, 100.0) if name in TOTALS else ()))) is not None
    )
    asked = [("time", time.test)] if time is not None and time.test.p is not None else []
    asked += [
        (m.name, m.test)
        for m in (*mistakes[:1], *(m for m in ratings if m.name in TOTALS))
        if m.test is not None and m.test.p is not None
    ]
    named = {
        n: found
        for n in ("shown", "hidden")
        if (found := compare_conditions([r for r in done if r.run.names == n])) is not None
    }
    others = [compare_conditions(done, data.unit, (c, BELOW)) for c in conditions if c not in PAIR]
    return Results(
        data,
        time,
        {task: found.ratio for task, found in ratios.items() if found is not None},
        {c: curve for c, rows in by.items() if (curve := fit_learning_curve(rows)) is not None},
        {c: _spent(rows) for c, rows in by.items()},
        {c: model for c, rows in by.items() if (model := _predicted(rows)) is not None},
        mistakes,
        ratings,
        tuple(
            (name, test, p)
            for (name, test), p in zip(asked, stats.apply_holm([t.p for _, t in asked]), strict=True)
        ),
        analyse_sensitivity(done, time, data.sites) if time is not None else None,
        {c: count_vanished([(r.run.seconds, r.gaps) for r in rows]) for c, rows in by.items()},
        tuple(found for found in others if found is not None),
        {s: e for s in dict.fromkeys(data.sites.values()) if (e := _site(done, data, s)) is not None},
        judge_equivalence(time.logs, data.smallest)
        if time is not None and data.smallest is not None
        else None,
        {n: found.ratio for n, found in named.items()},
        _compare_names(named),
    )


def _compare_names(named: Mapping[str, ConditionComparison]) -> Estimate | None:
    """Return how many times the ratio with numbers is that with names, within people."""
    if len(named) < 2:
        return None
    mine = {n: {p.participant: p.ratio for p in found.people} for n, found in named.items()}
    both = sorted(mine["shown"].keys() & mine["hidden"].keys())
    if not both:
        return None
    return stats.estimate_ratio([mine["hidden"][p] for p in both], [mine["shown"][p] for p in both])


def _site(done: Sequence[AnalysisRow], data: Data, site: str) -> Estimate | None:
    found = compare_conditions([r for r in done if data.sites.get(r.run.participant) == site], data.unit)
    return found.ratio if found is not None else None


# --- practice, and what the time went into


def fit_learning_curve(rows: Sequence[AnalysisRow]) -> Curve | None:
    """Return how people got quicker from clip to clip, within one condition; None if nobody had
    three clips.
    """
    by: dict[str, list[float]] = {}
    for r in sorted(rows, key=lambda r: r.run.index):
        by.setdefault(r.run.participant, []).extend(s for s in r.run.per_clip.values() if s > 0)
    lines = [line for seconds in by.values() if (line := stats.fit_power_law(seconds)) is not None]
    if not lines:
        return None
    slope = lines[0][0] if len(lines) == 1 else stats.mean([line.value for line, _ in lines])
    first = stats.compute_geometric_mean([at for _, at in lines]).value
    longest = max(len(s) for s in by.values())
    means = tuple(exp(float(np.mean([log(s[n]) for s in by.values() if n < len(s)]))) for n in range(longest))
    return Curve(slope, first, means)


def _spent(rows: Sequence[AnalysisRow]) -> dict[str, float]:
    """Return mean seconds a task by what they went into, each person counting once."""
    people: dict[str, list[Mapping[str, float]]] = {}
    for r in rows:
        people.setdefault(r.run.participant, []).append(r.uses or {str(k): v for k, v in r.run.spent.items()})
    names = dict.fromkeys((*USES, *SPENT))
    out = {
        n: float(np.mean([np.mean([m.get(n, 0.0) for m in mine]) for mine in people.values()])) for n in names
    }
    return {n: seconds for n, seconds in out.items() if seconds > 0}


def _predicted(rows: Sequence[AnalysisRow]) -> Predicted | None:
    people: dict[str, list[AnalysisRow]] = {}
    for r in rows:
        if r.predicted > 0:
            people.setdefault(r.run.participant, []).append(r)
    if not people:
        return None
    observed, model = (
        [exp(np.mean([log(get(r)) for r in mine])) for mine in people.values()] for get in (_observed, _model)
    )
    return Predicted(
        stats.compute_geometric_mean(observed),
        stats.compute_geometric_mean(model),
        stats.estimate_ratio(observed, model),
    )


def _observed(row: AnalysisRow) -> float:
    return row.run.seconds


def _model(row: AnalysisRow) -> float:
    return row.predicted


# --- mistakes and ratings


def _counted(what: What) -> Callable[[Score], float | None]:
    return lambda s: None if what == "jump" and s.jumps is None else float(s.count(what))


def _share(name: str) -> Callable[[Score], float | None]:
    def get(score: Score) -> float | None:
        found = getattr(score, name)
        return None if found is None else 100 * float(found)

    return get


MISTAKES: Mapping[str, Callable[[Score], float | None]] = {
    "F1 of connections, %": _share("f1"),
    "precision, %": _share("precision"),
    "recall, %": _share("recall"),
    "connections to and from rest, %": lambda s: (
        100 * s.essential_right / s.essential if s.essential else None
    ),
    "clips in the right place, %": lambda s: 100 * s.placed / s.states if s.states else None,
    "connections to the wrong target": lambda s: float(s.wrong),
    **{words: _counted(what) for what, words in WORDS.items()},
}


def _scored(
    rows: Sequence[AnalysisRow], get: Callable[[Score], float | None]
) -> list[tuple[str, str, float]]:
    found = [(r.run.participant, r.run.condition, get(r.score)) for r in rows if r.score is not None]
    return [(who, condition, value) for who, condition, value in found if value is not None]


def _rated(data: Data, name: str) -> list[tuple[str, str, float]]:
    return [(r.participant, r.condition or "", r.value) for r in data.ratings if r.measure == name]


def _measure(
    name: str, values: Sequence[tuple[str, str, float]], least: float = -inf, most: float = inf
) -> StudyMeasure | None:
    """Return a measure of (participant, condition, value), several of one participant taken together by their
    mean. least, most: what a value can be; intervals do not go beyond.
    """
    by: dict[str, dict[str, list[float]]] = {}
    for who, condition, value in values:
        by.setdefault(condition, {}).setdefault(who, []).append(value)
    if not by:
        return None
    each = {c: {who: float(np.mean(v)) for who, v in people.items()} for c, people in by.items()}
    means = {c: _within(stats.mean(list(people.values())), least, most) for c, people in each.items()}
    both = sorted(each.get(ABOVE, {}).keys() & each.get(BELOW, {}).keys())
    if not both:
        return StudyMeasure(name, means, None, None)
    a, b = ([each[c][who] for who in both] for c in (ABOVE, BELOW))
    difference = stats.mean([x - y for x, y in zip(a, b, strict=True)])
    return StudyMeasure(
        name, means, difference, stats.compute_paired_t(a, b), stats.compute_effect_size(a, b)
    )


def _within(found: Estimate, least: float, most: float) -> Estimate:
    low, high = found.low, found.high
    return Estimate(
        found.value,
        None if low is None else max(low, least),
        None if high is None else min(high, most),
        found.n,
    )
