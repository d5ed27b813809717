"""Versions that Git has kept."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

import pytest

from metagraph.common.programs import find_system_program
from metagraph.errors import FileError
from metagraph.formats.project.git_history import Commit, list_commits, read_commit
from metagraph.formats.store import SUFFIX, save_project
from metagraph.graph.model import Project

pytestmark = pytest.mark.skipif(find_system_program("git") is None, reason="there is no Git")


def git(folder: Path, *words: str) -> None:
    who = {"GIT_AUTHOR_NAME": "Ada", "GIT_AUTHOR_EMAIL": "a@b", "GIT_COMMITTER_NAME": "Ada"}
    env = {**os.environ, **who, "GIT_COMMITTER_EMAIL": "a@b"}
    subprocess.run(["git", "-C", str(folder), *words], check=True, env=env, capture_output=True)


@pytest.fixture
def path(tmp_path: Path) -> Path:
    """A project with two commits, in a folder of a repository."""
    folder = tmp_path / "repository" / "characters"
    folder.mkdir(parents=True)
    git(folder.parent, "init", "-q")
    path = folder / f"ada{SUFFIX}"
    for name in ("first", "second"):
        save_project(Project(name), path)
        git(folder, "add", path.name)
        git(folder, "commit", "-q", "-m", f"Call it {name}")
    return path


def test_commits_of_the_file_are_listed_and_read_the_latest_first(path: Path) -> None:
    save_project(Project("not committed"), path)
    commits = list_commits(path)
    assert [(c.subject, c.author) for c in commits] == [("Call it second", "Ada"), ("Call it first", "Ada")]
    assert [read_commit(path, c).name for c in commits] == ["second", "first"]


def test_a_file_in_no_repository_has_no_commits(tmp_path: Path) -> None:
    path = tmp_path / f"ada{SUFFIX}"
    save_project(Project("alone"), path)
    assert list_commits(path) == ()
    with pytest.raises(FileError, match="commit"):
        read_commit(path, Commit("0" * 40, 0.0, "", ""))


def test_nothing_that_the_repository_names_is_run(path: Path, tmp_path: Path) -> None:
    """A repository may come from a stranger: its filters, hooks, pagers and signatures are programs."""
    trap = tmp_path / "sprung"
    for key in (
        "core.fsmonitor",
        "core.pager",
        "gpg.program",
        "diff.x.textconv",
        "diff.external",
        "filter.x.smudge",
    ):
        git(path.parent, "config", key, f"touch {trap}; cat")
    git(path.parent, "config", "log.showSignature", "true")
    (path.parent / ".gitattributes").write_text("* diff=x filter=x\n", encoding="utf-8")
    assert [read_commit(path, c).name for c in list_commits(path)] == ["second", "first"]
    assert not trap.exists()
