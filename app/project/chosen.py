"""Remember sounds outside their project's folder that this user chose by hand, in a JSON file beside the
recent projects. A project from somebody else may name any file, and none of those goes into an export.
"""

from __future__ import annotations

import json
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path

from app.project.autosave import state_folder
from metagraph.common.budgets import LIST_FILE
from metagraph.common.files import read_file
from metagraph.errors import FileError
from metagraph.formats.atomic import write_atomically

MOST = 20_000  # entries; the oldest are removed first


def _place() -> Path:
    return state_folder() / "chosen_sounds.json"


def _kept() -> list[str]:
    try:
        rows = json.loads(read_file(_place(), LIST_FILE))
    except (FileError, ValueError, RecursionError):
        return []
    return [row for row in rows if isinstance(row, str)] if isinstance(rows, list) else []


def keep_chosen(paths: Iterable[Path]) -> None:
    """Remember files that the user has chosen in a dialog or dropped. If they cannot be kept, they must be
    chosen again.
    """
    names = {str(path.resolve()): None for path in paths}
    if names:
        rows = [*(row for row in _kept() if row not in names), *names][-MOST:]
        with suppress(FileError, OSError):
            write_atomically(_place(), json.dumps(rows).encode())


def is_chosen(path: Path) -> bool:
    """Return whether the user has chosen this file by hand."""
    return str(path.resolve()) in _kept()
