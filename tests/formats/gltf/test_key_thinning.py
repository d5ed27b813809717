"""Frames kept as keys are those that splitting track by track keeps, however many are looked at together."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from metagraph.formats.gltf import key_thinning
from metagraph.formats.gltf.key_thinning import find_kept_frames
from metagraph.motion import rotation

Array = NDArray[Any]


def forget() -> None:
    """Let nothing from before be remembered."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(key_thinning, "MOST", 0)
        find_kept_frames([np.zeros((1, 1, 3))], 0.0, False)


@pytest.fixture(autouse=True)
def nothing_known() -> None:
    forget()


def wandering(frames: int, tracks: int, turning: bool, seed: int) -> Array:
    """Return tracks that wander, stand still for a while, and jump."""
    chance = np.random.default_rng(seed)
    steps = chance.normal(size=(frames, tracks, 3)) * chance.choice([0, 0.01, 0.3], (frames, tracks, 1))
    way = np.cumsum(steps, 0)
    way[:, chance.random(tracks) < 0.2] = 0.1
    return rotation.exp(way) if turning else way


def one_by_one(track: Array, tolerance: float, turning: bool) -> list[int]:
    """Return the frames to keep of one track `[F, n]`, as is said and without haste."""
    last = len(track) - 1
    if np.abs(track - track[0]).max() <= tolerance:
        return [0]
    if last < 2 or tolerance <= 0:
        return list(range(last + 1))
    kept, stretches = {0, last}, [(0, last)]
    while stretches:
        low, high = stretches.pop()
        errors = []
        for f in range(low + 1, high):
            part = (f - low) / (high - low)
            if turning:
                guess = rotation.slerp(track[low], track[high], part)
                guess = guess * np.sign(guess @ track[f])
            else:
                guess = track[low] + (track[high] - track[low]) * part
            errors.append(float(np.abs(guess - track[f]).max()))
        if errors and max(errors) > tolerance:
            bounds = [low, *(low + 1 + n for n, e in enumerate(errors) if e >= max(errors)), high]
            kept.update(bounds)
            stretches += itertools.pairwise(bounds)
    return list(range(last + 1)) if len(kept) > key_thinning.WORTH * (last + 1) else sorted(kept)


@pytest.mark.nightly
@given(
    st.lists(st.tuples(st.integers(1, 40), st.integers(1, 4)), min_size=1, max_size=5),
    st.sampled_from([0.0, 1e-3, 0.05, 0.4]),
    st.booleans(),
    st.integers(0, 999),
)
def test_frames_are_those_of_each_track_by_itself(
    sizes: list[tuple[int, int]], tolerance: float, turning: bool, seed: int
) -> None:
    forget()
    many = [wandering(f, c, turning, seed + n) for n, (f, c) in enumerate(sizes)]
    for values, found in zip(many, find_kept_frames(many, tolerance, turning), strict=True):
        assert [list(k) for k in found] == [
            one_by_one(values[:, c], tolerance, turning) for c in range(values.shape[1])
        ]


def test_it_does_not_matter_what_is_looked_at_together_or_was_before(monkeypatch: pytest.MonkeyPatch) -> None:
    many = [wandering(20, 3, True, n % 7) for n in range(12)]
    whole = find_kept_frames(many, 0.05, True)
    again = find_kept_frames(many[::-1], 0.05, True)[::-1]
    forget()
    monkeypatch.setattr(key_thinning, "AT_ONCE", 500)
    for other in (again, find_kept_frames(many, 0.05, True)):
        assert [[list(k) for k in one] for one in other] == [[list(k) for k in one] for one in whole]
    assert find_kept_frames([], 0.05, True) == []


def test_no_more_is_remembered_than_it_says_and_the_last_longest(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(key_thinning, "MOST", 4)
    many = [wandering(20, 2, False, n) for n in range(10)]
    first = find_kept_frames(many, 0.05, False)
    again = [find_kept_frames([values], 0.05, False)[0] for values in many[6:]]
    assert all(a is b for a, b in zip(again, first[6:], strict=True)), "what is remembered is the very same"
    assert find_kept_frames([many[5]], 0.05, False)[0] is not first[5]
    assert find_kept_frames([many[6]], 0.05, False)[0] is not first[6], (
        "the one that was used longest ago went"
    )
    assert find_kept_frames([many[9]], 0.05, False)[0] is first[9]
