"""What stands beside a project file when it is opened: another window's lock, and journals of sittings that
ended in a crash.
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from app.project.document import state_folder
from metagraph.errors import FileError
from metagraph.formats.locking import Holder, Lock, Owner
from metagraph.formats.recovery import Left, journals_in, left_journals, read_journal
from metagraph.formats.store import SUFFIX, save_project

UNTITLED = (
    r"\.untitled\.[0-9a-f]+\.journal|untitled(-\d+)?\.journal"  # the second as they were called at first
)


@dataclass(frozen=True)
class FoundJournal:
    """lock: ours, unless there is a holder. left: journals with edits, the latest first. notes: what cannot
    be recovered, in words.
    """

    lock: Lock | None
    holder: Holder | None
    left: tuple[Left, ...]
    notes: tuple[str, ...]


def look_beside(path: Path, owner: Owner) -> FoundJournal:
    """Take the lock of a project file, and read the journals that were left beside it."""
    if not path.is_file():
        return FoundJournal(None, None, (), ())
    lock = Lock(path, owner)
    return FoundJournal(lock, lock.acquire(), *_read(left_journals(path), path))


def untitled_journals() -> list[Path]:
    """Return the journals of projects never saved whose windows are gone."""
    return journals_in(state_folder(), UNTITLED)


def read_untitled(journals: Sequence[Path]) -> FoundJournal:
    return FoundJournal(None, None, *_read(journals, None))


def _read(journals: Sequence[Path], saved: Path | None) -> tuple[tuple[Left, ...], tuple[str, ...]]:
    left: list[Left] = []
    notes: list[str] = []
    for journal in journals:
        try:
            found = read_journal(journal, saved)
        except FileError as error:
            kept = journal.with_suffix(".old")
            with suppress(OSError):
                journal.replace(kept)
            notes.append(f"{error} ({kept.name})")
            continue
        if found is not None:
            left.insert(0, found)
        else:
            forget(journal)  # all of it was saved, or nothing edited
    return tuple(left), tuple(notes)


def forget(journal: Path) -> None:
    """Remove a journal that was taken over or declined; where that is not allowed it is offered again."""
    with suppress(OSError):
        journal.unlink(missing_ok=True)


def keep_as_copy(left: Left, saved: Path) -> Path:
    """Save a journal's project beside the project file it belongs to, under a name that is free; return
    where. Raises FileError.
    """
    stem = saved.name.removesuffix(SUFFIX) if saved.name.endswith(SUFFIX) else saved.stem
    number = 1
    while (
        place := saved.with_name(f"{stem} recovered{f' {number}' if number > 1 else ''}{SUFFIX}")
    ).exists():
        number += 1
    save_project(left.project, place)
    return place
