"""Envelopes: least and greatest of every column of pixels, right at every zoom, and never looking at more
than there are pixels for.
"""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PySide6.QtGui import QColor

from app.widgets.waveforms import RATE, Envelope, join_columns, paint_columns


def made(seconds: float, seed: int = 3) -> tuple[Envelope, np.ndarray]:
    values = np.random.default_rng(seed).standard_normal(round(seconds * RATE)).astype(np.float32)
    out = Envelope(seconds)
    out.fill(0, values)
    return out, values


@given(each=st.floats(0.6, 400), first=st.floats(0, 50))
def test_a_column_spans_what_is_in_it_to_a_pixel(each: float, first: float) -> None:
    wave, values = made(60)
    low, high = wave.columns(first, each, 200)
    for n in range(1, 199, 17):
        a, b = (int((first + (n + k) / each) * RATE) for k in (0, 1))
        if b >= len(values) or b <= a:
            continue
        wide = max(8, 4 * int(RATE / each) + 4)
        near = values[max(0, a - wide) : b + wide]
        beside = slice(max(0, n - 1), n + 2)  # an edge may lie a bin off, less than a pixel
        assert low[beside].min() <= values[a:b].min() + 1e-6
        assert high[beside].max() >= values[a:b].max() - 1e-6
        assert near.min() - 1e-6 <= low[n]
        assert high[n] <= near.max() + 1e-6


@pytest.mark.parametrize("each", [0.6, 2, 7, 44, 150, 400])
def test_half_an_hour_is_as_little_work_as_a_minute_at_every_zoom(each: float) -> None:
    wave, _ = made(1800)
    for first in (0.0, 700.0, 1799.0):
        wave.worked = 0
        wave.columns(first, each, 1500)
        assert wave.worked <= 4 * 1500 + 8


def test_what_is_not_filled_yet_and_what_is_voiceless_is_nothing() -> None:
    pitch = Envelope(10, 100)
    hertz = np.full(600, np.nan)
    hertz[100:200] = 150
    pitch.fill(0, hertz)
    for each in (20, 100, 400):
        low, high = pitch.columns(0, each, round(10 * each))
        there = np.flatnonzero(high >= low) / each
        assert there.min() == pytest.approx(1.0, abs=0.06)
        assert there.max() == pytest.approx(2.0, abs=0.06)


def test_filled_piece_by_piece_it_is_the_same() -> None:
    whole, values = made(30)
    parts = Envelope(30)
    for first in range(0, len(values), 777):
        parts.fill(first, values[first : first + 777])
    for a, b in zip(whole.lows + whole.highs, parts.lows + parts.highs, strict=True):
        assert np.array_equal(a, b)


@pytest.mark.parametrize("samples", [0, 1, 3])
def test_the_shortest_sounds_do_no_harm(samples: int) -> None:
    wave = Envelope(samples / 16000)
    wave.fill(0, np.zeros(samples), 40)
    low, high = wave.columns(0, 44, 10)
    assert (high >= low).sum() == (1 if samples else 0)


def test_columns_touch_and_are_painted_where_they_are() -> None:
    top, bottom = join_columns(np.array([2.0, 8.0, np.inf]), np.array([3.0, 9.0, -np.inf]), 1.0)
    assert top[1] <= 3.0 < 9.0 <= bottom[1]
    image = paint_columns(top, bottom, 12, QColor("#ff0000"))
    assert (image.width(), image.height()) == (3, 12)
    assert QColor(image.pixelColor(0, 2)).red() == 255
    assert image.pixelColor(0, 6).alpha() == 0
    assert all(image.pixelColor(2, y).alpha() == 0 for y in range(12))
