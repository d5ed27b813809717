"""Opening, saving, importing and recovering, with the questions they ask. The window's right hand; it draws nothing."""

from __future__ import annotations

import json
from pathlib import Path

from PySide6.QtCore import QObject, Signal
from PySide6.QtWidgets import QFileDialog, QMessageBox, QWidget

from app.project.document import Document, state_folder, untitled_journal
from app.project.jobs import Job, Jobs
from app.project.opening import load_whole, open_whole
from metagraph.errors import FileError
from metagraph.formats.journal import journal_path, recover
from metagraph.formats.store import SUFFIX, Opened, absolute
from metagraph.graph.model import Project

RECENT = 10
FILTER = f"Metagraph projects (*{SUFFIX} *.yaml);;All files (*)"
SAMPLE = Path(__file__).resolve().parents[2] / "sample_clips" / f"sample{SUFFIX}"
PRACTICE = Path(__file__).resolve().parents[2] / "sample_clips" / f"practice{SUFFIX}"


class Files(QObject):
    """told: words for the status bar. report: (title, lines) to read. opened: a project is shown."""

    told = Signal(str)
    report = Signal(str, object)
    opened = Signal()

    def __init__(self, document: Document, jobs: Jobs, window: QWidget) -> None:
        super().__init__(window)
        self.document, self.jobs, self.window = document, jobs, window
        self.closed = ""  # why no other project or clip may be brought in now, in words

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
        name, _ = QFileDialog.getOpenFileName(self.window, "Open project", str(self.document.folder or Path.home()), FILTER)
        if name:
            self.open(Path(name))

    def open(self, path: Path, template: bool = False) -> None:
        """Open a project; its clips load on a thread. Asks about unsaved changes and about a journal that was left behind.

        template: a copy without a file is opened; saving asks for a place of one's own.
        """
        if self.refuse():
            return
        if not self.may_leave():
            return
        recovered = None if template else self._offer(journal_path(path), path)
        left = self.document.project

        def work(job: Job) -> Opened:
            if recovered is not None:
                return load_whole(recovered, path.parent, job.tell)
            return open_whole(path, job.tell)

        def done(opened: Opened) -> None:
            if self.document.project is not left and not self.may_leave():
                return  # it was edited meanwhile
            if template:
                self.document.load(absolute(opened.project, path.parent), None)
            else:
                self.document.load(opened.project, path, recovered is not None)
                self._remember(path)
            self.opened.emit()
            if opened.notes:
                self.report.emit(f"{path.name} was opened, but", list(opened.notes))

        self.jobs.start(f"Opening {path.name}", work, done, self.show_failure)

    def recover_untitled(self) -> bool:
        """Offer what was never saved before a crash; return whether it is being opened."""
        project = self._offer(untitled_journal(), None)
        if project is None:
            return False

        def done(opened: Opened) -> None:
            self.document.load(opened.project, None, recovered=True)
            self.opened.emit()

        self.jobs.start("Recovering", lambda job: load_whole(project, Path("/"), job.tell), done, self.show_failure)
        return True

    def _offer(self, journal: Path, saved: Path | None) -> Project | None:
        """Ask whether to take over a journal's edits; None when there are none or they are not wanted."""
        try:
            found = recover(journal, saved)
        except FileError as error:
            kept = journal.with_suffix(".old")
            journal.replace(kept)
            self.told.emit(f"{error} ({kept.name})")
            return None
        if found is None:
            return None
        project, count = found
        name = saved.name if saved is not None else "A project that was never saved"
        edits = f"{count} edit{'s' if count != 1 else ''}"
        answer = QMessageBox.question(
            self.window,
            "Recover edits?",
            f"{name} was not closed properly. {edits.capitalize()} since the last save can be recovered.",
            QMessageBox.StandardButton.Yes | QMessageBox.StandardButton.Discard,
            QMessageBox.StandardButton.Yes,
        )
        return project if answer == QMessageBox.StandardButton.Yes else None

    def show_failure(self, error: Exception) -> None:
        """Say what went wrong with a job."""
        if not isinstance(error, FileError):
            for note in getattr(error, "__notes__", ()):
                print(note)
        QMessageBox.warning(self.window, "Metagraph", str(error))

    # --- save

    def save(self) -> bool:
        if self.document.path is None:
            return self.save_as()
        return self._save(None)

    def save_as(self) -> bool:
        start = self.document.folder or Path.home()
        name, _ = QFileDialog.getSaveFileName(self.window, "Save project as", str(start / f"{self.document.project.name}{SUFFIX}"), FILTER)
        if not name:
            return False
        path = Path(name)
        return self._save(path if path.suffix in (".yaml", ".yml") else path.with_name(path.name + SUFFIX))

    def _save(self, path: Path | None) -> bool:
        try:
            self.document.save(path)
        except FileError as error:
            QMessageBox.warning(self.window, "Not saved", str(error))
            return False
        assert self.document.path is not None
        self._remember(self.document.path)
        self.told.emit(f"Saved {self.document.path.name}")
        return True

    def may_leave(self) -> bool:
        """Return whether the project may be left: nothing unsaved, or saved or discarded when asked."""
        if not self.document.dirty:
            return True
        box = QMessageBox.StandardButton
        answer = QMessageBox.question(
            self.window,
            "Save changes?",
            f"'{self.document.project.name}' has changes that are not saved.",
            box.Save | box.Discard | box.Cancel,
            box.Save,
        )
        return self.save() if answer == box.Save else answer == box.Discard

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
            (state_folder() / "recent.json").write_text(json.dumps(names[:RECENT]), encoding="utf-8")
        except OSError:
            self.told.emit("The list of recent projects could not be written.")
