"""Raters who do not exist, with a known preference: to try a study out, and to see that its report finds what
was put in.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import isfinite
from pathlib import Path
from typing import Any

import numpy as np

from metagraph.research.study.perceive.answers import PageEvent, Sheet, keep_sheet
from metagraph.research.study.perceive.binomial import logistic
from metagraph.research.study.perceive.design import Trial, make_design
from metagraph.research.study.perceive.folder import Perceived, write_folder
from metagraph.research.study.perceive.perceive_data import SIMULATED
from metagraph.research.study.perceive.perceive_plan import PerceivePlan


@dataclass(frozen=True)
class Raters:
    """liked: how much a condition is liked, log odds; choices go by differences of these, ratings by points
    of them. people, items: standard deviations of log odds by which each person's and item's differences
    deviate. left: log odds the left side gains. lapses: the share of answers given without looking. careless:
    the share of people who never look. unfinished: the share who break off.
    """

    liked: Mapping[str, float] = field(default_factory=dict)
    people: float = 0.4
    items: float = 0.3
    left: float = 0.0
    lapses: float = 0.02
    careless: float = 0.0
    unfinished: float = 0.0
    seed: int = 1

    def __post_init__(self) -> None:
        for name in ("people", "items"):
            if not 0 <= getattr(self, name) <= 10:
                raise ValueError(
                    f"{name} should be a deviation of 0 to 10 log odds, not {getattr(self, name):g}"
                )
        for name in ("lapses", "careless", "unfinished"):
            if not 0 <= getattr(self, name) <= 1:
                raise ValueError(f"{name} is a share of 0 to 1, not {getattr(self, name):g}")
        if not all(isfinite(v) and abs(v) <= 20 for v in (*self.liked.values(), self.left)):
            raise ValueError("log odds lie between -20 and 20")


def simulate_raters(study: Perceived, raters: Raters) -> int:
    """Answer a study as raters would, through the same door as real answers; return how many did. Raises
    ValueError for conditions there are not.
    """
    strange = set(raters.liked) - set(study.plan.conditions)
    if strange:
        raise ValueError(f"there is no condition '{sorted(strange)[0]}'")
    rng = np.random.default_rng(raters.seed)
    conditions = [*study.plan.conditions]
    # Of a condition, not of a pair: a person who likes one more does so beside every other one.
    by_item = {
        (i.id, c): rng.normal(0, raters.items / np.sqrt(2)) for i in study.plan.items for c in conditions
    }
    for who, session in study.key.sessions.items():
        own = {c: rng.normal(0, raters.people / np.sqrt(2)) for c in conditions}
        careless, stops = rng.random() < raters.careless, rng.random() < raters.unfinished
        liking = {(i, c): raters.liked.get(c, 0.0) + own[c] + float(by_item[i, c]) for i, c in by_item}
        run = f"{int(rng.integers(1 << 62)):016x}"
        trials = session.trials[: max(1, len(session.trials) // 2)] if stops else session.trials
        events = [PageEvent(0, "begin", agent="nobody")]
        for trial in trials:
            lapse = careless or rng.random() < raters.lapses
            value = _answer(study.plan, trial, liking, raters.left, lapse, rng)
            seconds = round(float(np.exp(rng.normal(0.4, 0.5))), 3)
            replays = int(rng.random() < 0.1)
            events.append(
                PageEvent(
                    len(events),
                    "answer",
                    trial=trial.id,
                    value=value,
                    seconds=seconds,
                    first=seconds,
                    replays=replays,
                )
            )
        if not stops:
            events.append(PageEvent(len(events), "end"))
        keep_sheet(study, Sheet(1, study.key.design, who, run, tuple(events)))
    return len(study.key.sessions)


def _answer(
    plan: PerceivePlan,
    trial: Trial,
    liking: Mapping[tuple[str, str], float],
    left: float,
    lapse: bool,
    rng: np.random.Generator,
) -> Any:
    if trial.right:
        if lapse:
            return "left" if rng.random() < 0.5 else "right"
        if trial.kind == "told":
            return trial.told
        gain = liking[trial.item, trial.a] - liking[trial.item, trial.b] + left
        return "left" if rng.random() < logistic(gain) else "right"
    assert plan.rating is not None
    out = {}
    for q in plan.rating.questions:
        assert q.scale is not None
        points = q.scale.points
        if lapse:
            out[q.id] = int(rng.choice(points))
        elif trial.kind == "told" and trial.told in points:
            out[q.id] = int(trial.told)
        else:
            middle = (points[0] + points[-1]) / 2 + liking[trial.item, trial.a] * q.scale.step
            wanted = middle + float(rng.normal(0, 1)) * q.scale.step
            out[q.id] = min(points, key=lambda p: abs(p - wanted))
    return out


def write_simulated(folder: Path, plan: PerceivePlan, text: bytes, secret: str, raters: Raters) -> Perceived:
    """Write a study without videos and answer it. text: the plan's file. Raises ValueError, FileError."""
    study = write_folder(folder, plan, text, make_design(plan, secret))
    (folder / SIMULATED).write_text("Nobody gave these answers.\n", encoding="utf-8")
    simulate_raters(study, raters)
    return study
