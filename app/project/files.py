"""Open, save, import and recover, and ask the questions that this needs. It serves the window and draws
nothing.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, QTimer, Signal
from PySide6.QtWidgets import QFileDialog, QMessageBox, QWidget

from app.faults import is_foreseen
from app.project.autosave import state_folder
from app.project.document import Document, ProjectPast
from app.project.finish_typing import finish_typing
from app.project.jobs import WORDS, Jobs, WindowJob
from app.project.keeper import Keeper
from app.project.leftovers import FoundJournal, keep_as_copy, look_beside, remove_journal
from app.project.network_files import NetworkFiles
from app.project.opening import load_recovered, open_whole
from app.project.outside import Outside
from app.project.saver import Saver
from app.project.step_store import find_steps
from app.project.unsaved import Unsaved, count_lost_steps
from app.project.writing import FolderGoneError
from app.translation import tr, tr_error
from metagraph.common.extras import find_missing_extra
from metagraph.common.files import is_file
from metagraph.common.network_paths import allow
from metagraph.common.studio import find_start_folder
from metagraph.errors import FileError
from metagraph.formats.atomic import write_atomically
from metagraph.formats.locking import Lock
from metagraph.formats.new_file import PRIVATE
from metagraph.formats.project.clip_loading import Opened
from metagraph.formats.project.history import UndoStep
from metagraph.formats.project.paths import make_paths_absolute
from metagraph.formats.project.versions import is_version
from metagraph.formats.recovery import Left
from metagraph.formats.store import SUFFIX, read_project
from metagraph.graph.model import Project

if TYPE_CHECKING:
    from app.project.recovering import Choice

Steps = tuple[UndoStep, ...]
RECENT = 10
SAMPLE = Path(__file__).resolve().parents[2] / "sample_clips" / f"sample{SUFFIX}"
SEATED = Path(__file__).resolve().parents[2] / "sample_clips" / f"seated{SUFFIX}"
PRACTICE = Path(__file__).resolve().parents[2] / "sample_clips" / f"practice{SUFFIX}"


def _filter() -> str:
    return tr("Metagraph projects (*{ending} *.yaml);;All files (*)", ending=SUFFIX)


class Files(QObject):
    """The files of a window. `told` has words for the status bar, `report` (title, lines) to read. `opened`
    is emitted when a project is shown. `noticed` has (words, tip, function that shows more), for later
    reading. `extra_wanted` has the name of an extra that the user wants to see.
    """

    told = Signal(str)
    report = Signal(str, object)
    opened = Signal()
    noticed = Signal(str, str, object)
    extra_wanted = Signal(str)

    def __init__(self, document: Document, jobs: Jobs, window: QWidget) -> None:
        super().__init__(window)
        self.document, self.jobs, self.window = document, jobs, window
        self.saver = Saver(document, jobs, self)
        self.saver.saved.connect(self._saved)
        self.saver.noted.connect(
            lambda path, note: self.report.emit(tr("Saved {name}, with a warning", name=path.name), [note])
        )
        self.saver.failed.connect(self._not_saved)
        self.saver.gone.connect(self._folder_gone)
        self.unsaved = Unsaved(self)
        self.outside = Outside(self)
        self.keeper = Keeper(document, jobs, self)
        self.keeper.told.connect(self.told)
        self.network = NetworkFiles(self)
        self._warnings: list[str] = []
        document.warned.connect(self._warn)
        self._asked_for: Lock | None = None  # the lock of the place that is being saved to
        self.closed = ""  # why no other project or clip may be opened now, in words

    def refuse(self) -> bool:
        """Return whether nothing may be opened now, and report why."""
        if self.closed:
            self.told.emit(self.closed)
        return bool(self.closed)

    # --- new and open

    def new(self, name: str | None = None) -> bool:
        """Show an empty project in place of this one, with a name if there is one; return whether it is
        there.
        """
        if self.refuse() or not self.may_leave():
            return False
        self.document.load(Project() if name is None else Project(name=name), None)
        self.opened.emit()
        return True

    def ask_open(self) -> None:
        if self.refuse():
            return
        name, _ = QFileDialog.getOpenFileName(
            self.window, tr("Open project"), str(find_start_folder(self.document.folder)), _filter()
        )
        if name:
            self.open(Path(name))

    def open(self, path: Path, template: bool = False, name: str | None = None) -> None:
        """Open a project; its clips load on a thread. Ask about unsaved changes, about another window that
        has it open, and about journals that were left behind.

        With `template`, a copy without a file is opened, so that saving asks for a place. `name` is the name
        of that copy, if not the project's.
        """
        path = path.absolute()  # what draws its clips runs in another folder
        if self.refuse():
            return
        if not self.may_leave():
            return
        left = self.document.project
        if template or is_version(path):  # a version is history: edits of it are saved elsewhere
            self._open(path, left, template=True, name=name)
            return
        self._look(path, left, None)

    def go_on(self, chosen: Left, path: Path) -> None:
        """Open a project, and continue with what a journal adds to it."""
        self._look(path, self.document.project, chosen)

    def _look(self, path: Path, before: Project, chosen: Left | None) -> None:
        owner = self.document.owner
        self.jobs.start(
            tr("Opening {name}", name=path.name),
            lambda _: look_beside(path, owner),
            lambda found: self._looked(path, before, found, chosen),
            self.show_failure,
        )

    def _looked(self, path: Path, before: Project, found: FoundJournal, chosen: Left | None = None) -> None:
        """Ask about what was found beside a project file, and open it. `chosen` is the journal to continue
        with, if that was asked before.
        """
        # Dialogs are imported when there is something to ask, so that the first picture does not wait for
        # them.
        from app.project.questions import ask_held
        from app.project.recovering import ask_recover

        read_only = False
        holder = found.holder
        while holder is not None and not read_only:
            answer = ask_held(self.window, path, holder)
            if answer == "copy":
                self._open(path, before, template=True)
                return
            if answer is None:
                return
            read_only = answer == "read only"
            if answer == "take over" and found.lock is not None:
                holder = found.lock.acquire(take_over=True)
        if chosen is not None:
            self._open(path, before, found, ((chosen, "recover"),), read_only=read_only)
            return
        choices = ask_recover(self.window, found, path) if found.left else ()
        if choices is None:
            _release(found.lock, self.document)
            return
        if found.notes and not found.left:
            self.report.emit(tr("Unrecoverable edits were kept"), list(found.notes))
        self._open(path, before, found, tuple(zip(found.left, choices, strict=True)), read_only=read_only)

    def _open(
        self,
        path: Path,
        before: Project,
        found: FoundJournal | None = None,
        choices: Sequence[tuple[Left, Choice]] = (),
        template: bool = False,
        read_only: bool = False,
        name: str | None = None,
    ) -> None:
        """Load a project and its clips, and show it in place of `before`. `choices` says what becomes of
        journals' edits.
        """
        chosen = next((left for left, choice in choices if choice == "recover"), None)
        copies = [left for left, choice in choices if choice == "copy"]
        dropped = [left for left, choice in choices if choice == "discard"]
        lock = found.lock if found is not None and found.lock is not None and found.lock.held else None
        if not template:  # a copy of an allowed project names the same files
            allow(False)

        def work(job: WindowJob) -> tuple[Opened, Project | None, list[Path], Steps, Steps]:
            kept = [keep_as_copy(other, path) for other in copies]
            if chosen is None:
                opened = open_whole(path, job.tell)
                earlier = () if template else find_steps(opened.digest, opened.project, path.resolve().parent)
                return opened, None, kept, earlier, ()
            common = read_project(path) if is_file(path) and not chosen.behind else chosen.common
            opened, steps = load_recovered(chosen, path.parent, job.tell)
            earlier = ()
            if steps and not (chosen.behind or chosen.worked_in or count_lost_steps(chosen, steps)):
                earlier = find_steps(chosen.digest, steps[0].before, path.resolve().parent)
            return replace(opened, digest=chosen.digest), common, kept, earlier, steps

        def done(result: tuple[Opened, Project | None, list[Path], Steps, Steps]) -> None:
            opened, common, kept, earlier, steps = result
            if self.document.project is not before and not self.may_leave():
                _release(lock, self.document)
                return  # it was edited meanwhile
            if template:
                copy = make_paths_absolute(opened.project, path.parent)
                self.document.load(copy if name is None else replace(copy, name=name), None)
            else:
                self.document.load(
                    opened.project,
                    path,
                    ProjectPast(
                        earlier, steps, count_lost_steps(chosen, steps) if chosen is not None else 0, common
                    ),
                    digest=opened.digest,
                    lock=lock,
                    read_only=read_only,
                    newer=opened.newer,
                )
                self._remember(path)
            over = chosen is not None and self.document.secured()  # otherwise it stays, and is offered again
            for other in [*copies, *([chosen] if chosen is not None and over else [])]:
                remove_journal(other.path)
            for other in dropped:
                remove_journal(other.path, discard=True)
            self.opened.emit()
            if chosen is not None:
                self.tell_lost(chosen)
            if chosen is not None and chosen.behind:
                self.look_at_file()
            if kept:
                self.told.emit(
                    tr("Saved as copies beside it: {names}", names=", ".join(place.name for place in kept))
                )
            notes = [note for note in opened.notes if not self.network.tells(note)]
            if notes:
                self.report.emit(tr("Opened {name}, with warnings", name=path.name), notes)
            self.network.look()

        def failed(error: Exception) -> None:
            _release(lock, self.document)
            self.show_failure(error)

        self.jobs.start(tr("Opening {name}", name=path.name), work, done, failed)

    def tell_lost(self, left: Left) -> None:
        """Report which edits of a damaged journal are lost."""
        from app.project.recovering import describe_lost

        if left.is_damaged:
            kept = tr("The damaged file is still there: {place}", place=left.path.parent)
            self.report.emit(tr("Some of your unsaved edits were damaged"), [*describe_lost(left), kept])

    def recover(self) -> None:
        """Offer all unsaved work, wherever it is."""
        if not self.refuse():
            self.unsaved.offer_all()

    def recover_untitled(self, otherwise: Callable[[], object] | None = None) -> None:
        """Offer what was never saved before a crash; if there is nothing, or it is declined, call
        `otherwise`.
        """
        self.unsaved.offer(otherwise)

    def show_failure(self, error: Exception) -> None:
        """Report what went wrong with a job."""
        if not (is_foreseen(error) or isinstance(error, WORDS)):
            return  # reported already
        self.show_warning("Metagraph", error)

    def show_warning(self, title: str, error: Exception) -> None:
        """Show what went wrong, and offer the extras where one is missing."""
        name = find_missing_extra(error)
        if name is None:
            QMessageBox.warning(self.window, title, tr_error(error))
            return
        box = QMessageBox(QMessageBox.Icon.Warning, title, tr_error(error), parent=self.window)
        box.addButton(QMessageBox.StandardButton.Ok)
        more = box.addButton(tr("Extras…"), QMessageBox.ButtonRole.ActionRole)
        box.exec()
        box.deleteLater()  # its parent would keep it
        if box.clickedButton() is more:
            self.extra_wanted.emit(name)

    # --- save

    def save(self) -> bool:
        """Begin to save, on a thread; return whether it was not cancelled."""
        finish_typing()
        if self.document.path is None or self.document.read_only:
            return self.save_as()
        self.saver.save()
        return True

    def save_as(self) -> bool:
        finish_typing()
        start = find_start_folder(self.document.folder)
        name, _ = QFileDialog.getSaveFileName(
            self.window,
            tr("Save project as"),
            str(start / f"{self.document.project.name}{SUFFIX}"),
            _filter(),
        )
        if not name:
            return False
        path = Path(name)
        path = path if path.suffix in (".yaml", ".yml") else path.with_name(path.name + SUFFIX)
        lock = Lock(path, self.document.owner, self.document.access)
        holder = lock.acquire()
        if holder is not None:
            from app.project.questions import describe_holder

            QMessageBox.warning(
                self.window,
                tr("Not saved"),
                tr(
                    "{name} is open in another window ({holder}). Choose another name.",
                    name=path.name,
                    holder=describe_holder(holder),
                ),
            )
            return False
        if self.document.path is not None and Lock(self.document.path, self.document.owner).path == lock.path:
            path = self.document.path  # saved under another name, or the other window has released it
            self.document.regain(lock)
        else:
            self._asked_for = lock
        self.saver.save(path)
        return True

    def _saved(self, path: Path, anew: bool) -> None:
        self._asked_for = None  # it belongs to the document now
        self._remember(path)
        if anew and path == self.document.path:
            self.told.emit(tr("{name} no longer existed, so it was written again.", name=path.name))
        else:
            self.told.emit(tr("Saved {name}", name=path.name))

    def _folder_gone(self, error: FolderGoneError) -> None:
        """Ask where to save, because the project's folder is not in its place."""
        from app.project.questions import ask_folder_gone

        answer = ask_folder_gone(self.window, error)
        if answer == "there" and error.place is not None:
            self.document.follow(error.place)
            self.saver.save()
        elif answer == "save as":
            self.save_as()

    def _warn(self, words: str) -> None:
        """Show what the user must have read: now, and until it was read."""
        self._warnings.append(words)
        QTimer.singleShot(0, self._show_warnings)  # a project that is being shown clears earlier messages

    def _show_warnings(self) -> None:
        if not self._warnings:
            return
        warnings = list(dict.fromkeys(self._warnings))
        self._warnings.clear()

        def show() -> None:
            self.report.emit(tr("Your unsaved edits"), warnings)

        self.noticed.emit(tr("Check your unsaved edits…"), "\n".join(warnings), show)

    def _not_saved(self, error: Exception, path: Path | None) -> None:
        if self._asked_for is not None:
            self._asked_for.release()
            self._asked_for = None
        QMessageBox.warning(self.window, tr("Not saved"), tr_error(error))

    def look_at_file(self) -> None:
        """Check whether the project file has changed on disk, and report it."""
        self.outside.look()

    def may_leave(self) -> bool:
        """Return whether the project may be closed: nothing is unsaved, or the user saved or discarded it."""
        if self.saver.wait():
            return True
        box = QMessageBox.StandardButton
        answer = QMessageBox.question(
            self.window,
            tr("Save changes?"),
            tr("'{name}' has unsaved changes.", name=self.document.project.name),
            box.Save | box.Discard | box.Cancel,
            box.Save,
        )
        return (self.save() and self.saver.wait()) if answer == box.Save else answer == box.Discard

    # --- recent

    def recent(self) -> list[Path]:
        """Return the recent projects that still exist, the latest first."""
        try:
            names = json.loads((state_folder() / "recent.json").read_text(encoding="utf-8"))
            return [Path(n) for n in names if isinstance(n, str) and Path(n).is_file()]
        except (OSError, ValueError, TypeError):
            return []

    def _remember(self, path: Path) -> None:
        names = [str(path.resolve()), *(str(p) for p in self.recent() if p != path.resolve())]
        try:
            write_atomically(state_folder() / "recent.json", json.dumps(names[:RECENT]).encode(), PRIVATE)
        except (FileError, OSError):
            self.told.emit(tr("The list of recent projects could not be saved."))


def _release(lock: Lock | None, document: Document) -> None:
    """Release a lock that was taken for a project that is not shown."""
    if lock is not None and (document.lock is None or document.lock.path != lock.path):
        lock.release()
