"""Shadows: of figures on themselves near by, and on the ground."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from metagraph.motion.character_mesh import CharacterMesh, MeshMaterial, Surface
from preview import shadows
from preview.camera import Camera
from preview.figure import SkinnedFigure
from preview.frame import Frame, find_piece_boxes
from preview.offscreen import Offscreen
from preview.scene import DARK, Actor, Scene
from tests.preview.conftest import chain
from tests.preview.test_figure import character

pytestmark = pytest.mark.gl
SIZE = (400, 400)
NOON = replace(DARK, toward=(0.35, 1.0, 0.5))


def slab(y: float, half: float) -> tuple[np.ndarray, np.ndarray]:
    """A level square seen from above."""
    positions = np.array([[x, y, z] for x in (-half, half) for z in (-half, half)])
    return positions, np.array([[0, 1, 3], [0, 3, 2]])


def shelf() -> Scene:
    """A small square above a large one: its shadow has straight edges."""
    (low, first), (high, second) = slab(0.9, 0.9), slab(1.1, 0.12)
    made = character(
        chain("a", "b", "c"),
        positions=np.concatenate([low, high]),
        triangles=np.concatenate([first, second + 4]),
        normals=np.tile([0.0, 1, 0], (8, 1)),
        uvs=np.zeros((8, 2)),
        joints=np.zeros((8, 4), int),
        weights=np.tile([1.0, 0, 0, 0], (8, 1)),
        materials=(MeshMaterial("white", (0.8, 0.8, 0.8, 1)),),
        surfaces=(Surface(0, 4, 0),),
    )
    figure = SkinnedFigure(made)
    return Scene((Actor(figure, *figure.skeleton.globals(figure.skeleton.rest)),))


def near() -> Camera:
    """Straight down on the shadow's far corner, past the small square."""
    return Camera((-0.13, 0.9, -0.20), 0.0, np.radians(88.0), 0.6)


def steps(picture: np.ndarray) -> float:
    """How far an edge that leads upwards through a picture is from a straight line, pixels, at most."""
    light = picture[..., :3].astype(float).mean(-1)
    middle = (light.min() + light.max()) / 2
    at = []
    for row in light:
        crossings = np.flatnonzero((row[:-1] < middle) != (row[1:] < middle))
        if len(crossings):
            n = crossings[0]
            at.append(n + (middle - row[n]) / (row[n + 1] - row[n]))
    rows = np.arange(len(at))
    return float(np.abs(at - np.polyval(np.polyfit(rows, at, 1), rows)).max())


def frame_of(scene: Scene, camera: Camera, offscreen: Offscreen) -> Frame:
    offscreen.render(scene, camera, NOON, SIZE)
    actors = list(scene.actors)
    matrix = camera.projection(1.0) @ camera.view()
    parts = find_piece_boxes(actors, offscreen.renderer.store.palettes)
    meshes = [a.figure.mesh for a in actors]
    return Frame(scene, actors, [0], camera, SIZE, NOON, matrix, scene.bounds(), meshes, parts, [])


def test_near_by_an_edge_has_no_saw_teeth(offscreen, monkeypatch):
    """Straight edges stay straight; in the map of all a texel is seven pixels wide here."""
    picture = offscreen.render(shelf(), near(), NOON, SIZE)
    monkeypatch.setattr(shadows, "NEAR", 1e9)
    toothed = offscreen.render(shelf(), near(), NOON, SIZE)
    assert np.ptp(picture[..., 0].astype(int)) > 40, "the shadow is in the picture"
    edge = np.s_[200:340, 60:200]
    assert steps(picture[edge]) < 0.5 * steps(toothed[edge])


def test_the_map_near_by_is_of_what_is_seen_alone(offscreen):
    axes = np.stack(np.eye(3)[[0, 2, 1]] * [[1], [1], [-1]])
    close, far = (frame_of(shelf(), c, offscreen) for c in (near(), replace(near(), distance=8.0)))
    pixels, low, high = shadows.find_seen_window(close, axes)
    assert pixels > 10 * shadows.find_seen_window(far, axes)[0] > 0
    assert (high - low < 0.6).all() and (low < [-0.13, -0.20]).all() and (high > [-0.13, -0.20]).all()
    away = frame_of(shelf(), replace(near(), target=(9.0, 0.9, 9.0)), offscreen)
    assert shadows.find_seen_window(away, axes)[0] == 0, "nothing of it is in the picture"


@pytest.mark.parametrize("distance", [0.6, 1.5, 2.2, 5.0])
def test_whichever_map_is_used_shadows_lie_where_they_did(offscreen, monkeypatch, distance):
    camera = replace(near(), distance=distance)
    seen = offscreen.render(shelf(), camera, NOON, SIZE).astype(int)
    assert (seen.min(-1) < 220).mean() > 0.001
    monkeypatch.setattr(shadows, "SMALL", 0.0)
    for limit in (1e9, 0.0):
        monkeypatch.setattr(shadows, "NEAR", limit)
        other = offscreen.render(shelf(), camera, NOON, SIZE).astype(int)
        assert (np.abs(seen - other).max(-1) > 24).mean() < 0.03


def test_a_window_keeps_its_size_while_a_body_sways_a_little(offscreen):
    axes = np.stack(np.eye(3)[[0, 2, 1]] * [[1], [1], [-1]])
    sizes = set()
    for x in np.linspace(0, 0.004, 5):
        frame = frame_of(shelf(), replace(near(), target=(-0.13 + x, 0.9, -0.2)), offscreen)
        _, low, high = shadows.find_seen_window(frame, axes)
        sizes.add(tuple((high - low).round(9)))
    assert len(sizes) == 1


def test_the_ground_is_as_dark_whether_or_not_the_body_has_a_map_of_its_own(
    offscreen, mannequin, monkeypatch
):
    """Its own shadow comes from a smaller picture then."""
    figure = SkinnedFigure(mannequin)
    scene = Scene((Actor(figure, *figure.skeleton.globals(figure.skeleton.rest)),))
    camera = Camera((0.3, 0.2, -0.3), 0.4, 0.5, 2.0)
    pictures = []
    for limit in (1e9, 1e-9):  # never, always
        monkeypatch.setattr(shadows, "NEAR", limit)
        scene = replace(scene, actors=tuple(replace(a) for a in scene.actors))  # so that nothing is kept
        pictures.append(offscreen.render(scene, camera, NOON, SIZE).astype(int))
    apart = np.abs(pictures[0] - pictures[1]).max(-1)
    assert (pictures[0] != pictures[1]).any() and (apart > 24).mean() < 0.01


def test_who_stands_behind_the_eye_or_round_it_is_no_trouble(offscreen, mannequin):
    figure = SkinnedFigure(mannequin)
    rotations, positions = figure.skeleton.globals(figure.skeleton.rest)
    ahead, behind = (
        Actor(figure, rotations, positions),
        Actor(figure, rotations, positions + [0, 0, 3.0]),
    )
    for z in (0.0, 0.2, 1.0, 3.0):
        camera = Camera((0.0, 1.4, z), 0.0, 0.0, 0.3)
        picture = offscreen.render(Scene((ahead, behind)), camera, NOON, SIZE)
        assert picture.shape == (*SIZE, 4)
    away = frame_of(Scene((behind,)), Camera((0.0, 1.4, 0.0), 0.0, 0.0, 0.5), offscreen)
    assert shadows.find_seen_window(away, np.stack(np.eye(3)))[0] == 0


def test_in_small_pictures_a_body_does_not_shade_itself_in_stripes(
    mannequin: CharacterMesh, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A texel of the small map covers more of a slope than what a surface is kept away by at least."""
    figure = SkinnedFigure(mannequin)
    posed = mannequin.skeleton.globals(mannequin.skeleton.rest)
    scene = Scene((Actor(figure, *(values[None] for values in posed)),))
    camera = Camera().frame(scene.bounds(), 1.0)

    def unevenness(offscreen: Offscreen) -> float:
        lit = offscreen.render(scene, camera)[..., :3].astype(float)
        bare = offscreen.render(replace(scene, shadow=False), camera)[..., :3].astype(float)
        d = (lit - bare).mean(-1)[:200]  # without the ground
        bent = 4 * d[1:-1, 1:-1] - d[2:, 1:-1] - d[:-2, 1:-1] - d[1:-1, 2:] - d[1:-1, :-2]
        return float(np.abs(bent).mean())

    with Offscreen(332, 332) as offscreen:
        if not offscreen.renderer.software:
            pytest.skip("a graphics card's map is fine enough at any size")
        kept = unevenness(offscreen)
        monkeypatch.setattr(shadows, "OFF_TEXELS", 0.0)
        monkeypatch.setattr(offscreen.renderer._shadows, "_off_least", shadows.OFF_LEAST[0])
        assert kept < 0.6 * unevenness(offscreen)
