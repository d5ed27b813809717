"""Commands that read a project say which edits beside it a crash kept from being saved."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from app.cli.parser import main
from metagraph.formats.locking import make_owner
from metagraph.formats.project.journal import Journal, make_journal_path
from metagraph.formats.store import SUFFIX, save_project
from metagraph.graph import edits
from metagraph.graph.model import Project
from tests.sittings import kill_sittings

Capture = pytest.CaptureFixture[str]


@pytest.fixture
def saved(tmp_path: Path) -> Path:
    path = tmp_path / f"show{SUFFIX}"
    save_project(Project("show"), path)
    return path


def leave(saved: Path, count: int, sitting: str = "ab12") -> Path:
    """Edit a project a number of times and let the program end; return the journal."""
    states = [edits.rename_project(Project("show"), f"name {n}") for n in range(count + 1)]
    journal = Journal(make_journal_path(saved, sitting), saved, make_owner())
    for n in range(count):
        journal.edit(states[n] if n else Project("show"), states[n + 1], "Rename")
    journal.close()
    kill_sittings(saved.parent)
    return journal.path


@pytest.mark.parametrize("command", ["info", "check"])
@pytest.mark.parametrize(("count", "words"), [(1, "1 edit "), (3, "3 edits ")])
def test_edits_that_a_crash_left_are_counted(
    saved: Path, capsys: Capture, command: str, count: int, words: str
) -> None:
    journal = leave(saved, count)
    main([command, str(saved)])
    said = capsys.readouterr().err
    assert said.startswith(f"note: {journal.name} has {words}from before a crash that ")
    assert saved.name in said.replace(journal.name, "")


@pytest.mark.parametrize("command", ["info", "check"])
def test_the_note_changes_neither_what_is_printed_nor_the_exit_code_nor_the_journal(
    saved: Path, capsys: Capture, command: str
) -> None:
    code = main([command, str(saved), "--json"])
    alone = capsys.readouterr()
    journal = leave(saved, 2)
    content = journal.read_bytes()
    assert main([command, str(saved), "--json"]) == code
    beside = capsys.readouterr()
    assert json.loads(beside.out) == json.loads(alone.out)
    assert not alone.err and beside.err and journal.read_bytes() == content


def test_each_journal_has_a_line(saved: Path, capsys: Capture) -> None:
    names = [leave(saved, 1, sitting).name for sitting in ("ab12", "cd34")]
    main(["info", str(saved)])
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) == 2 and all(any(name in line for line in lines) for name in names)


def test_a_link_to_a_project_leads_to_its_journals(saved: Path, tmp_path: Path, capsys: Capture) -> None:
    leave(saved, 1)
    link = tmp_path / "elsewhere" / f"link{SUFFIX}"
    link.parent.mkdir()
    try:
        link.symlink_to(saved)
    except OSError:
        pytest.skip("this system lets nobody make links")
    main(["info", str(link)])
    assert "1 edit" in capsys.readouterr().err


def test_a_journal_of_a_window_that_is_open_or_of_another_project_is_not_mentioned(
    saved: Path, capsys: Capture
) -> None:
    other = saved.with_name(f"other{SUFFIX}")
    save_project(Project("show"), other)
    leave(other, 1)
    journal = Journal(make_journal_path(saved, "ab12"), saved, make_owner())
    journal.edit(Project("show"), Project("open"), "Rename")
    main(["info", str(saved)])
    journal.close()
    assert not capsys.readouterr().err


def test_a_journal_that_nobody_can_read_is_mentioned_with_the_reason(saved: Path, capsys: Capture) -> None:
    journal = leave(saved, 1)
    journal.write_bytes(b"nonsense\n")
    assert main(["info", str(saved)]) == 0
    said = capsys.readouterr().err
    assert said.startswith("note: ") and journal.name in said and "damaged" in said


def test_a_damaged_journal_says_how_many_edits_are_lost(saved: Path, capsys: Capture) -> None:
    journal = leave(saved, 3)
    content = journal.read_bytes()
    journal.write_bytes(content.replace(b"name 2", b"name_2", 1))
    main(["info", str(saved)])
    assert "has 2 edits" in (said := capsys.readouterr().err) and "(1 of them is damaged)" in said
