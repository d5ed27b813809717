"""Lanes: extended, cut and forgotten without being changed."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from metagraph.playback.life.lane import Lane, lane

times = st.lists(st.floats(0, 100).map(lambda x: round(x, 2)), max_size=30).map(sorted)


def filled(starts: list[float]) -> Lane:
    return lane(2).plus(starts, [(t, -t) for t in starts])


def test_an_empty_lane_stays_itself() -> None:
    empty = lane(3)
    assert len(empty) == 0 and empty.next == 0
    assert empty.plus([], []) is empty and empty.until(5) is empty and empty.since(5) is empty


@given(times, st.floats(-1, 101))
def test_until_keeps_what_begins_before(starts: list[float], at: float) -> None:
    kept = filled(starts).until(at)
    assert kept.starts.tolist() == [t for t in starts if t < at] and kept.values.shape == (len(kept), 2)


@given(times, st.floats(-1, 101), st.integers(0, 3))
def test_since_keeps_what_goes_on_what_comes_and_the_numbers(
    starts: list[float], at: float, before: int
) -> None:
    whole = filled(starts)
    kept = whole.since(at, before)
    assert kept.next == whole.next
    assert set(whole.starts[whole.starts > at]) <= set(kept.starts)
    gone = [t for t in starts if t <= at]
    assert len(kept) == len(starts) - max(0, len(gone) - 1 - before)
    assert np.array_equal(kept.starts, whole.starts[kept.first :])


@given(times)
def test_lanes_are_equal_by_what_they_hold(starts: list[float]) -> None:
    assert filled(starts) == filled(starts) and hash(filled(starts)) == hash(filled(starts))
    assert filled([*starts, 200.0]) != filled(starts) and filled(starts) != 3
    assert not starts or filled(starts) != Lane(filled(starts).starts, filled(starts).values, 1)
