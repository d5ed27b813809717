"""A sitting: the phases one participant goes through. Where it stands follows from the log alone, so that it
goes on after any crash.
"""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal

from metagraph.common.lab_streaming import LabStreamError
from metagraph.errors import FileError
from metagraph.research.study.logs.log import Event, StudyLog, Writer, read_log
from metagraph.research.study.logs.lsl_markers import open_marker_outlet
from metagraph.research.study.plan.allocation import allocate
from metagraph.research.study.questionnaires import Questionnaire
from metagraph.research.study.scores.tasks import list_event_steps
from metagraph.research.study.study_plan import CONDITION_TITLES, Study

PhaseName = Literal["consent", "instructions", "training", "task", "questionnaire", "break", "end"]
WORK: tuple[PhaseName, ...] = ("training", "task")  # phases with a project in them


@dataclass(frozen=True)
class Phase:
    """index: its place in the sitting. condition, task: ids, where it is about one. minutes: the limit, of a
    break how long it should be. clips: of the work, as the plan names them. names: how
    a task's clips are called, "" where the plan says nothing of it.
    """

    index: int
    name: PhaseName
    title: str
    text: str = ""
    condition: str | None = None
    task: str | None = None
    minutes: float | None = None
    questionnaire: Questionnaire | None = None
    clips: str | tuple[str, ...] = ()
    names: Literal["", "shown", "hidden"] = ""

    @property
    def works(self) -> bool:
        """Whether something is made in it."""
        return self.name in WORK

    @property
    def fields(self) -> dict[str, Any]:
        """Return what the log says of it."""
        out: dict[str, Any] = {"name": self.name, "index": self.index}
        if self.condition is not None:
            out["condition"] = self.condition
        if self.task is not None:
            out["task"] = self.task
        if self.questionnaire is not None:
            out["questionnaire"] = self.questionnaire.id
        if self.names:
            out["names"] = self.names
        return out

    @property
    def file(self) -> str:
        """Return what the project made in it is called, in the participant's folder."""
        return f"{self.index:02d}-{self.task or 'training'}-{self.condition}.metagraph.yaml"


@dataclass(frozen=True)
class Where:
    """phase: the one that runs, or comes next; None at the end. begun: it runs. elapsed: seconds it has
    lasted, without pauses. answers: given in it. artefact: what was made in it is there already, and only its
    end was not told.
    """

    phase: Phase | None
    begun: bool = False
    elapsed: float = 0.0
    answers: dict[str, Any] = field(default_factory=dict)
    artefact: Event | None = None


class SittingError(ValueError):
    """A log does not fit its study."""


def list_phases(study: Study, participant: str) -> tuple[Phase, ...]:
    """Return what a participant goes through, from consent to end. Raises ValueError for one who does not
    take part.
    """
    plan = study.plan
    out: list[Phase] = []

    def add(name: PhaseName, title: str, text: str = "", **more: Any) -> None:
        out.append(Phase(len(out), name, title, text, **more))

    def ask(when: str, condition: str | None = None, task: str | None = None) -> None:
        for q in plan.questions():
            if (q.when or plan.when) == when:
                add(
                    "questionnaire",
                    q.title or "Some questions",
                    q.instructions,
                    condition=condition,
                    task=task,
                    questionnaire=q,
                )

    if plan.consent:
        add("consent", plan.title, plan.consent)
    if plan.instructions:
        add("instructions", plan.title, plan.instructions)
    blocks = study.blocks(participant)
    trained: set[str] = set()
    for place, (condition, tasks) in enumerate(blocks):
        editor = CONDITION_TITLES[condition]
        for training in plan.training if condition not in trained else ():
            if training.condition == condition:
                add(
                    "instructions",
                    f"Practice: {editor}",
                    training.instructions,
                    condition=condition,
                    minutes=training.minutes,
                )
                add(
                    "training",
                    f"Practice: {editor}",
                    training.instructions,
                    condition=condition,
                    minutes=training.minutes,
                    clips=training.clips,
                )
        trained.add(condition)
        for ident in tasks:
            task = plan.task(ident)
            more = {"condition": condition, "task": ident, "minutes": task.minutes}
            text, names = task.instructions, ""
            if plan.names != "shown":
                names = "hidden" if study.hides(participant, ident) else "shown"
                text = f"{text}\n\n{plan.hidden}".strip() if names == "hidden" else text
            add("instructions", f"{task.name}: {editor}", text, **more)
            add("task", f"{task.name}: {editor}", text, clips=task.clips, names=names, **more)
            ask("after_task", condition, ident)
        if condition not in [c for c, _ in blocks[place + 1 :]]:
            ask("after_condition", condition)
        if plan.breaks and place + 1 < len(blocks):
            add("break", "A break", minutes=plan.breaks)
    ask("after_study")
    add("end", "Thank you", plan.thanks)
    return tuple(out)


def find_place_in_sitting(course: Sequence[Phase], events: Sequence[Event]) -> Where:
    """Return where a sitting stands. Raises SittingError when the events are of another course."""
    done = 0
    begun: Event | None = None
    elapsed = 0.0
    answers: dict[str, Any] = {}
    artefact: Event | None = None
    for event, seconds, why in list_event_steps(events):
        if begun is not None and why != "paused":
            elapsed += seconds
        if event["type"] == "answer" and begun is not None:
            answers[str(event.get("item"))] = event.get("value")
        elif event["type"] == "artefact" and begun is not None:
            artefact = event
        elif event["type"] == "phase":
            starts = event.get("state") == "begin"
            expected = course[done].fields if done < len(course) else {}
            if (
                {k: event.get(k) for k in expected} != expected
                or not expected
                or starts is (begun is not None)
            ):
                told = " ".join(str(event[k]) for k in ("name", "condition", "task", "state") if k in event)
                raise SittingError(
                    f"event {event['n']} ({told}) does not fit the study: was the study file changed since?"
                )
            if starts:
                begun, elapsed, answers, artefact = event, 0.0, {}, None
            else:
                begun, done = None, done + 1
    if done == len(course):
        return Where(None)
    return (
        Where(course[done], begun is not None, elapsed, answers, artefact)
        if begun is not None
        else Where(course[done])
    )


def describe_standing(study: Study, participant: str) -> str:
    """Return how far a participant is, in words."""
    if not study.log(participant).is_file():
        return "not begun"
    try:
        log = read_log(study.log(participant))
        if log.standing in ("declined", "withdrawn"):
            return log.standing
        now = find_place_in_sitting(list_phases(study, participant), log.events)
    except (FileError, ValueError) as error:
        return str(error)
    return "done" if now.phase is None else f"goes on at: {now.phase.title}"


class Sitting:
    """A sitting as it goes on: the one place that writes its phases. `writer` is open while it does; `close`
    at the end.

    log: what was there when it was opened. Raises FileError, and SittingError as `where`.
    """

    def __init__(
        self, study: Study, participant: str, machine: dict[str, Any] | None = None, version: str = ""
    ) -> None:
        self.study, self.participant = study, participant
        if study.plan.order == "concealed":
            allocate(study, participant)
        self.course = list_phases(study, participant)
        if study.log(participant).is_file() and read_log(study.log(participant)).standing == "withdrawn":
            raise SittingError(
                f"{participant} withdrew; let somebody else take part, under another pseudonym"
            )
        send = None
        if study.plan.lsl:
            try:
                send = open_marker_outlet(participant)
            except LabStreamError as error:
                raise SittingError(error.args[0]) from None
        self.writer = Writer(study.log(participant))
        self.writer.listeners += [send] if send is not None else []
        try:
            self.log: StudyLog = self.writer.before
            self.now = find_place_in_sitting(self.course, self.log.events)
            if self.now.phase is not None or not self.log.complete:
                self.writer.begin(
                    participant=participant, study=study.digest, version=version, machine=machine or {}
                )
        except (ValueError, FileError):
            self.writer.close()
            raise
        self.resumed = bool(self.log.events)
        if self.now.phase is None and not self.log.complete:
            self.writer.add("end")
        if self.now.artefact is not None:
            self.end(str(self.now.artefact.get("why", "done")))

    @property
    def phase(self) -> Phase | None:
        return self.now.phase

    @property
    def file(self) -> Path:
        """Return where the project of the phase lies."""
        assert self.phase is not None
        return self.study.data(self.participant) / self.phase.file

    def begin(self) -> None:
        """Begin the phase, unless it runs already."""
        phase = self.now.phase
        if phase is not None and not self.now.begun:
            self.writer.add("phase", state="begin", **phase.fields)
            self.now = Where(phase, True)

    def end(self, why: str = "done") -> None:
        """End the phase that runs, and go on to the next. why: `done`, or `time` when there was none left."""
        phase = self.now.phase
        if phase is None or not self.now.begun:
            return
        self.writer.add("phase", state="end", why=why, **phase.fields)
        last = phase.index + 1 == len(self.course)
        self.now = Where(None if last else self.course[phase.index + 1])
        if last:
            self.writer.add("end")

    def decline(self) -> None:
        """Report that the participant does not agree to take part; the sitting stays where it is."""
        self.writer.add("declined")

    def freeze(self, digests: Mapping[str, str]) -> None:
        """Report what is worked with, name -> SHA-256; nothing if the sitting was left meanwhile."""
        if not self.writer.closed:
            self.writer.add("frozen", digests=dict(digests))

    def keep(self, why: str = "done") -> None:
        """Report the project that was made in the phase, as it is in its file, and end the phase. Raises
        FileError.
        """
        phase = self.now.phase
        assert phase is not None
        try:
            digest = hashlib.sha256(self.file.read_bytes()).hexdigest()
        except OSError as error:
            raise FileError(
                self.file,
                f"cannot be read ({error.strerror or error})",
                "on keeping it",
                "Save the project again.",
            ) from None
        about = {k: v for k, v in phase.fields.items() if k in ("condition", "task")}
        self.writer.add("artefact", path=self.file.name, digest=digest, why=why, **about)
        self.end(why)

    def answer(self, item: str, value: Any) -> None:
        """Report an answer; the last one to an item counts."""
        phase = self.now.phase
        assert phase is not None and phase.questionnaire is not None
        if self.now.answers.get(item) != value:
            self.now.answers[item] = value
            self.writer.add("answer", questionnaire=phase.questionnaire.id, item=item, value=value)

    def close(self) -> None:
        self.writer.close()
