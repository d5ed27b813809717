"""The document: the project being edited, its undo stack, its file and its journal.

Every change - drop, menu, paste, undo, load - ends in `changed(before, after)`; views redraw what is not the same object.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from PySide6.QtCore import QLockFile, QObject, QStandardPaths, Signal
from PySide6.QtGui import QUndoCommand, QUndoStack

from metagraph.errors import FileError
from metagraph.formats.journal import Journal, journal_path
from metagraph.formats.store import SUFFIX, moved, save_project
from metagraph.graph.model import Project

Edit = Callable[[Project], Project]


class _Change(QUndoCommand):
    """The one undo command: the project before and after."""

    def __init__(self, document: Document, text: str, before: Project, after: Project, merge: str | None) -> None:
        super().__init__(text)
        self.document, self.before, self.after, self.merge = document, before, after, merge
        self.cancelled = False

    def redo(self) -> None:
        self.document._set(self.after)

    def undo(self) -> None:
        self.document._set(self.before)
        self.setObsolete(self.cancelled)  # then it leaves no step to redo

    def id(self) -> int:
        return 1 if self.merge is not None else -1

    def mergeWith(self, other: QUndoCommand) -> bool:
        if not isinstance(other, _Change) or other.merge != self.merge:
            return False
        self.after = other.after
        return True


class Document(QObject):
    """changed: (before, after) projects. loaded: comes first when `after` is another project, not an edited one.

    state_changed: path, dirty mark or undo texts may differ. saved: it was written. failed: words for the user.
    """

    changed = Signal(object, object)
    loaded = Signal()
    state_changed = Signal()
    saved = Signal()
    failed = Signal(str)

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.project = Project()
        self.path: Path | None = None
        self.undo_stack = QUndoStack(self)
        self.undo_stack.cleanChanged.connect(self.state_changed)
        self.undo_stack.indexChanged.connect(self.state_changed)
        self._journal: Journal | None = None
        self._unsafe = False  # no journal can be written; that was told

    # --- editing

    def edit(self, text: str, function: Edit, merge: str | None = None) -> None:
        """Change the project by a pure function; one undo step named `text`. Edits with the same `merge` in a row are one step.

        Raises EditError, from the function; the project is then as it was.
        """
        after = function(self.project)
        if after is not self.project and after != self.project:
            self.undo_stack.push(_Change(self, text, self.project, after, merge))

    def finish_merging(self) -> None:
        """End a run of merged edits (the mouse was released), so that the next begins a step of its own."""
        count = self.undo_stack.count()
        top = self.undo_stack.command(count - 1) if count else None
        if isinstance(top, _Change):
            top.merge = None

    def cancel_merging(self, merge: str) -> None:
        """Take back a run of merged edits that has not ended: the mouse's drag was cancelled."""
        count = self.undo_stack.count()
        top = self.undo_stack.command(count - 1) if count else None
        if isinstance(top, _Change) and top.merge == merge and self.undo_stack.index() == count:
            top.cancelled = True
            self.undo_stack.undo()

    def _set(self, project: Project) -> None:
        before, self.project = self.project, project
        if self._journal is None and not self._unsafe:  # the first edit of a window that opened nothing
            self._begin_journal(before if self.path is None else None)
        if self._journal is not None:
            try:
                self._journal.edit(before, project)
            except (FileError, OSError) as error:
                self.failed.emit(f"This edit was not autosaved: {error}")
        self.changed.emit(before, project)

    def undo(self) -> None:
        self.undo_stack.undo()

    def redo(self) -> None:
        self.undo_stack.redo()

    @property
    def dirty(self) -> bool:
        return not self.undo_stack.isClean()

    @property
    def folder(self) -> Path | None:
        """What clip paths are relative to; None while the project was never saved (paths are absolute then)."""
        return self.path.parent if self.path is not None else None

    # --- files

    def load(self, project: Project, path: Path | None, recovered: bool = False) -> None:
        """Show another project; without a path its clip paths are absolute. recovered: it holds edits that are not in its file."""
        self.close_journal()
        before, self.project = self.project, project
        self.path = path
        self.undo_stack.clear()
        if recovered:
            self.undo_stack.resetClean()
        self._begin_journal(project if recovered or path is None else None)
        self.loaded.emit()
        self.changed.emit(before, project)
        self.state_changed.emit()

    def save(self, path: Path | None = None) -> None:
        """Write the project, to its own file or another; in a new place it is named after its file. Raises FileError."""
        target = path or self.path
        if target is None:
            raise ValueError("a project that was never saved needs a path")
        if target == self.path:
            save_project(self.project, target)
        else:
            after = replace(moved(self.project, self.path, target), name=project_name(target))
            save_project(after, target, target)
            before, self.project = self.project, after
            # Steps back would bring paths relative to the old place; a new place begins a new history.
            self.undo_stack.clear()
            self.path = target
            self.changed.emit(before, after)
        self.undo_stack.setClean()
        self._begin_journal(None)
        self.state_changed.emit()
        self.saved.emit()

    # --- journal

    def _begin_journal(self, base: Project | None) -> None:
        if self._journal is not None:
            self._journal.remove()
        self._unsafe = False
        place = untitled_journal() if self.path is None else journal_path(self.path)
        self._journal = Journal(place, self.path)
        if base is not None:
            try:
                self._journal.begin(base)
            except (FileError, OSError) as error:
                self._journal, self._unsafe = None, True
                self.failed.emit(f"Autosave is off: {error}")

    def close_journal(self) -> None:
        """Forget the journal; when the user has saved or chosen to discard."""
        if self._journal is not None:
            self._journal.remove()
            self._journal = None


def project_name(path: Path) -> str:
    """Return what a project saved as `path` is called: the file's name without `.metagraph.yaml`."""
    name = path.name
    for suffix in (SUFFIX, ".yaml", ".yml"):
        if name.lower().endswith(suffix) and len(name) > len(suffix):
            return name[: -len(suffix)]
    return name


def state_folder() -> Path:
    """Return where recent projects and the journal of unsaved work are kept; made if need be."""
    folder = Path(QStandardPaths.writableLocation(QStandardPaths.StandardLocation.AppDataLocation))
    folder.mkdir(parents=True, exist_ok=True)
    return folder


_lock: QLockFile | None = None


def untitled_journal() -> Path:
    """Return where edits of a project without a file are kept; a second window at the same time has a place of its own."""
    global _lock
    if _lock is None:
        _lock = QLockFile(str(state_folder() / "untitled.lock"))
        _lock.setStaleLockTime(0)
        _lock.tryLock(0)
    name = "untitled.journal" if _lock.isLocked() else f"untitled-{os.getpid()}.journal"
    return state_folder() / name
