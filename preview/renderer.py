"""Draws scenes with OpenGL 3.3: the same pictures in a window and without one, on a graphics card and in
software.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import moderngl
import numpy as np
from numpy.typing import NDArray

from preview import shaders
from preview.camera import Camera
from preview.gpu import Store
from preview.mesh import Mesh
from preview.scene import DARK, Actor, Scene, Theme

Array = NDArray[Any]

SHADOW_SIZE = 1024, 320  # texels, on a graphics card and in software
SOFT_SIZE = 128, 56  # texels of the ground's shadow, along the light and across
SHADOW_LIMIT = 8  # instances; a crowd has only the soft spots under it
GHOST_BACK = (2.0, 1500.0)  # by slope, and in steps of the depth; about a centimetre where a figure stands
CONTACT, CONTACT_HIGH = 0.75, 0.16  # how much darker a sole is, and of the height, up to where
SHADE = 0.8  # how dark the figure's shadow on itself is
COARSE_BELOW, COARSE_CROWD_BELOW = (
    90,
    240,
)  # pixels of height under which figures are drawn with their coarse mesh
BESIDE_BELOW = 640  # likewise in software, of a ghost, and in a view beside another
Strip = tuple[tuple[float, ...], tuple[float, float]]  # a patch of the ground and its turn
_SOFTWARE = ("llvmpipe", "softpipe", "swiftshader", "software", "basic render")


def is_software(ctx: moderngl.Context) -> bool:
    """Whether the context draws with the processor: multisampling is then too slow and edges are smoothed
    afterwards.
    """
    return any(word in str(ctx.info.get("GL_RENDERER", "")).lower() for word in _SOFTWARE)


@dataclass(frozen=True, eq=False)
class _Frame:
    """What the passes of one picture share. rows: each actor's first row in the palette. light: world to
    shadow map.
    """

    scene: Scene
    actors: list[Actor]
    rows: list[int]
    camera: Camera
    size: tuple[int, int]
    theme: Theme
    matrix: Array
    bounds: tuple[Array, Array]
    meshes: list[Mesh]
    light: Array | None = None

    @property
    def floor(self) -> bool:
        """Whether the ground is seen, from above."""
        scene = self.scene
        plain = scene.background is None and scene.picture is None
        return scene.ground and plain and float(self.camera.eye[1]) > 0

    def which(self, solid: bool) -> list[int]:
        return [i for i, actor in enumerate(self.actors) if (actor.opacity >= 1) == solid]


class _Kept:
    """What lies on the graphics card for all renderers of one context, and whom the lamp saw last."""

    def __init__(self, ctx: moderngl.Context, software: bool) -> None:
        self.store = Store(ctx)
        self.programs: dict[str, moderngl.Program] = {}
        self.plain: dict[str, moderngl.VertexArray] = {}
        self.buffers: dict[str, moderngl.Buffer] = {}
        self.shadow_size = SHADOW_SIZE[software]
        self.shadow_map = ctx.depth_texture((self.shadow_size, self.shadow_size))
        self.shadow_map.compare_func = "<="
        self.shadow_fbo = ctx.framebuffer(depth_attachment=self.shadow_map)
        self.soft = ctx.texture(SOFT_SIZE, 1)
        self.soft_fbo = ctx.framebuffer([self.soft])
        for texture in (self.shadow_map, self.soft):
            texture.repeat_x = texture.repeat_y = False
        self.lit: tuple[list[Actor], tuple[float, ...], Array] | None = None  # actors, lamp, matrix
        self.picture: moderngl.Texture | None = None  # behind, and what it shows
        self.pictured: Array | None = None
        self.strip: Strip | None = None  # where their shadow lies on the ground, once it is drawn

    def release(self) -> None:
        self.store.release()
        held: Any
        for held in (
            *self.plain.values(),
            *self.programs.values(),
            *self.buffers.values(),
            *(self.shadow_fbo, self.shadow_map, self.soft_fbo, self.soft),
        ):
            held.release()
        if self.picture is not None:
            self.picture.release()
        for gone in (self.plain, self.programs, self.buffers):
            gone.clear()


class Renderer:
    """Belongs to one context. `samples` None chooses: 4 on a graphics card, 0 in software (edges are smoothed
    instead). beside: another of the same context, which draws the same scenes from elsewhere: what both need
    is made once. It has to live longer.
    """

    def __init__(
        self, ctx: moderngl.Context, samples: int | None = None, beside: Renderer | None = None
    ) -> None:
        self.ctx = ctx
        self.software = is_software(ctx)
        self.samples = min((0 if self.software else 4) if samples is None else samples, int(ctx.max_samples))
        self._beside = beside
        self._common: _Kept = _Kept(ctx, self.software) if beside is None else beside._common
        self.store = self._common.store
        self._size = (0, 0)
        self._targets: list[Any] = []
        self._seen: tuple[Camera, tuple[int, int], Theme, bool] | None = (
            None  # how ground and sky were drawn last
        )
        self._kept, self._sky_from = False, 0  # whether they are kept, and the row the sky begins at
        self._resize(1, 1)

    def release(self) -> None:
        """Give everything on the graphics card back; the context must be current."""
        for held in reversed(self._targets):
            held.release()
        self._targets.clear()
        if self._beside is None:
            self._common.release()

    def draw(
        self,
        scene: Scene,
        camera: Camera,
        size: tuple[int, int],
        target: moderngl.Framebuffer,
        theme: Theme = DARK,
    ) -> None:
        """Draw into `target`'s lower left `size` (width, height, pixels). Sets all state it needs; keeps none
        of the caller's.

        Actors whose transforms hold something that is not a number are left out.
        """
        width, height = max(1, int(size[0])), max(1, int(size[1]))
        actors = [a for a in scene.actors if _drawable(a)]
        self._resize(width, height)
        solid = [a for a in actors if a.opacity >= 1]
        cast = scene.shadow and 0 < sum(a.count for a in solid) <= SHADOW_LIMIT
        small = COARSE_BELOW if sum(a.count for a in actors) <= SHADOW_LIMIT else COARSE_CROWD_BELOW
        beside = BESIDE_BELOW if self.software else small

        def mesh(a: Actor) -> Mesh:
            second = self._beside is not None or a.opacity < 1  # looked at less closely
            coarse = a.morphs is None and _tall(a, camera, height) < (beside if second else small)
            return a.figure.coarse if coarse else a.figure.mesh

        meshes = [mesh(a) for a in actors]
        rows = self.store.prepare(actors, meshes + ([a.figure.coarse for a in solid] if cast else []))
        matrix = camera.projection(width / height) @ camera.view()
        frame = _Frame(
            scene, actors, rows, camera, (width, height), theme, matrix, Scene(tuple(solid)).bounds(), meshes
        )
        if cast:
            frame = replace(frame, light=self._cast(frame))

        # The ground and the sky need no smoothing and go to the target; figures are drawn apart and laid over
        # them.
        covered = _covered(frame)
        self._state(target, (0, 0, width, height), moderngl.NOTHING)
        if scene.picture is not None:
            target.clear(*(scene.background or (*theme.top, 1.0)), viewport=(0, 0, width, height))
            self._behind(scene.picture, (width, height))
        elif scene.background is not None:
            target.clear(*scene.background, viewport=(0, 0, width, height))
        else:
            self._backdrop(frame, target, [a for a in solid if scene.shadow])
        if covered[2] and covered[3]:
            self._state(self._main, (0, 0, width, height), moderngl.DEPTH_TEST)
            self._main.clear(0.0, 0.0, 0.0, 0.0, depth=1.0)
            self._bodies(frame, frame.which(solid=True))
            self._ghosts(frame)
            self._compose(frame, target, covered)
        self._overlay(frame)

    # --- passes

    def _cast(self, frame: _Frame) -> Array:
        """Draw depth as the lamp sees it, if it sees another; return the matrix from the world to the shadow
        map, 0..1.
        """
        before = self._common.lit
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
        self._state(
            self._common.shadow_fbo,
            (0, 0, self._common.shadow_size, self._common.shadow_size),
            moderngl.DEPTH_TEST,
        )
        self._common.shadow_fbo.clear(depth=1.0)
        self._depths(frame, frame.which(solid=True), matrix, coarse=True)
        half = np.eye(4) * 0.5
        half[:3, 3], half[3, 3] = 0.5, 1
        self._common.strip = None
        self._common.lit = frame.actors, frame.theme.toward, np.asarray(half @ matrix)
        return self._common.lit[2]

    def _depths(self, frame: _Frame, which: Sequence[int], matrix: Array, coarse: bool) -> None:
        program = self._program("depth", shaders.DEPTH_VERTEX, shaders.DEPTH)
        _set(program, u_matrix=matrix, u_palette=0)
        self.store.palette.use(0)
        for i in which:
            _set(program, u_row=frame.rows[i])
            self._triangles(
                frame.actors[i].figure.coarse if coarse else frame.meshes[i],
                frame.actors[i],
                program,
                "depth",
            )

    def _bodies(self, frame: _Frame, which: Sequence[int]) -> None:
        theme = frame.theme
        self.store.palette.use(0)
        self._common.shadow_map.use(1)
        self.store.marks.use(3)
        for i in which:
            actor = frame.actors[i]
            cast = frame.light is not None and actor.opacity >= 1
            for kind in ("plain", "textured"):
                if not any((b.image is not None) == (kind == "textured") for b in frame.meshes[i].batches):
                    continue
                sunk = frame.floor and float(np.min(actor.positions[..., 1])) < 0
                flags = (
                    ("TEXTURED", kind == "textured"),
                    ("MARKED", bool(actor.marks)),
                    ("SHADOWED", cast),
                    ("SUNK", sunk),
                )
                words = [w for w, on in flags if on]
                head = "#version 330 core\n" + "".join(f"#define {w}\n" for w in words)
                program = self._program(
                    "body " + " ".join(words), head + shaders.BODY_VERTEX, head + shaders.BODY
                )
                _set(
                    program,
                    u_matrix=frame.matrix,
                    u_eye=frame.camera.eye,
                    u_to_light=theme.to_light,
                    u_opacity=actor.opacity,
                )
                _set(
                    program, u_palette=0, u_shadow=1, u_image=2, u_marks=3, u_marks_row=i, u_row=frame.rows[i]
                )
                _set(
                    program,
                    u_key=theme.key,
                    u_above=theme.above,
                    u_below=theme.below,
                    u_rim=theme.rim,
                    u_shade=SHADE,
                )
                if frame.light is not None:
                    _set(program, u_light=frame.light)
                contact = CONTACT if frame.floor and cast else 0.0
                _set(program, u_near_ground=(contact, 1 / (CONTACT_HIGH * actor.figure.height)))
                self._triangles(frame.meshes[i], actor, program, kind)

    def _ghosts(self, frame: _Frame) -> None:
        """Depth first, so that a ghost shows its nearest surface only, then colour."""
        which = frame.which(solid=False)
        if not which:
            return
        # What lies in one place with the figure is the figure's: a ghost is reckoned a little farther away.
        self.ctx.polygon_offset = GHOST_BACK
        self._main.color_mask = (False, False, False, False)
        self._main.use()  # a mask counts from the next use
        self._depths(frame, which, frame.matrix, coarse=False)
        self._main.color_mask = (True, True, True, True)
        self._main.use()
        self.ctx.blend_func = moderngl.ONE, moderngl.ONE_MINUS_SRC_ALPHA
        self._bodies(frame, which)
        self.ctx.polygon_offset = 0.0, 0.0

    def _backdrop(self, frame: _Frame, target: Any, casters: Sequence[Actor]) -> None:
        """Ground with its shadows up to its far edge, sky above. While the camera stands they are kept: from
        the second picture on only the shadows are drawn anew.
        """
        key = frame.camera, frame.size, frame.theme, frame.scene.ground
        if key != self._seen:
            self._seen, self._kept = key, False
            sky_from = self._empty_stage(frame, target)
        else:
            if not self._kept:
                self._state(self._stage, (0, 0, *frame.size), moderngl.NOTHING)
                self._sky_from = self._empty_stage(frame, self._stage)
                self._kept = True
                self._state(target, (0, 0, *frame.size), moderngl.NOTHING)
            sky_from = self._sky_from
            self.ctx.copy_framebuffer(target, self._stage)
            target.use()
        if sky_from > 0 and casters:
            self._shadows(frame, target, sky_from, casters)
            target.scissor = None

    def _behind(self, picture: Array, size: tuple[int, int]) -> None:
        """Draw a picture as large as it fits."""
        common, (high, wide) = self._common, picture.shape[:2]
        if common.picture is None or common.picture.size != (wide, high):
            if common.picture is not None:
                common.picture.release()
            common.picture, common.pictured = self.ctx.texture((wide, high), 3, alignment=1), None
            common.picture.repeat_x = common.picture.repeat_y = False
        if common.pictured is not picture:
            common.picture.write(np.ascontiguousarray(picture, np.uint8), alignment=1)
            common.pictured = picture
        scale = min(size[0] / wide, size[1] / high)
        part = (wide * scale / size[0], high * scale / size[1])
        common.picture.use(5)
        program = self._program("behind", shaders.COVER, shaders.BEHIND)
        _set(program, u_picture=5, u_part=part)
        self._bare("behind", program).render(moderngl.TRIANGLES, 3)

    def _empty_stage(self, frame: _Frame, target: Any) -> int:
        """Draw ground and sky: no point is painted twice. Return the row at which the sky begins."""
        camera, (width, height) = frame.camera, frame.size
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
            self.ctx.enable_only(moderngl.NOTHING)
            target.scissor = (0, sky_from, width, height - sky_from)
            self._sky("sky", self._program("sky", shaders.COVER, shaders.SKY), frame, moderngl.TRIANGLES, 3)
            target.scissor = None
        return sky_from

    def _ground(
        self, frame: _Frame, patch: tuple[float, ...], turn: tuple[float, float], reach: float
    ) -> None:
        theme, distance = frame.theme, frame.camera.distance
        spacing = 0.5 if distance < 14 else 1.0 if distance < 40 else 5.0
        program = self._program("ground", shaders.GROUND_VERTEX, shaders.GROUND)
        _set(program, u_matrix=frame.matrix, u_patch=patch, u_turn=turn, u_reach=reach)
        _set(program, u_floor=theme.floor, u_line=theme.line, u_spacing=(spacing, theme.line_strength))
        self._sky("ground", program, frame, moderngl.TRIANGLE_STRIP, 4)

    def _shadows(self, frame: _Frame, target: Any, sky_from: int, solid: Sequence[Actor]) -> None:
        """What darkens the ground multiplies what is there."""
        strip = self._softened(frame) if frame.light is not None else None
        self._state(target, (0, 0, *frame.size), moderngl.BLEND)
        target.scissor = (0, 0, frame.size[0], sky_from)
        self.ctx.blend_func = moderngl.ZERO, moderngl.SRC_COLOR
        if strip is not None:
            patch, turn = strip
            program = self._program("cast", shaders.GROUND_VERTEX, shaders.CAST)
            self._common.soft.use(4)
            _set(program, u_matrix=frame.matrix, u_patch=patch, u_turn=turn)
            _set(program, u_dark=frame.theme.shadow, u_soft=4)
            self._bare("cast", program).render(moderngl.TRIANGLE_STRIP, 4)
        program = self._program("spots", shaders.SPOT_VERTEX, shaders.SPOT)
        _set(program, u_matrix=frame.matrix, u_dark=frame.theme.shadow)
        self._squares("spots", program, np.concatenate([_spots(a) for a in solid]), "4f/i", "in_spot")

    def _softened(self, frame: _Frame) -> Strip:
        """Draw the shadow on the ground as seen from above; return where on it that lies: a patch, its turn.
        Only a strip along the light can be dark.
        """
        assert frame.light is not None
        if self._common.strip is not None:
            return self._common.strip
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
        self._state(self._common.soft_fbo, (0, 0, *SOFT_SIZE), moderngl.NOTHING)
        program = self._program("soft", shaders.COVER, shaders.SOFT)
        self._common.shadow_map.compare_func = ""
        self._common.shadow_map.use(1)
        _set(program, u_depth=1, u_light=frame.light, u_patch=patch, u_turn=turn)
        _set(program, u_fade=(middle[0], middle[2], max(half[0], half[2])))
        _set(program, u_scale=float(np.linalg.norm(frame.light[0, :3])))
        self._bare("soft", program).render(moderngl.TRIANGLES, 3)
        self._common.shadow_map.compare_func = "<="
        self._common.strip = patch, turn
        return patch, turn

    def _sky(self, key: str, program: moderngl.Program, frame: _Frame, mode: int, count: int) -> None:
        """Draw with a program that ends in the sky's colours."""
        _set(
            program,
            u_pixel=(1 / frame.size[0], 1 / frame.size[1]),
            u_top=frame.theme.top,
            u_bottom=frame.theme.bottom,
        )
        self._bare(key, program).render(mode, count)

    def _overlay(self, frame: _Frame) -> None:
        """The skeletons of actors that want it, over everything."""
        segments = []
        for actor in frame.actors:
            if actor.bones and len(actor.figure.lines):
                p = np.asarray(actor.positions).reshape(-1, len(actor.figure.skeleton), 3)
                segments.append(
                    np.concatenate([p[:, actor.figure.line_starts], p[:, actor.figure.lines]], -1).reshape(
                        -1, 6
                    )
                )
        if not segments:
            return
        lines = np.concatenate(segments)
        dots = np.tile(lines[:, 3:], 2)
        self.ctx.enable_only(moderngl.BLEND)
        self.ctx.blend_func = moderngl.ONE, moderngl.ONE_MINUS_SRC_ALPHA
        program = self._program("lines", shaders.LINE_VERTEX, shaders.LINE)
        unit = max(1.0, frame.size[1] / 540)
        for data, width in ((lines, 1.6 * unit), (dots, 4.0 * unit)):
            _set(program, u_matrix=frame.matrix, u_size=frame.size, u_width=width, u_ink=frame.theme.ink)
            self._squares("lines", program, data, "3f 3f/i", "in_start", "in_end")

    def _compose(self, frame: _Frame, target: Any, covered: tuple[int, int, int, int]) -> None:
        """Lay the figures over the target; without multisampling, smooth their edges on the way."""
        if self._resolved is not None:
            self.ctx.copy_framebuffer(self._resolved, self._main)
        self._state(target, (0, 0, *frame.size), moderngl.BLEND)
        self.ctx.blend_func = moderngl.ONE, moderngl.ONE_MINUS_SRC_ALPHA
        self._picture.use(0)
        name, source = ("copy", shaders.COPY) if self.samples else ("smooth", shaders.SMOOTH)
        program = self._program(name, shaders.COVER, source)
        _set(program, u_picture=0, u_pixel=(1 / frame.size[0], 1 / frame.size[1]))
        target.scissor = covered
        self._bare(name, program).render(moderngl.TRIANGLES, 3)
        target.scissor = None

    # --- helpers

    def _state(self, target: Any, viewport: tuple[int, int, int, int], flags: int) -> None:
        """Everything somebody else may have changed since the last frame."""
        ctx: Any = self.ctx
        target.viewport = viewport
        target.scissor = None
        target.depth_mask = True
        if target is not self._common.shadow_fbo:
            target.color_mask = (True, True, True, True)
        target.use()
        ctx.enable_only(flags)
        ctx.depth_func = "<="
        ctx.blend_equation = moderngl.FUNC_ADD
        ctx.front_face, ctx.cull_face = "ccw", "back"
        ctx.wireframe = False
        ctx.polygon_offset = 0.0, 0.0

    def _resize(self, width: int, height: int) -> None:
        if self._size == (width, height):
            return
        for held in reversed(self._targets):
            held.release()
        ctx, size = self.ctx, (width, height)
        self._picture = ctx.texture(size, 4)
        self._picture.repeat_x = self._picture.repeat_y = False
        self._resolved: moderngl.Framebuffer | None = None
        if self.samples:
            color, depth = ctx.renderbuffer(size, 4, self.samples), ctx.depth_renderbuffer(size, self.samples)
            self._main, self._resolved = ctx.framebuffer([color], depth), ctx.framebuffer([self._picture])
            self._targets = [self._picture, color, depth, self._main, self._resolved]
        else:
            depth = ctx.depth_renderbuffer(size)
            self._main = ctx.framebuffer([self._picture], depth)
            self._targets = [self._picture, depth, self._main]
        ground = ctx.texture(size, 4)
        self._stage = ctx.framebuffer([ground])
        self._targets += [ground, self._stage]
        self._seen = None
        self._size = size

    def _triangles(self, mesh: Mesh, actor: Actor, program: moderngl.Program, kind: str) -> None:
        """Draw the actor's batches that `program` is for: all (kind depth), the plain ones or the textured
        ones.
        """
        loaded = self.store[mesh]
        self.store.shape(mesh, actor.morphs)
        array = loaded.array(self.ctx, program, kind)
        flags = moderngl.DEPTH_TEST | (
            moderngl.BLEND if actor.opacity < 1 and kind != "depth" else moderngl.NOTHING
        )
        for batch in mesh.batches:
            if kind != "depth" and (batch.image is not None) != (kind == "textured"):
                continue
            if not batch.count:
                continue
            if kind == "textured" and batch.image is not None:
                loaded.images[batch.image].use(2)
            self.ctx.enable_only(flags | (moderngl.NOTHING if batch.double_sided else moderngl.CULL_FACE))
            array.render(moderngl.TRIANGLES, batch.count * 3, first=batch.first * 3, instances=actor.count)

    def _squares(self, key: str, program: moderngl.Program, data: Array, layout: str, *names: str) -> None:
        """Draw one square for each row of `data`."""
        if not len(data):
            return
        content = np.ascontiguousarray(data, "<f4").tobytes()
        if key not in self._common.buffers:
            self._common.buffers[key] = self.ctx.buffer(reserve=len(content))
            self._common.plain[key] = self.ctx.vertex_array(
                program, [(self._common.buffers[key], layout, *names)]
            )
        self._common.buffers[key].orphan(max(len(content), self._common.buffers[key].size))
        self._common.buffers[key].write(content)
        self._common.plain[key].render(moderngl.TRIANGLE_STRIP, 4, instances=len(data))

    def _bare(self, key: str, program: moderngl.Program) -> moderngl.VertexArray:
        """A vertex array without vertices, for shaders that make their own."""
        if key not in self._common.plain:
            self._common.plain[key] = self.ctx.vertex_array(program, [])
        return self._common.plain[key]

    def _program(self, key: str, vertex: str, fragment: str) -> moderngl.Program:
        if key not in self._common.programs:
            self._common.programs[key] = self.ctx.program(vertex_shader=vertex, fragment_shader=fragment)
        return self._common.programs[key]


def _alike(before: Sequence[Actor], now: Sequence[Actor]) -> bool:
    """Whether they are the very same actors."""
    return len(before) == len(now) and all(a is b for a, b in zip(before, now, strict=True))


def _drawable(actor: Actor) -> bool:
    return bool(
        actor.count
        and len(actor.figure.mesh.vertices)
        and np.isfinite(actor.positions).all()
        and np.isfinite(actor.rotations).all()
    )


def _tall(actor: Actor, camera: Camera, height: int) -> float:
    """How many pixels tall the nearest instance is, about."""
    away = np.linalg.norm(np.asarray(actor.positions)[..., 0, :].reshape(-1, 3) - camera.eye, axis=1).min()
    return float(actor.figure.height / (2 * np.tan(camera.fov / 2) * max(float(away), 1e-3)) * height)


def _covered(frame: _Frame) -> tuple[int, int, int, int]:
    """The part of the picture with figures in it: x, y (from below), width, height, pixels."""
    if not frame.actors:
        return 0, 0, 0, 0
    size = np.array(frame.size)
    boxes = [a.figure.bounds(a.positions) for a in frame.actors]
    corners = np.array([[box[k >> j & 1][j] for j in range(3)] for box in boxes for k in range(8)])
    seen = frame.camera.project(corners, frame.size[0] / frame.size[1])
    if not np.isfinite(seen).all():
        return 0, 0, *frame.size
    seen[:, 1] = 1 - seen[:, 1]
    low = np.maximum(np.clip(seen.min(0), 0, 1) * size - 2, 0).astype(int)
    high = np.minimum(np.clip(seen.max(0), 0, 1) * size + 3, size).astype(int)
    return int(low[0]), int(low[1]), int(high[0] - low[0]), int(high[1] - low[1])


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


def _set(program: moderngl.Program, **values: Any) -> None:
    """Set uniforms by name; those a compiler left out are skipped. Matrices are given row-major."""
    for name, value in values.items():
        member: Any = program.get(name, None)
        if member is None:
            continue
        if isinstance(value, np.ndarray) and value.shape == (4, 4):
            member.write(np.ascontiguousarray(value.T, "<f4").tobytes())
        else:
            member.value = tuple(float(x) for x in value) if isinstance(value, (tuple, np.ndarray)) else value
