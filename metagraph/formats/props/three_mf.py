"""Read the meshes of 3MF files: a zip with XML in it, as printers and CAD programs write it (3MF Core
Specification 1.3). trimesh reads it with two more packages, lxml and networkx, which nothing else needs.
"""

from __future__ import annotations

import io
import zipfile
from dataclasses import dataclass, field
from typing import Any
from xml.etree import ElementTree

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]

UNITS = {
    "micron": 1e-6,
    "millimeter": 1e-3,
    "centimeter": 1e-2,
    "inch": 0.0254,
    "foot": 0.3048,
    "meter": 1.0,
}
MODEL = "3D/3dmodel.model"
DEPTH = 16  # of objects in objects
_UP = np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]])  # from z up to y up


@dataclass
class ThreeMesh:
    """A mesh as it stands: positions `[V, 3]` in metres, y up, triangles `[N, 3]`, and the colours of its
    triangles `[N, 3]`, 0..255, None if it has none.
    """

    positions: Array
    triangles: Array
    colours: Array | None


@dataclass
class _Object:
    """What an object of a model holds: a mesh, or other objects, each with its file, number and matrix."""

    positions: Array = field(default_factory=lambda: np.zeros((0, 3)))
    triangles: Array = field(default_factory=lambda: np.zeros((0, 3), np.int64))
    colours: Array | None = None
    parts: list[tuple[str, str, Array]] = field(default_factory=list)


def read_three_meshes(content: bytes, most: int) -> list[ThreeMesh]:
    """Return the meshes that a 3MF file builds. most: bytes that its models may have together. Raises
    ValueError for a file that is none, or is broken; pictures and beams are left out.
    """
    try:
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            names = [name for name in archive.namelist() if name.lower().endswith(".model")]
            if sum(archive.getinfo(name).file_size for name in names) > most:
                raise ValueError("its models are too large")
            models = {name.lstrip("/"): _Model(archive.read(name)) for name in names}
    except (zipfile.BadZipFile, ElementTree.ParseError, KeyError) as error:
        raise ValueError(str(error)) from None
    root = next((name for name in models if name.lower() == MODEL.lower()), next(iter(models), ""))
    if not root:
        raise ValueError("it has no model")
    out: list[ThreeMesh] = []
    for path, ident, matrix in models[root].items:
        _place(models, path or root, ident, matrix, out, 0)
    size = UNITS.get(models[root].unit, UNITS["millimeter"])
    for mesh in out:
        mesh.positions = mesh.positions @ _UP.T * size
    return out


class _Model:
    """One model: its objects by their numbers, and what of them is built."""

    def __init__(self, text: bytes) -> None:
        if b"<!DOCTYPE" in text or b"<!ENTITY" in text:
            raise ValueError("it declares entities")
        root = ElementTree.fromstring(text)
        self.unit = root.get("unit", "millimeter")
        self.palettes: dict[str, list[tuple[int, int, int]]] = {}
        self.objects: dict[str, _Object] = {}
        self.items: list[tuple[str, str, Array]] = []
        for element in root.iter():
            kind = _name(element)
            if kind in ("basematerials", "colorgroup"):
                self.palettes[element.get("id", "")] = [_read_colour(child) for child in element]
            elif kind == "object":
                self.objects[element.get("id", "")] = self._read_object(element)
            elif kind == "item":
                self.items.append(_read_reference(element))

    def _read_object(self, element: Any) -> _Object:
        out = _Object()
        given = (element.get("pid"), element.get("pindex", "0"))
        for child in element:
            if _name(child) == "components":
                out.parts = [_read_reference(part) for part in child]
            elif _name(child) == "mesh":
                lists = {_name(grand): grand for grand in child}
                corners = [(v.get("x"), v.get("y"), v.get("z")) for v in lists.get("vertices", ())]
                sides = list(lists.get("triangles", ()))
                numbers = [(t.get("v1"), t.get("v2"), t.get("v3")) for t in sides]
                out.positions = np.array(corners, float).reshape(-1, 3)
                out.triangles = np.array(numbers, np.int64).reshape(-1, 3)
                colours = [self._find_colour(t.get("pid"), t.get("p1"), given) for t in sides]
                if any(colour is not None for colour in colours):
                    out.colours = np.array([colour or (160, 160, 160) for colour in colours], np.uint8)
        return out

    def _find_colour(
        self, group: str | None, index: str | None, given: tuple[str | None, str]
    ) -> tuple[int, int, int] | None:
        palette = self.palettes.get(group or given[0] or "", [])
        place = int(index if index is not None else given[1])
        return palette[place] if 0 <= place < len(palette) else None


def _place(
    models: dict[str, _Model], path: str, ident: str, matrix: Array, out: list[ThreeMesh], depth: int
) -> None:
    """Add the meshes of an object, and of those in it, where a matrix `[4, 3]` has them."""
    found = models[path].objects.get(ident) if path in models else None
    if found is None or depth > DEPTH or len(out) > 10_000:
        raise ValueError(f"it has no object {ident}" if found is None else "its objects are nested too deep")
    if len(found.triangles):
        triangles = found.triangles
        if np.linalg.det(matrix[:3]) < 0:  # a mirrored part is inside out
            triangles = triangles[:, ::-1]
        out.append(ThreeMesh(found.positions @ matrix[:3] + matrix[3], triangles, found.colours))
    for other, number, inner in found.parts:
        both = np.vstack([inner[:3] @ matrix[:3], inner[3] @ matrix[:3] + matrix[3]])
        _place(models, other or path, number, both, out, depth + 1)


def _read_reference(element: Any) -> tuple[str, str, Array]:
    path = next((value for key, value in element.attrib.items() if key.endswith("}path")), "")
    words = element.get("transform")
    matrix = np.array(words.split(), float) if words else np.eye(4)[:, :3].reshape(-1)
    if matrix.shape != (12,):
        raise ValueError("a transform has not 12 numbers")
    return path.lstrip("/"), element.get("objectid", ""), matrix.reshape(4, 3)


def _read_colour(element: Any) -> tuple[int, int, int]:
    words = element.get("displaycolor") or element.get("color") or "#A0A0A0"
    value = int(words.lstrip("#")[:6].ljust(6, "0"), 16)
    return value >> 16 & 255, value >> 8 & 255, value & 255


def _name(element: Any) -> str:
    return str(element.tag).rpartition("}")[2]
