"""The log of a sitting: one JSON object a line, appended, never changed. What a study knows about time comes
from here.

Every event has n (0, 1, 2 ... without gaps), run (one per start of the program), mono (seconds within the
run), wall (UTC), type and the fields of its type. A line is handed to the system whole, so that a killed
program loses none, and is synced to the disk at most every 250 ms and at each boundary, so that a power cut
loses no more than that.
"""

from __future__ import annotations

import contextlib
import os
import threading
import time
import uuid
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, Literal

import msgspec

from metagraph.common.budgets import LOG_FILE
from metagraph.common.files import read_file
from metagraph.errors import FileError
from metagraph.formats.atomic import write_atomically
from metagraph.research.study.logs.clocks import find_clock_problems
from metagraph.research.study.scores.tasks import (
    Event,
    ItemAnswer,
    TaskRun,
    last_answers,
    list_task_runs,
    read_moment,
)

__all__ = [
    "BOUNDARIES",
    "NAME",
    "TYPES",
    "Event",
    "ItemAnswer",
    "StudyLog",
    "TaskRun",
    "Writer",
    "format_wall_time",
    "read_log",
]

NAME = "log.jsonl"
Standing = Literal["not begun", "declined", "broken off", "done", "withdrawn", "deleted"]
TYPES = (
    "begin",
    "resumed",
    "frozen",
    "declined",
    "withdrawn",
    "phase",
    "pause",
    "idle",
    "edit",
    "undo",
    "redo",
    "view",
    "playback",
    "dialog",
    "error",
    "import",
    "save",
    "export",
    "ops",
    "note",
    "marker",
    "answer",
    "artefact",
    "end",
)
BOUNDARIES = frozenset(
    {"begin", "resumed", "declined", "withdrawn", "phase", "pause", "marker", "answer", "artefact", "end"}
)  # synced before anything else happens
SYNC = 0.25  # seconds between syncs to the disk


@dataclass(frozen=True)
class StudyLog:
    """A log as it was read. torn: a half-written last line was left out. problems: what else is wrong, in
    words. following: the number of the event that comes next.
    """

    path: Path
    events: tuple[Event, ...] = ()
    torn: bool = False
    problems: tuple[str, ...] = ()
    following: int = 0

    @property
    def participant(self) -> str:
        """Return who it is about: as the log says, else as its folder is called."""
        return next(
            (str(e["participant"]) for e in self.events if e["type"] == "begin" and "participant" in e),
            self.path.parent.name,
        )

    @property
    def complete(self) -> bool:
        """Whether the sitting was gone through to its end."""
        return any(e["type"] == "end" for e in self.events)

    @property
    def frozen(self) -> dict[str, str] | None:
        """Return what was worked with, name -> SHA-256, as it was reported first; None if it was not."""
        found = next((e.get("digests") for e in self.events if e["type"] == "frozen"), None)
        return {str(k): str(v) for k, v in found.items()} if isinstance(found, dict) else None

    @property
    def standing(self) -> Standing:
        """Return how far the sitting came, by the log alone."""
        kinds = [e["type"] for e in self.events]
        if "withdrawn" in kinds:
            return "withdrawn"
        if "end" in kinds:
            return "done"
        if "declined" in kinds and "phase" not in kinds[kinds.index("declined") :]:
            return "declined"
        return "broken off"

    def tasks(self) -> list[TaskRun]:
        """Return the tasks that were begun, in their order."""
        return list_task_runs(self.participant, self.events)

    def answers(self) -> list[ItemAnswer]:
        """Return the answers to questionnaires; of several to one item the last."""
        return last_answers(self.participant, self.events)


def format_wall_time(now: datetime) -> str:
    """Return a time as logs write it: UTC, milliseconds."""
    return now.astimezone(UTC).isoformat(timespec="milliseconds").replace("+00:00", "Z")


# --- reading


def read_log(path: str | Path) -> StudyLog:
    """Read a log. Raises FileError when there is none; damaged lines are left out and told among the
    problems.
    """
    path = Path(path)
    content = read_file(path, LOG_FILE)
    *lines, tail = content.split(b"\n")
    events: list[Event] = []
    problems: list[str] = []
    expected = 0
    for number, line in enumerate(lines, 1):
        event = _event(line)
        if isinstance(event, str):
            problems.append(f"line {number}: {event}; it is left out")
            expected += 1  # the line that cannot be read had this number
            continue
        if event["n"] < expected:
            problems.append(f"line {number}: event {event['n']} is there twice; it is left out")
            continue
        if event["n"] > expected:
            problems.append(
                f"line {number}: event {expected} is missing"
                + (" and more" if event["n"] > expected + 1 else "")
            )
        if event["type"] not in TYPES:
            problems.append(f"line {number}: '{event['type']}' is no kind of event")
        if events and events[-1]["run"] == event["run"] and event["mono"] < events[-1]["mono"]:
            problems.append(f"line {number}: time goes backwards")
        expected = event["n"] + 1
        events.append(event)
    problems += find_clock_problems(events)
    return StudyLog(path, tuple(events), bool(tail), tuple(problems), expected)


def _event(line: bytes) -> Event | str:
    """Return an event, or what is wrong with its line."""
    try:
        event = msgspec.json.decode(line)
    except (msgspec.DecodeError, RecursionError, UnicodeDecodeError):
        return "is no JSON"
    if not isinstance(event, dict):
        return "is no event"
    for key, kinds in (("n", int), ("run", str), ("mono", (int, float)), ("wall", str), ("type", str)):
        value = event.get(key)
        if not isinstance(value, kinds) or isinstance(value, bool):
            return f"has no {key}"
    try:
        if read_moment(event).tzinfo is None:
            return "its wall time is of no time zone"
    except ValueError:
        return f"its wall time '{event['wall'][:40]}' is none"
    return event


# --- writing


@dataclass
class _Disk:
    """Syncs a file on a thread of its own, at most every SYNC seconds: a slow disk must not hold up the
    window.
    """

    handle: int
    wake: threading.Event = field(default_factory=threading.Event)
    ended: threading.Event = field(default_factory=threading.Event)

    def __post_init__(self) -> None:
        self.thread = threading.Thread(target=self._run, name="log", daemon=True)
        self.thread.start()

    def _run(self) -> None:
        while self.wake.wait() and not self.ended.is_set():
            self.wake.clear()
            with contextlib.suppress(OSError):  # the next boundary tells
                os.fsync(self.handle)
            self.ended.wait(SYNC)

    def end(self) -> None:
        self.ended.set()
        self.wake.set()
        self.thread.join()


class Writer:
    """Appends to a log, or begins one. before: what was in it; a torn last line is cut off and kept in a file
    beside it.

    clock: seconds, monotonic; now: the time of day. Only one program may write a log at a time; its user sees
    to that.
    """

    def __init__(
        self,
        path: str | Path,
        clock: Callable[[], float] = time.monotonic,
        now: Callable[[], datetime] = lambda: datetime.now(UTC),
        run: str | None = None,
    ) -> None:
        """Raises FileError."""
        self.path, self._clock, self._now = Path(path), clock, now
        self.run = run or uuid.uuid4().hex[:12]
        self.before = read_log(self.path) if self.path.exists() else StudyLog(self.path)
        self.n = self.before.following
        self._waiting: list[bytes] = []  # lines that could not be written yet
        self.listeners: list[Callable[[Event], None]] = []  # reported about each event that is in the log
        self.closed = False
        try:
            self.path.parent.mkdir(parents=True, exist_ok=True)
            if self.before.torn:
                self._cut()
            self._handle = os.open(
                self.path, os.O_WRONLY | os.O_APPEND | os.O_CREAT | getattr(os, "O_BINARY", 0), 0o666
            )
        except OSError as error:
            raise self._failure(error) from None
        self._disk = _Disk(self._handle)
        self._start = clock()

    def begin(self, **fields: Any) -> Event:
        """Write that the sitting begins, or goes on: `resumed` tells where it was left and how much time was
        lost.
        """
        if not self.before.events:
            return self.add("begin", **fields)
        last = self.before.events[-1]
        lost = max(0.0, (self._now() - read_moment(last)).total_seconds())
        return self.add("resumed", after=last["n"], lost=round(lost, 3), **fields)

    def add(self, kind: str, **fields: Any) -> Event:
        """Append an event. Raises ValueError for a kind that there is not, TypeError for what JSON cannot
        say, FileError when the disk does not take it; the event is then kept and written with the next one.
        """
        event = self._append(kind, fields)
        if kind in BOUNDARIES:
            self.sync()
        else:
            self._disk.wake.set()
        return event

    def extend(self, events: Iterable[tuple[str, Mapping[str, Any]]]) -> None:
        """Append several events, (kind, fields) each; all are on the disk afterwards. Raises as `add`."""
        for kind, fields in events:
            self._append(kind, fields)
        self.sync()

    def _append(self, kind: str, fields: Mapping[str, Any]) -> Event:
        if kind not in TYPES:
            raise ValueError(f"'{kind}' is no kind of event; there are {', '.join(TYPES)}")
        mono = round(self._clock() - self._start, 6)
        event: Event = {
            "n": self.n,
            "run": self.run,
            "mono": mono,
            "wall": format_wall_time(self._now()),
            "type": kind,
            **fields,
        }
        line = msgspec.json.encode(event) + b"\n"
        self.n += 1
        self._waiting.append(line)
        self._flush()
        for listener in self.listeners:
            listener(event)
        return event

    def _flush(self) -> None:
        content = b"".join(self._waiting)
        size = os.fstat(self._handle).st_size
        try:
            done = 0
            while done < len(content):
                done += os.write(self._handle, content[done:])
        except OSError as error:
            os.truncate(self._handle, size)  # what is written later must not stand behind half a line
            raise self._failure(error) from None
        self._waiting.clear()

    def sync(self) -> None:
        """Wait until all that was added is on the disk. Raises FileError."""
        try:
            os.fsync(self._handle)
        except OSError as error:
            raise self._failure(error) from None

    def close(self) -> None:
        """Sync and close; nothing more can be added."""
        if not self.closed:
            self.closed = True
            self._disk.end()
            try:
                self.sync()
            finally:
                os.close(self._handle)

    def _cut(self) -> None:
        """Move a torn last line into a file of its own."""
        content = self.path.read_bytes()
        whole = content.rfind(b"\n") + 1
        number = 1
        while (aside := self.path.with_name(f"{self.path.stem}.torn-{number}")).exists():
            number += 1
        write_atomically(aside, content[whole:])
        os.truncate(self.path, whole)

    def _failure(self, error: OSError) -> FileError:
        return FileError(
            self.path,
            f"cannot be written ({error.strerror or error})",
            "on adding to it",
            "Make room on the disk, and check your rights.",
        )
