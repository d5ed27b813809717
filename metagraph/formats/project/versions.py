"""Earlier versions of a project file: each save keeps what stood there before, as `name.metagraph.yaml.1`,
the most recent, `.2` and so on.
"""

from __future__ import annotations

import errno
import os
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from metagraph.common.budgets import TEXT_FILE
from metagraph.common.files import read_file
from metagraph.common.wording import Phrase, phrase
from metagraph.errors import FileError
from metagraph.formats.atomic import write_atomically
from metagraph.formats.new_file import Access, access_of, open_new
from metagraph.formats.replacing import make_unfinished_name, sync_folder, write_all
from metagraph.formats.store import SUFFIX

KEPT = 3  # versions, unless the settings say otherwise
MOST = 99


@dataclass(frozen=True)
class Version:
    """An earlier version. number: 1 is the most recent. saved: when it was saved, seconds since 1970."""

    path: Path
    number: int
    saved: float


def make_version_path(path: Path, number: int) -> Path:
    """Return where an earlier version of a project file lies: beside the file itself, not beside a link."""
    path = path.resolve()
    return path.with_name(f"{path.name}.{number}")


def is_version(path: Path) -> bool:
    """Return whether a file is called like an earlier version of a project."""
    stem, _, number = path.name.rpartition(".")
    return stem.endswith(SUFFIX) and number.isascii() and number.isdigit() and not number.startswith("0")


def list_earlier_versions(path: Path) -> tuple[Version, ...]:
    """Return the earlier versions of a project file that there are, the most recent first."""
    whole = path.resolve()
    found = []
    with suppress(OSError):
        for entry in os.scandir(whole.parent):
            stem, _, number = entry.name.rpartition(".")
            plain = number.isascii() and number.isdigit() and not number.startswith("0")
            if stem == whole.name and plain and int(number) <= MOST and entry.is_file(follow_symlinks=False):
                found.append(Version(Path(entry.path), int(number), entry.stat().st_mtime))
    return tuple(sorted(found, key=lambda version: version.number))


def write_project(path: Path, content: bytes, versions: int, like: Access | None = None) -> Phrase | None:
    """Write a project file, and keep what stood there as its most recent earlier version. Raises FileError if
    the file itself cannot be written.

    versions: how many are kept; 0 keeps none, and leaves those that are there alone. like: who may read the
    file if there is none yet. Returns why the version could not be kept, None if all went well: what is to be
    saved is worth more than what was.
    """
    note = None
    if versions > 0:
        try:
            _keep(path.resolve(), content, min(versions, MOST))
        except (OSError, FileError) as error:
            cause = error.cause if isinstance(error, FileError) else error.strerror or str(error)
            note = phrase(
                "{name} was saved, but its earlier version could not be kept ({cause}). "
                "Free some disk space, and check that you may write there.",
                name=path.name,
                cause=cause,
            )
    write_atomically(path, content, like)
    return note


def _keep(path: Path, content: bytes, versions: int) -> None:
    """Copy a file to its first version; the others move up by one, and the oldest goes. Nothing is kept
    twice. The file itself is not touched, so that it is there at every moment. Raises OSError, FileError.
    """
    if not path.is_file() or not os.access(path, os.W_OK):
        return  # there is nothing, or it cannot be written either
    before = read_file(path, TEXT_FILE)
    first = make_version_path(path, 1)
    if before == content or (first.is_file() and first.read_bytes() == before):
        return
    for number in range(1, versions + 1):
        if make_version_path(path, number).is_dir():
            raise IsADirectoryError(errno.EISDIR, f"{make_version_path(path, number).name} is a folder")
    copy = _copied(path, before)
    try:
        free = next((n for n in range(1, versions + 1) if not make_version_path(path, n).exists()), versions)
        for number in range(free, 1, -1):
            make_version_path(path, number - 1).replace(make_version_path(path, number))
        copy.replace(first)
    finally:
        copy.unlink(missing_ok=True)
    for version in list_earlier_versions(path):
        if version.number > versions:
            version.path.unlink(missing_ok=True)
    sync_folder(path.parent)


def _copied(path: Path, content: bytes) -> Path:
    """Return an unfinished copy of a file beside it, on the disk, with its rights and its time."""
    state = path.stat()
    copy = path.with_name(make_unfinished_name())
    handle = open_new(copy, access_of(path))
    try:
        try:
            write_all(handle, content)
            os.fsync(handle)
        finally:
            os.close(handle)
        with suppress(OSError):
            os.utime(copy, ns=(state.st_atime_ns, state.st_mtime_ns))
    except BaseException:
        copy.unlink(missing_ok=True)
        raise
    return copy
