"""The document: the project being edited, its undo stack, its file and its journal.

Every change - drop, menu, paste, undo, load - ends in `changed(before, after)`; views redraw what is not the
same object.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import replace
from pathlib import Path

from PySide6.QtCore import QObject, Signal
from PySide6.QtGui import QUndoCommand, QUndoStack

from app.project.autosave import Autosave
from app.project.autosave import state_folder as state_folder  # where others look for it
from app.project.opening import with_motion_of
from app.project.version_count import version_count
from app.project.writing import Writing, name_after_file
from app.translation import in_english, tr
from metagraph.errors import FileError
from metagraph.formats.locking import Lock, new_owner
from metagraph.formats.new_file import Access, access_of
from metagraph.formats.project.appended_file import Identity, folder_now, identity_of
from metagraph.formats.project.history import UndoStep
from metagraph.formats.project.journal import Done, How
from metagraph.formats.project.limits import find_unwritable
from metagraph.formats.store import file_digest, move_project
from metagraph.graph.edit_error import EditError
from metagraph.graph.editing.listing import is_listed_differently
from metagraph.graph.model import Project

Edit = Callable[[Project], Project]
UNDO_STEPS = 300  # most that can be undone: where each changes all of 10,000 actions they hold 0.8 GB


class _Change(QUndoCommand):
    """The one undo command: the project before and after."""

    def __init__(
        self, document: Document, text: str, before: Project, after: Project, merge: str | None
    ) -> None:
        super().__init__(text)
        self.english = in_english(text)  # what logs call it
        self.document, self.before, self.after, self.merge = document, before, after, merge
        self.cancelled = False
        self._how: How = "done"

    def redo(self) -> None:
        if self._how == "done" and self._goes_on():
            self._how = "merged"
        self.document._set(self.after, self.text(), self._how)
        self._how = "redone"  # the next time

    def _goes_on(self) -> bool:
        """Whether the stack will merge it with the step before."""
        stack = self.document.undo_stack
        top = stack.command(stack.index() - 1) if stack.index() else None
        return (
            self.merge is not None
            and isinstance(top, _Change)
            and top.merge == self.merge
            and stack.index() != stack.cleanIndex()
        )

    def undo(self) -> None:
        self.document._set(self.before, self.text(), "undone")
        self.setObsolete(self.cancelled)  # then it leaves no step to redo

    def id(self) -> int:
        return 1 if self.merge is not None else -1

    def mergeWith(self, other: QUndoCommand) -> bool:
        if not isinstance(other, _Change) or other.merge != self.merge:
            return False
        self.after = other.after
        return True


class Document(QObject):
    """changed: (before, after) projects. loaded: comes first when `after` is another project, not an edited
    one.

    state_changed: comes after `changed`, too: path, dirty mark or undo texts may differ. saved: it was
    written. failed: words for the user. warned: words that the user must have read.

    common: the project as its file was when it was read or saved last, None where that is not known; digest:
    of that file, SHA-256. lock: of the file, while this window has it. read_only: another window has it, so
    saving asks for another place. access: who may read the file, and so all that is written beside it.
    """

    changed = Signal(object, object)
    loaded = Signal()
    state_changed = Signal()
    saved = Signal()
    failed = Signal(str)
    warned = Signal(str)

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.project = Project()
        self.path: Path | None = None
        self.undo_stack = QUndoStack(self)
        self.undo_stack.setUndoLimit(UNDO_STEPS)
        self.undo_stack.cleanChanged.connect(self.state_changed)
        self.undo_stack.indexChanged.connect(self.state_changed)
        self.owner = new_owner()
        self.lock: Lock | None = None
        self.read_only = False
        self.common: Project | None = None
        self.digest: str | None = None
        self.access: Access | None = None
        self._home: Identity | None = None  # of the folder that the file is in, whatever its name
        self.autosave = Autosave(self)
        self._returned = False  # motion came back that earlier steps do not have
        self._restoring = False  # steps of before a crash

    # --- editing

    def edit(self, text: str, function: Edit, merge: str | None = None) -> None:
        """Change the project by a pure function; one undo step named `text`. Edits with the same `merge` in a
        row are one step.

        Raises EditError, from the function or where no project file could hold what comes of it; the project
        is then as it was.
        """
        after = function(self.project)
        if after is not self.project and (
            after != self.project or is_listed_differently(self.project, after)
        ):
            why = find_unwritable(self.project, after)
            if why is not None:
                raise EditError(why)
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

    def take_motion(self, text: str, function: Edit) -> None:
        """Let clips have their motion again. Where nothing that is saved changes by that it is no step, and
        no undo takes it away.
        """
        after = function(self.project)
        if after != self.project:
            self.edit(text, lambda _: after)
        elif after is not self.project:
            self._returned = True
            before, self.project = self.project, after
            self.common = after if self.common is before else self.common
            self.changed.emit(before, after)
            self.state_changed.emit()

    def _set(self, project: Project, text: str, how: How) -> None:
        if self._restoring:
            return
        if self._returned:
            project = with_motion_of(project, self.project)
        before, self.project = self.project, project
        if self.autosave.journal is None:  # the first edit of a window that opened nothing
            self.autosave.begin(before if self.path is None or self.read_only else None)
        self.autosave.write(before, project, text, how)
        self.changed.emit(before, project)

    def undo(self) -> None:
        self.undo_stack.undo()

    def redo(self) -> None:
        self.undo_stack.redo()

    @property
    def dirty(self) -> bool:
        return not self.undo_stack.isClean() and self.project is not self.common

    @property
    def folder(self) -> Path | None:
        """What clip paths are relative to; None while the project was never saved (paths are absolute
        then).
        """
        return self.path.parent if self.path is not None else None

    # --- files

    def load(
        self,
        project: Project,
        path: Path | None,
        recovered: int = 0,
        *,
        steps: Sequence[UndoStep] = (),
        common: Project | None = None,
        digest: str | None = None,
        lock: Lock | None = None,
        read_only: bool = False,
    ) -> None:
        """Show another project; without a path its clip paths are absolute. recovered: how many edits it
        holds that are not in its file. steps: those that can be undone, the last leading to `project`;
        `recovered` counts the edits before them then.

        common, digest: what its file holds, and that file's (as it is now, when left out). lock: of that
        file.
        """
        self._leave_file(lock)
        before, self.project = self.project, project
        self.path, self.lock, self.read_only, self._returned = path, lock, read_only, False
        self.digest = digest or self._digest_now()
        self._settle_in()
        first = steps[0].before if steps else project
        self.common = common if recovered else first
        self.undo_stack.clear()
        if recovered:
            self.undo_stack.resetClean()
        self._restore(steps)
        done = [(step.before, step.after, step.text) for step in steps]
        self.autosave.begin(first if recovered or steps or path is None else None, recovered, done)
        self.loaded.emit()
        self.changed.emit(before, project)
        self.state_changed.emit()

    def _restore(self, steps: Sequence[UndoStep]) -> None:
        """Put steps on the stack that were made before a crash."""
        self.undo_stack.blockSignals(True)  # the views follow once, in the end
        self._restoring = True
        for step in steps:
            self.undo_stack.push(_Change(self, step.text, step.before, step.after, None))
        self._restoring = False
        self.undo_stack.blockSignals(False)

    def take_over(self, other: Document) -> None:
        """Go on with the document of another window, which lets go of it: project, steps, file, lock and
        journal.
        """
        before, self.project, self.path = self.project, other.project, other.path
        self.owner, self.common, self.digest = other.owner, other.common, other.digest
        self.access, self._home = other.access, other._home
        self.read_only, self._returned = other.read_only, other._returned
        self.lock, other.lock = other.lock, None
        self.autosave.take_over(other.autosave)
        theirs, stack = other.undo_stack, self.undo_stack
        made = [c for c in map(theirs.command, range(theirs.count())) if isinstance(c, _Change)]
        stack.clear()
        self._restore([UndoStep(c.text(), c.before, c.after) for c in made])
        for step, theirs_step in zip(map(stack.command, range(stack.count())), made, strict=True):
            assert isinstance(step, _Change)
            step.english = theirs_step.english
        stack.blockSignals(True)
        self._restoring = True  # only the stack moves, to where the other stands
        if theirs.cleanIndex() < 0:
            stack.resetClean()
        else:
            stack.setIndex(theirs.cleanIndex())
            stack.setClean()
        stack.setIndex(theirs.index())
        self._restoring = False
        stack.blockSignals(False)
        self.loaded.emit()
        self.changed.emit(before, self.project)
        self.state_changed.emit()

    def reload(self, project: Project, digest: str) -> None:
        """Take over what another program has made of the file: one step, which can be undone, to the saved
        state.
        """
        if project != self.project:
            self.undo_stack.push(_Change(self, tr("Reload from disk"), self.project, project, None))
        self.common, self.digest = self.project, digest
        self.undo_stack.setClean()
        self.autosave.begin(None)
        self.state_changed.emit()

    def merge(self, project: Project, theirs: Project, digest: str) -> None:
        """Take over what was made of this project and of what another program has made of the file: one step,
        to be saved. theirs, digest: what the file holds, and that file's.
        """
        self.undo_stack.push(_Change(self, tr("Merge with the file"), self.project, project, None))
        self.common, self.digest = theirs, digest
        self.undo_stack.resetClean()
        self.keep_all()
        self.state_changed.emit()

    def save(self, path: Path | None = None) -> None:
        """Write the project at once, whatever its file has become; see `begin_saving`. Raises FileError."""
        writing = self.begin_saving(path)
        writing.write()
        self.end_saving(writing)

    def begin_saving(self, path: Path | None = None) -> Writing:
        """Return how the project as it is now is written, to its own file or another; in a new place it is
        named after its file.

        `write` may run on any thread while edits go on; then comes `end_saving`.
        """
        target = path or self.path
        if target is None:
            raise ValueError("a project that was never saved needs a path")
        mark, journal = None, self.autosave.journal
        if journal is not None:
            with suppress(FileError):  # it is about to be saved
                mark = journal.mark()
        home = self._home if target == self.path else None
        return Writing(self.project, self.path, target, journal, mark, version_count(), home, self.access)

    def end_saving(self, writing: Writing) -> None:
        """The file is written: what it holds is the saved state. Edits that were made meanwhile are not."""
        edited = self.project is not writing.project
        elsewhere = writing.target != self.path
        if elsewhere:
            before = self.project
            after = writing.after
            if edited:
                after = replace(
                    move_project(before, self.path, writing.target), name=name_after_file(writing.target)
                )
            # Steps back would bring paths relative to the old place; a new place begins a new history.
            self.undo_stack.clear()
            self._move_lock(writing.target)
            self.project, self.path, self.read_only, self._returned = after, writing.target, False, False
            self.changed.emit(before, after)
        self.common, self.digest = writing.after, writing.digest
        self._settle_in()
        if edited:
            self.undo_stack.resetClean()
        else:
            self.undo_stack.setClean()
        if elsewhere or not edited:  # else the journal has a mark behind which it goes on
            self.autosave.begin(self.project if edited else None, int(edited))
        self.state_changed.emit()
        self.saved.emit()

    def _settle_in(self) -> None:
        """Remember what the file and its folder are known by."""
        self.access = access_of(self.path) or (self.access if self.path is not None else None)
        self._home = identity_of(self.path.parent) if self.path is not None else None

    def folder_now(self) -> Path | None:
        """Return where the file's folder is by now, where it was renamed or moved while this window had it
        open.
        """
        if self.path is None:
            return None
        journal = self.autosave.journal
        return folder_now(self.path.parent, self._home, journal.path if journal is not None else None)

    def follow(self, folder: Path) -> None:
        """The folder of the project has another name, and all that lies in it has moved along."""
        assert self.path is not None
        self.path = folder / self.path.name
        if self.lock is not None:
            self.lock = Lock(self.path, self.owner, self.access)
            self.lock.acquire()
        self._settle_in()
        self.keep_all()
        self.state_changed.emit()

    # --- lock

    def _move_lock(self, target: Path) -> None:
        lock = Lock(target, self.owner, self.access)
        if self.lock is None or self.lock.path != lock.path:
            lock.acquire()  # where somebody else has it, the window has asked before
            if self.lock is not None:
                self.lock.release()
            self.lock = lock

    def regain(self, lock: Lock) -> None:
        """The lock of the project's file is ours, perhaps after it was not."""
        self.lock, self.read_only = lock, False
        self.state_changed.emit()

    def lose_lock(self) -> None:
        """Another window has taken the file over: from now on it is read only."""
        self.lock, self.read_only = None, True
        self.keep_all()
        self.state_changed.emit()

    # --- journal

    @property
    def journal_place(self) -> Path:
        """Where this sitting keeps its edits."""
        journal = self.autosave.journal
        return journal.path if journal is not None else self.autosave.place

    def keep_all(self) -> None:
        """Write the whole project into the journal, since the file it builds on is another one now."""
        if self.dirty:
            self.autosave.begin(*self.unsaved(self.project))

    def unsaved(self, now: Project) -> tuple[Project, int, list[Done]]:
        """Return what leads to the project as it is now: what it builds on, how many edits of that are in no
        file, and the edits after it.
        """
        stack = self.undo_stack
        clean = stack.cleanIndex()
        made = [stack.command(n) for n in range(max(0, clean), stack.index())]
        steps = [c for c in made if isinstance(c, _Change)]
        if not steps:  # what was saved has been undone, or nothing was done
            return now, int(now is not self.common and now != self.common), []
        done = [(step.before, step.after, step.text()) for step in steps]
        return steps[0].before, int(clean < 0), done

    def secured(self) -> bool:
        """Return whether the journal is safely on the disk with every edit that is in no file."""
        return self.autosave.secure()

    def touch_journal(self) -> None:
        """See `Journal.touch`."""
        if self.autosave.journal is not None:
            self.autosave.journal.touch()

    def close_journal(self) -> None:
        """Forget the journal, and give the file back; when the user has saved or chosen to discard."""
        self._leave_file(None)

    def _leave_file(self, lock: Lock | None) -> None:
        self.autosave.forget()
        if self.lock is not None and (lock is None or lock.path != self.lock.path):
            self.lock.release()
        self.lock = None

    def _digest_now(self) -> str | None:
        try:
            return file_digest(self.path)
        except FileError:
            return None
