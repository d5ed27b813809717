"""Keep the undo steps of saved projects in the user's own folder, to offer them when one is opened again.

A project is recognised by the SHA-256 of its file, so it may be moved or renamed; a file that another program
has changed has no steps.
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path

from app.project.autosave import state_folder
from metagraph.common.files import read_file
from metagraph.errors import FileError
from metagraph.formats.atomic import write_atomically
from metagraph.formats.new_file import PRIVATE
from metagraph.formats.project.clip_loading import load_motions
from metagraph.formats.project.history import UndoStep, with_motion
from metagraph.formats.project.kept_steps import MAX_BYTES, decode_steps, encode_steps
from metagraph.graph.model import Project

MAX_PROJECTS = 50  # the steps of those saved last are kept


def keep_steps(digest: str, steps: Sequence[UndoStep], previous: str | None) -> None:
    """Keep the steps that lead to the file with a digest, in place of those of the `previous` file. What
    cannot be written is not kept: the project itself is saved.
    """
    folder = _folder()
    with suppress(OSError, FileError):
        if previous is not None and previous != digest:
            (folder / previous).unlink(missing_ok=True)
        content = encode_steps(steps)
        if not content:
            return
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        write_atomically(folder / digest, content, PRIVATE)
        newest_first = sorted(folder.iterdir(), key=lambda path: path.stat().st_mtime, reverse=True)
        for path in newest_first[MAX_PROJECTS:]:
            path.unlink(missing_ok=True)


def find_steps(digest: str | None, project: Project, folder: Path) -> tuple[UndoStep, ...]:
    """Return the steps that led to a project whose file has a digest, with the motion of their clips. Its
    paths are relative to `folder`.
    """
    if digest is None:
        return ()
    try:
        content = read_file(_folder() / digest, MAX_BYTES)
    except (OSError, FileError):
        return ()
    steps = decode_steps(content, project)
    return with_motion(steps, project, project, lambda p: load_motions(p, folder).project) if steps else ()


def _folder() -> Path:
    return state_folder() / "steps"
