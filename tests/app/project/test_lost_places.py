"""Projects whose file, folder or journal was moved, removed or damaged: the work is offered, wherever it lies."""

from __future__ import annotations

import os
import shutil
from pathlib import Path

import pytest
from PySide6.QtWidgets import QFileDialog, QMessageBox, QWidget

from app.project import questions
from app.project.autosave import state_folder
from app.project.document import Document
from app.project.files import Files
from app.project.jobs import Jobs
from app.project.leftovers import list_known_journals, look_beside
from metagraph.formats.locking import lock_path, make_owner
from metagraph.formats.recovery import DAMAGED
from metagraph.formats.store import read_project, save_project
from metagraph.graph import edits
from tests.app import recovering
from tests.sittings import kill_sittings


class Desk(Files):
    """Files that keep what they said; `answers` are given to the questions in turn."""

    def __init__(self, window, monkeypatch):
        super().__init__(Document(window), Jobs(window), window)
        self.asked, self.next, self.words, self.reports, self.notices, self.warned = [], [], [], [], [], []
        recovering.answers(monkeypatch, self)
        self.told.connect(self.words.append)
        self.report.connect(lambda title, lines: self.reports.append((title, list(lines))))
        self.noticed.connect(lambda *words: self.notices.append(words))
        monkeypatch.setattr(QMessageBox, "warning", lambda *a, **k: self.warned.append(a[2]))

    def idle(self) -> bool:
        return not self.jobs.running and not self.saver.busy


@pytest.fixture
def desk(qtbot, monkeypatch):
    window = QWidget()
    qtbot.addWidget(window)
    desk = Desk(window, monkeypatch)
    yield desk
    desk.jobs.stop()
    desk.document.close_journal()


@pytest.fixture
def saved(toy, tmp_path):
    path = tmp_path / "folder" / "show.metagraph.yaml"
    path.parent.mkdir()
    save_project(toy.project(), path)
    return path


def opened(desk, path, qtbot):
    desk.open(path)
    qtbot.waitUntil(desk.idle)


def seed(desk, value):
    desk.document.edit("Change seed", lambda p: edits.set_settings(p, seed=value))


def crash(desk):
    """Forget the document without closing it, as a killed program does."""
    document = desk.document
    place = document.journal_place
    document.autosave.journal.close()
    for folder in {place.parent, document.path.parent}:
        if folder.is_dir():
            kill_sittings(folder)
    document.autosave.journal = document.lock = None
    document.owner = make_owner()
    document.undo_stack.setClean()


def crashed(desk, saved, qtbot):
    opened(desk, saved, qtbot)
    seed(desk, 7)
    seed(desk, 8)
    place = desk.document.journal_place
    crash(desk)
    desk.new()
    return place


# --- the project file is gone, or is another one


def recovered(desk, qtbot, how):
    desk.next = [("recover",)]
    how()
    qtbot.waitUntil(lambda: not desk.next and desk.idle())
    return desk.document.project.settings.seed


def test_a_deleted_projects_edits_are_offered_and_saving_writes_it_again(desk, saved, qtbot):
    crashed(desk, saved, qtbot)
    saved.unlink()
    assert recovered(desk, qtbot, desk.recover) == 8
    assert "no longer exists" in desk.asked[0]
    assert desk.document.path == saved and desk.document.dirty
    desk.save()
    qtbot.waitUntil(lambda: desk.idle() and not desk.document.dirty)
    assert read_project(saved).settings.seed == 8
    assert "was written again" in desk.words[-1]


@pytest.mark.parametrize("content", [b"", b"\x00" * 5000, b"a: [", b"metagraph: 1\nsettings: 3\n"])
def test_a_file_that_was_destroyed_offers_its_edits_at_once(desk, saved, qtbot, content):
    crashed(desk, saved, qtbot)
    saved.write_bytes(content)
    assert recovered(desk, qtbot, lambda: desk.open(saved)) == 8
    assert saved.name in desk.asked[0]


def test_a_renamed_file_finds_its_edits(desk, saved, qtbot):
    crashed(desk, saved, qtbot)
    renamed = saved.with_name("renamed.metagraph.yaml")
    saved.rename(renamed)
    assert recovered(desk, qtbot, lambda: desk.open(renamed)) == 8
    assert "named show.metagraph.yaml" in desk.asked[0]


@pytest.mark.skipif(os.name == "nt", reason="links need rights on Windows")
@pytest.mark.parametrize("first_by_link", [True, False])
def test_a_linked_file_finds_its_edits_by_either_path(desk, saved, qtbot, first_by_link, tmp_path):
    link = tmp_path / "elsewhere.metagraph.yaml"
    link.symlink_to(saved)
    crashed(desk, link if first_by_link else saved, qtbot)
    assert recovered(desk, qtbot, lambda: desk.open(saved if first_by_link else link)) == 8


def test_a_moved_file_finds_its_edits_where_they_stayed(desk, saved, qtbot, tmp_path):
    place = crashed(desk, saved, qtbot)
    moved = tmp_path / "moved" / saved.name
    moved.parent.mkdir()
    shutil.move(saved, moved)
    assert recovered(desk, qtbot, lambda: desk.open(moved)) == 8
    assert not place.exists(), "it was taken over"


def test_a_copy_of_a_project_is_not_offered_the_edits_of_the_other(desk, saved, qtbot, tmp_path):
    crashed(desk, saved, qtbot)
    copy = tmp_path / "copy" / saved.name
    copy.parent.mkdir()
    shutil.copy(saved, copy)
    found = look_beside(copy, make_owner())
    assert not found.left
    found.lock.release()


def test_a_renamed_folder_is_found_by_the_list_of_all(desk, saved, qtbot):
    crashed(desk, saved, qtbot)
    folder = saved.parent.with_name("renamed")
    saved.parent.rename(folder)
    assert recovered(desk, qtbot, desk.recover) == 8
    assert desk.document.path == folder / saved.name


def test_a_folder_that_is_gone_leaves_nothing_to_offer_and_no_error(desk, saved, qtbot):
    crashed(desk, saved, qtbot)
    shutil.rmtree(saved.parent)
    desk.recover()
    qtbot.waitUntil(lambda: desk.idle() and bool(desk.words))
    assert "nothing to recover" in desk.words[-1]


# --- damage


def test_a_damaged_journal_says_what_is_lost_and_is_kept_until_it_is_discarded(desk, saved, qtbot):
    place = crashed(desk, saved, qtbot)
    place.write_bytes(place.read_bytes().replace(b'"seed":7', b'"seed":\x00'))
    assert recovered(desk, qtbot, lambda: desk.open(saved)) == 8
    assert "1 edit is damaged" in desk.asked[0]
    lines = next(lines for title, lines in desk.reports if "damaged" in title)
    assert any("Seed 1 → 7" in line for line in lines)
    kept = place.with_name(place.name + DAMAGED)
    assert kept.exists() and not place.exists()
    desk.document.save()
    desk.new()
    assert list_known_journals([saved]) == [kept], "it can be looked for again"
    desk.next = [("discard",)]
    desk.recover()
    qtbot.waitUntil(lambda: not desk.next and desk.idle())
    assert not kept.exists()


# --- the folder while it is open


def test_saving_to_a_renamed_folder_asks_and_goes_there(desk, saved, qtbot, monkeypatch):
    opened(desk, saved, qtbot)
    seed(desk, 7)
    folder = saved.parent.with_name("renamed")
    saved.parent.rename(folder)
    asked = []
    monkeypatch.setattr(questions, "ask_folder_gone", lambda _, error: asked.append(error.place) or "there")
    seed(desk, 8)
    desk.save()
    qtbot.waitUntil(lambda: desk.idle() and not desk.document.dirty)
    assert asked == [folder] and not saved.parent.exists()
    assert desk.document.path == folder / saved.name
    assert read_project(folder / saved.name).settings.seed == 8
    assert lock_path(folder / saved.name).exists()
    desk.document.close_journal()
    kept = {saved.name, f"{saved.name}.1"}
    assert {path.name for path in folder.iterdir()} == kept, "no lock and no journal stays"


def test_without_an_edit_a_renamed_folder_is_noticed_too(desk, saved, qtbot, monkeypatch):
    opened(desk, saved, qtbot)
    saved.parent.rename(saved.parent.with_name("renamed"))
    asked = []
    monkeypatch.setattr(questions, "ask_folder_gone", lambda _, error: asked.append(error.place))
    desk.save()
    qtbot.waitUntil(lambda: desk.idle() and bool(asked))
    assert asked == [saved.parent.with_name("renamed")] and not saved.parent.exists()


def test_edits_of_a_folder_that_is_gone_are_kept_and_offered(desk, saved, qtbot, monkeypatch, tmp_path):
    opened(desk, saved, qtbot)
    seed(desk, 7)
    content = saved.read_bytes()
    shutil.rmtree(saved.parent)
    seed(desk, 8)
    assert desk.document.secured() and desk.document.journal_place.is_relative_to(state_folder())
    qtbot.waitUntil(lambda: bool(desk.notices))
    desk.notices[0][2]()
    assert "Metagraph's own folder" in desk.reports[-1][1][0]
    asked = []
    monkeypatch.setattr(questions, "ask_folder_gone", lambda _, error: asked.append(error.place) or "save as")
    elsewhere = tmp_path / "elsewhere.metagraph.yaml"
    monkeypatch.setattr(QFileDialog, "getSaveFileName", lambda *a, **k: ("", ""))
    desk.save()
    qtbot.waitUntil(lambda: desk.idle() and bool(asked))
    assert asked == [None] and not saved.parent.exists() and desk.document.dirty
    crash(desk)
    desk.new()
    saved.parent.mkdir()
    saved.write_bytes(content)  # the drive is there again
    assert recovered(desk, qtbot, lambda: desk.open(saved)) == 8
    desk.document.save(elsewhere)
    assert read_project(elsewhere).settings.seed == 8


@pytest.mark.skipif(not Path("/proc/self/fd").is_dir(), reason="this system lists no open files")
def test_a_folder_that_goes_and_comes_back_leaves_no_open_files_and_no_journals(desk, saved, qtbot, tmp_path):
    opened(desk, saved, qtbot)
    away = tmp_path / "away"
    handles, listed = [], []
    for n in range(4):
        seed(desk, 2 * n + 1)
        shutil.copytree(saved.parent, away)
        shutil.rmtree(saved.parent)
        seed(desk, 2 * n + 2)
        assert desk.document.secured() and desk.document.journal_place.is_relative_to(state_folder())
        away.rename(saved.parent)
        desk.document.save()
        assert read_project(saved).settings.seed == 2 * n + 2
        assert not list(saved.parent.glob(".*.journal")), "what it held is saved"
        handles.append(len(list(Path("/proc/self/fd").iterdir())))
        listed.append(list((state_folder() / "journals").glob("*")))
    assert max(handles) == handles[0] and not any(listed)


def test_looking_after_it_moves_edits_out_of_a_folder_that_is_gone(desk, saved, qtbot):
    opened(desk, saved, qtbot)
    seed(desk, 7)
    shutil.rmtree(saved.parent)
    desk.keeper.refresh()
    qtbot.waitUntil(lambda: bool(desk.notices))
    assert desk.document.journal_place.is_relative_to(state_folder()) and desk.document.secured()


def test_a_removed_lock_is_there_again_and_told(desk, saved, qtbot):
    opened(desk, saved, qtbot)
    lock_path(saved).unlink()
    desk.keeper.refresh()
    qtbot.waitUntil(lambda: bool(desk.notices))
    assert lock_path(saved).exists() and desk.document.lock.held
    desk.notices[0][2]()
    assert "other windows" in desk.reports[-1][1][0]


def test_a_removed_journal_is_written_again_and_told(desk, saved, qtbot):
    opened(desk, saved, qtbot)
    seed(desk, 7)
    place = desk.document.journal_place
    place.unlink()
    assert desk.document.secured() and place.exists()
    qtbot.waitUntil(lambda: bool(desk.notices))
    desk.notices[0][2]()
    assert "written it again" in desk.reports[-1][1][0]
