"""A training at work in a process of its own: takes that were read are written for it, one that was cut
short is gone on with, and what it says is heard on the window's thread.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

from PySide6.QtCore import QObject, QTimer, Signal

from app.translation import make_lazy_texts, tr, tr_error, tr_plural

if TYPE_CHECKING:
    from metagraph.generation.standing import Standing
    from metagraph.generation.train_process import TrainingEvent

# What an event's numbers tell, the most telling first.
GOALS = make_lazy_texts(
    lambda: {
        "likelihood": tr("likelihood: higher is better"),
        "matching": tr("error of the flow: lower is better"),
        "loss": tr("error: lower is better"),
    }
)
LITTLE = 0.4  # of a core: other work takes the rest
LOOKS = 200  # milliseconds between two looks at what was said


class Process(Protocol):
    """`train_process.TrainingProcess`: asked to stop it writes the model and ends by itself. wait: the
    model's file once it has ended; raises RuntimeError, in words, if there is none, TimeoutError.
    """

    @property
    def running(self) -> bool: ...

    def wait(self, seconds: float | None = None) -> Path: ...

    def stop(self) -> None: ...

    def leave(self) -> None: ...


Hear = Callable[["TrainingEvent"], None]
Begin = Callable[[Any, Mapping[str, Any], Path, Hear], Process]


def begin_training(batch: Any, wish: Mapping[str, Any], out: Path, hear: Hear) -> Process:
    """Begin to train with the takes that were read; on a job's thread. wish: kind, size and minutes. Raises
    SplitError, FileError, TrainingFailedError.
    """
    from metagraph.generation.takes import split_takes
    from metagraph.generation.train_plan import find_training_folder, plan_of, write_training
    from metagraph.generation.train_process import TrainingProcess

    learned, held = split_takes(batch.takes)
    plan = plan_of(batch.rig, learned, held, out, **wish)
    folder = find_training_folder(out)
    folder.mkdir(parents=True, exist_ok=True)
    write_training(folder, plan, learned, held)
    return TrainingProcess(out, hear)


def continue_training(standing: Standing, minutes: float, hear: Hear) -> Process:
    """Go on with a training that was begun, for as long as it was to last, and `minutes` more if that is
    over; on a job's thread. Raises FileError, TrainingFailedError.
    """
    from msgspec.structs import replace

    from metagraph.generation.train_plan import find_training_folder, write_plan
    from metagraph.generation.train_process import TrainingProcess

    plan = replace(standing.plan, out=str(standing.out.resolve()))
    if standing.share >= 1:
        plan = replace(plan, minutes=standing.minutes + minutes, seconds=0.0, steps=0)
    write_plan(find_training_folder(standing.out), plan)
    return TrainingProcess(standing.out, hear)


def keep_checkpoint(standing: Standing, hear: Hear) -> Process:
    """Write the model of a training's last checkpoint, without learning more; on a job's thread. Raises as
    `go_on` does.
    """
    from msgspec.structs import replace

    from metagraph.generation.train_plan import find_training_folder, write_plan
    from metagraph.generation.train_process import TrainingProcess

    write_plan(find_training_folder(standing.out), replace(standing.plan, out=str(standing.out.resolve())))
    return TrainingProcess(standing.out, hear, export=True)


def describe_progress(standing: Standing) -> str:
    """Return how far a training got, in words."""
    kind, step = standing.plan.kind, standing.step
    if not step:
        return tr("{kind}, nothing saved yet", kind=kind)
    if standing.share >= 1:
        return tr(
            "{kind}, {steps}, training time is up",
            kind=kind,
            steps=tr_plural("{count:,} step", "{count:,} steps", step),
        )
    return tr(
        "{kind}, {steps}, {share:.0f} % done",
        kind=kind,
        steps=tr_plural("{count:,} step", "{count:,} steps", step),
        share=100 * standing.share,
    )


class TrainingRun(QObject):
    """moved: something happened, an Event. ended: the model's file, None if there is none, and words."""

    moved = Signal(object)
    ended = Signal(object, str)

    def __init__(self, process: Process, said: deque[TrainingEvent], parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.process, self.said = process, said
        self.stopping = False
        self._timer = QTimer(self, interval=LOOKS)
        self._timer.timeout.connect(self.look)
        self._timer.start()

    def look(self) -> None:
        """Pass on what was said since."""
        running = self.process.running  # asked first: what it says last is read after it has ended
        if not running:
            self._timer.stop()
        path, error = (None, "") if running else self._result()
        while self.said:
            self.moved.emit(self.said.popleft())
        if not running:
            self.ended.emit(path, error)

    def _result(self) -> tuple[Path | None, str]:
        try:
            return self.process.wait(1.0), ""
        except (RuntimeError, TimeoutError) as error:
            return None, tr_error(error)

    def stop(self) -> None:
        """Let it end soon, keeping what it has."""
        if not self.stopping:
            self.stopping = True
            self.process.stop()

    def leave(self) -> None:
        """The window closes: it ends by itself, and what it has learned can be gone on from."""
        self._timer.stop()
        self.process.leave()


def describe_event(event: TrainingEvent) -> str:
    """Return how far a training is, in words; also how little of the machine it gets, if so."""
    words = tr(
        "{steps}, {minutes:.1f} min",
        steps=tr_plural("{count:,} step", "{count:,} steps", event.step),
        minutes=event.minutes,
    )
    got = event.seconds / (60 * event.minutes)
    return (
        tr(
            "{words}; the computer is busy: training gets {share:.0f} % of a core",
            words=words,
            share=100 * got,
        )
        if got < LITTLE
        else words
    )


def describe_goal(event: TrainingEvent) -> tuple[str, float]:
    """Return what an event reports how near the training is to its goal, in words and as a number; "" if it
    says nothing of it.
    """
    for name, words in GOALS.items():
        if name in event.numbers:
            return words, event.numbers[name]
    return "", 0.0
