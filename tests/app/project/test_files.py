"""Opening, saving, importing and recovering, with every answer to every question they ask."""

from __future__ import annotations

import json
import os
import shutil
from dataclasses import replace
from pathlib import Path

import pytest
from PySide6.QtWidgets import QFileDialog, QMessageBox, QWidget

from app.project import questions
from app.project.autosave import state_folder
from app.project.document import Document
from app.project.files import Files
from app.project.importing import Importing
from app.project.jobs import Jobs
from app.project.leftovers import list_untitled_journals
from metagraph.formats.bvh.file import write_bvh
from metagraph.formats.locking import lock_path, make_owner
from metagraph.formats.project.journal_records import read_records
from metagraph.formats.recovery import read_journal
from metagraph.formats.store import open_project, read_project, save_project
from metagraph.graph import edits
from metagraph.graph.model import Project
from tests.app import recovering
from tests.failing_system import failing
from tests.sittings import kill_sittings

BUTTON = QMessageBox.StandardButton


class Answers:
    """Stands in for the person: answers questions in the order given, and keeps what was asked and told."""

    def __init__(self, monkeypatch):
        self.next, self.asked, self.warned = [], [], []
        monkeypatch.setattr(
            QMessageBox, "question", lambda *a, **k: (self.asked.append(a[2]), self.next.pop(0))[1]
        )
        monkeypatch.setattr(QMessageBox, "warning", lambda *a, **k: self.warned.append(a[2]))
        self.patch = monkeypatch
        recovering.answers(monkeypatch, self)

    def save_as(self, path) -> None:
        self.patch.setattr(QFileDialog, "getSaveFileName", lambda *a, **k: (str(path) if path else "", ""))

    def folder(self, path) -> None:
        self.patch.setattr(QFileDialog, "getExistingDirectory", lambda *a, **k: str(path) if path else "")


@pytest.fixture
def person(monkeypatch):
    return Answers(monkeypatch)


class Desk(Files):
    """Files with what they told kept."""

    def __init__(self, window):
        super().__init__(Document(window), Jobs(window), window)
        self.words, self.reports, self.drops = [], [], []
        self.told.connect(self.words.append)
        self.report.connect(lambda title, lines: self.reports.append((title, lines)))
        self.importing = Importing(self.document, self.jobs, self, window)
        self.importing.told.connect(self.words.append)
        self.importing.report.connect(lambda title, lines: self.reports.append((title, lines)))
        self.importing.imported.connect(lambda result, drop: self.drops.append(drop))

    def idle(self) -> bool:
        return not self.jobs.running


@pytest.fixture
def desk(qtbot, person):
    window = QWidget()
    qtbot.addWidget(window)
    desk = Desk(window)
    yield desk
    desk.jobs.stop()
    desk.document.close_journal()


@pytest.fixture
def clips(toy, tmp_path) -> Path:
    """A folder of three clips, one of them in a folder below."""
    folder = tmp_path / "clips"
    (folder / "more").mkdir(parents=True)
    for n, name in enumerate(("idle", "wave", "more/nod")):
        write_bvh(toy.clip(name.split("/")[-1], 0.5, swing=0.1 * n), folder / f"{name}.bvh")
    return folder


@pytest.fixture
def saved(desk, clips, tmp_path, qtbot) -> Path:
    """A project file with those clips."""
    path = tmp_path / "mine.metagraph.yaml"
    desk.importing.import_paths([str(clips)])
    qtbot.waitUntil(lambda: len(desk.document.project.clips) == 3)
    desk.document.save(path)
    return path


def change_seed(desk, seed=99):
    desk.document.edit("Change seed", lambda p: edits.set_settings(p, seed=seed))


# --- leaving


def test_a_project_without_changes_may_be_left_unasked(desk, person):
    assert desk.may_leave()
    assert not person.asked


@pytest.mark.parametrize(("answer", "leaves"), [(BUTTON.Discard, True), (BUTTON.Cancel, False)])
def test_changes_may_be_discarded_or_kept(desk, person, answer, leaves):
    change_seed(desk)
    person.next = [answer]
    assert desk.may_leave() is leaves
    assert "unsaved changes" in person.asked[0]


def test_changes_may_be_saved_first(desk, person, tmp_path):
    change_seed(desk)
    person.next = [BUTTON.Save]
    person.save_as(tmp_path / "new")
    assert desk.may_leave()
    assert open_project(tmp_path / "new.metagraph.yaml").project.settings.seed == 99
    assert desk.recent() == [tmp_path / "new.metagraph.yaml"]


def test_not_choosing_a_place_is_staying(desk, person):
    change_seed(desk)
    person.next = [BUTTON.Save]
    person.save_as(None)
    assert not desk.may_leave()
    assert desk.document.dirty


def test_a_place_that_cannot_be_written_is_staying_with_the_reason(desk, person, tmp_path):
    change_seed(desk)
    (tmp_path / "file").write_text("in the way")
    person.next = [BUTTON.Save]
    person.save_as(tmp_path / "file" / "x.metagraph.yaml")
    assert not desk.may_leave()
    assert "cannot be written" in person.warned[0]


def test_a_new_project_asks_first(desk, person):
    change_seed(desk)
    person.next = [BUTTON.Cancel]
    desk.new()
    assert desk.document.project.settings.seed == 99
    person.next = [BUTTON.Discard]
    desk.new()
    assert desk.document.project == Project()


# --- opening


def test_opening_loads_the_clips_and_is_remembered(desk, saved, qtbot):
    desk.document.load(Project(), None)
    seen = []
    desk.opened.connect(lambda: seen.append(len(desk.document.project.clips)))
    desk.open(saved)
    qtbot.waitUntil(lambda: seen == [3])
    assert all(e.motion is not None for e in desk.document.project.clips.values())
    assert desk.document.path == saved
    assert desk.recent() == [saved]
    assert not desk.document.dirty


def test_a_project_opened_by_a_relative_path_has_an_absolute_folder(desk, saved, qtbot, monkeypatch):
    """Its pictures are drawn by a process in another folder, which would not find the character there."""
    desk.document.load(Project(), None)
    monkeypatch.chdir(saved.parent)
    desk.open(Path(saved.name))
    qtbot.waitUntil(lambda: bool(desk.document.project.clips))
    assert desk.document.folder == saved.parent


def test_a_template_is_opened_without_its_file(desk, saved, qtbot):
    desk.document.load(Project(), None)
    desk.open(saved, template=True)
    qtbot.waitUntil(lambda: len(desk.document.project.clips) == 3)
    assert desk.document.path is None
    assert all(Path(e.path).is_absolute() for e in desk.document.project.clips.values())
    assert desk.recent() == []


@pytest.mark.parametrize(
    "content", [None, b"", b"\xff\xfe\x00", b"a: [", b"metagraph: 99\nlayers: 5\n", b"- 1\n"]
)
def test_what_is_no_project_is_told_and_nothing_changes(desk, person, tmp_path, qtbot, content):
    path = tmp_path / "bad.metagraph.yaml"
    if content is not None:
        path.write_bytes(content)
    before = desk.document.project
    desk.open(path)
    qtbot.waitUntil(lambda: bool(person.warned) and desk.idle())
    assert "bad.metagraph.yaml" in person.warned[0]
    assert desk.document.project is before
    assert desk.recent() == []


def test_a_project_whose_clips_and_character_are_missing_opens_with_notes(desk, saved, clips, qtbot):
    project = edits.set_character(desk.document.project, "nobody.glb")
    save_project(project, saved)
    (clips / "wave.bvh").unlink()
    desk.document.load(Project(), None)
    desk.open(saved)
    qtbot.waitUntil(lambda: len(desk.document.project.clips) == 3)
    missing = [e.name for e in desk.document.project.clips.values() if e.motion is None]
    assert missing == ["wave"]
    title, lines = desk.reports[-1]
    assert "mine.metagraph.yaml" in title
    assert any("wave.bvh" in line for line in lines)


def test_edits_made_while_another_project_opens_are_not_thrown_away(desk, person, saved, qtbot):
    desk.document.load(Project(), None)
    desk.open(saved)
    change_seed(desk)  # before the clips are there
    person.next = [BUTTON.Cancel]
    qtbot.waitUntil(desk.idle)
    assert desk.document.project.settings.seed == 99
    assert len(person.asked) == 1


# --- recovering


def crash(desk) -> None:
    """Forget the document without closing it, as a killed program does."""
    document = desk.document
    place = document.journal_place
    document.autosave.journal.close()
    kill_sittings(place.parent)
    document.autosave.journal = document.lock = None
    document.owner = make_owner()
    document.undo_stack.setClean()


def reopen(desk, path, qtbot):
    desk.document.load(Project(), None)
    desk.open(path)
    qtbot.waitUntil(lambda: len(desk.document.project.clips) == 3 and desk.idle())


def test_steps_can_be_undone_after_saving_and_opening_again(desk, saved, qtbot):
    change_seed(desk, 7)
    first = next(iter(desk.document.project.clips))
    desk.document.edit("Rename clip", lambda p: edits.rename_clip(p, first, "hello"))
    desk.document.save()
    reopen(desk, saved, qtbot)
    stack = desk.document.undo_stack
    assert [stack.text(n) for n in range(stack.count())] == ["Import 3 clips", "Seed 1 → 7", "Rename clip"]
    assert not desk.document.dirty
    desk.document.undo()
    assert desk.document.project.clips[first].name != "hello" and desk.document.dirty
    assert desk.document.project.clips[first].motion is not None
    desk.document.undo()
    assert desk.document.project.settings.seed == 1
    desk.document.undo()
    assert not desk.document.project.clips
    for _ in range(3):
        desk.document.redo()
    assert desk.document.project.clips[first].name == "hello" and not desk.document.dirty


def test_a_clip_removed_before_saving_comes_back_with_its_motion(desk, saved, qtbot):
    first = next(iter(desk.document.project.clips))
    desk.document.edit("Remove clip", lambda p: edits.remove_clips(p, (first,)))
    desk.document.save()
    desk.document.load(Project(), None)
    desk.open(saved)
    qtbot.waitUntil(lambda: len(desk.document.project.clips) == 2 and desk.idle())
    desk.document.undo()
    assert desk.document.project.clips[first].motion is not None


def test_a_file_that_another_program_changed_has_no_steps(desk, saved, qtbot):
    change_seed(desk, 7)
    desk.document.save()
    saved.write_text(saved.read_text(encoding="utf-8") + "# a remark\n", encoding="utf-8")
    reopen(desk, saved, qtbot)
    assert desk.document.undo_stack.count() == 0


@pytest.mark.parametrize("answer", ["recover", "discard"])
def test_edits_since_the_last_save_are_offered(desk, person, saved, qtbot, answer):
    change_seed(desk, 7)
    change_seed(desk, 8)
    crash(desk)
    person.next = [(answer,)]
    desk.document.load(Project(), None)
    desk.open(saved)
    qtbot.waitUntil(lambda: len(desk.document.project.clips) == 3)
    assert "2 unsaved edits" in person.asked[0]
    taken = answer == "recover"
    assert desk.document.project.settings.seed == (8 if taken else 1)
    assert desk.document.dirty is taken
    # the step before the save can be undone, too
    assert desk.document.undo_stack.count() == (3 if taken else 1)
    if taken:
        desk.document.undo()
        assert desk.document.project.settings.seed == 7
        assert all(e.motion is not None for e in desk.document.project.clips.values())
        desk.document.undo()
        assert desk.document.project.settings.seed == 1 and not desk.document.dirty
        desk.document.redo()
        desk.document.redo()
    assert all(e.motion is not None for e in desk.document.project.clips.values())
    change_seed(desk, 5)
    assert list(saved.parent.glob(".*.journal")) == [desk.document.journal_place], (
        "a new journal takes the old one's place"
    )


@pytest.mark.parametrize("answer", ["recover", "discard", "later", None])
def test_a_project_never_saved_is_offered_too(desk, person, clips, qtbot, answer):
    desk.importing.import_paths([str(clips)])
    qtbot.waitUntil(lambda: len(desk.document.project.clips) == 3)
    assert desk.document.dirty
    crash(desk)
    person.next, otherwise = [answer and (answer,)], []
    desk.document.project = Project()
    desk.recover_untitled(lambda: otherwise.append(1))
    qtbot.waitUntil(desk.idle)
    assert bool(otherwise) is (answer != "recover")
    assert "never saved" in person.asked[0] and "3 clips" in person.asked[0]
    assert len(desk.document.project.clips) == (3 if answer == "recover" else 0)
    kept = [path for path in list_untitled_journals() if path != desk.document.journal_place]
    assert len(kept) == (1 if answer in ("later", None) else 0), (
        "what is not wanted now is there another time"
    )
    if answer == "recover":
        assert desk.document.dirty
        assert desk.document.path is None
        assert all(e.motion is not None for e in desk.document.project.clips.values())


def test_without_a_crash_nothing_is_offered(desk, person):
    otherwise = []
    desk.recover_untitled(lambda: otherwise.append(1))
    assert otherwise and not person.asked


def test_edits_of_another_state_of_the_file_are_offered_and_can_be_merged(
    desk, person, saved, qtbot, monkeypatch
):
    change_seed(desk, 7)
    crash(desk)
    theirs = edits.rename_project(read_project(saved), "renamed by git")
    save_project(theirs, saved)
    noticed = []
    desk.noticed.connect(lambda *a: noticed.append(a))
    person.next = [("recover",)]
    desk.document.load(Project(), None)
    desk.open(saved)
    qtbot.waitUntil(lambda: len(desk.document.project.clips) == 3 and bool(noticed))
    assert "Someone else has saved" in person.asked[0]
    assert desk.document.project.settings.seed == 7 and desk.document.project.name == "mine"
    monkeypatch.setattr(questions, "ask_changed", lambda *a: "merge")
    noticed[0][2]()
    qtbot.waitUntil(lambda: desk.document.project.name == "renamed by git")
    assert desk.document.project.settings.seed == 7 and desk.document.dirty
    assert all(e.motion is not None for e in desk.document.project.clips.values())
    desk.save()
    qtbot.waitUntil(lambda: not desk.document.dirty)
    both = read_project(saved)
    assert (both.name, both.settings.seed) == ("renamed by git", 7)
    desk.document.undo()
    assert desk.document.project.name == "mine", "merging is one step"


def test_edits_of_another_state_can_be_saved_beside_the_file(desk, person, saved, qtbot):
    change_seed(desk, 7)
    crash(desk)
    saved.write_text(saved.read_text() + "# edited by hand, or by git\n")
    person.next = [("copy",)]
    desk.document.load(Project(), None)
    desk.open(saved)
    qtbot.waitUntil(lambda: len(desk.document.project.clips) == 3)
    assert desk.document.project.settings.seed == 1
    copy = saved.with_name("mine recovered.metagraph.yaml")
    assert read_project(copy).settings.seed == 7
    assert not list(saved.parent.glob(".*.old")) and not list(saved.parent.glob(".*.journal"))


def test_a_journal_of_before_journals_held_what_they_build_on_is_worked_into_the_file_as_it_is(
    desk, person, saved, qtbot
):
    change_seed(desk, 7)
    place = desk.document.journal_place
    crash(desk)
    head, _, *rest = read_records(place.read_bytes()).whole
    place.write_text("".join(f"{json.dumps(record.data)}\n" for record in (head, *rest)))
    save_project(edits.rename_project(read_project(saved), "renamed"), saved)
    person.next = [("recover",)]
    desk.document.load(Project(), None)
    desk.open(saved)
    qtbot.waitUntil(lambda: len(desk.document.project.clips) == 3)
    assert "merged into" in person.asked[0]
    assert (desk.document.project.name, desk.document.project.settings.seed) == ("renamed", 7)


def test_what_nobody_can_read_is_told_and_stays(desk, person, saved, qtbot):
    change_seed(desk, 7)
    place = desk.document.journal_place
    crash(desk)
    place.write_bytes(b"\x00\n\x00\n")
    desk.document.load(Project(), None)
    desk.open(saved)
    qtbot.waitUntil(lambda: len(desk.document.project.clips) == 3)
    assert "kept" in desk.reports[0][0] and place.name in desk.reports[0][1][0]
    assert place.read_bytes() == b"\x00\n\x00\n"


def test_putting_it_off_opens_nothing_and_keeps_everything(desk, person, saved, qtbot):
    change_seed(desk, 7)
    place = desk.document.journal_place
    crash(desk)
    before = place.read_bytes()
    desk.document.load(Project(), None)
    person.next = [None]
    desk.open(saved)
    qtbot.waitUntil(lambda: not person.next and desk.idle())
    assert desk.document.path is None and place.read_bytes() == before
    assert not lock_path(saved).exists(), "others may open it"


def test_what_is_kept_for_later_is_offered_again(desk, person, saved, qtbot):
    change_seed(desk, 7)
    crash(desk)
    for choice in ("later", "later", "recover"):
        desk.document.load(Project(), None)
        person.next = [(choice,)]
        desk.open(saved)
        qtbot.waitUntil(lambda: not person.next and desk.idle() and len(desk.document.project.clips) == 3)
        assert desk.document.project.settings.seed == (7 if choice == "recover" else 1)


def test_what_could_not_be_taken_over_safely_is_not_forgotten(desk, person, saved, qtbot, tmp_path):
    change_seed(desk, 7)
    left = desk.document.journal_place
    crash(desk)
    desk.document.load(Project(), None)
    person.next = [("recover",)]
    with failing(saved.parent, 0, "error", for_ever=True):  # the disk is full
        desk.open(saved)
        qtbot.waitUntil(lambda: not person.next and desk.idle() and len(desk.document.project.clips) == 3)
    assert desk.document.project.settings.seed == 7 and left.exists()
    change_seed(desk, 8)  # there is room again
    again = read_journal(desk.document.journal_place, saved)
    assert again is not None and again.project.settings.seed == 8


CHAIN = ["crash", "edit and crash"]


@pytest.mark.parametrize("chain", [(a, b, c) for a in CHAIN for b in CHAIN for c in CHAIN])
@pytest.mark.parametrize("named", [True, False])
def test_nothing_is_lost_however_often_it_crashes(desk, person, saved, clips, qtbot, chain, named):
    if not named:
        desk.document.load(Project(), None)
        desk.importing.import_paths([str(clips)])
        qtbot.waitUntil(lambda: len(desk.document.project.clips) == 3)
    change_seed(desk, 7)
    wanted, steps = 7, desk.document.undo_stack.count()
    crash(desk)
    for n, link in enumerate(chain):
        person.next = [("recover",)]
        desk.document.project = Project()
        desk.open(saved) if named else desk.recover_untitled()
        qtbot.waitUntil(lambda: not person.next and desk.idle() and len(desk.document.project.clips) == 3)
        assert desk.document.project.settings.seed == wanted and desk.document.dirty
        assert desk.document.undo_stack.count() == steps, "each can be undone"
        if link != "crash":
            wanted, steps = 20 + n, steps + 1
            change_seed(desk, wanted)
        crash(desk)
    person.next = [("recover",)]
    desk.document.project = Project()
    desk.open(saved) if named else desk.recover_untitled()
    qtbot.waitUntil(lambda: not person.next and desk.idle() and len(desk.document.project.clips) == 3)
    assert desk.document.project.settings.seed == wanted


def test_a_new_project_after_a_crash_writes_over_nothing(desk, person, qtbot):
    change_seed(desk, 7)
    place = desk.document.journal_place
    before = place.read_bytes()
    crash(desk)
    killed = place.read_bytes()
    desk.new()
    change_seed(desk, 8)
    assert place.read_bytes() == killed != before and desk.document.journal_place != place


def test_a_project_opened_by_name_tells_of_what_was_never_saved(desk, person, saved, qtbot):
    desk.document.load(Project(), None)
    change_seed(desk, 7)
    crash(desk)
    noticed = []
    desk.noticed.connect(lambda *a: noticed.append(a))
    desk.document.load(Project(), None)
    desk.unsaved.tell()
    assert "1 unsaved project" in noticed[0][0]
    person.next = [("recover",)]
    noticed[0][2]()
    qtbot.waitUntil(lambda: desk.document.project.settings.seed == 7)


def test_with_nothing_to_recover_the_command_says_so(desk, person):
    desk.recover_untitled()
    assert "nothing to recover" in desk.words[-1] and not person.asked


# --- importing


def test_a_folder_with_a_bad_file_brings_in_the_rest_and_says_what_failed(desk, clips, qtbot):
    (clips / "broken.bvh").write_text("HIERARCHY\nROOT Hips\n{\n")
    desk.importing.import_paths([str(clips)])
    ended = []
    desk.importing.ended.connect(ended.append)
    qtbot.waitUntil(lambda: bool(ended))
    assert sorted(e.name for e in desk.document.project.clips.values()) == ["idle", "nod", "wave"]
    assert any("3 clips" in words and "1 unusable file" in words for words in desk.words)
    assert "broken.bvh" in ended[0].failures[0] and not desk.reports
    assert desk.document.undo_stack.count() == 1, "one import is one step"
    desk.document.undo()
    assert not desk.document.project.clips


def test_importing_nothing_says_what_clips_are(desk, tmp_path, qtbot):
    (tmp_path / "empty").mkdir()
    desk.importing.import_paths([str(tmp_path / "empty")])
    qtbot.waitUntil(lambda: bool(desk.reports))
    assert desk.reports[0][0] == "Nothing was imported"
    assert ".bvh" in desk.reports[0][1][0]


def test_importing_again_refreshes_in_place(desk, clips, qtbot):
    desk.importing.import_paths([str(clips)])
    qtbot.waitUntil(lambda: len(desk.document.project.clips) == 3)
    ids = list(desk.document.project.clips)
    desk.importing.import_paths([str(clips / "idle.bvh"), str(clips / "more")])
    qtbot.waitUntil(lambda: len(desk.words) == 2)
    assert list(desk.document.project.clips) == ids


def test_an_import_carries_its_drop_and_what_was_loaded(desk, clips, qtbot):
    from app.features.graph.graph_drops import Drop

    drop = Drop(True, "here", "stance")
    desk.importing.import_paths([str(clips)], drop)
    qtbot.waitUntil(lambda: desk.drops == [drop])


def test_an_import_for_a_project_that_was_left_is_dropped(desk, clips, qtbot):
    desk.importing.import_paths([str(clips)])
    desk.document.load(Project("another"), None)
    qtbot.waitUntil(desk.idle)
    qtbot.wait(20)
    assert not desk.document.project.clips


def test_dialogs_left_with_cancel_do_nothing(desk, person, monkeypatch):
    person.folder(None)
    monkeypatch.setattr(QFileDialog, "getOpenFileName", lambda *a, **k: ("", ""))
    monkeypatch.setattr(QFileDialog, "getOpenFileNames", lambda *a, **k: ([], ""))
    desk.ask_open()
    desk.importing.ask_import_folder()
    desk.importing.ask_import_files()
    assert desk.idle()


# --- missing files


def test_missing_clips_are_found_where_they_are_now(desk, person, saved, clips, tmp_path, qtbot):
    elsewhere = tmp_path.parent / f"{tmp_path.name}-elsewhere"
    shutil.move(clips, elsewhere / "deep" / "clips")
    desk.document.load(Project(), None)
    desk.open(saved)
    qtbot.waitUntil(lambda: len(desk.document.project.clips) == 3)
    assert all(e.motion is None for e in desk.document.project.clips.values())
    person.folder(elsewhere)
    desk.importing.find_missing()
    qtbot.waitUntil(lambda: desk.words[-1] == "Found 3 of 3 missing clips.")
    assert all(e.motion is not None for e in desk.document.project.clips.values())
    assert desk.document.dirty, "the new paths are to be saved"
    shutil.rmtree(elsewhere)


def gone_and_back(desk, saved, clips, qtbot):
    """Open the project while a clip's file is gone; put the file back."""
    (clips / "wave.bvh").rename(clips / "wave.kept")
    desk.document.load(Project(), None)
    desk.open(saved)
    qtbot.waitUntil(lambda: len(desk.document.project.clips) == 3 and desk.idle())
    assert [e.name for e in desk.document.project.clips.values() if e.motion is None] == ["wave"]
    (clips / "wave.kept").rename(clips / "wave.bvh")


def test_a_clip_whose_file_was_put_back_is_found_without_asking(desk, saved, clips, qtbot):
    gone_and_back(desk, saved, clips, qtbot)
    desk.importing.find_missing()
    qtbot.waitUntil(lambda: desk.words[-1] == "Found 1 of 1 missing clips.")
    assert all(e.motion is not None for e in desk.document.project.clips.values())
    assert not desk.document.dirty, "the file says the same as before"


def test_a_clip_whose_file_was_put_back_is_there_when_the_project_is_opened_again(desk, saved, clips, qtbot):
    gone_and_back(desk, saved, clips, qtbot)
    desk.open(saved)
    qtbot.waitUntil(lambda: all(e.motion is not None for e in desk.document.project.clips.values()))


def test_undo_does_not_take_away_what_came_back(desk, saved, clips, qtbot):
    gone_and_back(desk, saved, clips, qtbot)
    change_seed(desk)
    desk.importing.find_missing()
    qtbot.waitUntil(lambda: desk.words[-1] == "Found 1 of 1 missing clips.")
    desk.document.undo()
    assert desk.document.project.settings.seed == 1
    assert all(e.motion is not None for e in desk.document.project.clips.values())
    assert not desk.document.dirty


def test_when_nothing_is_missing_nothing_is_asked(desk, saved):
    desk.importing.find_missing()
    assert desk.words[-1].startswith("No clip file ")


def test_not_finding_them_says_so(desk, person, saved, tmp_path, qtbot):
    clips = {
        i: replace(e, motion=None, path="gone.bvh", digest="") for i, e in desk.document.project.clips.items()
    }
    desk.document.load(replace(desk.document.project, clips=clips), None)
    (tmp_path / "nothing").mkdir()
    person.folder(tmp_path / "nothing")
    desk.importing.find_missing()
    qtbot.waitUntil(lambda: desk.words[-1] == "Found 0 of 3 missing clips.")


# --- recent projects


def test_recent_projects_are_the_latest_first_and_only_those_that_exist(desk, tmp_path):
    places = [tmp_path / f"{n}.metagraph.yaml" for n in range(13)]
    for place in places:
        desk.document.save(place)
        desk.saver.saved.emit(place, False)
    desk.saver.saved.emit(places[5], False)
    assert desk.recent()[:2] == [places[5], places[12]]
    assert len(desk.recent()) == 10
    places[12].unlink()
    assert places[12] not in desk.recent()


@pytest.mark.parametrize("content", ["", "{", "[1, null]", json.dumps({"a": 1}), json.dumps(None)])
def test_a_broken_list_of_recent_projects_is_an_empty_one(desk, content):

    (state_folder() / "recent.json").write_text(content)
    assert desk.recent() == []


def test_a_full_disk_leaves_the_list_of_recent_projects_as_it_was(desk, tmp_path, monkeypatch):
    place = tmp_path / "a.metagraph.yaml"
    desk.document.save(place)
    desk.saver.saved.emit(place, False)

    def full(*args):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    desk.saver.saved.emit(tmp_path / "b.metagraph.yaml", False)
    assert desk.recent() == [place]
    assert any("could not be saved" in words for words in desk.words)
