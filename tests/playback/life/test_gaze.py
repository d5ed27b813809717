"""Where the gaze goes: moves that never jump, whatever is asked."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from metagraph.graph.life import Life
from metagraph.graph.model import Project
from metagraph.playback.life.body import PARTNER_AWAY, find_body
from metagraph.playback.life.gaze import (
    ENDING,
    BodyGaze,
    Moves,
    compute_eye_time,
    compute_head_time,
    ease_gaze,
    settle_gaze,
)
from metagraph.playback.life.lane import lane
from metagraph.playback.life.schedule import RECALL, Schedule, schedule
from metagraph.playback.life.track import LookAt, PlaceFrom, Track, track_of
from metagraph.playback.life.wanted import GazeTarget
from tests.label_zoo.catalogue import named
from tests.posing import body_of, gaze_of

STEP = 1 / 240
CALM = Life(saccades=0, aversion_rate=0)


def gaze(project: Project, track: Track, life: Life = CALM, end: float = 20.0, **points: Any) -> BodyGaze:
    return gaze_of(schedule(life, track, {}, 1, end, Schedule(), 0.0), life, body_of(project), points)


def seen(moves: Moves, head: bool = False) -> np.ndarray[Any, Any]:
    """Where the gaze is, metres: the targets' mean."""
    return np.sum(
        [np.array(aim.at) * (turned if head else came) for aim, came, turned in moves.parts], axis=0
    )


@pytest.mark.parametrize("curve", [ease_gaze, settle_gaze])
def test_curves_go_from_0_to_1_and_never_back(curve: Any) -> None:
    way = [curve(x) for x in np.linspace(-0.5, 1.5, 401)]
    assert way[0] == 0 and way[-1] == 1 and (np.diff(way) >= 0).all()
    assert curve(0.0) == 0 and curve(1.0) == 1


def test_the_head_settles_within_what_is_remembered() -> None:
    assert compute_head_time(180) + 0.1 < RECALL and compute_eye_time(20) == pytest.approx(0.065)


def test_shares_of_all_targets_are_one_whenever_looked(sample: Project) -> None:
    track = track_of([LookAt(f"l{n}", 1 + 0.13 * n, 99, (np.sin(n), 1.5, 1.0)) for n in range(20)])
    found = gaze(sample, track)
    for time in np.arange(0, 8, 0.05):
        moves = found.at(float(time))
        assert sum(came for _, came, _ in moves.parts) == pytest.approx(1)
        assert sum(turned for _, _, turned in moves.parts) == pytest.approx(1)


def test_the_eyes_lead_and_the_head_follows(sample: Project) -> None:
    found = gaze(sample, track_of([LookAt("l", 2.0, 99, (1.0, 1.6, 0.6))]))
    arrives = {}
    for head in (False, True):
        way = [seen(found.at(t), head)[0] for t in np.arange(1.9, 4.0, STEP)]
        arrives[head] = 1.9 + STEP * int(np.argmax(np.array(way) > 0.9))
    assert arrives[False] - 2.0 < 0.15 and 0.2 < arrives[True] - arrives[False] < 0.7


def test_the_first_target_has_always_been_looked_at(sample: Project) -> None:
    found = gaze(sample, Track())
    for time in (-3.0, 0.0, 1e-6, 5.0):
        [(aim, came, turned)] = found.at(time).parts
        assert came == turned == 1 and aim.at == body_of(sample).partner


def test_the_partner_is_ahead_at_the_height_of_the_eyes(sample: Project) -> None:
    body = body_of(sample)
    assert np.allclose(np.array(body.partner) - body.eyes_at_rest, PARTNER_AWAY * np.array(body.ahead))
    assert 1.5 < body.eyes_at_rest[1] < 1.7 and body.ahead == pytest.approx((0, 0, 1), abs=0.05)


def test_the_partner_of_a_giant_is_farther_away_than_its_head_sways() -> None:
    body = find_body(named("a hundred times too large").project)
    assert np.linalg.norm(np.array(body.partner) - body.eyes_at_rest) > 50.0


@pytest.mark.parametrize(("to", "amount"), [("ahead", 0.0), ("nobody", 0.0), ("user", 1.0), ("door", 1.0)])
def test_who_looks_ahead_or_at_what_is_nowhere_looks_at_nothing(
    sample: Project, to: str, amount: float
) -> None:
    found = gaze(sample, track_of([LookAt("l", 1.0, 99, to)]), door=(2.0, 1.0, 1.0))
    assert found.at(5.0).parts[0][0].amount == amount


def test_a_named_place_is_where_the_project_says_until_somebody_moves_it(sample: Project) -> None:
    track = track_of([LookAt("l", 1.0, 99, "door"), PlaceFrom("p", 5.0, "door", (0.0, 1.0, 2.0))])
    found = gaze(sample, track, door=(2.0, 1.0, 1.0))
    assert seen(found.at(4.9)) == pytest.approx([2.0, 1.0, 1.0]) and seen(found.at(9)) == pytest.approx(
        [0.0, 1.0, 2.0]
    )


# --- nothing jumps


def fastest(found: BodyGaze, start: float, end: float) -> float:
    """Metres a second at which the head's target moves."""
    at = np.array([seen(found.at(float(t)), True) for t in np.arange(start, end, STEP)])
    return float(np.linalg.norm(np.diff(at, axis=0), axis=1).max()) / STEP


@pytest.mark.parametrize("seed", range(10))
def test_whatever_is_asked_when_the_head_moves_without_a_jump(sample: Project, seed: int) -> None:
    rng = np.random.default_rng(seed)
    points = rng.uniform((-2, 0, 0.5), (2, 2.5, 3), (rng.integers(1, 9), 3))
    looks = [LookAt(f"l{n}", float(rng.uniform(0.5, 4)), 99, tuple(p.tolist())) for n, p in enumerate(points)]
    found = gaze(sample, track_of(looks))
    way = np.array([body_of(sample).partner, *(x.to for x in sorted(looks, key=lambda x: x.start))])
    assert fastest(found, 0.3, 6.0) < 6 * np.linalg.norm(np.diff(way, axis=0), axis=1).sum()


def test_a_target_that_moves_every_frame_is_followed_smoothly(sample: Project) -> None:
    places = [PlaceFrom(f"p{n}", 2 + n / 30, "user", (0.8 * np.sin(n / 30), 1.6, 1.2)) for n in range(180)]
    found = gaze(sample, track_of(places))
    times = np.arange(3.0, 7.5, STEP)
    at = np.array([seen(found.at(float(t)), True)[0] for t in times])
    want = 0.8 * np.sin(times - 2)
    assert np.abs(at - want).max() < 0.25, "no farther behind than a head is"
    assert np.abs(np.diff(at, 2)).max() / STEP**2 < 20


def test_a_moment_needs_only_what_is_near_it(sample: Project) -> None:
    targets = tuple(GazeTarget(0.5 * n, (0.1 * (n % 7), 1.6, 1.2)) for n in range(20000))
    found = BodyGaze(replace(Schedule(), targets=targets), CALM, body_of(sample), {})
    assert len(found.at(9000.0).parts) <= 4 and len(found._aims) <= 5


# --- aversions


def averting(sample: Project, track: Track) -> tuple[BodyGaze, Schedule]:
    life = Life(saccades=0, aversion_rate=40, aversion_length=2)
    found = schedule(life, track, {}, 1, 60.0, Schedule(), 0.0)
    return gaze_of(found, life, body_of(sample), {}), found


def test_an_aversion_goes_by_its_angle_and_comes_back(sample: Project) -> None:
    found, drawn = averting(sample, Track())
    start, (end, x, y) = float(drawn.aversions.starts[1]), drawn.aversions.values[1]
    assert found.at(start).eyes == pytest.approx((0, 0), abs=1e-12)
    there = found.at(end - 0.05)
    assert np.degrees(there.eyes) == pytest.approx([14 * x, 14 * y], rel=1e-6)
    assert found.at(end + 0.2).eyes == pytest.approx((0, 0), abs=1e-9)


def test_a_strict_look_does_not_avert_and_a_new_look_ends_an_aversion(sample: Project) -> None:
    _, plain = averting(sample, Track())
    start, end = float(plain.aversions.starts[2]), float(plain.aversions.values[2, 0])
    middle = 0.5 * (start + end)
    for strict in (True, False):
        before = schedule(
            Life(saccades=0, aversion_rate=40, aversion_length=2), Track(), {}, 1, 60.0, Schedule(), 0.0
        )
        life = Life(saccades=0, aversion_rate=40, aversion_length=2)
        after = schedule(
            life,
            track_of([LookAt("l", middle, 99, (1.0, 1.5, 1.0), strict=strict)]),
            {},
            1,
            60.0,
            before,
            middle,
        )
        assert float(after.aversions.starts[2]) == start, "it has begun"
        found = gaze_of(after, life, body_of(sample), {})
        assert np.hypot(*found.at(middle - 0.01).eyes) > 0.05
        assert np.hypot(*found.at(middle + ENDING + 0.01).eyes) < 1e-9


def test_an_aversion_within_a_strict_look_is_not_made(sample: Project) -> None:
    for strict, size in ((False, 14.0), (True, 0.0)):
        drawn = Schedule(
            targets=(GazeTarget(0.0, "user", strict=strict),),
            aversions=lane(3).plus([5.0], [(7.0, 1.0, 0.0)]),
        )
        assert np.degrees(gaze_of(drawn, CALM, body_of(sample), {}).at(6.0).eyes[0]) == pytest.approx(size)


def test_a_place_that_moves_does_not_end_an_aversion(sample: Project) -> None:
    _, plain = averting(sample, Track())
    start, end = float(plain.aversions.starts[2]), float(plain.aversions.values[2, 0])
    middle = 0.5 * (start + end)
    found, _ = averting(sample, track_of([PlaceFrom("p", middle, "user", (0.1, 1.6, 1.2))]))
    assert np.hypot(*found.at(middle + 0.3 * (end - middle)).eyes) > 0.05


def test_saccades_jump_and_rest(sample: Project) -> None:
    life = Life(aversion_rate=0)
    drawn = schedule(life, Track(), {}, 1, 60.0, Schedule(), 0.0)
    found = gaze_of(drawn, life, body_of(sample), {})
    times = np.arange(0, 50, 0.005)
    at = np.degrees([found.at(float(t)).eyes for t in times])
    moving = np.linalg.norm(np.diff(at, axis=0), axis=1) > 1e-9
    assert 0.01 < moving.mean() < 0.12, "most of the time the eyes rest"
    assert np.abs(at).max() <= 4.001
