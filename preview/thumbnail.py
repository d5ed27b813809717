"""Make thumbnails: small pictures of poses of a clip, and find the pose that tells most."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.motion.roles import find_roles
from metagraph.motion.skeleton import Pose
from preview import joints as rules
from preview.camera import Camera
from preview.figure import MeshFigure
from preview.framing import Box, choose_nearness, find_heading, find_near_box
from preview.offscreen import Offscreen
from preview.scene import DARK, Actor, Scene, SceneTheme

Array = NDArray[Any]

LOOK_AT = 120  # frames of a clip that are compared
FRAMED = 16  # frames of a clip that certainly fit into the picture


def find_telling_frame(clip: Clip) -> int:
    """Return the frame whose pose differs most from the first. The root is left out; fingers and face count
    little.
    """
    frames = np.unique(np.linspace(0, clip.frames - 1, min(clip.frames, LOOK_AT)).round().astype(int))
    poses = clip.poses()[frames]
    translations = poses.translations.copy()
    translations[:, 0] = 0
    _, positions = clip.skeleton.globals(Pose(poses.rotations, translations))
    small = np.array(
        [rules.is_finger(n) or rules.is_face(n) or rules.is_control(n) for n in clip.skeleton.names]
    )
    apart = np.linalg.norm(positions - positions[:1], axis=-1) * np.where(small, 0.1, 1.0)
    return int(frames[np.argmax(apart.sum(1))])


@dataclass(frozen=True)
class ThumbnailStyle:
    """How a thumbnail is drawn: `size * scale` pixels on a side. `paper` is the sRGB background, None for a
    transparent one. `tint` is an sRGB colour (that of the clip's kind) mixed into the paper a little.
    """

    size: int = 160
    scale: int = 2
    tint: tuple[float, float, float] | None = None
    paper: tuple[float, float, float] | None = (0.110, 0.114, 0.129)
    theme: SceneTheme = DARK

    @property
    def background(self) -> tuple[float, float, float, float]:
        """The colour behind the figure, with its opacity."""
        if self.paper is None:
            return 0.0, 0.0, 0.0, 0.0
        share = 0.0 if self.tint is None else 0.16
        tint = self.tint or self.paper
        r, g, b = (p * (1 - share) + t * share for p, t in zip(self.paper, tint, strict=True))
        return r, g, b, 1.0


USUAL = ThumbnailStyle()


def render_thumbnail(
    offscreen: Offscreen,
    figure: MeshFigure,
    rotations: Array,
    positions: Array,
    style: ThumbnailStyle = USUAL,
) -> Array:
    """Return a square picture `[size * scale, size * scale, 4]` uint8 of one pose on the figure's skeleton.

    `rotations` `[J, 4]` and `positions` `[J, 3]` are global. All clips of a skeleton are framed in the same
    way, so that they can be compared; a figure that leaves the frame is shown whole.
    """
    pixels = style.size * style.scale
    # The figure is turned towards the lamp, not the camera round it, so that all thumbnails have the same
    # light.
    turn = rotation.from_axis_angle(np.array([0.0, 1, 0]), np.array(-find_heading(figure, positions)))
    centred = rotation.rotate_vectors(turn, positions - positions[0] * [1, 0, 1])
    actor = Actor(figure, rotation.multiply(turn, rotations), centred)
    camera = _camera(_person(figure, figure.posed_bounds(actor.rotations, actor.positions)))
    scene = Scene((actor,), background=style.background)
    return offscreen.render(scene, camera, style.theme, (pixels, pixels))


def render_thumbnails(
    offscreen: Offscreen,
    figure: MeshFigure,
    clip: Clip,
    frames: Array,
    pixels: int = 320,
    theme: SceneTheme = DARK,
    paper: tuple[float, float, float] | None = None,
) -> list[Array]:
    """Return square pictures `[pixels, pixels, 4]` uint8 of a clip's frames `[N]`.

    They are as near as the moved parts allow, all framed in the same way, and turned by the direction of the
    first frame. The character stays in the middle.
    """
    background = (*paper, 1.0) if paper is not None else (0.0, 0.0, 0.0, 0.0)
    looked = np.unique(np.linspace(0, clip.frames - 1, min(clip.frames, FRAMED)).round().astype(int))
    every = np.concatenate((looked[:1], np.unique(np.concatenate((looked, frames)))))
    rotations, positions = clip.skeleton.globals(clip.poses()[every])
    turn = rotation.from_axis_angle(np.array([0.0, 1, 0]), np.array(-find_heading(figure, positions[0])))
    centred = rotation.rotate_vectors(turn, positions - positions[:, :1] * [1, 0, 1])
    turned = rotation.multiply(turn, rotations)
    near = choose_nearness(clip)
    if near == "whole":
        box = _person(figure, figure.posed_bounds(turned, centred))
    else:
        low, high = find_near_box(clip.skeleton, near, centred, figure.bounds(centred), figure.height)
        # Some heads are wider than the shoulders.
        head = figure.posed_bounds(turned, centred, find_roles(clip.skeleton)["head"])
        box = np.minimum(low, [head[0][0], low[1], head[0][2]]), np.maximum(high, head[1])
    camera = _camera(box)
    at = 1 + np.searchsorted(every[1:], frames)
    return [
        offscreen.render(
            Scene((Actor(figure, turned[n], centred[n]),), background=background),
            camera, theme, (pixels, pixels),
        )
        for n in at
    ]  # fmt: skip


def _person(figure: MeshFigure, whole: Box) -> Box:
    """Return a box at least as large as that of a person with half-raised arms, turned with the character."""
    low, high = whole
    reach, top = 0.42 * figure.height, 1.1 * figure.height
    centre = (low + high) / 2
    half = np.array([reach, 0, reach * 0.4])
    low = np.minimum(low, [centre[0] - half[0], 0, centre[2] - half[2]])
    high = np.maximum(high, [centre[0] + half[0], min(top, max(high[1], top * 0.9)), centre[2] + half[2]])
    return low, high


def _camera(box: Box) -> Camera:
    return Camera().facing(np.radians(22), np.radians(6)).frame(box, 1.0, margin=1.02)


def draw_clip_thumbnail(
    offscreen: Offscreen, figure: MeshFigure, clip: Clip, style: ThumbnailStyle = USUAL
) -> Array:
    """Return `render_thumbnail` of the clip's telling frame. The clip is on the figure's skeleton."""
    rotations, positions = clip.skeleton.globals(clip.poses()[find_telling_frame(clip)])
    return render_thumbnail(offscreen, figure, rotations, positions, style)
