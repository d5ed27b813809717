"""Hands that touch their own body: on figures put together of a few points, and whichever way they stand."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import astuple
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from metagraph.suggest.self_contact import NOTHING, measure_self_contact
from tests.suggest.test_traits import mirrored, moved, of, one_armed, scaled

FRAMES = 31
STANDS = {
    "hips": (0.0, 0.53, 0.0),
    "skull": (0.0, 0.94, 0.02),
    "head": (0.0, 0.88, 0.0),
    "left_upper_arm": (0.1, 0.82, 0.0),
    "left_lower_arm": (0.12, 0.64, 0.0),
    "left_hand": (0.14, 0.48, 0.02),
    "left_tip": (0.14, 0.38, 0.02),
    "left_upper_leg": (0.05, 0.5, 0.0),
    "left_lower_leg": (0.05, 0.28, 0.0),
}
SWAP = {"left": "right", "right": "left"}


def swapped(name: str) -> str:
    side, _, rest = name.partition("_")
    return f"{SWAP[side]}_{rest}" if side in SWAP else name


def figure(**hand: Any) -> dict[str, Any]:
    """A figure that stands, in heights. hand: paths `[F, 3]` that replace where joints are."""
    places = {**STANDS, **{swapped(n): (-x, y, z) for n, (x, y, z) in STANDS.items()}}
    world = {name: np.tile(np.array(at, float), (FRAMES, 1)) for name, at in places.items()}
    return world | hand


def path(*corners: tuple[float, float, float]) -> Any:
    """A way past corners, each reached in equal time."""
    at = np.linspace(0, len(corners) - 1, FRAMES)
    return np.stack([np.interp(at, range(len(corners)), c) for c in zip(*corners, strict=True)], -1)


DOWN, OUT, FACE = (0.14, 0.48, 0.02), (0.35, 0.7, 0.25), (0.02, 0.92, 0.09)
BELLY, BELOW = (0.02, 0.68, 0.1), (0.02, 0.6, 0.1)


def reaching(*corners: tuple[float, float, float]) -> dict[str, Any]:
    hand = path(*corners)
    return figure(left_hand=hand, left_tip=hand + [0.0, 0.0, 0.01])


def test_a_figure_without_hands_touches_nothing() -> None:
    assert measure_self_contact({}, 0.1) == NOTHING
    bare = {n: x for n, x in figure().items() if "hand" not in n and "tip" not in n}
    assert measure_self_contact(bare, 0.1) == NOTHING


def test_a_hand_alone_touches_nothing() -> None:
    assert measure_self_contact({"left_hand": path(DOWN, FACE)}, 0.1) == NOTHING


@pytest.mark.parametrize("seconds", [0.0, 1 / 30])
def test_a_single_frame_has_no_new_touch(seconds: float) -> None:
    found = measure_self_contact({n: x[:1] for n, x in figure().items()}, seconds)
    assert (found.head, found.trunk, found.arm, found.rub) == (0, 0, 0, 0)


def test_a_gesture_in_free_space_touches_nothing() -> None:
    found = measure_self_contact(reaching(DOWN, OUT, DOWN), 0.1)
    assert (found.head, found.trunk, found.arm) == (0, 0, 0)


@pytest.mark.parametrize(("there", "part"), [(FACE, "head"), (BELLY, "trunk")])
def test_a_hand_that_comes_to_a_part_touches_it(there: tuple[float, float, float], part: str) -> None:
    found = measure_self_contact(reaching(OUT, there, there, there, OUT), 0.1)
    shares = {"head": found.head, "trunk": found.trunk, "arm": found.arm}
    assert shares.pop(part) > 0.4 and not any(shares.values())


def test_a_hand_that_comes_to_the_other_arm_touches_that() -> None:
    elbow = (-0.12, 0.64, 0.03)
    found = measure_self_contact(reaching(OUT, elbow, elbow, OUT), 0.1)
    assert found.arm > 0.2 and found.head == 0


def test_a_hand_that_slides_on_what_it_touches_rubs_and_one_that_rests_there_does_not() -> None:
    rubs = measure_self_contact(reaching(OUT, BELLY, BELOW, BELLY, BELOW, BELLY, OUT), 0.1)
    rests = measure_self_contact(reaching(OUT, BELLY, BELLY, BELLY, BELLY, BELLY, OUT), 0.1)
    assert rubs.trunk > 0.5 < rests.trunk and rubs.rub > 2 * rests.rub
    assert (
        measure_self_contact(reaching(OUT, BELLY, BELOW, BELLY, OUT), 0.0).rub == 0
    )  # nobody knows how fast


def test_what_is_touched_from_the_first_on_is_kept_and_nothing_new() -> None:
    found = measure_self_contact(reaching(BELLY, BELOW, BELLY), 0.1)
    assert found.trunk == 0 and found.kept == pytest.approx(1.0)
    left = measure_self_contact(reaching(BELLY, OUT, OUT, OUT, BELLY), 0.1)
    assert left.trunk == 0 and 0 < left.kept < 0.5


def test_the_hand_that_rests_says_nothing_beside_one_that_moves() -> None:
    """The right hand lies on the trunk all the time while the left one waves."""
    hand = np.tile(np.array(BELLY), (FRAMES, 1))
    both = {**reaching(DOWN, OUT, DOWN), "right_hand": hand, "right_tip": hand}
    assert measure_self_contact(both, 0.1).kept == 0


def test_a_figure_without_fingers_touches_with_its_hand() -> None:
    whole = reaching(OUT, FACE, FACE, FACE, OUT)
    bare = {n: x for n, x in whole.items() if "tip" not in n}
    assert (
        measure_self_contact(bare, 0.1).head
        == pytest.approx(measure_self_contact(whole, 0.1).head, abs=0.15)
        != 0
    )


def test_a_figure_without_a_head_or_legs_touches_the_rest() -> None:
    world = reaching(OUT, BELLY, BELLY, BELLY, OUT)
    for missing in ("skull", "leg"):
        some = {n: x for n, x in world.items() if missing not in n}
        assert (
            measure_self_contact(some, 0.1).trunk
            == pytest.approx(measure_self_contact(world, 0.1).trunk)
            != 0
        )
    assert measure_self_contact({n: x for n, x in world.items() if n != "skull"}, 0.1).head == 0


points = st.tuples(*[st.floats(-0.5, 0.5), st.floats(0, 1.1), st.floats(-0.5, 0.5)])
paths = st.lists(points, min_size=2, max_size=6)


def turned(world: Mapping[str, Any], angle: float, way: Any) -> dict[str, Any]:
    c, s = np.cos(angle), np.sin(angle)
    turn = np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])
    return {n: x @ turn.T + way for n, x in world.items()}


@given(paths, st.floats(-4, 4), st.floats(-30, 30))
def test_wherever_a_figure_stands_and_looks_it_touches_alike(corners: Any, angle: float, far: float) -> None:
    world = reaching(*corners)
    other = measure_self_contact(turned(world, angle, np.array([far, 0, -far])), 0.1)
    for a, b in zip(astuple(measure_self_contact(world, 0.1))[:4], astuple(other)[:4], strict=True):
        assert abs(a - b) <= 1.5 / FRAMES  # rounding may move a frame over the limit


@given(paths)
def test_a_mirrored_figure_touches_alike(corners: Any) -> None:
    world = reaching(*corners)
    other = {swapped(n): x * [-1, 1, 1] for n, x in world.items()}
    assert astuple(measure_self_contact(other, 0.1)) == pytest.approx(
        astuple(measure_self_contact(world, 0.1))
    )


@given(paths, st.sets(st.sampled_from(sorted(figure()))))
def test_whatever_is_missing_the_figures_are_shares_and_numbers(corners: Any, gone: set[str]) -> None:
    found = measure_self_contact({n: x for n, x in reaching(*corners).items() if n not in gone}, 1 / 30)
    assert all(0 <= x <= 1 for x in (found.head, found.trunk, found.arm, found.kept))
    assert np.isfinite(found.rub) and found.rub >= 0


@pytest.mark.parametrize("factor", [0.01, 100.0])
def test_the_size_and_place_of_a_clip_do_not_matter(toy: Any, factor: float) -> None:
    clip = one_armed(toy)
    usual = astuple(of(clip).contact)
    for other in (scaled(clip, factor), moved(clip, 2.0, (3.0, 0.0, -1.0)), mirrored(clip)):
        assert astuple(of(other).contact) == pytest.approx(usual, abs=0.05)
