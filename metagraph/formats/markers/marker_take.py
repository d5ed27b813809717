"""Markers over time, as a motion capture system recorded them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from numpy.typing import NDArray

from metagraph.common.budgets import KEYPOINTS_FILE
from metagraph.common.files import open_file
from metagraph.common.wording import phrase
from metagraph.errors import FileError

Array = NDArray[Any]

METRES = {"m": 1.0, "dm": 0.1, "cm": 0.01, "mm": 0.001, "in": 0.0254, "ft": 0.3048}
MOST_MARKERS = 1000
AGAIN = phrase("Export it again from the program it is from.")


@dataclass(frozen=True, eq=False)
class MarkerTake:
    """What was recorded. names of the M markers; rate: frames a second; places `[F, M, 3]` metres in the
    laboratory's axes, not a number where a marker was not seen. notes: what was inferred, in words.
    """

    names: tuple[str, ...]
    rate: float
    places: Array
    notes: tuple[str, ...] = ()


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


def check_rate(path: Path, rate: float) -> float:
    """Return how many frames a second there are. Raises FileError for what cannot be."""
    if not 1 <= rate <= 10_000:
        raise FileError(path, phrase("it has {rate:g} frames a second", rate=rate), "", AGAIN)
    return rate


def find_metres(path: Path, unit: str) -> float:
    """Return how long a file's unit is, in metres. Raises FileError for one that is not known."""
    word = unit.strip().lower().rstrip(".")
    word = {"meters": "m", "metres": "m", "meter": "m", "millimeters": "mm", "centimeters": "cm"}.get(
        word, word
    )
    if word not in METRES:
        raise FileError(
            path,
            phrase("its unit is '{unit}'", unit=unit[:20]),
            phrase("in its head"),
            phrase("Export it in millimetres or metres."),
        )
    return METRES[word]
