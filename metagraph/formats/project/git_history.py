"""Read the versions of a project file that Git has kept. Git is the system's own, and is asked so that
nothing that a stranger's repository names is run: no hook, no filter, no signature, no network.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from metagraph.common.budgets import TEXT_FILE
from metagraph.common.programs import find_system_program, run_program
from metagraph.common.wording import phrase
from metagraph.errors import FileError
from metagraph.formats.store import parse_project
from metagraph.graph.model import Project

MOST_COMMITS = 100
PATIENCE = 20.0  # seconds that Git may take
_FIELD, _RECORD = "\x1f", "\x1e"
_SAFE = (
    *("-c", "log.showSignature=false", "-c", "protocol.allow=never", "-c", "core.fsmonitor=false"),
    *("-c", "core.hooksPath=", "--no-pager", "--literal-pathspecs", "--no-optional-locks"),
)


@dataclass(frozen=True)
class Commit:
    """A commit that changed the file. saved: seconds since 1970. subject: its first line."""

    ident: str
    saved: float
    author: str
    subject: str


def list_commits(path: Path) -> tuple[Commit, ...]:
    """Return the commits that changed a project file, the latest first, at most MOST_COMMITS; none if there
    is no Git, or if the file is in no repository.
    """
    form = _FIELD.join(("%H", "%ct", "%an", "%s")) + _RECORD
    code, said = _ask(path, "log", f"-n{MOST_COMMITS}", f"--format={form}", "--", path.resolve().name)
    out = []
    for record in said.split(_RECORD) if code == 0 else ():
        words = record.strip("\n").split(_FIELD)
        if len(words) == 4 and words[1].isdigit():
            out.append(Commit(words[0], float(words[1]), words[2], words[3]))
    return tuple(out)


def read_commit(path: Path, commit: Commit) -> Project:
    """Return the project as a commit has it, its clips without motion. Raises FileError."""
    name = f"{commit.ident}:./{path.resolve().name}"
    code, size = _ask(path, "cat-file", "-s", name)
    if code == 0 and size.strip().isdigit() and int(size) <= TEXT_FILE:
        code, text = _ask(path, "cat-file", "blob", name)
        if code == 0:
            return parse_project(text.removeprefix("\ufeff"), path, to_look_at=True)
    raise FileError(
        path,
        phrase("is not in the commit {commit}, or too large there", commit=commit.ident[:10]),
        phrase("the project"),
        phrase("Choose another version."),
    )


def _ask(path: Path, *words: str) -> tuple[int, str]:
    """Return Git's exit status and what it said about the file's folder; not 0 where there is no Git."""
    git = find_system_program("git")
    if git is None:
        return -1, ""
    command: Sequence[str] = (str(git), "-C", str(path.resolve().parent), *_SAFE, *words)
    try:
        return run_program(command, PATIENCE, env={"GIT_NO_LAZY_FETCH": "1", "GIT_TERMINAL_PROMPT": "0"})
    except (OSError, TimeoutError):
        return -1, ""
