"""Names that lead to another computer or a device: known on every system, and never opened unasked."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from pathlib import Path

import msgspec
import pytest

from metagraph.common import network_paths
from metagraph.common.network_paths import (
    close_path,
    explain_refusal,
    is_closed,
    make_escape_check,
    recover_original_path,
)
from metagraph.errors import FileError
from metagraph.formats.gltf.reader import read_gltf_clips
from metagraph.formats.project.paths import list_closed_paths, make_paths_absolute, move_project, reopen_paths
from metagraph.formats.store import open_project, read_project, save_project
from metagraph.research.study.study_plan import parse_study_plan

STUDY = Path(__file__).parents[2] / "sample_clips" / "study" / "study.yaml"
STRANGE = [
    r"\\server\share\x.bvh", "//server/share/x.bvh", r"\/server/share/x.bvh", r"/\server\share\x.bvh",
    "///server/share/x.bvh", r" \\server\share\x.bvh", r"\\?\UNC\server\share\x.bvh",
    "//?/UNC/server/share/x.bvh", r"\\?\C:\x.bvh", r"\\.\pipe\x", "//./pipe/x", r"\??\C:\x",
    r"clips\\server\share\x.bvh", r"clips/\\server\share\x.bvh", "smb://server/share/x.bvh",
    "file://server/share/x.bvh", "file:///etc/passwd", "FILE:/x.bvh", "http://server/x.bvh",
    "nfs://server/x", r"davs:\server\x", "/net/server/x.bvh", "CON", "nul", "NUL.bvh", "clips/aux.glb",
    "com1", "LPT9.wav", "prn ", r"clips\con\x.bvh", "CONIN$", "nul:",
]  # fmt: skip
ORDINARY = [
    "x.bvh", "clips/x.bvh", "../x.bvh", r"clips\x.bvh", r"C:\clips\x.bvh", "C:/clips/x.bvh",
    "/home/me/x.bvh", "clips//x.bvh", "control.bvh", "nullify/x.bvh", "com10.bvh", "my con.bvh", "a:b.bvh",
    "netz/x.bvh", "été/ä.glb", ".not-opened/x.bvh",
]  # fmt: skip


@pytest.fixture(autouse=True)
def not_allowed() -> Iterator[None]:
    network_paths.allow(False)
    yield
    network_paths.allow(False)


@pytest.mark.parametrize("name", STRANGE)
def test_a_strange_name_is_known_closed_and_given_back_as_it_was(name: str) -> None:
    assert explain_refusal(name) is not None
    path = close_path(name)
    assert is_closed(path) and recover_original_path(path) == name
    assert explain_refusal(path) is None and not Path(path).is_absolute() and ".." not in Path(path).parts
    network_paths.allow(True)
    assert close_path(name) == name


@pytest.mark.parametrize("name", ORDINARY)
def test_an_ordinary_name_stays_as_it_is(name: str) -> None:
    assert explain_refusal(name) is None and close_path(name) == name and recover_original_path(name) == name


def _project(folder: Path, name: str) -> Path:
    """Write a project that names a file in each place that can name one."""
    folder.mkdir(exist_ok=True)
    path = folder / "p.metagraph.yaml"
    said = msgspec.json.encode(name).decode()
    path.write_text(
        "metagraph: 1\nname: p\n"
        f"character: {said}\n"
        f"clips:\n- {{id: c1, name: walk, path: {said}}}\n"
        f"lines:\n  l1: {{text: hello, audio: {said}, phones: {said}}}\n"
        "conversations:\n  t1:\n    name: talk\n    length: 5\n"
        f"    sides: [{{audio: {said}, project: {said}, character: {said}}}, {{name: other}}]\n"
    )
    return path


@pytest.mark.parametrize("name", STRANGE)
def test_a_project_touches_none_of_them_and_saves_them_as_they_were(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    path = _project(tmp_path / "a", name)
    touched: list[str] = []
    opened = os.open
    monkeypatch.setattr(os, "open", lambda p, *more, **k: touched.append(str(p)) or opened(p, *more, **k))
    found = open_project(path)
    assert list_closed_paths(found.project) == (name,)
    assert any("were not opened" in note for note in found.notes)
    assert not any("missing" in note for note in found.notes)
    assert touched and all(t == str(path) for t in touched)
    save_project(found.project, path)
    text = path.read_text()
    assert network_paths.FOLDER not in text
    assert reopen_paths(read_project(path)).clips["c1"].path == name
    for project in (
        move_project(found.project, path, tmp_path / "b" / "q.metagraph.yaml"),
        make_paths_absolute(found.project, tmp_path),
    ):
        save_project(project, tmp_path / "q.metagraph.yaml")
        assert list_closed_paths(read_project(tmp_path / "q.metagraph.yaml")) == (name,)


def test_a_file_that_is_there_is_opened_only_when_that_is_allowed(tmp_path: Path) -> None:
    """On Linux two slashes lead to a file of this computer: it is the same name elsewhere."""
    from metagraph.formats.bvh.file import write_bvh
    from tests.fuzz.test_clip_files import sample

    clip, _ = sample()
    write_bvh(clip, tmp_path / "walk.bvh")
    path = _project(tmp_path / "a", "/" + str(tmp_path / "walk.bvh"))
    assert open_project(path).project.clips["c1"].motion is None
    network_paths.allow(True)
    assert open_project(path).project.clips["c1"].motion is not None


def _gltf(uri: str) -> bytes:
    """Return a glTF file whose numbers are in another one."""
    document = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"name": "a"}],
        "buffers": [{"uri": uri, "byteLength": 8}], "bufferViews": [{"buffer": 0, "byteLength": 8}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 2, "type": "SCALAR"}],
        "animations": [{"samplers": [{"input": 0, "output": 0}],
                        "channels": [{"sampler": 0, "target": {"node": 0, "path": "rotation"}}]}],
    }  # fmt: skip
    return msgspec.json.encode(document)


@pytest.mark.parametrize(
    "uri",
    [r"\\server\x.bin", "%5C%5Cserver%5Cx.bin", "//server/x.bin", "%2F/server/x.bin", "file://server/x.bin"],
)
def test_a_gltf_file_never_names_another_computer(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, uri: str
) -> None:
    network_paths.allow(True)  # not even then: its files lie beside it
    path = tmp_path / "a.gltf"
    path.write_bytes(_gltf(uri))
    looked: list[str] = []
    resolve = Path.resolve
    monkeypatch.setattr(Path, "resolve", lambda p, strict=False: looked.append(str(p)) or resolve(p, strict))
    with pytest.raises(FileError, match="was not opened"):
        read_gltf_clips(path)
    assert not any("server" in p for p in looked)


@pytest.mark.parametrize("name", [r"\\server\share", "//server/share"])
def test_a_study_names_none_unless_that_is_allowed(name: str) -> None:
    text = re.sub(r"(?m)^  clips:\n(  - .*\n)+", lambda _: f"  clips: '{name}'\n", STUDY.read_text(), count=1)
    with pytest.raises(FileError, match="another computer"):
        parse_study_plan(text)
    network_paths.allow(True)
    parse_study_plan(text)


def _climbing(folder: Path) -> list[str]:
    """Names that lead from a folder to where systems reach other computers, and links there."""
    folder.mkdir(parents=True, exist_ok=True)
    up = "../" * (len(folder.resolve().parts) - 1)
    for name, target in (
        ("far", "/net/server/share"),
        ("root", up + "."),
        ("twice", "far"),
        ("x.bvh", "/afs/cell/x.bvh"),
    ):
        (folder / name).symlink_to(target)
    return [
        f"{up}net/server/x.bvh", f"{up}../../net/server/x.bvh", f"a/../{up}/net//server/x.bvh",
        up.replace("/", "\\") + r"misc\server\x.bvh", f"./{up}./afs/cell/x.bvh", f"{up}Network/server/x.bvh",
        "far/x.bvh", "root/net/server/x.bvh", "twice/x.bvh", "x.bvh", str(folder / "far" / "x.bvh"),
    ]  # fmt: skip


@pytest.mark.skipif(os.name == "nt", reason="such places and links are of other systems")
def test_what_climbs_to_another_computer_is_closed_too(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    touched: list[str] = []
    opened, read_link = os.open, os.readlink
    monkeypatch.setattr(os, "open", lambda p, *more, **k: touched.append(str(p)) or opened(p, *more, **k))
    names = _climbing(tmp_path / "a")
    monkeypatch.setattr(os, "readlink", lambda p: touched.append(str(p)) or read_link(p))
    for name in names:
        path = _project(tmp_path / "a", name)
        found = open_project(path)
        assert list_closed_paths(found.project) == (name,)
        assert any("another computer" in note for note in found.notes)
        save_project(found.project, path)
        text = path.read_text()
        assert network_paths.FOLDER not in text
        assert reopen_paths(read_project(path)).clips["c1"].path == name
    outside = re.compile(r"/(net|misc|afs|Network)/")
    assert not any(outside.match(os.path.normpath(t)) for t in touched)
    network_paths.allow(True)
    assert not list_closed_paths(open_project(path).project)


def test_folders_of_such_names_elsewhere_are_ordinary(tmp_path: Path) -> None:
    for name in ("net/server/x.bvh", "../misc/x.bvh", "../net/a/x.bvh", "loop/x.bvh", "a\0b", "../../x"):
        assert explain_refusal(name, tmp_path / "a") is None
    if os.name != "nt":
        (tmp_path / "loop").symlink_to("loop")
        assert explain_refusal("loop/x.bvh", tmp_path) is None


@pytest.mark.skipif(os.name == "nt", reason="such places are of other systems")
def test_a_project_that_lies_on_another_computer_reaches_its_own_files() -> None:
    away = make_escape_check(Path("/net/server/share/project"))
    assert not away("clips/x.bvh") and not away("../x.bvh") and not away("/net/server/x.bvh")
    assert away("../../../other/x.bvh") and away("/net/other/x.bvh") and away("/afs/server/x.bvh")


@pytest.mark.skipif(os.name == "nt", reason="such places and links are of other systems")
def test_other_files_that_climb_there_are_refused(tmp_path: Path) -> None:
    names = _climbing(tmp_path)
    name = names[0]
    text = re.sub(r"(?m)^  clips:\n(  - .*\n)+", lambda _: f"  clips: '{name}'\n", STUDY.read_text(), count=1)
    with pytest.raises(FileError, match="another computer"):
        parse_study_plan(text, tmp_path / "study.yaml")
    (tmp_path / "a.gltf").write_bytes(_gltf(name))
    with pytest.raises(FileError, match="another computer"):
        read_gltf_clips(tmp_path / "a.gltf")
