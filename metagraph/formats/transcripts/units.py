"""The unit of a file's times, where the file does not name it: told by how long the sound is, and by how fast
people speak.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from math import log
from statistics import median

from metagraph.common.wording import Phrase, phrase

SLOWEST = 3.0  # seconds a letter: the slowest speech has a fifth of that
FASTEST = 0.015  # seconds a letter: hurried speech has twice that
_USUAL = 0.08  # seconds a letter in conversation: about five syllables a second (Tauroza and Allison 1990)
_SURELY_NOT = max(SLOWEST, 1000 * FASTEST)  # above it no times are seconds, whatever lasts so long
_SLACK = 1.05, 2.0  # by how much words may pass the end of the sound: a share, and seconds
_MILLISECONDS = 1e-3
# Ticks are what .NET, and so Azure, counts in.
UNITS: Sequence[tuple[float, Phrase]] = (
    (_MILLISECONDS, phrase("milliseconds")),
    (1e-2, phrase("hundredths of a second")),
    (1e-7, phrase("ticks of 100 nanoseconds")),
    (1e-6, phrase("microseconds")),
    (1e-9, phrase("nanoseconds")),
)


def infer_time_unit(
    spans: Iterable[tuple[float, float, str]], sound: float | None
) -> tuple[float, Phrase | None]:
    """Return the seconds of one of a file's units of time, and a note about it; None for plain seconds.

    spans: start, end and text of what is said, in the file's unit. sound: seconds, None if nobody knows.

    Times are seconds as long as they fit into the sound and no text lasts impossibly long. Else the unit
    counts at which both hold, and of several the one nearest to usual speech. Without the sound, only whole
    numbers are taken for anything but seconds.
    """
    given = list(spans)
    rates = [(end - start) / letters for start, end, text in given if (letters := _letters(text))]
    if not rates:
        return 1.0, None
    rate, last = median(rates), max(end for _, end, _ in given)
    most = None if sound is None else sound * _SLACK[0] + _SLACK[1]
    if (most is None or last <= most) and rate <= _SURELY_NOT:
        return 1.0, None
    whole = all(float(t).is_integer() for start, end, _ in given for t in (start, end))
    if most is None and not whole:
        return 1.0, None
    fitting = [
        (unit, name)
        for unit, name in UNITS
        if FASTEST <= rate * unit <= SLOWEST and (last * unit <= most if most is not None else unit != 1e-2)
    ]
    if not fitting:
        return 1.0, None
    unit, name = min(fitting, key=lambda one: abs(log(rate * one[0] / _USUAL)))
    if sound is None:
        if unit == _MILLISECONDS:
            return unit, phrase("its times are whole numbers too large for seconds: read as milliseconds")
        return unit, phrase("its times are whole numbers too large for seconds: read as {name}", name=name)
    return unit, phrase(
        "its times are read as {name}, because as seconds they would last {last:.0f} s and the sound lasts "
        "{sound:.1f} s",
        name=name,
        last=last,
        sound=sound,
    )


def _letters(text: str) -> int:
    return sum(c.isalnum() for c in text)
