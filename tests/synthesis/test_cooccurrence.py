"""How often people move when something is said: thresholds as the equations say, and planted couplings found
again.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from metagraph.formats.clips import read_clips
from metagraph.graph.conversation.model import Segment
from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.motion.roles import find_roles
from metagraph.synthesis.cooccurrence import (
    _matches,
    compute_wilson_interval,
    count_cooccurrence,
    find_activation_speed,
    find_movement,
    find_movement_windows,
    measure_part_speeds,
)

CLIPS = Path(__file__).resolve().parents[2] / "sample_clips" / "clips"
FPS = 30.0


@pytest.fixture(scope="module")
def base() -> Clip:
    return read_clips(CLIPS / "hands_at_sides__stance.glb")[0]


def moving(
    base: Clip,
    seconds: float,
    arms: list[tuple[float, float]],
    nods: list[tuple[float, float]] = (),
    arm: str = "right",
) -> Clip:  # type: ignore[assignment]
    """Somebody who stands still except for swings of an arm and nods, from when to when."""
    frames = round(seconds * FPS)
    t = np.arange(frames) / FPS
    rotations = np.repeat(base.rotations[:1], frames, 0).copy()
    roles = find_roles(base.skeleton)
    for joint, spans, angle in ((roles[f"{arm}_upper_arm"], arms, 0.9), (roles["head"], nods, 0.4)):
        bend = np.zeros(frames)
        for a, b in spans:
            inside = (t >= a) & (t <= b)
            bend[inside] += angle * np.sin(np.pi * (t[inside] - a) / (b - a)) ** 2
        turn = np.stack([np.sin(bend / 2), np.zeros(frames), np.zeros(frames), np.cos(bend / 2)], axis=-1)
        rotations[:, joint] = rotation.multiply(rotations[:, joint], turn)
    return Clip(
        "take",
        base.skeleton,
        FPS,
        rotations.astype(np.float32),
        np.repeat(base.translations[:1], frames, 0),
        base.translated,
    )


def test_what_is_active_lies_a_tenth_above_the_least() -> None:
    assert find_activation_speed(np.array([1.0, 2.0, 11.0])) == pytest.approx(2.0)
    assert find_activation_speed(np.array([3.0, 3.0])) == 3.0


def test_a_movement_is_from_the_first_to_the_last_frame_over_the_windows_threshold() -> None:
    speed = np.array([0, 0, 0.05, 0.5, 1.0, 0.02, 0.8, 0.2, 0, 0])
    # The window's threshold is 0.1: frames 3 .. 7 of 10 frames a second.
    assert find_movement(speed, 10.0, (0.0, 0.9), 0.1) == (0.3, 0.7)
    assert find_movement(speed, 10.0, (0.0, 0.2), 0.1) is None, "slower than the take's own threshold"
    assert find_movement(speed, 10.0, (5.0, 6.0), 0.1) is None


def test_windows_are_twice_as_long_and_trimmed_at_neighbours() -> None:
    segments = [Segment("clause", 1.0, 2.0), Segment("clause", 2.4, 3.4), Segment("clause", 8.0, 9.0)]
    assert find_movement_windows(segments, 9.2) == [
        (pytest.approx(0.5), pytest.approx(2.2)),
        (pytest.approx(2.2), pytest.approx(3.9)),
        (pytest.approx(7.5), pytest.approx(9.2)),
    ]


@given(st.lists(st.tuples(st.floats(0, 50), st.floats(0.05, 5)), max_size=12))
def test_a_window_holds_its_segment_where_none_overlap(spans: list[tuple[float, float]]) -> None:
    at, segments = 0.0, []
    for gap, length in spans:
        segments.append(Segment("clause", at + gap, at + gap + length))
        at += gap + length
    for s, (low, high) in zip(segments, find_movement_windows(segments, at + 1), strict=True):
        assert low <= s.start + 1e-9 and high >= s.end - 1e-9


def test_windows_are_trimmed_at_neighbours_of_any_kind() -> None:
    clause, response = Segment("clause", 1.0, 2.0), Segment("response", 2.2, 2.6)
    assert find_movement_windows([clause], 9.0) == [(0.5, 2.5)]
    assert find_movement_windows([clause], 9.0, [clause, response]) == [(0.5, pytest.approx(2.1))]
    assert find_movement_windows([response], 9.0, [clause, response]) == [
        (pytest.approx(2.1), pytest.approx(2.8))
    ]


def test_a_movement_that_spans_two_clauses_counts_once(base: Clip) -> None:
    two = [Segment("clause", 2.0, 3.0, 2.5), Segment("clause", 3.0, 4.0, 3.5)]
    clip, t = moving(base, 8, []), np.arange(round(8 * FPS)) / FPS
    once = np.exp(-(((t - 2.95) / 0.25) ** 2))  # fastest before the second begins, and over after that
    twice = once + np.exp(-(((t - 3.7) / 0.1) ** 2))
    for speed, count in ((once, 1), (twice, 2)):
        found = [(clip, {"right_hand": speed}, two)]
        assert _matches(found, "clause", ("right_hand",), None) == (count, 2)


def test_a_turn_of_the_whole_body_moves_no_hand_and_no_head(base: Clip) -> None:
    frames = 60
    angle = np.linspace(0, 2, frames)
    rotations = np.repeat(base.rotations[:1], frames, 0).copy()
    turn = np.stack([np.zeros(frames), np.sin(angle / 2), np.zeros(frames), np.cos(angle / 2)], axis=-1)
    rotations[:, 0] = rotation.multiply(turn, rotations[:, 0])
    found = measure_part_speeds(
        Clip(
            "turn",
            base.skeleton,
            FPS,
            rotations.astype(np.float32),
            np.repeat(base.translations[:1], frames, 0),
            base.translated,
        )
    )
    assert set(found) == {"left_hand", "right_hand", "head"}
    assert all(v.max() < 0.01 for v in found.values())


def test_a_nod_is_up_and_down_a_shake_is_not(base: Clip) -> None:
    nod = measure_part_speeds(moving(base, 2, [], [(0.5, 1.2)]))["head"]
    assert nod.max() > 0.05 and nod[:10].max() < 0.01


def test_a_planted_coupling_is_found_and_chance_is_not(base: Clip) -> None:
    chance = np.random.default_rng(5)
    starts = np.arange(2.0, 118.0, 4.0)
    clauses = [Segment("clause", float(s), float(s) + 0.8, float(s) + 0.4) for s in starts]
    with_hand = chance.random(len(starts)) < 0.7
    responses = [Segment("response", float(s) + 2.0, float(s) + 2.4) for s in starts[::2]]
    nodded = chance.random(len(responses)) < 0.5
    take = moving(
        base, 120, [(s.start, s.end) for s, w in zip(clauses, with_hand, strict=True) if w],
        [(r.start, r.end + 0.3) for r, w in zip(responses, nodded, strict=True) if w],
    )  # fmt: skip
    rows = {r.hypothesis: r for r in count_cooccurrence([take], [[*clauses, *responses]], chances=40)}
    right, left, nod = (
        rows[n] for n in ("clause with the right hand", "clause with the left hand", "response with a nod")
    )
    assert (right.matched, right.total) == (with_hand.sum(), len(starts)) and left.matched == 0
    assert rows["clause with either hand"].matched == right.matched
    assert (nod.matched, nod.total) == (nodded.sum(), len(responses))
    assert right.low < right.rate < right.high and right.chance < right.low
    none = rows["partner's hesitation with a nod"]
    assert (none.total, none.rate, none.low, none.high) == (0, 0.0, 0.0, 1.0)


def test_takes_and_speech_must_be_as_many(base: Clip) -> None:
    with pytest.raises(ValueError, match="1 takes, but speech for 0"):
        count_cooccurrence([base], [])


def test_the_interval_of_a_share_is_wilsons() -> None:
    # 387 of 515: the paper's 75 %.
    low, high = compute_wilson_interval(387, 515)
    assert (low, high) == (pytest.approx(0.7123, abs=5e-4), pytest.approx(0.7868, abs=5e-4))
    assert compute_wilson_interval(0, 10)[0] == pytest.approx(0, abs=1e-9) and compute_wilson_interval(
        10, 10
    )[1] == pytest.approx(1)
