"""A training in a process of its own:
python -m metagraph.generation.training FOLDER [--export] [--afresh] [--watched]

What happens is reported line by line on standard output, as JSON. It ends by itself, after a file `stop` in
the folder, or on SIGTERM or SIGINT; each time the model is written. --export writes the model of the last
checkpoint, without learning more. --watched: once standard input is closed, as it is when who began it ends
in whatever way, or it has another parent, it keeps a checkpoint and ends.
"""

from __future__ import annotations

import json
import os
import signal
import sys
import threading
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

from metagraph.errors import FileError
from metagraph.generation.standing import hold
from metagraph.generation.train_plan import PLAN

BUSY = (
    "another process learns in this folder: a second one would spoil its checkpoints. Wait until it has "
    "ended, or stop it"
)


def write_event(event: Mapping[str, Any]) -> None:
    """Write a line; nobody may be listening any more."""
    with suppress(BrokenPipeError, ValueError):
        print(json.dumps(event, allow_nan=False), flush=True)


def make_parent_watch() -> Callable[[], bool]:
    """Return what tells whether who began this process has gone."""
    parent, closed = os.getppid(), threading.Event()

    def listen() -> None:
        with suppress(OSError, ValueError):
            while os.read(0, 1024):
                pass
        closed.set()

    threading.Thread(target=listen, daemon=True).start()
    return lambda: closed.is_set() or os.getppid() != parent


def main(
    arguments: Sequence[str], asked: Sequence[int] = (), deserted: Callable[[], bool] = lambda: False
) -> int:
    """Train; return 0, or 2 after telling what went wrong. asked: filled once it is to stop. deserted: as for
    `Run`.
    """
    folder = Path(arguments[0])
    held = None
    with suppress(OSError):  # if nothing can be written that is reported soon enough
        if (folder / PLAN).is_file() and (held := hold(folder)) is None:
            write_event({"event": "error", "text": BUSY})
            return 2
    try:
        from metagraph.generation.training.learner import TrainingError
        from metagraph.generation.training.run import Run

        try:
            run = Run(folder, write_event, lambda: bool(asked), "--afresh" not in arguments, deserted)
            run.finish(True) if "--export" in arguments else run.go()
        except (TrainingError, ValueError) as error:
            write_event({"event": "error", "text": str(error)})
            return 2
    except FileError as error:
        write_event({"event": "error", "text": str(error)})
        return 2
    except MemoryError:
        write_event(
            {
                "event": "error",
                "text": "too little memory: train a smaller model, or smaller batches",
            }
        )
        return 2
    except ImportError as error:
        write_event({"event": "error", "text": f"torch cannot be used ({error})"})
        return 2
    finally:
        if held is not None:
            held.close()
    return 0


def train_alone() -> int:
    """Train in a process that is there for nothing else: behind all others, and stopped by signals."""
    if hasattr(os, "nice"):
        with suppress(OSError):
            os.nice(10)
    asked: list[int] = []
    for kind in (signal.SIGTERM, signal.SIGINT):
        signal.signal(kind, lambda number, _: asked.append(number))
    gone = make_parent_watch() if "--watched" in sys.argv else lambda: False
    return main(sys.argv[1:], asked, gone)


if __name__ == "__main__":
    sys.exit(train_alone())
