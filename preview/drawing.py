"""Hold what all renderers of one context share on the graphics card, and the calls that every pass draws
with.
"""

from __future__ import annotations

from typing import Any

import moderngl
import numpy as np
from numpy.typing import NDArray

from preview.gpu import Store
from preview.mesh import SkinnedMesh
from preview.scene import Actor

Array = NDArray[Any]


class SceneDrawing:
    """Programs, vertex arrays without vertices, meshes and palettes of one context. Each is made on first
    use.
    """

    def __init__(self, ctx: moderngl.Context, software: bool = False) -> None:
        self.ctx = ctx
        self.store = Store(ctx, software)
        self._programs: dict[str, moderngl.Program] = {}
        self._plain: dict[str, moderngl.VertexArray] = {}
        self._buffers: dict[str, moderngl.Buffer] = {}
        self._picture: moderngl.Texture | None = None
        self._pictured: Array | None = None  # the array that it shows

    def release(self) -> None:
        """Release everything on the graphics card."""
        self.store.release()
        held: Any
        for held in (*self._plain.values(), *self._programs.values(), *self._buffers.values()):
            held.release()
        if self._picture is not None:
            self._picture.release()
            self._picture = None
        for gone in (self._plain, self._programs, self._buffers):
            gone.clear()

    def begin(self) -> None:
        """Set all state that other code may have changed since the last frame, except what `state` sets."""
        ctx: Any = self.ctx
        ctx.depth_func = "<="
        ctx.blend_equation = moderngl.FUNC_ADD
        ctx.front_face, ctx.cull_face = "ccw", "back"
        ctx.wireframe = False
        ctx.polygon_offset = 0.0, 0.0

    def state(
        self, target: Any, viewport: tuple[int, int, int, int], flags: int, colors: bool = True
    ) -> None:
        """Draw into `target` from now on. `colors` says whether the target has colours."""
        target.viewport = viewport
        target.scissor = None
        target.depth_mask = True
        if colors:
            target.color_mask = (True, True, True, True)
        target.use()
        self.ctx.enable_only(flags)

    def triangles(
        self, mesh: SkinnedMesh, actor: Actor, program: moderngl.Program, kind: str, grained: bool = False
    ) -> None:
        """Draw the batches of the actor that `program` is for: all of them (kind "depth"), the plain ones or
        the textured ones; of these, those with a grain or those without.
        """
        loaded = self.store[mesh]
        self.store.shape(mesh, actor.morphs)
        array = loaded.array(self.ctx, program, kind, actor.figure.rods if kind != "depth" else None)
        flags = moderngl.DEPTH_TEST | (
            moderngl.BLEND if actor.opacity < 1 and kind != "depth" else moderngl.NOTHING
        )
        for batch in mesh.batches if kind == "depth" else loaded.batches:
            if kind != "depth" and (batch.image is not None, batch.grain is not None) != (
                kind == "textured",
                grained,
            ):
                continue
            if not batch.count:
                continue
            if kind == "textured" and batch.image is not None:
                loaded.images[batch.image].use(2)
            if grained and batch.grain is not None:
                loaded.images[batch.grain].use(4)
            self.ctx.enable_only(flags | (moderngl.NOTHING if batch.double_sided else moderngl.CULL_FACE))
            array.render(moderngl.TRIANGLES, batch.count * 3, first=batch.first * 3, instances=actor.count)

    def squares(self, key: str, program: moderngl.Program, data: Array, layout: str, *names: str) -> None:
        """Draw one square for each row of `data`."""
        if not len(data):
            return
        content = np.ascontiguousarray(data, "<f4").tobytes()
        if key not in self._buffers:
            self._buffers[key] = self.ctx.buffer(reserve=len(content))
            self._plain[key] = self.ctx.vertex_array(program, [(self._buffers[key], layout, *names)])
        self._buffers[key].orphan(max(len(content), self._buffers[key].size))
        self._buffers[key].write(content)
        self._plain[key].render(moderngl.TRIANGLE_STRIP, 4, instances=len(data))

    def bare(self, key: str, program: moderngl.Program) -> moderngl.VertexArray:
        """Return a vertex array without vertices, for shaders that make their own."""
        if key not in self._plain:
            self._plain[key] = self.ctx.vertex_array(program, [])
        return self._plain[key]

    def program(self, key: str, vertex: str, fragment: str) -> moderngl.Program:
        if key not in self._programs:
            self._programs[key] = self.ctx.program(vertex_shader=vertex, fragment_shader=fragment)
        return self._programs[key]

    def picture(self, picture: Array) -> moderngl.Texture:
        """Return a texture that shows `picture [H, W, 3]` uint8. The last one is kept."""
        size = (picture.shape[1], picture.shape[0])
        if self._picture is None or self._picture.size != size:
            if self._picture is not None:
                self._picture.release()
            self._picture, self._pictured = self.ctx.texture(size, 3, alignment=1), None
            self._picture.repeat_x = self._picture.repeat_y = False
        if self._pictured is not picture:
            self._picture.write(np.ascontiguousarray(picture, np.uint8), alignment=1)
            self._pictured = picture
        return self._picture


def set_uniforms(program: moderngl.Program, **values: Any) -> None:
    """Set uniforms by name. Those that a compiler has removed are skipped. Matrices are given row-major.

    A value that a uniform already has is not set again. Arrays are compared by identity, so they must not be
    written to.
    """
    if program.extra is None:
        program.extra = {}
    held: dict[str, Any] = program.extra
    for name, value in values.items():
        before = held.get(name)
        if before is value or (type(before) is type(value) is not np.ndarray and before == value):
            continue
        held[name] = value
        member: Any = program.get(name, None)
        if member is None:
            continue
        if isinstance(value, np.ndarray) and value.ndim == 2 and value.shape != (4, 4):
            member.write(np.ascontiguousarray(value, "<f4").tobytes())  # an array of vectors
        elif isinstance(value, np.ndarray) and value.shape == (4, 4):
            member.write(np.ascontiguousarray(value.T, "<f4").tobytes())
        else:
            member.value = tuple(float(x) for x in value) if isinstance(value, (tuple, np.ndarray)) else value
