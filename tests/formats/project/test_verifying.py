"""Verifying a project reports each file that is not whole, hides none of them, and changes nothing."""

from __future__ import annotations

import dataclasses
import json
import os
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from msgspec.structs import replace

from metagraph.errors import FileError
from metagraph.formats.bvh.file import write_bvh
from metagraph.formats.gltf.reader import write_glb
from metagraph.formats.imports import import_files
from metagraph.formats.locking import Lock, make_owner
from metagraph.formats.project.journal import Journal, make_journal_path
from metagraph.formats.project.verified import Verified
from metagraph.formats.project.verifying import verify_project
from metagraph.formats.project.versions import make_version_path, write_project
from metagraph.formats.recovery import DAMAGED, retire
from metagraph.formats.store import SUFFIX, read_project, save_project
from metagraph.graph import edits
from metagraph.graph.conversation.model import Conversation, Side
from metagraph.graph.model import Project
from metagraph.graph.requests import Line
from tests.projects import clip
from tests.sittings import kill_sittings
from tests.wavs import wav

NAME = f"home{SUFFIX}"
OTHERS_MARK = "00000000-1-1"  # of a process on another computer


@pytest.fixture
def home(tmp_path: Path) -> Path:
    """A project of four clips in three files, with a character, sounds and an earlier version."""
    folder = tmp_path / "home"
    (folder / "clips").mkdir(parents=True)
    write_glb(folder / "clips" / "two.glb", [clip("one"), clip("two", 20)])
    write_glb(folder / "clips" / "idle.glb", [clip("idle")])
    write_bvh(clip("alone", 10), folder / "clips" / "alone.bvh")
    wav(folder / "hello.wav", 8000, bytes(1600))
    wav(folder / "talk.wav", 8000, bytes(3200), channels=2)
    project = import_files(Project("home"), folder, [folder / "clips"]).into(Project("home"))
    project = edits.add_stance(project, "arms", "rest", list(project.clips)[:1])
    sides = (Side(audio="talk.wav", channel=0), Side(audio="talk.wav", channel=1))
    project = dataclasses.replace(
        project,
        lines={"hello": Line(audio="hello.wav")},
        conversations={"c": Conversation(name="talk", length=1.0, sides=sides)},
    )
    path = folder / NAME
    save_project(project, path, path)
    write_project(path, path.read_bytes().replace(b"name: home", b"name: home now", 1), 3)
    return path


def damage(path: Path, at: int = -20) -> None:
    content = bytearray(path.read_bytes())
    content[at] ^= 0xFF
    path.write_bytes(content)


def said(found: Verified) -> dict[str, list[str]]:
    return {p.name: [f"{f.place}: {f.words}" for f in p.faults] for p in found.parts if p.faults}


def only(path: Path, part: str) -> str:
    """The one fault of a project, which is of a part."""
    found = said(verify_project(path))
    assert [*found] == [part] and len(found[part]) == 1, found
    return found[part][0]


def words(found: Verified, part: str) -> str:
    return next(p.words for p in found.parts if p.name == part)


def state(folder: Path) -> dict[str, tuple[int, bytes]]:
    return {
        str(p): (p.stat().st_mtime_ns, p.read_bytes() if p.is_file() else b"")
        for p in (folder, *folder.rglob("*"))
    }


def edited(path: Path, names: list[str]) -> Journal:
    owner, project = make_owner(), read_project(path)
    journal = Journal(make_journal_path(path, owner.sitting), path, owner)
    for name in names:
        after = edits.rename_project(project, name)
        journal.edit(project, after, f"Rename to {name}")
        project = after
    journal.close()
    return journal


def test_a_whole_project_is_whole_and_stays_as_it_is(home: Path) -> None:
    before = state(home.parent)
    found = verify_project(home)
    assert not found.faults, said(found)
    assert words(found, "clips").startswith("4 of 4 ")
    assert words(found, "sounds") == "2 of 2 can be read"
    assert words(found, "versions") == "1 of 1 can be opened"
    assert state(home.parent) == before


def test_a_project_with_nothing_in_it_is_whole(tmp_path: Path) -> None:
    save_project(Project("empty"), tmp_path / NAME)
    assert not verify_project(tmp_path / NAME).faults


def test_a_linked_project_names_its_files_from_where_it_lies(home: Path, tmp_path: Path) -> None:
    (tmp_path / "link").mkdir()
    link = tmp_path / "link" / NAME
    link.symlink_to(home)
    assert not verify_project(link).faults


def test_no_file_is_an_error_and_not_a_fault(tmp_path: Path) -> None:
    with pytest.raises(FileError, match="No such file"):
        verify_project(tmp_path / NAME)


def test_each_bad_clip_is_named_and_hides_no_other(home: Path) -> None:
    damage(home.parent / "clips" / "two.glb")
    (home.parent / "clips" / "alone.bvh").unlink()
    (home.parent / "clips" / "idle.glb").write_bytes(b"")
    found = verify_project(home)
    clips = said(found)["clips"]
    assert [line.split(": ")[0].split(",")[0] for line in clips] == [
        "clips/alone.bvh",
        "clips/idle.glb",
        "clips/idle.glb",
        "clips/two.glb",
    ]
    assert "is missing" in clips[0] and "SHA-256" in clips[1] and "an empty file" in clips[2]
    assert words(found, "clips").startswith("0 of 4")
    assert [*said(found)] == ["clips"]


def test_a_clip_whose_file_has_moved_is_found_by_its_content(home: Path) -> None:
    (home.parent / "clips" / "alone.bvh").rename(home.parent / "renamed.bvh")
    line = only(home, "clips")
    assert line.startswith("clips/alone.bvh: ") and "renamed.bvh" in line


def test_a_file_with_fewer_takes_is_told(home: Path) -> None:
    write_glb(home.parent / "clips" / "two.glb", [clip("one")])
    assert any("take 2" in line and "'two'" in line for line in said(verify_project(home))["clips"])


def test_a_folder_in_the_place_of_a_clip_is_told_as_such(home: Path) -> None:
    place = home.parent / "clips" / "alone.bvh"
    place.unlink()
    place.mkdir()
    assert "a directory" in said(verify_project(home))["clips"][0].lower()


def test_a_clip_on_another_computer_is_not_opened_and_not_called_whole(home: Path) -> None:
    home.write_bytes(home.read_bytes().replace(b"path: clips/alone.bvh", b'path: "//server/alone.bvh"'))
    (line,) = said(verify_project(home))["clips"]
    assert line.startswith("//server/alone.bvh: ") and "another computer" in line


def test_a_wrong_number_of_frames_in_the_project_is_told(home: Path) -> None:
    home.write_bytes(home.read_bytes().replace(b"frames: 20", b"frames: 21"))
    line = said(verify_project(home))["clips"][0]
    assert all(piece in line for piece in ("'two'", "20", "21"))


@pytest.mark.parametrize("name", ["hello.wav", "talk.wav"])
def test_sounds_that_cannot_be_read_are_told(home: Path, name: str) -> None:
    (home.parent / name).write_bytes(b"no sound")
    assert [*said(verify_project(home))] == ["sounds"]
    (home.parent / name).unlink()
    assert said(verify_project(home))["sounds"] == [f"{name}: is missing."]


def test_a_channel_that_a_sound_does_not_have_is_told(home: Path) -> None:
    wav(home.parent / "talk.wav", 8000, bytes(1600))
    assert [*said(verify_project(home))] == ["sounds"]


def test_a_character_that_cannot_be_read_is_told(home: Path) -> None:
    save_project(dataclasses.replace(read_project(home), character="clips/ada.glb"), home)
    assert only(home, "characters").startswith("clips/ada.glb: ")
    (home.parent / "clips" / "ada.glb").write_bytes(b"glTF")
    assert [*said(verify_project(home))] == ["characters"]


@pytest.mark.parametrize("share", [0.0, 0.2, 0.5, 0.97])
def test_a_truncated_project_is_told_and_all_beside_it_is_looked_at(home: Path, share: float) -> None:
    content = home.read_bytes()
    home.write_bytes(content[: int(len(content) * share)])
    make_version_path(home, 1).write_bytes(b"nothing")
    assert {"file", "versions"} <= {*said(verify_project(home))}


def test_an_id_that_is_used_twice_is_told(home: Path) -> None:
    lines = home.read_text().splitlines(keepends=True)
    place = next(n for n, line in enumerate(lines) if "path: clips/" in line)
    home.write_text("".join([*lines[: place + 1], *lines[place:]]))
    assert "used twice" in said(verify_project(home))["file"][0]


def test_an_action_that_plays_another_clip_than_it_was_made_of_is_told(home: Path) -> None:
    project = read_project(home)
    (action,) = project.actions()
    other = next(i for i in project.clips if i != action.clip)
    home.write_text(home.read_text().replace(f"clip: {action.clip},", f"clip: {other},"))
    assert "was made from clip" in said(verify_project(home))["graph"][0]


def test_a_damaged_earlier_version_is_told(home: Path) -> None:
    make_version_path(home, 1).write_bytes(b"\xff\xfe")
    (line,) = said(verify_project(home))["versions"]
    assert line.startswith(f"{NAME}.1")


def test_edits_that_wait_in_a_journal_are_told_and_those_being_made_are_not(home: Path) -> None:
    journal = edited(home, ["a", "b"])
    before = state(home.parent)
    found = verify_project(home)
    assert not found.faults and "has the project open" in words(found, "journals")
    assert state(home.parent) == before
    kill_sittings(home.parent)
    line = only(home, "journals")
    assert line.startswith(f"{journal.path.name}: ") and "2 edits" in line


def test_a_damaged_record_of_a_journal_is_named(home: Path) -> None:
    path = edited(home, ["first", "second", "third"]).path
    kill_sittings(home.parent)
    path.write_bytes(path.read_bytes().replace(b'"name":"second"', b'"name":"secXnd"'))
    lines = said(verify_project(home))["journals"]
    assert "holds 2 edits" in lines[0] and "'Rename to second'" in lines[1]


def test_a_journal_that_cannot_be_read_and_one_kept_as_damaged_are_told(home: Path) -> None:
    path = edited(home, ["first", "second"]).path
    kill_sittings(home.parent)
    path.write_bytes(path.read_bytes().replace(b'"name":"second"', b'"name":"secXnd"'))
    retire(path)
    bad = home.with_name(f".{NAME}.0123456789ab.journal")
    bad.write_bytes(b"nonsense\n")
    os.utime(bad, (1, 1))
    told = " ".join(said(verify_project(home))["journals"])
    assert f"{path.name}{DAMAGED}: " in told
    assert f"{bad.name}, line 1: is damaged" in told


def test_half_written_files_of_the_dead_are_told_and_those_of_the_living_are_not(home: Path) -> None:
    from metagraph.formats.replacing import make_unfinished_name

    (home.parent / make_unfinished_name()).write_bytes(b"half")
    assert not verify_project(home).faults
    left = home.with_name(f".saving-{OTHERS_MARK}-{'a' * 12}")
    left.write_bytes(b"half")
    os.utime(left, (1, 1))
    assert only(home, "leftovers").startswith(f"{left.name}: ")


def test_a_lock_of_the_dead_is_told_and_one_of_the_living_is_not(home: Path) -> None:
    lock = Lock(home, make_owner())
    lock.acquire()
    found = verify_project(home)
    assert not found.faults and "has the project open" in words(found, "leftovers")
    kill_sittings(home.parent)
    assert "is a lock that" in said(verify_project(home))["leftovers"][0]


def test_a_lock_of_another_computer_is_judged_without_writing_anything(home: Path) -> None:
    owner = replace(make_owner(), host="elsewhere", machine="other")
    Lock(home, owner).acquire()
    before = state(home.parent)
    assert not verify_project(home).faults
    assert state(home.parent) == before
    os.utime(home.with_name(f".{NAME}.lock"), (1, 1))
    before = state(home.parent)
    assert "on elsewhere left behind" in said(verify_project(home))["leftovers"][0]
    assert state(home.parent) == before


@pytest.mark.nightly
@settings(max_examples=60, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(data=st.data())
def test_no_flipped_byte_of_a_clip_goes_unseen_and_a_project_is_told_or_another_that_can_be_saved(
    home: Path, data: st.DataObject
) -> None:
    """A project's file is there to be edited by hand, so it has no digest of its own: what a flip leaves
    readable is another project.
    """
    files = sorted(p for p in home.parent.rglob("*") if p.suffix in (".glb", ".bvh", ".yaml"))
    path = data.draw(st.sampled_from(files))
    content = path.read_bytes()
    at = data.draw(st.integers(0, len(content) - 1))
    flipped = bytearray(content)
    flipped[at] ^= data.draw(st.sampled_from([0x01, 0x20, 0xFF]))
    path.write_bytes(flipped)
    try:
        found = verify_project(home)
    finally:
        path.write_bytes(content)
    if not found.faults:
        assert path == home, f"{path}, byte {at}"
    else:
        assert all(f.place and f.words and f.remedy for f in found.faults)
        json.dumps([f.words for f in found.faults])
