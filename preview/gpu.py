"""Keep on the graphics card: meshes, their textures, and each frame's palettes."""

from __future__ import annotations

import io
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from typing import Any

import moderngl
import numpy as np
from numpy.typing import NDArray

from metagraph.common.budgets import PICTURE_PIXELS
from metagraph.common.pictures import holds_flat_colors, read_picture_size
from preview.mesh import VERTEX, SkinnedMesh, TriangleBatch, arrange_vertices
from preview.occlusion import Rods
from preview.paint import remove_invisible_texture
from preview.scene import Actor

Array = NDArray[Any]

KEEP_MESHES = 16
IDLE_FRAMES = 240
TEXTURE_LIMIT = 2048
MARK_STRENGTH = 200  # of 255: how much a mark covers the figure's own colour

# How shaders of each kind read the vertex (see mesh.VERTEX). Positions come from a buffer of their own.
_LAYOUTS = {
    "depth": ("12x 12x 8x 4u2 4f 4x", ("in_bones", "in_weights")),
    "plain": ("12x 3f 8x 4u2 4f 4f1", ("in_normal", "in_bones", "in_weights", "in_color")),
    "textured": ("12x 3f 2f 4u2 4f 4f1", ("in_normal", "in_uv", "in_bones", "in_weights", "in_color")),
}


@dataclass
class LoadedMesh:
    """One mesh's buffers, and a vertex array for each program that draws it. `order` is the order of the
    vertices `[U]`. `batches` are those drawn in passes with colours.
    """

    order: Array
    batches: tuple[TriangleBatch, ...]
    vertices: moderngl.Buffer
    positions: moderngl.Buffer
    indices: moderngl.Buffer
    images: dict[bytes, moderngl.Texture]
    arrays: dict[int, moderngl.VertexArray] = field(default_factory=dict)
    limbs: moderngl.Buffer | None = None
    grain: moderngl.Buffer | None = None
    morphs: bytes = b""
    idle: int = 0

    def array(
        self, ctx: moderngl.Context, program: moderngl.Program, kind: str, rods: Rods | None = None
    ) -> moderngl.VertexArray:
        """Return the vertex array for `program`. `kind` is depth, plain or textured. `rods` is for a program
        that uses each vertex's limb.
        """
        if program.glo not in self.arrays:
            layout, names = _LAYOUTS[kind]
            content: list[Any] = [(self.positions, "3f", "in_position"), (self.vertices, layout, *names)]
            if rods is not None and "in_limb" in program:
                if self.limbs is None:
                    held = np.frombuffer(self.vertices.read(), VERTEX)
                    self.limbs = ctx.buffer(rods.of(held).tobytes())
                content.append((self.limbs, "1u1", "in_limb"))
            if self.grain is not None and "in_grain" in program:
                content.append((self.grain, "2f", "in_grain"))
            self.arrays[program.glo] = ctx.vertex_array(program, content, self.indices)
        return self.arrays[program.glo]

    def release(self) -> None:
        for array in self.arrays.values():
            array.release()
        for buffer in (self.vertices, self.positions, self.indices, self.limbs, self.grain):
            if buffer is not None:
                buffer.release()


class Store:
    """Load what a frame needs and release what has not been drawn for some time. `software` says whether the
    processor draws, for which textures are expensive.
    """

    def __init__(self, ctx: moderngl.Context, software: bool = False) -> None:
        self._ctx, self._software = ctx, software
        self._meshes: dict[SkinnedMesh, LoadedMesh] = {}
        self._images: dict[bytes, moderngl.Texture] = {}  # shared by a mesh and its levels of detail
        self.palette = ctx.texture((3, 1), 4, dtype="f4")
        self.marks = ctx.texture((1, 1), 4)
        self._written: list[Actor] = []  # the actors whose palettes and marks these are
        self.palettes: list[Array] = []  # of each of them `[instances, M, 3, 4]`

    def __getitem__(self, mesh: SkinnedMesh) -> LoadedMesh:
        return self._meshes[mesh]

    def __len__(self) -> int:
        return len(self._meshes)

    def release(self) -> None:
        for loaded in self._meshes.values():
            loaded.release()
        self._meshes.clear()
        self._let_images_go()
        self.palette.release()
        self.marks.release()

    def prepare(self, actors: Sequence[Actor], meshes: Sequence[SkinnedMesh]) -> list[int]:
        """Load meshes, palettes (all in one texture) and marks. Return each actor's first row in the palette
        texture.

        `meshes` holds one for each actor, in order, then any others the frame draws.
        """
        for loaded in self._meshes.values():
            loaded.idle += 1
        rows, row = [], 0
        for mesh in meshes:
            self._load(mesh)
        for actor in actors:
            rows.append(row)
            row += actor.count
        crowded = len(self._meshes) > KEEP_MESHES
        gone = [m for m, loaded in self._meshes.items() if loaded.idle > (0 if crowded else IDLE_FRAMES)]
        for mesh in gone:
            self._meshes.pop(mesh).release()
        if gone:
            self._let_images_go()
        if len(actors) == len(self._written) and all(
            a is b for a, b in zip(actors, self._written, strict=True)
        ):
            return rows
        self._written = list(actors)
        if actors:
            self._write_palettes(actors, rows, row)
        if any(actor.marks for actor in actors):
            self._write_marks(actors)
        return rows

    def _write_palettes(self, actors: Sequence[Actor], rows: Sequence[int], height: int) -> None:
        width = max(a.figure.mesh.matrices for a in actors)
        self.palettes = [
            a.figure.palette(a.rotations, a.positions).reshape(a.count, -1, 3, 4) for a in actors
        ]
        data = self.palettes[0]
        if len(actors) > 1:
            data = np.zeros((height, width, 3, 4), np.float32)
            for palette, row in zip(self.palettes, rows, strict=True):
                data[row : row + len(palette), : palette.shape[1]] = palette
        if self.palette.size[0] < 3 * width or self.palette.size[1] < height:
            self.palette.release()
            self.palette = self._ctx.texture((3 * width, height), 4, dtype="f4")
            self.palette.filter = moderngl.NEAREST, moderngl.NEAREST
        self.palette.write(np.ascontiguousarray(data, "<f4"), viewport=(0, 0, 3 * width, height))

    def _write_marks(self, actors: Sequence[Actor]) -> None:
        width = max(a.figure.mesh.matrices for a in actors)
        marks = np.zeros((len(actors), width, 4), np.uint8)
        for row, actor in zip(marks, actors, strict=True):
            for joint, color in actor.marks.items():
                row[: len(actor.figure.sources)][actor.figure.sources == joint] = (
                    *(round(255 * c) for c in color),
                    MARK_STRENGTH,
                )
        self.marks.release()
        self.marks = self._ctx.texture((width, len(actors)), 4, marks.tobytes())
        self.marks.filter = moderngl.NEAREST, moderngl.NEAREST

    def _load(self, mesh: SkinnedMesh) -> None:
        loaded = self._meshes.get(mesh)
        if loaded is None:
            buffer = self._ctx.buffer
            drawn, origins = (
                remove_invisible_texture(mesh, decode_texture)
                if self._software
                else (mesh, np.arange(len(mesh.vertices)))
            )
            order, triangles = arrange_vertices(drawn)
            vertices = drawn.vertices[order]
            loaded = self._meshes[mesh] = LoadedMesh(
                origins[order],
                drawn.batches,
                buffer(vertices.tobytes()),
                buffer(vertices["position"].tobytes()),
                buffer(np.ascontiguousarray(triangles, "<u4").tobytes()),
                {
                    image: self._image(image, image == b.grain)
                    for b in drawn.batches
                    for image in (b.image, b.grain)
                    if image is not None
                },
                grain=None
                if mesh.grain is None
                else buffer(np.ascontiguousarray(mesh.grain[origins[order]], "<f4").tobytes()),
            )
        loaded.idle = 0

    def shape(self, mesh: SkinnedMesh, weights: Array | None) -> None:
        """Give a loaded mesh the face of the actor that is drawn next, at rest if it has none; two actors may
        share a mesh. `weights` `[K]` are those of its morph targets.
        """
        if mesh.morphs is None:
            return
        fits = weights is not None and len(weights) == len(mesh.morphs)
        wanted = np.asarray(weights, np.float32) if fits else np.zeros(len(mesh.morphs), np.float32)
        loaded = self._meshes[mesh]
        if wanted.tobytes() != (loaded.morphs or bytes(wanted.nbytes)):  # on change only
            moved = mesh.morphs.positions(mesh.vertices["position"], wanted)
            loaded.positions.write(np.ascontiguousarray(moved[loaded.order], "<f4").tobytes())
            loaded.morphs = wanted.tobytes()

    def _let_images_go(self) -> None:
        """Release the textures that no mesh uses any more."""
        used = {image for loaded in self._meshes.values() for image in loaded.images}
        for image in [image for image in self._images if image not in used]:
            self._images.pop(image).release()

    def _image(self, encoded: bytes, repeats: bool = False) -> moderngl.Texture:
        if encoded in self._images:
            return self._images[encoded]
        size, pixels = decode_texture(encoded)
        texture = self._ctx.texture(size, 4, pixels)
        if repeats or not holds_flat_colors(size):  # to make mipmaps stalls drawing in software
            texture.build_mipmaps()
            texture.filter = moderngl.LINEAR_MIPMAP_LINEAR, moderngl.LINEAR
        self._images[encoded] = texture
        return texture


@lru_cache(maxsize=32)
def decode_texture(encoded: bytes) -> tuple[tuple[int, int], bytes]:
    """Return a texture's size and RGBA pixels. One that cannot be read becomes white, so that the figure is
    still drawn.

    The result is kept: code that loads a figure on a thread can decode there, so that drawing need not wait.
    """
    from PIL import Image

    try:
        size = read_picture_size(encoded)
        if size is None or size[0] * size[1] > PICTURE_PIXELS:
            raise ValueError("no picture that can be drawn")
        picture = Image.open(io.BytesIO(encoded)).convert("RGBA")
    except Exception:  # Pillow raises many kinds on broken files
        picture = Image.new("RGBA", (1, 1), "white")
    picture.thumbnail((TEXTURE_LIMIT, TEXTURE_LIMIT))
    return picture.size, picture.tobytes()
