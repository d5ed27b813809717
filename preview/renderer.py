"""Draw scenes with OpenGL 3.3: the same pictures in a window and without one, on a graphics card and in
software.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import moderngl
import numpy as np

from preview import shaders
from preview.backdrop import ViewBackdrop
from preview.camera import Camera
from preview.drawing import SceneDrawing, set_uniforms
from preview.focus import DepthOfField
from preview.frame import (
    MARGIN,
    Array,
    Frame,
    find_covered,
    find_piece_boxes,
    is_drawable,
    measure_pixel_height,
)
from preview.mesh import SkinnedMesh
from preview.scene import DARK, Actor, Scene, SceneTheme
from preview.shadows import SHADOW_LIMIT, Shadows, draw_depths, list_shadow_casters

GHOST_BACK = (2.0, 1500.0)  # by slope, and in steps of the depth; about a centimetre at a figure
CONTACT, CONTACT_HIGH = 0.75, 0.16  # how much darker a sole is; up to which share of the height
SHADE = 0.8  # how dark the figure's shadow on itself is
# Pixels by which a figure's surface may be off because it has fewer triangles: on a graphics card and in
# software; in a crowd, which also has no shadows on itself; in software for a ghost or for a view beside
# another, which are looked at less closely.
OFF, OFF_CROWD, OFF_BESIDE = (0.5, 1.0), 1.4, 1.6
WHOLE = 0.5  # of a picture; larger parts are cleared with all of it, as clearing a part means drawing it
_SOFTWARE = ("llvmpipe", "softpipe", "swiftshader", "software", "basic render")


def is_software(ctx: moderngl.Context) -> bool:
    """Return whether the context draws with the processor. Multisampling is then too slow, and edges are
    smoothed afterwards.
    """
    return any(word in str(ctx.info.get("GL_RENDERER", "")).lower() for word in _SOFTWARE)


class Renderer:
    """Draws the scenes of one context.

    `occlusion` says whether limbs keep light from each other; by default only if a graphics card draws.
    `samples` is the number of samples of a pixel; None chooses 4 on a graphics card and 0 in software, where
    edges are smoothed instead. `beside` is another renderer of the same context that draws the same scenes
    from elsewhere: what both need is made once. It has to be released last.
    """

    def __init__(
        self, ctx: moderngl.Context, samples: int | None = None, beside: Renderer | None = None
    ) -> None:
        self.ctx = ctx
        self.software = is_software(ctx)
        self.samples = min((0 if self.software else 4) if samples is None else samples, int(ctx.max_samples))
        self._beside = beside
        self._drawing: SceneDrawing = SceneDrawing(ctx, self.software) if beside is None else beside._drawing
        self._shadows: Shadows = Shadows(self._drawing, self.software) if beside is None else beside._shadows
        self.store = self._drawing.store
        self.occlusion = not self.software  # takes a tenth of a picture's time if the processor draws
        self._backdrop = ViewBackdrop(self._drawing)
        self._focus = DepthOfField(self._drawing)
        self._size = (0, 0)
        self._targets: list[Any] = []
        self._resize(1, 1)

    def release(self) -> None:
        """Release everything on the graphics card. The context must be current."""
        for held in reversed(self._targets):
            held.release()
        self._targets.clear()
        self._backdrop.release()
        self._focus.release()
        if self._beside is None:
            self._shadows.release()
            self._drawing.release()

    def draw(
        self,
        scene: Scene,
        camera: Camera,
        size: tuple[int, int],
        target: moderngl.Framebuffer,
        theme: SceneTheme = DARK,
    ) -> None:
        """Draw into the lower left `size` (width, height in pixels) of `target`. Sets all state it needs and
        restores none of the caller's.

        Actors with transforms that are not finite are skipped.
        """
        width, height = max(1, int(size[0])), max(1, int(size[1]))
        theme = theme if scene.lamp is None else theme.turned(scene.lamp)
        actors = [a for a in scene.actors if is_drawable(a)]
        self._resize(width, height)
        self._drawing.begin()
        solid = [a for a in actors if a.opacity >= 1]
        cast = scene.shadow and 0 < sum(a.count for a in solid) <= SHADOW_LIMIT
        crowd = sum(a.count for a in actors) > SHADOW_LIMIT

        def mesh(a: Actor) -> SkinnedMesh:
            second = self.software and (self._beside is not None or a.opacity < 1)
            off = max(OFF_CROWD if crowd else OFF[self.software], OFF_BESIDE if second else 0.0)
            return a.figure.finest(off * a.figure.height / max(1.0, measure_pixel_height(a, camera, height)))

        meshes = [mesh(a) for a in actors]
        casters = list_shadow_casters(actors) if cast else []
        rows = self._drawing.store.prepare(actors, meshes + casters)
        matrix = camera.matrix(width / height)
        bounds = Scene(tuple(solid)).bounds()
        round_pieces = find_piece_boxes(actors, self.store.palettes if actors else ())
        frame = Frame(
            scene, actors, rows, camera, (width, height), theme, matrix, bounds, meshes, round_pieces, casters
        )
        if cast:
            frame.light = self._shadows.cast(frame)

        # The ground and the sky need no smoothing and are drawn into the target. Figures are drawn into
        # another picture and laid over them.
        ground_to = self._backdrop.draw(frame, target)
        if ground_to > 0 and solid and scene.shadow:
            self._shadows.on_ground(frame, target, ground_to, solid)
        parts = find_covered(frame)
        if len(parts):
            self._drawing.state(self._main, (0, 0, width, height), moderngl.DEPTH_TEST)
            self._clear(parts, scene.focus is not None)
            self._bodies(frame, frame.which(solid=True))
            self._ghosts(frame)
            self._compose(frame, target, parts)
        elif scene.focus is not None:
            self._main.clear(depth=1.0)
        if not theme.transparent:
            self._focus.draw(frame, target, self._main)
        self._overlay(frame)

    # --- passes

    def _bodies(self, frame: Frame, which: Sequence[int]) -> None:
        theme = frame.theme
        self._drawing.store.palette.use(0)
        self._shadows.map.use(1)
        self._drawing.store.marks.use(3)
        shared: dict[str, Any] = {"u_palette": 0, "u_shadow": 1, "u_image": 2, "u_marks": 3, "u_grain": 4}
        shared |= {"u_matrix": frame.matrix, "u_eye": frame.camera.eye, "u_to_light": theme.to_light}
        shared |= {"u_key": theme.key, "u_above": theme.above, "u_below": theme.below, "u_rim": theme.rim}
        shared["u_shade"] = SHADE
        if frame.light is not None:
            off = self._shadows.off(frame.light)
            shared |= {"u_light": frame.light, "u_spread": self._shadows.spread, "u_off": off}
        for i in which:
            actor = frame.actors[i]
            cast = frame.light is not None and actor.opacity >= 1
            rods = actor.figure.rods if self.occlusion and cast and actor.count == 1 else None
            sunk = frame.floor and float(np.min(actor.positions[..., 1])) < 0
            own: dict[str, Any] = {"u_opacity": actor.opacity, "u_marks_row": i, "u_row": frame.rows[i]}
            contact = CONTACT if frame.floor and cast else 0.0
            own["u_near_ground"] = contact, 1 / (CONTACT_HIGH * actor.figure.height)
            if rods is not None:
                own["u_rod_starts"], own["u_rod_ends"] = rods.placed(self.store.palettes[i][0])
            batches = self._drawing.store[frame.meshes[i]].batches
            for textured, grained in sorted({(b.image is not None, b.grain is not None) for b in batches}):
                flags = (
                    ("TEXTURED", textured),
                    ("GRAINED", grained),
                    ("MARKED", bool(actor.marks)),
                    ("SHADOWED", cast),
                    ("SUNK", sunk),
                    ("OCCLUDED", rods is not None),
                )
                words = [w for w, on in flags if on]
                head = "#version 330 core\n" + "".join(f"#define {w}\n" for w in words)
                program = self._drawing.program(
                    "body " + " ".join(words), head + shaders.BODY_VERTEX, head + shaders.BODY
                )
                set_uniforms(program, **shared, **own)
                kind = "textured" if textured else "plain"
                self._drawing.triangles(frame.meshes[i], actor, program, kind, grained)

    def _ghosts(self, frame: Frame) -> None:
        """Draw depth first, so that a ghost shows only its nearest surface, then colour."""
        which = frame.which(solid=False)
        if not which:
            return
        # Where a ghost and a figure are at the same place, the figure is shown: a ghost counts as a little
        # farther away.
        self.ctx.polygon_offset = GHOST_BACK
        self._main.color_mask = (False, False, False, False)
        self._main.use()  # a mask takes effect at the next use
        draw_depths(self._drawing, frame, which, frame.matrix, frame.meshes)
        self._main.color_mask = (True, True, True, True)
        self._main.use()
        self.ctx.blend_func = moderngl.ONE, moderngl.ONE_MINUS_SRC_ALPHA
        self._bodies(frame, which)
        self.ctx.polygon_offset = 0.0, 0.0

    def _clear(self, parts: Array, whole: bool) -> None:
        """Clear the picture for figures: all of it or only round their parts, whichever is faster."""
        low, past = parts[:, :2].min(0) - MARGIN, parts[:, 2:].max(0) + MARGIN  # smoothing reads beyond
        low, past = np.maximum(low, 0), np.minimum(past, self._size)
        part = (*low.tolist(), *(past - low).tolist())
        if whole or part[2] * part[3] > WHOLE * self._size[0] * self._size[1]:
            self._main.clear(depth=1.0)
        else:
            self._main.clear(depth=1.0, viewport=part)

    def _overlay(self, frame: Frame) -> None:
        """Draw the skeletons of actors with `bones` over everything."""
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
        program = self._drawing.program("lines", shaders.LINE_VERTEX, shaders.LINE)
        unit = max(1.0, frame.size[1] / 540)
        for data, width in ((lines, 1.6 * unit), (dots, 4.0 * unit)):
            set_uniforms(
                program, u_matrix=frame.matrix, u_size=frame.size, u_width=width, u_ink=frame.theme.ink
            )
            self._drawing.squares("lines", program, data, "3f 3f/i", "in_start", "in_end")

    def _compose(self, frame: Frame, target: Any, parts: Array) -> None:
        """Lay the figures over the target. Without multisampling, smooth their edges at the same time.
        `parts` are the rectangles that may have figures in them.
        """
        if self._resolved is not None:
            self.ctx.copy_framebuffer(self._resolved, self._main)
        self._drawing.state(target, (0, 0, *frame.size), moderngl.BLEND)
        self.ctx.blend_func = moderngl.ONE, moderngl.ONE_MINUS_SRC_ALPHA
        self._picture.use(0)
        name, source = ("copy", shaders.COPY) if self.samples else ("smooth", shaders.SMOOTH)
        program = self._drawing.program(name, shaders.PART_VERTEX, source)
        set_uniforms(program, u_picture=0, u_pixel=(1 / frame.size[0], 1 / frame.size[1]))
        self._drawing.squares(name, program, parts, "4f/i", "in_part")

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
        self._backdrop.resize(size)
        self._size = size
