"""A training in a process of its own: python -m metagraph.generation.training FOLDER [--export] [--afresh]

What happens is told line by line on standard output, as JSON. It ends by itself, after a file `stop` in the
folder, or on SIGTERM or SIGINT; each time the model is written. --export writes the model of the last
checkpoint, without learning more.
"""

from __future__ import annotations

import json
import os
import signal
import sys
from collections.abc import Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

from metagraph.errors import FileError


def tell(event: Mapping[str, Any]) -> None:
    """Write a line; nobody may be listening any more."""
    with suppress(BrokenPipeError, ValueError):
        print(json.dumps(event, allow_nan=False), flush=True)


def main(arguments: Sequence[str], asked: Sequence[int] = ()) -> int:
    """Train; return 0, or 2 after telling what went wrong. asked: filled once it is to stop."""
    folder = Path(arguments[0])
    try:
        from metagraph.generation.training.learner import TrainingError
        from metagraph.generation.training.run import Run

        try:
            run = Run(folder, tell, lambda: bool(asked), "--afresh" not in arguments)
            run.finish(True) if "--export" in arguments else run.go()
        except (TrainingError, ValueError) as error:
            tell({"event": "error", "text": str(error)})
            return 2
    except FileError as error:
        tell({"event": "error", "text": str(error)})
        return 2
    except MemoryError:
        tell(
            {
                "event": "error",
                "text": "too little memory: train a smaller model, or smaller batches",
            }
        )
        return 2
    except ImportError as error:
        tell({"event": "error", "text": f"torch cannot be used ({error})"})
        return 2
    return 0


def alone() -> int:
    """Train in a process that is there for nothing else: behind all others, and stopped by signals."""
    if hasattr(os, "nice"):
        with suppress(OSError):
            os.nice(10)
    asked: list[int] = []
    for kind in (signal.SIGTERM, signal.SIGINT):
        signal.signal(kind, lambda number, _: asked.append(number))
    return main(sys.argv[1:], asked)


if __name__ == "__main__":
    sys.exit(alone())
