"""The paths of the files that a project names: relative to its own file, absolute, or closed because they
lead to other computers.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import msgspec

from metagraph.common.files import is_text
from metagraph.common.network_paths import (
    ANOTHER,
    explain_refusal,
    is_allowed,
    is_closed,
    make_escape_check,
    make_path_to_nowhere,
    recover_original_path,
)
from metagraph.common.wording import phrase
from metagraph.errors import FileError, clean_text
from metagraph.graph.backdrop import Backdrop
from metagraph.graph.conversation.model import Conversation, Side
from metagraph.graph.model import ClipEntry, Project
from metagraph.graph.prop import Prop
from metagraph.graph.requests import Line


def move_project(project: Project, old: Path | None, new: Path) -> Project:
    """Return the project with paths relative to `old` made relative to `new`. Both are project files; None
    means absolute paths.
    """
    return move_projects([project], old, new)[0]


def move_projects(projects: Sequence[Project], old: Path | None, new: Path) -> list[Project]:
    """Move several states of one project as `move_project` does; what they share stays shared."""
    source = old.parent if old is not None else None
    moved: dict[int, Any] = {}  # by the identity of parts, which `projects` keep alive

    @cache
    def renew(text: str) -> str:
        whole = Path(text) if source is None else source / text
        return text if is_closed(text) else make_path_relative(whole, new.parent)

    def once(part: Any, move: Callable[[Any], Any]) -> Any:
        if id(part) not in moved:
            moved[id(part)] = move(part)
        return moved[id(part)]

    def move_entry(entry: ClipEntry) -> ClipEntry:
        return replace(entry, path=renew(entry.path))

    def move(project: Project) -> Project:
        return replace(
            project,
            clips=once(project.clips, lambda c: {i: once(entry, move_entry) for i, entry in c.items()}),
            character=renew(project.character) if project.character else None,
            lines=once(project.lines, lambda _: _lines(project, renew)),
            props=once(project.props, lambda _: _props(project, renew)),
            backdrop=_backdrop(project, renew),
            conversations=once(project.conversations, lambda _: _conversations(project, renew)),
        )

    return [once(project, move) for project in projects]


def _with_paths(project: Project, make: Callable[[str], str]) -> Project:
    """Return the project with every path to another file remade by `make`. Closed paths stay closed."""
    return _each_path(project, lambda name: name if is_closed(name) else make(name))


def close_paths_below(project: Project, folder: Path) -> Project:
    """Return the project with every path closed that leads from its folder to other computers."""
    if is_allowed():
        return project
    away, found = make_escape_check(folder), False

    def close(name: str) -> str:
        nonlocal found
        if is_closed(name) or not away(name):
            return name
        found = True
        return make_path_to_nowhere(name)

    made = _each_path(project, close)
    return made if found else project


def _each_path(project: Project, renew: Callable[[str], str]) -> Project:
    clips = {i: replace(e, path=renew(e.path)) for i, e in project.clips.items()}
    character = renew(project.character) if project.character else None
    return replace(
        project,
        clips=clips,
        character=character,
        lines=_lines(project, renew),
        props=_props(project, renew),
        backdrop=_backdrop(project, renew),
        conversations=_conversations(project, renew),
    )


def list_project_files(project: Project, folder: Path) -> tuple[Path, ...]:
    """Return every file that a project in a folder names: clips, the character, props, a picture,
    sounds, other projects.
    """
    found: dict[Path, None] = {}

    def note(text: str) -> str:
        found[folder / text] = None
        return text

    _with_paths(project, note)
    return tuple(found)


def _conversations(project: Project, renew: Callable[[str], str]) -> Mapping[str, Conversation]:
    """Return the project's conversations with renewed paths to their sounds, their characters and the
    projects that move them.
    """

    def moved(side: Side) -> Side:
        files = {name: getattr(side, name) for name in ("audio", "project", "character")}
        return msgspec.structs.replace(side, **{name: path and renew(path) for name, path in files.items()})

    return {
        i: msgspec.structs.replace(c, sides=tuple(map(moved, c.sides)))
        for i, c in project.conversations.items()
    }


def _lines(project: Project, renew: Callable[[str], str]) -> Mapping[str, Line]:
    """Return the project's lines with renewed paths to their sounds and phones."""
    found = project.lines.items()
    return {
        i: msgspec.structs.replace(x, audio=x.audio and renew(x.audio), phones=x.phones and renew(x.phones))
        for i, x in found
    }


def _props(project: Project, renew: Callable[[str], str]) -> Mapping[str, Prop]:
    """Return the project's props with renewed paths."""
    return {i: msgspec.structs.replace(x, path=renew(x.path)) for i, x in project.props.items()}


def _backdrop(project: Project, renew: Callable[[str], str]) -> Backdrop:
    """Return the project's backdrop with a renewed path."""
    found = project.backdrop
    return msgspec.structs.replace(found, path=renew(found.path)) if found.path else found


def make_paths_absolute(project: Project, folder: Path) -> Project:
    """Return the project with its paths, relative to `folder`, made absolute, for a project without
    a file.
    """

    folders: dict[Path, Path] = {}  # many clips are in one folder, which is resolved once

    def renew(text: str) -> str:
        place = folder / text
        if place.name in ("", "..") or place.is_symlink():
            return place.resolve().as_posix()
        if place.parent not in folders:
            folders[place.parent] = place.parent.resolve()
        return (folders[place.parent] / place.name).as_posix()

    return _with_paths(project, renew)


def make_path_for_project(path: Path, folder: Path | None) -> str:
    """Return a file's path as a project in `folder` keeps it; absolute if `folder` is None. Raises FileError
    for a name that is not text, because it could not be written.
    """
    whole = path.parent.resolve() / path.name  # a linked file keeps its name
    name = make_path_relative(path, folder) if folder is not None else whole.as_posix()
    if not is_text(name):
        raise FileError(path, phrase("has a name that is not text"), phrase("its name"), phrase("Rename it."))
    return name


def make_path_relative(path: Path, folder: Path) -> str:
    """Return `path` relative to `folder` with `/` between parts; absolute if that is impossible (another
    drive).

    Links among the folders are followed first, because `..` out of a linked folder leads elsewhere. A linked
    file keeps its name.
    """
    path = path.parent.resolve() / path.name
    try:
        return Path(os.path.relpath(path, folder.resolve())).as_posix()
    except ValueError:
        return path.as_posix()


def list_closed_paths(project: Project) -> tuple[str, ...]:
    """Return the paths in a project's file that were not opened: those on other computers, and devices."""
    found: dict[str, None] = {}

    def see(name: str) -> str:
        if is_closed(name):
            found[recover_original_path(name)] = None
        return name

    _each_path(project, see)
    return tuple(found)


def reopen_paths(project: Project) -> Project:
    """Return a project whose closed paths are as in its file, to be opened."""
    return _each_path(project, recover_original_path)


def describe_closed_paths(names: Sequence[str]) -> str:
    """Say which files were not opened, and how to open them."""
    return phrase(
        "{count} of the files that it names were not opened, such as '{name}': "
        "{why}. If you trust the source of the project, add --network to the "
        "command, or choose File, Files on other computers in the window",
        count=len(names),
        name=clean_text(names[0])[:200],
        why=explain_refusal(names[0]) or ANOTHER,
    )
