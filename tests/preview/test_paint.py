import io

import numpy as np
import pytest

import sample_clips
from metagraph.formats.gltf.reader import read_character
from preview import gpu
from preview.camera import make_whole_figure_camera
from preview.figure import SkinnedFigure
from preview.gpu import decode_texture
from preview.mesh import VERTEX, SkinnedMesh, TriangleBatch
from preview.offscreen import Offscreen
from preview.paint import remove_invisible_texture
from preview.scene import LIGHT, Actor, Scene


def image(colors):
    from PIL import Image

    out = io.BytesIO()
    Image.fromarray(np.asarray(colors, np.uint8)).save(out, "PNG")
    return out.getvalue()


def triangles_at(uvs, picture):
    """A mesh of one triangle for each three of `uvs`, all with a picture."""
    vertices = np.zeros(len(uvs), VERTEX)
    vertices["uv"], vertices["color"] = uvs, 255
    vertices["position"] = np.random.default_rng(1).normal(size=(len(uvs), 3))
    count = len(uvs) // 3
    corners = np.arange(3 * count, dtype=np.uint32).reshape(-1, 3)
    return SkinnedMesh(vertices, corners, (TriangleBatch(0, count, picture),), 1)


@pytest.fixture(scope="module")
def ada():
    return SkinnedFigure(read_character(sample_clips.__path__[0] + "/ada.glb"))


def test_what_has_one_colour_needs_no_texture_and_what_has_two_does():
    halves = np.zeros((32, 32, 3), np.uint8)
    halves[:, 16:] = 255, 128, 0
    flat = [(0.1, 0.1), (0.4, 0.1), (0.1, 0.8)], [(0.6, 0.1), (0.9, 0.1), (0.6, 0.8)]
    across = [(0.1, 0.1), (0.9, 0.1), (0.1, 0.8)]
    mesh = triangles_at([*flat[0], *across, *flat[1]], image(halves))
    found, origins = remove_invisible_texture(mesh, decode_texture)
    assert [(b.first, b.count, b.image is None) for b in found.batches] == [(0, 2, True), (2, 1, False)]
    assert origins[found.triangles].tolist() == [[0, 1, 2], [6, 7, 8], [3, 4, 5]]
    # As dark as the shader makes the texture, which is a little more than the power.
    seen = (found.vertices["color"][found.triangles[1], :3] / 255) ** 2.2
    texel = np.array([1, 128 / 255, 0])
    assert seen == pytest.approx(np.tile(texel**2 * (0.7 * texel + 0.3), (3, 1)), abs=0.005)


def test_a_colour_that_fades_evenly_is_told_at_the_corners():
    ramp = np.repeat(np.linspace(100, 120, 64)[None, :, None], 8, 0).repeat(3, 2)
    mesh = triangles_at([(0.2, 0.5), (0.7, 0.5), (0.4, 0.6)], image(ramp))
    assert [b.image for b in remove_invisible_texture(mesh, decode_texture)[0].batches] == [None]


@pytest.mark.parametrize("uvs", [[(0.2, 0.2), (0.7, 0.5), (0.4, 0.6)], [(np.nan, 0), (0, 0), (1, 0)]])
def test_what_has_a_picture_on_it_keeps_it(uvs):
    noise = np.random.default_rng(1).integers(0, 255, (64, 64, 3))
    mesh = triangles_at(uvs, image(noise))
    found, origins = remove_invisible_texture(mesh, decode_texture)
    assert found is mesh and origins.tolist() == [0, 1, 2]


def test_a_mesh_without_textures_or_triangles_is_left_alone():
    plain = SkinnedMesh(np.zeros(3, VERTEX), np.array([[0, 1, 2]], np.uint32), (TriangleBatch(0, 1),), 1)
    empty = SkinnedMesh(
        np.zeros(0, VERTEX), np.zeros((0, 3), np.uint32), (TriangleBatch(0, 0, image([[(1, 2, 3)]])),), 1
    )
    assert (
        remove_invisible_texture(plain, decode_texture)[0] is plain
        and remove_invisible_texture(empty, decode_texture)[0] is empty
    )


def test_most_of_a_sample_needs_no_texture_and_none_of_it_is_lost(ada):
    found, origins = remove_invisible_texture(ada.mesh, decode_texture)
    assert sum(b.count for b in found.batches if b.image is None) > 0.9 * len(found.triangles)
    assert sorted(origins[found.triangles].tolist()) == sorted(ada.mesh.triangles.tolist())
    for name in ("position", "normal", "bones", "weights"):
        assert np.array_equal(found.vertices[name], ada.mesh.vertices[name][origins])


@pytest.mark.gl
def test_pictures_are_the_same_with_colours_at_corners_and_faces_move_as_they_did(
    ada, offscreen, monkeypatch
):
    size = (240, 320)
    rest = ada.skeleton.globals(ada.skeleton.rest)
    face = np.zeros(len(ada.morphs), np.float32)
    face[::3] = 0.8
    scenes = [Scene((Actor(ada, *rest, morphs=m),)) for m in (None, face)]
    camera = make_whole_figure_camera(scenes[0].bounds(), size[0] / size[1]).zoom(3)
    now = [offscreen.render(s, camera, LIGHT, size).astype(int) for s in scenes]
    monkeypatch.setattr(
        gpu, "remove_invisible_texture", lambda mesh, _: (mesh, np.arange(len(mesh.vertices)))
    )
    with Offscreen(*size) as textured:
        before = [textured.render(s, camera, LIGHT, size).astype(int) for s in scenes]
    for a, b in zip(now, before, strict=True):
        assert np.abs(a - b).mean() < 0.1 and (np.abs(a - b).max(-1) > 16).mean() < 1e-3
    assert np.abs(now[0] - now[1]).max() > 16
