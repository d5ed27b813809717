"""The files of props are found where they were moved to, and told when they have changed."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
import trimesh

from metagraph.formats.clips import digest
from metagraph.formats.project.prop_files import find_prop_files
from metagraph.formats.store import open_project, save_project
from metagraph.graph.editing.props import add_prop
from metagraph.graph.model import Project
from metagraph.graph.prop import Prop


@pytest.fixture
def desk(tmp_path: Path) -> tuple[Project, str]:
    """A project with a desk in its folder, and the desk's id."""
    place = tmp_path / "props" / "desk.stl"
    place.parent.mkdir()
    place.write_bytes(trimesh.creation.box((1, 0.7, 1)).export(file_type="stl"))
    return add_prop(Project(), Prop(name="desk", path="props/desk.stl", sha256=digest(place)))


def test_a_file_as_it_was_added_says_nothing(desk: tuple[Project, str], tmp_path: Path) -> None:
    assert find_prop_files(desk[0], tmp_path) == (desk[0], [])


def test_a_moved_file_is_found_by_its_content_and_saved_there(
    desk: tuple[Project, str], tmp_path: Path
) -> None:
    project, ident = desk
    saved = tmp_path / "a.metagraph.yaml"
    save_project(project, saved)
    (tmp_path / "things").mkdir()
    (tmp_path / "props" / "desk.stl").rename(tmp_path / "things" / "table.stl")
    (tmp_path / "props" / "other.stl").write_bytes(trimesh.creation.box().export(file_type="stl"))
    opened = open_project(saved)
    assert opened.project.props[ident].path == "things/table.stl"
    assert any("was moved" in note and "things/table.stl" in note for note in opened.notes)
    save_project(opened.project, saved)
    assert not any("moved" in note for note in open_project(saved).notes)


def test_a_changed_file_is_told_once(desk: tuple[Project, str], tmp_path: Path) -> None:
    project, ident = desk
    (tmp_path / "props" / "desk.stl").write_bytes(trimesh.creation.box().export(file_type="stl"))
    after, notes = find_prop_files(project, tmp_path)
    assert len(notes) == 1 and "has changed" in notes[0]
    assert after.props[ident].sha256 != project.props[ident].sha256
    assert find_prop_files(after, tmp_path) == (after, [])


def test_a_lost_file_without_a_digest_or_with_another_content_is_missing(
    desk: tuple[Project, str], tmp_path: Path
) -> None:
    project, ident = desk
    (tmp_path / "props" / "desk.stl").unlink()
    (tmp_path / "desk.stl").write_bytes(trimesh.creation.box().export(file_type="stl"))
    old = replace(project, props={ident: Prop(name="desk", path="props/desk.stl")})
    for lost in (project, old):
        after, notes = find_prop_files(lost, tmp_path)
        assert after is lost and "there is no file" in notes[0]
