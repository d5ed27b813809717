"""When somebody speaks, by loudness alone: what stands out of a channel's own noise, and is not the partner
heard through one's microphone.

Levels are relative to the channel's, so gain does not matter. It tells speech from silence and steady noise,
not from music or laughter.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.speech.pitch import Pitch, list_runs
from metagraph.speech.sound import HOP, HeardSound

Array = NDArray[Any]

HUSH = -75.0  # dB of full scale: softer than this nobody speaks
LEAST = 12.0  # dB between the noise and the loudest speech
ABOVE = 0.35  # of that: how far above the noise speech begins
AGAIN = 4.0  # dB softer than that it may become before it ends
BELOW = 32.0  # dB under the loudest that speech begins at least
PAUSE = 0.25  # seconds of silence that part what is spoken; shorter ones are stops and breath within it
SHORTEST = 0.10  # seconds; shorter is a click
VOICED = 0.15  # share of a stretch that is voiced, or it is a breath, a cough, a chair
BLEED = 7.0  # dB louder than what the partner's microphone explains
APART = 10.0  # dB between the two channels' levels, one's own speech and the partner's


@dataclass(frozen=True, slots=True)
class SpokenStretch:
    """Something said without a pause. start, end: seconds."""

    start: float
    end: float


def find_activity(
    heard: HeardSound, pitch: Pitch | None = None, partner: HeardSound | None = None
) -> tuple[SpokenStretch, ...]:
    """Return when somebody speaks, by start, pauses between. pitch: of the same channel, to leave out what is
    not voiced. partner: what the other's microphone hears, of the same conversation, to leave out what only
    crosses over.
    """
    return tuple(_spoken(heard, pitch, partner))


def _spoken(heard: HeardSound, pitch: Pitch | None, partner: HeardSound | None) -> list[SpokenStretch]:
    level = heard.level
    own = np.ones(len(level), bool) if partner is None else is_not_crosstalk(heard, partner)
    if not own.any():
        return []
    floor, top = float(np.percentile(level, 10)), float(np.percentile(level[own], 99.5))
    if top < HUSH or top - floor < LEAST:
        return []
    begin = max(floor + ABOVE * (top - floor), floor + 0.6 * LEAST, top - BELOW)
    loud = (level > begin) & own
    held = (level > begin - AGAIN) & own
    runs = [(a, b) for a, b in list_runs(held) if loud[a:b].any()]
    joined: list[tuple[int, int]] = []
    for a, b in runs:
        if joined and (a - joined[-1][1]) * HOP < PAUSE:
            joined[-1] = joined[-1][0], b
        else:
            joined.append((a, b))
    out = []
    for a, b in joined:
        if (b - a) * HOP < SHORTEST or (pitch is not None and not _voiced(pitch, a, b)):
            continue
        out.append(
            SpokenStretch(
                round(float(heard.times[a]), 3),
                round(min(float(heard.times[b - 1]) + HOP, heard.duration), 3),
            )
        )
    return [s for s in out if s.start < s.end]


def _voiced(pitch: Pitch, a: int, b: int) -> bool:
    return float((~np.isnan(pitch.hertz[a:b])).mean() if len(pitch.hertz[a:b]) else 0.0) >= VOICED


def measure_crosstalk(heard: HeardSound, partner: HeardSound) -> float:
    """Return how loud the partner is in one's own microphone, dB relative to the partner's: their middle over
    the moments in which only the partner seems to speak. -inf where the partner says nothing.
    """
    count = min(len(heard.level), len(partner.level))
    mine, theirs = heard.level[:count], partner.level[:count]
    floor, top = float(np.percentile(theirs, 10)), float(np.percentile(theirs, 99.5))
    if top < HUSH or top - floor < LEAST:
        return -np.inf
    speaking = theirs > max(floor + 0.5 * (top - floor), top - BELOW)
    apart = (mine - theirs)[speaking]
    # Two kinds of moments: those in which one speaks oneself as well lie higher.
    low, high = np.percentile(apart, (10, 90)).tolist()
    for _ in range(20):
        upper = apart > (low + high) / 2
        if not upper.any() or upper.all():
            break
        low, high = float(apart[~upper].mean()), float(apart[upper].mean())
    return low if high - low > APART else float(np.median(apart))


def is_not_crosstalk(heard: HeardSound, partner: HeardSound) -> Array:
    """Return which moments `[K]` are louder than what comes over from the partner."""
    bleed = measure_crosstalk(heard, partner)
    count = min(len(heard.level), len(partner.level))
    if (
        not np.isfinite(bleed) or bleed > -3.0
    ):  # one's own voice is as loud there: the two cannot be distinguished by that
        return np.ones(len(heard.level), bool)
    out = np.ones(len(heard.level), bool)
    # Rooms answer late: what came over in the last 30 ms counts.
    late = np.max(
        np.lib.stride_tricks.sliding_window_view(np.pad(partner.level[:count], (3, 0), "edge"), 4), axis=1
    )
    out[:count] = heard.level[:count] > late + bleed + BLEED
    return out
