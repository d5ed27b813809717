"""Say on a terminal how far a long job is, and how long it will still take."""

from __future__ import annotations

import sys
import time
from argparse import Namespace

EARLY = 2.0  # seconds of work before what is left is estimated
OFTEN = 0.1  # seconds between two looks at most


class ProgressLine:
    """A line on a terminal that is written again and again; nothing where nobody reads it.

    what: what is done, such as "Reading clips". Not shown with --json, or where standard error is a file.
    """

    def __init__(self, options: Namespace, what: str) -> None:
        self._what = what
        self._shown = sys.stderr.isatty() and not getattr(options, "json", False)
        self._last = 0.0
        self._first: tuple[float, int] | None = None  # when it was first told, and how much was done then
        self._length = 0

    def tell(self, done: int, total: int, more: str = "") -> None:
        """Say that so many of all parts are done, and `more`, such as a file's name. The line ends with the
        last part.
        """
        now = time.monotonic()
        self._first = began, before = self._first or (now, done)
        if not self._shown or (done < total and self._length and now - self._last < OFTEN):
            return
        self._last = now
        line = f"{self._what}: {done:,} of {total:,}"
        if before < done < total and now - began > EARLY:
            line += f", about {describe_seconds((now - began) / (done - before) * (total - done))} left"
        line += f"  {more[:50]}" if more else ""
        ended = done >= total
        print(f"\r{line:<{self._length}}", end="\n" if ended else "", file=sys.stderr, flush=True)
        self._length = 0 if ended else len(line)

    def finish(self) -> None:
        """End the line, if one was begun and not ended."""
        if self._length:
            print(file=sys.stderr, flush=True)
            self._length = 0


def describe_seconds(seconds: float) -> str:
    """Return a length of time in words, rounded as an estimate is."""
    if seconds < 90:
        return f"{max(1, round(seconds))} s"
    return f"{round(seconds / 60)} min" if seconds < 5400 else f"{seconds / 3600:.1f} h"
