"""Rotations: xyzw, unit length, free leading dimensions."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from metagraph.motion import rotation

ORDERS = ["".join(p) for p in itertools.permutations("XYZ")]
HALF_TURNS = np.array([[1.0, 0, 0, 0], [0, 1.0, 0, 0], [0, 0, 1.0, 0], [-1.0, 0, 0, 0], [0.6, 0.8, 0, 0]])
EDGES = np.concatenate([[[0, 0, 0, 1.0], [0, 0, 0, -1.0], [1e-9, 0, 0, 1.0], [1e-4, 0, 0, -1.0]], HALF_TURNS])

numbers = st.floats(-1, 1, allow_subnormal=False)
unit = (
    arrays(np.float64, 4, elements=numbers).filter(lambda q: np.linalg.norm(q) > 0.1).map(rotation.normalize)
)
vector = arrays(np.float64, 3, elements=st.floats(-10, 10, allow_subnormal=False))


def same(a: np.ndarray, b: np.ndarray, within: float = 1e-6) -> bool:
    return bool(np.all(rotation.measure_angle_between(a, b) < within))


def test_a_zero_quaternion_becomes_the_identity() -> None:
    assert np.array_equal(rotation.normalize(np.zeros(4)), rotation.IDENTITY)
    assert np.array_equal(
        rotation.normalize(np.zeros((2, 4), np.float32)), np.tile(rotation.IDENTITY, (2, 1))
    )
    assert rotation.normalize(np.zeros(4, np.float32)).dtype == np.float32


@pytest.mark.parametrize("q", EDGES)
def test_identity_and_half_turns_of_both_signs_survive_every_round_trip(q: np.ndarray) -> None:
    q = rotation.normalize(q)
    assert same(rotation.from_matrix(rotation.to_matrix(q)), q)
    assert same(rotation.exp(rotation.log(q)), q)
    assert same(rotation.scale_rotation(q, 1.0), q)
    assert same(rotation.scale_rotation(q, 0.0), rotation.IDENTITY)
    assert same(rotation.multiply(q, rotation.conjugate(q)), rotation.IDENTITY)
    for order in ORDERS:
        assert same(rotation.from_euler(rotation.to_euler(q, order), order), q)


@given(unit)
def test_both_signs_of_a_quaternion_are_the_same_rotation(q: np.ndarray) -> None:
    assert np.allclose(rotation.to_matrix(q), rotation.to_matrix(-q))
    assert np.allclose(rotation.log(q), rotation.log(-q)) or np.linalg.norm(rotation.log(q)) > 3.14
    assert rotation.measure_angle_between(q, -q) < 1e-7


@given(unit, vector)
def test_matrices_and_quaternions_turn_a_vector_alike(q: np.ndarray, v: np.ndarray) -> None:
    m = rotation.to_matrix(q)
    assert np.allclose(m @ v, rotation.rotate_vectors(q, v), atol=1e-9)
    assert np.allclose(m @ m.T, np.eye(3), atol=1e-9)
    assert np.linalg.det(m) == pytest.approx(1)
    assert same(rotation.from_matrix(m), q)
    assert rotation.from_matrix(m)[3] >= 0


@given(unit, unit, vector)
def test_a_product_turns_by_the_right_one_first(a: np.ndarray, b: np.ndarray, v: np.ndarray) -> None:
    assert np.allclose(
        rotation.rotate_vectors(rotation.multiply(a, b), v),
        rotation.rotate_vectors(a, rotation.rotate_vectors(b, v)),
        atol=1e-9,
    )


@pytest.mark.parametrize("order", ORDERS)
@given(angles=arrays(np.float64, 3, elements=st.floats(-3, 3)))
@settings(max_examples=30)
def test_euler_angles_of_every_order_come_back_as_the_same_rotation(order: str, angles: np.ndarray) -> None:
    q = rotation.from_euler(angles, order)
    assert same(rotation.from_euler(rotation.to_euler(q, order), order), q, 1e-5)


@pytest.mark.parametrize("order", ORDERS)
@pytest.mark.parametrize("middle", [-np.pi / 2, np.pi / 2])
def test_gimbal_lock_still_gives_the_same_rotation(order: str, middle: float) -> None:
    q = rotation.from_euler(np.array([0.4, middle, -1.1]), order)
    assert same(rotation.from_euler(rotation.to_euler(q, order), order), q, 1e-6)


def test_euler_angles_are_applied_outermost_first() -> None:
    zxy = rotation.from_euler(np.radians([90, 0, 0]), "ZXY")
    assert np.allclose(rotation.rotate_vectors(zxy, [1.0, 0, 0]), [0, 1, 0], atol=1e-12)
    both = rotation.from_euler(np.radians([90.0, 90, 0]), "ZXY")
    assert np.allclose(
        rotation.rotate_vectors(both, [0, 1.0, 0]), rotation.rotate_vectors(zxy, [0, 0, 1.0]), atol=1e-12
    )


@given(unit, st.floats(-1, 2), st.floats(-1, 2))
def test_powers_add_up_and_go_the_short_way(q: np.ndarray, a: float, b: float) -> None:
    whole = rotation.measure_angle_between(q, rotation.IDENTITY)
    if whole > 3.1:
        return  # half a turn has no short way
    both = rotation.multiply(rotation.scale_rotation(q, a), rotation.scale_rotation(q, b))
    assert same(both, rotation.scale_rotation(q, a + b), 1e-6)
    assert rotation.measure_angle_between(
        rotation.scale_rotation(q, 0.5), rotation.IDENTITY
    ) == pytest.approx(whole / 2, abs=1e-6)


@given(arrays(np.float64, 3, elements=st.floats(-1.8, 1.8)))
def test_the_logarithm_of_an_exponential_is_what_went_in(v: np.ndarray) -> None:
    if np.linalg.norm(v) < np.pi - 1e-3:
        assert np.allclose(rotation.log(rotation.exp(v)), v, atol=1e-7)


@given(unit, unit)
def test_blends_start_and_end_where_they_should_and_keep_unit_length(a: np.ndarray, b: np.ndarray) -> None:
    for blend in (rotation.nlerp, rotation.slerp):
        assert same(blend(a, b, 0.0), a)
        assert same(blend(a, b, 1.0), b)
    if abs(a @ b) > 1e-3:  # at exactly half a turn apart the middle is anyone's
        middle = rotation.nlerp(a, b, 0.5)
        assert np.linalg.norm(middle) == pytest.approx(1)
        assert same(middle, rotation.slerp(a, b, 0.5), 1e-5)


@given(unit, unit, st.floats(0, 1))
def test_slerp_turns_at_constant_speed(a: np.ndarray, b: np.ndarray, w: float) -> None:
    whole = rotation.measure_angle_between(a, b)
    if whole < 3.1:
        assert rotation.measure_angle_between(a, rotation.slerp(a, b, w)) == pytest.approx(
            w * whole, abs=1e-6
        )


def test_blending_takes_the_shorter_arc_whatever_the_signs() -> None:
    a, b = rotation.from_axis_angle([0, 0, 1], 0.1), -rotation.from_axis_angle([0, 0, 1], 0.5)
    for blend in (rotation.nlerp, rotation.slerp):
        assert (
            rotation.measure_angle_between(blend(a, b, 0.5), rotation.from_axis_angle([0, 0, 1], 0.3)) < 1e-6
        )


def test_neighbours_are_brought_to_the_same_side() -> None:
    q = np.tile(rotation.from_axis_angle([1, 0, 0], 0.3), (5, 2, 1))
    q[1, 0] *= -1
    q[3:, 1] *= -1
    out = rotation.make_continuous(q)
    assert np.all(np.einsum("...i,...i->...", out[1:], out[:-1]) > 0)
    assert np.array_equal(out[0], q[0])
    assert np.array_equal(rotation.make_continuous(q[:1]), q[:1])


@given(vector, vector)
def test_the_turn_between_two_directions_takes_one_to_the_other(a: np.ndarray, b: np.ndarray) -> None:
    if np.linalg.norm(a) < 1e-3 or np.linalg.norm(b) < 1e-3:
        return
    a, b = a / np.linalg.norm(a), b / np.linalg.norm(b)
    assert np.allclose(rotation.rotate_vectors(rotation.find_rotation_between(a, b), a), b, atol=1e-4)


@pytest.mark.parametrize("a", [[1.0, 0, 0], [0, 1.0, 0], [0, 0, 1.0], [0.6, 0.8, 0]])
def test_opposite_directions_are_half_a_turn_apart(a: list[float]) -> None:
    turn = rotation.find_rotation_between(a, -np.array(a))
    assert np.allclose(rotation.rotate_vectors(turn, a), -np.array(a), atol=1e-9)


@pytest.mark.parametrize("shape", [(), (1,), (0,), (2, 3), (4, 0, 2)])
def test_every_function_keeps_leading_dimensions(shape: tuple[int, ...]) -> None:
    q, v, w = rotation.make_identity_rotations(shape), np.zeros((*shape, 3)), np.zeros(shape)
    assert rotation.multiply(q, q).shape == (*shape, 4)
    assert rotation.rotate_vectors(q, v).shape == (*shape, 3)
    assert rotation.from_euler(v, "ZXY").shape == (*shape, 4)
    assert rotation.to_euler(q).shape == (*shape, 3)
    assert rotation.from_matrix(rotation.to_matrix(q)).shape == (*shape, 4)
    assert rotation.exp(rotation.log(q)).shape == (*shape, 4)
    assert rotation.nlerp(q, q, w).shape == rotation.slerp(q, q, w).shape == (*shape, 4)
    assert rotation.measure_angle_between(q, q).shape == shape


def test_leading_dimensions_broadcast() -> None:
    many = rotation.from_axis_angle(np.tile([0, 1.0, 0], (5, 3, 1)), np.linspace(0, 1, 15).reshape(5, 3))
    one = rotation.from_axis_angle([1, 0, 0], 0.5)
    assert np.allclose(rotation.multiply(one, many)[2, 1], rotation.multiply(one, many[2, 1]))
    assert np.allclose(
        rotation.rotate_vectors(one, np.ones((4, 3)))[2], rotation.rotate_vectors(one, np.ones(3))
    )


def test_single_precision_stays_single() -> None:
    q = rotation.make_identity_rotations((3,), np.float32)
    assert rotation.multiply(q, q).dtype == rotation.nlerp(q, q, np.float32(0.5)).dtype == np.float32
    assert rotation.conjugate(q).dtype == rotation.to_matrix(q).dtype == np.float32
