"""Writing files whole or not at all: what stands there is replaced once what comes in its place is safely on
the disk.
"""

from __future__ import annotations

import errno
import os
import re
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from contextvars import ContextVar
from pathlib import Path

from metagraph.errors import FileError
from metagraph.formats.locking import mark_is_gone
from metagraph.formats.new_file import Access
from metagraph.formats.outputs import claim, claim_output
from metagraph.formats.replacing import replace_file, sync_folder

FORSAKEN = 86_400.0  # seconds after which an unfinished file of a computer that cannot be asked is nobody's
# Unfinished files. Those being written say by whom; the others are from before they did, or stay a moment.
_UNFINISHED = re.compile(
    r"\.saving-(?P<mark>[0-9a-f]{8}-\d{1,10}-[0-9A-Za-z]*)-[0-9a-f]{12}|\.saving-[0-9a-f]{32}"
    r"|\.clock-\w{8}|\..+\.lock\.[0-9a-f]{12}|\..+\.[0-9a-f]{12}\.journal\.new"
)
WAITING = 8  # threads that wait for the disk: it takes what is for one no longer than for some
_LATER: ContextVar[list[Path] | None] = ContextVar("files that are synced later", default=None)
_SWEPT: set[str] = set()  # folders this process has looked through


def write_atomically(path: Path, content: bytes, like: Access | None = None) -> None:
    """Write a file whole or not at all; a link is kept, its target written. Raises FileError.

    like: who may read it if there is none yet (`new_file.access_of` another file); what is replaced keeps its
    own mode. When it returns, the file survives a power cut, as far as the system keeps its word. What
    processes that are gone have left half-written in that folder is swept, once a process.
    """
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        if str(path.parent) not in _SWEPT:
            _SWEPT.add(str(path.parent))
            sweep(path.parent)
        path = path.resolve()
        if path.exists() and not os.access(path, os.W_OK):
            raise PermissionError(errno.EACCES, "it is read-only")
        later = _LATER.get()
        with claim_output(path, content):
            replace_file(path, content, sync=later is None, like=like)
        if later is not None:
            later.append(path)
    except OSError as error:
        raise _unwritable(path, error) from None


def write_together(folder: Path, files: dict[str, bytes]) -> list[Path]:
    """Write files into a folder, or none of them where one must not be written. Raises FileError."""
    claim(*(folder / name for name in files))
    for name, content in files.items():
        write_atomically(folder / name, content)
    return [folder / name for name in files]


def _unwritable(path: Path, error: OSError) -> FileError:
    return FileError(
        path,
        f"cannot be written ({error.strerror or error})",
        "on saving it",
        "Choose a place you may write to, with space left.",
    )


@contextmanager
def sync_together() -> Iterator[None]:
    """Have what is written atomically inside wait for the disk at the end, several files at once: for folders
    that nobody looks into before. Raises FileError.
    """
    later: list[Path] = []
    token = _LATER.set(later)
    try:
        yield
    finally:
        _LATER.reset(token)
    from concurrent.futures import ThreadPoolExecutor  # for exports alone

    with ThreadPoolExecutor(WAITING) as pool:
        list(pool.map(_sync, dict.fromkeys(later)))
    for folder in {path.parent for path in later}:
        sync_folder(folder)


def _sync(path: Path) -> None:
    try:
        handle = os.open(path, os.O_RDWR | getattr(os, "O_BINARY", 0))
        try:
            os.fsync(handle)
        finally:
            os.close(handle)
    except FileNotFoundError:  # it was taken away again
        return
    except OSError as error:
        raise _unwritable(path, error) from None


def append_line(path: Path, line: str) -> None:
    """Add a line to the end of a file, safely on the disk when it returns. A line that was cut off before it
    stays a line of its own. Raises OSError.
    """
    with path.open("a+b") as file:
        if file.tell() and file.seek(-1, os.SEEK_END) >= 0 and file.read(1) != b"\n":
            line = f"\n{line}"
        file.write(f"{line}\n".encode())
        file.flush()
        os.fsync(file.fileno())


# --- what was left half-written


def sweep(folder: Path) -> list[Path]:
    """Remove what writers that are gone have left half-written in a folder; return what was removed.

    Only what this program calls so, and only when its writer is gone: certainly on this computer, elsewhere
    when it was not touched for a day.
    """
    swept: list[Path] = []
    for path in find_forsaken_files(folder):
        with suppress(OSError):
            path.unlink()
            swept.append(path)
    return swept


def find_forsaken_files(folder: Path) -> list[Path]:
    """Return what writers that are gone have left half-written in a folder."""
    found: list[Path] = []
    with suppress(OSError), os.scandir(folder) as entries:
        for entry in entries:
            match = _UNFINISHED.fullmatch(entry.name)
            if match and entry.is_file(follow_symlinks=False) and _is_forsaken(match["mark"], entry):
                found.append(Path(entry.path))
    return found


def _is_forsaken(mark: str | None, entry: os.DirEntry[str]) -> bool:
    gone = mark_is_gone(mark) if mark is not None else None
    if gone is None:
        with suppress(OSError):
            return time.time() - entry.stat().st_mtime > FORSAKEN
    return bool(gone)
