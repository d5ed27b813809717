"""What a path looks like: how long it rests, what it shows again, how often it jumps."""

from __future__ import annotations

import numpy as np
import pytest

from metagraph.synthesis.search.path import Path
from metagraph.synthesis.search.path_quality import measure_quality
from metagraph.synthesis.states import States


def states(*takes: list[float]) -> States:
    """Takes of one joint, that is so many metres along."""
    places = np.array([x for take in takes for x in take], np.float32)[:, None, None] * [1.0, 0, 0]
    starts = np.cumsum([0, *map(len, takes)])
    return States(places, np.zeros_like(places), np.ones(1, np.float32), starts, 1.0)


def path(*shown: int) -> Path:
    way = np.array(shown)
    return Path(way, 0.0, np.flatnonzero(np.diff(way) != 1) + 1)


def test_a_take_as_it_is_repeats_nothing_and_rests_as_it_does() -> None:
    take = [0.0] * 46 + [0.01 * n for n in range(1, 60)]
    looks = measure_quality(states(take), path(*range(len(take))))
    assert looks.repeated == 0 and looks.jumps == 0 and looks.distinct == 1
    assert looks.frozen == looks.source == pytest.approx(1.5)
    assert not looks.stands_still


def test_a_frame_shown_again_and_again_is_repeated_and_at_rest() -> None:
    take = [0.01 * n for n in range(60)]
    looks = measure_quality(states(take), path(*range(10), *[9] * 80, *range(10, 20)))
    assert looks.repeated == pytest.approx(80 / 100)
    assert looks.distinct == pytest.approx(20 / 100)
    assert looks.frozen == pytest.approx(80 / 30) and looks.source == 0
    assert looks.stands_still and "stands still for up to 2.7 s" in looks.rest_words()


def test_a_jump_to_a_pose_farther_off_is_no_rest() -> None:
    take = [0.0] * 30 + [0.5] * 30
    looks = measure_quality(states(take), path(*range(20), *range(40, 60)))
    assert looks.frozen < 0.7 and not looks.stands_still


def test_what_comes_back_after_more_than_three_seconds_is_not_shown_again() -> None:
    take = [0.01 * n for n in range(300)]
    assert measure_quality(states(take), path(*range(100), *range(5))).repeated == 0
    assert measure_quality(states(take), path(*range(60), *range(6))).repeated == pytest.approx(6 / 66)
