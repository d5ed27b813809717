"""Writing a project on a thread while it is edited on, one writing after another."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import field, replace
from pathlib import Path

from metagraph.errors import FileError
from metagraph.formats.journal import Journal
from metagraph.formats.store import SUFFIX, content_digest, encoded, file_digest, moved, read_with_digest
from metagraph.formats.versions import write_project
from metagraph.graph.model import Project
from metagraph.records import dataclass


class FileChangedError(Exception):
    """The project file is not the one that was read or saved last. theirs: what it holds now, None where that
    cannot be read.
    """

    def __init__(self, path: Path, theirs: Project | None, digest: str | None, why: str = "") -> None:
        super().__init__(f"{path.name} has changed")
        self.path, self.theirs, self.digest, self.why = path, theirs, digest, why


@dataclass
class Writing:
    """One writing of a project as it was when it was asked for.

    was: the file its paths are relative to. mark: where it stands in the journal. versions: how many earlier
    ones are kept. When it is written: after, the project as the file has it, digest, that file's SHA-256, and
    note, why its earlier version could not be kept.
    """

    project: Project
    was: Path | None
    target: Path
    journal: Journal | None = None
    mark: int | None = None
    versions: int = 0
    after: Project = field(default_factory=Project)
    digest: str = ""
    note: str | None = None

    def write(self, expected: str | None = None) -> None:
        """Write the file whole or not at all. expected: the digest it has to have. Raises FileError,
        FileChangedError.
        """
        self.after = self.project
        if self.target != self.was:
            self.after = replace(moved(self.project, self.was, self.target), name=project_name(self.target))
        content = encoded(self.after, self.target)
        self.digest = content_digest(content)
        if expected is not None:
            changed = file_changed(self.target, expected)
            if changed is not None and changed.digest != self.digest:
                raise changed
        if self.journal is not None and self.mark is not None:
            with suppress(FileError):  # what cannot be journalled is to be saved all the same
                self.journal.settle(self.mark, self.digest)
        self.note = write_project(self.target, content, self.versions)


def file_changed(path: Path, expected: str) -> FileChangedError | None:
    """Return how a project file has changed; None when it has not, or is not there."""
    try:
        now = file_digest(path)
    except OSError:
        return None  # whoever writes or reads it will say so
    if now is None or now == expected:
        return None
    try:
        return FileChangedError(path, *read_with_digest(path))
    except FileError as error:
        return FileChangedError(path, None, now, str(error))


def project_name(path: Path) -> str:
    """Return what a project saved as `path` is called: the file's name without `.metagraph.yaml`."""
    name = path.name
    for suffix in (SUFFIX, ".yaml", ".yml"):
        if name.lower().endswith(suffix) and len(name) > len(suffix):
            return name[: -len(suffix)]
    return name
