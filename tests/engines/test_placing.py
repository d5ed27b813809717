"""An export goes over nothing that is not its own, and is written whole or not at all."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from metagraph.engines.targets import registry
from metagraph.engines.targets.placing import RECORD, ForeignFilesError, Staging, place_files, read_record


def staged(folder: Path, **files: str) -> Path:
    folder.mkdir(parents=True, exist_ok=True)
    for name, text in files.items():
        (folder / name).write_text(text)
    return folder


def put(tmp_path: Path, target: str, overwrite: bool = False, project: str = "anna", **files: str) -> Path:
    out = tmp_path / "out"
    out.mkdir(exist_ok=True)
    with Staging(out) as beside:
        staged(beside.path, **files)
        place_files(beside, out, files, target, project, overwrite)
    return out


def texts(folder: Path) -> dict[str, str]:
    return {p.name: p.read_text() for p in folder.iterdir() if p.name != RECORD}


def test_writing_again_replaces_its_own_files_and_takes_away_what_it_no_longer_has(tmp_path):
    put(tmp_path, "web", a="1", b="2")
    assert texts(put(tmp_path, "web", a="3", c="4")) == {"a": "3", "c": "4"}


@pytest.mark.parametrize("other", [{"target": "unity"}, {"target": "web", "project": "bert"}])
def test_another_targets_or_projects_files_are_foreign(tmp_path, other):
    out = put(tmp_path, "web", a="1", b="2")
    with pytest.raises(ForeignFilesError) as caught:
        put(tmp_path, **other, a="9", d="4")
    assert caught.value.files == ("a",)
    assert "'anna' for 'web'" in str(caught.value) and "another folder" in str(caught.value)
    assert texts(out) == {"a": "1", "b": "2"}, "nothing was changed"
    assert read_record(out).target == "web"


def test_a_file_that_somebody_changed_since_is_foreign_until_it_may_be_overwritten(tmp_path):
    out = put(tmp_path, "web", a="1")
    (out / "a").write_text("mine")
    with pytest.raises(ForeignFilesError):
        put(tmp_path, "web", a="2")
    assert texts(put(tmp_path, "web", overwrite=True, a="2")) == {"a": "2"}


def test_what_stands_there_byte_for_byte_is_in_nobodys_way(tmp_path):
    staged(tmp_path / "out", a="1", z="mine")
    assert texts(put(tmp_path, "web", a="1", b="2")) == {"a": "1", "b": "2", "z": "mine"}


def test_a_changed_file_that_is_not_made_any_more_stays(tmp_path):
    out = put(tmp_path, "web", a="1", b="2")
    (out / "b").write_text("mine")
    assert texts(put(tmp_path, "web", a="1")) == {"a": "1", "b": "mine"}


@pytest.mark.parametrize("record", ["", "nonsense", "[]", json.dumps({"target": 1})])
def test_a_record_that_cannot_be_read_is_as_none(tmp_path, record):
    out = put(tmp_path, "web", a="1")
    (out / RECORD).write_text(record)
    with pytest.raises(ForeignFilesError):
        put(tmp_path, "web", a="2")


def test_an_export_that_fails_leaves_nothing_behind(tmp_path, toy, monkeypatch):
    from dataclasses import replace

    target = registry.get_target("xstate")

    def broken(order):
        (order.folder / "half").write_text("half")
        raise RuntimeError("broken")

    monkeypatch.setattr(registry, "list_targets", lambda: {"xstate": replace(target, write=broken)})
    with pytest.raises(RuntimeError):
        registry.write_for_target(toy.project(), "xstate", tmp_path / "out")
    assert not (tmp_path / "out").exists(), "nor the folder it made"


def test_two_targets_of_one_project_do_not_break_each_other(tmp_path, toy):
    project = toy.project()
    first = registry.write_for_target(project, "playcanvas", tmp_path)
    before = {path: path.read_bytes() for path in first.files}
    with pytest.raises(ForeignFilesError):
        registry.write_for_target(project, "metagraph", tmp_path)
    assert {path: path.read_bytes() for path in first.files} == before
    assert registry.write_for_target(project, "playcanvas", tmp_path).files == first.files
