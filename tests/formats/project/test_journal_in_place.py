"""A journal that is removed, replaced or moved while it is written is there again, with every edit."""

from __future__ import annotations

import os
import shutil
from pathlib import Path

import pytest

from metagraph.errors import FileError
from metagraph.formats.locking import make_owner
from metagraph.formats.project.data import to_data
from metagraph.formats.project.journal import Journal, make_journal_path
from metagraph.formats.recovery import find_left_journals, read_journal
from metagraph.formats.store import SUFFIX, save_project
from metagraph.graph import edits
from metagraph.graph.model import Project
from tests.sittings import kill_sittings

pytestmark = pytest.mark.skipif(os.name == "nt", reason="Windows removes and moves no open file")


class Sitting:
    def __init__(self, folder: Path) -> None:
        self.saved = folder / f"show{SUFFIX}"
        self.project = Project("show")
        save_project(self.project, self.saved)
        self.journal = Journal(make_journal_path(self.saved, "ab12"), self.saved, make_owner())
        self.edit("first")

    def edit(self, name: str) -> None:
        before, self.project = self.project, edits.rename_project(self.project, name)
        self.journal.edit(before, self.project, name)

    def kept(self) -> str | None:
        found = read_journal(self.journal.path, self.saved)
        return found.project.name if found is not None else None


@pytest.fixture
def sitting(tmp_path: Path):
    folder = tmp_path / "folder"
    folder.mkdir()
    sitting = Sitting(folder)
    yield sitting
    sitting.journal.close()


def remove(path: Path) -> None:
    path.unlink()


def rename(path: Path) -> None:
    path.rename(path.with_name("elsewhere"))


def move_away(path: Path) -> None:
    bin_ = path.parent.parent / "bin"
    bin_.mkdir()
    path.rename(bin_ / path.name)


def replace_by_older(path: Path) -> None:
    """As a sync client does."""
    other = path.with_name("other")
    other.write_bytes(path.read_bytes()[:-40])
    other.replace(path)


def remove_and_make_folder_again(path: Path) -> None:
    saved = [(p.name, p.read_bytes()) for p in path.parent.iterdir() if p != path]
    shutil.rmtree(path.parent)
    path.parent.mkdir()
    for name, content in saved:
        (path.parent / name).write_bytes(content)


HARM = [remove, rename, move_away, replace_by_older, remove_and_make_folder_again]


@pytest.mark.parametrize("harm", HARM)
def test_the_next_edit_writes_all_of_it_again(sitting: Sitting, harm) -> None:
    harm(sitting.journal.path)
    sitting.edit("second")
    assert sitting.kept() == "second"
    assert len(sitting.journal.notes) == 1 and "written it again" in str(sitting.journal.notes[0])
    sitting.edit("third")
    assert sitting.kept() == "third" and len(sitting.journal.notes) == 1, "it is said once"


@pytest.mark.parametrize("harm", HARM)
def test_whoever_looks_after_it_finds_it_without_an_edit(sitting: Sitting, harm) -> None:
    harm(sitting.journal.path)
    sitting.journal.touch()
    assert sitting.kept() == "first" and sitting.journal.notes
    assert sitting.journal.secure()


@pytest.mark.parametrize("harm", HARM)
def test_it_is_not_called_safe_before_it_is_there_again(
    sitting: Sitting, harm, monkeypatch: pytest.MonkeyPatch
) -> None:
    harm(sitting.journal.path)

    def full(*args, **more):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("metagraph.formats.project.appended_file.replace_file", full)
    assert not sitting.journal.secure() and sitting.journal.error is not None
    with pytest.raises(FileError, match="cannot be written"):
        sitting.edit("second")
    monkeypatch.undo()
    sitting.edit("third")
    assert sitting.kept() == "third" and sitting.journal.secure()


def test_what_somebody_put_in_its_place_is_kept(sitting: Sitting) -> None:
    path = sitting.journal.path
    path.unlink()
    other = Journal(path, sitting.saved, make_owner())
    other.edit(Project("show"), edits.rename_project(Project("show"), "another's"))
    other.close()
    sitting.edit("second")
    assert sitting.kept() == "second"
    kill_sittings(path.parent)
    names = {read_journal(one, sitting.saved).project.name for one in find_left_journals(sitting.saved)}  # type: ignore[union-attr]
    assert names == {"second", "another's"}


def test_it_goes_with_its_folder(sitting: Sitting) -> None:
    folder = sitting.saved.parent
    folder.rename(folder.with_name("renamed"))
    sitting.edit("second")
    assert not folder.exists(), "the old folder is not made again"
    assert sitting.journal.path.parent == folder.with_name("renamed")
    found = read_journal(sitting.journal.path, folder.with_name("renamed") / sitting.saved.name)
    assert found is not None and to_data(found.project) == to_data(sitting.project)
    assert "renamed" in str(sitting.journal.notes[0]) and sitting.journal.secure()


def test_a_folder_that_is_gone_is_an_error_and_is_not_made_again(sitting: Sitting) -> None:
    shutil.rmtree(sitting.saved.parent)
    with pytest.raises(FileError, match="cannot be written"):
        sitting.edit("second")
    assert not sitting.saved.parent.exists() and not sitting.journal.secure()
