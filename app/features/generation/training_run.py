"""A training at work in a process of its own, followed by what it writes, a line of JSON each."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Protocol

from PySide6.QtCore import QObject, QTimer, Signal

LOOKS = 250  # milliseconds between two looks at what was written


class Process(Protocol):
    """The process: what it has written since it was asked last; whether it still runs; asked to stop it keeps
    what it has and ends by itself. error: why it ended, in words, "" where it ended well.
    """

    def lines(self) -> list[Mapping[str, Any]]: ...

    @property
    def running(self) -> bool: ...

    @property
    def error(self) -> str: ...

    def stop(self) -> None: ...

    def kill(self) -> None: ...


@dataclass(frozen=True)
class TrainingMoment:
    """Where a training stands. share: 0..1 of what it was asked for. losses, statistics: by name. model: a
    file with the model as it is now, where it was just written.
    """

    step: int = 0
    seconds: float = 0.0
    share: float = 0.0
    losses: Mapping[str, float] = field(default_factory=dict)
    statistics: Mapping[str, float] = field(default_factory=dict)
    words: str = ""
    model: Path | None = None


class TrainingRun(QObject):
    """moved: it stands elsewhere. ended: the model's file, None where there is none, and words."""

    moved = Signal(object)
    ended = Signal(object, str)

    def __init__(self, process: Process, out: Path, minutes: float, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.process, self.out, self.minutes = process, out, minutes
        self.stopping = False
        self._timer = QTimer(self, interval=LOOKS)
        self._timer.timeout.connect(self.look)
        self._timer.start()

    def look(self) -> None:
        """Read what was written since."""
        running = self.process.running  # asked first: what it wrote last is read after it has ended
        for line in self.process.lines():
            self.moved.emit(moment_of(line, self.minutes))
        if not running:
            self._timer.stop()
            error = self.process.error
            found = self.out if self.out.is_file() else None
            self.ended.emit(None if error and not found else found, error)

    def stop(self) -> None:
        """Let it end soon, keeping what it has."""
        if not self.stopping:
            self.stopping = True
            self.process.stop()

    def kill(self) -> None:
        """End it now: the window closes."""
        self._timer.stop()
        self.process.kill()


def moment_of(line: Mapping[str, Any], minutes: float) -> TrainingMoment:
    """Return what a line says; what it does not know, or says otherwise, is left out."""

    def numbers(name: str) -> dict[str, float]:
        found = line.get(name)
        values = found.items() if isinstance(found, Mapping) else ()
        return {str(k): x for k, v in values if (x := _number(v)) is not None}

    seconds = _number(line.get("seconds")) or 0.0
    share = _number(line.get("share"))
    model = line.get("model")
    return TrainingMoment(
        step=int(_number(line.get("step")) or 0),
        seconds=seconds,
        share=min(1.0, seconds / max(1.0, 60 * minutes)) if share is None else share,
        losses=numbers("losses"),
        statistics=numbers("statistics"),
        words=str(line.get("words", "")),
        model=Path(model) if isinstance(model, str) and model else None,
    )


def _number(value: object) -> float | None:
    fine = isinstance(value, int | float) and not isinstance(value, bool)
    return float(value) if fine else None  # type: ignore[arg-type]
