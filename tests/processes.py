"""Starts programs for tests, and ends them whatever becomes of the test."""

from __future__ import annotations

import contextlib
import os
import signal
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[1]
PATIENCE = 10.0  # seconds that a program is given to end once it was told to


@contextlib.contextmanager
def started(
    *command: object, ignored: bool = False, longest: float = 600.0, **options: Any
) -> Iterator[subprocess.Popen[str]]:
    """Start a program in this project's folder; at the end it is told to end, and killed if it does not.

    ignored: starts it where interrupts are ignored, as `nohup` and background jobs of scripts do. longest:
    seconds after which it is killed whatever it does, so that nobody waits for its words for ever. options:
    of Popen; texts unless told otherwise.
    """
    options = {"cwd": ROOT, "text": True, **options}
    if ignored:
        options["preexec_fn"] = _ignore_interrupts
    process = subprocess.Popen(list(map(str, command)), **options)
    late = threading.Timer(longest, process.kill)
    late.daemon = True
    late.start()
    try:
        yield process
    finally:
        late.cancel()
        end(process)


def end(process: subprocess.Popen[Any], patience: float = PATIENCE) -> None:
    """End a process: asked first, killed after `patience` seconds. Its pipes are closed."""
    try:
        if process.poll() is None:
            process.terminate()
            with contextlib.suppress(subprocess.TimeoutExpired):
                process.wait(patience)
    finally:
        if process.poll() is None:
            process.kill()
            process.wait()
        for pipe in (process.stdin, process.stdout, process.stderr):
            if pipe is not None:
                with contextlib.suppress(OSError):
                    pipe.close()


def _ignore_interrupts() -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)


def metagraph(*words: object) -> tuple[object, ...]:
    """Return the command line of the program itself."""
    return (sys.executable, "-m", "app.cli", *words)


class Answering:
    """A program kept running that answers each line with one line."""

    def __init__(self, process: subprocess.Popen[str], patience: float = 120.0) -> None:
        self._process = process
        self._patience = patience  # seconds for one answer

    def ask(self, line: str) -> str:
        """Return the answer to a line, without its end. Raises AssertionError if there is none, or none in
        time.
        """
        assert self._process.stdin is not None and self._process.stdout is not None
        late = threading.Timer(self._patience, self._process.kill)
        late.daemon = True
        late.start()
        try:
            self._process.stdin.write(line + os.linesep)
            self._process.stdin.flush()
            answer = self._process.stdout.readline()
        finally:
            late.cancel()
        assert answer.endswith("\n"), f"no answer to {line[:200]!r}; it has ended with {self._process.poll()}"
        return answer.rstrip("\r\n")


def until(sure: Callable[[], object], what: str, patience: float = 30.0) -> None:
    """Wait until something is so; fail with `what` was waited for after `patience` seconds."""
    import time

    deadline = time.monotonic() + patience
    while not sure():
        assert time.monotonic() < deadline, f"waited {patience:g} s in vain for {what}"
        time.sleep(0.05)
