"""Props from files as other programs write them: what is read, what is said of it, and what is refused."""

from __future__ import annotations

import io
import json
import random
import struct
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import trimesh
from PIL import Image

from metagraph.errors import FileError
from metagraph.formats.props.reader import ENDINGS, GREY, read_prop
from metagraph.formats.props.shapes import MOST_TRIANGLES
from tests.formats.props.three_mf_file import write_box
from tests.processes import ROOT

OBJ = """mtllib board.mtl
v 0 0 0
v 1 0 0
v 1 2 0
v 0 2 0
vt 0 0
vt 1 0
vt 1 1
vt 0 1
usemtl paint
f 1/1 2/2 3/3 4/4
"""


def write(path: Path, mesh: trimesh.Trimesh | trimesh.Scene) -> Path:
    path.write_bytes(mesh.export(file_type=path.suffix[1:]))
    return path


def export(mesh: trimesh.Trimesh, ending: str) -> bytes:
    if ending == ".3mf":
        return write_box(mesh)
    data = mesh.export(file_type=ending[1:])
    return data.encode() if isinstance(data, str) else data


@pytest.mark.parametrize("ending", ENDINGS)
def test_a_box_of_each_kind_of_file_is_as_large_as_it_was(tmp_path: Path, ending: str) -> None:
    path = tmp_path / f"box{ending}"
    path.write_bytes(export(trimesh.creation.box((0.5, 0.7, 0.4)), ending))
    mesh = read_prop(path)
    np.testing.assert_allclose(np.ptp(mesh.positions, axis=0), (0.5, 0.7, 0.4), atol=1e-6)
    assert len(mesh.triangles) == 12 and mesh.skeleton.names == ("Prop",) and mesh.notes == ()
    np.testing.assert_allclose(np.linalg.norm(mesh.normals, axis=1), 1, atol=1e-5)
    assert len(mesh.positions) == 24, "each side of a box has corners of its own, so its edges are sharp"


def test_a_ball_is_smooth(tmp_path: Path) -> None:
    mesh = read_prop(write(tmp_path / "ball.stl", trimesh.creation.icosphere(subdivisions=3)))
    np.testing.assert_allclose(mesh.normals, mesh.positions, atol=0.02)


@pytest.mark.parametrize(("factor", "unit"), [(1, ""), (100, "centimetres"), (1000, "millimetres")])
def test_the_unit_of_a_file_that_does_not_say_it_is_told_by_its_size(
    tmp_path: Path, factor: int, unit: str
) -> None:
    chair = trimesh.creation.box(np.array((0.45, 0.9, 0.45)) * factor)
    mesh = read_prop(write(tmp_path / "chair.stl", chair))
    np.testing.assert_allclose(np.ptp(mesh.positions, axis=0), (0.45, 0.9, 0.45), atol=1e-5)
    assert unit in "".join(mesh.notes) and bool(mesh.notes) == bool(unit)


def test_a_glb_is_in_metres_however_large_it_is(tmp_path: Path) -> None:
    mesh = read_prop(write(tmp_path / "hall.glb", trimesh.creation.box((40, 8, 60))))
    np.testing.assert_allclose(np.ptp(mesh.positions, axis=0), (40, 8, 60), atol=1e-4)
    assert mesh.notes == ()


def test_an_obj_has_the_colour_and_the_picture_that_lie_beside_it(tmp_path: Path) -> None:
    (tmp_path / "board.obj").write_text(OBJ, "utf-8")
    (tmp_path / "board.mtl").write_text("newmtl paint\nKd 1 0.5 0\nmap_Kd wood.png\n", "utf-8")
    picture = Image.new("RGB", (2, 2), (10, 200, 30))
    picture.putpixel((0, 0), (255, 0, 0))
    picture.save(tmp_path / "wood.png")
    mesh = read_prop(tmp_path / "board.obj")
    (material,) = mesh.materials
    assert (
        material.image is not None
        and material.color[0] == 1
        and material.color[1] == pytest.approx(0.214, abs=0.01)
    )
    top_left = np.argmin(np.abs(mesh.positions - [0, 2, 0]).sum(1))
    np.testing.assert_allclose(mesh.uvs[top_left], (0, 0), atol=1e-6)  # glTF counts from the top


def test_a_picture_that_is_not_there_is_said_and_the_rest_is_read(tmp_path: Path) -> None:
    (tmp_path / "board.obj").write_text(OBJ, "utf-8")
    mesh = read_prop(tmp_path / "board.obj")
    assert "'board.mtl' is not beside it and was left out" in mesh.notes
    assert len(mesh.triangles) == 2


def test_nothing_outside_the_folder_of_a_prop_is_read(tmp_path: Path) -> None:
    (tmp_path / "secret.mtl").write_text("newmtl paint\nKd 0 1 0\n", "utf-8")
    inside = tmp_path / "inside"
    inside.mkdir()
    (inside / "a.obj").write_text(OBJ.replace("board.mtl", "../secret.mtl"), "utf-8")
    mesh = read_prop(inside / "a.obj")
    assert any("secret.mtl" in note for note in mesh.notes)
    assert mesh.materials[0].color[:3] != pytest.approx((0, 1, 0))


def test_colours_of_triangles_are_kept_and_a_mesh_without_is_grey(tmp_path: Path) -> None:
    box = trimesh.creation.box()
    box.visual.face_colors = [[n * 20, 255 - n * 20, 9, 255] for n in range(12)]
    mesh = read_prop(write(tmp_path / "box.ply", box))
    assert mesh.materials[0].image is not None
    picture = np.asarray(Image.open(io.BytesIO(mesh.materials[0].image)).convert("RGB"))
    found = set()
    for corner in mesh.uvs:
        x, y = (corner * picture.shape[0]).astype(int)
        found.add(tuple(int(v) for v in picture[y, x]))
    assert found == {(n * 20, 255 - n * 20, 9) for n in range(12)}
    assert read_prop(write(tmp_path / "plain.stl", trimesh.creation.box())).materials[0].color == GREY


def test_parts_of_a_scene_stand_where_it_has_them(tmp_path: Path) -> None:
    scene = trimesh.Scene()
    scene.add_geometry(
        trimesh.creation.box((1, 0.1, 1)), transform=trimesh.transformations.translation_matrix([0, 0.7, 0])
    )
    scene.add_geometry(
        trimesh.creation.box((0.1, 0.7, 0.1)),
        transform=trimesh.transformations.translation_matrix([0.4, 0.35, 0]),
    )
    mesh = read_prop(write(tmp_path / "table.glb", scene))
    assert len(mesh.surfaces) == 2
    np.testing.assert_allclose(mesh.positions.min(0), (-0.5, 0, -0.5), atol=1e-6)
    np.testing.assert_allclose(mesh.positions.max(0), (0.5, 0.75, 0.5), atol=1e-6)


def test_triangles_without_an_area_are_left_out_with_a_note(tmp_path: Path) -> None:
    (tmp_path / "a.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 1 2\n", "utf-8")
    mesh = read_prop(tmp_path / "a.obj")
    assert len(mesh.triangles) == 1 and "1 triangle without an area was left out" in mesh.notes


@pytest.mark.nightly
def test_a_huge_mesh_is_drawn_with_fewer_triangles_of_the_same_shape(tmp_path: Path) -> None:
    ball = trimesh.creation.icosphere(subdivisions=7)  # 327,680
    mesh = read_prop(write(tmp_path / "ball.stl", ball))
    assert 20_000 < len(mesh.triangles) <= MOST_TRIANGLES
    assert any("are drawn" in note for note in mesh.notes)
    np.testing.assert_allclose(np.linalg.norm(mesh.positions, axis=1), 1, atol=0.01)


@pytest.mark.parametrize(
    ("name", "content", "why"),
    [
        ("a.fbx", b"x", "not a kind of file"),
        ("a.3mf", b"PK", "cannot be read"),
        ("a.obj", b"hello", "no triangle"),
        ("a.stl", b"", "no triangle|cannot be read"),
        ("a.ply", b"ply\nformat ascii 1.0\nelement vertex 1\n", "cannot be read|no triangle"),
        ("a.glb", b"glTF\x02\0\0\0\xff\0\0\0", "cannot be read"),
        ("a.off", b"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n", "can be drawn|cannot be read"),
        (
            "a.ply",
            b"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
            b"element face 1\nproperty list uchar int vertex_indices\nend_header\n"
            b"nan 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
            "none of its 1 triangles",
        ),
    ],
)
def test_what_cannot_be_read_says_why_and_what_to_do(
    tmp_path: Path, name: str, content: bytes, why: str
) -> None:
    path = tmp_path / name
    path.write_bytes(content)
    with pytest.raises(FileError, match=why) as told:
        read_prop(path)
    assert name in str(told.value) and "Export it as GLB" in str(told.value)


def test_a_file_that_is_not_there_says_so(tmp_path: Path) -> None:
    with pytest.raises(FileError, match=r"gone\.obj"):
        read_prop(tmp_path / "gone.obj")


def test_a_glb_that_names_a_file_elsewhere_is_refused_or_read_without_it(tmp_path: Path) -> None:
    (tmp_path / "secret.bin").write_bytes(np.zeros((3, 3), "<f4").tobytes())
    document = {
        "asset": {"version": "2.0"},
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "buffers": [{"byteLength": 36, "uri": "../secret.bin"}],
    }
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    inside = tmp_path / "inside"
    inside.mkdir()
    glb = struct.pack("<4sIIII", b"glTF", 2, 20 + len(text), len(text), 0x4E4F534A) + text
    (inside / "a.glb").write_bytes(glb)
    with pytest.raises(FileError):
        read_prop(inside / "a.glb")


@pytest.mark.parametrize("ending", ENDINGS)
def test_files_with_bytes_changed_are_read_or_refused(tmp_path: Path, ending: str) -> None:
    sound = export(trimesh.creation.box(), ending)
    chance, path = random.Random(7), tmp_path / f"a{ending}"
    for _ in range(60):
        broken = bytearray(sound)
        for _ in range(chance.choice((1, 2, 8))):
            broken[chance.randrange(len(broken))] = chance.randrange(256)
        path.write_bytes(broken[: chance.choice((len(broken), chance.randrange(len(broken))))])
        try:
            mesh = read_prop(path)
        except FileError:
            continue
        assert np.isfinite(mesh.positions).all() and np.isfinite(mesh.normals).all()


def test_colours_are_read_without_scipy_which_users_do_not_have(tmp_path: Path) -> None:
    box = trimesh.creation.box()
    box.visual.face_colors = [[n * 20, 9, 9, 255] for n in range(12)]
    path = write(tmp_path / "box.ply", box)
    code = (
        "import sys; sys.modules['scipy'] = None\n"
        "from metagraph.formats.props.reader import read_prop\n"
        f"print(read_prop({str(path)!r}).materials[0].image is not None)"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, timeout=60, check=False
    )
    assert done.stdout.strip() == "True", done.stderr
