"""Project files: what is written, what is read back, and clips whose files moved."""

from __future__ import annotations

import os
import random
import stat
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from metagraph.errors import FileError
from metagraph.formats import store
from metagraph.formats.atomic import write_atomically
from metagraph.formats.project.data import to_data
from metagraph.formats.store import SUFFIX, open_project, parse_project, read_project, save_project, to_text
from metagraph.graph import edits
from metagraph.graph.model import Project
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


@settings(max_examples=20, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(projects(6))
def test_any_project_is_saved_and_opened(tmp_path: Path, project: Project) -> None:
    save_project(project, tmp_path / PATH)
    assert read_project(tmp_path / PATH) == project
