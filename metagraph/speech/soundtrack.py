"""The sound of a performance: its lines' files, each where it is said, mixed into one track."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.common.wording import phrase
from metagraph.errors import FileError
from metagraph.graph.requests import Line
from metagraph.playback.plan import Plan
from metagraph.speech.sound import read_sound

Array = NDArray[Any]

RATE = 44100  # samples a second
FADE = 0.02  # seconds in which a line that is cut short goes


def place_line_sounds(
    lines: Mapping[str, Line], folder: Path, rate: int = RATE
) -> tuple[dict[str, Array], tuple[str, ...]]:
    """Return the samples of each line that has sound, `[N]` float32 at `rate`, and what could not be read, in
    words.
    """
    sounds: dict[str, Array] = {}
    notes: list[str] = []
    for ident, line in lines.items():
        if line.audio:
            try:
                samples, own = read_sound(folder / line.audio, line.channel)
            except FileError as error:
                notes.append(phrase("line '{ident}': {why}", ident=ident, why=error.words))
                continue
            sounds[ident] = resample_sound(samples, own, rate)
    return sounds, tuple(notes)


def resample_sound(samples: Array, rate: int, wanted: int) -> Array:
    """Return samples `[N]` at another rate, float32."""
    samples = np.asarray(samples, np.float32)
    if rate == wanted or len(samples) < 2:
        return samples
    import soxr

    return np.asarray(soxr.resample(samples, rate, wanted), np.float32)


def place_lines(plan: Plan, sounds: Mapping[str, Array], rate: int = RATE) -> list[tuple[float, Array]]:
    """Return each spoken line's start and samples, cut where the plan cuts the line."""
    out: list[tuple[float, Array]] = []
    for speech in plan.track.speeches:
        samples = sounds.get(speech.line or "")
        if samples is None:
            continue
        samples = samples[round(speech.skip * rate) :]  # what was said before a pause
        count = round((speech.end - speech.start) * rate)
        if count < len(samples) - rate // 100:
            samples = samples[: max(count, 0)].copy()
            last = min(len(samples), round(FADE * rate))
            samples[len(samples) - last :] *= np.linspace(1, 0, last, dtype=np.float32)
        out.append((speech.start, samples))
    return out


def mix_track(parts: list[tuple[float, Array]], start: int, count: int, rate: int = RATE) -> Array:
    """Return samples `start`..`start + count` of the track, `[count]` float32 within -1..1. Silent outside
    its parts.
    """
    out = np.zeros(count, np.float32)
    for at, samples in parts:
        first = round(at * rate) - start
        low, high = max(first, 0), min(first + len(samples), count)
        if low < high:
            out[low:high] += samples[low - first : high - first]
    return np.clip(out, -1, 1, out=out)
