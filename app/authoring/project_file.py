"""Work on a project's file without a window: each edit is saved as a step that the window shows in its
history and can undo.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from app.project.change_words import describe_edit
from app.project.opening import open_whole
from app.project.step_store import find_steps, keep_steps
from app.project.version_count import count_kept_versions
from app.project.writing import name_after_file
from app.translation import tr
from metagraph.common.files import is_file
from metagraph.errors import FileError
from metagraph.formats.locking import Lock, make_owner
from metagraph.formats.outputs import declare_inputs, declare_updates, make_locked_error
from metagraph.formats.project.history import UndoStep
from metagraph.formats.project.paths import list_project_files
from metagraph.formats.project.versions import write_project
from metagraph.formats.store import compute_content_digest, compute_file_digest, encode_project
from metagraph.graph.model import Project


class AuthoredFile:
    """A project's file. It is locked during each call alone, and read again if somebody has changed it.

    roots: further folders that may be used. look_only: whether nothing may be edited. notes: what was odd
    about the project when it was read.
    """

    def __init__(self, path: Path, roots: Sequence[Path] = (), look_only: bool = False) -> None:
        self.path = path
        self.roots = (path.resolve().parent, *(root.resolve() for root in roots))
        self.project = Project(name=name_after_file(path))
        self.notes: tuple[str, ...] = ()
        self._look_only = look_only
        self._owner = make_owner()
        self._digest: str | None = None  # of the file that was read or written last; None if there is none
        self._steps: list[UndoStep] = []
        self._undone: list[UndoStep] = []
        self._saved = False  # whether this sitting has written it

    @contextmanager
    def hold(self) -> Iterator[None]:
        """Lock the file, and read what is in it. Raises FileError if a window or a command has it."""
        lock = Lock(self.path, self._owner)
        found = lock.acquire()
        if found is not None:
            error = make_locked_error(self.path, found)
            remedy = f"{error.remedy} Or choose 'File > Let agents edit' in its window, and connect again."
            raise FileError(self.path, error.cause, "", remedy)
        try:
            self._refresh()
            yield
        finally:
            lock.release()

    def find_refusal(self) -> str:
        return "edits are forbidden: this server was started with --look-only" if self._look_only else ""

    def commit(self, title: str, after: Project) -> str:
        text = tr("{what} (agent)", what=describe_edit(title, self.project, after))
        step = UndoStep(text, self.project, after)
        self._write(after, [*self._steps, step])
        self._undone.clear()
        return text

    def list_steps(self) -> tuple[Sequence[str], Sequence[str]]:
        return [step.text for step in self._steps], [step.text for step in self._undone]

    def undo(self) -> None:
        *before, step = self._steps
        self._write(step.before, before)
        self._undone.insert(0, step)

    def redo(self) -> None:
        step = self._undone[0]
        self._write(step.after, [*self._steps, step])
        del self._undone[0]

    def _refresh(self) -> None:
        """Read the file if it is not as it was."""
        digest = compute_file_digest(self.path) if is_file(self.path) else None
        if digest == self._digest:
            return
        if digest is None:  # it was removed: the next edit writes it again
            self._digest = None
            return
        folder = self.path.resolve().parent
        opened = open_whole(self.path)
        self.project, self.notes, self._digest = opened.project, opened.notes, opened.digest
        self._steps, self._undone = list(find_steps(opened.digest, opened.project, folder)), []
        declare_updates(self.path)
        declare_inputs(*list_project_files(opened.project, folder))

    def _write(self, project: Project, steps: list[UndoStep]) -> None:
        """Write the file and its steps. The earlier version that is kept is the one before this sitting."""
        content = encode_project(project, self.path)
        declare_updates(self.path)
        write_project(self.path, content, 0 if self._saved else count_kept_versions())
        digest = compute_content_digest(content)
        keep_steps(digest, steps, self._digest)
        self.project, self._digest, self._saved, self._steps = project, digest, True, steps
