"""Putting a whole file in the place of another, with nothing asked and nobody told; `atomic` does both."""

from __future__ import annotations

import errno
import os
import uuid
from contextlib import suppress
from pathlib import Path

from metagraph.formats.locking import process_mark
from metagraph.formats.new_file import Access, access_of, open_new


def replace_file(path: Path, content: bytes, sync: bool = True, like: Access | None = None) -> None:
    """Put a file in the place of what is there, or leave that as it was. Raises OSError.

    sync: wait until it is safely on the disk; before what is there goes. like: see `atomic.write_atomically`.
    """
    temporary: Path | None = path.with_name(make_unfinished_name())
    assert temporary is not None
    try:
        handle = open_new(temporary, access_of(path) or like)
        try:
            write_all(handle, content)
            if sync:
                os.fsync(handle)
        finally:
            os.close(handle)
        temporary.replace(path)
        temporary = None
    finally:
        if temporary is not None:
            with suppress(OSError):  # swept another time; why it was not written is to be told
                temporary.unlink(missing_ok=True)
    if sync:
        sync_folder(path.parent)


def write_all(handle: int, content: bytes) -> None:
    """Write all of it, however little the system takes at once. Raises OSError."""
    rest = memoryview(content)
    while rest:
        count = os.write(handle, rest)
        if count <= 0:
            raise OSError(errno.ENOSPC, "No space left on device")
        rest = rest[count:]


def sync_folder(folder: Path) -> None:
    """Let the names in a folder survive a power cut, where the system can do that; the files are there
    already.
    """
    if os.name == "nt":  # it has no handles of folders
        return
    with suppress(OSError):
        handle = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(handle)
        finally:
            os.close(handle)


def make_unfinished_name() -> str:
    """Return a name for a file that is being written by this process."""
    return f".saving-{process_mark()}-{uuid.uuid4().hex[:12]}"
