"""What the data of a study show: the ratio of times with its interval, learning, mistakes, ratings, and what
cannot be said from them.

People are the units: each counts once, by the mean over their tasks, however many tasks there are.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from math import exp, inf, log

import numpy as np

from metagraph.study import stats
from metagraph.study.analysis_read import TOTALS, AnalysisRow, Data
from metagraph.study.score import WORDS, Score, What
from metagraph.study.stats import Estimate, PeriodOrder, Test
from metagraph.study.tasks import SPENT, Spent

ABOVE, BELOW = "manual", "meta"  # the ratio is of the one to the other
TITLES: Mapping[str, str] = {"meta": "meta-graph", "manual": "state machine by hand"}


@dataclass(frozen=True, slots=True)
class Person:
    """What one participant took, seconds, geometric mean over the tasks that count. above_first: began with
    ABOVE.
    """

    participant: str
    above: float
    below: float
    above_first: bool

    @property
    def ratio(self) -> float:
        return self.above / self.below


@dataclass(frozen=True)
class Comparison:
    """Seconds of ABOVE beside BELOW. unit: `task`, or `clip` where people had other tasks in each. paired:
    everybody did both; then people are they. means: geometric, by condition. effect: d_z; raw_effect:
    uncorrected.
    """

    unit: str
    paired: bool
    means: Mapping[str, Estimate]
    ratio: Estimate
    test: Test
    people: tuple[Person, ...] = ()
    ranked: Test | None = None
    effect: Estimate | None = None
    raw_effect: float | None = None
    biserial: float | None = None
    order: PeriodOrder | None = None
    cautions: tuple[str, ...] = ()


@dataclass(frozen=True)
class Measure:
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
    """Everything a report tells. by_task: task -> its ratio and its test, and p corrected for how many tasks
    there are. together: name, test and p corrected for how many questions were asked of the same people.
    """

    data: Data
    time: Comparison | None = None
    by_task: Mapping[str, tuple[Estimate, Test, float | None]] = field(default_factory=dict)
    curves: Mapping[str, Curve] = field(default_factory=dict)
    spent: Mapping[str, Mapping[Spent, float]] = field(default_factory=dict)
    predicted: Mapping[str, Predicted] = field(default_factory=dict)
    mistakes: tuple[Measure, ...] = ()
    ratings: tuple[Measure, ...] = ()
    together: tuple[tuple[str, Test, float | None], ...] = ()


def analyse(data: Data) -> Results:
    """Return what the data show."""
    done = [r for r in data.rows if r.done]
    time = compare(done)
    tasks: dict[str, tuple[Estimate, Test]] = {}
    for task in data.tasks:
        found = compare([r for r in done if r.run.task == task])
        if found is not None:
            tasks[task] = found.ratio, found.test
    corrected = stats.holm([test.p for _, test in tasks.values()])
    conditions = [c for c in data.conditions if any(r.run.condition == c for r in done)]
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
        (m.name, m.test) for m in (*mistakes[:1], *ratings) if m.test is not None and m.test.p is not None
    ]
    return Results(
        data,
        time,
        {task: (*found, p) for (task, found), p in zip(tasks.items(), corrected, strict=True)},
        {
            c: curve
            for c in conditions
            if (curve := learning([r for r in done if r.run.condition == c])) is not None
        },
        {c: _spent([r for r in done if r.run.condition == c]) for c in conditions},
        {
            c: model
            for c in conditions
            if (model := _predicted([r for r in done if r.run.condition == c])) is not None
        },
        mistakes,
        ratings,
        tuple(
            (name, test, p)
            for (name, test), p in zip(asked, stats.holm([t.p for _, t in asked]), strict=True)
        ),
    )


# --- time


def compare(rows: Sequence[AnalysisRow]) -> Comparison | None:
    """Return the comparison of both conditions; None where one of them was never done."""
    by: dict[str, dict[str, dict[str, AnalysisRow]]] = {}  # participant -> condition -> task
    for r in rows:
        by.setdefault(r.run.participant, {}).setdefault(r.run.condition, {})[r.run.task] = r
    both = {p: c for p, c in by.items() if ABOVE in c and BELOW in c}
    if not both:
        return _unpaired(by)
    same = all(c[ABOVE].keys() & c[BELOW].keys() for c in both.values())
    people = []
    for participant, conditions in both.items():
        tasks = conditions[ABOVE].keys() & conditions[BELOW].keys() if same else None
        above, below = (_took(conditions[c], tasks) for c in (ABOVE, BELOW))
        first = min((r for c in conditions.values() for r in c.values()), key=lambda r: r.run.index)
        people.append(Person(participant, above, below, first.run.condition == ABOVE))
    a, b = [p.above for p in people], [p.below for p in people]
    log_a, log_b = stats.logs(a), stats.logs(b)
    ratio = stats.ratio(a, b)
    effect = stats.effect_size(log_a, log_b)
    raw = effect.value / stats.correction(len(people) - 1) if effect is not None else None
    began = {first: [(p.above, p.below) for p in people if p.above_first is first] for first in (True, False)}
    cautions = stats.cautions(ratio, raw)
    alone = len(by) - len(both)
    if alone:
        cautions.append(
            f"{alone} did only one of the two and {'is' if alone == 1 else 'are'} left out of the ratio."
        )
    timed_out = sum(1 for r in rows if r.run.timed_out)
    if timed_out:
        cautions.append(
            f"{timed_out} of {len(rows)} tasks were ended by the time limit: their true times are longer "
            "than those used here."
        )
    order = stats.order_effects(began[True], began[False])
    if order is None and len(people) > 1:
        cautions.append(
            "Fewer than 2 people began with one of the conditions, so practice cannot be told from the "
            "condition."
        )
    return Comparison(
        "task" if same else "clip",
        True,
        {ABOVE: stats.geometric_mean(a), BELOW: stats.geometric_mean(b)},
        ratio,
        stats.paired_t(log_a, log_b),
        tuple(people),
        stats.wilcoxon(log_a, log_b),
        effect,
        raw,
        stats.rank_biserial(log_a, log_b),
        order,
        tuple(cautions),
    )


def _took(rows: Mapping[str, AnalysisRow], tasks: set[str] | None) -> float:
    """Return the geometric mean of seconds: a task, over some tasks, or where tasks is None a clip, over
    all.
    """
    if tasks is None:
        return exp(np.mean([log(r.run.seconds / max(1, r.clips)) for r in rows.values()]))
    return exp(np.mean([log(rows[t].run.seconds) for t in sorted(tasks)]))


def _unpaired(by: Mapping[str, Mapping[str, Mapping[str, AnalysisRow]]]) -> Comparison | None:
    groups = {c: [found[c] for found in by.values() if c in found] for c in (ABOVE, BELOW)}
    if not all(groups.values()):
        return None
    tasks = {c: {t for rows in group for t in rows} for c, group in groups.items()}
    same = tasks[ABOVE] == tasks[BELOW]
    took = {c: [_took(rows, set(rows) if same else None) for rows in group] for c, group in groups.items()}
    found, test = stats.welch(stats.logs(took[ABOVE]), stats.logs(took[BELOW]))
    ratio = found.exp()
    words = [
        "No one did both, so people are compared with other people: it takes many more of them than when "
        "everybody does both."
    ]
    if ratio.low is None:
        words = ["A group of one has no interval: this says nothing about other people."]
    elif ratio.holds(1.0):
        words.append(
            "The interval of the ratio includes 1: these people do not show that either way is faster."
        )
    means = {c: stats.geometric_mean(values) for c, values in took.items()}
    return Comparison("task" if same else "clip", False, means, ratio, test, cautions=tuple(words))


def learning(rows: Sequence[AnalysisRow]) -> Curve | None:
    """Return how people got quicker from clip to clip, within one condition; None where nobody had three
    clips.
    """
    by: dict[str, list[float]] = {}
    for r in sorted(rows, key=lambda r: r.run.index):
        by.setdefault(r.run.participant, []).extend(s for s in r.run.per_clip.values() if s > 0)
    lines = [line for seconds in by.values() if (line := stats.power_law(seconds)) is not None]
    if not lines:
        return None
    slope = lines[0][0] if len(lines) == 1 else stats.mean([line.value for line, _ in lines])
    first = stats.geometric_mean([at for _, at in lines]).value
    longest = max(len(s) for s in by.values())
    means = tuple(exp(float(np.mean([log(s[n]) for s in by.values() if n < len(s)]))) for n in range(longest))
    return Curve(slope, first, means)


def _spent(rows: Sequence[AnalysisRow]) -> dict[Spent, float]:
    """Return mean seconds a task by what they went into, each person counting once."""
    people: dict[str, list[AnalysisRow]] = {}
    for r in rows:
        people.setdefault(r.run.participant, []).append(r)
    return {
        s: float(np.mean([np.mean([r.run.spent[s] for r in mine]) for mine in people.values()]))
        for s in SPENT
    }


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
        stats.geometric_mean(observed), stats.geometric_mean(model), stats.ratio(observed, model)
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
) -> Measure | None:
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
        return Measure(name, means, None, None)
    a, b = ([each[c][who] for who in both] for c in (ABOVE, BELOW))
    difference = stats.mean([x - y for x, y in zip(a, b, strict=True)])
    return Measure(name, means, difference, stats.wilcoxon(a, b), stats.effect_size(a, b))


def _within(found: Estimate, least: float, most: float) -> Estimate:
    low, high = found.low, found.high
    return Estimate(
        found.value,
        None if low is None else max(low, least),
        None if high is None else min(high, most),
        found.n,
    )
