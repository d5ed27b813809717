"""Plain arithmetic of one pose, against the rotations used elsewhere."""

from __future__ import annotations

from math import degrees, radians
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from metagraph.graph.model import Project
from metagraph.motion import rotation
from metagraph.playback.life import solve
from tests.posing import body_of

angles = st.floats(-3.1, 3.1)
quaternions = st.builds(
    lambda axis, angle: tuple(rotation.from_axis_angle(np.array(axis) + [0, 0, 1e-3], angle).tolist()),
    st.tuples(*[st.floats(-1, 1)] * 3),
    angles,
)


@given(quaternions, quaternions, st.tuples(*[st.floats(-5, 5)] * 3))
def test_products_and_turned_vectors_are_those_of_rotation(a: Any, b: Any, v: Any) -> None:
    assert np.allclose(solve.multiply_quaternions(a, b), rotation.multiply(a, b), atol=1e-12)
    assert np.allclose(
        solve.rotate_tuple(a, v), rotation.rotate_vectors(np.array(a), np.array(v)), atol=1e-11
    )


def test_a_chain_is_where_the_skeleton_has_it(sample: Project) -> None:
    skeleton, body = sample.skeleton, body_of(sample)
    assert skeleton is not None
    entry = next(c for c in sample.clips.values() if "shake" in c.name)
    assert entry.motion is not None
    pose = entry.motion.pose_at(0.5)
    turned, at = skeleton.globals(pose)
    q, p = solve.compute_globals(pose.rotations[body.chain].tolist(), pose.translations[body.chain].tolist())
    assert np.allclose(p, at[body.chain], atol=1e-5) and np.allclose(q, turned[body.chain], atol=1e-5)


@given(st.floats(-2, 2), st.floats(-2, 2))
def test_eyes_never_leave_their_reach_nor_their_direction(left: float, up: float) -> None:
    x, y = solve.limit_eye_turn(left, up)
    limit = solve.EYE_UP if up > 0 else solve.EYE_DOWN
    assert (x / solve.EYE_SIDEWAYS) ** 2 + (y / limit) ** 2 <= 1 + 1e-9
    assert x * up == pytest.approx(y * left, abs=1e-9) and x * left >= 0 and y * up >= 0


def test_eyes_go_all_the_way_where_it_is_easy() -> None:
    assert solve.limit_eye_turn(radians(15), radians(-10)) == (radians(15), radians(-10))


@given(st.floats(-1.5, 1.5), st.floats(0, 1))
def test_the_head_takes_little_of_little_and_never_more_than_its_share(angle: float, share: float) -> None:
    part = solve.compute_head_part(angle, share)
    assert part * angle >= 0 and abs(part) <= share * abs(angle)
    assert abs(solve.compute_head_part(radians(4), 1.0)) < radians(1)


@pytest.mark.parametrize("already", [-0.3, 0.0, 0.4, 1.0])
@pytest.mark.parametrize("down", [-0.4, 0.0, 0.4])
def test_a_blink_always_shuts_the_lid_and_no_farther(already: float, down: float) -> None:
    assert solve.compute_lid(down, 0.86, already, 1.0) == pytest.approx(1.0)
    open_, half = solve.compute_lid(down, 0.86, already, 0.0), solve.compute_lid(down, 0.86, already, 0.5)
    assert solve.WIDEST <= open_ <= half <= 1


def test_lids_follow_down_and_up() -> None:
    down, level, up = (solve.compute_lid(a, 0.86, 0.0, 0.0) for a in (0.3, 0.0, -0.3))
    assert down > level == 0 > up


# --- the head


def turned(
    project: Project, left: float, up: float, share: float = 0.6, trunk: float = 0.0, head: float = 0.0
) -> tuple[float, float]:
    """Degrees to the left and up that the head turns for a target so far to the left and up; trunk and head
    turned by clips.
    """
    body = body_of(project)
    about = [tuple(rotation.from_axis_angle([0, 1.0, 0], radians(a)).tolist()) for a in (trunk, head)]
    chain = [(0.0, 0.0, 0.0, 1.0)] * len(body.chain)
    chain[body.trunk], chain[-1] = about[0], about[1]
    vector, size = solve._head(body, chain, radians(left), radians(up), 1.0, share)  # type: ignore[arg-type]
    assert np.linalg.norm(vector) == pytest.approx(size, abs=1e-9)
    x, y, z = rotation.rotate_vectors(rotation.exp(np.array(vector)), np.array([0, 0, 1.0]))
    return degrees(np.arctan2(x, z)), degrees(np.arcsin(np.clip(y, -1, 1)))


def test_the_head_stays_for_what_is_ahead(toy: Any, sample: Project) -> None:
    assert turned(sample, 0, 0) == pytest.approx((0, 0), abs=0.5)


def test_the_wider_the_turn_the_more_the_head_does(sample: Project) -> None:
    parts = [turned(sample, a, 0)[0] for a in (5, 10, 20, 40, 60, 80)]
    assert parts[0] < 1.0 and (np.diff(parts) > 0).all()
    assert all(
        a - p <= degrees(solve.EYE_EASE) + 1 for a, p in zip((5, 10, 20, 40, 60, 80), parts, strict=True)
    ), "the eyes can do the rest"


def test_a_head_without_a_share_leaves_all_to_the_eyes(sample: Project) -> None:
    assert turned(sample, 60, 20, share=0.0, trunk=80, head=80) == pytest.approx((0, 0), abs=1e-6)


@pytest.mark.parametrize(("left", "up"), [(110, 0), (-110, 60), (90, -60)])
def test_a_neck_has_limits(sample: Project, left: float, up: float) -> None:
    x, y = turned(sample, left, up, share=1.0)
    assert abs(x) <= 66 and -36 <= y <= 31


def test_a_head_that_a_clip_turned_away_is_left_alone(sample: Project) -> None:
    assert turned(sample, 0, 0, head=60)[0] == pytest.approx(0, abs=0.6)
    assert turned(sample, 0, 0, trunk=60)[0] == pytest.approx(0, abs=0.6)


def test_a_character_that_has_turned_away_as_a_whole_turns_its_head_back(sample: Project) -> None:
    assert turned(sample, 0, 0, trunk=75, head=80)[0] == pytest.approx(
        -(75 - degrees(solve.TURNED_AWAY)), abs=2
    )
    assert turned(sample, 0, 0, trunk=-75, head=-80)[0] == pytest.approx(
        75 - degrees(solve.TURNED_AWAY), abs=2
    )


def _greatest_change(turns: list[tuple[float, float]]) -> float:
    return float(np.linalg.norm(np.diff(np.array([*turns, turns[0]]), axis=0), axis=1).max())


@pytest.mark.parametrize("apart", [0, 15, -40])
def test_a_body_that_turns_all_the_way_round_never_throws_its_head_to_the_other_side(
    sample: Project, apart: float
) -> None:
    for target in (0, 45, -110):
        found = [turned(sample, target, 0, trunk=a, head=a + apart) for a in range(0, 360, 2)]
        assert _greatest_change(found) < 3 * 2


def test_a_target_that_goes_all_the_way_round_never_throws_the_gaze_to_the_other_side() -> None:
    ways = [solve._turning(radians(a), solve.LOOK_SIDEWAYS, solve.LOOK_BEHIND) for a in range(-180, 181)]
    assert ways[0] == pytest.approx(ways[-1], abs=1e-9)
    assert abs(np.diff(np.degrees(ways))).max() < 3


def test_a_face_bent_to_the_floor_is_no_face_turned_away(sample: Project) -> None:
    assert solve._gap(body_of(sample), 0.0, (0.01, -1.0, -0.01)) == pytest.approx(0.0, abs=0.01)
