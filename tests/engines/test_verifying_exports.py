"""Verifying an export reports each file that is not the one that was written, and of exports that were
interrupted.
"""

from __future__ import annotations

import dataclasses
import json
import os
import shutil
from pathlib import Path

import msgspec
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from metagraph.engines.targets import registry
from metagraph.engines.targets.placing import RECORD, STAGED, ExportRecord, Staging, read_record
from metagraph.engines.targets.target import Contents
from metagraph.engines.verifying_exports import verify
from metagraph.errors import FileError
from metagraph.formats.clips import digest
from metagraph.formats.store import SUFFIX, save_project
from metagraph.graph import edits
from metagraph.graph.model import Project
from metagraph.graph.requests import Line
from tests.wavs import wav

OLD = Path(__file__).parent / "old" / "1"


@pytest.fixture
def game(tmp_path: Path, toy) -> Path:
    """An export with a line's sound."""
    wav(tmp_path / "hello.wav", 8000, bytes(1600))
    project = dataclasses.replace(toy.project(), lines={"hello": Line(audio="hello.wav")})
    registry.write_for_target(project, "metagraph", tmp_path / "game", Contents(base=tmp_path))
    return tmp_path / "game"


def json_of(folder: Path) -> Path:
    return next(folder.glob("[!.]*.json"))


def glb_of(folder: Path) -> Path:
    return next(folder.glob("*.glb"))


def said(path: Path) -> dict[str, list[str]]:
    return {
        part.name: [f"{f.place}: {f.words}" for f in part.faults]
        for one in verify(path)
        for part in one.parts
        if part.faults
    }


def flip(path: Path, at: int = -20) -> None:
    content = bytearray(path.read_bytes())
    content[at] ^= 0x01
    path.write_bytes(content)


def without_record(folder: Path) -> Path:
    (folder / RECORD).unlink()
    return folder


def test_a_whole_export_is_whole_by_its_folder_and_by_each_of_its_files(game: Path) -> None:
    before = {p: (p.stat().st_mtime_ns, p.read_bytes()) for p in game.rglob("*") if p.is_file()}
    assert len(before) == 5
    for path in (game, *before):
        assert said(path) == {}, path
    assert {p: (p.stat().st_mtime_ns, p.read_bytes()) for p in game.rglob("*") if p.is_file()} == before


@pytest.mark.parametrize("name", ["talk.json", "talk.glb"])
def test_an_old_export_without_digests_is_whole_and_says_that_it_could_not_be_compared(name: str) -> None:
    (found,) = verify(OLD / name)
    assert not found.faults
    assert any("could not be compared" in part.words for part in found.parts)


def test_a_linked_export_is_looked_at_where_it_lies(game: Path, tmp_path: Path) -> None:
    link = tmp_path / "link.json"
    link.symlink_to(json_of(game))
    assert said(link) == {}


@pytest.mark.parametrize("target", ["xstate", "web", "unity"])
def test_the_files_of_every_target_are_compared_with_their_record(tmp_path: Path, toy, target: str) -> None:
    registry.write_for_target(toy.project(), target, tmp_path)
    assert said(tmp_path) == {}
    names = sorted(read_record(tmp_path).files)
    flip(tmp_path / names[0], 0)
    (tmp_path / names[-1]).unlink()
    files = said(tmp_path)["files"]
    assert any(line.startswith(f"{names[0]}: ") for line in files)
    assert f"{names[-1]}: is missing." in files


def test_without_a_record_a_flipped_byte_of_the_glb_is_told(game: Path) -> None:
    without_record(game)
    flip(glb_of(game))
    assert "SHA-256 is another" in said(json_of(game))["GLB"][0]
    flip(glb_of(game))
    assert said(json_of(game)) == {}
    with glb_of(game).open("ab") as file:
        file.write(b"\0\0\0\0")
    assert "bytes" in said(glb_of(game))["GLB"][0]
    glb_of(game).unlink()
    assert "is missing" in said(json_of(game))["GLB"][0]


def test_another_glb_beside_an_older_export_is_told_by_its_animations_and_joints(
    game: Path, tmp_path: Path
) -> None:
    for name in ("talk.json", "talk.glb"):
        shutil.copy(OLD / name, tmp_path)
    shutil.copy(glb_of(game), tmp_path / "talk.glb")
    told = " ".join(said(tmp_path / "talk.json")["animations"])
    assert "as animation 0; the JSON has" in told and "has no joint" in told


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda d: d.update(metagraph=99), "metagraph"),
        (lambda d: d["layers"].pop("arms"), "arms"),
        (lambda d: d["clips"][0].update(sha256=1), "sha256"),
        (lambda d: d["clips"].append(d["clips"][0]), "used twice"),
        (lambda d: d["layers"]["arms"]["actions"][0].update(clip="zz"), "not in the project"),
        (
            lambda d: d["layers"]["arms"]["transitions"].append({"from": "x", "to": "y", "actions": ["zz"]}),
            "'zz'",
        ),
        (lambda d: d.update(glb="../other.glb"), "glb"),
        (lambda d: d.update(unknown=1), "unknown"),
    ],
)
def test_what_the_schema_or_the_ids_forbid_is_told_with_its_place(game: Path, change, words: str) -> None:
    path = json_of(without_record(game))
    data = json.loads(path.read_bytes())
    change(data)
    path.write_text(json.dumps(data))
    (line, *_) = said(path)["JSON"]
    assert words in line or words in str(verify(path)[0].faults), line


def test_a_truncated_json_is_told_and_its_glb_is_read(game: Path) -> None:
    path = json_of(without_record(game))
    path.write_bytes(path.read_bytes()[:5000])
    (found,) = verify(path)
    assert [part.name for part in found.parts if part.faults] == ["JSON"]
    assert any(part.name == "GLB" and "can be read" in part.words for part in found.parts)
    path.write_bytes(b"")
    assert [*said(path)] == ["JSON"]


@pytest.mark.nightly
def test_a_sound_that_is_missing_or_none_is_told(game: Path) -> None:
    without_record(game)
    (sound,) = (game / "lines").iterdir()
    sound.write_bytes(b"no sound")
    assert [*said(game)] == ["sounds"]
    sound.unlink()
    (line,) = said(game)["sounds"]
    assert line.startswith("lines/hello.wav: ")


def test_a_sound_on_another_computer_is_not_opened(game: Path) -> None:
    path = json_of(without_record(game))
    path.write_text(path.read_text().replace("lines/hello.wav", "//server/hello.wav"))
    assert "another computer" in said(path)["sounds"][0]


@pytest.mark.nightly
def test_an_export_that_was_interrupted_is_told_with_the_files_of_before(
    game: Path, toy, tmp_path: Path
) -> None:
    """What a kill leaves between the first file and the last: a record of both, and some files still old."""
    project = toy.project()
    registry.write_for_target(edits.set_settings(project, seed=7), "metagraph", tmp_path / "new")
    old, new = read_record(game), read_record(tmp_path / "new")
    shutil.copy(glb_of(tmp_path / "new"), glb_of(game))
    record = ExportRecord(old.target, old.project, new.files, old.files)
    (game / RECORD).write_bytes(msgspec.json.encode(record))
    told = said(game)
    assert "was interrupted" in told["record"][0]
    assert any(line.startswith(f"{json_of(game).name}: ") for line in told["files"])


@pytest.mark.nightly
def test_a_killed_export_leaves_its_record_and_staging_and_both_are_told(
    game: Path, toy, monkeypatch
) -> None:
    """The process ends in the middle of moving the files; nothing of it is tidied."""

    class Killed(BaseException):
        pass

    moved: list[str] = []
    replace = Path.replace

    def dying(self: Path, target: Path) -> Path:
        if STAGED in str(self) and target.parent == game:
            if len(moved) == 2:
                raise Killed
            moved.append(self.name)
        return replace(self, target)

    with monkeypatch.context() as patch:
        patch.setattr(Path, "replace", dying)
        patch.setattr(Staging, "_put_back", lambda *_: None)
        patch.setattr(Staging, "__exit__", lambda *_: None)
        with pytest.raises(Killed):
            registry.write_for_target(edits.set_settings(toy.project(), seed=7), "metagraph", game)
    assert "leftovers" not in said(game), "its process lives"
    (staging,) = game.glob(f"{STAGED}*")
    staging.rename(game / f"{STAGED}00000000-1-1-x")
    os.utime(game / f"{STAGED}00000000-1-1-x", (1, 1))
    told = said(game)
    assert "was interrupted" in told["record"][0]
    assert "an interrupted export left" in told["leftovers"][0]
    assert any("the export before" in line for line in told["files"])


@pytest.mark.parametrize("content", [b"", b"nonsense", b"[]"])
def test_a_record_that_cannot_be_read_is_told_and_the_export_is_looked_at(game: Path, content: bytes) -> None:
    (game / RECORD).write_bytes(content)
    for path in (game, json_of(game), glb_of(game)):
        (found,) = verify(path)
        assert [part.name for part in found.parts if part.faults] == ["record"]
        assert any(part.name == "GLB" for part in found.parts)


@pytest.mark.parametrize("name", ["../outside", "//server/x", "/etc/passwd", "CON"])
def test_a_record_opens_no_file_outside_its_folder(game: Path, name: str) -> None:
    record = read_record(game)
    (game / RECORD).write_bytes(msgspec.json.encode(msgspec.structs.replace(record, files={name: "0" * 64})))
    assert "no file that an export would have written" in said(game)["files"][0]


def test_a_folder_of_several_is_looked_at_one_by_one(game: Path) -> None:
    save_project(Project("one"), game / f"one{SUFFIX}")
    for name in ("talk.json", "talk.glb"):
        shutil.copy(OLD / name, game)
    found = verify(game)
    assert [Path(one.file).name for one in found] == [f"one{SUFFIX}", "game", "talk.json"]
    assert not any(one.faults for one in found)
    (game / f"one{SUFFIX}").write_text("metagraph: [")
    assert [*said(game)] == ["file"]


@pytest.mark.parametrize("name", ["a.txt", "a.json", "a.glb", "a.bvh"])
@pytest.mark.parametrize("content", [b"", b"{}", b"hello"])
def test_a_file_that_is_neither_is_an_error(tmp_path: Path, name: str, content: bytes) -> None:
    (tmp_path / name).write_bytes(content)
    with pytest.raises(FileError):
        verify(tmp_path / name)


def test_a_folder_without_any_and_no_file_are_errors(tmp_path: Path) -> None:
    for path in (tmp_path, tmp_path / "none.json", tmp_path / f"none{SUFFIX}"):
        with pytest.raises(FileError):
            verify(path)


def test_a_pipe_is_refused_and_nothing_waits_for_it(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / f"pipe{SUFFIX}")
    with pytest.raises(FileError, match="a pipe"):
        verify(tmp_path / f"pipe{SUFFIX}")


@pytest.mark.nightly
@settings(max_examples=60, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(data=st.data())
def test_no_flipped_byte_of_an_export_goes_unseen(game: Path, data: st.DataObject) -> None:
    path = data.draw(st.sampled_from(sorted(p for p in game.rglob("*") if p.is_file())))
    content = path.read_bytes()
    at = data.draw(st.integers(0, len(content) - 1))
    flipped = bytearray(content)
    flipped[at] ^= data.draw(st.sampled_from([0x01, 0x20, 0xFF]))
    before = read_record(game)
    path.write_bytes(flipped)
    try:
        told = said(game)
        after = read_record(game)
    finally:
        path.write_bytes(content)
    # Blanks and the letters of a digest's hexadecimal digits may mean the same: then the record does.
    assert told or (path.name == RECORD and after == before), f"{path}, byte {at}"


def test_the_digests_of_the_files_are_those_of_the_record(game: Path) -> None:
    record = read_record(game)
    assert {name: digest(game / name) for name in record.files} == record.files
