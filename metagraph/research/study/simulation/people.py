"""Simulated participants whose effects are known, to see whether an analysis finds them. They are no people,
and reports of them say so.

How long somebody works on their n-th clip: a base, times the person's own pace, times the condition, times
n^slope for practice, times the order for the second sitting, times chance; all log-normal.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from math import exp, log

import numpy as np

from metagraph.research.study.analysis.reading import AnalysisRow, Data, StudyRating
from metagraph.research.study.plan.order import order_conditions
from metagraph.research.study.scores.tasks import SPENT, TaskRun

CONDITIONS = ("meta", "manual")


@dataclass(frozen=True)
class Truth:
    """What is put in. ratio: seconds by hand beside those with the meta-graph. seconds: for the first clip
    with the meta-graph. learning: slope of log seconds over log of the clip's number. order: seconds of the
    second sitting beside the first. pace, spread: of people, standard deviations of log seconds and of the
    log of their own ratio. chance: of a clip. slips: mean mistakes a task, meta and by hand. sus, tlx: mean
    ratings, meta and by hand; sus_spread, tlx_spread: of people. hidden: times as long where
    clips have numbers instead of names, meta and by hand. Raises ValueError for what cannot be.
    """

    participants: int = 24
    seed: int = 1
    ratio: float = 7.9
    seconds: float = 40.0
    learning: float = -0.25
    order: float = 0.9
    pace: float = 0.25
    spread: float = 0.3
    chance: float = 0.4
    slips: tuple[float, float] = (0.4, 3.0)
    sus: tuple[float, float] = (78.0, 52.0)
    sus_spread: float = 8.0
    tlx: tuple[float, float] = (35.0, 62.0)
    tlx_spread: float = 8.0
    hidden: tuple[float, float] = (1.0, 1.0)

    def __post_init__(self) -> None:
        for name in ("ratio", "seconds", "order"):
            if not 0 < getattr(self, name) < 1e6:
                raise ValueError(f"{name} should be greater than 0, not {getattr(self, name):g}")
        for name in ("pace", "spread", "chance", "sus_spread", "tlx_spread"):
            if not 0 <= getattr(self, name) < 100:
                raise ValueError(
                    f"{name} should not be less than 0, and less than 100, not {getattr(self, name):g}"
                )
        if not all(0 < x < 1000 for x in self.hidden):
            raise ValueError("hidden should be greater than 0, and less than 1000")
        if not 1 <= self.participants <= 1000:
            raise ValueError(f"there are 1 to 1000 participants, not {self.participants}")
        if not -3 <= self.learning <= 3:
            raise ValueError(f"learning should be from -3 to 3, not {self.learning:g}")
        if not 0 <= self.seed <= 0xFFFFFFFF:
            raise ValueError(f"the seed should be a whole number from 0 to {0xFFFFFFFF}, not {self.seed}")


@dataclass(frozen=True)
class SimulatedWork:
    """What a simulated participant does in one task. seconds: clip -> how long. slips: how many mistakes."""

    condition: str
    task: str
    seconds: Mapping[str, float]
    slips: int


@dataclass(frozen=True)
class Simulated:
    """works: in the order they are done. sus, tlx: condition -> score, 0..100 (SUS in steps of 2.5)."""

    participant: str
    works: tuple[SimulatedWork, ...]
    sus: Mapping[str, float]
    tlx: Mapping[str, float]


def simulate_participants(truth: Truth, tasks: Mapping[str, tuple[str, ...]]) -> Iterator[Simulated]:
    """Yield the participants. tasks: id -> its clips."""
    width = max(2, len(str(truth.participants)))
    for number in range(truth.participants):
        rng = np.random.default_rng((truth.seed, number))
        pace, own = rng.normal(0, truth.pace), rng.normal(log(truth.ratio), truth.spread)
        works = []
        for sitting, (condition, order) in enumerate(
            order_conditions(CONDITIONS, tuple(tasks), number, truth.seed)
        ):
            by_hand = condition == "manual"
            n = 0
            for task in order:
                seconds = {}
                for clip in tasks[task]:
                    n += 1
                    at = (
                        log(truth.seconds)
                        + pace
                        + own * by_hand
                        + truth.learning * log(n)
                        + log(truth.order) * sitting
                    )
                    seconds[clip] = exp(at + rng.normal(0, truth.chance))
                works.append(SimulatedWork(condition, task, seconds, int(rng.poisson(truth.slips[by_hand]))))
        liking, load = rng.normal(0, truth.sus_spread), rng.normal(0, truth.tlx_spread)
        sus = {
            c: _steps(m + liking + rng.normal(0, truth.sus_spread), 2.5)
            for c, m in zip(CONDITIONS, truth.sus, strict=True)
        }
        tlx = {
            c: _steps(m + load + rng.normal(0, truth.tlx_spread), 5 / 6)
            for c, m in zip(CONDITIONS, truth.tlx, strict=True)
        }
        yield Simulated(f"P{number + 1:0{width}}", tuple(works), sus, tlx)


def _steps(value: float, step: float) -> float:
    return min(max(round(value / step), 0), round(100 / step)) * step


def simulate_times(truth: Truth, tasks: Mapping[str, tuple[str, ...]]) -> Data:
    """Return the data of simulated participants without any files: times and ratings, no mistakes."""
    rows: list[AnalysisRow] = []
    ratings: list[StudyRating] = []
    for person in simulate_participants(truth, tasks):
        began = person.works[0].condition
        for index, work in enumerate(person.works):
            total = sum(work.seconds.values())
            run = TaskRun(
                person.participant,
                work.condition,
                work.task,
                index,
                total,
                total,
                Counter(),
                0.0,
                len(work.seconds),
                0,
                0,
                work.seconds,
                dict.fromkeys(SPENT, total / len(SPENT)),
                True,
                None,
            )
            rows.append(AnalysisRow(run, 1 if work.condition == began else 2, len(work.seconds), 0.0))
        for name, scores in (("SUS", person.sus), ("NASA-TLX, raw", person.tlx)):
            ratings += [StudyRating(person.participant, name, c, value) for c, value in scores.items()]
    people = tuple(dict.fromkeys(r.run.participant for r in rows))
    return Data(
        "Simulated", CONDITIONS, {t: t for t in tasks}, people, tuple(rows), tuple(ratings), simulated=True
    )
