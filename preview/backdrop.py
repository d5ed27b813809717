"""Draw what is behind the figures: ground and sky, one flat colour, or a picture."""

from __future__ import annotations

import math
from typing import Any

import moderngl
import numpy as np
from numpy.typing import NDArray

from preview import shaders
from preview.camera import Camera
from preview.drawing import SceneDrawing, set_uniforms
from preview.frame import Frame
from preview.scene import THEMES, SceneTheme, Walls

Array = NDArray[Any]


class ViewBackdrop:
    """The backdrop of one view. While its camera stands still, ground and sky are kept as a picture."""

    def __init__(self, drawing: SceneDrawing) -> None:
        self._drawing = drawing
        self._held: list[Any] = []
        self._seen: tuple[Camera, tuple[int, int], SceneTheme, bool] | None = None  # how they were drawn last
        self._kept, self._sky_from = False, 0  # whether kept; the row where the sky begins

    def release(self) -> None:
        """Release everything on the graphics card."""
        while self._held:
            self._held.pop().release()

    def resize(self, size: tuple[int, int]) -> None:
        """Make room for another size in pixels."""
        self.release()
        texture = self._drawing.ctx.texture(size, 4)
        self._stage = self._drawing.ctx.framebuffer([texture])
        self._held = [texture, self._stage]
        self._seen = None

    def draw(self, frame: Frame, target: Any) -> int:
        """Draw the backdrop. Return the row, counted from below, at which the ground ends: 0 if there is
        none.
        """
        scene, (width, height) = frame.scene, frame.size
        self._drawing.state(target, (0, 0, width, height), moderngl.NOTHING)
        if scene.picture is not None:
            target.clear(*(scene.background or (*frame.theme.top, 1.0)), viewport=(0, 0, width, height))
            self._behind(scene.picture, frame.size)
            return 0
        if scene.background is not None:
            target.clear(*scene.background, viewport=(0, 0, width, height))
            return 0
        if frame.theme.transparent:
            target.clear(0.0, 0.0, 0.0, 0.0, viewport=(0, 0, width, height))
            return 0
        if frame.theme.picture is not None and scene.ground:
            target.clear(*frame.theme.top, 1.0, viewport=(0, 0, width, height))
            self._behind(frame.theme.picture.pixels, frame.size, fill=True)
            return _find_far_row(frame, 60.0)
        return self._ground_and_sky(frame, target)

    def _ground_and_sky(self, frame: Frame, target: Any) -> int:
        """Draw ground up to its far edge and sky above. From the second picture on, a kept picture
        is copied.
        """
        key = frame.camera, frame.size, frame.theme, frame.scene.ground
        if key != self._seen:
            self._seen, self._kept = key, False
            return self._empty_stage(frame, target)
        if not self._kept:
            self._drawing.state(self._stage, (0, 0, *frame.size), moderngl.NOTHING)
            self._sky_from = self._empty_stage(frame, self._stage)
            self._kept = True
            self._drawing.state(target, (0, 0, *frame.size), moderngl.NOTHING)
        self._drawing.ctx.copy_framebuffer(target, self._stage)
        target.use()
        return self._sky_from

    def _behind(self, picture: Array, size: tuple[int, int], fill: bool = False) -> None:
        """Draw a picture as large as it fits, or so large that nothing is left empty."""
        high, wide = picture.shape[:2]
        scale = (max if fill else min)(size[0] / wide, size[1] / high)
        part = (wide * scale / size[0], high * scale / size[1])
        self._drawing.picture(picture).use(5)
        program = self._drawing.program("behind", shaders.COVER, shaders.BEHIND)
        set_uniforms(program, u_picture=5, u_part=part)
        self._drawing.bare("behind", program).render(moderngl.TRIANGLES, 3)

    def _empty_stage(self, frame: Frame, target: Any) -> int:
        """Draw ground and sky so that no pixel is painted twice. Return the row at which the sky begins."""
        camera, (width, height) = frame.camera, frame.size
        walls = frame.theme.walls
        if walls is not None and frame.scene.ground:
            self._walls(frame, walls)
            return _find_far_row(frame, max(map(abs, (*walls.low[::2], *walls.high[::2]))))
        sky_from = 0
        if frame.scene.ground and camera.eye[1] > 0:
            reach = min(60.0, max(7.0, 2.2 * camera.distance))
            x, z = camera.target[0], camera.target[2]
            right = camera.axes[0]
            edge = camera.project((x + 4 * reach * right[2], 0.0, z - 4 * reach * right[0]), width / height)[
                1
            ]
            sky_from = int(np.clip((1 - edge) * height - 1, 0, height)) if np.isfinite(edge) else 0
            # Wide enough to reach both sides of the picture at its far edge.
            wide = 4 * reach * max(1.0, 2 * math.tan(camera.fov / 2) * width / height)
            self._ground(frame, (x, z, wide, 4 * reach), (right[0], right[2]), reach)
        if sky_from < height:
            self._drawing.ctx.enable_only(moderngl.NOTHING)
            target.scissor = (0, sky_from, width, height - sky_from)
            self._sky(
                "sky", self._drawing.program("sky", shaders.COVER, shaders.SKY), frame, moderngl.TRIANGLES, 3
            )
            target.scissor = None
        return sky_from

    def _walls(self, frame: Frame, walls: Walls) -> None:
        """Draw a studio or a room."""
        right, up, back = frame.camera.axes
        tall = math.tan(frame.camera.fov / 2)
        program = self._drawing.program("walls", shaders.COVER, shaders.WALLS)
        set_uniforms(program, u_eye=frame.camera.eye, u_ahead=-back)
        set_uniforms(program, u_right=right * (tall * frame.size[0] / frame.size[1]), u_above_eye=up * tall)
        set_uniforms(program, u_low=walls.low, u_high=walls.high, u_bend=walls.bend)
        set_uniforms(program, u_floor=walls.floor, u_wall=walls.wall, u_furnished=float(walls.furnished))
        set_uniforms(program, u_tint=find_tint(frame.theme), u_to_light=frame.theme.to_light)
        self._sky("walls", program, frame, moderngl.TRIANGLES, 3)

    def _ground(
        self, frame: Frame, patch: tuple[float, ...], turn: tuple[float, float], reach: float
    ) -> None:
        theme, distance = frame.theme, frame.camera.distance
        spacing = 0.5 if distance < 14 else 1.0 if distance < 40 else 5.0
        program = self._drawing.program("ground", shaders.GROUND_VERTEX, shaders.GROUND)
        set_uniforms(program, u_matrix=frame.matrix, u_patch=patch, u_turn=turn, u_reach=reach)
        set_uniforms(
            program, u_floor=theme.floor, u_line=theme.line, u_spacing=(spacing, theme.line_strength)
        )
        self._sky("ground", program, frame, moderngl.TRIANGLE_STRIP, 4)

    def _sky(self, key: str, program: moderngl.Program, frame: Frame, mode: int, count: int) -> None:
        """Draw with a program that ends in the colours of the sky."""
        set_uniforms(
            program,
            u_pixel=(1 / frame.size[0], 1 / frame.size[1]),
            u_top=frame.theme.top,
            u_bottom=frame.theme.bottom,
        )
        self._drawing.bare(key, program).render(mode, count)


def find_tint(theme: SceneTheme) -> tuple[float, float, float]:
    """Return the colour of a light on white, sRGB, 1 for the studio's."""
    plain = THEMES[theme.name]
    lights = [
        0.5 * np.array(x.key) + 0.5 * np.array(x.above) + 0.3 * np.array(x.below) for x in (theme, plain)
    ]
    red, green, blue = np.clip((lights[0] / lights[1]) ** (1 / 2.2), 0.3, 1.15).tolist()
    return red, green, blue


def _find_far_row(frame: Frame, reach: float) -> int:
    """Return the row, counted from below, up to which a floor is seen that ends `reach` metres away; 0 from
    below the floor.
    """
    camera, (width, height) = frame.camera, frame.size
    if not frame.scene.ground or camera.eye[1] <= 0:
        return 0
    ends = [(x * reach, 0.0, z * reach) for x in (-1, 0, 1) for z in (-1, 0, 1)]
    seen = camera.project(ends, width / height)[:, 1]
    if not np.isfinite(seen).any():
        return 0
    return int(np.clip((1 - np.nanmin(seen)) * height + 1, 0, height))
