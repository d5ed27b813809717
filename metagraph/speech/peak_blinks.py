"""Blinks of one who speaks, as Yang et al. (section 7.3) key them: on the peaks of what is said, and if
nothing brings one for long.
"""

from __future__ import annotations

from collections.abc import Sequence

from metagraph.playback.planning.choice import uniform

AFTER = 1.0  # seconds since the last blink at which a peak brings another
WITHOUT = 5.0  # seconds without a blink, in which one is keyed at random


def place_peak_blinks(peaks: Sequence[float], length: float, seed: int, key: str = "") -> list[float]:
    """Return when somebody blinks from 0 to length seconds: at the first peak, at those that come at least
    `AFTER` seconds after the last blink, and once in each `WITHOUT` seconds in which there is none. peaks:
    seconds, ascending. key: of the draws.
    """
    keyed: list[float] = []
    for peak in peaks:
        if 0 <= peak < length and (not keyed or peak - keyed[-1] >= AFTER):
            keyed.append(peak)
    out: list[float] = []
    for until in (*keyed, length):
        last = out[-1] if out else 0.0
        while until - last > WITHOUT:
            latest = min(last + WITHOUT, until - (AFTER if until < length else 0.0))
            share = uniform(seed, key, "blink", str(len(out)))
            last = round(last + AFTER + (latest - last - AFTER) * share, 3)
            out.append(last)
        if until < length:
            out.append(until)
    return out
