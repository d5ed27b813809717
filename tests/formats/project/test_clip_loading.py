"""Clips of a project are loaded, also where their files moved, changed or broke."""

from __future__ import annotations

import os
import re
import shutil
from dataclasses import replace
from pathlib import Path

import pytest

from metagraph.errors import FileError
from metagraph.formats.bvh.file import write_bvh
from metagraph.formats.gltf.reader import write_glb
from metagraph.formats.imports import import_files
from metagraph.formats.project import moved_files
from metagraph.formats.project.clip_loading import load_motions, relocate
from metagraph.formats.project.paths import make_paths_absolute
from metagraph.formats.store import SUFFIX, open_project, read_project, save_project
from metagraph.graph import edits
from metagraph.graph.model import ClipEntry, Project
from tests.projects import clip

pytestmark = pytest.mark.usefixtures("numbered_ids")

PATH = Path(f"show{SUFFIX}")


@pytest.fixture
def home(tmp_path: Path) -> Path:
    """A project with two clip files, one of them with two takes, saved in `tmp_path/home`."""
    folder = tmp_path / "home"
    (folder / "clips").mkdir(parents=True)
    write_glb(folder / "clips" / "two.glb", [clip("one"), clip("two", 20)])
    write_bvh(clip("alone", 10), folder / "clips" / "alone.bvh")
    empty = Project("home")
    project = import_files(empty, folder, [folder]).into(empty)
    save_project(project, folder / PATH, folder / PATH)
    return folder


def test_a_linked_project_finds_its_clips_from_where_it_lies(home: Path, tmp_path: Path) -> None:
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "elsewhere" / PATH.name).symlink_to(home / PATH)
    opened = open_project(tmp_path / "elsewhere" / PATH.name)
    assert not opened.notes and all(entry.motion is not None for entry in opened.project.clips.values())


def paths(project: Project) -> list[str]:
    return [e.path for e in project.clips.values()]


def quoted(notes: tuple[str, ...]) -> list[list[str]]:
    """What each note names in quotes: files, and takes in them."""
    return [re.findall("'([^']+)'", note) for note in notes]


def loaded(project: Project) -> list[bool]:
    return [e.motion is not None for e in project.clips.values()]


def test_a_saved_project_opens_with_its_clips(home: Path) -> None:
    opened = open_project(home / PATH)
    assert opened.notes == ()
    assert paths(opened.project) == ["clips/alone.bvh", "clips/two.glb", "clips/two.glb"]
    assert all(loaded(opened.project))
    assert all(
        e.motion.skeleton is opened.project.skeleton for e in opened.project.clips.values() if e.motion
    )


def test_saving_in_place_leaves_the_paths_alone_wherever_one_works(
    home: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    project = open_project(home / PATH).project
    before = (home / PATH).read_bytes()
    monkeypatch.chdir("/")
    save_project(project, home / PATH)
    assert (home / PATH).read_bytes() == before
    monkeypatch.chdir(home)
    save_project(project, PATH, PATH)
    assert (home / PATH).read_bytes() == before


def test_saved_in_another_folder_the_clips_are_still_found(home: Path, tmp_path: Path) -> None:
    other = tmp_path / "elsewhere" / "deep" / PATH
    project = save_project(
        edits.set_character(open_project(home / PATH).project, "body.glb"), other, home / PATH
    )
    assert paths(project)[0] == "../../home/clips/alone.bvh"
    assert project.character == "../../home/body.glb"
    assert open_project(other).notes == ()


@pytest.mark.skipif(os.name == "nt", reason="links need rights on Windows")
def test_paths_out_of_a_linked_folder_lead_to_the_clips(home: Path, tmp_path: Path) -> None:
    (tmp_path / "far" / "real").mkdir(parents=True)
    (tmp_path / "link").symlink_to(tmp_path / "far" / "real")
    place = tmp_path / "link" / PATH
    save_project(open_project(home / PATH).project, place, home / PATH)
    assert open_project(place).notes == ()


def test_a_project_whose_folder_moved_opens_as_before(home: Path, tmp_path: Path) -> None:
    shutil.move(home, tmp_path / "new home")
    assert open_project(tmp_path / "new home" / PATH).notes == ()


def test_a_moved_clip_is_found_by_its_content(home: Path) -> None:
    (home / "takes").mkdir()
    (home / "clips" / "two.glb").rename(home / "takes" / "two.glb")
    opened = open_project(home / PATH)
    assert quoted(opened.notes) == [["clips/two.glb", "takes/two.glb"]]
    assert paths(opened.project)[1:] == ["takes/two.glb"] * 2
    assert all(loaded(opened.project))


def test_a_renamed_clip_is_found_by_its_content(home: Path) -> None:
    (home / "clips" / "two.glb").rename(home / "clips" / "three.glb")
    assert quoted(open_project(home / PATH).notes) == [["clips/two.glb", "clips/three.glb"]]


def test_two_lost_files_of_one_content_are_both_found(home: Path) -> None:
    shutil.copy(home / "clips" / "alone.bvh", home / "clips" / "same.bvh")
    project = open_project(home / PATH).project
    project = import_files(project, home, [home / "clips" / "same.bvh"]).into(project)
    save_project(project, home / PATH)
    (home / "clips").rename(home / "takes")
    opened = open_project(home / PATH)
    assert [p for p in paths(opened.project) if p.endswith("bvh")] == ["takes/alone.bvh", "takes/same.bvh"]


def test_a_missing_clip_stays_in_the_project_without_motion(home: Path) -> None:
    (home / "clips" / "two.glb").unlink()
    opened = open_project(home / PATH)
    assert quoted(opened.notes) == [["clips/two.glb"]] and "missing" in opened.notes[0]
    assert loaded(opened.project) == [True, False, False]
    save_project(opened.project, home / PATH)
    assert len(read_project(home / PATH).clips) == 3


def test_another_file_of_the_same_name_is_not_taken_for_a_missing_one(home: Path) -> None:
    (home / "clips" / "two.glb").unlink()
    (home / "other").mkdir()
    write_glb(home / "other" / "two.glb", [clip("stranger", 5), clip("danger", 6)])
    assert quoted(open_project(home / PATH).notes) == [["clips/two.glb"]]


def test_a_clip_that_changed_is_loaded_with_a_note(home: Path) -> None:
    write_bvh(clip("alone", 44), home / "clips" / "alone.bvh")
    opened = open_project(home / PATH)
    assert quoted(opened.notes) == [["clips/alone.bvh"]] and "changed" in opened.notes[0]
    assert next(iter(opened.project.clips.values())).frames == 44


def test_a_clip_file_with_fewer_takes_than_before_says_which_is_gone(home: Path) -> None:
    write_glb(home / "clips" / "two.glb", [clip("one")])
    opened = open_project(home / PATH)
    assert quoted(opened.notes[1:]) == [["clips/two.glb", "two"]] and "take 2" in opened.notes[1]
    assert loaded(opened.project) == [True, True, False]


def test_a_broken_clip_file_is_told_and_the_rest_opens(home: Path) -> None:
    (home / "clips" / "two.glb").write_bytes(b"glTF but not really")
    opened = open_project(home / PATH)
    assert len(opened.notes) == 1
    assert opened.notes[0].startswith("two.glb")
    assert loaded(opened.project) == [True, False, False]


def test_paths_written_on_windows_are_understood(home: Path) -> None:
    (home / PATH).write_text((home / PATH).read_text().replace("clips/two.glb", '"clips\\\\two.glb"'))
    opened = open_project(home / PATH)
    assert opened.notes == ()
    assert paths(opened.project)[1] == "clips/two.glb"
    (home / PATH).write_text(
        (home / PATH).read_text().replace('"clips\\\\two.glb"', '"D:\\\\shared\\\\two.glb"')
    )
    assert quoted(open_project(home / PATH).notes) == [["D:\\shared\\two.glb", "clips/two.glb"]]


def test_an_unreadable_file_does_not_stop_the_search(home: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (home / "clips" / "two.glb").rename(home / "clips" / "z.glb")
    (home / "clips" / "a.glb").write_bytes(b"x")
    real = moved_files.digest

    def digest(path: Path) -> str:
        if path.name == "a.glb":
            raise FileError(path, "it cannot be read", "on opening it", "")
        return real(path)

    monkeypatch.setattr(moved_files, "digest", digest)
    assert quoted(open_project(home / PATH).notes) == [["clips/two.glb", "clips/z.glb"]]


def test_relocating_finds_clips_anywhere_below_a_folder(home: Path, tmp_path: Path) -> None:
    (home / "clips").rename(tmp_path / "archive")
    project = open_project(home / PATH).project
    assert not any(loaded(project))
    found = relocate(project, home, tmp_path / "archive")
    assert all(loaded(found))
    assert paths(found)[0] == "../archive/alone.bvh"


def test_relocating_takes_a_changed_file_of_the_same_name_from_the_likeliest_folder(
    home: Path, tmp_path: Path
) -> None:
    shutil.rmtree(home / "clips")
    for name, frames in (("old/clips", 3), ("z/other", 4)):
        (tmp_path / name).mkdir(parents=True)
        write_bvh(clip("alone", frames), tmp_path / name / "alone.bvh")
    found = relocate(open_project(home / PATH).project, home, tmp_path)
    assert loaded(found) == [True, False, False]
    assert paths(found)[0] == "../old/clips/alone.bvh"


def test_a_project_never_saved_keeps_absolute_paths(home: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    bare = make_paths_absolute(read_project(home / PATH), home)
    for folder in (None, Path("/")):
        found = load_motions(bare, folder).project
        assert all(loaded(found))
        assert paths(found) == paths(bare)
    (home / "clips").rename(home / "takes")
    found = relocate(bare, None, home)
    assert paths(found)[0] == (home / "takes" / "alone.bvh").as_posix()


def test_nothing_is_searched_from_the_root_of_all_files(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(os, "walk", lambda *args: pytest.fail("searched"))
    project = replace(Project(), clips={"c1": ClipEntry("c1", "x", "/nowhere/x.glb", digest="ab" * 32)})
    assert quoted(load_motions(project, Path("/")).notes) == [["/nowhere/x.glb"]]


def test_opening_tells_how_far_it_is(home: Path) -> None:
    told: list[tuple[int, int]] = []
    open_project(home / PATH, lambda done, total: told.append((done, total)))
    assert told == [(0, 2), (1, 2)]
