"""Which shape the mouth has: the voices of what is said, at any time."""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.graph.face.names import VISEMES
from metagraph.playback.life.items import find_line_start
from metagraph.playback.life.mouth import soften
from metagraph.playback.life.track import Speech, Track
from metagraph.playback.life.voice import Voice, choose_voice

Array = NDArray[Any]

CLOSING = 0.12  # seconds the mouth takes to close where speech was cut
_TAPS = np.array([-1.0, 0.0, 1.0])


def compute_mouth_shapes(
    track: Track, voices: Mapping[str, Voice], smoothing: float, times: Array
) -> Array | None:
    """Return how much of each shape but silence the mouth shows at `times [N]`: `[N, 14]`; None if nothing is
    said.
    """
    if not track.speeches or not len(times):
        return None
    first = bisect_left(track.speeches, times.min() - CLOSING - smoothing, key=lambda s: s.end)
    last = bisect_right(track.speeches, times.max() + smoothing, key=lambda s: s.start)
    out: Array | None = None
    for speech in track.speeches[first:last]:
        here = np.flatnonzero((times > speech.start - smoothing) & (times < speech.end + CLOSING + smoothing))
        if len(here):
            if out is None:
                out = np.zeros((len(times), len(VISEMES) - 1))
            out[here] += _shown(speech, choose_voice(voices, speech), smoothing, times[here])
    if out is not None:  # two speeches may meet; together they are one mouth
        out /= np.maximum(out.sum(1, keepdims=True), 1.0)
    return out


def _shown(speech: Speech, voice: Voice, smoothing: float, times: Array) -> Array:
    """Return a speech's shapes, smoothed over `smoothing` seconds before and after (`mouth.soften`)."""
    if smoothing <= 0:
        return _at(speech, voice, times)
    taps = _at(speech, voice, (times[:, None] + smoothing * _TAPS).reshape(-1))
    out: list[list[float]] = []
    for before, now, after in taps.reshape(len(times), 3, -1).tolist():
        out.append([0.0] * len(now))
        soften(out[-1], before, now, after)
    return np.array(out)


def _at(speech: Speech, voice: Voice, times: Array) -> Array:
    said = np.minimum(times, speech.end) - find_line_start(speech)
    keys = voice.times
    low = np.minimum(np.maximum(keys.searchsorted(said, "right") - 1, 0), len(keys) - 2)
    part = np.minimum(np.maximum((said - keys[low]) / np.maximum(keys[low + 1] - keys[low], 1e-9), 0.0), 1.0)[
        :, None
    ]
    shown = voice.weights[low, 1:] * (1 - part) + voice.weights[low + 1, 1:] * part
    gone = np.minimum(np.maximum((times - speech.end) / CLOSING, 0.0), 1.0)
    kept = np.where(times < speech.start, 0.0, 1 - gone * gone * (3 - 2 * gone))
    return np.asarray(shown * kept[:, None])
