"""What a log says about the tasks of a sitting: time, operators, edits, and which clips and what the time
went into.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import Any, Literal

Event = dict[str, Any]
Spent = Literal["dragging", "timing", "looking", "undoing", "other"]

AWAY = 60.0  # seconds without any event after which a person is taken to be away
OPERATORS = ("K", "P", "B", "D", "H")
SPENT: tuple[Spent, ...] = ("dragging", "timing", "looking", "undoing", "other")
_TELLING: Mapping[str, Spent] = {
    "edit": "other",
    "undo": "undoing",
    "redo": "undoing",
    "view": "looking",
    "playback": "looking",
    "import": "other",
    "dialog": "other",
    "error": "other",
}  # what the time before an event of a type went into; others say nothing about it


@dataclass(frozen=True)
class TaskRun:
    """One task of one participant in one condition.

    index: the phase's place in the sitting. seconds: active, without pauses and absences; wall: from begin to
    end by the clock; paused, away: seconds. operators: K keys, P pointings, B buttons pressed or released, D
    drags, H hands changing over; drag_s: seconds of the drags. errors: what was refused or failed, not what
    the program warned of. per_clip: active seconds by clip name, in the order in which the clips were first
    dealt with. spent: active seconds by what they went into; seconds before a change of timing are timing, of
    the others those with the button held are dragging. finished: ended by the participant; timed_out: ended
    by the time limit. artefact: the project that came of it, relative to the log's folder; digest: its
    SHA-256 as it was then.
    """

    participant: str
    condition: str
    task: str
    index: int
    seconds: float
    wall: float
    operators: Counter[str]
    drag_s: float
    edits: int
    undos: int
    errors: int
    per_clip: Mapping[str, float]
    spent: Mapping[Spent, float]
    finished: bool
    artefact: str | None
    digest: str | None = None
    paused: float = 0.0
    away: float = 0.0
    timed_out: bool = False
    begun: str = ""  # wall time
    names: str = ""  # of the clips: shown or hidden, "" if the study says nothing of it


@dataclass(frozen=True)
class ItemAnswer:
    """What was answered to an item last. condition, task: what the questionnaire was about, None for the
    whole study.
    """

    participant: str
    questionnaire: str
    item: str
    value: Any
    condition: str | None
    task: str | None
    index: int


def list_task_runs(participant: str, events: Sequence[Event]) -> list[TaskRun]:
    """Return the tasks that were begun, in their order."""
    out: list[TaskRun] = []
    tally: _Tally | None = None
    for event, seconds, why in list_event_steps(events):
        if tally is not None:
            tally.add(event, seconds, why)
        if event["type"] == "phase":
            if tally is not None:
                out.append(tally.run())
            tally = (
                _Tally(participant, event)
                if event.get("name") == "task" and event.get("state") == "begin"
                else None
            )
    return [*out, tally.run()] if tally is not None else out


def last_answers(participant: str, events: Sequence[Event]) -> list[ItemAnswer]:
    """Return the answers to questionnaires; of several to one item the last."""
    out: dict[tuple[Any, ...], ItemAnswer] = {}
    phase: Event = {}
    for e in events:
        if e["type"] == "phase":
            phase = e
        elif e["type"] == "answer":
            index = _index(phase)
            questionnaire, item = str(e.get("questionnaire")), str(e.get("item"))
            about = phase.get("condition"), phase.get("task")
            out[index, questionnaire, item] = ItemAnswer(
                participant, questionnaire, item, e.get("value"), *about, index
            )
    return list(out.values())


def list_event_steps(
    events: Sequence[Event],
) -> Iterator[tuple[Event, float, Literal["active", "paused", "away"]]]:
    """Yield each event with the seconds since the one before and what they were; between two runs there are
    none.
    """
    before: Event | None = None
    paused = False
    for event in events:
        same = before is not None and before["run"] == event["run"]
        seconds = max(0.0, event["mono"] - before["mono"]) if before is not None and same else 0.0
        yield event, seconds, "paused" if paused else "away" if seconds > AWAY else "active"
        if event["type"] == "pause":
            paused = event.get("state") == "begin"
        elif event["type"] in ("resumed", "phase"):
            paused = False
        before = event


class _Tally:
    """Adds a task up, event by event."""

    def __init__(self, participant: str, begin: Event) -> None:
        self.participant, self.begin, self.last = participant, begin, begin
        self.seconds = {"active": 0.0, "paused": 0.0, "away": 0.0}
        self.counts: Counter[str] = Counter()
        self.operators: Counter[str] = Counter(dict.fromkeys(OPERATORS, 0))
        self.drag_s = 0.0
        self.per_clip: dict[str, float] = {}
        self.spent: dict[Spent, float] = dict.fromkeys(SPENT, 0.0)
        self.on_clip = 0.0  # seconds since the last edit of a clip
        self.loose = self.loose_drag = (
            0.0  # seconds that no event has told the use of, and those of drags among them
        )
        self.artefact: str | None = None
        self.digest: str | None = None
        self.ended = ""

    def add(self, event: Event, seconds: float, why: str) -> None:
        self.last = event
        self.seconds[why] += seconds
        if why == "active":
            self.loose += seconds
            self.on_clip += seconds
        kind = event["type"]
        if kind == "ops":
            for name in OPERATORS:
                self.operators[name] += int(_number(event.get(name)))
            self.drag_s += _number(event.get("drag_s"))
            self.loose_drag += _number(event.get("drag_s"))
        elif kind == "artefact":
            self.artefact, self.digest = event.get("path"), event.get("digest")
        elif kind == "phase":
            self.ended = str(event.get("why", "done")) if event.get("state") == "end" else ""
            self._spend("other")
        elif kind == "error" and event.get("what") == "warning":
            self.counts["warning"] += 1  # found by the program; the time before it went into something else
        elif kind in _TELLING:
            self.counts[kind] += 1
            self._spend("timing" if kind == "edit" and event.get("what") == "timing" else _TELLING[kind])
        clips = event.get("clips") if kind == "edit" else None
        if clips and isinstance(clips, list):
            for clip in map(str, clips):
                self.per_clip[clip] = self.per_clip.get(clip, 0.0) + self.on_clip / len(clips)
            self.on_clip = 0.0

    def _spend(self, on: Spent) -> None:
        dragged = 0.0 if on == "timing" else min(self.loose, self.loose_drag)
        self.spent["dragging"] += dragged
        self.spent[on] += self.loose - dragged
        self.loose = self.loose_drag = 0.0

    def run(self) -> TaskRun:
        self._spend("other")
        return TaskRun(
            self.participant,
            str(self.begin.get("condition", "")),
            str(self.begin.get("task", "")),
            _index(self.begin),
            self.seconds["active"],
            max(0.0, (read_moment(self.last) - read_moment(self.begin)).total_seconds()),
            self.operators,
            self.drag_s,
            self.counts["edit"],
            self.counts["undo"],
            self.counts["error"],
            self.per_clip,
            self.spent,
            finished=self.ended == "done",
            artefact=self.artefact,
            digest=self.digest,
            paused=self.seconds["paused"],
            away=self.seconds["away"],
            timed_out=self.ended == "time",
            begun=self.begin["wall"],
            names=str(self.begin.get("names", "")),
        )


def _number(value: object) -> float:
    return float(value) if isinstance(value, int | float) and not isinstance(value, bool) else 0.0


def _index(phase: Event) -> int:
    return int(_number(phase.get("index", -1)))


def read_moment(event: Event) -> datetime:
    """Return when it was, by the clock on the wall."""
    return datetime.fromisoformat(event["wall"])
