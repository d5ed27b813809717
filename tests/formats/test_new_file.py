"""New files: as private as the project they lie beside, from their first moment on."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from metagraph.formats.atomic import write_atomically
from metagraph.formats.locking import Lock, make_owner
from metagraph.formats.new_file import Access, access_of, open_new
from metagraph.formats.project.journal import Journal
from metagraph.formats.store import SUFFIX, save_project
from metagraph.graph import edits
from metagraph.graph.model import Project

pytestmark = pytest.mark.skipif(os.name == "nt", reason="Windows has no modes")


def mode(path: Path) -> int:
    return path.stat().st_mode & 0o777


@pytest.fixture
def wide_umask():
    before = os.umask(0)
    yield
    os.umask(before)


@pytest.mark.parametrize("wanted", [0o600, 0o640, 0o644, 0o660, 0o400])
def test_a_file_has_the_mode_of_the_other_and_was_never_wider(
    tmp_path: Path, wide_umask: None, monkeypatch: pytest.MonkeyPatch, wanted: int
) -> None:
    like = tmp_path / "like"
    like.write_text("")
    like.chmod(wanted)
    seen, real = [], os.open

    def spy(path, flags, mode=0o777, **more):
        handle = real(path, flags, mode, **more)
        seen.append(os.fstat(handle).st_mode & 0o777)
        return handle

    monkeypatch.setattr(os, "open", spy)
    os.close(open_new(tmp_path / "new", access_of(like)))
    assert mode(tmp_path / "new") == wanted
    assert all(not (first & ~wanted) for first in seen)


def test_a_file_whose_group_cannot_be_had_is_not_opened_to_another(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(*args):
        raise PermissionError

    monkeypatch.setattr(os, "fchown", refuse)
    os.close(open_new(tmp_path / "new", Access(0o640, os.getgid() + 1)))
    assert mode(tmp_path / "new") == 0o600


def test_what_is_replaced_keeps_its_mode_and_its_unfinished_file_has_it(
    tmp_path: Path, wide_umask: None, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "file"
    path.write_text("old")
    path.chmod(0o600)
    modes, real = [], os.fsync

    def look(handle):
        modes.append(os.fstat(handle).st_mode & 0o777)
        real(handle)

    monkeypatch.setattr(os, "fsync", look)
    write_atomically(path, b"new")
    assert mode(path) == 0o600 and modes[0] == 0o600


def test_everything_beside_a_private_project_is_private(tmp_path: Path, wide_umask: None) -> None:
    saved = tmp_path / f"show{SUFFIX}"
    save_project(Project("show"), saved)
    saved.chmod(0o600)
    lock = Lock(saved, make_owner())
    lock.acquire()
    journal = Journal(tmp_path / ".journal", saved, make_owner())
    journal.edit(Project("show"), edits.rename_project(Project("show"), "x"))
    copy = tmp_path / f"copy{SUFFIX}"
    save_project(Project("copy"), copy, like=access_of(saved))
    journal.close()
    assert {mode(path) for path in tmp_path.iterdir()} == {0o600}
    journal.path.unlink()
    saved.unlink()
    again = Journal(tmp_path / ".journal", saved, make_owner(), like=Access(0o600, os.getgid()))
    again.begin(Project("show"), 1)
    again.close()
    assert mode(again.path) == 0o600, "though the project is gone"
    lock.release()
