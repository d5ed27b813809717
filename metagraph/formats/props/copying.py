"""Copy the files of props that lie outside the project's folder into it, so that they go where it goes."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from dataclasses import replace
from pathlib import Path

import msgspec

from metagraph.common.files import read_file
from metagraph.common.network_paths import is_closed
from metagraph.errors import FileError
from metagraph.formats.atomic import write_atomically
from metagraph.formats.props.reader import PROP_FILE, list_files_beside
from metagraph.graph.model import Project

FOLDER = "props"  # below the project's folder


def find_outside_props(project: Project, folder: Path) -> dict[str, Path]:
    """Return the files of props that are not in a project's folder, by the props' ids."""
    inside, out = folder.resolve(), {}
    for ident, prop in project.props.items():
        place = Path(os.path.normpath(inside / prop.path))
        if not is_closed(prop.path) and not place.is_relative_to(inside):
            out[ident] = place
    return out


def copy_props(files: Mapping[str, Path], folder: Path) -> tuple[dict[str, str], list[FileError]]:
    """Copy files of props, with the pictures and materials beside them, into `props` below a folder. Return
    the paths of the copies, relative to it, by the props' ids, and why others were not copied. A file that is
    there already with another content keeps its name; the copy gets another.
    """
    made: dict[Path, str] = {}
    problems: dict[Path, FileError] = {}
    for place in dict.fromkeys(files.values()):
        try:
            made[place] = _copy(place, folder)
        except FileError as error:
            problems[place] = error
    return {i: made[place] for i, place in files.items() if place in made}, list(problems.values())


def set_prop_paths(project: Project, paths: Mapping[str, str]) -> Project:
    """Return the project with other paths of some of its props."""
    there = {i: path for i, path in paths.items() if i in project.props}
    changed = {i: msgspec.structs.replace(project.props[i], path=path) for i, path in there.items()}
    return replace(project, props={**project.props, **changed})


def _copy(place: Path, folder: Path) -> str:
    contents = {place.name: read_file(place, PROP_FILE)}
    for beside in list_files_beside(place):
        contents[beside.name] = read_file(beside, PROP_FILE)
    into = folder / FOLDER
    number = 1
    while _differs(into, contents):
        number += 1
        into = folder / FOLDER / f"{place.stem}-{number}"
    for name, content in contents.items():
        write_atomically(into / name, content)
    return (into / place.name).relative_to(folder).as_posix()


def _differs(into: Path, contents: Mapping[str, bytes]) -> bool:
    """Return whether a folder has another file of one of the names."""
    there: Iterable[str] = (name for name in contents if (into / name).exists())
    return any(read_file(into / name, PROP_FILE) != contents[name] for name in there)
