"""The journals that are there, wherever they are: a small file for each in the user's own folder.

A journal lies beside its project, and is looked for there. When the project is moved, renamed or deleted
after a crash, this list still knows it. A file for each journal needs no lock: windows write their own alone.
"""

from __future__ import annotations

import hashlib
from contextlib import suppress
from pathlib import Path

import msgspec

from metagraph.errors import FileError
from metagraph.formats.new_file import PRIVATE
from metagraph.formats.project.appended_file import read_identity
from metagraph.formats.project.fields import Data
from metagraph.formats.replacing import replace_file


class KnownJournal(msgspec.Struct, frozen=True):
    """A journal that was begun. project: its project file, None if there was none; digest: of that file,
    SHA-256; identity: device and number of it. begun: seconds since 1970.
    """

    journal: str
    project: str | None
    digest: str | None
    identity: tuple[int, int] | None
    begun: int


class JournalRegister:
    """The list in one folder. What cannot be written there is not listed: nothing hangs on it."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def add(self, journal: Path, project: Path | None, head: Data) -> None:
        """List a journal. head: what it begins with."""
        known = KnownJournal(
            str(journal),
            str(project.resolve()) if project is not None else None,
            head.get("saved"),
            read_identity(project) if project is not None else None,
            int(head.get("begun", 0)),
        )
        with suppress(OSError, FileError, UnicodeEncodeError):
            self.folder.mkdir(parents=True, exist_ok=True, mode=0o700)
            replace_file(self._entry(journal), msgspec.json.encode(known) + b"\n", False, PRIVATE)

    def remove(self, journal: Path) -> None:
        """Take a journal off the list."""
        with suppress(OSError):
            self._entry(journal).unlink(missing_ok=True)

    def known(self) -> list[KnownJournal]:
        """Return what is listed, the latest last."""
        found: list[KnownJournal] = []
        with suppress(OSError):
            for entry in self.folder.glob("*.json"):
                with suppress(OSError, msgspec.MsgspecError, UnicodeDecodeError):
                    found.append(msgspec.json.decode(entry.read_bytes(), type=KnownJournal))
        return sorted(found, key=lambda known: known.begun)

    def _entry(self, journal: Path) -> Path:
        key = hashlib.sha256(str(journal.absolute()).encode("utf-8", "surrogateescape")).hexdigest()[:24]
        return self.folder / f"{key}.json"
