"""Opening, saving, importing and recovering, with the questions they ask. The window's right hand; it draws
nothing.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

from PySide6.QtCore import QObject, Signal
from PySide6.QtWidgets import QFileDialog, QMessageBox, QWidget

from app.project.document import Document, state_folder
from app.project.jobs import Job, Jobs
from app.project.keeper import Keeper
from app.project.leftovers import (
    FoundJournal,
    forget,
    keep_as_copy,
    look_beside,
    read_untitled,
    untitled_journals,
)
from app.project.opening import load_recovered, load_whole, open_whole
from app.project.questions import ask_changed, ask_held, ask_keep, ask_recover, holder_words
from app.project.saver import Saver
from app.project.writing import FileChangedError, file_changed
from metagraph.errors import FileError
from metagraph.formats.atomic import write_atomically
from metagraph.formats.history import Step
from metagraph.formats.locking import Lock
from metagraph.formats.recovery import Left
from metagraph.formats.store import SUFFIX, Opened, absolute, read_project
from metagraph.graph.model import Project

RECENT = 10
FILTER = f"Metagraph projects (*{SUFFIX} *.yaml);;All files (*)"
SAMPLE = Path(__file__).resolve().parents[2] / "sample_clips" / f"sample{SUFFIX}"
PRACTICE = Path(__file__).resolve().parents[2] / "sample_clips" / f"practice{SUFFIX}"


class Files(QObject):
    """told: words for the status bar. report: (title, lines) to read. opened: a project is shown.
    changed_outside: (words, tip, what shows more), when another program has written the project file."""

    told = Signal(str)
    report = Signal(str, object)
    opened = Signal()
    changed_outside = Signal(str, str, object)

    def __init__(self, document: Document, jobs: Jobs, window: QWidget) -> None:
        super().__init__(window)
        self.document, self.jobs, self.window = document, jobs, window
        self.saver = Saver(document, jobs, self)
        self.saver.saved.connect(self._saved)
        self.saver.failed.connect(self._not_saved)
        self.saver.changed.connect(self._changed)
        self.keeper = Keeper(document, jobs, self)
        self.keeper.told.connect(self.told)
        self._asked_for: Lock | None = None  # of the place that is being saved to
        self._told_of: str | None = None  # the digest of a changed file that was told of
        self._era = 0  # counts the projects that were shown
        document.loaded.connect(self._next_era)
        self.closed = ""  # why no other project or clip may be brought in now, in words

    def _next_era(self) -> None:
        self._era += 1
        self._told_of = None

    def refuse(self) -> bool:
        """Return whether nothing may be brought in now, and say why."""
        if self.closed:
            self.told.emit(self.closed)
        return bool(self.closed)

    # --- new and open

    def new(self) -> None:
        if self.refuse():
            return
        if self.may_leave():
            self.document.load(Project(), None)
            self.opened.emit()

    def ask_open(self) -> None:
        if self.refuse():
            return
        name, _ = QFileDialog.getOpenFileName(
            self.window, "Open project", str(self.document.folder or Path.home()), FILTER
        )
        if name:
            self.open(Path(name))

    def open(self, path: Path, template: bool = False) -> None:
        """Open a project; its clips load on a thread. Asks about unsaved changes, about another window that
        has it open, and about journals that were left behind.

        template: a copy without a file is opened; saving asks for a place of one's own.
        """
        if self.refuse():
            return
        if not self.may_leave():
            return
        left = self.document.project
        if template:
            self._open(path, left, template=True)
            return
        owner = self.document.owner
        self.jobs.start(
            f"Opening {path.name}",
            lambda _: look_beside(path, owner),
            lambda found: self._looked(path, left, found),
            self.show_failure,
        )

    def _looked(self, path: Path, before: Project, found: FoundJournal) -> None:
        """Ask about what was found beside a project file, and open it."""
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
        for note in found.notes:
            self.told.emit(note)
        chosen: Left | None = None
        copies: list[Left] = []
        for n, left in enumerate(found.left):
            if chosen is None:
                chosen = left if ask_recover(self.window, left, path, len(found.left) - n - 1) else None
            elif ask_keep(self.window, left, path):
                copies.append(left)
        self._open(path, before, found, chosen, copies, read_only=read_only)

    def _open(
        self,
        path: Path,
        before: Project,
        found: FoundJournal | None = None,
        chosen: Left | None = None,
        copies: Sequence[Left] = (),
        template: bool = False,
        read_only: bool = False,
    ) -> None:
        """Load a project and its clips, and show it in place of `before`. chosen: a journal's edits, taken
        over; copies: those saved beside it.
        """
        lock = found.lock if found is not None and found.lock is not None and found.lock.held else None

        def work(job: Job) -> tuple[Opened, Project | None, list[Path], tuple[Step, ...]]:
            kept = [keep_as_copy(other, path) for other in copies]
            if chosen is None:
                return open_whole(path, job.tell), None, kept, ()
            common = None if chosen.behind else read_project(path)
            opened, steps = load_recovered(chosen, path.parent, job.tell)
            return replace(opened, digest=chosen.digest), common, kept, steps

        def release() -> None:
            if lock is not None and (self.document.lock is None or self.document.lock.path != lock.path):
                lock.release()

        def done(result: tuple[Opened, Project | None, list[Path], tuple[Step, ...]]) -> None:
            opened, common, kept, steps = result
            if self.document.project is not before and not self.may_leave():
                release()
                return  # it was edited meanwhile
            if template:
                self.document.load(absolute(opened.project, path.parent), None)
            else:
                self.document.load(
                    opened.project,
                    path,
                    _not_steps(chosen, steps) if chosen is not None else 0,
                    steps=steps,
                    common=common,
                    digest=opened.digest,
                    lock=lock,
                    read_only=read_only,
                )
                self._remember(path)
            for other in found.left if found is not None else ():
                forget(other.path)
            self.opened.emit()
            if kept:
                self.told.emit(f"Saved beside it: {', '.join(place.name for place in kept)}")
            if opened.notes:
                self.report.emit(f"{path.name} was opened, but", list(opened.notes))

        def failed(error: Exception) -> None:
            release()
            self.show_failure(error)

        self.jobs.start(f"Opening {path.name}", work, done, failed)

    def recover_untitled(self, otherwise: Callable[[], object] = lambda: None) -> None:
        """Offer what was never saved before a crash; where nothing is, or is wanted, do `otherwise`."""
        journals = untitled_journals()
        if journals:
            self.jobs.start(
                "Recovering",
                lambda _: read_untitled(journals),
                lambda found: self._offer(found, otherwise),
                self.show_failure,
            )
        else:
            otherwise()

    def _offer(self, found: FoundJournal, otherwise: Callable[[], object]) -> None:
        for note in found.notes:
            self.told.emit(note)
        for n, left in enumerate(found.left):
            if ask_recover(self.window, left, None, len(found.left) - n - 1):
                break
            forget(left.path)
        else:
            otherwise()
            return
        era = self._era

        def done(result: tuple[Opened, tuple[Step, ...]]) -> None:
            if era != self._era or self.document.dirty:
                return  # it is offered again another time
            opened, steps = result
            self.document.load(opened.project, None, _not_steps(left, steps), steps=steps)
            forget(left.path)
            self.opened.emit()
            rest = len(found.left) - n - 1
            if rest:
                self.told.emit(f"{rest} more will be offered when Metagraph is started again.")

        self.jobs.start(
            "Recovering", lambda job: load_recovered(left, Path("/"), job.tell), done, self.show_failure
        )

    def show_failure(self, error: Exception) -> None:
        """Say what went wrong with a job."""
        if not isinstance(error, FileError):
            for note in getattr(error, "__notes__", ()):
                print(note)
        QMessageBox.warning(self.window, "Metagraph", str(error))

    # --- save

    def save(self) -> bool:
        """Begin to save, on a thread; return whether that was not called off."""
        if self.document.path is None or self.document.read_only:
            return self.save_as()
        self.saver.save()
        return True

    def save_as(self) -> bool:
        start = self.document.folder or Path.home()
        name, _ = QFileDialog.getSaveFileName(
            self.window, "Save project as", str(start / f"{self.document.project.name}{SUFFIX}"), FILTER
        )
        if not name:
            return False
        path = Path(name)
        path = path if path.suffix in (".yaml", ".yml") else path.with_name(path.name + SUFFIX)
        lock = Lock(path, self.document.owner)
        holder = lock.acquire()
        if holder is not None:
            QMessageBox.warning(
                self.window,
                "Not saved",
                f"{path.name} is open in another window, by {holder_words(holder)}. Choose another name.",
            )
            return False
        if self.document.path is not None and Lock(self.document.path, self.document.owner).path == lock.path:
            path = self.document.path  # by another name, or whoever had it is gone
            self.document.regain(lock)
        else:
            self._asked_for = lock
        self.saver.save(path)
        return True

    def _saved(self, path: Path) -> None:
        self._asked_for = None  # the document's now
        self._remember(path)
        self.told.emit(f"Saved {path.name}")

    def _not_saved(self, error: Exception, path: Path | None) -> None:
        if self._asked_for is not None:
            self._asked_for.release()
            self._asked_for = None
        QMessageBox.warning(self.window, "Not saved", str(error))

    def _changed(self, changed: FileChangedError) -> None:
        """The project file is another one than was read: ask what to do with both."""
        document = self.document
        era, dirty = self._era, document.dirty
        answer = ask_changed(self.window, changed, document.common, document.project, dirty)
        if era != self._era:
            return
        if answer == "save as":
            self.save_as()
        elif answer == "anyway":
            self.saver.save(anyway=True)
        elif answer == "reload" and changed.theirs is not None and changed.digest is not None:
            theirs, digest, folder = changed.theirs, changed.digest, changed.path.parent

            def done(opened: Opened) -> None:
                if era == self._era:
                    document.reload(opened.project, digest)
                    self.told.emit(f"Read {changed.path.name} again")

            self.jobs.start(
                f"Reading {changed.path.name} again",
                lambda job: load_whole(theirs, folder, job.tell),
                done,
                self.show_failure,
            )

    def look_at_file(self) -> None:
        """Look whether the project file has changed on disk, and say so."""
        document = self.document
        path, digest = document.path, document.digest
        if path is None or digest is None or self.saver.busy:
            return

        def done(changed: FileChangedError | None) -> None:
            if (
                changed is None
                or self.saver.busy
                or (document.path, document.digest) != (path, digest)
                or changed.digest == self._told_of
            ):
                return
            self._told_of = changed.digest
            document.keep_all()
            what = "look…" if document.dirty else "reload…"
            tip = "Another program, another window or a version control update has written it"
            self.changed_outside.emit(
                f"{path.name} changed on disk: {what}", tip, lambda: self._changed(changed)
            )

        self.jobs.start("project file", lambda _: file_changed(path, digest), done, quick=True)

    def may_leave(self) -> bool:
        """Return whether the project may be left: nothing unsaved, or saved or discarded when asked."""
        if self.saver.wait():
            return True
        box = QMessageBox.StandardButton
        answer = QMessageBox.question(
            self.window,
            "Save changes?",
            f"'{self.document.project.name}' has changes that are not saved.",
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
            write_atomically(state_folder() / "recent.json", json.dumps(names[:RECENT]).encode())
        except (FileError, OSError):
            self.told.emit("The list of recent projects could not be written.")


def _not_steps(left: Left, steps: Sequence[Step]) -> int:
    """Return how many of a journal's edits are in no file and can no longer be undone one by one."""
    return left.unsaved if steps else left.edits
