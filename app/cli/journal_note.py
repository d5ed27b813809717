"""A word on edits beside a project that are in no file: commands read the file alone."""

from __future__ import annotations

import sys
from contextlib import suppress
from pathlib import Path

from metagraph.errors import FileError
from metagraph.formats.recovery import left_journals, read_journal


def warn_of_journals(path: Path) -> None:
    """Say on standard error which journals a crash has left beside a project file."""
    for journal in left_journals(path.resolve()):
        with suppress(FileError):
            left = read_journal(journal, path)
            if left is not None:
                edits = "1 edit" if left.edits == 1 else f"{left.edits:,} edits"
                print(
                    f"note: {journal.name} holds {edits} that a crash kept from being saved: open "
                    f"{path.name} in the window to recover them",
                    file=sys.stderr,
                )
