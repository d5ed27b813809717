"""A study's folder as data: what every participant did and said, and how right it was; and what of it is
missing, in words.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from metagraph.errors import FileError
from metagraph.formats.store import open_project, read_project
from metagraph.graph.model import Layer, Project
from metagraph.study.klm import USUAL, Times, predicted
from metagraph.study.log import Log, TaskRun, read
from metagraph.study.normal_machine import NormalMachine, normal
from metagraph.study.questionnaires import BUILT_IN, sus_score, tlx_raw, tlx_weighted
from metagraph.study.score import TOLERANCE, Score, score
from metagraph.study.score_jumps import with_jumps
from metagraph.study.study_plan import Study, read_study
from metagraph.study.tasks import Answer

Progress = Callable[[int, int], None]
SCORED: Mapping[str, tuple[str, Callable[[Mapping[str, Any]], float]]] = {
    "sus": ("SUS", sus_score),
    "tlx": ("NASA-TLX, raw", tlx_raw),
    "tlx_weighted": ("NASA-TLX, weighted", tlx_weighted),
}
TOTALS = frozenset(name for name, _ in SCORED.values())  # all from 0 to 100


@dataclass(frozen=True)
class AnalysisRow:
    """A task somebody did. sitting: 1 for the condition they began with, 2 for the next. clips: of the task,
    0 where nobody knows. predicted: seconds by the keystroke-level model. score: None without a reference or
    a project.
    """

    run: TaskRun
    sitting: int
    clips: int
    predicted: float
    score: Score | None = None

    @property
    def done(self) -> bool:
        """Whether its time can be used: it was worked on until it was done, or until there was no time
        left.
        """
        return (self.run.finished or self.run.timed_out) and self.run.seconds > 0


@dataclass(frozen=True, slots=True)
class Rating:
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
    order they were done, by participant. missing: what is not there or was left out, in words.
    """

    title: str
    conditions: tuple[str, ...]
    tasks: Mapping[str, str]
    participants: tuple[str, ...]
    rows: tuple[AnalysisRow, ...] = ()
    ratings: tuple[Rating, ...] = ()
    answers: tuple[Answer, ...] = ()
    missing: tuple[str, ...] = ()
    tolerance: float = TOLERANCE
    simulated: bool = False


def prediction(run: TaskRun, times: Times = USUAL) -> float:
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
    return predicted(counts, times)


def collect(folder: str | Path, jumps: bool = True, progress: Progress | None = None) -> Data:
    """Read a study's folder, or study file, and what lies beside it. jumps: judge them, which needs the
    references' clips. Raises FileError where the study file cannot be read; whatever else is wrong is told in
    `missing`.
    """
    study = read_study(folder)
    plan = study.plan
    missing: list[str] = []
    references = _References(study, jumps, missing)
    rows: list[AnalysisRow] = []
    answers: list[Answer] = []
    simulated = False
    for n, participant in enumerate(plan.ids):
        if progress is not None:
            progress(n, len(plan.ids))
        log = _log(study, participant, missing)
        if log is None:
            continue
        simulated |= any(e["type"] == "begin" and e.get("simulated") for e in log.events)
        rows += _rows(study, log, references, missing)
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
    ratings = _ratings(study, answers, missing)
    return Data(
        plan.title,
        tuple(plan.conditions),
        {t.id: t.name for t in plan.tasks},
        plan.ids,
        tuple(rows),
        ratings,
        tuple(answers),
        tuple(dict.fromkeys(missing)),
        plan.tolerance,
        simulated,
    )


def _log(study: Study, participant: str, missing: list[str]) -> Log | None:
    path = study.log(participant)
    if not path.is_file():
        missing.append(f"{participant}: has not begun.")
        return None
    try:
        log = read(path)
    except FileError as error:
        missing.append(f"{participant}: {error}")
        return None
    if log.torn:
        missing.append(f"{participant}: the last line of the log was not written whole; it is left out.")
    missing += [f"{participant}: {words}." for words in log.problems]
    digests = {str(e["study"]) for e in log.events if e["type"] in ("begin", "resumed") and e.get("study")}
    if digests - {study.digest}:
        missing.append(f"{participant}: worked with another version of the study file.")
    if not log.complete:
        missing.append(f"{participant}: has not come to the end.")
    return log


def _rows(study: Study, log: Log, references: _References, missing: list[str]) -> list[AnalysisRow]:
    out: list[AnalysisRow] = []
    order: list[str] = []
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
        row = AnalysisRow(run, order.index(run.condition) + 1, clips, prediction(run, study.plan.times))
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
            )
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
            self.known[task] = project, normal(project)
        return self.known[task]

    def scored(self, folder: Path, run: TaskRun, who: str) -> Score | None:
        """Return how right a project is, None where that cannot be told."""
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
        attempt = normal(project, run.condition == "manual")
        found = score(attempt, right[1], self.study.plan.tolerance)
        return with_jumps(found, attempt, right[0]) if self.jumps else found


def _ratings(study: Study, answers: Sequence[Answer], missing: list[str]) -> tuple[Rating, ...]:
    """Return the questionnaires' scores, and of other questionnaires the items answered with numbers."""
    sheets: dict[tuple[str, str, str | None, int], dict[str, Any]] = {}
    for a in answers:
        sheets.setdefault((a.participant, a.questionnaire, a.condition, a.index), {})[a.item] = a.value
    titles = {q.id: {i.id: i.title or i.text for i in q.items} for q in study.plan.questions()}
    out: list[Rating] = []
    for (who, sheet, condition, _), values in sheets.items():
        if sheet in SCORED:
            name, formula = SCORED[sheet]
            try:
                out.append(Rating(who, name, condition, formula(values)))
            except ValueError as error:
                missing.append(f"{who}: {BUILT_IN[sheet].title} cannot be scored: {error}.")
            continue
        for item, value in values.items():
            if isinstance(value, int | float) and not isinstance(value, bool):
                out.append(Rating(who, titles.get(sheet, {}).get(item, item), condition, float(value)))
    return tuple(out)
