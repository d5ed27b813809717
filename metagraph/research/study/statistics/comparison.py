"""The times of two conditions beside each other: each person counts once, by the mean over their tasks."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import exp, log
from typing import Literal

import numpy as np

from metagraph.research.study.analysis.reading import AnalysisRow
from metagraph.research.study.statistics import small_samples as stats
from metagraph.research.study.statistics.small_samples import Estimate, PeriodOrder, Test

ABOVE, BELOW = "manual", "meta"  # the ratio is of the one to the other
PAIR = ABOVE, BELOW
Unit = Literal["task", "clip"]
_ByTask = Mapping[str, AnalysisRow]


@dataclass(frozen=True, slots=True)
class ParticipantTimes:
    """What one participant took, seconds, geometric mean over the tasks that count. above_first: began with
    ABOVE. above_open, below_open: the time was cut short, by the time limit, so that it would have been
    longer.
    """

    participant: str
    above: float
    below: float
    above_first: bool
    above_open: bool = False
    below_open: bool = False

    @property
    def ratio(self) -> float:
        return self.above / self.below


@dataclass(frozen=True)
class ConditionComparison:
    """Seconds of ABOVE beside BELOW. unit: what they are seconds of. pair: above and below. paired:
    everybody who counts did both; then people are they. means: geometric, by condition. effect: d_z;
    raw_effect: uncorrected. left_out: who does not count here.
    """

    unit: Unit
    paired: bool
    pair: tuple[str, str]
    means: Mapping[str, Estimate]
    ratio: Estimate
    test: Test
    people: tuple[ParticipantTimes, ...] = ()
    effect: Estimate | None = None
    raw_effect: float | None = None
    order: PeriodOrder | None = None
    cautions: tuple[str, ...] = ()
    left_out: tuple[str, ...] = ()

    @property
    def logs(self) -> list[float]:
        """Return the logs of the people's ratios."""
        return [log(p.ratio) for p in self.people]


def compare_conditions(
    rows: Sequence[AnalysisRow], unit: Unit | None = None, pair: tuple[str, str] = PAIR
) -> ConditionComparison | None:
    """Return the comparison of two conditions; None if one of them was never done. unit: as the study is
    planned; None as most people did: one person with other tasks in each condition does not change it for the
    others.
    """
    by: dict[str, dict[str, dict[str, AnalysisRow]]] = {}  # participant -> condition -> task
    for r in rows:
        if r.run.condition in pair:
            by.setdefault(r.run.participant, {}).setdefault(r.run.condition, {})[r.run.task] = r
    above, below = pair
    both = {p: c for p, c in by.items() if above in c and below in c}
    if not both:
        return _unpaired(by, unit, pair)
    alike = {p for p, c in both.items() if c[above].keys() & c[below].keys()}
    if unit is None:
        unit = "task" if 2 * len(alike) >= len(both) else "clip"
    unlike = sorted(both.keys() - alike) if unit == "task" else []
    if len(unlike) == len(both):
        return None
    people = [_person(p, c, unit, pair) for p, c in both.items() if p not in unlike]
    a, b = [p.above for p in people], [p.below for p in people]
    log_a, log_b = stats.take_logs(a), stats.take_logs(b)
    ratio = stats.estimate_ratio(a, b)
    effect = stats.compute_effect_size(log_a, log_b)
    raw = effect.value / stats.compute_hedges_correction(len(people) - 1) if effect is not None else None
    began = {first: [(p.above, p.below) for p in people if p.above_first is first] for first in (True, False)}
    cautions = stats.list_ratio_cautions(ratio, raw)
    if unlike:
        cautions.append(
            f"{_names(unlike)} finished other tasks in the one condition than in the other and "
            f"{'is' if len(unlike) == 1 else 'are'} left out of the ratio, which compares the same tasks."
        )
    alone = sorted(by.keys() - both.keys())
    if alone:
        cautions.append(
            f"{len(alone)} did only one of the two and {'is' if len(alone) == 1 else 'are'} left out of the "
            "ratio."
        )
    there = [r for r in rows if r.run.condition in pair]
    timed_out = sum(1 for r in there if r.run.timed_out)
    if timed_out:
        cautions.append(
            f"{timed_out} of {len(there)} tasks were ended by the time limit: their true times are longer "
            "than those used here."
        )
    order = stats.order_effects(began[True], began[False])
    if order is None and len(people) > 1:
        cautions.append(
            "Fewer than 2 people began with one of the conditions, so practice cannot be told from the "
            "condition."
        )
    return ConditionComparison(
        unit,
        True,
        pair,
        {above: stats.compute_geometric_mean(a), below: stats.compute_geometric_mean(b)},
        ratio,
        stats.compute_paired_t(log_a, log_b),
        tuple(people),
        effect,
        raw,
        order,
        tuple(cautions),
        (*unlike, *alone),
    )


def _person(
    name: str, conditions: Mapping[str, _ByTask], unit: Unit, pair: tuple[str, str]
) -> ParticipantTimes:
    tasks = conditions[pair[0]].keys() & conditions[pair[1]].keys() if unit == "task" else None
    first = min((r for c in conditions.values() for r in c.values()), key=lambda r: r.run.index)
    above, below = ([r for t, r in conditions[c].items() if tasks is None or t in tasks] for c in pair)
    return ParticipantTimes(
        name,
        mean_seconds(above, unit),
        mean_seconds(below, unit),
        first.run.condition == pair[0],
        any(r.run.timed_out for r in above),
        any(r.run.timed_out for r in below),
    )


def mean_seconds(rows: Sequence[AnalysisRow], unit: Unit) -> float:
    """Return the geometric mean of seconds, a task or a clip."""
    each = sorted(rows, key=lambda r: r.run.task)
    return exp(np.mean([log(r.run.seconds / (max(1, r.clips) if unit == "clip" else 1)) for r in each]))


def _unpaired(
    by: Mapping[str, Mapping[str, _ByTask]], unit: Unit | None, pair: tuple[str, str]
) -> ConditionComparison | None:
    above, below = pair
    groups = {c: {p: found[c] for p, found in by.items() if c in found} for c in pair}
    if not all(groups.values()):
        return None
    tasks = {c: {t for rows in group.values() for t in rows} for c, group in groups.items()}
    common = tasks[above] & tasks[below]
    if unit is None:
        unit = "task" if tasks[above] == tasks[below] else "clip"
    used = {
        c: {
            p: [r for t, r in rows.items() if unit == "clip" or t in common]
            for p, rows in group.items()
            if unit == "clip" or rows.keys() & common
        }
        for c, group in groups.items()
    }
    if not all(used.values()):
        return None
    took = {c: [mean_seconds(rows, unit) for rows in group.values()] for c, group in used.items()}
    found, test = stats.compute_welch(stats.take_logs(took[above]), stats.take_logs(took[below]))
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
    left_out = sorted(p for c in groups for p in groups[c].keys() - used[c].keys())
    if left_out:
        words.append(f"{_names(left_out)} did no task that the others did, too, and does not count here.")
    means = {c: stats.compute_geometric_mean(values) for c, values in took.items()}
    return ConditionComparison(
        unit, False, pair, means, ratio, test, cautions=tuple(words), left_out=tuple(dict.fromkeys(left_out))
    )


def _names(people: Sequence[str]) -> str:
    few = ", ".join(people[:6])
    return few if len(people) <= 6 else f"{few} and {len(people) - 6} more"
