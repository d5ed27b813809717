"""Write the journal of a document: beside its file, or in the user's own folder if that is impossible."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from typing import Protocol

from PySide6.QtCore import QStandardPaths, SignalInstance

from app.translation import tr, tr_phrase
from metagraph.errors import FileError
from metagraph.formats.locking import Owner
from metagraph.formats.new_file import PRIVATE, Access
from metagraph.formats.project.journal import Done, How, Journal, make_journal_path
from metagraph.formats.project.journal_register import JournalRegister
from metagraph.graph.model import Project


class JournalledDocument(Protocol):
    """What the journal needs from its document; see `app.project.document.Document`."""

    project: Project
    path: Path | None
    owner: Owner
    digest: str | None
    access: Access | None
    read_only: bool
    failed: SignalInstance
    warned: SignalInstance

    def unsaved(self, now: Project) -> tuple[Project, int, list[Done]]: ...


class Autosave:
    """Writes a document's edits to its journal. The document reports everything that the user must know."""

    def __init__(self, document: JournalledDocument) -> None:
        self.document = document
        self.journal: Journal | None = None
        self._abandoned: list[Journal] = []  # their folder is gone; removed once all is saved

    @property
    def folder(self) -> Path:
        """Return the user's own folder, for journals of projects that were never saved, and those whose own
        place is gone; it also has the list of all journals.
        """
        return state_folder()

    @property
    def register(self) -> JournalRegister:
        return JournalRegister(find_journal_shelter(self.folder))

    @property
    def place(self) -> Path:
        """Return where this sitting keeps its edits, unless something prevents it."""
        document = self.document
        if document.path is None:
            return make_journal_path(self.folder / "untitled", document.owner.sitting)
        return make_journal_path(document.path.resolve(), document.owner.sitting)

    def begin(self, base: Project | None, unsaved: int = 0, done: Sequence[Done] = ()) -> None:
        """Begin again. `base` is what the journal must hold itself because no file does; `unsaved` is the
        number of its edits that are not saved to a file, and `done` are the edits after it.
        """
        document = self.document
        old, self.journal = self.journal, None
        if old is not None:
            old.close()
        journal = self._made(self.place)
        if base is not None:
            try:
                journal.begin(base, unsaved, done)
            except FileError as error:  # the edits in the old one stay there
                journal = self._sheltered(base, unsaved, done, error) or journal  # this tries again
                if not journal.begun:
                    self.journal = journal
                    document.failed.emit(tr("Autosave is off: {error}", error=error))
                    return
        if base is not None or not document.read_only:
            self.journal = journal  # else it begins with the first edit
        if old is not None and (base is None or old.path != journal.path):
            old.remove()
        self._forget_abandoned(journal.path if journal.begun else None)

    def take_over(self, other: Autosave) -> None:
        """Continue with the journal of another window."""
        self.journal, other.journal = other.journal, None
        self._abandoned, other._abandoned = other._abandoned, []

    def _made(self, place: Path) -> Journal:
        document = self.document
        like = document.access if document.path is not None and place.parent != self.folder else PRIVATE
        return Journal(place, document.path, document.owner, document.digest, like, self.register)

    def write(self, before: Project, after: Project, text: str, how: How) -> None:
        """Write an edit. If the journal's place is gone, write everything unsaved into the user's
        own folder.
        """
        if self.journal is None:
            return
        try:
            self.journal.edit(before, after, text, how)
        except FileError as error:
            if not self._take_shelter(before, error):
                self.document.failed.emit(tr("This edit was not autosaved: {error}", error=error))
                return
            with suppress(FileError):
                self.journal.edit(before, after, text, how)
        self.tell()

    def _take_shelter(self, now: Project, error: FileError) -> bool:
        base, unsaved, done = self.document.unsaved(now)
        journal = self._sheltered(base, unsaved, done, error)
        if journal is None:
            return False
        if self.journal is not None:
            self.journal.close()
            self._abandoned.append(self.journal)
        self.journal = journal
        return True

    def _sheltered(
        self, base: Project, unsaved: int, done: Sequence[Done], error: FileError
    ) -> Journal | None:
        """Return a journal in the user's own folder with everything unsaved; None if that is impossible."""
        document = self.document
        folder = find_journal_shelter(self.folder)
        if document.path is None or (self.journal is not None and self.journal.path.parent == folder):
            return None
        place = make_journal_path(folder / document.path.name, document.owner.sitting)
        journal = Journal(place, document.path, document.owner, document.digest, PRIVATE, self.register)
        try:
            folder.mkdir(mode=0o700, parents=True, exist_ok=True)
            journal.begin(base, unsaved, done)
        except (FileError, OSError):
            return None
        self._warn(
            tr(
                "Your edits can no longer be kept beside {name}: {error} They are now kept in "
                "Metagraph's own folder and offered when you open the project again. To be safe, save "
                "the project in another place.",
                name=document.path.name,
                error=error,
            )
        )
        return journal

    def look_after(self) -> None:
        """Report what happened to the journal, and move to the user's own folder if its place is gone."""
        self.tell()
        if self.journal is not None and self.journal.error is not None:
            error, self.journal.error = self.journal.error, None
            self._take_shelter(self.document.project, error)

    def tell(self) -> None:
        notes = self.journal.notes if self.journal is not None else []
        while notes:
            self._warn(tr_phrase(notes.pop(0)))

    def _warn(self, words: str) -> None:
        self.document.failed.emit(words)
        self.document.warned.emit(words)

    def secure(self) -> bool:
        """Return whether the journal is safely on the disk with every unsaved edit."""
        if self.journal is None:
            return False
        safe = self.journal.secure()
        if not safe:
            self.look_after()
            safe = self.journal.secure()
        self.tell()
        return safe

    def forget(self) -> None:
        """Remove the journal, because everything was saved, or is discarded."""
        if self.journal is not None:
            self.journal.remove()
            self.journal = None
        self._forget_abandoned(None)

    def _forget_abandoned(self, kept: Path | None) -> None:
        for journal in self._abandoned:
            if journal.path != kept:
                journal.remove()
        self._abandoned.clear()


def find_journal_shelter(folder: Path) -> Path:
    """Return the folder of the list of journals, and of journals that cannot be elsewhere."""
    return folder / "journals"


def state_folder() -> Path:
    """Return the folder for the recent projects and the journals of unsaved work; it is made if necessary."""
    folder = Path(QStandardPaths.writableLocation(QStandardPaths.StandardLocation.AppDataLocation))
    with suppress(OSError):  # the code that writes there reports it
        folder.mkdir(parents=True, exist_ok=True)
    return folder
