"""What is said of a journal that cannot be written, or is not where it was."""

from __future__ import annotations

from pathlib import Path

from metagraph.common.wording import phrase
from metagraph.errors import FileError
from metagraph.formats.project.fields import DataError


def make_unwritten_error(path: Path, error: OSError, where: str) -> FileError:
    """Return the error of a journal that the system does not let be written."""
    return FileError(
        path,
        phrase("cannot be written ({value})", value=error.strerror or error),
        where,
        phrase("Free some disk space and save the project, or save it in another place."),
    )


def make_unstorable_error(path: Path, error: DataError) -> FileError:
    """Return the error of an edit that no file can hold."""
    return FileError(
        path, phrase("cannot be written ({error})", error=error), error.where, phrase("Correct that value.")
    )


def describe_displacement(what: str, was: Path, now: Path) -> str:
    """Return what to say of a journal that was "removed" or has "moved"."""
    if what == "moved":
        return phrase(
            "The folder {folder} is now {place}. Your unsaved edits are kept there. "
            "Saving asks you where to save.",
            folder=was.parent.name,
            place=now.parent,
        )
    return phrase(
        "Another program removed or replaced the file in {folder} in which "
        "Metagraph keeps your unsaved edits. Metagraph has written it again, with "
        "all of them.",
        folder=was.parent.name,
    )
