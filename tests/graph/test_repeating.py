"""For how long actions play that repeat a part of their clip."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from metagraph.graph.model import KINDS, Timing
from metagraph.graph.repeating import LONGEST_REPEAT, cycle_of, seconds_played, times_played


def test_only_gestures_and_fidgets_with_a_time_to_repeat_do() -> None:
    found = {kind: cycle_of(kind, Timing(repeat=2.0), 0.5, 1.25) for kind in KINDS}
    assert found == {"stance": 0.0, "gesture": 0.75, "fidget": 0.75, "transition": 0.0}
    assert cycle_of("gesture", Timing(), 0.5, 1.25) == 0.0


def test_a_part_too_short_to_be_seen_plays_once() -> None:
    assert cycle_of("gesture", Timing(repeat=2.0), 0.0, 0.05) == 0.0
    assert seconds_played("gesture", Timing(repeat=2.0), 1.0, 1.0) == 0.0


@pytest.mark.parametrize(("asked", "times"), [(0.0, 1), (0.7, 1), (0.8, 2), (2.2, 4), (2.3, 5), (1e15, 1e6)])
def test_a_cycle_plays_the_nearest_whole_number_of_times(asked: float, times: float) -> None:
    assert times_played(0.5, asked) == times


def test_nothing_repeats_for_ever_where_nobody_asks_for_it() -> None:
    assert seconds_played("gesture", Timing(repeat=1e9), 0.0, 0.5) == LONGEST_REPEAT


@given(st.floats(0.1, 5.0), st.floats(0.01, 50.0))
def test_it_is_off_by_half_a_cycle_at_most(cycle: float, asked: float) -> None:
    seconds = seconds_played("gesture", Timing(repeat=asked), 0.0, cycle)
    assert seconds == pytest.approx(cycle) or abs(seconds - asked) <= 0.5 * cycle + 1e-9
