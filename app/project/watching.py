"""Read clip files again, in place, when they change on disk, for example after another export: timing and
labels stay, and it is one step to undo.

Files that were missing and are back are read, too. A signal says when the project's own file may have
changed.
"""

from __future__ import annotations

import os
import time
from collections.abc import Mapping
from dataclasses import replace

from PySide6.QtCore import QObject, QTimer, Signal

from app.look.plural import count_clips
from app.project.document import Document
from app.project.jobs import Jobs, WindowJob
from app.project.opening import take_over
from app.translation import tr, tr_error
from metagraph.formats.imports import Imported, import_files
from metagraph.formats.project.clip_loading import Opened, load_returned
from metagraph.graph.model import ClipEntry

EVERY = 1500  # ms between two checks; files on network drives give no notice of changes
SHARE = 20  # the inverse of the largest share of time spent on checks
State = tuple[int, int] | None  # of a file: modification time and size; None while it is missing


class Watcher(QObject):
    """Checks the files of the project's clips. `told` has words for the status bar. `file_touched` asks to
    check whether the project file changed.
    """

    told = Signal(str)
    file_touched = Signal()

    def __init__(self, document: Document, jobs: Jobs, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.document, self.jobs = document, jobs
        self._known: dict[str, State] = {}  # as they were last read
        self._changing: dict[str, State] = {}  # changed, and perhaps still being written
        self._clips: Mapping[str, ClipEntry] = {}  # the clips that `_paths` belongs to
        self._paths: list[str] = []
        self._missing: frozenset[str] = frozenset()  # those of clips without motion
        self._file: State = None  # the project file
        self._busy = False
        self._timer = QTimer(self)
        self._timer.setInterval(EVERY)
        self._timer.timeout.connect(self.look)
        document.loaded.connect(self._forget)

    @property
    def on(self) -> bool:
        return self._timer.isActive()

    def set_on(self, on: bool) -> None:
        """Begin or end checking. Changes in between are not read."""
        self._forget()
        (self._timer.start if on else self._timer.stop)()

    def _forget(self) -> None:
        self._known, self._changing = {}, {}  # new ones, because a check may be running
        self._clips, self._file = {}, None

    def look(self) -> None:
        """Check the files once, on a thread."""
        if self._busy or not (self.document.project.clips or self.document.path):
            return
        self._busy = True
        self._gather()
        file, paths, missing, known = self.document.path, self._paths, self._missing, self._known

        def work(_: WindowJob) -> tuple[dict[str, State], State, float]:
            begun = time.perf_counter()
            return (
                _changed(paths, missing, known),
                _state(str(file)) if file else None,
                time.perf_counter() - begun,
            )

        self.jobs.start(
            tr("Looking for changed files"),
            work,
            lambda found: self._compare(known, *found),
            self._failed,
            quick=True,
        )

    def _gather(self) -> None:
        """Find which files to check. If a clip's motion came or went, the mapping of clips is
        another object.
        """
        clips = self.document.project.clips
        if clips is self._clips:
            return
        folder = str(self.document.folder or "")
        self._clips = clips
        joined = os.path.join  # as text, ten thousand paths take a tenth of the time that `Path`s take
        missing = {e.path.replace("\\", "/") for e in clips.values() if e.motion is None}
        self._missing = frozenset(joined(folder, path) for path in missing)
        here = {joined(folder, path) for path in {e.path for e in clips.values() if e.motion is not None}}
        self._paths = [*(here | self._missing)]

    def _failed(self, error: Exception) -> None:
        self._busy = False

    def _compare(
        self, known: dict[str, State], now: Mapping[str, State], file: State, seconds: float
    ) -> None:
        self._busy = False
        if known is not self._known:
            return  # another project was opened in the meantime
        if self.on:
            self._timer.setInterval(max(EVERY, int(seconds * 1000 * SHARE)))
        if file != self._file:
            self._file = file
            self.file_touched.emit()
        ready = [
            path for path, state in now.items() if self._changing.get(path, ()) == state
        ]  # the program that writes it is done
        self._changing = {path: state for path, state in now.items() if path not in ready}
        self._known.update((path, now[path]) for path in ready)
        if ready:
            self._read(ready)

    def _read(self, paths: list[str]) -> None:
        project, folder, known = self.document.project, self.document.folder, self._known
        again = [path for path in paths if path not in self._missing]
        back = len(again) < len(paths)

        def work(job: WindowJob) -> tuple[Imported, Opened | None]:
            tell = lambda n, total, path: job.tell(n, total, path.name)  # noqa: E731
            returned = load_returned(project, folder, job.tell) if back else None
            return import_files(project, folder, again, tell, lambda: job.cancelled), returned

        def done(read: tuple[Imported, Opened | None]) -> None:
            if known is self._known:
                self._taken(*read)

        self.jobs.start(
            tr("Reading changed clips"), work, done, lambda error: self.told.emit(tr_error(error))
        )

    def _taken(self, result: Imported, returned: Opened | None) -> None:
        if returned is not None:
            self._put_back(returned)
        known = {(clip.path, clip.take): clip.digest for clip in self.document.project.clips.values()}
        again = tuple(x for x in result.loaded if known.get((x[0], x[1]), x[2]) != x[2])
        if again:
            self.document.edit(
                tr("Reload {clips}", clips=count_clips(len(again))),
                replace(result, loaded=again, character=None).into,
            )
            self.told.emit(
                tr("Changed on disk and reloaded: {names}", names=_names([x[3].name for x in again]))
            )
        if result.failures:
            self.told.emit(tr("Changed on disk, but not reloaded: {why}", why=result.failures[0]))

    def _put_back(self, returned: Opened) -> None:
        before = self.document.project
        self.document.take_motion(tr("Read restored clips"), lambda p: take_over(p, returned.project))
        back = [
            e.name
            for i, e in self.document.project.clips.items()
            if e.motion is not None and before.clips[i].motion is None
        ]
        if back:
            self.told.emit(tr("Found again: {names}", names=_names(back)))
        else:
            told = [note for note in returned.notes if not note.endswith("is missing")]
            self.told.emit(
                tr("A missing file is back, but cannot be used: {why}", why=told[0])
                if told
                else tr("A missing file is back, but its clip cannot be read.")
            )


def _names(names: list[str]) -> str:
    return ", ".join(names[:3]) + (" ..." if len(names) > 3 else "")


def _state(path: str) -> State:
    try:
        found = os.stat(path)  # noqa: PTH116 - a Path of each would take as long again
    except OSError:
        return None
    return found.st_mtime_ns, found.st_size


def _changed(paths: list[str], missing: frozenset[str], known: dict[str, State]) -> dict[str, State]:
    """Return the states of files that changed, and note those that are seen for the first time.

    A missing file is being replaced, or gone; missing files are reported elsewhere.
    """
    out: dict[str, State] = {}
    for path in paths:
        state = _state(path)
        before = known.setdefault(path, None if path in missing else state)
        if state is not None and state != before:
            out[path] = state
    return out
