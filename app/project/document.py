"""Hold the document: the project being edited, its undo stack, its file and its journal.

Every change - drop, menu, paste, undo, load - ends in `changed(before, after)`; views redraw what is not the
same object.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from msgspec import structs
from PySide6.QtCore import QObject, Signal
from PySide6.QtGui import QUndoCommand, QUndoStack

from app.project.autosave import Autosave
from app.project.autosave import state_folder as state_folder  # where others look for it
from app.project.change_words import describe_edit
from app.project.opening import with_motion_of
from app.project.version_count import count_kept_versions
from app.project.writing import Writing, move_steps
from app.translation import get_english, tr
from metagraph.common.studio import name_author
from metagraph.errors import FileError
from metagraph.formats.locking import Lock, make_owner
from metagraph.formats.new_file import Access, access_of
from metagraph.formats.project.appended_file import Identity, find_moved_folder, read_identity
from metagraph.formats.project.history import UndoStep
from metagraph.formats.project.journal import Done, How
from metagraph.formats.project.limits import find_unwritable
from metagraph.formats.store import compute_file_digest
from metagraph.graph.edit_error import EditError
from metagraph.graph.editing.half_labels import place_complete
from metagraph.graph.editing.listing import is_listed_differently
from metagraph.graph.model import Project

Edit = Callable[[Project], Project]
UNDO_STEPS = 300  # the largest number of steps; if each changes all of 10,000 actions, they take 0.8 GB


class _Change(QUndoCommand):
    """The only undo command: the project before and after."""

    def __init__(
        self,
        document: Document,
        text: str,
        before: Project,
        after: Project,
        merge: str | None,
        agent: bool = False,
    ) -> None:
        what = describe_edit(text, before, after)
        super().__init__(tr("{what} (agent)", what=what) if agent else what)
        self.command = text  # without what it changed
        self.english = get_english(text)  # its name in logs
        self.document, self.before, self.after, self.merge = document, before, after, merge
        self.cancelled = False
        self._how: How = "done"

    def redo(self) -> None:
        previous = self._goes_on() if self._how == "done" else None
        if previous is not None:
            self._how = "merged"
            self.setText(describe_edit(self.command, previous.before, self.after))
        self.document._set(self.after, self.text(), self._how)
        self._how = "redone"  # for the next time

    def _goes_on(self) -> _Change | None:
        """Return the previous step, if the stack will merge this one with it."""
        stack = self.document.undo_stack
        top = stack.command(stack.index() - 1) if stack.index() else None
        if (
            self.merge is not None
            and isinstance(top, _Change)
            and top.merge == self.merge
            and stack.index() != stack.cleanIndex()
        ):
            return top
        return None

    def undo(self) -> None:
        self.document._set(self.before, self.text(), "undone")
        self.setObsolete(self.cancelled)  # if so, there is no step to redo

    def id(self) -> int:
        return 1 if self.merge is not None else -1

    def mergeWith(self, other: QUndoCommand) -> bool:
        if not isinstance(other, _Change) or other.merge != self.merge:
            return False
        self.after = other.after
        self.setText(other.text())
        return True


@dataclass(frozen=True)
class ProjectPast:
    """How a project came to be.

    `saved` are the steps that led to what its file holds, and `steps` those after it, which no file holds;
    the last one leads to the project. `lost` counts unsaved edits that cannot be undone, between the two.
    `common` is the content of its file where there are such.
    """

    saved: Sequence[UndoStep] = ()
    steps: Sequence[UndoStep] = ()
    lost: int = 0
    common: Project | None = None


NO_PAST = ProjectPast()


class Document(QObject):
    """The document of a window.

    `changed` has the projects before and after. `loaded` comes first if `after` is another project, not an
    edited one. `state_changed` comes after `changed`, too: path, dirty mark or undo texts may differ. `saved`
    is emitted after writing, `exported` after files for an engine were written. `failed` has words for the
    user, `warned` words that the user must have read.

    `common` is the project as its file was when it was last read or saved, None if unknown; `digest` is the
    SHA-256 of that file. `lock` is the file's, while this window has it. With `read_only`, another window has
    it, so saving asks for another place. `access` says who may read the file, and everything written beside
    it.
    """

    changed = Signal(object, object)
    loaded = Signal()
    state_changed = Signal()
    saved = Signal()
    exported = Signal()
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
        owner = make_owner()
        self.owner = structs.replace(owner, user=name_author(owner.user))
        self.lock: Lock | None = None
        self.read_only = False
        self.newer = False
        self.common: Project | None = None
        self.digest: str | None = None
        self.access: Access | None = None
        self._home: Identity | None = None  # identifies the folder that the file is in, whatever its name
        self.autosave = Autosave(self)
        self._returned = False  # motion came back that earlier steps do not have
        self._restoring = False  # steps from before a crash

    # --- editing

    def edit(self, text: str, function: Edit, merge: str | None = None, agent: bool = False) -> None:
        """Change the project by a pure function, as one undo step named `text`. Consecutive edits with the
        same `merge` are one step. Clips whose labels are complete afterwards are placed by the same step.
        `agent` says that a program made it, which its name shows.

        Raises EditError, from the function or if no project file could hold the result; the project is then
        unchanged.
        """
        after = function(self.project)
        if after.graphs is not self.project.graphs and after.marks:
            after = place_complete(after)  # the stance that a half labelled clip waits for may be there now
        if after is not self.project and (
            after != self.project or is_listed_differently(self.project, after)
        ):
            why = find_unwritable(self.project, after)
            if why is not None:
                raise EditError(why)
            self.undo_stack.push(_Change(self, text, self.project, after, merge, agent))

    def finish_merging(self) -> None:
        """End a run of merged edits (the mouse was released), so that the next one begins a new step."""
        count = self.undo_stack.count()
        top = self.undo_stack.command(count - 1) if count else None
        if isinstance(top, _Change):
            top.merge = None

    def cancel_merging(self, merge: str) -> None:
        """Undo a run of merged edits that has not ended, because the drag was cancelled."""
        count = self.undo_stack.count()
        top = self.undo_stack.command(count - 1) if count else None
        if isinstance(top, _Change) and top.merge == merge and self.undo_stack.index() == count:
            top.cancelled = True
            self.undo_stack.undo()

    def take_motion(self, text: str, function: Edit) -> None:
        """Give clips their motion again. If nothing that is saved changes, this is not a step, and undo does
        not remove it.
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
        if self.autosave.journal is None:  # the first edit in a window that opened nothing
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
        """Return the folder that clip paths are relative to; None while the project was never saved (paths
        are absolute then).
        """
        return self.path.parent if self.path is not None else None

    # --- files

    def load(
        self,
        project: Project,
        path: Path | None,
        past: ProjectPast = NO_PAST,
        *,
        digest: str | None = None,
        lock: Lock | None = None,
        read_only: bool = False,
        newer: bool = False,
    ) -> None:
        """Show another project; without a path, its clip paths are absolute. `past` says how it came to be.

        `digest` is that of its file (its present one if left out), and `lock` the lock of the file. `newer`
        says that a newer Metagraph wrote it.
        """
        steps = past.steps
        self._leave_file(lock)
        before, self.project = self.project, project
        self.path, self.lock, self.read_only, self._returned = path, lock, read_only or newer, False
        self.newer = newer
        self.digest = digest or self._digest_now()
        self._settle_in()
        first = steps[0].before if steps else project
        self.common = past.common if past.lost else first
        self.undo_stack.clear()
        self._restore(past.saved)
        if past.lost:
            self.undo_stack.resetClean()
        else:
            self.undo_stack.setClean()
        self._restore(steps)
        done = [(step.before, step.after, step.text) for step in steps]
        self.autosave.begin(first if past.lost or steps or path is None else None, past.lost, done)
        self.loaded.emit()
        self.changed.emit(before, project)
        self.state_changed.emit()

    def _restore(self, steps: Sequence[UndoStep]) -> None:
        """Put steps on the stack that were made before."""
        self.undo_stack.blockSignals(True)  # the views follow once, at the end
        self._restoring = True
        for step in steps:
            self.undo_stack.push(_Change(self, step.text, step.before, step.after, None))
        self._restoring = False
        self.undo_stack.blockSignals(False)

    def take_over(self, other: Document) -> None:
        """Continue with the document of another window, which gives it up: project, steps, file, lock and
        journal.
        """
        before, self.project, self.path = self.project, other.project, other.path
        self.owner, self.common, self.digest = other.owner, other.common, other.digest
        self.access, self._home = other.access, other._home
        self.read_only, self.newer, self._returned = other.read_only, other.newer, other._returned
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
        self._restoring = True  # only the stack moves, to the other's position
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
        """Apply what another program has written to the file: one step, which can be undone, to the saved
        state.
        """
        if project != self.project:
            self.undo_stack.push(_Change(self, tr("Reload from disk"), self.project, project, None))
        self.common, self.digest = self.project, digest
        self.undo_stack.setClean()
        self.autosave.begin(None)
        self.state_changed.emit()

    def merge(self, project: Project, theirs: Project, digest: str) -> None:
        """Apply the merge of this project and what another program has written to the file: one step, to be
        saved. `theirs` and `digest` are the content and digest of the file.
        """
        self.undo_stack.push(_Change(self, tr("Merge with the file"), self.project, project, None))
        self.common, self.digest = theirs, digest
        self.undo_stack.resetClean()
        self.keep_all()
        self.state_changed.emit()

    def save(self, path: Path | None = None) -> None:
        """Write the project now, whatever has happened to its file; see `begin_saving`. Raises FileError."""
        writing = self.begin_saving(path)
        writing.write()
        self.end_saving(writing)

    def begin_saving(self, path: Path | None = None) -> Writing:
        """Return the writing of the current project to its own file or another; in a new place it is named
        after its file.

        `write` may run on any thread while editing continues; then call `end_saving`.
        """
        target = path or self.path
        if target is None:
            raise ValueError("a project that was never saved needs a path")
        mark, journal = None, self.autosave.journal
        if journal is not None:
            with suppress(FileError):  # it is about to be saved
                mark = journal.mark()
        home = self._home if target == self.path else None
        return Writing(
            self.project,
            self.path,
            target,
            journal,
            mark,
            count_kept_versions(),
            home,
            self.access,
            self._steps_done(),
            self.digest,
        )

    def _steps_done(self) -> tuple[UndoStep, ...]:
        """Return the steps that lead to the current project, the last one last."""
        made = map(self.undo_stack.command, range(self.undo_stack.index()))
        return tuple(UndoStep(c.text(), c.before, c.after) for c in made if isinstance(c, _Change))

    def end_saving(self, writing: Writing) -> None:
        """Take what was written as the saved state. Edits made in the meantime are unsaved."""
        edited = self.project is not writing.project
        elsewhere = writing.target != self.path
        if elsewhere:
            self._move(writing.target)
        self.common, self.digest = writing.after if edited else self.project, writing.digest
        self._settle_in()
        if edited:
            self.undo_stack.resetClean()
        else:
            self.undo_stack.setClean()
        if elsewhere or not edited:  # otherwise the journal continues after a mark
            self.autosave.begin(self.project if edited else None, int(edited))
        self.state_changed.emit()
        self.saved.emit()

    def _move(self, target: Path) -> None:
        """Continue with another file: the paths of the project and of every step are relative to that."""
        before = self.project
        made = map(self.undo_stack.command, range(self.undo_stack.count()))
        changes = [change for change in made if isinstance(change, _Change)]
        now = UndoStep("", before, before)
        *moved, now = move_steps(
            [*(UndoStep("", c.before, c.after) for c in changes), now], self.path, target
        )
        for change, step in zip(changes, moved, strict=True):
            change.before, change.after = step.before, step.after
        self._move_lock(target)
        self.project, self.path, self.read_only, self.newer = now.after, target, False, False
        self.changed.emit(before, self.project)

    def _settle_in(self) -> None:
        """Remember what identifies the file and its folder."""
        self.access = access_of(self.path) or (self.access if self.path is not None else None)
        self._home = read_identity(self.path.parent) if self.path is not None else None

    def folder_now(self) -> Path | None:
        """Return where the file's folder is now, if it was renamed or moved while this window had it open."""
        if self.path is None:
            return None
        journal = self.autosave.journal
        return find_moved_folder(self.path.parent, self._home, journal.path if journal is not None else None)

    def follow(self, folder: Path) -> None:
        """Follow the project's folder to another name; everything in it has moved along."""
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
            lock.acquire()  # if somebody else has it, the window has asked before
            if self.lock is not None:
                self.lock.release()
            self.lock = lock

    def regain(self, lock: Lock) -> None:
        """Take the lock of the project's file, perhaps after losing it."""
        self.lock, self.read_only = lock, self.newer
        self.state_changed.emit()

    def lose_lock(self) -> None:
        """Become read-only, because another window has taken the file."""
        self.lock, self.read_only = None, True
        self.keep_all()
        self.state_changed.emit()

    # --- journal

    @property
    def journal_place(self) -> Path:
        """Return where this sitting keeps its edits."""
        journal = self.autosave.journal
        return journal.path if journal is not None else self.autosave.place

    def keep_all(self) -> None:
        """Write the whole project into the journal, because the file it builds on is another one now."""
        if self.dirty:
            self.autosave.begin(*self.unsaved(self.project))

    def unsaved(self, now: Project) -> tuple[Project, int, list[Done]]:
        """Return what leads to the current project: what it builds on, how many of the edits in that are
        unsaved, and the edits after it.
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
        """Return whether the journal is safely on the disk with every unsaved edit."""
        return self.autosave.secure()

    def touch_journal(self) -> None:
        """Touch the journal; see `Journal.touch`."""
        if self.autosave.journal is not None:
            self.autosave.journal.touch()

    def close_journal(self) -> None:
        """Remove the journal and release the file, when the user has saved or chosen to discard."""
        self._leave_file(None)

    def _leave_file(self, lock: Lock | None) -> None:
        self.autosave.forget()
        if self.lock is not None and (lock is None or lock.path != self.lock.path):
            self.lock.release()
        self.lock = None

    def _digest_now(self) -> str | None:
        try:
            return compute_file_digest(self.path)
        except FileError:
            return None
