"""What is nearer or farther than what a camera is focused on is blurred."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from preview.camera import Camera
from preview.framing import find_focus
from preview.looks import set_back_picture, set_place
from preview.offscreen import Offscreen
from preview.scene import LIGHT, Actor, BackPicture, Scene
from preview.stool import make_stool

CAMERA = Camera(target=(0, 0.4, 0), distance=2.0, pitch=0.3)
SIZE = (640, 480)
STOOL = make_stool((0, 0.45, 0), 0.17)


def measure_detail(picture: np.ndarray) -> float:
    """How much neighbouring pixels differ, on average."""
    grey = picture[..., :3].astype(float).mean(-1)
    return float(np.abs(np.diff(grey, axis=1)).mean() + np.abs(np.diff(grey, axis=0)).mean())


def find_stool(offscreen: Offscreen) -> np.ndarray:
    """Where the stool is drawn, without its edge."""
    found = offscreen.render(Scene((STOOL,), shadow=False), CAMERA, LIGHT, SIZE).astype(int)
    empty = offscreen.render(Scene(shadow=False), CAMERA, LIGHT, SIZE)
    seen = np.abs(found - empty).max(-1) > 20
    for axis in (0, 1):
        seen &= np.roll(seen, 2, axis) & np.roll(seen, -2, axis)
    return np.asarray(seen)


def test_what_is_in_focus_stays_and_the_floor_far_behind_is_blurred(offscreen: Offscreen) -> None:
    theme = set_place(LIGHT, "room", [])
    sharp = offscreen.render(Scene((STOOL,)), CAMERA, theme, SIZE)
    blurred = offscreen.render(Scene((STOOL,), focus=2.0), CAMERA, theme, SIZE)
    stool = find_stool(offscreen)
    assert np.abs(blurred[stool].astype(int) - sharp[stool]).max() <= 1
    away = np.abs(blurred.astype(int) - sharp).max(-1)
    assert (away > 8).mean() > 0.02  # boards, skirting and the edges of the walls
    assert measure_detail(blurred) < 0.9 * measure_detail(sharp)
    assert np.array_equal(blurred[..., 3], sharp[..., 3])


def test_what_is_too_near_or_too_far_is_blurred_itself(offscreen: Offscreen) -> None:
    stool = find_stool(offscreen)
    for focus in (0.5, 12.0):
        sharp = offscreen.render(Scene((STOOL,)), CAMERA, LIGHT, SIZE)
        blurred = offscreen.render(Scene((STOOL,), focus=focus), CAMERA, LIGHT, SIZE)
        assert np.abs(blurred[stool].astype(int) - sharp[stool]).max() > 10


def test_colours_in_focus_do_not_spread_over_what_is_behind(offscreen: Offscreen) -> None:
    """A dark figure before a plain picture leaves no shadow round itself."""
    theme = set_back_picture(LIGHT, BackPicture(np.full((90, 160, 3), 200, np.uint8)))
    scene = Scene((STOOL,), shadow=False, focus=2.0)
    picture = offscreen.render(scene, CAMERA, theme, SIZE).astype(int)
    plain = offscreen.render(replace(scene, actors=()), CAMERA, theme, SIZE)
    inside = np.abs(picture - plain).max(-1) > 3
    sharp = offscreen.render(replace(scene, focus=None), CAMERA, theme, SIZE).astype(int)
    drawn = np.abs(sharp - plain).max(-1) > 3
    for axis in (0, 1):
        drawn |= np.roll(drawn, 2, axis) | np.roll(drawn, -2, axis)
    assert (inside & ~drawn).mean() < 0.001


def test_without_figures_and_after_another_size_it_is_blurred_as_well(offscreen: Offscreen) -> None:
    theme = set_place(LIGHT, "room", [])
    first = offscreen.render(Scene(focus=1.0), CAMERA, theme, SIZE)
    offscreen.render(Scene(focus=1.0), CAMERA, theme, (64, 48))
    again = offscreen.render(Scene(focus=1.0), CAMERA, theme, SIZE)
    assert np.array_equal(first, again)


def test_nothing_is_blurred_where_nothing_is_behind(offscreen: Offscreen) -> None:
    theme = replace(LIGHT, transparent=True)
    pictures = [offscreen.render(Scene((STOOL,), focus=focus), CAMERA, theme, SIZE) for focus in (None, 9.0)]
    assert np.array_equal(*pictures)


def test_the_focus_is_on_who_is_in_the_middle_of_the_picture() -> None:
    def stand(x: float, z: float) -> Actor:
        return Actor(STOOL.figure, STOOL.rotations, np.array([[[x, 0.4, z]]], np.float32))

    camera = Camera(target=(0, 0.4, 0), distance=3.0, pitch=0.0, yaw=0.0)
    assert find_focus(camera, [stand(0, 0.5)]) == pytest.approx(2.5, abs=0.01)
    assert find_focus(camera, [stand(0, 0.5), stand(2, -2)]) == pytest.approx(2.5, abs=0.05)
    assert find_focus(camera, [stand(-0.4167, 0.5), stand(0.5833, -0.5)]) == pytest.approx(3.0, abs=0.2)
    assert find_focus(camera, [stand(0, 5)]) is None
    assert find_focus(camera, []) is None
