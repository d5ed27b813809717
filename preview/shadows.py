"""Shadows: of figures on themselves and on each other, by what the lamp sees; and on the ground."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import moderngl
import numpy as np
from numpy.typing import NDArray

from preview import shaders
from preview.drawing import Drawing, set_uniforms
from preview.frame import Frame
from preview.scene import Actor

Array = NDArray[Any]

SHADOW_SIZE = 1024, 320  # texels, on a graphics card and in software
SOFT_SIZE = 128, 56  # texels of the ground's shadow, along the light and across
SHADOW_LIMIT = 8  # instances; a crowd has only the soft spots under it
Strip = tuple[tuple[float, ...], tuple[float, float]]  # a patch of the ground and its turn


class Shadows:
    """Belongs to a drawing; views of one scene share what the lamp saw."""

    def __init__(self, drawing: Drawing, software: bool) -> None:
        self._drawing, ctx = drawing, drawing.ctx
        self._size = SHADOW_SIZE[software]
        self.map = ctx.depth_texture((self._size, self._size))
        self.map.compare_func = "<="
        self._map_fbo = ctx.framebuffer(depth_attachment=self.map)
        self._soft = ctx.texture(SOFT_SIZE, 1)
        self._soft_fbo = ctx.framebuffer([self._soft])
        for texture in (self.map, self._soft):
            texture.repeat_x = texture.repeat_y = False
        self._lit: tuple[list[Actor], tuple[float, ...], Array] | None = None  # actors, lamp, matrix
        self._strip: Strip | None = None  # where their shadow lies on the ground, once it is drawn

    def release(self) -> None:
        """Give everything back."""
        held: Any
        for held in (self._map_fbo, self.map, self._soft_fbo, self._soft):
            held.release()

    def cast(self, frame: Frame) -> Array:
        """Draw depth as the lamp sees it, if it sees another; return the matrix from the world to the shadow
        map, 0..1.
        """
        before = self._lit
        if before is not None and before[1] == frame.theme.toward and _alike(before[0], frame.actors):
            return before[2]
        low, high = frame.bounds
        centre, radius = (low + high) / 2, max(0.05, float(np.linalg.norm(high - low)) / 2)
        to_light = frame.theme.to_light
        side = np.cross([0.0, 1, 0], to_light)
        side /= np.linalg.norm(side)
        axes = np.stack([side, np.cross(to_light, side), -to_light])
        matrix = np.eye(4)
        matrix[:3, :3] = axes / radius
        matrix[:3, 3] = -axes @ centre / radius
        self._drawing.state(
            self._map_fbo,
            (0, 0, self._size, self._size),
            moderngl.DEPTH_TEST,
            colors=False,
        )
        self._map_fbo.clear(depth=1.0)
        depths(self._drawing, frame, frame.which(solid=True), matrix, coarse=True)
        half = np.eye(4) * 0.5
        half[:3, 3], half[3, 3] = 0.5, 1
        self._strip = None
        self._lit = frame.actors, frame.theme.toward, np.asarray(half @ matrix)
        return self._lit[2]

    def on_ground(self, frame: Frame, target: Any, ground_to: int, solid: Sequence[Actor]) -> None:
        """What darkens the ground multiplies what is there. ground_to: the row, from below, it ends at."""
        strip = self._softened(frame) if frame.light is not None else None
        self._drawing.state(target, (0, 0, *frame.size), moderngl.BLEND)
        target.scissor = (0, 0, frame.size[0], ground_to)
        self._drawing.ctx.blend_func = moderngl.ZERO, moderngl.SRC_COLOR
        if strip is not None:
            patch, turn = strip
            program = self._drawing.program("cast", shaders.GROUND_VERTEX, shaders.CAST)
            self._soft.use(4)
            set_uniforms(program, u_matrix=frame.matrix, u_patch=patch, u_turn=turn)
            set_uniforms(program, u_dark=frame.theme.shadow, u_soft=4)
            self._drawing.bare("cast", program).render(moderngl.TRIANGLE_STRIP, 4)
        program = self._drawing.program("spots", shaders.SPOT_VERTEX, shaders.SPOT)
        set_uniforms(program, u_matrix=frame.matrix, u_dark=frame.theme.shadow)
        self._drawing.squares("spots", program, np.concatenate([_spots(a) for a in solid]), "4f/i", "in_spot")
        target.scissor = None

    def _softened(self, frame: Frame) -> Strip:
        """Draw the shadow on the ground as seen from above; return where on it that lies: a patch, its turn.
        Only a strip along the light can be dark.
        """
        assert frame.light is not None
        if self._strip is not None:
            return self._strip
        low, high = frame.bounds
        to_light = frame.theme.to_light
        thrown = -to_light / to_light[1] * max(0.0, float(high[1]))
        fade_low, fade_high = np.minimum(low, low + thrown), np.maximum(high, high + thrown)
        middle, half = (fade_low + fade_high) / 2, (fade_high - fade_low) / 2 * 1.05
        along = to_light[[0, 2]] / np.linalg.norm(to_light[[0, 2]])
        axes = np.stack([along, [-along[1], along[0]]])
        feet = np.array([(x, z) for x in (low[0], high[0]) for z in (low[2], high[2])])
        strip = np.concatenate([feet, feet + thrown[[0, 2]]]) @ axes.T
        least, most = strip.min(0) - 0.05 * half.max(), strip.max(0) + 0.05 * half.max()
        x, z = (least + most) / 2 @ axes
        patch, turn = (x, z, *((most - least) / 2)), (float(along[0]), float(along[1]))
        self._drawing.state(self._soft_fbo, (0, 0, *SOFT_SIZE), moderngl.NOTHING)
        program = self._drawing.program("soft", shaders.COVER, shaders.SOFT)
        self.map.compare_func = ""
        self.map.use(1)
        set_uniforms(program, u_depth=1, u_light=frame.light, u_patch=patch, u_turn=turn)
        set_uniforms(program, u_fade=(middle[0], middle[2], max(half[0], half[2])))
        set_uniforms(program, u_scale=float(np.linalg.norm(frame.light[0, :3])))
        self._drawing.bare("soft", program).render(moderngl.TRIANGLES, 3)
        self.map.compare_func = "<="
        self._strip = patch, turn
        return patch, turn


def depths(drawing: Drawing, frame: Frame, which: Sequence[int], matrix: Array, coarse: bool) -> None:
    """Draw nothing but depth, as seen through `matrix`. coarse: with coarse meshes instead of the frame's."""
    program = drawing.program("depth", shaders.DEPTH_VERTEX, shaders.DEPTH)
    set_uniforms(program, u_matrix=matrix, u_palette=0)
    drawing.store.palette.use(0)
    for i in which:
        set_uniforms(program, u_row=frame.rows[i])
        drawing.triangles(
            frame.actors[i].figure.coarse if coarse else frame.meshes[i],
            frame.actors[i],
            program,
            "depth",
        )


def _alike(before: Sequence[Actor], now: Sequence[Actor]) -> bool:
    """Whether they are the very same actors."""
    return len(before) == len(now) and all(a is b for a, b in zip(before, now, strict=True))


def _spots(actor: Actor) -> Array:
    """Where a body darkens the ground `[S, 4]`: x, z, radius, strength; wider and weaker with height."""
    ends, starts = actor.figure.shadow
    p = np.asarray(actor.positions, float).reshape(-1, len(actor.figure.skeleton), 3)
    h = actor.figure.height
    if not len(ends):
        ends = starts = np.flatnonzero(actor.figure.drawn)[:1]
    middle = (p[:, ends] + p[:, starts]) / 2
    length = np.linalg.norm(p[:, ends] - p[:, starts], axis=-1)
    up = np.maximum(middle[..., 1], 0) / h
    radius = 0.55 * length + 0.05 * h + 0.30 * up * h
    strength = 0.60 * np.exp(-5.0 * up) * np.clip(length / (0.12 * h), 0.25, 1.0)
    out = np.stack([middle[..., 0], middle[..., 2], radius, strength], -1).reshape(-1, 4)
    return np.asarray(out[out[:, 3] > 0.01])
