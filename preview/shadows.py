"""Draw shadows: of figures on themselves and on each other, by the depth that the lamp sees; and on the
ground.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import moderngl
import numpy as np
from numpy.typing import NDArray

from preview import shaders
from preview.drawing import SceneDrawing, set_uniforms
from preview.frame import Frame
from preview.mesh import SkinnedMesh
from preview.scene import Actor

Array = NDArray[Any]

# Texels of the maps on a graphics card and in software: first the size of the map of everything and of the
# map of the near part; then of the map of everything for small pictures and for the ground.
SHADOW_SIZE = (1024, 1024), (416, 208)
# How many pixels of the picture a texel of a map of everything may cover: of the small map; before the part
# in the picture gets a map of its own.
SMALL, NEAR = 2.0, 3.0
# Texels from the middle to the two places that are read from the map, on a graphics card and in software.
TAPS = (1.6, 0.9), (0.8, 0.45)
# How far before a surface its shadow is looked up: metres on a graphics card and in software, and texels. In
# software both the surface and its caster may be off more.
OFF_LEAST, OFF_TEXELS = (0.010, 0.013), 1.6
CAST_OFF = 0.004  # of the height; how far the surface that throws a shadow may be off
STEPS = 8  # sizes of the near map for each doubling; without steps its texels would creep over a moving body
SOFT_SIZE = 128, 56  # texels of the ground's shadow, along the light and across
SHADOW_LIMIT = 8  # instances; a crowd has only the soft spots under it
FAINT = 0.02  # strength; weaker spots on the ground are not drawn
_HALF = np.array([[0.5, 0, 0, 0.5], [0, 0.5, 0, 0.5], [0, 0, 0.5, 0.5], [0, 0, 0, 1]])  # -1..1 to 0..1
Strip = tuple[
    tuple[float, ...], tuple[float, float], tuple[float, ...]
]  # a patch of the ground, its turn, fading


class _Map:
    """Depth as the lamp sees it, `size` texels along each side."""

    def __init__(self, ctx: moderngl.Context, size: int) -> None:
        self.size = size
        self.seen: tuple[list[Actor], tuple[float, ...], Array] | None = None  # actors, lamp, matrix
        self.depth = ctx.depth_texture((size, size))
        self.depth.compare_func = "<="
        self.depth.repeat_x = self.depth.repeat_y = False
        self.target = ctx.framebuffer(depth_attachment=self.depth)

    def release(self) -> None:
        self.target.release()
        self.depth.release()


class Shadows:
    """The shadows of a drawing. Views of one scene share the depth that the lamp sees of all of it."""

    def __init__(self, drawing: SceneDrawing, software: bool) -> None:
        self._drawing, self._taps, ctx = drawing, TAPS[software], drawing.ctx
        self._off_least = OFF_LEAST[software]
        size, small = SHADOW_SIZE[software]
        self._whole, self._near, self._low = _Map(ctx, size), _Map(ctx, size), _Map(ctx, small)
        self._used = self._whole
        self._soft = ctx.texture(SOFT_SIZE, 1)
        self._soft_fbo = ctx.framebuffer([self._soft])
        self._soft.repeat_x = self._soft.repeat_y = False
        self._softened: tuple[list[Actor], tuple[float, ...]] | None = None  # whose shadow is on the ground

    def release(self) -> None:
        """Release everything on the graphics card."""
        for held in (self._whole, self._near, self._low, self._soft_fbo, self._soft):
            held.release()

    @property
    def map(self) -> moderngl.Texture:
        """The texture that figures are shaded by: depth as the lamp sees it."""
        return self._used.depth

    @property
    def spread(self) -> tuple[float, float]:
        """How far apart its texels are read, as a share of its size."""
        return self._taps[0] / self._used.size, self._taps[1] / self._used.size

    def off(self, light: Array) -> float:
        """Return how far before a surface its shadow is looked up, in metres, so that a texel of the map does
        not shade the slope it covers. `light` is the result of `cast`.
        """
        texel = 1 / (float(np.linalg.norm(light[:2, :3], axis=1).min()) * self._used.size)
        return max(self._off_least, OFF_TEXELS * texel)

    def cast(self, frame: Frame) -> Array:
        """Draw depth as the lamp sees it, if that has changed. Return the matrix from the world to the shadow
        map, 0..1.

        If the camera is near, the part in the picture has a map of its own.
        """
        axes, (centre, radius) = frame.theme.lamp, _lit(frame)
        pixels, low, high = find_seen_window(frame, axes)
        if pixels * 2 * radius < NEAR * self._whole.size:
            small = pixels * 2 * radius < SMALL * self._low.size
            self._used = self._low if small else self._whole
            return self._of_all(frame, self._used)
        self._used = self._near
        middle, half = (low + high) / 2, (high - low) / 2
        matrix = np.eye(4)
        matrix[:3, :3] = axes / [[half[0]], [half[1]], [radius]]
        matrix[:3, 3] = -np.array([*(middle / half), axes[2] @ centre / radius])
        return self._drawn(frame, self._near, matrix)

    def _of_all(self, frame: Frame, into: _Map) -> Array:
        before = into.seen
        if before is not None and before[1] == frame.theme.toward and _alike(before[0], frame.actors):
            return before[2]
        axes, (centre, radius) = frame.theme.lamp, _lit(frame)
        matrix = np.eye(4)
        matrix[:3, :3] = axes / radius
        matrix[:3, 3] = -axes @ centre / radius
        into.seen = frame.actors, frame.theme.toward, self._drawn(frame, into, matrix)
        return into.seen[2]

    def _drawn(self, frame: Frame, into: _Map, matrix: Array) -> Array:
        self._drawing.state(into.target, (0, 0, into.size, into.size), moderngl.DEPTH_TEST, colors=False)
        into.target.clear(depth=1.0)
        draw_depths(self._drawing, frame, frame.which(solid=True), matrix, frame.casters)
        return np.asarray(_HALF @ matrix)

    def on_ground(self, frame: Frame, target: Any, ground_to: int, solid: Sequence[Actor]) -> None:
        """Multiply the ground by its shadows and spots. `ground_to` is the row, counted from below, at which
        the ground ends.
        """
        strip = _strip(frame) if frame.light is not None else None
        if strip is not None:
            self._soften(frame, strip)
        self._drawing.state(target, (0, 0, *frame.size), moderngl.BLEND)
        target.scissor = (0, 0, frame.size[0], ground_to)
        self._drawing.ctx.blend_func = moderngl.ZERO, moderngl.SRC_COLOR
        if strip is not None:
            patch, turn, _ = strip
            program = self._drawing.program("cast", shaders.GROUND_VERTEX, shaders.CAST)
            self._soft.use(4)
            set_uniforms(program, u_matrix=frame.matrix, u_patch=patch, u_turn=turn)
            set_uniforms(program, u_dark=frame.theme.shadow, u_soft=4)
            self._drawing.bare("cast", program).render(moderngl.TRIANGLE_STRIP, 4)
        program = self._drawing.program("spots", shaders.SPOT_VERTEX, shaders.SPOT)
        dark = frame.theme.shadow
        set_uniforms(program, u_matrix=frame.matrix, u_dark=dark, u_most=max(1e-3, 1 - min(dark)))
        self._drawing.squares("spots", program, np.concatenate([_spots(a) for a in solid]), "4f/i", "in_spot")
        target.scissor = None

    def _soften(self, frame: Frame, strip: Strip) -> None:
        """Draw the shadow on a strip of the ground as seen from above."""
        toward, before = frame.theme.toward, self._softened
        if before is not None and before[1] == toward and _alike(before[0], frame.actors):
            return
        self._softened = frame.actors, toward
        into = self._whole if self._used is self._whole else self._low
        light = self._of_all(frame, into)
        patch, turn, fade = strip
        self._drawing.state(self._soft_fbo, (0, 0, *SOFT_SIZE), moderngl.NOTHING)
        program = self._drawing.program("soft", shaders.COVER, shaders.SOFT)
        depth = into.depth
        depth.compare_func = ""
        depth.use(1)
        set_uniforms(program, u_depth=1, u_light=light, u_patch=patch, u_turn=turn, u_fade=fade)
        set_uniforms(program, u_scale=math.hypot(*light[0, :3]))
        self._drawing.bare("soft", program).render(moderngl.TRIANGLES, 3)
        depth.compare_func = "<="


def _strip(frame: Frame) -> Strip | None:
    """Return where on the ground the shadow can be, None if that is outside the picture. Only a strip along
    the light can be dark.
    """
    (low_x, low_y, low_z), (high_x, high_y, high_z) = (x.tolist() for x in frame.bounds)
    x, y, z = frame.theme.to_light.tolist()
    reach = max(0.0, high_y) / y
    fade_x = min(low_x, low_x - x * reach), max(high_x, high_x - x * reach)
    fade_z = min(low_z, low_z - z * reach), max(high_z, high_z - z * reach)
    tall = max(high_y, high_y - y * reach) - min(low_y, low_y - y * reach)
    half = 1.05 / 2 * max(fade_x[1] - fade_x[0], tall, fade_z[1] - fade_z[0])
    flat = math.hypot(x, z)
    x, z = x / flat, z / flat  # along the light; across it is -z, x
    feet = [(u, v) for u in (low_x, high_x) for v in (low_z, high_z)]
    along, across = [u * x + v * z for u, v in feet], [v * x - u * z for u, v in feet]
    pad = 0.05 * half
    least, most = (min(along) - flat * reach - pad, min(across) - pad), (max(along) + pad, max(across) + pad)
    m = frame.matrix.tolist()
    seen = []
    for a, b in ((a, b) for a in (least[0], most[0]) for b in (least[1], most[1])):
        u, v = a * x - b * z, a * z + b * x
        seen.append([m[k][0] * u + m[k][2] * v + m[k][3] for k in (0, 1, 3)])
    if any(all(s * c[k] > c[2] for c in seen) for s in (1, -1) for k in (0, 1)):
        return None
    a, b = (least[0] + most[0]) / 2, (least[1] + most[1]) / 2
    patch = (a * x - b * z, a * z + b * x, (most[0] - least[0]) / 2, (most[1] - least[1]) / 2)
    wide = 1.05 / 2 * max(fade_x[1] - fade_x[0], fade_z[1] - fade_z[0])
    return patch, (x, z), ((fade_x[0] + fade_x[1]) / 2, (fade_z[0] + fade_z[1]) / 2, wide)


def list_shadow_casters(actors: Sequence[Actor]) -> list[SkinnedMesh]:
    """Return the mesh that throws each actor's shadow."""
    return [a.figure.finest(CAST_OFF * a.figure.height) for a in actors]


def draw_depths(
    drawing: SceneDrawing, frame: Frame, which: Sequence[int], matrix: Array, meshes: Sequence[SkinnedMesh]
) -> None:
    """Draw only depth, as seen through `matrix`. `meshes` holds one for each actor of the frame."""
    program = drawing.program("depth", shaders.DEPTH_VERTEX, shaders.DEPTH)
    set_uniforms(program, u_matrix=matrix, u_palette=0)
    drawing.store.palette.use(0)
    for i in which:
        set_uniforms(program, u_row=frame.rows[i])
        drawing.triangles(meshes[i], frame.actors[i], program, "depth")


def _lit(frame: Frame) -> tuple[Array, float]:
    """Return the middle `[3]` and the radius of what the lamp lights."""
    low, high = frame.bounds
    return (low + high) / 2, max(0.05, math.dist(low, high) / 2)


def find_seen_window(frame: Frame, axes: Array) -> tuple[float, Array, Array]:
    """Return how many pixels a metre has at the nearest point in the picture, and the part of the lamp's
    picture, `[2]` and `[2]` in metres, that shades what is seen. The number of pixels is 0 if nothing is
    seen.
    """
    camera, (width, height) = frame.camera, frame.size
    ends = frame.ends
    if np.isnan(ends).any():
        seen = camera.project(frame.boxes, width / height)
        behind = np.asarray(np.isnan(seen).any(2))  # the eye
        low, high = (np.where(behind[..., None], fill, seen) for fill in (np.inf, -np.inf))
        inside = (low.min(1) < 1).all(1) & (high.max(1) > 0).all(1)
        inside |= behind.any(1) & ~behind.all(1)
    else:
        inside = (ends[:2] < 1).all(0) & (ends[2:] > 0).all(0)
    if not inside.any():
        return 0.0, np.zeros(2), np.ones(2)
    back = camera.axes[2]
    # Along the lamp's right and up, and away from the eye.
    corners = (frame.boxes if inside.all() else frame.boxes[inside]).reshape(-1, 3)
    placed = np.einsum("ij,nj->in", np.stack([axes[0], axes[1], -back]), corners)
    least, most = placed.min(1), placed.max(1)
    near, far = (max(float(camera.eye @ back + x), camera.near) for x in (least[2], most[2]))
    tall = height / (2 * math.tan(camera.fov / 2))  # pixels of a metre, a metre away
    # Not more of the boxes than is in the picture, from the nearest to the farthest of them.
    sides = np.array([[x * width, y * height] for x in (-1, 1) for y in (-1, 1)]) / (2 * tall)
    rays = (sides @ camera.axes[:2] - back) @ axes[:2].T
    view = camera.eye @ axes[:2].T + np.concatenate([near * rays, far * rays])
    low, high = np.maximum(least[:2], view.min(0)), np.minimum(most[:2], view.max(0))
    half = np.array(
        [2 ** (math.ceil(math.log2(max(x, 1e-3) * 1.04) * STEPS) / STEPS) for x in (high - low) / 2]
    )
    texel = half / 128
    middle = np.round((low + high) / 2 / texel) * texel
    return tall / near, middle - half, middle + half


def _alike(before: Sequence[Actor], now: Sequence[Actor]) -> bool:
    """Return whether both hold the same actor objects."""
    return len(before) == len(now) and all(a is b for a, b in zip(before, now, strict=True))


def _spots(actor: Actor) -> Array:
    """Return where a body darkens the ground `[S, 4]`: x, z, radius, strength. Spots are wider and weaker the
    higher the body part is.
    """
    ends, starts = actor.figure.shadow
    p = np.asarray(actor.positions, float).reshape(-1, len(actor.figure.skeleton), 3)
    h = actor.figure.height
    if not len(ends):
        ends = starts = np.flatnonzero(actor.figure.drawn)[:1]
    a, b = p[:, ends], p[:, starts]
    middle = (a + b) / 2
    length = np.sqrt(((a - b) ** 2).sum(-1))
    up = np.maximum(middle[..., 1], 0) / h
    radius = 0.55 * length + 0.05 * h + 0.30 * up * h
    strength = 0.60 * np.exp(-5.0 * up) * np.clip(length / (0.12 * h), 0.25, 1.0)
    out = np.stack([middle[..., 0], middle[..., 2], radius, strength], -1).reshape(-1, 4)
    return np.asarray(out[out[:, 3] > FAINT])
