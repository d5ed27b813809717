"""Hold what all passes of one picture share, and find which parts of the picture its figures can cover."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from preview.camera import Camera
from preview.mesh import SkinnedMesh
from preview.scene import Actor, Scene, SceneTheme

Array = NDArray[Any]

TILE = 16  # pixels; the side of the squares that covered parts are made of
MOST = 64  # rectangles; if there are more, one round all of them is smoothed, which is cheaper
MARGIN = 2  # pixels that smoothing reads and writes beyond an edge, and a little more


@dataclass(eq=False)
class Frame:
    """What the passes of one picture share.

    `rows` holds each actor's first row in the palette. `matrix` leads from world to clip space `[4, 4]`.
    `bounds` is a box round the actors that are not ghosts. `meshes` holds the mesh that is drawn for each
    actor. `boxes` are the corners of the boxes round all actors' pieces `[N, 8, 3]`. `casters` are the meshes
    that throw each actor's shadow. `light` is the matrix from world to shadow map, 0..1, or None until
    shadows are drawn.
    """

    scene: Scene
    actors: list[Actor]
    rows: list[int]
    camera: Camera
    size: tuple[int, int]
    theme: SceneTheme
    matrix: Array
    bounds: tuple[Array, Array]
    meshes: list[SkinnedMesh]
    boxes: Array
    casters: list[SkinnedMesh]
    light: Array | None = None

    @property
    def floor(self) -> bool:
        """Whether the ground is seen from above."""
        scene = self.scene
        plain = scene.background is None and scene.picture is None and not self.theme.transparent
        return scene.ground and plain and float(self.camera.eye[1]) > 0

    @cached_property
    def ends(self) -> Array:
        """The least x and y and the greatest x and y at which each box is seen `[4, N]`, see
        `Camera.project`. NaN if part of the box is behind the eye.
        """
        camera = self.camera
        # Not `@`: for a crowd it starts threads, which wait busily.
        x, y, z = np.einsum("ij,nj->in", camera.axes, self.boxes.reshape(-1, 3) - camera.eye)
        depth = np.where(z < -1e-9, z, np.nan) * (-2 * math.tan(camera.fov / 2))
        x, y = (x / (depth * (self.size[0] / self.size[1]))).reshape(-1, 8), (y / depth).reshape(-1, 8)
        return np.stack([0.5 + x.min(1), 0.5 - y.max(1), 0.5 + x.max(1), 0.5 - y.min(1)])

    def which(self, solid: bool) -> list[int]:
        """Return the indices of the actors that are not ghosts (`solid`), or of the ghosts."""
        return [i for i, actor in enumerate(self.actors) if (actor.opacity >= 1) == solid]


def is_drawable(actor: Actor) -> bool:
    """Return whether the actor has something to draw and all its numbers are finite."""
    return bool(
        actor.count
        and len(actor.figure.mesh.vertices)
        and np.isfinite(actor.positions).all()
        and np.isfinite(actor.rotations).all()
    )


def measure_pixel_height(actor: Actor, camera: Camera, height: int) -> float:
    """Return about how many pixels tall the nearest instance is."""
    away = np.linalg.norm(np.asarray(actor.positions)[..., 0, :].reshape(-1, 3) - camera.eye, axis=1).min()
    return float(actor.figure.height / (2 * np.tan(camera.fov / 2) * max(float(away), 1e-3)) * height)


def find_covered(frame: Frame) -> Array:
    """Return the parts of the picture that have figures in them `[N, 4]`: left, low, right, high, in pixels
    from below. The rectangles do not overlap.

    The time of smoothing grows with the number of pixels, and the box round a figure with an arm stretched
    out is mostly empty.
    """
    if not frame.actors:
        return np.zeros((0, 4), int)
    width, height = frame.size
    if not np.isfinite(frame.ends).all():  # an actor is behind the eye or round it
        return np.array([[0, 0, width, height]])
    wide, high = (width + TILE - 1) // TILE, (height + TILE - 1) // TILE
    left, top, right, bottom = frame.ends.clip(-1, 2)  # in shares of the picture, from above
    margin = MARGIN / TILE
    left = np.floor(left * (width / TILE) - margin).clip(0).astype(int)
    low = np.floor((1 - bottom) * (height / TILE) - margin).clip(0).astype(int)
    right = np.ceil(right * (width / TILE) + margin).clip(None, wide).astype(int)
    past = np.ceil((1 - top) * (height / TILE) + margin).clip(None, high).astype(int)
    inside = (right > left) & (past > low)
    if not inside.all():
        left, low, right, past = (x[inside] for x in (left, low, right, past))
    # Corners of rectangles, summed up along both axes, count the rectangles over each tile.
    line = wide + 1
    corners = np.concatenate([low * line + left, past * line + right, low * line + right, past * line + left])
    signs = np.repeat([1, -1], 2 * len(left))
    changes = np.bincount(corners, signs, line * (high + 1)).reshape(high + 1, line)
    over = np.zeros((high, wide + 2), np.int8)
    over[:, 1:-1] = changes.cumsum(0).cumsum(1)[:high, :wide] > 0.5
    change = over[:, 1:] - over[:, :-1]
    (rows, first), (_, last) = np.nonzero(change == 1), np.nonzero(change == -1)
    runs = np.stack([first, rows, last, rows + 1], 1) * TILE
    if len(runs) > MOST:
        runs = np.concatenate([runs[:, :2].min(0), runs[:, 2:].max(0)])[None]
    return np.asarray(np.minimum(runs, (width, height, width, height)))


def find_piece_boxes(actors: Sequence[Actor], palettes: Sequence[Array]) -> Array:
    """Return the corners of the boxes round all actors' pieces `[N, 8, 3]`. `palettes` holds each actor's
    palette `[instances, M, 3, 4]`.
    """
    return np.concatenate(
        [np.zeros((0, 8, 3)), *(_corners(*at) for at in zip(actors, palettes, strict=True))]
    )


def _corners(actor: Actor, palette: Array) -> Array:
    """Return the corners of the boxes round an actor's pieces, in all its instances `[N, 8, 3]`."""
    matrix, corners = actor.figure.boxes
    moved = palette[:, matrix].astype(float)
    return np.asarray((corners @ moved[..., :3].swapaxes(-1, -2) + moved[..., None, :, 3]).reshape(-1, 8, 3))
