"""Write a project on a thread while editing continues, one writing after another."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from pathlib import Path

from app.project.step_store import keep_steps
from metagraph.common.files import is_file
from metagraph.common.wording import phrase
from metagraph.errors import FileError
from metagraph.formats.new_file import Access
from metagraph.formats.project.appended_file import Identity, find_moved_folder, read_identity
from metagraph.formats.project.history import UndoStep
from metagraph.formats.project.journal import Journal
from metagraph.formats.project.paths import move_projects
from metagraph.formats.project.versions import write_project
from metagraph.formats.store import (
    SUFFIX,
    compute_content_digest,
    compute_file_digest,
    encode_project,
    read_with_digest,
)
from metagraph.graph.model import Project


class FileChangedError(Exception):
    """Raised if the project file is not the one that was last read or saved. `theirs` is its present content,
    None if that cannot be read.
    """

    def __init__(self, path: Path, theirs: Project | None, digest: str | None, why: str = "") -> None:
        super().__init__(f"{path.name} has changed")
        self.path, self.theirs, self.digest, self.why = path, theirs, digest, why


class FolderGoneError(FileError):
    """Raised if the folder of a project no longer exists. `place` is where it is now, None if unknown."""

    def __init__(self, path: Path, place: Path | None) -> None:
        self.place = place
        cause = phrase("its folder {folder} no longer exists", folder=path.parent)
        remedy = phrase("Save the project in another place. Your edits are kept until then.")
        if place is not None:
            cause = phrase("its folder {folder} is now {place}", folder=path.parent, place=place)
            remedy = phrase("Save the project there or in another place. Your edits are kept until then.")
        super().__init__(path, cause, phrase("while saving it"), remedy)

    def __reduce__(self) -> tuple[type[FolderGoneError], tuple[Path, Path | None]]:  # type: ignore[override]
        return type(self), (self.path, self.place)


@dataclass
class Writing:
    """One writing of a project in the state in which it was requested.

    `was` is the file its paths are relative to. `mark` is its position in the journal. `versions` is the
    number of earlier ones that are kept. `home` identifies the folder of its own file. `access` says who may
    read it. `steps` led to the project; `replaces` is the digest of the file as it was. After writing:
    `after` is the project as in the file, `digest` the file's SHA-256, `note` the reason if its earlier
    version could not be kept, and `again` whether its own file had been missing.
    """

    project: Project
    was: Path | None
    target: Path
    journal: Journal | None = None
    mark: int | None = None
    versions: int = 0
    home: Identity | None = None
    access: Access | None = None
    steps: tuple[UndoStep, ...] = ()
    replaces: str | None = None
    anew: bool = False
    after: Project = field(default_factory=Project)
    digest: str = ""
    note: str | None = None

    def write(self, expected: str | None = None) -> None:
        """Write the file, whole or not at all. `expected` is the digest that the old file must have. Raises
        FileError, FileChangedError.
        """
        if self.target == self.was:
            self._look_for_folder()
            self.anew = not is_file(self.target)
        self.after = self.project
        if self.target != self.was:
            self.after = move_states([self.project], self.was, self.target)[0]
        content = encode_project(self.after, self.target)
        self.digest = compute_content_digest(content)
        if expected is not None:
            changed = find_file_change(self.target, expected)
            if changed is not None and changed.digest != self.digest:
                raise changed
        if self.journal is not None and self.mark is not None:
            with suppress(FileError):  # what cannot be journalled must be saved in any case
                self.journal.settle(self.mark, self.digest)
        self.note = write_project(self.target, content, self.versions, self.access)
        self._keep_steps()

    def _keep_steps(self) -> None:
        """Keep the steps for the next time the project is opened."""
        steps = self.steps
        if self.target != self.was:
            steps = move_steps(steps, self.was, self.target)
        keep_steps(self.digest, steps, self.replaces if self.target == self.was else None)

    def _look_for_folder(self) -> None:
        """Raise FolderGoneError if the folder is gone or has another name, because nobody would look for the
        project in a new one.
        """
        folder = self.target.parent
        there = read_identity(folder)
        if there is None or (self.home not in (None, there) and not is_file(self.target)):
            journal = self.journal.path if self.journal is not None else None
            place = find_moved_folder(folder, self.home, journal)
            if there is None or place is not None:
                raise FolderGoneError(self.target, place)


def move_states(states: Sequence[Project], old: Path | None, new: Path) -> list[Project]:
    """Return the states of a project as they are when it is saved as another file: with other paths, and
    named after it. `old` is the file that their paths are relative to, None if these are absolute.
    """
    name = name_after_file(new)
    moved = move_projects(states, old, new)
    renamed = {id(state): replace(state, name=name) for state in moved}  # one state stays one object
    return [renamed[id(state)] for state in moved]


def move_steps(steps: Sequence[UndoStep], old: Path | None, new: Path) -> tuple[UndoStep, ...]:
    """Return the steps between the states that `move_states` returns."""
    moved = iter(move_states([state for step in steps for state in (step.before, step.after)], old, new))
    return tuple(UndoStep(step.text, next(moved), next(moved)) for step in steps)


def find_file_change(path: Path, expected: str) -> FileChangedError | None:
    """Return how a project file has changed; None if it has not, or is missing."""
    try:
        now = compute_file_digest(path)
    except FileError:
        return None  # the code that writes or reads it will report this
    if now is None or now == expected:
        return None
    try:
        return FileChangedError(path, *read_with_digest(path))
    except FileError as error:
        return FileChangedError(path, None, now, str(error))


def name_after_file(path: Path) -> str:
    """Return the name of a project saved as `path`: the file's name without `.metagraph.yaml`."""
    name = path.name
    for suffix in (SUFFIX, ".yaml", ".yml"):
        if name.lower().endswith(suffix) and len(name) > len(suffix):
            return name[: -len(suffix)]
    return name
