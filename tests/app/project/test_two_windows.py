"""Two windows on one project: the second is told who has it, and whatever either does, neither's edits are
lost.
"""

from __future__ import annotations

import os
import time

import msgspec
import pytest
from PySide6.QtWidgets import QFileDialog, QMessageBox, QWidget

from app.project import questions
from app.project.document import Document
from app.project.files import Files
from app.project.jobs import Jobs
from metagraph.formats.locking import STALE, lock_path, make_owner
from metagraph.formats.project.journal import Journal, make_journal_path
from metagraph.formats.recovery import find_left_journals, read_journal
from metagraph.formats.store import read_project, save_project
from metagraph.graph import edits
from metagraph.graph.model import Project
from tests.app import recovering
from tests.sittings import ended, kill_sittings

BUTTON = QMessageBox.StandardButton


class Answers:
    """Stands in for the person: chooses buttons by their words, in the order given, and keeps what was
    asked.
    """

    def __init__(self, monkeypatch):
        self.next, self.asked, self.warned, self.patch = [], [], [], monkeypatch
        monkeypatch.setattr(QMessageBox, "exec", lambda box: self._answer(box))
        monkeypatch.setattr(
            QMessageBox, "question", lambda *a, **k: (self.asked.append(a[2]), self.next.pop(0))[1]
        )
        monkeypatch.setattr(QMessageBox, "warning", lambda *a, **k: self.warned.append(a[2]))
        recovering.answers(monkeypatch, self)

    def _answer(self, box):
        self.asked.append(f"{box.text()} {box.informativeText()}")
        self.buttons = [b.text().replace("&", "") for b in box.buttons()]
        wanted = self.next.pop(0)
        chosen = next(b for b in box.buttons() if b.text().replace("&", "") == wanted)
        self.patch.setattr(QMessageBox, "clickedButton", lambda box: chosen)

    def save_as(self, path) -> None:
        self.patch.setattr(QFileDialog, "getSaveFileName", lambda *a, **k: (str(path) if path else "", ""))


@pytest.fixture
def person(monkeypatch):
    return Answers(monkeypatch)


@pytest.fixture
def windows(qtbot, person):
    """Makes windows' files; those of one process are as apart as those of two."""
    made = []

    def make() -> Files:
        window = QWidget()
        qtbot.addWidget(window)
        files = Files(Document(window), Jobs(window), window)
        files.words = []
        files.told.connect(files.words.append)
        made.append(files)
        return files

    yield make
    for files in made:
        files.jobs.stop()
        files.document.close_journal()


@pytest.fixture
def saved(toy, tmp_path):
    path = tmp_path / "show.metagraph.yaml"
    save_project(toy.project(), path)
    return path


def opened(qtbot, files, path):
    """Open a file and wait until it is there or was given up."""
    files.open(path)
    qtbot.waitUntil(lambda: not files.jobs.running)
    return files


def seed(files, value):
    files.document.edit("Change seed", lambda p: edits.set_settings(p, seed=value))


def on_disk(path):
    return read_project(path).settings.seed


# --- who has it


def test_the_second_window_says_who_has_it_and_opens_read_only(windows, person, saved, qtbot, tmp_path):
    one = opened(qtbot, windows(), saved)
    assert lock_path(saved).exists() and not person.asked
    person.next = ["Open read-only"]
    two = opened(qtbot, windows(), saved)
    owner = one.document.owner
    assert owner.user in person.asked[0] and owner.host in person.asked[0]
    assert time.strftime("%H:%M", time.localtime(owner.since)) in person.asked[0]
    assert set(person.buttons) == {"Open read-only", "Open a copy", "Cancel"}, "nobody takes over what lives"
    assert two.document.read_only and two.document.path == saved
    seed(one, 5)
    seed(two, 6)
    one.save()
    qtbot.waitUntil(lambda: not one.document.dirty)
    person.save_as(tmp_path / "mine.metagraph.yaml")
    two.save()
    qtbot.waitUntil(lambda: not two.document.dirty)
    assert (on_disk(saved), on_disk(tmp_path / "mine.metagraph.yaml")) == (5, 6)
    assert not two.document.read_only


def test_a_file_of_a_newer_metagraph_opens_read_only_and_is_saved_elsewhere(
    windows, person, saved, qtbot, tmp_path
):
    text = saved.read_text(encoding="utf-8").replace("metagraph: 2", "metagraph: 3\ngravity: 9.81")
    saved.write_text(text, encoding="utf-8")
    one = opened(qtbot, windows(), saved)
    assert one.document.read_only
    seed(one, 6)
    person.save_as(saved)
    one.save()
    qtbot.waitUntil(lambda: bool(person.warned))
    assert "Update Metagraph, or save under another name" in person.warned[0]
    assert saved.read_text(encoding="utf-8") == text
    person.save_as(tmp_path / "mine.metagraph.yaml")
    one.save()
    qtbot.waitUntil(lambda: not one.document.dirty)
    assert on_disk(tmp_path / "mine.metagraph.yaml") == 6 and not one.document.read_only


def test_the_second_windows_edits_do_not_touch_the_firsts_journal(windows, person, saved, qtbot):
    one = opened(qtbot, windows(), saved)
    seed(one, 5)
    before = one.document.journal_place.read_bytes()
    person.next = ["Open read-only"]
    two = opened(qtbot, windows(), saved)
    seed(two, 6)
    assert one.document.journal_place.read_bytes() == before
    assert len(list(saved.parent.glob(".*.journal"))) == 2
    two.document.close_journal()
    assert one.document.journal_place.read_bytes() == before and lock_path(saved).exists()


def test_a_read_only_window_cannot_save_over_what_the_other_has_open(windows, person, saved, qtbot):
    one = opened(qtbot, windows(), saved)
    person.next = ["Open read-only"]
    two = opened(qtbot, windows(), saved)
    seed(two, 6)
    person.save_as(saved)
    assert not two.save()
    assert "open in another window" in person.warned[0]
    one.document.close_journal()
    assert two.save(), "it is nobody's now"
    qtbot.waitUntil(lambda: not two.document.dirty)
    assert on_disk(saved) == 6 and not two.document.read_only


def test_a_copy_is_a_project_of_its_own(windows, person, saved, qtbot):
    opened(qtbot, windows(), saved)
    person.next = ["Open a copy"]
    two = opened(qtbot, windows(), saved)
    assert two.document.path is None and not two.document.read_only and len(two.document.project.clips) > 3


def test_cancelling_leaves_all_as_it_was(windows, person, saved, qtbot):
    opened(qtbot, windows(), saved)
    person.next = ["Cancel"]
    two = windows()
    before = two.document.project
    opened(qtbot, two, saved)
    assert two.document.project is before


def test_opening_the_same_file_again_asks_nothing(windows, person, saved, qtbot):
    one = opened(qtbot, windows(), saved)
    opened(qtbot, one, saved)
    assert not person.asked and one.document.lock.held and lock_path(saved).exists()


def test_the_file_is_given_back_when_another_is_opened_or_the_window_closes(windows, saved, qtbot):
    one = opened(qtbot, windows(), saved)
    one.document.load(Project(), None)
    assert not lock_path(saved).exists()
    opened(qtbot, one, saved)
    one.document.close_journal()
    assert not lock_path(saved).exists()


def test_a_file_that_cannot_be_opened_is_not_kept_from_others(windows, person, saved, qtbot):
    saved.write_text("a: [")
    opened(qtbot, windows(), saved)
    assert person.warned and not lock_path(saved).exists()


def test_a_lock_on_a_sleeping_computer_is_taken_over_when_that_is_chosen(windows, person, saved, qtbot):
    path = lock_path(saved)
    path.write_bytes(msgspec.json.encode(msgspec.structs.replace(make_owner(), host="studio-3", user="ada")))
    os.utime(path, (time.time() - STALE * 2,) * 2)
    person.next = ["Take over"]
    two = opened(qtbot, windows(), saved)
    assert "ada on studio-3" in person.asked[0]
    assert two.document.lock.held and not two.document.read_only


def test_who_was_taken_over_becomes_read_only_and_loses_nothing(windows, person, saved, qtbot):
    one = opened(qtbot, windows(), saved)
    seed(one, 5)
    lock_path(saved).write_bytes(msgspec.json.encode(msgspec.structs.replace(make_owner(), host="studio-3")))
    one.keeper.refresh()
    qtbot.waitUntil(lambda: one.document.read_only)
    assert "show.metagraph.yaml" in one.words[-1]
    person.save_as(None)
    assert not one.save(), "it asks for another place"
    kill_sittings(saved.parent)
    assert len(find_left_journals(saved)) == 1


def test_a_folder_that_takes_no_lock_opens_all_the_same(windows, person, saved, qtbot):
    lock_path(saved).mkdir()
    one = opened(qtbot, windows(), saved)
    seed(one, 5)
    one.save()
    qtbot.waitUntil(lambda: not one.document.dirty)
    assert on_disk(saved) == 5 and not person.asked


# --- crashes


def crashed(saved, number, count=1, base=None):
    """Leave the journal of a sitting that was killed after some edits; return its project."""
    before = base or read_project(saved)
    owner = msgspec.structs.replace(make_owner(), pid=ended())
    journal = Journal(make_journal_path(saved, owner.sitting), saved, owner)
    for n in range(count):
        after = edits.set_settings(before, seed=number + n)
        journal.edit(before, after)
        before = after
    journal.close()
    os.utime(journal.path, (time.time() - 1000 + number,) * 2)
    return before


def test_each_of_two_sittings_that_crashed_is_offered_and_none_is_lost(windows, person, saved, qtbot):
    crashed(saved, 10)
    crashed(saved, 20, 2)
    person.next = [("recover", "copy")]
    one = opened(qtbot, windows(), saved)
    assert person.asked[0].index("2 unsaved edits") < person.asked[0].index("1 unsaved edit,"), (
        "the latest first"
    )
    assert one.document.project.settings.seed == 21 and one.document.dirty
    copy = saved.with_name("show recovered.metagraph.yaml")
    assert on_disk(copy) == 10
    assert find_left_journals(saved) == []


def test_the_older_sitting_is_offered_when_the_newer_is_declined(windows, person, saved, qtbot):
    crashed(saved, 10)
    crashed(saved, 20)
    person.next = [("discard", "recover")]
    one = opened(qtbot, windows(), saved)
    assert one.document.project.settings.seed == 10
    assert [p.name for p in saved.parent.glob(".*.journal")] == [one.document.journal_place.name]


def test_what_was_recovered_is_there_still_after_a_second_crash_without_an_edit(
    windows, person, saved, qtbot
):
    crashed(saved, 10, 3)
    person.next = [("recover",)]
    one = opened(qtbot, windows(), saved)
    one.document.autosave.journal.close()
    kill_sittings(saved.parent)
    person.next = [("recover",)]
    two = opened(qtbot, windows(), saved)
    assert "3 unsaved edits" in person.asked[-1]
    assert two.document.project.settings.seed == 12
    one.document._journal = one.document.lock = None


def test_a_read_only_windows_edits_survive_its_crash_though_the_file_went_on(windows, person, saved, qtbot):
    one = opened(qtbot, windows(), saved)
    person.next = ["Open read-only"]
    two = opened(qtbot, windows(), saved)
    seed(two, 6)
    seed(one, 5)
    one.save()
    qtbot.waitUntil(lambda: not one.document.dirty)
    one.document.close_journal()
    two.document.autosave.journal.close()
    two.document.autosave.journal = None
    kill_sittings(saved.parent)
    person.next = [("recover",)]
    three = opened(qtbot, windows(), saved)
    assert "Someone else has saved" in person.asked[-1]
    assert three.document.project.settings.seed == 6
    person.next = ["Cancel"]
    three.save()
    qtbot.waitUntil(lambda: not person.next)
    assert "changed on disk" in person.asked[-1] and on_disk(saved) == 5


def test_a_project_never_saved_in_each_of_two_windows_is_kept_apart(windows, person, qtbot):
    one, two = windows(), windows()
    seed(one, 5)
    seed(two, 6)
    places = {one.document.journal_place, two.document.journal_place}
    assert len(places) == 2 and all(place.exists() for place in places)
    three = windows()
    three.recover_untitled()
    assert not person.asked, "both live"
    for files in (one, two):
        files.document.autosave.journal.close()
        files.document.autosave.journal = None
    kill_sittings(one.document.journal_place.parent)
    person.next = [("recover", "later")]
    three.recover_untitled()
    qtbot.waitUntil(lambda: three.document.dirty)
    assert "Kept 1 project" in three.words[-1]
    four = windows()
    person.next = [("recover",)]
    four.recover_untitled()
    qtbot.waitUntil(lambda: four.document.dirty)
    assert {three.document.project.settings.seed, four.document.project.settings.seed} == {5, 6}


# --- files that change


def rewrite(saved, value):
    save_project(edits.set_settings(read_project(saved), seed=value), saved)


@pytest.mark.parametrize(
    ("answer", "disk", "here"),
    [
        ("Cancel", 99, 7),
        ("Save anyway", 7, 7),
        ("Reload", 99, 99),
        ("Save as…", 99, 7),
        ("Merge", 99, 7),
    ],
)
def test_saving_over_what_another_program_wrote_asks(
    windows, person, saved, qtbot, tmp_path, answer, disk, here
):
    one = opened(qtbot, windows(), saved)
    seed(one, 7)
    rewrite(saved, 99)
    person.next = [answer]
    person.save_as(tmp_path / "mine.metagraph.yaml")
    one.save()
    qtbot.waitUntil(lambda: not person.next)
    qtbot.waitUntil(lambda: not one.saver.busy and not one.jobs.running)
    assert (on_disk(saved), one.document.project.settings.seed) == (disk, here)
    assert one.document.dirty is (answer in ("Cancel", "Merge"))
    assert set(person.buttons) == {
        "Merge", "Save as…", "Reload", "Show differences", "Save anyway", "Cancel"
    }  # fmt: skip
    if answer == "Reload":
        one.document.undo()
        assert one.document.project.settings.seed == 7, "the edits are one step back"


def test_what_was_done_on_both_sides_is_merged_and_saved(windows, person, saved, qtbot):
    one = opened(qtbot, windows(), saved)
    seed(one, 7)
    save_project(edits.rename_project(read_project(saved), "theirs"), saved)
    person.next = ["Merge"]
    one.save()
    qtbot.waitUntil(lambda: one.document.project.name == "theirs")
    assert one.document.project.settings.seed == 7 and on_disk(saved) != 7
    kill = read_journal(one.document.journal_place, saved)
    assert kill is not None and kill.project.name == "theirs" and not kill.behind, "a crash now loses nothing"
    one.save()
    qtbot.waitUntil(lambda: not one.document.dirty)
    both = read_project(saved)
    assert (both.name, both.settings.seed) == ("theirs", 7)
    one.document.undo()
    assert one.document.project.name == "toy" and one.document.dirty


def test_the_differences_are_listed_side_by_side_before_choosing(windows, person, saved, qtbot, monkeypatch):
    one = opened(qtbot, windows(), saved)
    seed(one, 7)
    rewrite(saved, 99)
    seen = []

    def read(dialog):
        for shown in dialog.findChildren(questions.QListWidget):
            seen.append((shown.accessibleName(), [shown.item(n).text() for n in range(shown.count())]))

    monkeypatch.setattr(questions.DifferencesDialog, "exec", read)
    person.next = ["Show differences", "Cancel"]
    one.save()
    qtbot.waitUntil(lambda: not person.next)
    assert seen == [
        ("Changed on disk", ["Settings changed: seed 1 → 99"]),
        ("Changed here", ["Settings changed: seed 1 → 7"]),
    ]


@pytest.mark.parametrize("dirty", [False, True])
def test_a_file_that_changes_while_it_is_open_is_told_of_once(windows, person, saved, qtbot, dirty):
    one = opened(qtbot, windows(), saved)
    notices = []
    one.noticed.connect(lambda *a: notices.append(a))
    if dirty:
        seed(one, 7)
    one.look_at_file()
    qtbot.wait(100)
    assert not notices
    rewrite(saved, 99)
    one.look_at_file()
    qtbot.waitUntil(lambda: bool(notices))
    one.look_at_file()
    qtbot.wait(100)
    assert len(notices) == 1
    words, _, show = notices[0]
    assert ("Compare…" if dirty else "Reload…") in words
    person.next = ["Reload"]
    show()
    qtbot.waitUntil(lambda: one.document.project.settings.seed == 99)
    assert not one.document.dirty
    assert ("Save anyway" in person.buttons) is dirty


def test_closing_waits_for_what_is_being_saved_and_asks_about_the_rest(windows, person, saved, qtbot):
    one = opened(qtbot, windows(), saved)
    seed(one, 5)
    one.save()
    assert one.may_leave() and on_disk(saved) == 5
    seed(one, 6)
    person.next = [BUTTON.Save]
    assert one.may_leave() and on_disk(saved) == 6
    rewrite(saved, 99)
    seed(one, 7)
    person.next = [BUTTON.Save, "Cancel"]
    assert not one.may_leave(), "it was called off"
