"""Verifying a project: its file, the files it names, its journals, its earlier versions, and what programs
that ended have left beside it. Nothing is changed.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from metagraph.common.budgets import TEXT_FILE
from metagraph.common.files import is_file, read_file
from metagraph.errors import FileError, clean_text
from metagraph.formats.atomic import find_forsaken_files
from metagraph.formats.locking import Owner, find_holder, is_gone, lock_path
from metagraph.formats.project.data import FORMAT, to_data
from metagraph.formats.project.journal_records import LostEdit
from metagraph.formats.project.journal_search import find_journals_beside
from metagraph.formats.project.text import TextError, read_text_data
from metagraph.formats.project.verified import (
    VerificationFault,
    Verified,
    VerifiedPart,
    count_in_words,
    describe_whole,
    make_fault,
)
from metagraph.formats.project.verifying_clips import verify_clips, verify_named_files
from metagraph.formats.project.versions import list_earlier_versions
from metagraph.formats.recovery import DAMAGED, Left, read_journal, read_journal_head, read_journal_owner
from metagraph.formats.store import encode_project, parse_project, read_project
from metagraph.graph.check import check_project
from metagraph.graph.model import Project

# What `check` says of a graph that does not hold together, as after a merge by hand.
BROKEN = ("swapped-clip", "lost-clip", "lost-stance", "lost-end", "no-start")
NAMED = 5  # lost edits that are named
RECOVER = "Open the project in the window to recover or discard them."


def verify_project(path: Path) -> Verified:
    """Look at all of a project. Raises FileError if there is no file that can be read."""
    content = read_file(path, TEXT_FILE)
    folder = path.resolve().parent  # a linked project names its files from where it lies
    project, file = _file(path, content)
    parts = [file]
    if project is not None:
        parts += [verify_clips(project, folder), _graph(project), *verify_named_files(project, folder)]
    parts += [_journals(path), _versions(path), _leftovers(path)]
    return Verified(str(path), "project", tuple(parts))


def _file(path: Path, content: bytes) -> tuple[Project | None, VerifiedPart]:
    restore = "Undo the last change made by hand, or go back to an earlier version."
    if not content.strip():
        return None, VerifiedPart("file", "not whole", (VerificationFault(path.name, "is empty.", restore),))
    notes: list[str] = []
    try:
        project = read_project(path, notes)
    except FileError as error:
        return None, VerifiedPart("file", "not whole", (make_fault(error),))
    faults = [VerificationFault(path.name, f"{note}.", restore) for note in notes]
    try:
        again = parse_project(encode_project(project, path).decode(), path)
        if to_data(again) != to_data(project):
            faults.append(VerificationFault(path.name, "would be saved otherwise than it was read.", restore))
    except FileError as error:
        faults.append(make_fault(error))
    words = f"format {_format(content)}, can be read and saved again without a change"
    return project, VerifiedPart("file", words if not faults else "not whole", tuple(faults))


def _format(content: bytes) -> str:
    try:
        version = read_text_data(content.decode("utf-8-sig"))[0]["metagraph"]
    except (TextError, UnicodeDecodeError, KeyError, TypeError):
        version = FORMAT
    return f"{version}" if version == FORMAT else f"{version} (the next save writes format {FORMAT})"


def _graph(project: Project) -> VerifiedPart:
    faults = [
        VerificationFault(
            f"{problem.layer} layer" if problem.layer else "project", f"{problem.message}.", problem.remedy
        )
        for problem in check_project(project)
        if problem.code in BROKEN
    ]
    if project.base.clip is not None and project.base.clip not in project.clips:
        faults.append(
            VerificationFault(
                "project", "the clip of the base pose is not in it.", "Choose the base pose again."
            )
        )
    actions = sum(1 for _ in project.actions())
    words = (
        f"{count_in_words(actions, 'action')}, each of a clip and a stance that are there"
        if actions
        else "empty"
    )
    return VerifiedPart("graph", "not whole" if faults else words, tuple(faults))


def _journals(path: Path) -> VerifiedPart:
    words: list[str] = []
    faults: list[VerificationFault] = []
    for journal in find_journals_beside(path):
        owner = read_journal_owner(read_journal_head(journal))
        if journal.name.endswith(DAMAGED):
            remedy = "See 'File > Recover…' for what it holds; discard it there when you no longer need it."
            faults.append(VerificationFault(journal.name, "is a damaged journal that was kept.", remedy))
        elif owner is not None and not is_gone(owner, journal, look_only=True):
            words.append(f"{_who(owner)} has the project open, and a journal of it that is being written")
        else:
            faults += _left(journal, path)
    if faults:
        words.append("not whole")
    return VerifiedPart("journals", "; ".join(words) or "no edits wait in them", tuple(faults))


def _left(journal: Path, path: Path) -> Iterator[VerificationFault]:
    try:
        left = read_journal(journal, path)
    except FileError as error:
        yield make_fault(error, remedy="It is kept. Open the project in the window to see what can be done.")
        return
    if left is None:
        return
    if left.edits:
        yield VerificationFault(
            journal.name, f"holds {count_in_words(left.edits, 'edit')} that {_in_no_file(left)}.", RECOVER
        )
    lost = [_lost_words(one) for one in left.lost]
    if lost:
        more = f" and {len(lost) - NAMED} more" if len(lost) > NAMED else ""
        yield VerificationFault(
            journal.name,
            f"is damaged; {count_in_words(len(lost), 'edit')} cannot be read: "
            f"{', '.join(lost[:NAMED])}{more}.",
            "The others can be recovered in the window. Make those again.",
        )
    if left.doubtful:
        yield VerificationFault(
            journal.name,
            "is damaged in what its edits begin with; a value in it may be wrong.",
            "Recover it in the window, and look through the project before you save it.",
        )


def _in_no_file(left: Left) -> str:
    verb = "is" if left.edits == 1 else "are"
    changed = ", and the file has changed since" if left.behind or left.worked_in else ""
    return f"{verb} in no file{changed}"


def _lost_words(edit: LostEdit) -> str:
    return f"'{clean_text(edit.step)}'" if edit.step else "one without a name"


def _who(owner: Owner) -> str:
    return f"{clean_text(owner.user)} on {clean_text(owner.host)}"


def _versions(path: Path) -> VerifiedPart:
    versions = list_earlier_versions(path)
    faults = []
    for version in versions:
        try:
            read_project(version.path, [])
        except FileError as error:
            faults.append(make_fault(error, remedy="Remove it; it cannot be gone back to."))
    return VerifiedPart("versions", describe_whole(len(versions), faults, "can be opened"), tuple(faults))


def _leftovers(path: Path) -> VerifiedPart:
    """Look at locks and half-written files; those of programs that still run are none."""
    real = path.resolve()
    words = "none"
    faults = find_unfinished_files(real.parent)
    lock = lock_path(real)
    found = find_holder(lock, look_only=True) if is_file(lock) else None
    if found is not None and found.gone:
        whose = _who(found.owner) if found.owner is not None else "somebody"
        faults.append(
            VerificationFault(
                lock.name,
                f"is a lock that {whose} left behind; the program is not there any more.",
                "Open the project in the window: it takes the lock over.",
            )
        )
    elif found is not None:
        words = f"none; {_who(found.owner) if found.owner is not None else 'somebody'} has the project open"
    return VerifiedPart("leftovers", "found" if faults else words, tuple(faults))


def find_unfinished_files(folder: Path) -> list[VerificationFault]:
    """Return the files that programs which were killed have left half-written in a folder."""
    remedy = "The next save into this folder removes it; it can be removed by hand as well."
    words = "was left half-written by a program that is not there any more."
    return [VerificationFault(path.name, words, remedy) for path in sorted(find_forsaken_files(folder))]
