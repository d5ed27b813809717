"""Clip files that change on disk, as when they are exported again, are read anew in place: timing and labels stay, one step to undo."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

from PySide6.QtCore import QObject, QTimer, Signal

from app.project.document import Document
from app.project.jobs import Job, Jobs
from metagraph.formats.imports import Imported, import_files

EVERY = 1500  # ms between two looks; files on network drives tell nobody when they change
State = tuple[int, int]  # of a file: when it was written, and its size


class Watcher(QObject):
    """Looks at the files of the project's clips. told: words for the status bar."""

    told = Signal(str)

    def __init__(self, document: Document, jobs: Jobs, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.document, self.jobs = document, jobs
        self._known: dict[Path, State] = {}  # as they were last read
        self._changing: dict[Path, State] = {}  # seen to have changed, perhaps still being written
        self._busy = False
        self._timer = QTimer(self)
        self._timer.setInterval(EVERY)
        self._timer.timeout.connect(self.look)
        document.loaded.connect(self._forget)

    @property
    def on(self) -> bool:
        return self._timer.isActive()

    def set_on(self, on: bool) -> None:
        """Begin or end looking; what changed in between is not taken up."""
        self._forget()
        (self._timer.start if on else self._timer.stop)()

    def _forget(self) -> None:
        self._known.clear()
        self._changing.clear()

    def look(self) -> None:
        """Look at the files once, on a thread."""
        if self._busy or not self.document.project.clips:
            return
        self._busy = True
        folder, project = self.document.folder or Path(), self.document.project
        names = {clip.path for clip in project.clips.values()}  # a thousand paths would take their time here

        def work(_: Job) -> dict[Path, State]:
            return _states([folder / name for name in names])

        self.jobs.start("Looking for changed files", work, self._compare, self._failed, quick=True)

    def _failed(self, error: Exception) -> None:
        self._busy = False

    def _compare(self, now: Mapping[Path, State]) -> None:
        self._busy = False
        ready = []
        for path, state in now.items():
            before = self._known.setdefault(path, state)
            if state == before:
                self._changing.pop(path, None)
            elif self._changing.get(path) == state:  # it was the same a look ago, so whoever writes it is done
                ready.append(path)
            else:
                self._changing[path] = state
        for path in ready:
            self._known[path] = self._changing.pop(path)
        if ready:
            self._read(ready)

    def _read(self, paths: list[Path]) -> None:
        project, folder = self.document.project, self.document.folder

        def work(job: Job) -> Imported:
            return import_files(project, folder, paths, lambda n, total, path: job.tell(n, total, path.name), lambda: job.cancelled)

        self.jobs.start("Reading changed clips", work, self._taken, lambda error: self.told.emit(str(error)))

    def _taken(self, result: Imported) -> None:
        known = {(clip.path, clip.take): clip.digest for clip in self.document.project.clips.values()}
        again = tuple(x for x in result.loaded if known.get((x[0], x[1]), x[2]) != x[2])
        if again:
            count = len(again)
            self.document.edit(f"Refresh {count} clip{'s' if count != 1 else ''}", replace(result, loaded=again, character=None).into)
            names = ", ".join(x[3].name for x in again[:3]) + (" ..." if count > 3 else "")
            self.told.emit(f"Changed on disk and read again: {names}")
        if result.failures:
            self.told.emit(f"Changed on disk, but: {result.failures[0]}")


def _states(paths: list[Path]) -> dict[Path, State]:
    """Return the states of the files that are there."""
    out: dict[Path, State] = {}
    for path in paths:
        try:
            found = path.stat()
        except OSError:
            continue  # being replaced, or gone; what is missing is told elsewhere
        out[path] = (found.st_mtime_ns, found.st_size)
    return out
