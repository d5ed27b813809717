"""Project files: what is written, what is read back, and clips whose files moved."""

from __future__ import annotations

import os
import random
import re
import shutil
import stat
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from metagraph.errors import FileError
from metagraph.formats import store
from metagraph.formats.atomic import write_atomically
from metagraph.formats.bvh.file import write_bvh
from metagraph.formats.gltf.reader import write_glb
from metagraph.formats.imports import import_files
from metagraph.formats.project.data import to_data
from metagraph.formats.store import (
    SUFFIX,
    load_motions,
    make_path_relative,
    make_paths_absolute,
    open_project,
    parse_project,
    read_project,
    relocate,
    save_project,
    to_text,
)
from metagraph.graph import edits
from metagraph.graph.model import ClipEntry, Project
from tests.projects import clip, projects

pytestmark = pytest.mark.usefixtures("numbered_ids")

PATH = Path(f"show{SUFFIX}")


def text_of(project: Project) -> str:
    return to_text(to_data(project))


# --- text


@pytest.mark.nightly
@settings(max_examples=80, deadline=None)
@given(projects())
def test_a_project_comes_back_from_its_text_and_is_written_the_same_again(project: Project) -> None:
    text = text_of(project)
    back = parse_project(text, PATH)
    assert back == project
    assert text_of(back) == text


def grown() -> Project:
    project = edits.add_clips(
        Project("grown"), [(f"clips/{n}.glb", 0, "ab" * 32, clip(f"clip {n}")) for n in range(30)]
    )
    project = edits.add_stance(project, "arms", "rest", ["c1"])
    return edits.place_clips(project, [f"c{n}" for n in range(2, 30)], "arms", "gesture", "s31")


@pytest.mark.parametrize(
    ("edit", "removed", "added"),
    [
        (lambda p: edits.update_actions(p, ["a40"], likelihood=2.0), 1, 1),
        (lambda p: edits.update_actions(p, ["a40"], timing={"start": 0.1}), 1, 1),
        (lambda p: edits.remove_actions(p, ["a40"]), 1, 0),
        (lambda p: edits.place_clips(p, ["c3"], "arms", "fidget", "s31"), 1, 2),  # and the next id
        (lambda p: edits.rename_clip(p, "c3", "other"), 1, 1),
        (lambda p: edits.set_base(p, "c3", 2), 1, 3),
        (lambda p: edits.set_weight(p, "arms", "head", 0.5), 1, 1),
        (lambda p: edits.rename_stance(p, "s31", "at ease"), 1, 1),
        (lambda p: edits.set_settings(p, seed=7), 1, 2),
        (lambda p: edits.rename_project(p, "other"), 1, 1),
    ],
)
def test_one_edit_changes_few_lines(edit: Any, removed: int, added: int) -> None:
    before, after = text_of(grown()).splitlines(), text_of(edit(grown())).splitlines()
    assert len([line for line in before if line not in after]) <= removed
    assert len([line for line in after if line not in before]) <= added


def test_the_order_of_lines_is_the_order_things_were_made_in() -> None:
    project = grown()
    again = edits.update_actions(project, ["a33"], name="renamed")
    ids = [line.split(",")[0] for line in text_of(again).splitlines() if "kind: gesture" in line]
    assert ids == [f"    - {{id: a{n}" for n in range(33, 61)]


# --- wrong files


def refused(text: str) -> FileError:
    with pytest.raises(FileError) as caught:
        parse_project(text, PATH)
    error = caught.value
    assert error.path == PATH and error.cause and error.where and error.remedy
    assert str(error).startswith(f"{PATH.name}, {error.where}: ")
    return error


@pytest.mark.parametrize(
    ("old", "new", "cause"),
    [
        (
            "kind: gesture",
            "kind: dance",
            "layers.arms.actions[1].kind should be one of stance, gesture, fidget",
        ),
        ("name: clip 3", "name: 3", "clips[3].name should be text, found 3"),
        ("name: clip 3", "colour: 3", "clips[3].colour is not a field known here"),
        ("frames: 31", "frames: many", "clips[0].frames should be a whole number, found 'many'"),
        ("metagraph: 2", "metagraph: one", "metagraph should be the version"),
        ("metagraph: 2", "metagraph: 0", "metagraph should be the version"),
        ("metagraph: 2", "metagraf: 1", "not a Metagraph project"),
        ("start: s31", "start: [s31]", "layers.arms.start should be text"),
        ("- {name: Head", "- {nom: Head", "skeleton[2].name is missing"),
        ("settings: {}", "settings: {alpha: .nan}", "settings.alpha should be a finite number"),
        ("settings: {}", "settings: {:", "not valid YAML"),
        ("settings: {}", "settings: &x {}", "anchors and aliases"),
    ],
)
def test_a_wrong_line_is_named_with_field_cause_and_remedy(old: str, new: str, cause: str) -> None:
    text = text_of(grown())
    error = refused(text.replace(old, new, 1))
    assert cause in error.cause
    line = next(n for n, line in enumerate(text.splitlines(), 1) if old in line)
    near = (line, line + 1) if "YAML" in cause else (line, line)  # a bracket left open shows on the next line
    assert error.where in [f"line {n}" for n in near]


@pytest.mark.parametrize(
    "text", ["", "[]", "hello", "- a", "3", "null", "---\n", "a: 1", "{", "\t", "%YAML 9.9\n--- {}"]
)
def test_other_files_are_refused(text: str) -> None:
    refused(text)


def test_a_file_of_a_newer_version_is_refused_with_what_to_do() -> None:
    error = refused(text_of(grown()).replace("metagraph: 2", "metagraph: 99"))
    assert "newer Metagraph (format 99" in error.cause
    assert error.remedy == "Update Metagraph."


def test_a_file_of_a_newer_version_can_be_looked_at_but_not_replaced(tmp_path: Path) -> None:
    project = grown()
    text = text_of(project).replace("metagraph: 2", "metagraph: 3\ngravity: 9.81")
    first = next(iter(project.actions()))
    text = text.replace(f"id: {first.id}", f"id: {first.id}, sparkle: true")
    text = text.replace("kind: gesture", "kind: gesture, weight_of_two: 3")  # as a new field of each action
    path = tmp_path / "new.metagraph.yaml"
    path.write_text(text, encoding="utf-8")
    opened = open_project(path)
    assert opened.newer and opened.project.graphs == project.graphs
    assert "newer Metagraph" in opened.notes[0] and "gravity" in opened.notes[1]
    assert opened.notes[1].count("weight_of_two") == 1, "it is dropped everywhere at once"
    with pytest.raises(FileError, match="newer Metagraph") as refusal:
        save_project(opened.project, path)
    assert refusal.value.remedy == "Update Metagraph, or save under another name."
    assert path.read_text(encoding="utf-8") == text
    save_project(opened.project, tmp_path / "copy.metagraph.yaml")
    assert not open_project(tmp_path / "copy.metagraph.yaml").newer
    with pytest.raises(FileError, match="Update Metagraph"):
        read_project(path)


def test_a_newer_file_whose_known_part_makes_no_sense_is_refused_as_newer(tmp_path: Path) -> None:
    path = tmp_path / "new.metagraph.yaml"
    text = text_of(grown()).replace("metagraph: 2", "metagraph: 3").replace("kind: gesture", "kind: dance")
    path.write_text(text, encoding="utf-8")
    with pytest.raises(FileError, match="written by a newer Metagraph"):
        open_project(path)


def test_an_older_file_is_upgraded_step_by_step(monkeypatch: pytest.MonkeyPatch) -> None:
    steps: list[int] = []

    def first(data: dict[str, Any]) -> dict[str, Any]:
        steps.append(data["metagraph"])
        return {**data, "name": data.pop("title")}

    def second(data: dict[str, Any]) -> dict[str, Any]:
        steps.append(data["metagraph"])
        return {**data, "name": data["name"] + "!"}

    text = text_of(grown()).replace("metagraph: 2", "metagraph: 1")
    monkeypatch.setattr(store, "FORMAT", 3)
    monkeypatch.setattr(store, "UPGRADES", {1: lambda d: first(dict(d)), 2: second})
    text = text.replace("name: grown", "title: grown")
    with pytest.raises(FileError, match="title"):
        parse_project(text, PATH)
    monkeypatch.setattr(
        store, "UPGRADES", {1: lambda d: {k: v for k, v in first(dict(d)).items() if k != "title"}, 2: second}
    )
    assert parse_project(text, PATH).name == "grown!"
    assert steps == [1, 2, 1, 2]


@pytest.mark.nightly
@settings(max_examples=150, deadline=None)
@given(st.randoms(use_true_random=False), st.integers(1, 6))
def test_a_file_with_letters_changed_is_read_or_refused(chance: random.Random, count: int) -> None:
    text = list(text_of(grown()))
    for _ in range(count):
        at = chance.randrange(len(text))
        text[at] = chance.choice(
            [
                "",
                "{",
                "}",
                "[",
                "]",
                ":",
                ",",
                '"',
                "'",
                "\n",
                " ",
                "-",
                "9",
                "\x00",
                "é",
                "&a ",
                "*a",
                "!!x ",
                text[at] * 2,
            ]
        )
    try:
        parse_project("".join(text), PATH)
    except FileError as error:
        assert error.cause and error.where and error.remedy
        assert str(error).isprintable()


@pytest.mark.nightly
@settings(max_examples=100, deadline=None)
@given(st.integers(0, 4000))
def test_a_file_cut_off_anywhere_is_read_or_refused(length: int) -> None:
    try:
        parse_project(text_of(grown())[:length], PATH)
    except FileError as error:
        assert error.where and error.remedy


def test_a_file_that_is_no_text_or_not_there_is_refused(tmp_path: Path) -> None:
    (tmp_path / "a.yaml").write_bytes(b"\xff\xfe\x00a")
    with pytest.raises(FileError, match="is not text"):
        read_project(tmp_path / "a.yaml")
    with pytest.raises(FileError, match="cannot be read"):
        read_project(tmp_path / "b.yaml")
    with pytest.raises(FileError, match="cannot be read"):
        read_project(tmp_path)


def test_a_byte_order_mark_and_windows_line_ends_are_no_trouble(tmp_path: Path) -> None:
    (tmp_path / "a.yaml").write_bytes(b"\xef\xbb\xbf" + text_of(grown()).replace("\n", "\r\n").encode())
    assert read_project(tmp_path / "a.yaml") == grown()


# --- writing


@pytest.mark.parametrize("step", ["write", "fsync", "replace"])
def test_a_failure_on_the_way_leaves_the_old_file_whole_and_nothing_beside_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, step: str
) -> None:
    path = tmp_path / "a.yaml"
    path.write_text("old")

    def fail(*args: Any, **kwargs: Any) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Path if step == "replace" else os, step, fail)
    with pytest.raises(FileError, match="No space left on device"):
        write_atomically(path, b"new")
    monkeypatch.undo()
    assert path.read_text() == "old"
    assert [p.name for p in tmp_path.iterdir()] == ["a.yaml"]


def test_a_stop_on_the_way_leaves_nothing_beside_the_old_file_either(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def stop(*args: Any) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(os, "fsync", stop)
    with pytest.raises(KeyboardInterrupt):
        write_atomically(tmp_path / "a.yaml", b"new")
    assert not list(tmp_path.iterdir())


@pytest.mark.skipif(os.name == "nt", reason="Windows has no such permissions")
def test_permissions_are_kept_and_new_files_get_the_usual_ones(tmp_path: Path) -> None:
    old, new = tmp_path / "old", tmp_path / "new"
    old.write_text("x")
    old.chmod(0o640)
    write_atomically(old, b"y")
    assert stat.S_IMODE(old.stat().st_mode) == 0o640
    mask = os.umask(0o027)
    try:
        write_atomically(new, b"y")
    finally:
        os.umask(mask)
    assert stat.S_IMODE(new.stat().st_mode) == 0o640


def test_the_umask_of_the_process_is_not_touched(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    touched: list[int] = []
    monkeypatch.setattr(os, "umask", lambda mask: touched.append(mask) or 0o022)
    write_atomically(tmp_path / "new", b"y")
    assert not touched, "another thread may make a file at that moment"


def test_a_read_only_file_is_not_replaced(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "locked.yaml"
    path.write_text("checked in")
    monkeypatch.setattr(
        os, "access", lambda *args: False
    )  # also for the administrator, who may write everything
    with pytest.raises(FileError, match="it is read-only"):
        write_atomically(path, b"new")
    assert path.read_text() == "checked in"


@pytest.mark.skipif(os.name == "nt", reason="links need rights on Windows")
def test_a_link_stays_a_link(tmp_path: Path) -> None:
    (tmp_path / "real").mkdir()
    (tmp_path / "real" / "a.yaml").write_text("old")
    (tmp_path / "link.yaml").symlink_to(tmp_path / "real" / "a.yaml")
    write_atomically(tmp_path / "link.yaml", b"new")
    assert (tmp_path / "link.yaml").is_symlink()
    assert (tmp_path / "real" / "a.yaml").read_text() == "new"


def test_a_folder_in_the_way_is_an_error_in_words(tmp_path: Path) -> None:
    (tmp_path / "a.yaml").mkdir()
    with pytest.raises(FileError, match="cannot be written"):
        write_atomically(tmp_path / "a.yaml", b"x")
    (tmp_path / "file").write_text("")
    with pytest.raises(FileError, match="cannot be written"):
        write_atomically(tmp_path / "file" / "a.yaml", b"x")
    assert sorted(p.name for p in tmp_path.iterdir()) == ["a.yaml", "file"]


def test_a_value_that_cannot_be_saved_leaves_the_old_file(tmp_path: Path) -> None:
    path = tmp_path / "a.yaml"
    save_project(grown(), path)
    with pytest.raises(FileError, match="cannot be saved"):
        save_project(edits.update_actions(grown(), ["a40"], likelihood=float("inf")), path)
    assert read_project(path) == grown()


# --- clips


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
    real = store.digest

    def digest(path: Path) -> str:
        if path.name == "a.glb":
            raise FileError(path, "it cannot be read", "on opening it", "")
        return real(path)

    monkeypatch.setattr(store, "digest", digest)
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


def test_relative_paths_use_slashes_and_go_up(tmp_path: Path) -> None:
    assert make_path_relative(tmp_path / "a" / "b c.glb", tmp_path / "x") == "../a/b c.glb"
    assert make_path_relative(tmp_path / "a.glb", tmp_path) == "a.glb"


@settings(max_examples=20, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(projects(6))
def test_any_project_is_saved_and_opened(tmp_path: Path, project: Project) -> None:
    save_project(project, tmp_path / PATH)
    assert read_project(tmp_path / PATH) == project


def test_paths_are_made_absolute_as_each_by_itself_would_be(tmp_path: Path) -> None:
    there = tmp_path / "there"
    (there / "clips").mkdir(parents=True)
    (there / "clips" / "a.bvh").write_text("")
    try:
        (tmp_path / "linked").symlink_to(there, target_is_directory=True)
        (there / "clips" / "b.bvh").symlink_to(there / "clips" / "a.bvh")
    except OSError:  # where links are not for everybody
        pass
    folder = tmp_path / "linked"
    names = [
        "clips/a.bvh",
        "clips/b.bvh",
        "clips/../clips/a.bvh",
        "../x.bvh",
        "gone/c.bvh",
        "clips/..",
        ".",
        "a/",
    ]
    names += [(there / "clips" / "a.bvh").as_posix(), "/top.bvh", "clips//a.bvh", "./clips/a.bvh"]
    clips = {str(n): ClipEntry(str(n), "", name) for n, name in enumerate(names)}
    found = make_paths_absolute(Project(clips=clips), folder)
    assert [e.path for e in found.clips.values()] == [(folder / n).resolve().as_posix() for n in names]
