"""Twenty odd files of props: each is read with a word about what is odd, or refused with its reason."""

from __future__ import annotations

import struct
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import trimesh
from PIL import Image

from metagraph.errors import FileError
from metagraph.formats.props.reader import read_prop
from metagraph.formats.props.shapes import MOST_TRIANGLES
from tests.processes import ROOT

BOX = trimesh.creation.box((1, 1, 1))


def write_obj(points: object, sides: object) -> bytes:
    lines = [f"v {' '.join(map(str, p))}" for p in points]  # type: ignore[attr-defined]
    lines += [f"f {' '.join(str(n + 1) for n in side)}" for side in sides]  # type: ignore[attr-defined]
    return "\n".join(lines).encode()


def write_stl(mesh: trimesh.Trimesh) -> bytes:
    return bytes(mesh.export(file_type="stl"))


def move(x: float) -> trimesh.Trimesh:
    out = BOX.copy()
    out.apply_translation((x, 0, 0))
    return out


def scale(by: float) -> trimesh.Trimesh:
    out = BOX.copy()
    out.apply_scale(by)
    return out


def turn_inside_out() -> trimesh.Trimesh:
    out = BOX.copy()
    out.invert()
    return out


FAN = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (0, -1, 0)]
PLAIN = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]
PLY_LINES = (
    b"ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
    b"element edge 1\nproperty int vertex1\nproperty int vertex2\nend_header\n0 0 0\n1 0 0\n0 1\n"
)
# What is read: the file, its triangles, its largest side in metres, and the words about it.
READ = {
    "nonmanifold.obj": (write_obj(FAN, [(0, 1, 2), (0, 1, 3), (0, 1, 4)]), 3, 2.0, ""),
    "no_normals.ply": (
        trimesh.creation.icosphere(2).export(file_type="ply", vertex_normal=False), 320, 2.0, "",
    ),
    "millimetres.stl": (write_stl(trimesh.creation.box((750, 720, 1400))), 12, 1.4, "millimetres"),
    "inverted.stl": (write_stl(turn_inside_out()), 12, 1.0, "inside out"),
    "nan.obj": (write_obj([*PLAIN, ("nan", 0, 0)], [(0, 1, 2), (0, 1, 3)]), 1, 1.0, "1 triangle without"),
    "one_triangle.obj": (write_obj(PLAIN, [(0, 1, 2)]), 1, 1.0, ""),
    "far_away.stl": (write_stl(move(5000)), 12, 1.0, "5,000 m away"),
    "flat.obj": (write_obj([(0, 0, 0), (1, 0, 0), (1, 0, 1), (0, 0, 1)], [(0, 1, 2), (0, 2, 3)]), 2, 1.0, ""),
    "tiny.stl": (write_stl(scale(1e-4)), 12, 1e-4, "0.1 mm"),
    "polygon.obj": (b"v 0 0 0\nv 1 0 0\nv 1 0 1\nv .5 0 1.5\nv 0 0 1\nf 1 2 3 4 5\n", 3, 1.5, ""),
    "twice.stl": (write_stl(trimesh.util.concatenate([BOX, BOX])), 24, 1.0, ""),
    "open.stl": (write_stl(trimesh.Trimesh(BOX.vertices, BOX.faces[:-2], process=False)), 10, 1.0, ""),
}  # fmt: skip
REFUSED = {
    "empty.obj": (b"", "no triangle"),
    "points_only.obj": (write_obj(BOX.vertices.tolist(), []), "no triangle"),
    "all_degenerate.obj": (
        write_obj([(0, 0, 0), (1, 0, 0), (2, 0, 0)], [(0, 1, 2), (0, 0, 1)]), "none of its 2"
    ),
    "out_of_range.obj": (write_obj(PLAIN, [(0, 1, 9)]), "cannot be read|none of its"),
    "truncated.stl": (write_stl(BOX)[:300], "no triangle|cannot be read"),
    "truncated.glb": (bytes(trimesh.Scene(BOX).export(file_type="glb"))[:200], "cannot be read"),
    "picture.ply": (b"\x89PNG\r\n\x1a\n" + bytes(range(256)) * 8, "cannot be read"),
    "lines.ply": (PLY_LINES, "no triangle"),
    "hostile_count.stl": (b"\0" * 80 + struct.pack("<I", 2**31) + b"\0" * 50, "no triangle|cannot be read"),
    "huge_numbers.obj": (write_obj([(0, 0, 0), (1e30, 0, 0), (0, 1e30, 0)], [(0, 1, 2)]), "m large"),
}  # fmt: skip


@pytest.mark.parametrize("name", READ)
def test_it_is_read_and_what_is_odd_is_said(tmp_path: Path, name: str) -> None:
    content, count, size, words = READ[name]
    path = tmp_path / name
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    mesh = read_prop(path)
    assert len(mesh.triangles) == count
    assert float(np.ptp(mesh.positions, axis=0).max()) == pytest.approx(size, rel=0.01)
    assert np.abs(mesh.positions).max() < 3 and np.isfinite(mesh.normals).all()
    said = "; ".join(map(str, mesh.notes))
    assert (words in said) if words else said == ""


@pytest.mark.parametrize("name", REFUSED)
def test_it_is_refused_and_the_reason_is_said(tmp_path: Path, name: str) -> None:
    content, why = REFUSED[name]
    (tmp_path / name).write_bytes(content)
    with pytest.raises(FileError, match=why):
        read_prop(tmp_path / name)


def test_what_has_a_hole_is_seen_from_both_sides_and_what_was_inside_out_from_outside(tmp_path: Path) -> None:
    for name, double in (("open.stl", True), ("flat.obj", True), ("inverted.stl", False)):
        (tmp_path / name).write_bytes(READ[name][0])  # type: ignore[arg-type]
        mesh = read_prop(tmp_path / name)
        assert mesh.materials[0].double_sided == double, name
    assert (np.einsum("ij,ij->i", mesh.positions, mesh.normals) > 0).all()


def test_a_picture_that_is_too_large_is_reduced_and_that_is_said(tmp_path: Path) -> None:
    Image.new("RGB", (4096, 1024)).save(tmp_path / "large.png")
    (tmp_path / "a.mtl").write_text("newmtl a\nmap_Kd large.png\n")
    (tmp_path / "a.obj").write_text(
        "mtllib a.mtl\nusemtl a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n"
    )
    mesh = read_prop(tmp_path / "a.obj")
    assert [str(note) for note in mesh.notes] == ["its picture of 4,096 × 1,024 pixels was reduced to 2,048"]


@pytest.mark.nightly
def test_two_million_triangles_are_simplified(tmp_path: Path) -> None:
    code = f"""
import numpy as np, resource, trimesh
n = 1000
x, z = np.meshgrid(np.linspace(0, 1, n + 1), np.linspace(0, 1, n + 1))
points = np.stack([x, 0.1 * np.sin(9 * x), z], -1).reshape(-1, 3)
i = np.arange(n * n); r = i // n * (n + 1) + i % n
sides = np.concatenate([np.stack([r, r + n + 1, r + 1], 1), np.stack([r + 1, r + n + 1, r + n + 2], 1)])
rows = np.zeros(len(sides), [("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("more", "<u2")])
rows["corners"] = points[sides]
content = bytes(80) + np.uint32(len(sides)).tobytes() + rows.tobytes()
open({str(tmp_path / "large.stl")!r}, "wb").write(content)
"""
    subprocess.run([sys.executable, "-c", code], check=True)
    read = (
        "import resource, sys; from metagraph.formats.props.reader import read_prop; "
        "m = read_prop(sys.argv[1]); print(len(m.triangles), *m.notes); "
        "print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)"
    )
    done = subprocess.run(
        [sys.executable, "-c", read, str(tmp_path / "large.stl")],
        check=True, capture_output=True, text=True, cwd=ROOT,
    )  # fmt: skip
    first, peak = done.stdout.strip().splitlines()
    assert 10_000 < int(first.split()[0]) <= MOST_TRIANGLES and "2,000,000 triangles" in first
    assert int(peak) < 1.8e6, f"{int(peak) / 1e6:.2f} GB"
