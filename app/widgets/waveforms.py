"""Curves as they are seen: the least and the greatest of every column of pixels, found as fast for half an
hour as for a second.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from PySide6.QtGui import QColor, QImage

Array = NDArray[Any]

RATE = 400.0  # bins of a waveform a second: as many as there are pixels where one is nearest
_FOUR, _LEVELS = 4, 7  # every level has a bin for so many of the one below


class Envelope:
    """Least and greatest values of a signal, in bins at ever coarser levels; filled from the front while it
    is being read.

    rate: bins a second at the finest level. What is not filled, or not there (nan), is nothing: +inf is its
    least, -inf its greatest.
    """

    def __init__(self, seconds: float, rate: float = RATE) -> None:
        self.rate = rate
        whole = _FOUR ** (_LEVELS - 1)
        count = -(-max(1, int(np.ceil(seconds * rate))) // whole) * whole
        self.lows = [np.full(count // _FOUR**n, np.inf, np.float32) for n in range(_LEVELS)]
        self.highs = [np.full(count // _FOUR**n, -np.inf, np.float32) for n in range(_LEVELS)]
        self.worked = 0  # bins that were looked at to paint, all in all

    def fill(self, first: int, values: Array, each: float = 1.0) -> None:
        """Fill bins from the `first` on from values `[N]`, `each` of them a bin; nan is nothing."""
        self.put(first, *measure_bins(values, each))

    def put(self, first: int, lows: Array, highs: Array) -> None:
        """Fill bins from the `first` on with their least and greatest values `[N]`; quick, for the window's
        thread.
        """
        count = min(len(lows), len(self.lows[0]) - first)
        if count <= 0:
            return
        end = first + count
        self.lows[0][first:end], self.highs[0][first:end] = lows[:count], highs[:count]
        for n in range(1, _LEVELS):
            first, end = first // _FOUR, -(-end // _FOUR)
            below = slice(first * _FOUR, end * _FOUR)
            self.lows[n][first:end] = self.lows[n - 1][below].reshape(-1, _FOUR).min(1)
            self.highs[n][first:end] = self.highs[n - 1][below].reshape(-1, _FOUR).max(1)

    def columns(self, first: float, each: float, width: int) -> tuple[Array, Array]:
        """Return the least and greatest `[width]` in columns of pixels. first: seconds at the left; each:
        pixels a second.
        """
        wanted = self.rate / each  # bins a column
        if wanted < 1:
            return self._between(first, each, width)
        level = min(_LEVELS - 1, int(np.log(wanted) / np.log(_FOUR) + 1e-9))
        low, high = self.lows[level], self.highs[level]
        rate = self.rate / _FOUR**level
        edges = np.floor((first + np.arange(width + 1) / each) * rate).astype(int)
        there = (edges[:-1] >= 0) & (edges[:-1] < len(low))
        edges = np.clip(edges, 0, len(low) - 1)
        begin, end = int(edges[0]), int(edges[-1]) + 1
        self.worked += end - begin
        # The last edge only ends the last column.
        lows = np.minimum.reduceat(low[begin:end], edges - begin)[:-1]
        highs = np.maximum.reduceat(high[begin:end], edges - begin)[:-1]
        return np.where(there, lows, np.inf), np.where(there, highs, -np.inf)

    def _between(self, first: float, each: float, width: int) -> tuple[Array, Array]:
        """Return the same where a bin is wider than a column: straight lines from bin to bin, never over
        nothing.
        """
        at = (first + np.arange(width + 1) / each) * self.rate - 0.5
        there = np.clip(np.floor(at).astype(int), 0, len(self.lows[0]) - 2)
        part = np.clip(at - there, 0, 1)
        self.worked += int(there[-1] - there[0]) + 2
        out = []
        for level in (self.lows[0], self.highs[0]):
            a, b = level[there], level[there + 1]
            nearest = np.where(part < 0.5, a, b)
            both = np.isfinite(a) & np.isfinite(b)
            with np.errstate(invalid="ignore"):
                out.append(np.where(both, a * (1 - part) + b * part, nearest))
        low, high = out
        return np.minimum(low[:-1], low[1:]), np.maximum(high[:-1], high[1:])


def measure_bins(values: Array, each: float = 1.0) -> tuple[Array, Array]:
    """Return the least and greatest `[B]` of bins of `each` values `[N]`; nan is nothing. For a thread: it
    takes what the values take.
    """
    values = np.asarray(values, np.float32)
    count = int(np.ceil(len(values) / each))
    if count <= 0:
        return np.empty(0, np.float32), np.empty(0, np.float32)
    starts = np.minimum((np.arange(count) * each).astype(int), len(values) - 1)
    lows = np.minimum.reduceat(np.where(np.isnan(values), np.inf, values), starts)
    return lows, np.maximum.reduceat(np.where(np.isnan(values), -np.inf, values), starts)


def join_columns(low: Array, high: Array, least: float) -> tuple[Array, Array]:
    """Return columns `[W]` of y, downwards, made to touch the one before, where both are something, and at
    least so thick.
    """
    there = high >= low
    with np.errstate(invalid="ignore"):
        before = np.roll(there, 1) & there
        before[:1] = False
        top = np.where(before, np.minimum(low, np.roll(high, 1)), low)
        bottom = np.where(before, np.maximum(high, np.roll(low, 1)), high)
        thin = np.maximum(0.0, least - (bottom - top)) / 2
    thin = np.where(there, thin, 0.0)
    return top - thin, bottom + thin


def paint_columns(low: Array, high: Array, height: int, color: QColor) -> QImage:
    """Return a picture of columns from `low` to `high` `[W]`, pixels from the top; nothing if low
    is greater.
    """
    rows = np.arange(height, dtype=np.float32)[:, None]
    top, bottom = (
        np.clip(low, -1, height + 1).astype(np.float32),
        np.clip(high, -1, height + 1).astype(np.float32),
    )
    cover = np.clip(np.minimum(rows + 1, bottom) - np.maximum(rows, top), 0.0, 1.0) * color.alphaF()
    cover[:, ~(high >= low)] = 0
    blue_first = np.array([color.blue(), color.green(), color.red(), 255], np.float32)
    pixels = np.ascontiguousarray((cover[..., None] * blue_first + 0.5).astype(np.uint8))
    image = QImage(
        pixels.data, pixels.shape[1], height, pixels.strides[0], QImage.Format.Format_ARGB32_Premultiplied
    )
    return image.copy()  # of its own, since the array goes
