"""Lights and backgrounds."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from preview.camera import Camera
from preview.figure import StickFigure
from preview.looks import BACKDROPS, LIGHTS, STAGE, STUDIO, look_name, look_of
from preview.offscreen import Offscreen
from preview.scene import THEMES, Actor, LampTurn, Scene


@pytest.mark.parametrize("theme", THEMES)
def test_studio_on_the_stage_is_the_theme_itself_and_unknown_names_change_nothing(theme):
    assert look_of(theme) is THEMES[theme]
    assert look_of(theme, "moon", "beach") is THEMES[theme]


def test_every_preset_has_a_name_of_its_own_a_lamp_above_and_a_ground_that_shadows_darken():
    names = [look_name(name) for name in (*LIGHTS, *BACKDROPS)]
    assert len(set(names)) == len(names)
    for light in LIGHTS:
        for back in BACKDROPS:
            look = look_of("dark", light, back)
            assert np.linalg.norm(look.to_light) == pytest.approx(1.0) and look.to_light[1] > 0.3
            assert all(0 <= x <= 1 for x in look.shadow)


@pytest.mark.gl
def test_lights_fall_from_other_sides_and_a_plain_background_is_one_colour_up_to_the_edges(toy):
    figure = StickFigure(toy.skeleton)
    rotations, positions = toy.skeleton.globals(toy.skeleton.rest)
    scene = Scene((Actor(figure, rotations, positions),))
    with Offscreen(160, 120) as offscreen:
        camera = Camera().frame(scene.bounds(), 160 / 120)
        drawn = {name: offscreen.render(scene, camera, look_of("dark", name)) for name in LIGHTS}
        for name in LIGHTS:
            assert name == STUDIO or np.abs(drawn[name].astype(int) - drawn[STUDIO]).max() > 20
        grey = offscreen.render(scene, camera, look_of("light", STUDIO, "neutral"))
        edge = np.concatenate([grey[0], grey[:, 0]])[:, :3].astype(int)
        assert np.ptp(edge, axis=0).max() <= 1 and abs(int(edge[0, 0]) - 117) <= 2
        green = offscreen.render(scene, camera, look_of("dark", STUDIO, "green"))
        assert np.abs(green[-1, :, :3].astype(int) - (0, 176, 64)).max() <= 2, "no shadow on it"
    assert STAGE in BACKDROPS


@pytest.mark.gl
def test_a_picture_behind_is_seen_whole_and_upright():
    picture = np.zeros((10, 20, 3), np.uint8)
    picture[:5], picture[5:] = (255, 0, 0), (0, 0, 255)
    with Offscreen(100, 100) as offscreen:
        drawn = offscreen.render(Scene(picture=picture), Camera())
        other = offscreen.render(Scene(picture=picture[::-1].copy()), Camera())
    assert drawn[30, 50, 0] > 250 and drawn[70, 50, 2] > 250 and other[30, 50, 2] > 250
    assert max(drawn[10, 50, :3]) < 80, "what it does not cover is the theme's"


@pytest.mark.gl
def test_two_pictures_side_by_side_share_what_they_draw_and_are_what_each_is_alone(toy):
    figure = StickFigure(toy.skeleton)
    scene = Scene((Actor(figure, *toy.skeleton.globals(toy.skeleton.rest)),))
    camera = Camera().frame(scene.bounds(), 1.0)
    with Offscreen(200, 200) as first:
        beside = Offscreen(120, 120, beside=first)
        a = first.render(scene, camera)
        b = beside.render(scene, camera.orbit(0.3, 0.0))
        moved = Scene((Actor(figure, *toy.skeleton.globals(toy.skeleton.rest)),))
        assert (first.render(moved, camera) == a).all()
        assert (beside.render(moved, camera.orbit(0.3, 0.0)) == b).all()
        assert beside.renderer.store is first.renderer.store
    beside.release()  # after the first: nothing happens
    with Offscreen(200, 200) as alone:
        assert (alone.render(scene, camera) == a).all()


def test_a_turned_lamp_keeps_its_height_and_its_angle_to_a_camera_that_turns_as_far():
    theme = THEMES["dark"]
    turned = theme.turned(LampTurn(np.pi / 2))
    x, y, z = theme.to_light
    assert turned.to_light == pytest.approx([z, y, -x])
    mirrored = theme.turned(LampTurn(0.0, mirrored=True))
    assert mirrored.to_light == pytest.approx([-x, y, z])
    assert theme.turned(LampTurn(0.0)).to_light == pytest.approx(theme.to_light)


@pytest.mark.gl
def test_a_scene_is_drawn_in_the_light_that_it_says(toy):
    figure = StickFigure(toy.skeleton)
    rotations, positions = toy.skeleton.globals(toy.skeleton.rest)
    plain = Scene((Actor(figure, rotations, positions),), ground=False)
    behind = replace(plain, lamp=LampTurn(np.pi))
    assert not plain.same(behind)
    with Offscreen(160, 120) as offscreen:
        camera = Camera().frame(plain.bounds(), 160 / 120)
        lit, dark = (offscreen.render(s, camera).astype(int) for s in (plain, behind))
        assert np.abs(lit - dark).max() > 20
        theme = THEMES["dark"].turned(LampTurn(np.pi))
        assert np.array_equal(dark, offscreen.render(plain, camera, theme))
