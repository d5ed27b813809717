"""A study's folder as data: what every participant did and said, and how right it was; and what of it is
missing, in words.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from itertools import pairwise
from pathlib import Path
from typing import Any, Literal

from metagraph.errors import FileError
from metagraph.formats.store import open_project, read_project
from metagraph.graph.model import Layer, Project
from metagraph.research.study.logs.engine_import import list_engine_logs
from metagraph.research.study.logs.gaps import LogGap, find_log_gaps
from metagraph.research.study.logs.log import Standing, StudyLog, TaskRun, read_log
from metagraph.research.study.logs.withdrawal import read_deleted
from metagraph.research.study.machines.klm import USUAL, OperatorTimes, predict_seconds
from metagraph.research.study.machines.normal_machine import NormalMachine, normalize_machines
from metagraph.research.study.plan.freeze import describe_study_differences, find_changed_names, list_people
from metagraph.research.study.plan.hidden_names import reveal_names
from metagraph.research.study.questionnaires import (
    BUILT_IN,
    compute_sus_score,
    compute_tlx_raw,
    compute_weighted_tlx,
)
from metagraph.research.study.scores.jumps import with_jumps
from metagraph.research.study.scores.machines import TOLERANCE, Score, score
from metagraph.research.study.scores.tasks import ItemAnswer
from metagraph.research.study.scores.uses import uses
from metagraph.research.study.study_plan import Study, read_study

Progress = Callable[[int, int], None]
SCORED: Mapping[str, tuple[str, Callable[[Mapping[str, Any]], float]]] = {
    "sus": ("SUS", compute_sus_score),
    "tlx": ("NASA-TLX, raw", compute_tlx_raw),
    "tlx_weighted": ("NASA-TLX, weighted", compute_weighted_tlx),
}
AFTER = 1000  # what was done in an engine comes after a sitting's phases
TOTALS = frozenset(name for name, _ in SCORED.values())  # all from 0 to 100


@dataclass(frozen=True)
class AnalysisRow:
    """A task somebody did. sitting: 1 for the condition they began with, 2 for the next. clips: of the task,
    0 if nobody knows. predicted: seconds by the keystroke-level model. score: None without a reference or a
    project. gaps: of the log, longer ones. minutes: the task's limit. uses: seconds by what they went into.
    """

    run: TaskRun
    sitting: int
    clips: int
    predicted: float
    score: Score | None = None
    gaps: tuple[LogGap, ...] = ()
    minutes: float | None = None
    uses: Mapping[str, float] = field(default_factory=dict)

    @property
    def done(self) -> bool:
        """Whether its time can be used: it was worked on until it was done, or until there was no time
        left.
        """
        return (self.run.finished or self.run.timed_out) and self.run.seconds > 0

    @property
    def correct(self) -> bool:
        """Whether it was compared with a reference, and has no mistake; jumps, which are the clips',
        aside.
        """
        return self.score is not None and all(m.what == "jump" for m in self.score.mistakes)


@dataclass(frozen=True, slots=True)
class StudyRating:
    """What a questionnaire amounts to, or what was answered to one number item of others. condition: None for
    the whole study.
    """

    participant: str
    measure: str
    condition: str | None
    value: float


@dataclass(frozen=True)
class Data:
    """title, conditions and tasks (id -> title): of the plan. participants: all that take part. rows: in the
    order they were done, by participant. missing: what is not there or was left out, in words. unit: what the
    plan lets be compared, None if nobody knows. people: participant -> how far they came and what they were
    to begin with. sites: participant -> where, of several. smallest: the smallest ratio that matters.
    """

    title: str
    conditions: tuple[str, ...]
    tasks: Mapping[str, str]
    participants: tuple[str, ...]
    rows: tuple[AnalysisRow, ...] = ()
    ratings: tuple[StudyRating, ...] = ()
    answers: tuple[ItemAnswer, ...] = ()
    missing: tuple[str, ...] = ()
    tolerance: float = TOLERANCE
    simulated: bool = False
    unit: Literal["task", "clip"] | None = None
    people: Mapping[str, StudyParticipant] = field(default_factory=dict)
    sites: Mapping[str, str] = field(default_factory=dict)
    smallest: float | None = None


@dataclass(frozen=True, slots=True)
class StudyParticipant:
    """How a participant took part. first: the condition the plan gives them first."""

    standing: Standing
    first: str


def predict_task_seconds(run: TaskRun, times: OperatorTimes = USUAL) -> float:
    """Return the seconds the keystroke-level model predicts for a task: its operators, a drag as a pointing
    besides its two button operators, and a thought for every edit and for every step back.
    """
    ops = run.operators
    counts = {
        "K": ops["K"],
        "P": ops["P"] + ops["D"],
        "B": ops["B"],
        "H": ops["H"],
        "M": run.edits + run.undos,
    }
    return predict_seconds(counts, times)


def collect_study(folder: str | Path, jumps: bool = True, progress: Progress | None = None) -> Data:
    """Read a study's folder, or study file, and what lies beside it. jumps: judge them, which needs the
    references' clips. Raises FileError if the study file cannot be read; whatever else is wrong is given in
    `missing`.
    """
    study = read_study(folder)
    plan = study.plan
    missing: list[str] = []
    references = _References(study, jumps, missing)
    rows: list[AnalysisRow] = []
    answers: list[ItemAnswer] = []
    people: dict[str, StudyParticipant] = {}
    orders = _orders(study)
    worked: dict[str, Mapping[str, str] | None] = {}
    gone = read_deleted(study)
    simulated = False
    for n, participant in enumerate(plan.ids):
        if progress is not None:
            progress(n, len(plan.ids))
        first = orders.get(participant, (("", ()),))[0][0]
        if participant in gone and not study.log(participant).is_file():
            missing.append(f"{participant}: withdrew, and all data was deleted.")
            people[participant] = StudyParticipant("deleted", first)
            continue
        log = _log(study, participant, missing)
        people[participant] = StudyParticipant(log.standing if log is not None else "not begun", first)
        if log is None or log.standing == "withdrawn":
            continue
        if log.tasks():
            worked[participant] = log.frozen
        simulated |= any(e["type"] == "begin" and e.get("simulated") for e in log.events)
        rows += _rows(study, log, references, missing)
        for path in list_engine_logs(study, participant):
            rows += _engine_rows(study, path, participant, missing)
        answers += log.answers()
    data = study.folder / "data"
    strangers = (
        sorted(p.name for p in data.iterdir() if p.is_dir() and p.name not in plan.ids)
        if data.is_dir()
        else []
    )
    missing += [
        f"{name}: a folder of data, but nobody of that name takes part; it is left out." for name in strangers
    ]
    missing += describe_study_differences(study, worked, jumps)
    ratings = _ratings(study, answers, missing)
    return Data(
        plan.title,
        tuple(dict.fromkeys((*plan.conditions, *(r.run.condition for r in rows)))),
        {t.id: t.name for t in plan.tasks},
        plan.ids,
        tuple(rows),
        ratings,
        tuple(answers),
        tuple(dict.fromkeys(missing)),
        plan.tolerance,
        simulated,
        _unit(study),
        people,
        {},
        plan.smallest,
    )


def _orders(study: Study) -> dict[str, tuple[tuple[str, tuple[str, ...]], ...]]:
    """Return everybody's conditions with their tasks; not of those for whom none was drawn yet."""
    out = {}
    for who in study.plan.ids:
        with suppress(ValueError):
            out[who] = study.blocks(who)
    return out


def _unit(study: Study) -> Literal["task", "clip"] | None:
    """Return what can be compared: tasks, unless the plan gives nobody the same one in two conditions. None
    if it does not say.
    """
    orders = _orders(study)
    for blocks in orders.values():
        seen: set[str] = set()
        for _, tasks in blocks:
            if seen & set(tasks):
                return "task"
            seen |= set(tasks)
    groups = all(len({c for c, _ in blocks}) == 1 for blocks in orders.values())
    return None if groups else "clip"


def _log(study: Study, participant: str, missing: list[str]) -> StudyLog | None:
    path = study.log(participant)
    if not path.is_file():
        missing.append(f"{participant}: has not begun.")
        return None
    try:
        log = read_log(path)
    except FileError as error:
        missing.append(f"{participant}: {error}")
        return None
    if log.torn:
        missing.append(f"{participant}: the last line of the log was not written whole; it is left out.")
    missing += [f"{participant}: {words}." for words in log.problems]
    digests = {str(e["study"]) for e in log.events if e["type"] in ("begin", "resumed") and e.get("study")}
    if digests - {study.digest}:
        missing.append(f"{participant}: worked with another version of the study file.")
    told = [e["digests"] for e in log.events if e["type"] == "frozen" and isinstance(e.get("digests"), dict)]
    for one, other in pairwise(told):
        names = find_changed_names(one, other)
        if names:
            missing.append(f"{participant}: {list_people(names)} changed between two parts of the sitting.")
    if log.standing == "withdrawn":
        missing.append(f"{participant}: withdrew; their data is left out.")
    elif log.standing == "declined":
        missing.append(f"{participant}: declined to take part.")
    elif not log.complete:
        missing.append(f"{participant}: has not come to the end.")
    return log


def _rows(study: Study, log: StudyLog, references: _References, missing: list[str]) -> list[AnalysisRow]:
    out: list[AnalysisRow] = []
    order: list[str] = []
    found_gaps, found_uses = find_log_gaps(log.events), uses(log.events)
    for run in log.tasks():
        who = f"{log.participant}, {run.task} ({run.condition})"
        if run.condition not in order:
            order.append(run.condition)
        try:
            task = study.plan.task(run.task)
        except KeyError:
            missing.append(f"{who}: the study has no such task; it is left out.")
            continue
        try:
            clips = len(study.clips(task.clips))
        except FileError:
            clips = len(run.per_clip)
        row = AnalysisRow(
            run, order.index(run.condition) + 1, clips, predict_task_seconds(run, study.plan.times)
        )
        if run.timed_out:
            missing.append(f"{who}: was ended by the time limit; the time it would have taken is not known.")
        elif not row.done:
            missing.append(f"{who}: was not finished; its time is left out.")
        out.append(
            AnalysisRow(
                run,
                row.sitting,
                clips,
                row.predicted,
                references.scored(log.path.parent, run, who) if row.done else None,
                found_gaps.get(run.index, ()),
                task.minutes,
                found_uses.get(run.index, {}),
            )
        )
    return out


def _engine_rows(study: Study, path: Path, participant: str, missing: list[str]) -> list[AnalysisRow]:
    """Return the tasks done in an engine; nobody counts mistakes there."""
    try:
        log = read_log(path)
    except FileError as error:
        missing.append(f"{participant}: {error}")
        return []
    missing += [f"{participant}, {path.stem}: {words}." for words in log.problems]
    known, breaks = {t.id: t for t in study.plan.tasks}, find_log_gaps(log.events)
    out = []
    for run in log.tasks():
        if run.task not in known:
            missing.append(
                f"{participant}, {run.task} ({run.condition}): the study has no such task; it is left out."
            )
            continue
        named = replace(run, participant=participant, index=AFTER + run.index)
        with suppress(FileError):
            clips = len(study.clips(known[run.task].clips))
            out.append(
                AnalysisRow(named, 3, clips, 0.0, None, breaks.get(run.index, ()), known[run.task].minutes)
            )
    return out


@dataclass
class _References:
    """The right answers, each read once."""

    study: Study
    jumps: bool
    missing: list[str]
    known: dict[str, tuple[Project, Mapping[Layer, NormalMachine]] | None] = field(default_factory=dict)

    def of(self, task: str) -> tuple[Project, Mapping[Layer, NormalMachine]] | None:
        if task not in self.known:
            path = self.study.reference(task)
            self.known[task] = None
            if path is None:
                self.missing.append(f"{task}: has no reference, so mistakes are not counted.")
                return None
            try:
                project = open_project(path).project if self.jumps else read_project(path)
            except FileError as error:
                self.missing.append(f"{task}: its reference cannot be used: {error}")
                return None
            self.known[task] = project, normalize_machines(project)
        return self.known[task]

    def scored(self, folder: Path, run: TaskRun, who: str) -> Score | None:
        """Return how right a project is, None if that cannot be told."""
        right = self.of(run.task)
        if right is None:
            return None
        if run.artefact is None:
            self.missing.append(f"{who}: kept no project, so its mistakes are not counted.")
            return None
        path = folder / Path(run.artefact).name
        try:
            project = read_project(path)
            if run.digest is not None and hashlib.sha256(path.read_bytes()).hexdigest() != run.digest:
                self.missing.append(f"{who}: its project was changed after the sitting.")
        except (FileError, OSError) as error:
            self.missing.append(f"{who}: its project cannot be used: {error}")
            return None
        if run.names == "hidden":
            with suppress(FileError):
                project = reveal_names(
                    project, self.study.make_clip_numbers(run.participant, run.condition, run.task)
                )
        attempt = normalize_machines(project, run.condition == "manual")
        found = score(attempt, right[1], self.study.plan.tolerance)
        return with_jumps(found, attempt, right[0]) if self.jumps else found


def _ratings(study: Study, answers: Sequence[ItemAnswer], missing: list[str]) -> tuple[StudyRating, ...]:
    """Return the questionnaires' scores, and of other questionnaires the items answered with numbers."""
    sheets: dict[tuple[str, str, str | None, int], dict[str, Any]] = {}
    for a in answers:
        sheets.setdefault((a.participant, a.questionnaire, a.condition, a.index), {})[a.item] = a.value
    titles = {q.id: {i.id: i.title or i.text for i in q.items} for q in study.plan.questions()}
    out: list[StudyRating] = []
    for (who, sheet, condition, _), values in sheets.items():
        if sheet in SCORED:
            name, formula = SCORED[sheet]
            try:
                out.append(StudyRating(who, name, condition, formula(values)))
            except ValueError as error:
                missing.append(f"{who}: {BUILT_IN[sheet].title} cannot be scored: {error}.")
            continue
        for item, value in values.items():
            if isinstance(value, int | float) and not isinstance(value, bool):
                out.append(StudyRating(who, titles.get(sheet, {}).get(item, item), condition, float(value)))
    return tuple(out)
