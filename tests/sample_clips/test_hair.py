"""Hair is sheets: both sides of each are drawn, or one that is seen along its edge is a dotted line."""

from __future__ import annotations

from pathlib import Path

import pytest

from metagraph.formats.gltf.reader import read_character
from metagraph.formats.store import open_project
from metagraph.graph import anatomy
from preview.camera import close_up
from preview.figure import SkinnedFigure
from preview.offscreen import Offscreen
from preview.scene import THEMES, Actor, Scene

SAMPLES = Path(__file__).resolve().parents[2] / "sample_clips"


@pytest.mark.parametrize("name", ["ada.glb", "ben.glb", "mannequin.glb"])
def test_hair_is_drawn_from_both_sides_and_nothing_else_is(name: str) -> None:
    character = read_character(SAMPLES / name)
    assert [m.name for m in character.materials if m.double_sided] == ["hair"]


@pytest.mark.gl
def test_no_strand_of_adas_hair_is_broken_into_dots() -> None:
    project = open_project(SAMPLES / "sample.metagraph.yaml").project
    assert project.skeleton is not None
    figure = SkinnedFigure(read_character(SAMPLES / "ada.glb"))
    rotations, positions = project.skeleton.globals(anatomy.get_base_pose(project))
    actor = Actor(figure, rotations, positions)
    size = (700, 700)
    drawing = Offscreen(*size)
    for yaw in (0.2, 0.35, -0.3):
        camera = close_up(figure.head(rotations, positions), figure.height, 1.0).facing(yaw, 0.1)
        scene = Scene((actor,), background=(0.0, 1.0, 0.0, 1.0))
        covered = drawing.render(scene, camera, THEMES["dark"], size)[..., 1] < 225
        beside = covered[:-2, 1:-1] | covered[2:, 1:-1] | covered[1:-1, :-2] | covered[1:-1, 2:]
        alone = covered[1:-1, 1:-1] & ~beside
        assert alone.sum() <= 8, f"{alone.sum()} dots"
