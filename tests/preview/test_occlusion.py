"""Limbs keep light from each other, and from nothing else."""

from __future__ import annotations

import numpy as np
import pytest

from metagraph.formats.gltf.reader import read_character
from metagraph.motion import rotation
from metagraph.motion.skeleton import Pose
from preview.camera import Camera
from preview.figure import SkinnedFigure, StickFigure
from preview.occlusion import FROM_END, FROM_START, LIMBS, OWN, WHOLE, tabulate_occlusion
from preview.offscreen import Offscreen
from preview.scene import DARK, Actor, Scene
from tests.preview.conftest import chain

NAMES = [name for name, *_ in LIMBS]


@pytest.fixture
def open_air(offscreen, monkeypatch):
    """What draws with occlusion, whatever draws."""
    monkeypatch.setattr(offscreen.renderer, "occlusion", True)
    return offscreen


def way(of: str, rod: str) -> int:
    return int(tabulate_occlusion()[NAMES.index(of), NAMES.index(rod)])


def test_no_limb_is_dark_by_itself_and_none_by_what_it_hangs_on_where_they_meet():
    assert all(way(name, name) == OWN for name in NAMES)
    assert way("trunk", "left arm") == FROM_START
    assert way("left forearm", "left arm") == FROM_END
    assert way("left arm", "left forearm") == FROM_START
    assert way("head", "trunk") == FROM_END
    assert way("left thigh", "trunk") == FROM_START
    assert way("left thigh", "right thigh") == WHOLE
    assert way("left arm", "trunk") == WHOLE, "an arm hangs beside the trunk's rod, not at its end"


def test_who_is_no_person_has_no_rods():
    assert StickFigure(chain("a", "b", "c")).rods is None


def test_rods_lie_where_limbs_are_and_move_with_them(mannequin):
    figure = SkinnedFigure(mannequin)
    rods, skeleton = figure.rods, figure.skeleton
    assert rods is not None and (rods.radii > 0.02).all() and (rods.radii < 0.12).all()
    turned = skeleton.rest_rotations.copy()
    arm = skeleton.index("LeftUpperArm")
    turned[arm] = rotation.multiply(turned[arm], rotation.from_axis_angle(np.array([0.0, 0, 1]), -1.2))
    rotations, positions = skeleton.globals(Pose(turned, skeleton.rest_translations))
    starts, ends = rods.placed(figure.palette(rotations, positions))
    for name, first, last in (
        ("left arm", "LeftUpperArm", "LeftLowerArm"),
        ("left forearm", "LeftLowerArm", "LeftHand"),
        ("right shin", "RightLowerLeg", "RightFoot"),
    ):
        n = NAMES.index(name)
        np.testing.assert_allclose(starts[n, :3], positions[skeleton.index(first)], atol=1e-4)
        np.testing.assert_allclose(ends[n, :3], positions[skeleton.index(last)], atol=1e-4)


@pytest.mark.gl
def test_an_arm_at_the_side_darkens_the_flank_and_nothing_gets_brighter(open_air, mannequin):
    figure = SkinnedFigure(mannequin)
    skeleton = figure.skeleton
    turned = skeleton.rest_rotations.copy()
    for name, sign in (("LeftUpperArm", 1), ("RightUpperArm", -1)):
        joint = skeleton.index(name)
        axis = np.array([0.0, 0, 1])
        turned[joint] = rotation.multiply(turned[joint], rotation.from_axis_angle(axis, -sign * 1.2))
    placed = skeleton.globals(Pose(turned, skeleton.rest_translations))
    scene = Scene((Actor(figure, *placed),))
    camera = Camera(yaw=0.0).frame(scene.bounds(), 0.8)
    with_rods = open_air.render(scene, camera, DARK, (240, 300))[..., :3].astype(int)
    figure.__dict__["rods"] = None
    without = open_air.render(Scene((Actor(figure, *placed),)), camera, DARK, (240, 300))[..., :3].astype(int)
    change = (with_rods - without).sum(-1)
    assert change.max() <= 9, "smoothing moves an edge by a step or three"
    assert (change < -9).sum() > 200, (change < -9).sum()
    head = placed[1][skeleton.index("Head")] + [0, 0.18, 0]
    x, y = camera.project(head, 0.8) * [240, 300]
    assert abs(change[int(y), int(x)]) < 6, "the top of the head is open"


@pytest.mark.gl
@pytest.mark.parametrize("name", ["kaykit-rogue/Rogue.glb", "robot-expressive/RobotExpressive.glb"])
def test_bodies_of_other_shapes_stay_bright_where_they_rest(open_air: Offscreen, shared_data, name):
    """A child's body is as wide as high: its rods are as well, and must not shade all of it."""
    figure = SkinnedFigure(read_character(shared_data / name))
    placed = figure.skeleton.globals(figure.skeleton.rest)
    camera = Camera(yaw=0.0).frame(Scene((Actor(figure, *placed),)).bounds(), 0.8)
    lit = open_air.render(Scene((Actor(figure, *placed),)), camera, DARK, (240, 300))[..., :3].astype(float)
    figure.__dict__["rods"] = None
    plain = open_air.render(Scene((Actor(figure, *placed),)), camera, DARK, (240, 300))[..., :3].astype(float)
    inside = np.abs(plain - plain[2, 2]).sum(-1) > 60
    assert 0.88 < lit[inside].mean() / plain[inside].mean() <= 1.001


@pytest.mark.gl
def test_the_processor_draws_without_unless_it_is_asked_to(offscreen):
    assert offscreen.renderer.occlusion == (not offscreen.renderer.software)
