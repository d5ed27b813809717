"""A training in a process of its own, niced: it is begun, listened to, stopped, and gone on with. The window
and the command line never import torch. It does not outlive the process that began it.
"""

from __future__ import annotations

import importlib.util
import os
import subprocess
import threading
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from time import monotonic

import msgspec
from msgspec import Struct

from metagraph.common.extras import describe_missing_extra
from metagraph.common.programs import make_python_command, start
from metagraph.common.wording import phrase
from metagraph.generation.train_plan import STOP, find_training_folder

PATIENCE = 30.0  # seconds that a process may take to write its model once it is asked to stop


class TrainingFailedError(RuntimeError):
    """A training that did not lead to a model; the message says why. What was learned is in its folder."""


class TrainingEvent(Struct, frozen=True, kw_only=True):
    """What happened. event: `begin`, `step`, `checkpoint`, `statistics`, `poses`, `finish`, `note`, `error`
    or `end`. seconds: of the processor; minutes: of the clock; share: of the training, 0..1. numbers: `loss`,
    `likelihood` (natural logarithm), `reconstruction`, `matching`, `speeds`, `deviation`, `rate`: those that
    the model has. landmarks: `[n, 9, 3]`, metres, five times a second. path: of what was written.
    """

    event: str
    step: int = 0
    seconds: float = 0.0
    minutes: float = 0.0
    share: float = 0.0
    frames: int = 0
    parameters: int = 0
    threads: int = 0
    kind: str = ""
    numbers: dict[str, float] = {}
    statistics: dict[str, float] = {}
    landmarks: list[list[list[float]]] = []
    path: str = ""
    text: str = ""
    stopped: bool = False


def find_missing_tools() -> str | None:
    """Return what to do before anything can be trained, in words; None if torch is installed."""
    if importlib.util.find_spec("torch") is not None:
        return None
    return describe_missing_extra("train", phrase("Training"))


class TrainingProcess:
    """A training that runs. out: the model's file; its folder has a plan (`train_plan.write_training`).
    resume: go on from the last checkpoint. export: write the model of the last checkpoint, and end. heard: is
    given each event, on a thread of its own. Raises TrainingFailedError if torch is missing.
    """

    def __init__(
        self,
        out: Path,
        heard: Callable[[TrainingEvent], None] = lambda event: None,
        *,
        resume: bool = True,
        export: bool = False,
    ) -> None:
        if told := find_missing_tools():
            raise TrainingFailedError(told)
        self.folder = find_training_folder(out)
        (self.folder / STOP).unlink(missing_ok=True)
        words = [str(self.folder.resolve()), "--watched"]
        words += [] if resume else ["--afresh"]
        words += ["--export"] if export else []
        self._heard, self._said, self.last = heard, list[str](), TrainingEvent(event="none")
        self.error, self.path = "", ""
        self._process = start(
            make_python_command("metagraph.generation.training", *words),
            stdin=subprocess.PIPE,  # closed when this process ends, however that comes about
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            encoding="utf-8",
            errors="replace",
            # Threads that wait turning on the spot starve each other where others work as well.
            env={"OMP_WAIT_POLICY": os.environ.get("OMP_WAIT_POLICY", "PASSIVE")},
        )
        self._threads = [
            threading.Thread(target=target, daemon=True) for target in (self._listen, self._complain)
        ]
        for thread in self._threads:
            thread.start()

    @property
    def pid(self) -> int:
        return self._process.pid

    @property
    def running(self) -> bool:
        return self._process.poll() is None

    def stop(self) -> None:
        """Ask it to keep what was learned, write the model, and end."""
        self.folder.mkdir(exist_ok=True)
        (self.folder / STOP).touch()

    def leave(self) -> None:
        """Let it keep a checkpoint and end by itself, soon; no model is written. Nobody waits for it."""
        if self._process.stdin is not None:
            with suppress(OSError):
                self._process.stdin.close()

    def kill(self) -> None:
        """End it at once; its last checkpoint can be gone on from."""
        self._process.kill()
        self._process.wait()
        self.leave()

    def wait(self, seconds: float | None = None) -> Path:
        """Return the model's file once it is written. Raises TrainingFailedError, TimeoutError."""
        end = None if seconds is None else monotonic() + seconds
        try:
            code = self._process.wait(seconds)
        except subprocess.TimeoutExpired:
            raise TimeoutError("the training has not ended yet") from None
        self.leave()  # it has ended; what is open is closed
        for thread in self._threads:
            thread.join(None if end is None else max(1.0, end - monotonic()))
        if code or not self.path:
            raise TrainingFailedError(self.error or _last_words(self._said, code))
        return Path(self.path)

    def _listen(self) -> None:
        assert self._process.stdout is not None
        with self._process.stdout as lines:
            for line in lines:
                try:
                    event = msgspec.json.decode(line, type=TrainingEvent)
                except msgspec.DecodeError:
                    continue  # what a library says on its own
                self.last = event
                if event.event == "error":
                    self.error = event.text
                elif event.event == "end":
                    self.path = event.path
                self._heard(event)

    def _complain(self) -> None:
        assert self._process.stderr is not None
        with self._process.stderr as lines:
            for line in lines:
                if line.strip():
                    self._said.append(line.strip())
                    del self._said[:-20]


def _last_words(said: list[str], code: int) -> str:
    """Return why a process ended that did not say so itself."""
    if code < 0:
        return (
            f"the training was ended from outside (signal {-code}), perhaps since memory ran out. Go on from "
            "its last checkpoint, or train a smaller model"
        )
    return f"the training ended: {said[-1]}" if said else "the training ended without a word"
