"""Locks that the system keeps: it gives them back when a process ends, however it ends, so that none is ever
left behind and none has to be taken over.
"""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import IO

from metagraph.errors import FileError

PATIENCE = 30.0  # seconds to wait for others
LOOK = 0.02  # seconds between two looks


def try_hold(path: Path) -> IO[bytes] | None:
    """Take the lock file at `path`, which is made, for this process until what is returned is closed, or the
    process ends; None if another one has it. Raises OSError if nothing can be written there.
    """
    held = path.open("ab")
    try:
        if sys.platform == "win32":
            import msvcrt

            held.seek(0)
            msvcrt.locking(held.fileno(), msvcrt.LK_NBLCK, 1)
        else:
            import fcntl

            fcntl.flock(held, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        held.close()
        return None
    return held


@contextmanager
def wait_for_turn(path: Path) -> Iterator[None]:
    """Wait until no other process, and no other thread, is in here with the same lock file. Raises FileError
    when that takes too long, rather than go on beside another.
    """
    until = time.monotonic() + PATIENCE
    try:
        while (held := _held(path)) is None:
            if time.monotonic() > until:
                raise FileError(
                    path,
                    f"is held by another program for {PATIENCE:g} s",
                    "",
                    "Look what that program waits for, or end it; a drive that keeps no locks is of no use.",
                )
            time.sleep(LOOK)
    except OSError as error:
        raise FileError(
            path, f"cannot be written ({error.strerror or error})", "", "Check your rights, and make room."
        ) from None
    try:
        yield
    finally:
        with suppress(OSError):  # Windows lets nobody remove what is open
            if _is_at(held, path):
                path.unlink()
        held.close()


def _held(path: Path) -> IO[bytes] | None:
    """Return the lock, None if it must be tried again: the file that was opened may be one that its last
    holder has just removed, while others make a new one.
    """
    held = try_hold(path)
    if held is None or sys.platform == "win32":
        return held
    if _is_at(held, path):
        return held
    held.close()
    return None


def _is_at(held: IO[bytes], path: Path) -> bool:
    """Return whether the file at a path is the one that is held."""
    try:
        mine, there = os.fstat(held.fileno()), path.stat()
    except OSError:
        return False
    return (mine.st_dev, mine.st_ino) == (there.st_dev, there.st_ino)
