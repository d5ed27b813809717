"""File > Earlier versions: what saves have kept, in words and pictures, opened as a copy."""

from __future__ import annotations

from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest

from app.features.files.versions_dialog import VersionsDialog, find_versions
from app.project.version_count import count_kept_versions
from metagraph.formats.gltf.writer import write_glb
from metagraph.formats.project.versions import list_earlier_versions, make_version_path
from metagraph.formats.store import SUFFIX, read_project, save_project
from metagraph.graph import edits
from metagraph.graph.model import Project

pytestmark = [pytest.mark.window, pytest.mark.gl]


@pytest.fixture
def path(drive, toy, tmp_path: Path) -> Path:
    """A project in the window, saved three times."""
    (tmp_path / "clips").mkdir()
    write_glb(tmp_path / "clips" / "wave.glb", [toy.clip("wave", 1.0)])
    path = tmp_path / f"mine{SUFFIX}"
    save_project(Project("mine"), path)
    drive.files.open(path)
    drive.wait(lambda: drive.document.path == path)
    drive.importing.import_paths([str(tmp_path / "clips")])
    drive.wait(lambda: bool(drive.document.project.clips))
    drive.files.save()
    assert drive.files.saver.wait()
    drive.document.edit("Rename", lambda p: edits.rename_project(p, "other"))
    drive.files.save()
    assert drive.files.saver.wait()
    return path


@pytest.fixture
def dialog(drive, path: Path) -> VersionsDialog:
    drive.shell.actions["versions"].trigger()
    drive.wait(lambda: any(d.isVisible() for d in drive.window.findChildren(VersionsDialog)))
    return next(d for d in drive.window.findChildren(VersionsDialog) if d.isVisible())


def rows(shown) -> list[str]:
    return [shown.item(n).text() for n in range(shown.count())]


@pytest.mark.nightly
def test_versions_are_listed_with_what_changed_since(drive, dialog: VersionsDialog) -> None:
    assert [text.split(",")[0] for text in rows(dialog.versions)] == ["Version 1", "Version 2"]
    assert "1 clip, 0 actions\n1 change " in rows(dialog.versions)[0]
    assert not dialog.versions.item(0).icon().isNull()
    assert rows(dialog.changes) == ["Name changed: 'mine' → 'other'"]
    QTest.keyClick(dialog.versions, Qt.Key.Key_Down)
    assert rows(dialog.changes) == [
        "Name changed: 'mine' → 'other'",
        "Skeleton changed",
        "Clip 'wave' added",
    ]
    dialog.reject()


@pytest.mark.nightly
def test_return_opens_the_chosen_one_as_a_copy_that_replaces_nothing(
    drive, dialog: VersionsDialog, path: Path
) -> None:
    before = path.read_bytes()
    QTest.keyClick(dialog.versions, Qt.Key.Key_Return)
    drive.wait(lambda: drive.document.path is None)
    project = drive.document.project
    assert project.name.startswith("other ") and [e.motion is not None for e in project.clips.values()] == [
        True
    ]
    assert path.read_bytes() == before and len(list_earlier_versions(path)) == 2
    assert not path.with_name(f".{path.name}.lock").exists()


@pytest.mark.nightly
def test_one_that_cannot_be_read_says_why_and_is_not_opened(drive, path: Path) -> None:
    make_version_path(path, 1).write_text("- no project")
    found = find_versions(path, drive.document.project)
    dialog = VersionsDialog(path.name, found, lambda _: pytest.fail("it cannot be opened"), drive.window)
    assert rows(dialog.versions)[0].endswith("Cannot be read") and not dialog.go.isEnabled()
    assert rows(dialog.changes)[0].startswith(f"{path.name}.1")
    dialog.open_chosen()
    dialog.versions.setCurrentRow(1)
    assert dialog.go.isEnabled()
    dialog.deleteLater()


@pytest.mark.nightly
def test_how_many_are_kept_is_set_there_and_none_is_said_in_words(drive, path: Path) -> None:
    dialog = VersionsDialog(path.name, (), lambda _: None, drive.window)
    assert dialog.count.value() == 3 and dialog.current is None and not dialog.go.isEnabled()
    dialog.count.setValue(1)
    assert count_kept_versions() == 1
    dialog.count.setValue(0)
    assert dialog.count.text() == "none"
    dialog.deleteLater()


@pytest.mark.nightly
def test_a_save_whose_version_cannot_be_kept_is_whole_and_tells_so(drive, path: Path) -> None:
    told: list[object] = []
    drive.files.report.connect(lambda title, lines: told.append((title, lines)))
    make_version_path(path, 3).mkdir()
    drive.document.edit("Rename", lambda p: edits.rename_project(p, "third"))
    drive.files.save()
    assert drive.files.saver.wait() and not drive.document.dirty
    assert read_project(path).name == "third"
    ((title, (line,)),) = told
    assert title == f"Saved {path.name}, with a warning" and "is a folder" in line


def test_the_command_waits_for_a_file(drive) -> None:
    assert not drive.shell.actions["versions"].isEnabled()


@pytest.mark.nightly
def test_a_version_that_is_opened_as_a_file_is_a_copy(drive, path: Path) -> None:
    drive.files.open(make_version_path(path, 1))
    drive.wait(lambda: drive.document.path is None and bool(drive.document.project.clips))
    before = make_version_path(path, 1).read_bytes()
    drive.document.edit("Rename", lambda p: edits.rename_project(p, "changed"))
    assert (
        make_version_path(path, 1).read_bytes() == before
        and not make_version_path(make_version_path(path, 1), 1).exists()
    )
