"""Opening what a user, or a file, names: by one way, which neither hangs nor runs out of memory nor ends in
anything but a FileError.

A pipe, a device or a folder is no file; what is larger than its budget is not read; a path may be too long or
no text. `guarded` makes whatever else a reader trips over a FileError, so that one file never spoils a batch.
"""

from __future__ import annotations

import os
import stat
from collections.abc import Callable, Iterator
from concurrent.futures import CancelledError
from contextlib import contextmanager
from functools import wraps
from io import BufferedReader
from pathlib import Path
from typing import ParamSpec, TypeVar

from metagraph.common.wording import phrase
from metagraph.errors import FileError

P = ParamSpec("P")
R = TypeVar("R")

_THERE = phrase("Check that it is there and that you may read it.")
_KINDS = (
    (stat.S_ISDIR, "a folder"),
    (stat.S_ISFIFO, "a pipe"),
    (stat.S_ISSOCK, "a socket"),
    (stat.S_ISCHR, "a device"),
    (stat.S_ISBLK, "a device"),
)

strict = False  # whether errors nobody foresaw are raised as they are: for tests, which look for them


def is_text(path: str | Path) -> bool:
    """Return whether a path can be written down: names on some disks are bytes in no known encoding."""
    try:
        str(path).encode()
    except UnicodeEncodeError:
        return False
    return True


def is_file(path: str | Path) -> bool:
    """Return whether there is a file; a path that cannot be one is none."""
    try:
        return stat.S_ISREG(Path(path).stat().st_mode)
    except (OSError, ValueError):
        return False


def is_inside(path: Path, folder: Path) -> bool:
    """Return whether a path leads to somewhere below a folder, by whatever links."""
    try:
        return path.resolve().is_relative_to(folder.resolve())
    except (OSError, ValueError, RuntimeError):  # it is none, or leads in a circle
        return False


@contextmanager
def open_file(path: str | Path, most: int) -> Iterator[BufferedReader]:
    """Open a file of at most `most` bytes for reading. Raises FileError; so does reading it."""
    path = Path(path)
    try:
        file = _handle(path)
    except (OSError, ValueError) as error:
        raise describe_unreadable_error(path, error) from None
    try:
        with file:
            _checked(path, os.fstat(file.fileno()), most)
            yield file
    except OSError as error:
        raise describe_unreadable_error(path, error) from None


def read_file(path: str | Path, most: int) -> bytes:
    """Return the bytes of a file of at most `most` bytes. Raises FileError."""
    with open_file(path, most) as file:
        # As much as it says it has: a buffer for all it may have would cost as much.
        parts = [file.read(os.fstat(file.fileno()).st_size + 1)]
        size = len(parts[0])
        while parts[-1] and size <= most:  # it grows, or is made up by the system while it is read
            parts.append(file.read(1 << 20))
            size += len(parts[-1])
    if size > most:
        raise _too_large(Path(path), most)
    return parts[0] if len(parts) < 3 else b"".join(parts)


def check_file(path: str | Path, most: int) -> Path:
    """Return the path of a file that a library will open. Raises FileError for what `opened` refuses."""
    with open_file(path, most):
        return Path(path)


def describe_unreadable_error(path: Path, error: OSError | ValueError) -> FileError:
    """Return the error that says why a file cannot be read."""
    words = (error.strerror or str(error)) if isinstance(error, OSError) else "its path is none"
    return FileError(path, phrase("cannot be read ({words})", words=words), phrase("on opening it"), _THERE)


def _handle(path: Path) -> BufferedReader:
    # A pipe that nobody writes to would keep open() waiting for ever.
    flags = os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0)
    return os.fdopen(os.open(path, flags), "rb")


def _checked(path: Path, found: os.stat_result, most: int) -> None:
    for kind, words in _KINDS:
        if kind(found.st_mode):
            raise FileError(
                path,
                phrase("it is {words}, not a file", words=words),
                phrase("on opening it"),
                phrase("Choose a file."),
            )
    if found.st_size > most:
        raise _too_large(path, most)


def _too_large(path: Path, most: int) -> FileError:
    size = f"{most >> 30} GiB" if most >= 1 << 30 else f"{most >> 20} MiB"
    return FileError(
        path,
        phrase("is larger than the {size} that are read", size=size),
        phrase("on opening it"),
        phrase("Split it."),
    )


def guard_reader(read: Callable[P, R]) -> Callable[P, R]:
    """Make a reader, whose first argument is the file's path, raise FileError for whatever goes wrong in it.

    ValueError for arguments that are no file's fault must be raised before, outside.
    """

    @wraps(read)
    def safely(*args: P.args, **kwargs: P.kwargs) -> R:
        try:
            return read(*args, **kwargs)
        except (FileError, CancelledError):
            raise
        except Exception as error:
            if strict:
                raise
            path = args[0] if args else kwargs["path"]
            raise make_unforeseen_error(path, error) from error  # type: ignore[arg-type]

    return safely


def make_unforeseen_error(path: str | Path, error: Exception) -> FileError:
    """Return what to report a file on which a reader failed in a way that nobody foresaw."""
    if isinstance(error, FileError):
        return error
    if isinstance(error, MemoryError):
        remedy = phrase("Close other programs, or split the file.")
        return FileError(path, phrase("there is not enough memory for it"), phrase("on reading it"), remedy)
    if isinstance(error, OSError):
        return describe_unreadable_error(Path(path), error)
    said = f"{type(error).__name__}: {error}" if str(error) else type(error).__name__
    remedy = phrase(
        "Export it again; if that does not help, report it with the file (docs/animators/safety.md)."
    )
    return FileError(
        path, phrase("its reader failed on it ({said})", said=said), phrase("on reading it"), remedy
    )
