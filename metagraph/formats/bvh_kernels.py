"""Compiled loops of the BVH reader. Importing this imports numba (half a second): only large files do."""

from __future__ import annotations

from typing import Any

import numpy as np

from metagraph.compiling import compiler

KEPT, SOURCES = ("parse", "turn"), ()

_POWERS = 10.0 ** np.arange(23)  # exact in double precision

_compiled = compiler(nogil=True, fastmath={"contract", "arcp", "nsz"})


@_compiled
def parse(data: Any, at: int, end: int, out: Any) -> tuple[int, int]:
    """Read decimal numbers between white space from bytes `data[at:end]` into `out`.

    Returns how many there were, and where reading stopped: `end`, or the first byte of what is not a number,
    or the first number that no longer fits or is over a billion.
    """
    count = 0
    while True:
        while at < end and (data[at] == 32 or 9 <= data[at] <= 13):
            at += 1
        if at >= end:
            return count, end
        start = at
        if count >= len(out):
            return count, start
        negative = data[at] == 45
        if negative or data[at] == 43:
            at += 1
        whole, digits, shift = np.int64(0), 0, 0
        while at < end and 48 <= data[at] <= 57:
            if digits < 18:
                whole = whole * 10 + (np.int64(data[at]) - 48)
                if whole:
                    digits += 1
            else:
                shift += 1
            at += 1
        any_digit = at > start and 48 <= data[at - 1] <= 57
        if at < end and data[at] == 46:
            at += 1
            while at < end and 48 <= data[at] <= 57:
                any_digit = True
                if digits < 18:
                    whole = whole * 10 + (np.int64(data[at]) - 48)
                    if whole:
                        digits += 1
                    shift -= 1
                at += 1
        if not any_digit:
            return count, start
        if at < end and (data[at] == 101 or data[at] == 69):
            at += 1
            down = at < end and data[at] == 45
            if at < end and (data[at] == 45 or data[at] == 43):
                at += 1
            if at >= end or not 48 <= data[at] <= 57:
                return count, start
            power = 0
            while at < end and 48 <= data[at] <= 57:
                if power < 9999:
                    power = power * 10 + int(data[at]) - 48
                at += 1
            shift += -power if down else power
        if at < end and not (data[at] == 32 or 9 <= data[at] <= 13):
            return count, start
        value = float(whole)
        if shift < 0:
            value = value / _POWERS[-shift] if shift >= -22 else value * 10.0**shift
        elif shift > 0:
            value = value * _POWERS[shift] if shift <= 22 else value * 10.0**shift
        if not value <= 1e9:
            return count, start
        out[count] = -value if negative else value
        count += 1


@_compiled
def turn(values: Any, first: int, last: int, starts: Any, axes: Any, columns: Any, out: Any) -> None:
    """Write quaternions of frames `first` to `last` into `out [F, J, 4]` float32.

    values: `[F, C]` degrees. Joint j turns about `axes[starts[j] : starts[j + 1]]` (0 x, 1 y, 2 z), the first
    outermost, by the angles in `columns` at the same places. Neighbouring frames lie on the same side.
    """
    joints, turns = len(starts) - 1, len(columns)
    half, sine, cosine = np.empty(turns), np.empty(turns), np.empty(turns)
    to_half = np.pi / 360.0
    for f in range(first, last):
        for k in range(turns):
            degrees = values[f, columns[k]]
            half[k] = (degrees - 360.0 * np.floor(degrees / 360.0 + 0.5)) * to_half
        # Taylor series on -pi/2..pi/2, error below 1e-9; whole turns only flip the quaternion's sign.
        for k in range(turns):
            x = half[k] * half[k]
            s = 1 / 6227020800.0
            s = s * x - 1 / 39916800.0
            s = s * x + 1 / 362880.0
            s = s * x - 1 / 5040.0
            s = s * x + 1 / 120.0
            s = s * x - 1 / 6.0
            sine[k] = (s * x + 1.0) * half[k]
            c = -1 / 87178291200.0
            c = c * x + 1 / 479001600.0
            c = c * x - 1 / 3628800.0
            c = c * x + 1 / 40320.0
            c = c * x - 1 / 720.0
            c = c * x + 1 / 24.0
            c = c * x - 0.5
            cosine[k] = c * x + 1.0
        for j in range(joints):
            x, y, z, w = 0.0, 0.0, 0.0, 1.0
            for k in range(starts[j], starts[j + 1]):
                s, c = sine[k], cosine[k]
                if axes[k] == 0:
                    x, y, z, w = x * c + w * s, y * c + z * s, z * c - y * s, w * c - x * s
                elif axes[k] == 1:
                    x, y, z, w = x * c - z * s, y * c + w * s, z * c + x * s, w * c - y * s
                else:
                    x, y, z, w = x * c + y * s, y * c - x * s, z * c + w * s, w * c - z * s
            if (
                f > first
                and x * out[f - 1, j, 0] + y * out[f - 1, j, 1] + z * out[f - 1, j, 2] + w * out[f - 1, j, 3]
                < 0
            ):
                x, y, z, w = -x, -y, -z, -w
            out[f, j, 0], out[f, j, 1], out[f, j, 2], out[f, j, 3] = x, y, z, w


def warm() -> None:
    """Have ready what files are read with."""
    parse(np.frombuffer(b"", np.uint8), 0, 0, np.zeros(0))
    numbers = np.zeros(0, np.int64)
    turn(np.zeros((0, 0)), 0, 0, np.zeros(1, np.int64), numbers, numbers, np.zeros((0, 0, 4), np.float32))
