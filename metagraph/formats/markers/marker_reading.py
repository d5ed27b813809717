"""Tell files of markers by how they begin, and read them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from metagraph.common.budgets import KEYPOINTS_FILE
from metagraph.common.files import open_file
from metagraph.common.wording import phrase
from metagraph.errors import FileError
from metagraph.formats.markers.marker_take import AGAIN, MarkerTake


def is_trc(head: bytes) -> bool:
    """Return whether a file that begins so is a TRC file."""
    return head.lstrip(b"\xef\xbb\xbf \t\r\n")[:12].lower() == b"pathfiletype"


def is_c3d(head: bytes) -> bool:
    """Return whether a file that begins so is a C3D file: its second byte is always 80, the block of its
    parameters is one of the first.
    """
    return len(head) > 1 and head[1] == 0x50 and 2 <= head[0] <= 8


def find_marker_reader(head: bytes) -> Callable[[Path], MarkerTake] | None:
    """Return what reads a file that begins so; None if it holds no markers."""
    if is_trc(head):
        from metagraph.formats.markers.trc import read_trc

        return read_trc
    if is_c3d(head):
        from metagraph.formats.markers.c3d_file import read_c3d

        return read_c3d
    return None


def read_markers(path: str | Path) -> MarkerTake:
    """Return the markers of a TRC or C3D file. Raises FileError."""
    path = Path(path)
    with open_file(path, KEYPOINTS_FILE) as file:
        read = find_marker_reader(file.read(64))
    if read is None:
        raise FileError(path, phrase("it is neither a TRC nor a C3D file"), "", AGAIN)
    return read(path)
