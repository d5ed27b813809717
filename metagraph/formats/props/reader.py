"""Read props: meshes that stand still, from OBJ, STL, PLY, OFF and GLB files, through trimesh, and 3MF."""

from __future__ import annotations

import io
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.common.budgets import MIB, PICTURE_PIXELS
from metagraph.common.files import guard_reader, is_file, read_file
from metagraph.common.wording import phrase, plural_phrase
from metagraph.errors import FileError
from metagraph.formats.props.shapes import (
    MOST_TRIANGLES,
    WIDEST,
    encode_picture,
    find_drawable,
    has_inside,
    make_colour_picture,
    make_normals,
    measure_volume,
    thin_out,
)
from metagraph.motion.character_mesh import CharacterMesh, MeshMaterial, Surface
from metagraph.motion.skeleton import Skeleton

Array = NDArray[Any]

PROP_FILE = 512 * MIB
ENDINGS = (".obj", ".stl", ".ply", ".off", ".glb", ".3mf")
REMEDY = phrase("Export it as GLB from the program that made it.")
GREY = (0.35, 0.35, 0.36, 1.0)  # linear, of what has no colour
_IN_METRES = (".glb", ".3mf")  # once read; the others do not say their unit
_SAY_SIDES = (".glb",)  # which of their triangles are seen from both sides
FARTHEST, SMALLEST = 1e5, 1e-3  # metres: larger than this is broken, smaller is not seen
AWAY = 20.0  # metres, and times its size, from its origin: what is farther away is moved there
_CENTIMETRES, _MILLIMETRES = 20.0, 500.0  # what is larger than this many units is not in metres, centimetres
_BESIDE = (".png", ".jpg", ".jpeg", ".bmp", ".tga", ".webp", ".mtl")


@guard_reader
def read_prop(path: str | Path) -> CharacterMesh:
    """Return the mesh of a prop, in metres with y up, held whole by one joint, "Prop", at its origin.

    Its `notes` say what was assumed, repaired and left out: the unit, triangles without an area, pictures
    that are not there or are too large, triangles beyond `MOST_TRIANGLES`, surfaces that were inside out, a
    place far from its origin. A surface with a hole is drawn from both sides. Raises FileError for a file
    that is none of `ENDINGS`, is broken, or has no triangle.
    """
    path = Path(path)
    ending = path.suffix.lower()
    if ending not in ENDINGS:
        raise FileError(
            path,
            phrase("it is not a kind of file that props are read from"),
            "",
            phrase("Known are {endings}. {remedy}", endings=", ".join(ENDINGS), remedy=REMEDY),
        )
    notes: list[str] = []
    content = read_file(path, PROP_FILE)
    try:
        if ending == ".3mf":
            parts = _list_three_parts(content)
        else:
            import trimesh

            beside: Any = _Beside(path.parent, notes)
            scene = trimesh.load_scene(
                io.BytesIO(content), file_type=ending[1:], resolver=beside, process=False
            )
            parts = _list_parts(scene)
    except FileError:
        raise
    except Exception as error:  # trimesh raises many kinds on broken files
        why = phrase("it cannot be read ({error})", error=str(error)[:200] or type(error).__name__)
        raise FileError(path, why, "", REMEDY) from None
    if not parts:
        raise FileError(path, phrase("it has no triangle"), "", REMEDY)
    unit = _find_unit(parts, notes) if ending not in _IN_METRES else 1.0
    return _Builder(path.stem, notes, ending in _SAY_SIDES).build(path, parts, unit)


def list_files_beside(path: Path) -> list[Path]:
    """Return the files beside a prop's that belong to it: the materials and pictures of an OBJ. Raises
    FileError if it cannot be read.
    """
    if path.suffix.lower() != ".obj":
        return []
    import trimesh

    beside: Any = _Beside(path.parent, [])
    try:
        content = io.BytesIO(read_file(path, PROP_FILE))
        trimesh.load_scene(content, file_type="obj", resolver=beside, process=False)
    except FileError:
        raise
    except Exception as error:  # as above
        why = phrase("it cannot be read ({error})", error=str(error)[:200])
        raise FileError(path, why, "", REMEDY) from None
    return list(dict.fromkeys(beside.used))


@dataclass(frozen=True)
class _Part:
    """positions `[V, 3]` in the file's unit, triangles `[N, 3]`, and trimesh's word on how it looks."""

    positions: Array
    triangles: Array
    visual: Any


@dataclass
class _Beside:
    """Gives trimesh the files that a prop names: pictures and materials in its own folder, nothing else."""

    folder: Path
    notes: list[str]
    used: list[Path] = field(default_factory=list)

    def get(self, name: str) -> bytes:
        kind = Path(str(name).replace("\\", "/")).name
        place = self.folder / kind
        if place.suffix.lower() not in _BESIDE or not is_file(place):
            self.notes.append(phrase("'{name}' is not beside it and was left out", name=kind[:80]))
            raise FileNotFoundError(kind)
        self.used.append(place)
        return read_file(place, PROP_FILE)

    def __getitem__(self, name: str) -> bytes:
        return self.get(name)


def _list_parts(scene: Any) -> list[_Part]:
    """Return the meshes of a scene, where it has them. The `dump` of trimesh would do it, but needs SciPy to
    copy colours.
    """
    out = []
    for node in scene.graph.nodes_geometry:
        matrix, name = scene.graph[node]
        mesh = scene.geometry[name]
        if not len(getattr(mesh, "faces", ())):
            continue
        positions = np.asarray(mesh.vertices, float) @ matrix[:3, :3].T + matrix[:3, 3]
        triangles = np.asarray(mesh.faces, np.int64).reshape(-1, 3)
        if np.linalg.det(matrix[:3, :3]) < 0:  # a mirrored part is inside out
            triangles = triangles[:, ::-1]
        out.append(_Part(positions, triangles, mesh.visual))
    return out


@dataclass(frozen=True)
class _Painted:
    """How a part looks whose triangles have colours, as trimesh has it; none if `face_colors` is None."""

    face_colors: Array | None

    @property
    def kind(self) -> str | None:
        return None if self.face_colors is None else "face"


def _list_three_parts(content: bytes) -> list[_Part]:
    from metagraph.formats.props.three_mf import read_three_meshes

    return [
        _Part(mesh.positions, mesh.triangles, _Painted(mesh.colours))
        for mesh in read_three_meshes(content, PROP_FILE)
    ]


def _find_unit(parts: list[_Part], notes: list[str]) -> float:
    """Return how many metres one unit of a file is that does not say so, and note what was taken."""
    with np.errstate(invalid="ignore", over="ignore"):
        points = np.concatenate([part.positions for part in parts])
        points = points[np.isfinite(points).all(1)]
        size = float(np.ptp(points, axis=0).max()) if len(points) else 0.0
    if size <= _CENTIMETRES:
        return 1.0
    unit, word = (0.01, phrase("centimetres")) if size <= _MILLIMETRES else (0.001, phrase("millimetres"))
    notes.append(phrase("it is {size:.4g} units large, which were taken for {unit}", size=size, unit=word))
    return unit


@dataclass
class _Builder:
    """Puts the parts of a scene together. linear: whether colours are linear, as in glTF, not sRGB."""

    name: str
    notes: list[str]
    linear: bool
    arrays: list[tuple[Array, Array, Array, Array]] = field(default_factory=list)
    materials: list[MeshMaterial] = field(default_factory=list)

    def build(self, path: Path, parts: list[_Part], unit: float) -> CharacterMesh:
        """Return the mesh of all parts. Raises FileError if nothing of them can be drawn."""
        total, left, turned = sum(len(part.triangles) for part in parts), 0, 0
        share = min(1.0, MOST_TRIANGLES / total)
        for part in parts:
            positions, triangles = part.positions * unit, part.triangles
            drawn = find_drawable(positions, triangles)
            triangles = triangles[drawn]
            left += len(drawn) - len(triangles)
            if not len(triangles):
                continue
            material, uvs = self._describe(part, drawn if share == 1.0 else None)
            if share < 1.0:
                positions, triangles = thin_out(positions, triangles, max(1, int(share * len(triangles))))
            if not has_inside(positions, triangles):
                material = replace(material, double_sided=material.double_sided or not self.linear)
            elif measure_volume(positions, triangles) < 0:
                triangles, turned = triangles[:, ::-1], turned + 1
            self.arrays.append(make_normals(positions, triangles, uvs))
            self.materials.append(material)
        if not self.arrays:
            raise FileError(
                path, phrase("none of its {count} triangles can be drawn", count=total), "", REMEDY
            )
        if left:
            self.notes.append(
                plural_phrase(
                    "{count:,} triangle without an area was left out",
                    "{count:,} triangles without an area were left out",
                    left,
                )
            )
        if turned:
            self.notes.append(phrase("it was inside out and was turned"))
        self._check_place(path)
        kept = sum(len(a[3]) for a in self.arrays)
        if share < 1.0:
            self.notes.append(
                phrase(
                    "it has {total:,} triangles; {kept:,} are drawn, without pictures", total=total, kept=kept
                )
            )
        return self._join()

    def _check_place(self, path: Path) -> None:
        """Refuse what is larger than any set, note what is too small to be seen, and move what is far from
        its origin onto it.
        """
        points = np.concatenate([a[0] for a in self.arrays])
        low, high = points.min(0), points.max(0)
        size = float((high - low).max())
        if size > FARTHEST:
            raise FileError(path, phrase("it is {size:.3g} m large", size=size), "", REMEDY)
        if size < SMALLEST:
            self.notes.append(
                phrase("it is only {size:.2g} mm large; enlarge it with its size", size=size * 1e3)
            )
        foot = np.array([(low[0] + high[0]) / 2, low[1], (low[2] + high[2]) / 2])
        away = float(np.linalg.norm((low + high) / 2))
        if away > AWAY * max(1.0, size):
            self.arrays = [(a[0] - foot, *a[1:]) for a in self.arrays]
            self.notes.append(
                phrase("it is {away:,.0f} m away from its origin and was moved there", away=away)
            )

    def _describe(self, part: _Part, drawn: Array | None) -> tuple[MeshMaterial, Array | None]:
        """Return a part's material, and its texture coordinates. drawn: which triangles are drawn; None for a
        part without pictures.
        """
        visual = part.visual
        if visual.kind == "texture":
            material = visual.material
            image = getattr(material, "baseColorTexture", None) or getattr(material, "image", None)
            uv = None if visual.uv is None else np.asarray(visual.uv, float)
            usable = (
                image is not None
                and drawn is not None
                and uv is not None
                and uv.shape == (len(part.positions), 2)
            )
            if usable:
                usable = self._check_picture(image)
            colour = self._colour(material.main_color)
            double = bool(getattr(material, "doubleSided", False))
            if not usable or uv is None:
                return MeshMaterial(self.name, colour, double_sided=double), None
            uv = np.nan_to_num(uv) * [1.0, -1.0] + [0.0, 1.0]  # trimesh counts v from below
            return MeshMaterial(self.name, colour, encode_picture(image), double_sided=double), uv
        if visual.kind in ("vertex", "face"):
            colours = np.asarray(visual.face_colors, np.uint8)[:, :3]
            if drawn is not None and len(np.unique(colours[drawn], axis=0)) > 1:
                picture, uv = make_colour_picture(colours[drawn])
                return MeshMaterial(self.name, (1.0, 1.0, 1.0, 1.0), picture), uv
            return MeshMaterial(self.name, self._colour(np.append(np.median(colours, axis=0), 255))), None
        return MeshMaterial(self.name, GREY), None

    def _check_picture(self, image: Any) -> bool:
        """Return whether a picture can be used; note what is left out of it."""
        size = {"width": image.width, "height": image.height}
        if image.width * image.height > PICTURE_PIXELS:
            self.notes.append(
                phrase(
                    "its picture of {width:,} × {height:,} pixels is too large and was left out",
                    width=size["width"],
                    height=size["height"],
                )
            )
            return False
        if max(image.size) > WIDEST:
            self.notes.append(
                phrase(
                    "its picture of {width:,} × {height:,} pixels was reduced to {most:,}",
                    width=size["width"],
                    height=size["height"],
                    most=WIDEST,
                )
            )
        return True

    def _colour(self, rgba: Array) -> tuple[float, float, float, float]:
        """Return 8-bit values as linear 0..1, without transparency, which is not drawn."""
        value = np.clip(np.asarray(rgba, float)[:3] / 255, 0, 1)
        if not self.linear:
            value = np.where(value <= 0.04045, value / 12.92, ((value + 0.055) / 1.055) ** 2.4)
        return float(value[0]), float(value[1]), float(value[2]), 1.0

    def _join(self) -> CharacterMesh:
        points = np.cumsum([0, *(len(a[0]) for a in self.arrays)])
        faces = np.cumsum([0, *(len(a[3]) for a in self.arrays)])
        positions, normals, uvs = (np.concatenate([a[n] for a in self.arrays]) for n in range(3))
        weights = np.zeros((len(positions), 4), np.float32)
        weights[:, 0] = 1
        return CharacterMesh(
            self.name,
            Skeleton(("Prop",), np.array([-1]), np.array([[0.0, 0, 0, 1]]), np.zeros((1, 3))),
            positions.astype(np.float32),
            normals.astype(np.float32),
            uvs.astype(np.float32),
            np.zeros((len(positions), 4), np.uint16),
            weights,
            np.concatenate([a[3] + n for a, n in zip(self.arrays, points, strict=False)]).astype(np.uint32),
            tuple(self.materials),
            tuple(Surface(int(faces[n]), len(a[3]), n, self.name) for n, a in enumerate(self.arrays)),
            notes=tuple(dict.fromkeys(self.notes)),
            meshes=(self.name,),
        )
