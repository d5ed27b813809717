"""Blinks as the conversation paper keys them (section 7.3)."""

from __future__ import annotations

from itertools import pairwise

from hypothesis import given
from hypothesis import strategies as st

from metagraph.speech.peak_blinks import AFTER, WITHOUT, place_peak_blinks


def test_the_first_peak_brings_a_blink_and_later_ones_a_second_after_the_last() -> None:
    assert place_peak_blinks([0.4, 0.9, 1.39, 1.5, 2.3, 2.6], 4.0, 1) == [0.4, 1.5, 2.6]


def test_five_seconds_without_one_bring_one() -> None:
    found = place_peak_blinks([2.0, 12.0], 13.0, 1)
    assert found[0] == 2.0 and found[-1] == 12.0 and len(found) in (4, 5)
    assert place_peak_blinks([], 4.9, 1) == []
    assert len(place_peak_blinks([], 5.1, 1)) == 1


def test_peaks_outside_the_conversation_bring_none() -> None:
    assert place_peak_blinks([-1.0, 3.0, 4.0], 4.0, 1) == [3.0]


@given(
    st.lists(st.floats(0.0, 9.0), max_size=30),
    st.floats(0.1, 60.0),
    st.integers(0, 2**32 - 1),
    st.text(max_size=3),
)
def test_nobody_stares_nor_blinks_twice_in_a_second(
    gaps: list[float], length: float, seed: int, key: str
) -> None:
    at, peaks = 0.0, []
    for gap in gaps:
        at += gap
        peaks.append(at)
    found = place_peak_blinks(peaks, length, seed, key)
    assert found == place_peak_blinks(peaks, length, seed, key)
    assert all(AFTER - 2e-3 <= b - a <= WITHOUT + 2e-3 for a, b in pairwise(found))
    assert length - (found[-1] if found else 0.0) <= WITHOUT + 2e-3
