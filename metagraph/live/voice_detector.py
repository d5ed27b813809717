"""Whether somebody speaks, frame by frame as the sound comes in: for who does not say it."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]

QUIET = -50.0  # dB of full scale below which nobody speaks
ABOVE = 9.0  # dB above what is always heard
GOES_ON = 5  # frames after the last loud one: gaps within speech
RISES = 0.05  # dB a frame by which what is always heard may become louder


class VoiceDetector:
    """One voice's frames of sound, one after the other."""

    def __init__(self) -> None:
        self._floor = QUIET
        self._left = 0

    def hear(self, samples: Array) -> bool:
        """Return whether somebody speaks in a frame. samples: `[N]`, -1..1."""
        power = float(np.mean(np.square(samples))) if len(samples) else 0.0
        loud = 10 * np.log10(power + 1e-10)
        self._floor = min(loud, self._floor + RISES)
        if loud > max(QUIET, self._floor + ABOVE):
            self._left = GOES_ON + 1
        self._left = max(0, self._left - 1)
        return self._left > 0
