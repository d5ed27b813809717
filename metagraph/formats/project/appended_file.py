"""A file that lines are added to while it is open, and that others may remove, replace or move meanwhile.

A program that writes to a file which somebody has removed writes to nowhere, and no call of the system fails.
So after each line it is compared, as SQLite does, whether the file that is open is the one at its path.
"""

from __future__ import annotations

import errno
import os
import sys
from contextlib import suppress
from pathlib import Path

from metagraph.formats.new_file import Access
from metagraph.formats.replacing import replace_file, write_all

Identity = tuple[int, int]  # of a file or folder: its device and number there


class AppendedFile:
    """path: where it is; it follows a folder that is renamed. Its calls raise OSError."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self._handle: int | None = None
        self._like: Access | None = None
        self._size, self._torn = 0, False  # torn: half a line stands behind `size`
        self._folder: Identity | None = None

    def begin(self, content: bytes, like: Access | None, sync: bool) -> None:
        """Write it again, whole or not at all. like: who may read it. sync: wait for the disk."""
        replace_file(self.path, content, sync, like)  # until it is there, what was open is all there is
        self.close()
        self._like, self._torn, self._size = like, False, len(content)
        with suppress(OSError):  # tried again with the next line
            self._open()

    def _open(self) -> None:
        handle = os.open(self.path, os.O_RDWR | os.O_APPEND | getattr(os, "O_BINARY", 0))
        try:
            if not self._torn:
                self._size = os.fstat(handle).st_size
            self._folder = read_identity(self.path.parent)
        except OSError:
            os.close(handle)
            raise
        self._handle = handle

    def add(self, line: bytes) -> None:
        """Add a line; a half one that could not be written goes first."""
        if self._handle is None:  # it could not be opened again
            self._open()
        assert self._handle is not None
        if self._torn:
            os.ftruncate(self._handle, self._size)
        self._torn = True
        write_all(self._handle, line)
        self._size += len(line)
        self._torn = False

    def look(self) -> str:
        """Return what has become of it since it was opened: "" nothing; "moved", with its folder, where it
        was followed; "removed", and it was written again. Raises OSError if neither can be.
        """
        if self._handle is None:
            self._open()
        assert self._handle is not None
        own = os.fstat(self._handle)
        with suppress(FileNotFoundError, NotADirectoryError):
            there = self.path.stat()
            if (there.st_dev, there.st_ino) == (own.st_dev, own.st_ino):
                return ""
        moved = self._moved_to()
        if moved is not None:
            self.path = moved
            return "moved"
        if not self.path.parent.is_dir():
            raise FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT), str(self.path.parent))
        self._write_again()
        return "removed"

    def _moved_to(self) -> Path | None:
        """Return where it is by now, where its folder has another name."""
        place = find_moved_folder(self.path.parent, self._folder, find_open_path(self._handle))
        if place is None:
            return None
        path = place / self.path.name
        assert self._handle is not None
        return path if read_identity(path) == make_identity(os.fstat(self._handle)) else None

    def _write_again(self) -> None:
        """Write what was removed again; what stands in its place is put aside, if it says anything else."""
        content = self._content()
        with suppress(FileNotFoundError):
            other = self.path.read_bytes()
            if not content.startswith(other):
                self.path.replace(_aside(self.path))
        like = self._like
        self.begin(content, like, True)
        if self._handle is None:
            self._open()

    def _content(self) -> bytes:
        assert self._handle is not None
        handle = os.dup(self._handle)
        with os.fdopen(handle, "rb") as file:
            file.seek(0)
            content = file.read(self._size)
        if len(content) < self._size:
            raise OSError(errno.EIO, os.strerror(errno.EIO))
        return content

    def touch(self) -> None:
        """Give it the present time."""
        os.utime(self._handle if self._handle is not None and os.utime in os.supports_fd else self.path)

    def duplicate(self) -> int:
        """Return a handle of its own to sync."""
        if self._handle is None:
            self._open()
        assert self._handle is not None
        return os.dup(self._handle)

    @property
    def whole(self) -> bool:
        """Whether each line was written to its end."""
        return not self._torn

    def close(self) -> None:
        if self._handle is not None:
            handle, self._handle = self._handle, None
            with suppress(OSError):  # a network drive that is away
                os.close(handle)


def _aside(path: Path) -> Path:
    """Return a free name beside a journal, by which it is offered like any other."""
    number = 1
    while (place := path.with_name(f"{path.name.removesuffix('.journal')}{number:02x}.journal")).exists():
        number += 1
    return place


def make_identity(found: os.stat_result) -> Identity:
    """Return the identity of a file or folder that was looked at: its device and its number there."""
    return found.st_dev, found.st_ino


def read_identity(path: Path) -> Identity | None:
    """Return what a file or folder is known by, whatever its name; None if there is none."""
    try:
        return make_identity(path.stat())
    except (OSError, ValueError):
        return None


def find_open_path(handle: int | None) -> Path | None:
    """Return where an open file is by now; None if the system does not tell, or it was removed."""
    if handle is None:
        return None
    try:
        if sys.platform == "darwin":
            import fcntl

            said = fcntl.fcntl(handle, 50, bytes(1024)).rstrip(b"\0").decode()  # F_GETPATH
        else:
            said = str(Path(f"/proc/self/fd/{handle}").readlink())
        path = Path(said)
        return path if read_identity(path) == make_identity(os.fstat(handle)) else None
    except (OSError, ValueError, ImportError):
        return None


def find_moved_folder(folder: Path, known: Identity | None, inside: Path | None = None) -> Path | None:
    """Return where a folder is by now that is not at its path any more; None if it is there still, or nobody
    knows.

    known: what it is known by. inside: where a file in it was found. Else it is looked for beside its path.
    """
    if known is None or read_identity(folder) == known:
        return None
    if inside is not None and read_identity(inside.parent) == known:
        return inside.parent
    with suppress(OSError), os.scandir(folder.parent) as found:
        for entry in found:
            if entry.is_dir(follow_symlinks=False) and read_identity(Path(entry.path)) == known:
                return Path(entry.path)
    return None
