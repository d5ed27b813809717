"""Find the files of props that were moved, and tell which have changed since the props were added."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import msgspec

from metagraph.common.files import is_file
from metagraph.common.network_paths import is_closed
from metagraph.common.wording import phrase
from metagraph.errors import FileError
from metagraph.formats.clips import digest
from metagraph.formats.project.moved_files import find_moved_files
from metagraph.formats.project.paths import make_path_relative
from metagraph.graph.model import Project
from metagraph.graph.prop import Prop


def find_prop_files(project: Project, folder: Path) -> tuple[Project, list[str]]:
    """Return a project whose props have the paths of moved files and the digests of changed ones, and a note
    on each prop whose file was moved, has changed or is not there. A file that was moved is found by its
    content, below the project's folder.
    """
    lost: dict[str, list[Prop]] = {}
    for prop in project.props.values():
        if not is_closed(prop.path) and not is_file(folder / prop.path):
            lost.setdefault(prop.path, []).append(prop)
    moved = find_moved_files(lost, folder) if lost else {}
    props: dict[str, Prop] = {}
    notes: list[str] = []
    for ident, prop in project.props.items():
        props[ident], note = _find(prop, folder, moved)
        if note:
            notes.append(note)
    if all(props[ident] is prop for ident, prop in project.props.items()):
        return project, notes
    return replace(project, props=props), notes


def _find(prop: Prop, folder: Path, moved: Mapping[str, Path]) -> tuple[Prop, str]:
    if is_closed(prop.path):
        return prop, ""
    if prop.path in moved:
        path = make_path_relative(moved[prop.path], folder)
        words = phrase(
            "the file of the prop '{name}' was moved: it was found at '{path}'", name=prop.name, path=path
        )
        return msgspec.structs.replace(prop, path=path), words
    place = folder / prop.path
    if not is_file(place):
        return prop, phrase(
            "the prop '{name}' is not drawn: there is no file '{path}'. Put it back, or remove the prop",
            name=prop.name,
            path=prop.path,
        )
    try:
        now = digest(place) if prop.sha256 else ""
    except FileError:
        return prop, ""  # who reads it says why it cannot be read
    if now == prop.sha256:
        return prop, ""
    words = phrase(
        "the prop '{name}' may look different: its file '{path}' has changed", name=prop.name, path=prop.path
    )
    return msgspec.structs.replace(prop, sha256=now), words
