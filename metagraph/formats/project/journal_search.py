"""Find journals of sessions that are over, beside their project and elsewhere."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from contextlib import suppress
from pathlib import Path

from metagraph.common.files import is_file
from metagraph.errors import FileError
from metagraph.formats.project.appended_file import read_identity
from metagraph.formats.project.journal_register import JournalRegister, KnownJournal
from metagraph.formats.recovery import (
    DAMAGED,
    find_journals_in,
    find_left_journals,
    is_left,
    order_journals,
    read_journal_head,
)
from metagraph.formats.store import compute_file_digest

ANY = r"\..+\.(journal|old)"  # `.old`: as those were called at first that could not be read
_BESIDE = re.compile(r"\.(?P<name>.+?)(\.[0-9a-f]+)?\.(journal|old)(\.damaged)?")
FOLDERS = 2_000  # looked into for a journal that is not where it was


def find_journals_for(saved: Path, register: JournalRegister) -> list[Path]:
    """Return the journals that belong to a project file, the latest last: by its name, and, when it was
    renamed, moved or is opened by another way, by what it holds.
    """
    real = saved.resolve()
    found = [*find_left_journals(saved), *find_left_journals(real)]
    others = [path for path in find_journals_in(real.parent, ANY) if path not in found]
    known = {Path(one.journal): one for one in register.known()}
    others += [path for path in known if path not in others and is_file(path) and is_left(path)]
    digest: str | None = None
    with suppress(FileError):
        digest = compute_file_digest(real)
    for path in others:
        if _belongs(path, known.get(path), real, digest):
            found.append(path)
    return order_journals(found)


def find_journals_beside(saved: Path) -> list[Path]:
    """Return all journals in a project file's folder that belong to it, by name or by what they hold, the
    latest last: also those that somebody writes to, and those kept as damaged. Nothing is written for that.
    """
    real = saved.resolve()
    own = re.compile(rf"{re.escape(f'.{real.name}')}(\.[0-9a-f]+)?\.(journal|old)({re.escape(DAMAGED)})?")
    digest: str | None = None
    with suppress(FileError):
        digest = compute_file_digest(real)
    beside: list[Path] = []
    with suppress(OSError):
        beside = [p for p in real.parent.iterdir() if re.fullmatch(f"{ANY}({re.escape(DAMAGED)})?", p.name)]
    return order_journals(
        path
        for path in beside
        if is_file(path) and (own.fullmatch(path.name) or _belongs(path, None, real, digest))
    )


def _belongs(journal: Path, known: KnownJournal | None, saved: Path, digest: str | None) -> bool:
    named = known.project if known is not None else read_journal_head(journal).get("file")
    if not isinstance(named, str) or not named:
        return False  # of a project that was never saved
    project = Path(named)
    with suppress(OSError):
        if project.resolve() == saved or (is_file(saved) and is_file(project) and project.samefile(saved)):
            return True
    if is_file(project):
        return False  # it is that one's
    here = read_identity(saved)
    if known is not None and known.identity is not None and here is not None:
        if known.identity == here:
            return True
        if known.identity[0] == here[0] and journal.parent != saved.parent:
            return False  # a copy: on one drive a file that is moved stays the same
    with suppress(OSError):
        return digest is not None and digest.encode() in journal.read_bytes()
    return False


def find_all_journals(register: JournalRegister, folders: Iterable[Path]) -> list[Path]:
    """Return all journals that anybody knows of, the latest last: those listed, wherever their folder has
    come to, and those in `folders`; with them those that were kept as damaged.
    """
    found: list[Path] = []
    lost: set[str] = set()
    near: dict[Path, None] = {}
    for one in register.known():
        path = Path(one.journal)
        near[path.parent] = None
        if not is_file(path):
            lost.add(path.name)
    places = dict.fromkeys([*near, *folders])
    for folder in places:
        found += find_journals_in(folder, rf"{ANY}({re.escape(DAMAGED)})?")
    if lost:
        for folder in _beside(places):
            found += [path for path in map(folder.joinpath, lost) if is_file(path) and is_left(path)]
    return order_journals(found)


def _beside(folders: Iterable[Path]) -> Iterator[Path]:
    """Yield the folders that stand beside and in the given ones: where a renamed one may be."""
    count = 0
    for top in dict.fromkeys(place for folder in folders for place in (folder.parent, folder)):
        with suppress(OSError):
            for path in top.iterdir():
                count += 1
                if count > FOLDERS:
                    return
                if path.is_dir():
                    yield path


def project_of(journal: Path) -> Path | None:
    """Return the project file that a journal belongs to, where it is or was; None for one never saved."""
    match = _BESIDE.fullmatch(journal.name)
    if match is not None:
        beside = journal.with_name(match["name"])
        if is_file(beside):
            return beside
    named = read_journal_head(journal).get("file")
    return Path(named) if isinstance(named, str) and named else None
