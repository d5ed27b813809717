"""3MF: units, colours, objects in objects, and what is refused."""

from __future__ import annotations

import io
import zipfile
from pathlib import Path

import numpy as np
import pytest
import trimesh

from metagraph.errors import FileError
from metagraph.formats.props.reader import read_prop
from tests.formats.props.three_mf_file import write_box, write_mesh, write_three

BOX = trimesh.creation.box((2, 3, 4))
MESH = f'<object id="1">{write_mesh(BOX)}</object>'


def read(folder: Path, content: bytes) -> object:
    path = folder / "a.3mf"
    path.write_bytes(content)
    return read_prop(path)


@pytest.mark.parametrize(
    ("unit", "factor"),
    [("millimeter", 1e-3), ("centimeter", 0.01), ("inch", 0.0254), ("foot", 0.3048), ("meter", 1.0)],
)
def test_the_unit_is_the_files_and_z_is_up(tmp_path: Path, unit: str, factor: float) -> None:
    mesh = read(tmp_path, write_three(MESH, '<item objectid="1"/>', unit))
    np.testing.assert_allclose(np.ptp(mesh.positions, axis=0), np.array([2, 4, 3]) * factor, rtol=1e-5)
    assert mesh.notes == () and len(mesh.triangles) == 12
    outwards = np.einsum("ij,ij->i", mesh.positions, mesh.normals)
    assert (outwards > 0).all(), "it is not inside out"


def test_objects_in_objects_stand_where_their_transforms_have_them(tmp_path: Path) -> None:
    both = (
        f'{MESH}<object id="2"><components><component objectid="1"/>'
        '<component objectid="1" transform="1 0 0 0 1 0 0 0 1 10 0 0"/></components></object>'
    )
    item = '<item objectid="2" transform="-1 0 0 0 1 0 0 0 1 0 0 5"/>'
    mesh = read(tmp_path, write_three(both, item, "meter"))
    assert len(mesh.triangles) == 24
    np.testing.assert_allclose(mesh.positions.min(0), [-11, 3, -1.5], atol=1e-5)
    np.testing.assert_allclose(mesh.positions.max(0), [1, 7, 1.5], atol=1e-5)
    assert "it was inside out and was turned" not in mesh.notes, "a mirrored part is turned when it is read"


def test_a_component_may_be_in_another_model(tmp_path: Path) -> None:
    away = 'xmlns:p="http://schemas.microsoft.com/3dmanufacturing/production/2015/06"'
    outer = (
        f'<object id="2"><components><component {away} p:path="/3D/part.model" objectid="1"/>'
        "</components></object>"
    )
    mesh = read(tmp_path, write_three(outer, '<item objectid="2"/>', "meter", part=MESH))
    assert len(mesh.triangles) == 12


def test_triangles_have_the_colours_of_their_palette(tmp_path: Path) -> None:
    palette = (
        '<basematerials id="9"><base name="a" displaycolor="#FF0000"/>'
        '<base name="b" displaycolor="#00FF00FF"/></basematerials>'
    )
    paint = [0, 1] * 6
    two = f'{palette}<object id="1">{write_mesh(BOX, paint)}</object>'
    mesh = read(tmp_path, write_three(two, '<item objectid="1"/>'))
    assert mesh.materials[0].image is not None
    one = f'{palette}<object id="1" pid="9" pindex="1">{write_mesh(BOX)}</object>'
    mesh = read(tmp_path, write_three(one, '<item objectid="1"/>'))
    assert mesh.materials[0].image is None and mesh.materials[0].color[:3] == pytest.approx((0, 1, 0))


@pytest.mark.parametrize(
    ("content", "why"),
    [
        (write_three("", ""), "no triangle"),
        (write_three("", '<item objectid="7"/>'), "no object 7"),
        (write_three(MESH, '<item objectid="1" transform="1 2 3"/>'), "12 numbers"),
        (
            write_three(
                '<object id="1"><components><component objectid="1"/></components></object>',
                '<item objectid="1"/>',
            ),
            "too deep",
        ),
        (write_box(BOX)[:90], "zip"),
    ],
    ids=["empty", "missing object", "short transform", "in itself", "cut off"],
)
def test_broken_files_are_refused(tmp_path: Path, content: bytes, why: str) -> None:
    with pytest.raises(FileError, match=why):
        read(tmp_path, content)


def test_entities_and_models_that_unpack_to_too_much_are_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w") as archive:
        archive.writestr("3D/3dmodel.model", '<!DOCTYPE m [<!ENTITY a "aa">]><model/>')
    with pytest.raises(FileError, match="entities"):
        read(tmp_path, out.getvalue())
    monkeypatch.setattr("metagraph.formats.props.reader.PROP_FILE", 2000)
    with pytest.raises(FileError, match="too large"):
        read(tmp_path, write_three(MESH * 3, '<item objectid="1"/>'))
