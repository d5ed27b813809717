"""FBX, read in a process of its own."""

from __future__ import annotations

import importlib.util
import os
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from metagraph.errors import FileError
from metagraph.formats.clips import import_clips, read_clips
from metagraph.formats.fbx import processes as fbx_readers
from metagraph.formats.fbx import reader as fbx
from metagraph.formats.gltf.reader import write_glb
from metagraph.motion.roles import find_roles, is_humanoid

needs_ufbx = pytest.mark.skipif(
    importlib.util.find_spec("ufbx") is None, reason="the extra metagraph-studio[fbx] is not installed"
)
KAYDARA = b"Kaydara FBX Binary  \x00\x1a\x00" + (7400).to_bytes(4, "little")


# A reader of files that does what their names say, and tells how often it was started.
ANSWER = """
import json, os, struct, sys, time
def answer(data, code=0):
    sys.stdin.buffer.readline()
    sys.stdout.buffer.write(struct.pack("<Bq", code, len(data)) + data); sys.stdout.flush()
"""
READER = """
import json, os, struct, sys, time
open({log!r}, "a").write("started\\n")
glb = open({glb!r}, "rb").read()
for line in sys.stdin.buffer:
    name = os.path.basename(json.loads(line))
    if name.startswith("crash"):
        os.kill(os.getpid(), 11)
    if name.startswith("hang"):
        time.sleep(60)
    code, data = (3, b"broken") if name.startswith("broken") else (0, glb)
    sys.stdout.buffer.write(struct.pack("<Bq", code, len(data)) + data)
    sys.stdout.flush()
"""


def refused(path: Path, *words: str) -> None:
    with pytest.raises(FileError) as caught:
        read_clips(path)
    assert caught.value.cause and caught.value.remedy
    for word in words:
        assert word in str(caught.value)


def test_without_the_library_the_error_says_what_to_install(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "a.fbx").write_bytes(KAYDARA)
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    refused(tmp_path / "a.fbx", "ufbx", "pip install", "Help > Extras")


@needs_ufbx
@pytest.mark.parametrize(
    "content", [KAYDARA, KAYDARA + b"\xff" * 200, b"; FBX 7.4.0 project file\nObjects: {"]
)
def test_a_broken_file_is_refused(tmp_path: Path, content: bytes) -> None:
    (tmp_path / "a.fbx").write_bytes(content)
    refused(tmp_path / "a.fbx")


@needs_ufbx
def test_a_file_without_motion_is_refused(tmp_path: Path) -> None:
    (tmp_path / "a.fbx").write_text(
        "; FBX 7.4.0 project file\nFBXHeaderExtension:  {\n\tFBXVersion: 7400\n}\nObjects:  "
        "{\n}\nConnections:  {\n}\n"
    )
    refused(tmp_path / "a.fbx", "no animation")


@needs_ufbx
@pytest.mark.parametrize(
    ("program", "words"),
    [
        ("import os; os.kill(os.getpid(), 11)", "crashed"),
        ("import time; time.sleep(60)", "within"),
        ("import sys; print('odd', file=sys.stderr); sys.exit(9)", "could not be converted (odd)"),
        ("import sys; sys.exit(4)", "install it again"),
        ("print('neither glTF nor an answer')", "talks nonsense"),
        (ANSWER + "answer(b'no glTF')", "neither a binary nor a text"),
    ],
)
@pytest.mark.skipif(sys.platform == "win32", reason="signals differ")
def test_a_child_that_dies_hangs_or_talks_nonsense_costs_one_file_only(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, program: str, words: str
) -> None:
    fake = tmp_path / "python"
    fake.write_text(f"#!{sys.executable}\n{program}\n")
    fake.chmod(0o755)
    (tmp_path / "a.fbx").write_bytes(KAYDARA)
    monkeypatch.setattr(sys, "executable", str(fake))
    with pytest.raises(FileError) as caught:
        fbx.read_fbx_clips(tmp_path / "a.fbx", timeout=1.0)
    assert words in str(caught.value) and caught.value.remedy


@pytest.mark.nightly
@needs_ufbx
@pytest.mark.skipif(sys.platform == "win32", reason="signals differ")
def test_of_many_files_one_that_crashes_hangs_or_is_broken_fails_alone(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, toy: Any
) -> None:
    log = tmp_path / "log"
    write_glb(tmp_path / "made.glb", [toy.clip("walk", 0.5)])
    fake = tmp_path / "python"
    program = READER.format(log=str(log), glb=str(tmp_path / "made.glb"))
    fake.write_text(f"#!{sys.executable}\n{program}\n")
    fake.chmod(0o755)
    names = [f"a{n}" for n in range(8)] + ["broken", "crash", "hang"] + [f"z{n}" for n in range(8)]
    for name in names:
        (tmp_path / f"{name}.fbx").write_bytes(KAYDARA)
    monkeypatch.setattr(sys, "executable", str(fake))
    monkeypatch.setattr(fbx.read_fbx_clips, "__defaults__", (5.0, ()))
    monkeypatch.setattr(os, "cpu_count", lambda: 2)
    report = import_clips([tmp_path / f"{name}.fbx" for name in names])
    assert [p.stem for p, _, _ in report.clips] == [n for n in names if n[0] in "az"]
    told = {f.path.stem: f.cause for f in report.failures}
    assert "broken" in told["broken"] and "crashed" in told["crash"] and "within" in told["hang"]
    # Two at once, one more after each that died, and one that proves the crash is the file's own.
    assert len(log.read_text().splitlines()) <= 5
    assert not fbx_readers._idle


@pytest.mark.nightly
@needs_ufbx
def test_files_read_one_after_another_by_one_process_are_as_read_alone(
    shared_data: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    files = sorted((shared_data / "mesh2motion-cmu").glob("*.fbx")) + sorted(
        (shared_data / "fbx-pab").glob("*.fbx")
    )
    alone = [read_clips(f)[0] for f in files[-3:]]
    monkeypatch.setattr(os, "cpu_count", lambda: 1)
    together = import_clips([*files, *files])
    assert not together.failures and len(together.clips) == 2 * len(files)
    for own, (_, _, other) in zip(alone, together.clips[-3:], strict=True):
        np.testing.assert_array_equal(own.rotations, other.rotations)


@needs_ufbx
@pytest.mark.parametrize(
    ("file", "tall"),
    [("fbx-pab/crossarms.fbx", 1.8), ("fbx-pab/walk.fbx", 1.8), ("mesh2motion-cmu/91_48.fbx", 1.5)],
)
def test_real_files_are_people_in_metres_with_y_up(shared_data: Path, file: str, tall: float) -> None:
    (clip,) = read_clips(shared_data / file)
    roles = find_roles(clip.skeleton)
    assert clip.fps == 30 and clip.name == Path(file).stem and is_humanoid(roles)
    _, positions = clip.skeleton.globals(clip.poses())
    assert np.ptp(positions[..., 1], axis=1).max() == pytest.approx(tall, abs=0.25)
    assert (positions[:, roles["head"], 1] > positions[:, roles["left_foot"], 1] + 1).all()


@needs_ufbx
def test_joints_stand_where_the_library_itself_puts_them(shared_data: Path) -> None:
    import ufbx

    path = shared_data / "fbx-pab" / "walk.fbx"
    (clip,) = read_clips(path)
    scene = ufbx.load_file(str(path), target_unit_meters=1.0, target_axes=ufbx.axes_right_handed_y_up)
    stacks = list(scene.anim_stacks)
    frame = 12
    posed = ufbx.evaluate_scene(scene, stacks[0].anim, frame / 30)
    nodes = list(posed.nodes)
    _, positions = clip.skeleton.globals(clip.poses()[frame])
    for node in nodes:
        if node.name in clip.skeleton:
            t = node.node_to_world.c3
            np.testing.assert_allclose(
                positions[clip.skeleton.index(node.name)], (t.x, t.y, t.z), atol=1e-3, err_msg=node.name
            )


@needs_ufbx
def test_clips_of_one_actor_share_a_skeleton(shared_data: Path) -> None:
    files = [shared_data / "mesh2motion-cmu" / f"91_{n}.fbx" for n in (48, 52)]
    assert len({read_clips(f)[0].skeleton.fingerprint for f in files}) == 1


TIME = 46186158000  # FBX's units in a second


def fbx_face(mode: int) -> str:
    """Return a text FBX of one bone that turns for a second and a mesh whose jaw opens, a shape that never
    moves beside it. mode: the number of the file's frame rate.
    """

    def curve(number: int, last: float) -> str:
        return (
            f'AnimationCurve: {number}, "AnimCurve::", "" {{\n KeyVer: 4008\n KeyTime: *2 {{ a: 0,{TIME} }}\n'
            f" KeyValueFloat: *2 {{ a: 0,{last} }}\n KeyAttrFlags: *1 {{ a: 4 }}\n"
            " KeyAttrDataFloat: *4 { a: 0,0,0,0 }\n KeyAttrRefCount: *1 { a: 2 }\n}\n"
        )

    def shape(number: int, name: str) -> str:
        return (
            f'Geometry: {number}, "Geometry::{name}", "Shape" {{\n Indexes: *1 {{ a: 0 }}\n'
            " Vertices: *3 { a: 0,-1,0 }\n}\n"
            f'Deformer: {number + 1}, "SubDeformer::head.{name}", "BlendShapeChannel" {{\n DeformPercent: 0\n'
            " FullWeights: *1 { a: 100 }\n}\n"
        )

    links = [
        (10, 0), (11, 10), (20, 0), (21, 20), (22, 21), (31, 22), (30, 31), (33, 22), (32, 33), (41, 40),
    ]  # fmt: skip
    named = [(42, 41, ""), (42, 10, "Lcl Rotation"), (43, 42, "d|X"), (44, 41, ""), (44, 31, "DeformPercent")]
    named.append((45, 44, "d|DeformPercent"))
    connections = [f'C: "OO",{a},{b}' for a, b in links]
    connections += [f'C: "OP",{a},{b},"{name}"' if name else f'C: "OO",{a},{b}' for a, b, name in named]
    return (
        "; FBX 7.4.0 project file\nFBXHeaderExtension:  {\n FBXVersion: 7400\n}\n"
        f'GlobalSettings: {{\n Version: 1000\n Properties70: {{\n  P: "TimeMode", "enum", "", "",{mode}\n'
        '  P: "UnitScaleFactor", "double", "Number", "",100\n }\n}\nObjects:  {\n'
        'Model: 10, "Model::Head", "LimbNode" {\n Version: 232\n}\n'
        'NodeAttribute: 11, "NodeAttribute::Head", "LimbNode" {\n TypeFlags: "Skeleton"\n}\n'
        'Model: 20, "Model::Mesh", "Mesh" {\n Version: 232\n}\n'
        'Geometry: 21, "Geometry::Mesh", "Mesh" {\n Vertices: *9 { a: 0,0,0,1,0,0,0,1,0 }\n'
        " PolygonVertexIndex: *3 { a: 0,1,-3 }\n}\n"
        'Deformer: 22, "Deformer::head", "BlendShape" {\n}\n' + shape(30, "jawOpen") + shape(32, "cheekPuff")
        + 'AnimationStack: 40, "AnimStack::nod", "" {\n Properties70: {\n'
        '  P: "LocalStart", "KTime", "Time", "",0\n'
        f'  P: "LocalStop", "KTime", "Time", "",{TIME}\n }}\n}}\n'
        'AnimationLayer: 41, "AnimLayer::base", "" {\n}\n'
        'AnimationCurveNode: 42, "AnimCurveNode::R", "" {\n}\n' + curve(43, 40.0)
        + 'AnimationCurveNode: 44, "AnimCurveNode::DeformPercent", "" {\n}\n' + curve(45, 60.0)
        + "}\nConnections:  {\n" + "\n".join(connections) + "\n}\n"
    )  # fmt: skip


@needs_ufbx
def test_blend_shapes_that_move_come_along_by_their_own_names(tmp_path: Path) -> None:
    (tmp_path / "a.fbx").write_text(fbx_face(3))
    (clip,) = read_clips(tmp_path / "a.fbx")
    assert clip.morphs == ("jawOpen",) and clip.weights is not None
    assert clip.weights[:, 0] == pytest.approx(np.linspace(0, 0.6, 61), abs=1e-5)
    assert clip.skeleton.names == ("Head",)


@needs_ufbx
@pytest.mark.parametrize(("mode", "fps"), [(3, 60.0), (11, 24.0), (6, 30.0), (1, 120.0)])
def test_takes_keep_their_file_s_rate(tmp_path: Path, mode: int, fps: float) -> None:
    (tmp_path / "a.fbx").write_text(fbx_face(mode))
    (clip,) = read_clips(tmp_path / "a.fbx")
    assert clip.fps == fps and clip.frames == round(fps) + 1
