"""Where a window lets programs of the same user in: a port of this computer and a token, in a file that only
the user can read.
"""

from __future__ import annotations

import hashlib
import os
from contextlib import suppress
from pathlib import Path

import msgspec

from app.project.autosave import state_folder
from metagraph.common.files import read_file
from metagraph.errors import FileError
from metagraph.formats.atomic import write_atomically
from metagraph.formats.new_file import PRIVATE

LARGEST = 4096  # bytes of a key


class DoorKey(msgspec.Struct, frozen=True):
    """How to reach a window that has a project open."""

    port: int
    token: str
    pid: int


class DoorHello(msgspec.Struct, frozen=True):
    """The first line that a program sends to a window. folders: those that it may use besides the project's.
    look_only: whether it may not edit.
    """

    token: str
    folders: tuple[str, ...] = ()
    look_only: bool = False


def leave_key(project: Path, port: int, token: str) -> Path:
    """Write how to reach this process for a project; return the file. Raises FileError."""
    place = _find_place(project)
    place.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
    write_atomically(place, msgspec.json.encode(DoorKey(port, token, os.getpid())), PRIVATE)
    return place


def find_key(project: Path) -> DoorKey | None:
    """Return how to reach the window that lets programs in to a project; None if none does."""
    try:
        return msgspec.json.decode(read_file(_find_place(project), LARGEST), type=DoorKey)
    except (FileError, OSError, msgspec.MsgspecError):
        return None


def remove_key(place: Path) -> None:
    """Remove a file that `leave_key` wrote."""
    with suppress(OSError):
        place.unlink()


def _find_place(project: Path) -> Path:
    name = hashlib.sha256(os.fsencode(project.resolve())).hexdigest()[:32]
    return state_folder() / "agents" / name
