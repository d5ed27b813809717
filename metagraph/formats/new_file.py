"""Make files that have the access rights of another file."""

from __future__ import annotations

import os
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Access:
    """Who may read and write a file: its mode, as `chmod` takes it, and its group."""

    mode: int
    group: int


PRIVATE = Access(0o600, -1)  # for what lies in the user's own folders


def access_of(path: Path | None) -> Access | None:
    """Return who may read and write a file; None if there is none, or its folder is not to be reached."""
    if path is None:
        return None
    try:
        found = path.stat()
    except (OSError, ValueError):
        return None
    return Access(found.st_mode & 0o777, found.st_gid)


def open_new(path: Path, like: Access | None = None) -> int:
    """Make a file that is not there yet, and return a handle to write to it. Raises OSError.

    like: who may read and write it, from its first moment on; without it, the system's default (its umask). A
    file of another group gets that group before the group may read it; if that is not allowed, the group may
    do no more than everybody.
    """
    flags = os.O_CREAT | os.O_EXCL | os.O_WRONLY | getattr(os, "O_BINARY", 0)
    if like is None or os.name == "nt":
        return os.open(path, flags, 0o666)
    mode = like.mode
    handle = os.open(path, flags, mode & 0o700)
    with suppress(OSError):  # a drive that knows no modes
        if like.group >= 0 and os.fstat(handle).st_gid != like.group:
            try:
                os.fchown(handle, -1, like.group)
            except OSError:
                mode = mode & ~0o070 | (mode & 0o007) << 3 & mode
        os.fchmod(handle, mode)
    return handle
