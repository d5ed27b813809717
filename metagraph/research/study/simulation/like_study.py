"""Simulated participants of a study of one's own: its tasks, clips, references, orders, limits and
questionnaires, and people who do not exist, so that its report can be seen before anybody takes part.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from itertools import takewhile
from math import exp, log
from os.path import relpath
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
import yaml

from metagraph.errors import FileError
from metagraph.formats.atomic import write_atomically
from metagraph.formats.clips import digest
from metagraph.formats.store import read_project, save_project
from metagraph.graph.model import Project
from metagraph.research.study.plan.freeze import study_manifest
from metagraph.research.study.questionnaires import SUS, TLX, TLX_PAIRS, TLX_SCALES
from metagraph.research.study.simulation.files import _Sitting
from metagraph.research.study.simulation.people import Simulated, SimulatedWork, Truth
from metagraph.research.study.simulation.work import draw_every_connection, make_slips
from metagraph.research.study.sitting import Phase, list_phases
from metagraph.research.study.study_plan import FILE, Study, read_study


def write_like(study: Study, folder: Path, truth: Truth) -> Study:
    """Write a copy of a study with simulated participants, as many as it has, into a folder; its clips and
    references stay where they are. Raises FileError, also where there is something in the folder already.
    """
    if folder.exists() and any(folder.iterdir()):
        raise FileError(
            folder, "is not empty", "on writing the simulated study", "Give a folder that is not there yet."
        )
    write_atomically(folder / FILE, _copy(study, folder.resolve()).encode())
    made = read_study(folder)
    right: dict[tuple[str, str], Project] = {}
    for task in made.plan.tasks:
        path = made.reference(task.id)
        project = (
            _moved(read_project(path), path.parent, folder.resolve())
            if path is not None
            else Project(task.id)
        )
        right[task.id, "meta"], right[task.id, "manual"] = project, draw_every_connection(project)
    digests = study_manifest(made)
    for number, person in enumerate(_people(made, truth)):
        _LikeSitting(made, person, right, truth, number).write(digests)
    return made


def _copy(study: Study, folder: Path) -> str:
    """Return the study file with paths from the folder; a concealed order is drawn by number."""
    data: dict[str, Any] = msgspec.to_builtins(study.plan)
    plain = msgspec.to_builtins(type(study.plan)(1, "", 1, ("meta",), study.plan.tasks))
    data = {
        k: v
        for k, v in data.items()
        if k in ("study", "participants", "conditions", "tasks") or v != plain[k]
    }
    if data.get("order") == "concealed":
        del data["order"]

    def moved(named: str | list[str]) -> str | list[str]:
        if isinstance(named, str):
            return Path(relpath(study.folder / named, folder)).as_posix()
        return [Path(relpath(study.folder / n, folder)).as_posix() for n in named]

    for part in (*data["tasks"], *data.get("training", ())):
        part["clips"] = moved(part["clips"])
        if part.get("reference"):
            part["reference"] = moved(part["reference"])
    data["title"] = f"{study.plan.title} (simulated)"
    said = "# Nobody took part in this study: it was simulated.\n"
    return said + yaml.safe_dump(data, sort_keys=False, allow_unicode=True, width=1000)


def _moved(project: Project, before: Path, after: Path) -> Project:
    """Return a project with its paths from another folder."""
    clips = {
        i: replace(c, path=Path(relpath(before / c.path, after)).as_posix()) for i, c in project.clips.items()
    }
    return replace(project, clips=clips, character=None)


def _people(study: Study, truth: Truth) -> Iterator[Simulated]:
    """Yield the study's participants, in its orders, by the model of `simulated`."""
    names = {t.id: tuple(p.stem for p in study.clips(t.clips)) for t in study.plan.tasks}
    for number, who in enumerate(study.plan.ids):
        rng = np.random.default_rng((truth.seed, number))
        pace, own = rng.normal(0, truth.pace), rng.normal(log(truth.ratio), truth.spread)
        works: list[SimulatedWork] = []
        done: dict[str, int] = {}
        order: list[str] = []
        for condition, tasks in study.blocks(who):
            if condition not in order:
                order.append(condition)
            by_hand = condition == "manual"
            for task in tasks:
                seconds = {}
                slower = log(truth.hidden[by_hand]) if study.hides(who, task) else 0.0
                for clip in names[task]:
                    done[condition] = done.get(condition, 0) + 1
                    at = log(truth.seconds) + pace + own * by_hand + truth.learning * log(done[condition])
                    at += log(truth.order) * order.index(condition) + slower
                    seconds[clip] = exp(at + rng.normal(0, truth.chance))
                works.append(SimulatedWork(condition, task, seconds, int(rng.poisson(truth.slips[by_hand]))))
        liking, load = rng.normal(0, truth.sus_spread), rng.normal(0, truth.tlx_spread)
        sus = {c: _within(m + liking, 2.5) for c, m in zip(("meta", "manual"), truth.sus, strict=True)}
        tlx = {c: _within(m + load, 5 / 6) for c, m in zip(("meta", "manual"), truth.tlx, strict=True)}
        yield Simulated(who, tuple(works), sus, tlx)


def _within(score: float, step: float) -> float:
    return min(100.0, max(0.0, step * round(score / step)))


class _LikeSitting(_Sitting):
    """A sitting of any study: limits end tasks, and questionnaires of one's own are answered by chance."""

    def write(self, digests: Mapping[str, str]) -> None:
        works = {(w.condition, w.task): w for w in self.person.works}
        about: dict[str, Any] = {"version": "", "machine": {}, "simulated": True}
        self.add("begin", participant=self.person.participant, study=self.study.digest, **about)
        self.add("frozen", digests=dict(digests))
        for phase in list_phases(self.study, self.person.participant):
            why = "done"
            self.add("phase", 1.0, state="begin", **phase.fields)
            if phase.name == "task":
                work = works[phase.condition or "", phase.task or ""]
                limit = 60 * phase.minutes if phase.minutes is not None else float("inf")
                kept = _until(work, limit)
                self._work(phase, kept)
                if len(kept.seconds) < len(work.seconds):
                    why = "time"
                    self.mono += max(0.0, min(50.0, limit - sum(kept.seconds.values())))
            elif phase.questionnaire is not None:
                for item, value in self._said(phase):
                    self.add("answer", 4.0, questionnaire=phase.questionnaire.id, item=item, value=value)
            self.add("phase", 0.0 if phase.name == "task" else 2.0, state="end", why=why, **phase.fields)
        self.add("end")
        lines = b"".join(msgspec.json.encode(e) + b"\n" for e in self.events)
        write_atomically(self.study.log(self.person.participant), lines)

    def _work(self, phase: Phase, work: SimulatedWork) -> None:
        for clip, seconds in work.seconds.items():
            self._clip(clip, seconds, work.condition)
        path = self.study.data(self.person.participant) / phase.file
        by_hand = work.condition == "manual"
        project = make_slips(self.right[work.task, work.condition], by_hand, work.slips, self.rng)
        save_project(project, path, self.study.folder / FILE)
        about: dict[str, Any] = {"condition": work.condition, "task": work.task}
        self.add("artefact", path=phase.file, digest=digest(path), why="done", **about)

    def _said(self, phase: Phase) -> Iterator[tuple[str, Any]]:
        sheet = phase.questionnaire
        assert sheet is not None
        if sheet.id in (SUS.id, TLX.id) and phase.condition is not None:
            yield from self._answers(phase)
            return
        for item in sheet.items:
            if item.scale is not None:
                yield item.id, int(self.rng.choice(item.scale.points))
            elif item.choices:
                pair = next((p for p in TLX_PAIRS if "-".join(p) == item.id), None)
                titles = [TLX_SCALES[name][0] for name in pair] if pair is not None else list(item.choices)
                yield item.id, str(self.rng.choice(titles))


def _until(work: SimulatedWork, limit: float) -> SimulatedWork:
    """Return what of a task is done before its limit."""
    sums = np.cumsum(list(work.seconds.values()))
    there = list(takewhile(lambda n: sums[n] <= limit, range(len(sums))))
    kept = {clip: s for n, (clip, s) in enumerate(work.seconds.items()) if n in there}
    return replace(work, seconds=kept)
