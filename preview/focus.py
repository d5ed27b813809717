"""Blur what is nearer or farther than what a camera is focused on, as the lens of a camera does."""

from __future__ import annotations

import math
from typing import Any

import moderngl
import numpy as np

from preview import shaders
from preview.drawing import SceneDrawing, set_uniforms
from preview.frame import Frame

SHARP = 0.22  # metres before and behind what is in focus that are sharp: a head, and shoulders
BLUR = 0.014  # of the picture's height: by how much what is endlessly far is blurred, seen from
FROM = 2.0  # metres; less from farther away
MOST = 0.02  # of the height
ENDLESS = 1000.0  # metres to what is behind who has a picture or a plain colour behind them


class DepthOfField:
    """Blurs the finished picture of one view by depth, at half its size. Its textures are made on first use
    and kept until another size is drawn.
    """

    def __init__(self, drawing: SceneDrawing) -> None:
        self._drawing = drawing
        self._held: list[Any] = []
        self._size = (0, 0)

    def release(self) -> None:
        """Release everything on the graphics card."""
        while self._held:
            self._held.pop().release()
        self._size = (0, 0)

    def draw(self, frame: Frame, target: Any, main: Any) -> None:
        """Blur the picture in `target`. main: the framebuffer that has the figures' depths."""
        focus = frame.scene.focus
        if focus is None:
            return
        drawing, size = self._drawing, frame.size
        self._resize(size)
        drawing.ctx.copy_framebuffer(self._sharp, main)  # for its depths; colours are overwritten
        drawing.ctx.copy_framebuffer(self._colors, target)
        right, up, back = frame.camera.axes
        tall = math.tan(frame.camera.fov / 2)
        walls = frame.theme.walls if frame.scene.ground else None
        low = walls.low if walls is not None else (-ENDLESS, 0.0 if frame.floor else -ENDLESS, -ENDLESS)
        high = walls.high if walls is not None else (ENDLESS, ENDLESS, ENDLESS)
        if frame.theme.picture is not None or frame.scene.picture is not None:
            low = (-ENDLESS, -ENDLESS, -ENDLESS)
        most = min(MOST, BLUR * math.sqrt(FROM / max(focus, 1e-3)))
        shared = {
            "u_color": 0, "u_depth": 1, "u_eye": frame.camera.eye, "u_ahead": -back,
            "u_right": right * (tall * size[0] / size[1]), "u_above_eye": up * tall,
            "u_low": np.array(low, float), "u_high": np.array(high, float),
            "u_ends": (frame.camera.near, frame.camera.far), "u_focus": (focus, SHARP),
        }  # fmt: skip
        self._colors_texture.use(0)
        self._depths.use(1)
        self._pass("focus part", shaders.FOCUS_PART, self._first, shared)
        radius = max(1.0, most * size[1] / 2)  # in pixels of half the picture
        for source, to, way in (
            (self._first_texture, self._second, (radius / self._half[0], 0.0)),
            (self._second_texture, self._first, (0.0, radius / self._half[1])),
        ):
            source.use(0)
            self._pass("focus blur", shaders.FOCUS_BLUR, to, {"u_color": 0, "u_way": way})
        self._colors_texture.use(0)
        self._first_texture.use(2)
        pixels = max(1.0, most * size[1])
        self._pass("focus", shaders.FOCUS, target, {**shared, "u_blurred": 2, "u_pixels": pixels}, size)

    def _pass(
        self, key: str, source: str, to: Any, values: dict[str, Any], size: tuple[int, int] | None = None
    ) -> None:
        self._drawing.state(to, (0, 0, *(size or self._half)), moderngl.NOTHING)
        program = self._drawing.program(key, shaders.COVER, source)
        set_uniforms(program, **values)
        self._drawing.bare(key, program).render(moderngl.TRIANGLES, 3)

    def _resize(self, size: tuple[int, int]) -> None:
        if self._size == size:
            return
        self.release()
        ctx = self._drawing.ctx
        self._half = (max(1, (size[0] + 1) // 2), max(1, (size[1] + 1) // 2))
        self._colors_texture, self._depths = ctx.texture(size, 4), ctx.depth_texture(size)
        self._depths.compare_func = ""
        self._depths.filter = moderngl.NEAREST, moderngl.NEAREST
        spare = ctx.renderbuffer(size, 4)
        self._first_texture, self._second_texture = (ctx.texture(self._half, 4, dtype="f2") for _ in range(2))
        for texture in (self._colors_texture, self._depths, self._first_texture, self._second_texture):
            texture.repeat_x = texture.repeat_y = False
        self._sharp = ctx.framebuffer([spare], self._depths)
        self._colors = ctx.framebuffer([self._colors_texture])
        self._first, self._second = (
            ctx.framebuffer([self._first_texture]),
            ctx.framebuffer([self._second_texture]),
        )
        self._held = [
            self._colors_texture, self._depths, spare, self._first_texture, self._second_texture,
            self._sharp, self._colors, self._first, self._second,
        ]  # fmt: skip
        self._size = size
