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
    refused(tmp_path / "a.fbx", "ufbx", "pip install 'metagraph-studio[fbx]'")


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
        ("import sys; sys.exit(4)", "reinstall"),
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
