"""Project files of a newer format: what is known of them can be looked at, and nothing replaces them."""

from __future__ import annotations

import re
from collections.abc import Mapping
from copy import deepcopy
from pathlib import Path
from typing import Any

from metagraph.common.wording import phrase
from metagraph.errors import FileError
from metagraph.formats.project.data import FORMAT, from_data
from metagraph.formats.project.fields import Data, UnknownFieldError
from metagraph.graph.model import Project

HEAD = 4096  # bytes of a file in which its version is
MOST = 100  # kinds of fields that are left out
_VERSION = re.compile(rb"^\s*\{?\s*\"?metagraph\"?\s*:\s*(\d{1,9})\b", re.MULTILINE)
_PART = re.compile(r"([^.\[\]]+)(?=[.\[]|$)|\[\d+\]")
ONLY_LOOKED_AT = phrase(
    "A newer Metagraph wrote this project. You can only view it, without the parts that this "
    "version does not know. Update Metagraph to change it."
)


def find_newer_version(content: bytes) -> int | None:
    """Return the version that the beginning of a project file names if it is newer than ours, else None."""
    found = _VERSION.search(content[:HEAD])
    version = int(found[1]) if found is not None else 0
    return version if version > FORMAT else None


def make_newer_error(path: Path, version: int, remedy: str = phrase("Update Metagraph.")) -> FileError:
    """Return the error about a file of a newer version."""
    cause = phrase(
        "was written by a newer Metagraph (format {version}; this one reads up to {FORMAT})",
        version=version,
        FORMAT=FORMAT,
    )
    return FileError(path, cause, "metagraph", remedy)


def refuse_newer_file(path: Path) -> None:
    """Raise FileError if the file at a path was written by a newer Metagraph: saving would lose what this one
    does not know.
    """
    try:
        with path.open("rb") as file:
            version = find_newer_version(file.read(HEAD))
    except OSError:
        return  # whoever writes says what is wrong there
    if version is not None:
        raise make_newer_error(path, version, phrase("Update Metagraph, or save under another name."))


def read_known_part(data: Data, notes: list[str] | None) -> Project:
    """Return the project in the data of a newer format, without the fields that are not known here; a note
    names them. Raises DataError for what cannot be read for another reason.
    """
    data = {**deepcopy(data), "metagraph": FORMAT}
    left_out: list[str] = []
    while True:
        repairs: list[str] | None = None if notes is None else []
        try:
            project = from_data(data, repairs)
        except UnknownFieldError as error:
            if len(left_out) >= MOST or not _drop_field(data, _PART.findall(error.where)):
                raise
            left_out.append(error.where)
            continue
        if notes is not None:
            names = ", ".join(left_out[:5]) + (" …" if len(left_out) > 5 else "")
            notes += [phrase("not known here: {names}", names=names)] if names else []
            notes += repairs or []
        return project


def _drop_field(data: Any, way: list[str]) -> int:
    """Remove a field of plain data from all entries of the lists on the way to it, each "" there; return how
    often it was found: what one action has that is not known here, others have, too.
    """
    first, *rest = way
    if first == "":
        return sum(_drop_field(entry, rest) for entry in data) if isinstance(data, list) else 0
    if not isinstance(data, Mapping) or first not in data:
        return 0
    if rest:
        return _drop_field(data[first], rest)
    del data[first]  # type: ignore[attr-defined]
    return 1
