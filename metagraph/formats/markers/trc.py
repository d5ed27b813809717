"""TRC: the table of markers that Motion Analysis' programs, OpenSim, OpenCap and Pose2Sim write.

The second and third line name and give the rate and the unit, the fourth the markers, the fifth their axes.
A row has its number, its time and three numbers a marker, between tabs; a marker that was not seen has none.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from metagraph.common.budgets import KEYPOINT_FRAMES, KEYPOINTS_FILE
from metagraph.common.files import guard_reader, read_file
from metagraph.common.wording import phrase
from metagraph.errors import FileError
from metagraph.formats.markers.marker_take import (
    AGAIN,
    MOST_MARKERS,
    MarkerTake,
    check_rate,
    find_metres,
    hide_zeros,
)


@guard_reader
def read_trc(path: str | Path) -> MarkerTake:
    """Return the markers of a TRC file. Raises FileError."""
    path = Path(path)
    lines = read_file(path, KEYPOINTS_FILE).decode("utf-8-sig", "replace").splitlines()
    notes: list[str] = []
    if not any("." in line for line in lines[5:]) and any("," in line for line in lines[5:]):
        lines[2:3] = [x.replace(",", ".") for x in lines[2:3]]
        lines[5:] = [line.replace(",", ".") for line in lines[5:]]
        notes.append(phrase("its decimal commas were read as points"))
    if len(lines) < 5:
        raise FileError(path, phrase("it ends in its header"), "", AGAIN)
    head = dict(zip(_cells(lines[1]), _cells(lines[2]), strict=False))
    rate = check_rate(path, _number(head.get("DataRate", "")))
    metres = find_metres(path, head.get("Units", "mm"))
    names = _names(lines[3])
    if not 0 < len(names) <= MOST_MARKERS:
        raise FileError(path, phrase("it names {count:,} markers", count=len(names)), "line 4", AGAIN)
    rows = [(n, line) for n, line in enumerate(lines[5:], 6) if line.strip()]
    if len(rows) > KEYPOINT_FRAMES:
        raise FileError(path, phrase("it has more than {most:,} frames", most=KEYPOINT_FRAMES), "", AGAIN)
    places = np.full((len(rows), 3 * len(names)), np.nan)
    tabs = "\t" in lines[3]
    for row, (number, line) in enumerate(rows):
        cells = line.split("\t") if tabs else line.split()
        for n, cell in enumerate(cells[2 : 2 + 3 * len(names)]):
            if cell.strip():
                places[row, n] = _number(cell)
        if not _number(cells[0]) >= 0:
            raise FileError(path, phrase("a row does not begin with its number"), f"line {number}", AGAIN)
    found = places.reshape(len(rows), len(names), 3) * metres
    hide_zeros(found)
    return MarkerTake(names, rate, found, tuple(notes))


def _names(line: str) -> tuple[str, ...]:
    """Return the names of markers: between tabs one in three cells, where one without a name may be empty;
    else one after another.
    """
    cells = _cells(line)[2:]
    while cells and not cells[-1]:
        cells.pop()
    if any(name for n, name in enumerate(cells) if n % 3):  # not above its first number
        return tuple(name for name in cells if name)
    return tuple(name or f"unnamed {n}" for n, name in enumerate(cells[::3], 1))


def _cells(line: str) -> list[str]:
    return [cell.strip() for cell in (line.split("\t") if "\t" in line else line.split())]


def _number(text: str) -> float:
    """Return a number, not a number for what is none or is too large."""
    try:
        value = float(text)
    except ValueError:
        return float("nan")
    return value if abs(value) < 1e9 else float("nan")
