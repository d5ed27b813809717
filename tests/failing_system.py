"""A system whose n-th call fails: what a full disk, a drive that is away or a kill makes of files."""

from __future__ import annotations

import errno
import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

BY_PATH = ("open", "replace", "unlink", "chmod", "mkdir")
BY_HANDLE = ("write", "fsync", "ftruncate", "fstat", "fchmod", "dup", "close")


class Killed(BaseException):
    """The process ends just before a call: nothing after it is done, nothing is tidied up."""


class System:
    """Counts the calls that change files below a folder, and lets the n-th fail, as often as it is told to.

    how: "error" fails with `number`; "short": a write takes one byte, and the next fails; "late": the call
    is done, and fails then; "kill": the process ends there. for_ever: whether all calls after it fail, too.
    """

    def __init__(self, folder: Path, fail_at: int = -1, how: str = "error", for_ever: bool = False) -> None:
        self.folder, self.fail_at, self.how, self.for_ever = str(folder), fail_at, how, for_ever
        self.number, self.count, self.failed = errno.ENOSPC, 0, False
        self.calls: list[str] = []
        self._handles: set[int] = set()
        self._dead = False

    def wrap(self, name: str, real: Callable[..., Any]) -> Callable[..., Any]:
        def call(*args: Any, **kwargs: Any) -> Any:
            ours = args[0] in self._handles if name in BY_HANDLE else self.folder in os.fspath(args[0])
            if not ours or (name == "open" and _only_reads(*args)):
                return real(*args, **kwargs)
            if self._dead:
                if name == "close":
                    real(*args)
                raise Killed
            n, self.count = self.count, self.count + 1
            self.calls.append(name)
            if n == self.fail_at or (self.for_ever and 0 <= self.fail_at < n):
                return self._fail(name, real, args, kwargs)
            return self._done(name, real, args, kwargs)

        return call

    def _done(self, name: str, real: Callable[..., Any], args: Any, kwargs: Any) -> Any:
        out = real(*args, **kwargs)
        if name in ("open", "dup"):
            self._handles.add(out)
        if name == "close":
            self._handles.discard(args[0])
        return out

    def _fail(self, name: str, real: Callable[..., Any], args: Any, kwargs: Any) -> Any:
        self.failed = True
        if self.how == "kill":
            if name == "write":  # torn in the middle
                real(args[0], bytes(args[1])[: len(args[1]) // 2])
            self._dead = True
            raise Killed
        if self.how == "short" and name == "write" and len(args[1]) > 1:
            self.fail_at += 1
            return real(args[0], bytes(args[1])[:1])
        if self.how == "late" or name == "close":
            self._done(name, real, args, kwargs)
        raise OSError(self.number, os.strerror(self.number))


def _only_reads(path: Any, flags: int, *_: Any) -> bool:
    """Return whether a file is opened that nothing is written to; folders are opened to be synced."""
    return not flags & (os.O_WRONLY | os.O_RDWR | os.O_CREAT) and not Path(path).is_dir()


@contextmanager
def failing(folder: Path, fail_at: int, how: str = "error", for_ever: bool = False) -> Iterator[System]:
    """Let the calls of this process below a folder fail as told."""
    system = System(folder, fail_at, how, for_ever)
    with pytest.MonkeyPatch.context() as patch:
        for name in (*BY_PATH, *BY_HANDLE):
            patch.setattr(os, name, system.wrap(name, getattr(os, name)))
        yield system
