"""Markers over time, as a motion capture system recorded them."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.common.wording import phrase
from metagraph.errors import FileError

Array = NDArray[Any]

METRES = {"m": 1.0, "dm": 0.1, "cm": 0.01, "mm": 0.001, "in": 0.0254, "ft": 0.3048}
_WORDS = {
    "meters": "m", "metres": "m", "meter": "m", "millimeters": "mm", "millimetres": "mm", "centimeters": "cm",
    "centimetres": "cm", "inch": "in", "inches": "in", "feet": "ft",
}  # fmt: skip
MOST_MARKERS = 1000
AGAIN = phrase("Export it again from the program that made it.")


@dataclass(frozen=True, eq=False)
class MarkerTake:
    """What was recorded. names of the M markers; rate: frames a second; places `[F, M, 3]` metres in the
    laboratory's axes, not a number where a marker was not seen. notes: what was inferred, in words.
    """

    names: tuple[str, ...]
    rate: float
    places: Array
    notes: tuple[str, ...] = ()


def check_rate(path: Path, rate: float) -> float:
    """Return how many frames a second there are. Raises FileError for what cannot be."""
    if not 1 <= rate <= 10_000:
        raise FileError(path, phrase("it has {rate:g} frames a second", rate=rate), "", AGAIN)
    return rate


def find_metres(path: Path, unit: str) -> float:
    """Return how long a file's unit is, in metres. Raises FileError for one that is not known."""
    word = unit.strip().lower().rstrip(".")
    word = _WORDS.get(word, word)
    if word not in METRES:
        raise FileError(
            path,
            phrase("its unit is '{unit}'", unit=unit[:20]),
            phrase("in its header"),
            phrase("Export it in millimetres or metres."),
        )
    return METRES[word]


def hide_zeros(places: Array) -> None:
    """Say of markers `[F, M, 3]` that lie exactly in the origin that they were not seen, in place: many
    programs write zeros for them.
    """
    places[(places == 0.0).all(-1)] = np.nan
