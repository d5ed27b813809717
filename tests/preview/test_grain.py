"""Normal maps in second texture coordinates, and skin that light goes into."""

from __future__ import annotations

import io
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from metagraph.formats.gltf.reader import read_character, write_glb
from metagraph.motion.character_mesh import CharacterMesh, MeshMaterial, Surface
from metagraph.motion.skeleton import Skeleton
from preview.camera import Camera
from preview.figure import SkinnedFigure, encode_shininess
from preview.scene import Actor, Scene
from preview.simplify import Fewer


def normal_map(*rows: tuple[tuple[int, int, int], ...]) -> bytes:
    from PIL import Image

    out = io.BytesIO()
    Image.fromarray(np.array(rows, np.uint8)).save(out, "PNG")
    return out.getvalue()


UP, DOWN, FLAT = (128, 220, 200), (128, 36, 200), (128, 128, 255)


def wall(grain: bytes | None, name: str = "wall", turn: float = 0.0) -> CharacterMesh:
    """A wall of 2 x 2 m that faces +Z, turned about Y, on two joints."""
    skeleton = Skeleton(
        ("a", "b"), np.array([-1, 0]), np.tile([0.0, 0, 0, 1], (2, 1)), np.array([[0, 0.1, 0], [0, 1.0, 0.0]])
    )
    side = np.array([np.cos(turn), 0, -np.sin(turn)])
    facing = np.array([np.sin(turn), 0, np.cos(turn)])
    at = np.arange(5) / 2 - 1
    grid = np.array([x * side + [0, y + 1, 0] for y in at for x in at])
    cells = [(i * 5 + j) for i in range(4) for j in range(4)]
    triangles = np.array([t for a in cells for t in ((a, a + 1, a + 6), (a, a + 6, a + 5))], np.uint32)
    count = len(grid)
    joints = np.zeros((count, 4), np.uint16)
    joints[:, 0] = (grid[:, 1] > 1).astype(int)
    return CharacterMesh(
        "wall",
        skeleton,
        grid.astype(np.float32),
        np.tile(facing, (count, 1)).astype(np.float32),
        np.zeros((count, 2), np.float32),
        joints,
        np.tile([1.0, 0, 0, 0], (count, 1)).astype(np.float32),
        triangles,
        (MeshMaterial(name, (0.4, 0.4, 0.4, 1.0), None, 0.9, grain=grain),),
        (Surface(0, len(triangles), 0),),
        grain_uvs=None if grain is None else np.stack([grid[:, 0], -grid[:, 1]], 1).astype(np.float32),
    )


def brightness(offscreen: Any, character: CharacterMesh) -> float:
    figure = SkinnedFigure(character)
    rotations, positions = figure.skeleton.globals(figure.skeleton.rest)
    scene = Scene((Actor(figure, rotations, positions),), shadow=False)
    camera = Camera(target=(0.0, 1.0, 0.0), yaw=0.0, pitch=0.0, distance=3.0)
    return float(offscreen.render(scene, camera, size=(80, 60))[20:40, 30:50, :3].mean())


def test_a_grain_that_leans_up_catches_the_lamp_above_and_one_that_leans_down_does_not(offscreen):
    up, down = (brightness(offscreen, wall(normal_map((n, n), (n, n)))) for n in (UP, DOWN))
    assert up > down + 20


def test_a_flat_grain_looks_as_none(offscreen):
    flat = brightness(offscreen, wall(normal_map((FLAT, FLAT), (FLAT, FLAT))))
    assert flat == pytest.approx(brightness(offscreen, wall(None)), abs=1.5)


def test_a_grain_comes_back_from_a_file_and_one_in_the_first_coordinates_is_not_read(tmp_path: Path):
    made = wall(normal_map((UP, FLAT), (FLAT, DOWN)))
    write_glb(tmp_path / "wall.glb", (), made)
    back = read_character(tmp_path / "wall.glb")
    assert back.materials[0].grain == made.materials[0].grain
    np.testing.assert_allclose(back.grain_uvs, made.grain_uvs, atol=1e-6)
    content = (tmp_path / "wall.glb").read_bytes().replace(b'"texCoord":1', b'"texCoord":0')
    (tmp_path / "first.glb").write_bytes(content)
    other = read_character(tmp_path / "first.glb")
    assert other.materials[0].grain is None and other.grain_uvs is None


def test_coordinates_of_a_grain_have_the_shape_of_texture_coordinates():
    with pytest.raises(ValueError, match="grain_uvs"):
        replace(wall(normal_map((FLAT,))), grain_uvs=np.zeros((3, 2)))


def test_levels_of_detail_have_no_grain():
    mesh = SkinnedFigure(wall(normal_map((UP, UP)))).mesh
    assert mesh.batches[0].grain is not None and mesh.grain is not None
    all_of_it = Fewer(np.arange(len(mesh.vertices)), mesh.triangles, np.array([len(mesh.triangles)]))
    fewer = all_of_it.of(mesh)
    assert fewer.grain is None and fewer.batches[0].grain is None


def test_skin_is_told_by_its_materials_name_and_all_else_is_even():
    for name, skin in (("skin", 1), ("Body_00_SKIN", 1), ("Skinny jeans", 0), ("buckskins", 0), ("cloth", 0)):
        assert encode_shininess(MeshMaterial(name, roughness=0.37)) % 2 == skin, name
    assert encode_shininess(MeshMaterial("x", roughness=0.0)) == 254


def test_light_goes_on_under_skin_beyond_the_terminator(offscreen):
    # Turned so far from the lamp that its light just ends.
    turn = np.radians(124.0) - np.pi / 2
    plain, skin = (brightness(offscreen, wall(None, name, turn)) for name in ("wall", "skin"))
    assert skin > plain + 1
