"""Warn of unsaved edits in a journal beside a project, because commands read the project file only."""

from __future__ import annotations

import sys
from collections.abc import Sized
from pathlib import Path

from metagraph.errors import FileError
from metagraph.formats.recovery import find_left_journals, read_journal


def warn_of_journals(path: Path) -> None:
    """Print on standard error which journals a crash left beside a project file."""
    for journal in find_left_journals(path.resolve()):
        try:
            left = read_journal(journal, path)
        except FileError as error:
            print(f"note: {error}", file=sys.stderr)
            continue
        if left is not None:
            lost = f" ({len(left.lost):,} of them {_are(left.lost)} damaged)" if left.lost else ""
            print(
                f"note: {journal.name} has {_edits(left.edits)} from before a crash that "
                f"{_were(left.edits)} not saved{lost}. "
                f"Open {path.name} in the window to recover them",
                file=sys.stderr,
            )


def _edits(count: int) -> str:
    return "1 edit" if count == 1 else f"{count:,} edits"


def _were(count: int) -> str:
    return "was" if count == 1 else "were"


def _are(things: Sized) -> str:
    return "is" if len(things) == 1 else "are"
