"""What a start was given: a project, or clips for a new one."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from metagraph.errors import FileError


def sort_paths(paths: Sequence[Path]) -> tuple[Path | None, tuple[Path, ...]]:
    """Return the project among the files that a start was given, or None, and the clips. Raises FileError for
    what is not there, and for a project beside other files.
    """
    for path in paths:
        if not path.exists():
            raise FileError(
                path,
                "there is no such file",
                "while opening it",
                "Give a project that ends in .metagraph.yaml, or clips.",
            )
    projects = [path for path in paths if path.suffix.lower() in (".yaml", ".yml")]
    if projects and len(paths) > 1:
        raise FileError(
            projects[0], "a project opens alone", "while opening it", "Open the other files after it."
        )
    return (projects[0], ()) if projects else (None, tuple(paths))
