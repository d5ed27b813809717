"""Every call of the atomic writer and of the journal fails once, in every way: what is read back is the old
state or the new, never neither.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest

from metagraph.errors import FileError
from metagraph.formats.atomic import write_atomically
from metagraph.formats.project.data import to_data
from metagraph.formats.project.journal import Journal
from metagraph.formats.recovery import read_journal
from metagraph.formats.store import SUFFIX, compute_content_digest, encode_project, read_project, save_project
from metagraph.graph import edits
from metagraph.graph.model import Project
from tests.failing_system import Killed, System, failing
from tests.projects import clip

pytestmark = pytest.mark.usefixtures("numbered_ids")

WAYS = [(how, ever) for how in ("error", "short", "late") for ever in (False, True)] + [("kill", False)]


def every_failure(work: Callable[[int], System]) -> int:
    """Do something with its first call failing, its second, and so on until none is left to fail; return how
    many there were.
    """
    for n in range(500):
        if not work(n).failed:
            return n
    raise AssertionError("there is no end to the calls")


def first() -> Project:
    project = edits.add_clips(Project("show"), [(f"{n}.glb", 0, "ab" * 32, clip(f"{n}")) for n in range(3)])
    return edits.add_stance(project, "arms", "rest", ["c1"])


def states(count: int) -> list[Project]:
    out = [first()]
    for n in range(count):
        out.append(edits.rename_clip(out[-1], "c1", f"name {n}"))
    return out


def is_one_of(project: Project, some: list[Project]) -> bool:
    return any(to_data(project) == to_data(x) for x in some)


@pytest.mark.parametrize("exists", [True, False])
@pytest.mark.parametrize(("how", "ever"), WAYS)
def test_a_file_is_the_old_or_the_new_whichever_call_fails(
    tmp_path: Path, how: str, ever: bool, exists: bool
) -> None:
    def work(n: int) -> System:
        folder = tmp_path / str(n)
        folder.mkdir()
        path = folder / "file"
        if exists:
            path.write_bytes(b"old")
        told = False
        with failing(folder, n, how, ever) as system:
            try:
                write_atomically(path, b"new" * 1000)
            except (FileError, Killed):
                told = True
        found = path.read_bytes() if path.exists() else b""
        assert found in (b"old" if exists else b"", b"new" * 1000), system.calls
        assert told or found == b"new" * 1000, "no word of it, and it is not there"
        if how == "error" and not ever:
            assert {p.name for p in folder.iterdir()} <= {"file", *_left_by_unlink(system, folder)}
        return system

    assert every_failure(work) >= 6


def _left_by_unlink(system: System, folder: Path) -> set[str]:
    """The unfinished file stays where removing it is what failed."""
    return {p.name for p in folder.glob(".saving-*")} if system.calls[-1:] == ["unlink"] else set()


@pytest.mark.parametrize(("how", "ever"), WAYS)
def test_a_project_can_be_read_whichever_call_of_saving_it_fails(
    tmp_path: Path, how: str, ever: bool
) -> None:
    old, new = states(1)

    def work(n: int) -> System:
        path = tmp_path / str(n) / f"show{SUFFIX}"
        save_project(old, path)
        with failing(path.parent, n, how, ever) as system, suppress(FileError, Killed):
            save_project(new, path)
        assert is_one_of(read_project(path), [old, new])
        return system

    every_failure(work)


def sitting(path: Path, journal: Path, made: list[Project], done: list[int]) -> None:
    """Edit, save in between, and edit on, as a window does; `done` counts the edits that were accepted."""
    kept = Journal(journal, path)
    mark = None
    try:
        for n, (before, after) in enumerate(itertools.pairwise(made)):
            with suppress(FileError):
                kept.edit(before, after)
                done[0] = n + 1
            if n == 2:
                with suppress(FileError):
                    mark = kept.mark()
                    if mark is not None:
                        kept.settle(mark, compute_content_digest(encode_project(after, path)))
                    save_project(after, path)
                    done[1] = n + 1
    finally:
        kept.close()


@pytest.mark.nightly
@pytest.mark.parametrize(("how", "ever"), WAYS)
def test_a_sitting_is_read_back_as_far_as_it_was_written_whichever_call_fails(
    tmp_path: Path, how: str, ever: bool
) -> None:
    made = states(6)

    def work(n: int) -> System:
        path = tmp_path / str(n) / f"show{SUFFIX}"
        save_project(made[0], path)
        journal, done = path.with_name("journal"), [0, 0]
        with failing(path.parent, n, how, ever) as system, suppress(Killed):
            sitting(path, journal, made, done)
        left = read_journal(journal, path)
        found = left.project if left is not None else read_project(path)
        at = next(i for i, state in enumerate(made) if to_data(state) == to_data(found))
        assert at >= max(done), (n, system.calls)
        return system

    assert every_failure(work) >= 15


@pytest.mark.parametrize(("how", "ever"), WAYS)
def test_beginning_a_journal_anew_leaves_what_was_in_it_or_what_it_begins_with(
    tmp_path: Path, how: str, ever: bool
) -> None:
    made = states(3)

    def work(n: int) -> System:
        folder = tmp_path / str(n)
        folder.mkdir()
        journal = Journal(folder / "journal", None)
        journal.begin(made[0])
        for before, after in itertools.pairwise(made):
            journal.edit(before, after)
        with failing(folder, n, how, ever) as system, suppress(FileError, Killed):
            journal.begin(made[3], 3)
        journal.close()
        left = read_journal(folder / "journal", None)
        assert left is not None and is_one_of(left.project, [made[2], made[3]])
        return system

    every_failure(work)


def test_what_found_no_room_at_first_is_written_when_there_is_room_again(tmp_path: Path) -> None:
    made = states(4)
    journal = Journal(tmp_path / "journal", None)
    with failing(tmp_path, 0, "error", True), pytest.raises(FileError, match="No space left"):
        journal.begin(made[0])
    for before, after in itertools.pairwise(made):
        journal.edit(before, after)
    journal.close()
    left = read_journal(tmp_path / "journal", None)
    assert left is not None and left.edits == 4 and is_one_of(left.project, made[4:])


def test_an_edit_that_found_no_room_is_written_with_the_next(tmp_path: Path) -> None:
    made = states(4)
    journal = Journal(tmp_path / "journal", None)
    journal.edit(made[0], made[1])
    with failing(tmp_path, 0, "short") as system:
        system._handles.add(_handle(journal))
        with pytest.raises(FileError, match="No space left"):
            journal.edit(made[1], made[2])
    left = read_journal(tmp_path / "journal", None)
    assert left is not None and is_one_of(left.project, made[1:3]), "all but the last end of line was written"
    journal.edit(made[2], made[3])
    journal.edit(made[3], made[4])
    journal.close()
    left = read_journal(tmp_path / "journal", None)
    assert left is not None and is_one_of(left.project, [made[4]])


def _handle(journal: Any) -> int:
    return int(journal._file._handle)
