"""Recover work from journals after a crash: find journals whose sittings are over, and apply their edits to
projects.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

import msgspec

from metagraph.common.budgets import TEXT_FILE
from metagraph.common.files import is_file, read_file
from metagraph.errors import FileError
from metagraph.formats.clip_identity import remove_clip_identities
from metagraph.formats.locking import Owner, is_gone
from metagraph.formats.project.appended_file import Identity
from metagraph.formats.project.canonical_text import read_canonical
from metagraph.formats.project.data import FORMAT, from_data, to_data
from metagraph.formats.project.fields import Data, DataError
from metagraph.formats.project.journal_records import JournalRecord, LostEdit, Records, read_records
from metagraph.formats.project.replay import Replay
from metagraph.formats.store import compute_content_digest, compute_file_digest, parse_project, read_project
from metagraph.graph.model import Project

JOURNAL = 1 << 33  # bytes of a journal that are read: as many as a person can fill
DAMAGED = ".damaged"  # the end of a damaged journal's name, once everything readable in it was recovered
_UNFIT = 50  # edits that may fail to fit; after that, all later ones are left out
_KEPT = "It is kept."
_ANOTHER = "belongs to another state of the project file"


@dataclass(frozen=True)
class Left:
    """A journal that a sitting left behind.

    `project` has its edits applied, without motion, and `edits` is their number. `written` is the time of the
    last one, in seconds since 1970. `digest` is that of the file the edits build on. `behind` means that the
    project file has changed since: the edits are complete, but do not build on its present state. `worked_in`
    means that it has changed, and that the journal does not contain the earlier state, so the edits are
    applied to the present one. `base` is what the edits begin with, as plain data, of which `unsaved` edits
    are not in a file; `records` are the edits after it. `lost` are the edits that the journal cannot give
    back because it is damaged. `doubtful` means that the base was damaged, too, so a value in it may be
    wrong. `saved` is the project file that the journal names.
    """

    path: Path
    project: Project
    edits: int
    owner: Owner | None
    written: float
    digest: str | None
    behind: bool
    base: Data
    unsaved: int
    records: tuple[Data, ...]
    worked_in: bool = False
    lost: tuple[LostEdit, ...] = ()
    doubtful: bool = False
    saved: Path | None = None

    @property
    def is_damaged(self) -> bool:
        return bool(self.lost) or self.doubtful

    @property
    def common(self) -> Project | None:
        """Return what the file held that the edits build on, without motion; None if that is unknown."""
        return from_data(self.base, []) if self.digest is not None and not self.unsaved else None


def recover(journal: Path, saved: Path | None) -> tuple[Project, int] | None:
    """Return the project with the journal's edits applied, without motion, and their number; None if there
    are none.

    Raises FileError if the journal belongs to another state of the file, or nothing in it can be used.
    """
    found = read_journal(journal, saved)
    if found is not None and (found.behind or found.worked_in):
        raise FileError(journal, _ANOTHER, "line 1", _KEPT)
    return (found.project, found.edits) if found is not None else None


def read_journal(journal: Path, saved: Path | None) -> Left | None:
    """Return what a journal holds; None if it has no edit. A damaged record does not affect the others.

    Raises FileError if nothing in it can be used.
    """
    try:
        content = read_file(journal, JOURNAL)
        written = journal.stat().st_mtime
    except FileNotFoundError:
        return None
    except OSError as error:
        raise FileError(journal, f"cannot be read ({error.strerror or error})", "", _KEPT) from None
    except FileError as error:
        if not journal.exists() or journal.is_dir():
            return None
        raise FileError(journal, error.cause, "", _KEPT) from None
    records = read_records(content)
    if not content.strip(b"\n") or (not records.entries and not records.head):
        return None
    begun = _begun(records, journal)
    if begun is None:
        raise FileError(journal, "is damaged", "line 1", _KEPT)
    head, rest = begun
    now = compute_file_digest(saved)
    kept = rest[_settled(rest, now) :]
    all_of_it = len(kept) == len(rest)
    base = head.get("base") if all_of_it else None
    unsaved = head.get("unsaved", 0)
    before = unsaved if isinstance(base, dict) and _is_number(unsaved) else 0
    edits = [e.data for e in kept if isinstance(e, JournalRecord) and "mark" not in e.data]
    lost = [e for e in kept if isinstance(e, LostEdit)]
    if all_of_it and records.foundation and not isinstance(base, dict) and _is_number(unsaved):
        lost = [LostEdit()] * unsaved + lost
    if not edits and not before and not lost:
        return None
    changed = all_of_it and head.get("saved") != now
    if not isinstance(base, dict) and (changed or saved is None):
        base = _of_text(head.get("text"), journal)
    behind = changed and isinstance(base, dict)
    doubtful = bool(records.foundation) and all_of_it and (changed or head.get("holds") != "text")
    if (
        doubtful
        and head.get("holds") == "base"
        and not isinstance(base, dict)
        and _is_number(head["unsaved"])
    ):
        lost = [LostEdit()] * head["unsaved"] + lost
    if not isinstance(base, dict):
        base = _saved_data(saved, as_opened=not changed)
    project, good, unfit = _worked_in(base, edits)
    if not good and not before:
        raise FileError(journal, _ANOTHER if changed and not behind else "is damaged", "line 2", _KEPT)
    return Left(
        journal,
        project,
        before + max(1, sum(record.get("how") != "merged" for record in good)) if good else before,
        read_journal_owner(head),
        written,
        head.get("saved") if behind else now,
        behind,
        base,
        before,
        tuple(good),
        changed and not behind,
        (*lost, *map(_unfit, unfit)),
        doubtful,
        _named(head),
    )


def _begun(records: Records, journal: Path) -> tuple[Data, tuple[JournalRecord | LostEdit, ...]] | None:
    """Return what a journal begins with and what comes after it; None if it is not a journal.

    If the beginning is damaged, it is pieced together: the file's digest is that of its text, and a text with
    a wrong letter in it is better than none.
    """
    entries = records.entries
    numbered = any(record.number is not None for record in records.whole)
    if not numbered:
        if not entries or not isinstance(entries[0], JournalRecord) or "saved" not in entries[0].data:
            return None
        return entries[0].data, entries[1:]
    head: Data = {}
    for number in (0, 1):
        if entries and isinstance(entries[0], JournalRecord) and entries[0].number == number:
            head |= entries[0].data
            entries = entries[1:]
    if records.foundation:
        head |= _repaired(records.foundation, journal)
    if records.head and isinstance(head.get("text"), str) and not records.foundation:
        head["saved"] = compute_content_digest(head["text"].encode())
    return head, entries


def _repaired(line: bytes, journal: Path) -> Data:
    """Return what a damaged foundation says, if a project can be read from it."""
    with suppress(ValueError, RecursionError):
        found = json.loads(line.rpartition(b"\t")[0].rpartition(b"\t")[0], strict=False)
        if isinstance(found, dict) and isinstance(found.get("base"), dict):
            if _replayed(found["base"], []) is not None:
                return found
        elif isinstance(found, dict) and _of_text(found.get("text"), journal) is not None:
            return {"text": found["text"]}
    return {}


def _worked_in(base: Data, edits: Sequence[Data]) -> tuple[Project, list[Data], list[Data]]:
    """Return the project with the edits that fit applied, these edits, and the others. Usually all fit."""
    good: list[Data] = []
    unfit: list[Data] = []
    rest = list(edits)
    project: Project | None = None
    while rest:
        fits, bad = 0, len(rest) + 1
        count = len(rest)
        while count > fits:
            found = _replayed(base, [*good, *rest[:count]])
            if found is not None:
                fits, project = count, found
            else:
                bad = count
            count = (fits + bad) // 2
        good += rest[:fits]
        unfit += rest[fits : fits + 1] if len(unfit) < _UNFIT else rest[fits:]
        rest = rest[fits + 1 :] if len(unfit) <= _UNFIT else []
    return project or _replayed(base, []) or Project(), good, unfit


def _unfit(record: Data) -> LostEdit:
    at = record.get("at")
    return LostEdit(str(record.get("step") or ""), at if _is_number(at) else None, "unfit")


def _named(head: Data) -> Path | None:
    name = head.get("file")
    return Path(name) if isinstance(name, str) and name else None


def _of_text(text: object, journal: Path) -> Data | None:
    """Return what a project file held whose text is in a journal."""
    with suppress(FileError):
        return to_data(parse_project(text, journal, [])) if isinstance(text, str) else None
    return None


def _saved_data(saved: Path | None, as_opened: bool) -> Data:
    """Return what the project file holds. With `as_opened`, it is as a window opened or saved it, so no
    project needs to be made of it to check that it is one. Raises FileError.
    """
    if saved is None or not saved.is_file():
        return to_data(Project())
    if as_opened:
        with suppress(UnicodeDecodeError, KeyError, TypeError, AttributeError):
            data = read_canonical(read_file(saved, TEXT_FILE).decode("utf-8-sig"))
            if data is not None and data["metagraph"] == FORMAT:
                data = remove_clip_identities(data)
                Replay(data)  # has all that edits change, even if written by hand
                return data
    return to_data(read_project(saved, []))


def _settled(entries: Sequence[JournalRecord | LostEdit], digest: str | None) -> int:
    """Return the number of the first entry that the file with a digest does not have."""
    settled = [e.data for e in entries if isinstance(e, JournalRecord) and "mark" in e.data]
    marks = [r["mark"] for r in settled if digest is not None and r.get("saved") == digest]
    if not marks:
        return 0
    for place, entry in enumerate(entries):
        if isinstance(entry, JournalRecord):
            if entry.number is None and entry.data.get("mark") == marks[-1] and "saved" not in entry.data:
                return place + 1
            if entry.number is not None and _is_number(marks[-1]) and entry.number > marks[-1]:
                return place - _lost_before(entries[:place], entry.number - marks[-1] - 1)
    return 0


def _lost_before(entries: Sequence[JournalRecord | LostEdit], most: int) -> int:
    """Return how many entries at the end are lost edits, at most `most`."""
    return next(
        (n for n, entry in enumerate(entries[::-1][:most]) if isinstance(entry, JournalRecord)),
        min(most, len(entries)),
    )


def _is_number(value: object) -> bool:
    return isinstance(value, int)


def read_journal_owner(head: Data) -> Owner | None:
    """Return whose journal it is, from its beginning; None if that does not say it."""
    try:
        return msgspec.convert(head.get("owner"), Owner)
    except msgspec.ValidationError:
        return None


def _replayed(base: Data, records: Sequence[Data]) -> Project | None:
    try:
        replay = Replay(base)
        for record in records:
            replay.apply(record)
        return from_data(replay.data(), [])
    except (DataError, KeyError, TypeError, AttributeError):
        return None


# --- which there are


def find_left_journals(saved: Path) -> list[Path]:
    """Return the journals of a project file whose sittings are over, the latest last, including those that
    were put aside when the file had changed.
    """
    return find_journals_in(saved.parent, rf"{re.escape(f'.{saved.name}')}(\.[0-9a-f]+)?\.(journal|old)")


def find_journals_in(folder: Path, names: str) -> list[Path]:
    """Return the journals in a folder whose names match a regular expression and whose sittings are over, the
    latest last.
    """
    wanted = re.compile(names)
    found: list[Path] = []
    with suppress(OSError):  # a folder that cannot be listed has none
        found = [path for path in folder.iterdir() if wanted.fullmatch(path.name) and is_file(path)]
    return order_journals(path for path in found if is_left(path))


def order_journals(journals: Iterable[Path]) -> list[Path]:
    """Return journals, each once whatever its names, the latest last."""
    found: dict[Identity, tuple[float, Path]] = {}
    for path in journals:
        with suppress(OSError):
            told = path.stat()
            found.setdefault((told.st_dev, told.st_ino), (told.st_mtime, path))
    return [path for _, path in sorted(found.values())]


def is_left(journal: Path) -> bool:
    """Return whether no process writes to a journal any more. Journals without an owner are older than the
    owner field.
    """
    owner = read_journal_owner(read_journal_head(journal))
    return owner is None or is_gone(owner, journal)


def retire(journal: Path) -> None:
    """Remove a journal that was recovered or declined; a damaged one is kept under another name. Raises
    OSError.
    """
    if not is_damaged(journal):
        journal.unlink(missing_ok=True)
    elif not journal.name.endswith(DAMAGED):
        journal.replace(journal.with_name(f"{journal.name}{DAMAGED}"))


def is_damaged(journal: Path) -> bool:
    """Return whether a journal holds records that cannot be read."""
    try:
        records = read_records(read_file(journal, JOURNAL))
    except FileError:
        return journal.exists()
    return bool(records.head or records.foundation) or len(records.whole) < len(records.entries)


def read_journal_head(journal: Path) -> Data:
    """Return what a journal begins with; empty if it cannot be read."""
    with suppress(OSError), journal.open("rb") as file:
        records = read_records(file.readline(1 << 28))
        if records.whole:
            return records.whole[0].data
    return {}
