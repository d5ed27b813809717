"""Save on a thread: one writing after another, reported when done, waited for on closing."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import QEventLoop, QObject, Signal

from app.project.document import Document
from app.project.jobs import Jobs
from app.project.writing import FileChangedError, FolderGoneError, Writing
from app.translation import tr, tr_phrase


class Saver(QObject):
    """Saves the document.

    `saved` has the path that was written, and whether its own file had been missing. `noted` has that path
    and a remark. `failed` has the reason, and the requested place (None: its own). `changed` has a
    FileChangedError if another program has written the file, `gone` a FolderGoneError if its folder no longer
    exists. `idle` is emitted when nothing is being written any more.
    """

    saved = Signal(object, bool)
    noted = Signal(object, str)
    failed = Signal(object, object)
    changed = Signal(object)
    gone = Signal(object)
    idle = Signal()

    def __init__(self, document: Document, jobs: Jobs, parent: QObject) -> None:
        super().__init__(parent)
        self.document, self.jobs = document, jobs
        self._writing: Writing | None = None
        self._next: list[tuple[Path | None, bool]] = []
        self._left = False  # another project was opened while this one was written
        document.loaded.connect(self._leave)

    @property
    def busy(self) -> bool:
        return self._writing is not None

    def save(self, path: Path | None = None, anyway: bool = False) -> None:
        """Begin to write the current project, or its later state once the present writing is done. With
        `anyway`, whatever has happened to its file.
        """
        if self._writing is not None:
            self._next.append((path, anyway))
            return
        document = self.document
        document.finish_merging()  # later edits are not saved with it, and are a step of their own
        writing = self._writing = document.begin_saving(path)
        self._left = False
        expected = document.digest if writing.target == document.path and not anyway else None

        def work(_: object) -> Writing:
            writing.write(expected)
            return writing

        self.jobs.start(
            tr("Saving {name}", name=writing.target.name),
            work,
            self._written,
            lambda error: self._stopped(error, path),
            quick=True,
        )

    def wait(self) -> bool:
        """Wait until nothing is being written, with the window painted but without input; return whether all
        edits are saved.
        """
        while self.busy:
            loop = QEventLoop()
            self.idle.connect(loop.quit)
            loop.exec(QEventLoop.ProcessEventsFlag.ExcludeUserInputEvents)
        return not self.document.dirty

    def _leave(self) -> None:
        self._left = True
        self._next.clear()

    def _written(self, writing: Writing) -> None:
        if not self._left:
            self.document.end_saving(writing)
        self._writing = None
        self.saved.emit(writing.target, writing.anew)
        if writing.note is not None:
            self.noted.emit(writing.target, tr_phrase(writing.note))
        self._go_on()

    def _stopped(self, error: Exception, path: Path | None) -> None:
        self._writing = None
        self._next.clear()
        if isinstance(error, FileChangedError):
            if not self._left:
                self.document.keep_all()
                self.changed.emit(error)
        elif isinstance(error, FolderGoneError) and not self._left:
            self.gone.emit(error)
        else:
            self.failed.emit(error, path)
        self._go_on()

    def _go_on(self) -> None:
        while self._next and not self.busy:
            path, anyway = self._next.pop(0)
            if path is not None or self.document.dirty:
                self.save(path, anyway)
        if not self.busy:
            self.idle.emit()
