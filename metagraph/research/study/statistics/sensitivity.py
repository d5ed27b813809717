"""The ratio of times computed otherwise: what hangs on one person, on a limit, on a choice of the analysis.

Nobody is left out of the figure that is reported for being odd; what it would be without them is reported
beside it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import isinf, log

import numpy as np

from metagraph.research.study.analysis.reading import AnalysisRow
from metagraph.research.study.logs.gaps import LIMITS, measure_seconds_by_limit
from metagraph.research.study.scores.tasks import AWAY
from metagraph.research.study.statistics import small_samples as stats
from metagraph.research.study.statistics.comparison import ConditionComparison, compare_conditions
from metagraph.research.study.statistics.mixed import Mixed, fit_mixed
from metagraph.research.study.statistics.robust import (
    compute_hodges_lehmann,
    estimate_censored_mean,
    find_odd_ones,
    leave_one_out,
)
from metagraph.research.study.statistics.small_samples import Estimate

SLACK = 30.0  # seconds by which a task may be longer than its limit: saving, a question that was open


@dataclass(frozen=True)
class Otherwise:
    """The ratio by another way. name: short, for a figure; how: a sentence."""

    name: str
    ratio: Estimate
    how: str


@dataclass(frozen=True)
class Sensitivity:
    """ways: the ratio computed otherwise. mixed: the model of tasks, on logs. odd: what is unlike the rest,
    in words. correct: condition -> tasks without a mistake, and tasks whose mistakes were counted.
    """

    ways: tuple[Otherwise, ...]
    mixed: Mixed | None
    odd: tuple[str, ...]
    correct: Mapping[str, tuple[int, int]]


def analyse_sensitivity(
    rows: Sequence[AnalysisRow], found: ConditionComparison, sites: Mapping[str, str] | None = None
) -> Sensitivity:
    """Return what the ratio hangs on. rows: the tasks that were done. sites: participant -> where."""
    done = [r for r in rows if r.run.condition in found.pair]
    ways: list[Otherwise] = []
    odd = _odd(done, found)
    if found.paired:
        ways += _robust(found)
    for limit in LIMITS:
        other = (
            compare_conditions([_within(r, limit) for r in done], found.unit, found.pair)
            if limit != AWAY
            else None
        )
        if other is not None:
            name = "no gap taken off" if isinf(limit) else f"gaps of more than {limit:g} s off"
            ways.append(
                Otherwise(name, other.ratio, f"With {name} rather than those of more than {AWAY:g} s.")
            )
    mixed = None
    if found.paired:
        if found.order is not None:
            how = "Both orders weigh the same, however many people had each."
            ways.append(Otherwise("both orders alike", found.order.adjusted, how))
        mixed = fit_mixed_model(done, found, sites or {})
        if mixed is not None:
            how = (
                "A mixed model of all tasks with sitting, practice and task, people differing in "
                "pace and ratio."
            )
            ways.append(Otherwise("mixed model", mixed.effects[BY_HAND].exp(), how))
        ways += _censored(found)
    correct = {
        c: (sum(r.correct for r in scored), len(scored))
        for c in found.pair
        if (scored := [r for r in done if r.run.condition == c and r.score is not None])
    }
    if found.paired:
        ways += _to_correct(done, found)
    return Sensitivity(tuple(ways), mixed, tuple(odd), correct)


def _within(row: AnalysisRow, limit: float) -> AnalysisRow:
    seconds = max(1e-3, measure_seconds_by_limit(row.run.seconds, row.gaps, limit))
    return replace(row, run=replace(row.run, seconds=seconds))


def _odd(rows: Sequence[AnalysisRow], found: ConditionComparison) -> list[str]:
    """Return in words what is unlike the rest."""
    out = []
    for r in rows:
        limit = 60 * r.minutes if r.minutes is not None else None
        if limit is not None and r.run.seconds > limit + SLACK:
            out.append(
                f"{_who(r)} took {r.run.seconds / 60:.1f} minutes, longer than the limit of "
                f"{r.minutes:g}: the "
                "clock or the log is not to be trusted there."
            )
    for condition in found.pair:
        for task in dict.fromkeys(r.run.task for r in rows):
            mine = [r for r in rows if (r.run.condition, r.run.task) == (condition, task)]
            logs = [log(r.run.seconds) for r in mine]
            out += [
                f"{_who(mine[n])} took {mine[n].run.seconds / 60:.1f} minutes, far from what the others took "
                f"(median {float(np.median([r.run.seconds for r in mine])) / 60:.1f})."
                for n in find_odd_ones(logs)
            ]
    people = found.people
    out += [
        f"{people[n].participant}'s ratio, {people[n].ratio:.2f}, is far from the others' "
        f"(median {float(np.median([p.ratio for p in people])):.2f})."
        for n in find_odd_ones(found.logs)
    ]
    return out


def _who(row: AnalysisRow) -> str:
    return f"{row.run.participant}, {row.run.task} ({row.run.condition})"


def _robust(found: ConditionComparison) -> list[Otherwise]:
    logs, people = found.logs, found.people
    out = []
    if len(logs) >= 2:
        how = "The middle of all means of two people's ratios (Hodges and Lehmann), by signed ranks."
        out.append(Otherwise("by ranks", compute_hodges_lehmann(logs).exp(), how))
    without = leave_one_out(logs)
    ends = sorted(range(len(without)), key=lambda n: without[n].value)
    for n in (ends[0], ends[-1]) if ends else ():
        name = people[n].participant
        least = n == ends[0]
        how = f"Of all people the one without whom the ratio is {'smallest' if least else 'largest'}."
        out.append(Otherwise(f"without {name}", without[n].exp(), how))
    odd = set(find_odd_ones(logs))
    rest = [v for n, v in enumerate(logs) if n not in odd]
    if odd and len(rest) > 1:
        how = "Without everybody whose ratio is far from the others'."
        out.append(Otherwise("without odd ratios", stats.mean(rest).exp(), how))
    return out


def _bounded(known: Sequence[tuple[float, bool, bool]]) -> Estimate | None:
    """Return the mean of (log ratio, above is a lower bound, below is one)."""
    exact = [v for v, a, b in known if not a and not b]
    above = [v for v, a, b in known if a and not b]
    below = [v for v, a, b in known if b and not a]
    return estimate_censored_mean(exact, above, below)


def _censored(found: ConditionComparison) -> list[Otherwise]:
    known = [(log(p.ratio), p.above_open, p.below_open) for p in found.people]
    if not any(a or b for _, a, b in known):
        return []
    estimate = _bounded(known)
    if estimate is None:
        return []
    how = "What the time limit ended counts as having taken at least so long (censored)."
    return [Otherwise("time-outs as censored", estimate.exp(), how)]


def _to_correct(rows: Sequence[AnalysisRow], found: ConditionComparison) -> list[Otherwise]:
    """Return the ratio of times to a machine without a mistake; where there were some it took at least the
    time that was worked.
    """
    scored = [r for r in rows if r.score is not None]
    if not scored or all(r.correct for r in scored):
        return []
    again = compare_conditions(scored, found.unit, found.pair)
    if again is None or not again.paired:
        return []
    wrong = {(r.run.participant, r.run.condition) for r in scored if not r.correct or r.run.timed_out}
    above, below = found.pair
    known = [
        (log(p.ratio), (p.participant, above) in wrong, (p.participant, below) in wrong) for p in again.people
    ]
    estimate = _bounded(known)
    if estimate is None:
        return []
    how = (
        "Time to a machine without mistakes: where some were left, it would have taken at least the time "
        "that "
        "was worked. People who left some in both conditions say nothing here."
    )
    return [Otherwise("to a correct machine", estimate.exp(), how)]


BY_HAND, SECOND, PRACTICE = "by hand", "second sitting", "practice"


def fit_mixed_model(
    rows: Sequence[AnalysisRow], found: ConditionComparison, sites: Mapping[str, str]
) -> Mixed | None:
    """Return a model of log seconds of each task by condition, sitting, practice (the mean log of the clips'
    numbers within the condition) and task; people, and people within a condition, deviate, and so do sites
    where there are several. None if the rows do not allow it.
    """
    there = [r for r in rows if r.run.participant not in found.left_out and r.run.seconds > 0]
    people = {r.run.participant for r in there}
    if len(people) < 3 or len({r.run.condition for r in there}) < 2:
        return None
    tasks = sorted({r.run.task for r in there})
    effects: dict[str, list[float]] = {
        "constant": [1.0] * len(there),
        BY_HAND: [float(r.run.condition == found.pair[0]) for r in there],
        SECOND: [float(r.sitting - 1) for r in there],
        **{f"task {t}": [float(r.run.task == t) for r in there] for t in tasks[1:]},
    }
    practised = _practised(there)
    if practised is not None:
        effects[PRACTICE] = practised
    who = [r.run.participant for r in there]
    both = [f"{r.run.participant} {r.run.condition}" for r in there]
    groups: dict[str, list[object]] = {"people": [*who], "people's ratios": [*both]}
    if len({sites.get(w, "") for w in who}) > 1:
        where = [sites.get(w, "") for w in who]
        ratios = [f"{s} {r.run.condition}" for s, r in zip(where, there, strict=True)]
        groups |= {"sites": [*where], "sites' ratios": [*ratios]}
    model = fit_mixed([log(r.run.seconds) for r in there], effects, groups)
    return model if model is not None and BY_HAND in model.effects else None


def _practised(rows: Sequence[AnalysisRow]) -> list[float] | None:
    """Return for each row the mean log of its clips' numbers, those of tasks before in the condition counted
    on; None if nobody knows how many clips there were.
    """
    if any(r.clips < 1 for r in rows):
        return None
    before: dict[tuple[str, str], int] = {}
    at: dict[int, float] = {}
    for n in sorted(range(len(rows)), key=lambda n: rows[n].run.index):
        r = rows[n]
        key = r.run.participant, r.run.condition
        start = before.get(key, 0)
        at[n] = float(np.mean(np.log(np.arange(start + 1, start + r.clips + 1))))
        before[key] = start + r.clips
    return [at[n] for n in range(len(rows))]
