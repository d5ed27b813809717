"""3MF files for tests, as printers' programs write them."""

from __future__ import annotations

import io
import zipfile
from collections.abc import Sequence

import trimesh

CORE = 'xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02"'


def write_mesh(mesh: trimesh.Trimesh, paint: Sequence[int] = ()) -> str:
    """The mesh of an object. paint: the colour of each triangle in a palette numbered 9."""
    points = "".join(f'<vertex x="{x:g}" y="{y:g}" z="{z:g}"/>' for x, y, z in mesh.vertices.tolist())
    sides = "".join(
        f'<triangle v1="{a}" v2="{b}" v3="{c}"' + (f' pid="9" p1="{paint[n]}"/>' if len(paint) else "/>")
        for n, (a, b, c) in enumerate(mesh.faces.tolist())
    )
    return f"<mesh><vertices>{points}</vertices><triangles>{sides}</triangles></mesh>"


def write_three(resources: str, build: str, unit: str = "millimeter", **models: str) -> bytes:
    """A 3MF file of resources and build items; other models by their names."""
    out = io.BytesIO()
    text = f"<resources>{resources}</resources><build>{build}</build>"
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("[Content_Types].xml", "<Types/>")
        first = f'<?xml version="1.0"?><model unit="{unit}" {CORE}>{text}</model>'
        archive.writestr("3D/3dmodel.model", first)
        for name, more in models.items():
            archive.writestr(
                f"3D/{name}.model", f"<model {CORE}><resources>{more}</resources><build/></model>"
            )
    return out.getvalue()


def write_box(mesh: trimesh.Trimesh, unit: str = "meter") -> bytes:
    """A 3MF file of one mesh, y up as all of ours: its x, z, -y are those of the file."""
    turned = mesh.copy()
    turned.vertices = mesh.vertices[:, [0, 2, 1]] * [1, -1, 1]
    return write_three(f'<object id="1">{write_mesh(turned)}</object>', '<item objectid="1"/>', unit)
