"""What is known of a spoken line's sound: how long it is, where it is loudest, and which mouth shapes it goes through."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]

# The 15 mouth shapes most rigs and lip-sync tools share (Oculus), silence first.
VISEMES: tuple[str, ...] = ("sil", "PP", "FF", "TH", "DD", "kk", "CH", "SS", "nn", "RR", "aa", "E", "I", "O", "U")


@dataclass(frozen=True, eq=False)
class Voice:
    """One line, analysed. duration: seconds. peaks: times of its loudness peaks `[P]`. times `[K]`, weights `[K, 15]`: how
    much of each of `VISEMES` the mouth shows, 0..1, linear between the times."""

    duration: float
    peaks: Array
    times: Array
    weights: Array


def silent(duration: float) -> Voice:
    """Return a voice that says nothing for `duration` seconds."""
    rest = np.zeros((2, len(VISEMES)), np.float32)
    rest[:, 0] = 1
    return Voice(duration, np.zeros(0), np.array([0.0, duration]), rest)
