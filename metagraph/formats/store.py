"""Read and write project files: YAML, one line for each clip, stance or action, in a stable order; written
whole or not at all.

Clip paths are relative to the project file and have the file's SHA-256, so a moved or renamed file is found
again.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from metagraph.common.budgets import TEXT_FILE
from metagraph.common.files import is_file, read_file
from metagraph.common.network_paths import (
    is_closed,
)
from metagraph.common.wording import phrase
from metagraph.errors import FileError
from metagraph.formats.atomic import write_atomically
from metagraph.formats.clip_identity import with_clip_identity
from metagraph.formats.new_file import Access
from metagraph.formats.project.clip_loading import Opened, load_motions
from metagraph.formats.project.data import FORMAT, from_data, to_data
from metagraph.formats.project.fields import Data, DataError
from metagraph.formats.project.newer import (
    HEAD,
    ONLY_LOOKED_AT,
    find_newer_version,
    make_newer_error,
    read_known_part,
    refuse_newer_file,
)
from metagraph.formats.project.paths import (
    close_paths_below,
    describe_closed_paths,
    list_closed_paths,
    move_project,
)
from metagraph.formats.project.prop_files import find_prop_files
from metagraph.formats.project.text import TextError, as_text, read_text_data, to_text
from metagraph.graph.model import Project

SUFFIX = ".metagraph.yaml"
_CONFLICT = re.compile(r"^<{7} ", re.MULTILINE)

# Upgrades of the plain data, from the version under which they are listed to the next.
UPGRADES: dict[int, Callable[[Data], Data]] = {
    1: lambda data: {key: value for key, value in data.items() if key != "next_id"},
}


# --- text


def parse_project(text: str, path: Path, notes: list[str] | None = None, to_look_at: bool = False) -> Project:
    """Return the project written in a file's text, its clips without motion. Raises FileError with the line
    and the field.

    `notes` is as in `data.from_data`. A file of a newer format is refused, unless the project is only
    `to_look_at`: then what this Metagraph does not know is left out.
    """
    try:
        data, lines = read_text_data(text)
    except TextError as error:
        if conflict := _CONFLICT.search(text):
            raise FileError(
                path,
                phrase("holds two versions that Git could not merge"),
                phrase("line {line}", line=text.count("\n", 0, conflict.start()) + 1),
                phrase(
                    "Merge the three versions that Git keeps, as docs/animators/work-together.md describes."
                ),
            ) from None
        line = f"line {error.line}" if error.line else "its text"
        raise FileError(
            path,
            phrase("not valid YAML ({error})", error=error),
            line,
            phrase("Undo the last change made by hand, or restore a backup."),
        ) from None
    try:
        if to_look_at and (version := find_newer_version(text[:HEAD].encode())) is not None:
            try:
                return close_paths_below(read_known_part(data, notes), path.parent)
            except DataError:
                raise make_newer_error(path, version) from None
        return close_paths_below(from_data(_upgraded(data, path), notes), path.parent)
    except DataError as error:
        cause = f"{error.where} {error}".strip()
        raise FileError(
            path, cause, _line_of(lines, error.where), phrase("Correct it, or restore a backup.")
        ) from None


def _upgraded(data: Any, path: Path) -> Any:
    version = data.get("metagraph") if isinstance(data, Mapping) else None
    if version is None:
        return data
    if not isinstance(version, int) or isinstance(version, bool) or version < 1:
        raise DataError("metagraph", "should be the version of the format, a whole number from 1")
    if version > FORMAT:
        raise make_newer_error(path, version)
    while version < FORMAT:
        data = {**UPGRADES[version](dict(data)), "metagraph": version + 1}
        version += 1
    return data


def _line_of(lines: Callable[[], Mapping[str, int]], where: str) -> str:
    """Return "line n" of a field, or of what contains it."""
    try:
        found = lines()
    except TextError as error:  # a key that is longer than YAML allows
        return f"line {error.line}" if error.line else where
    while where not in found and where:
        where = where[: max(where.rfind("."), where.rfind("["), 0)]
    return f"line {found.get(where, 1)}"


# --- files


def save_project(
    project: Project, path: str | Path, was_at: Path | None = None, like: Access | None = None
) -> Project:
    """Save a project; return it as it was saved. Raises FileError.

    `was_at` is the project file that its paths are relative to, if that is another one; they are then made
    relative to `path`. `like` says who may read the file if it does not exist yet.
    """
    path = Path(path)
    if was_at is not None:
        project = move_project(project, was_at, path)
    write_atomically(path, encode_project(project, path), like)
    return project


def encode_project(project: Project, path: Path) -> bytes:
    """Return the content of a project's file at `path`, after reading it back as a check. Raises
    FileError, also if a newer Metagraph wrote the file that is there.
    """
    refuse_newer_file(path)
    try:
        text = to_text(with_clip_identity(to_data(project)))
    except DataError as error:
        raise FileError(
            path, phrase("cannot be saved: {error}", error=error), error.where, phrase("Correct that value.")
        ) from None
    try:
        from_data(_parsed(text, path))
    except DataError as error:
        raise FileError(
            path,
            phrase(
                "cannot be saved, because it could not be opened again: {where} {error}",
                where=error.where,
                error=error,
            ),
            error.where,
            phrase("Correct that value. The file is unchanged."),
        ) from None
    return text.encode()


def _parsed(text: str, path: Path) -> Data:
    try:
        data: Data = read_text_data(text)[0]
    except TextError as error:
        raise FileError(
            path,
            phrase("cannot be saved: {error}", error=error),
            phrase("line {line}", line=error.line),
            phrase("Correct it."),
        ) from None
    return data


def make_writable(project: Project) -> Project:
    """Return the project with only texts that can be written to any file; usually the project itself."""
    try:
        data = to_data(project)
    except DataError:
        return project  # the code that writes it reports what is wrong
    if as_text(data) is data:
        return project
    clean = from_data(data)
    clips = {
        i: replace(e, motion=project.clips[i].motion, source=project.clips[i].source)
        for i, e in clean.clips.items()
    }
    return replace(clean, clips=clips, skeleton=project.skeleton, voices=project.voices)


def compute_file_digest(path: Path | None) -> str | None:
    """Return the SHA-256 of a project file in hex, to detect changes; None if there is no file. Raises
    FileError.
    """
    if path is None or not is_file(path):
        return None
    return compute_content_digest(read_file(path, TEXT_FILE))


def compute_content_digest(content: bytes) -> str:
    """Return the SHA-256 of a content in hex."""
    return hashlib.sha256(content).hexdigest()


def read_project(path: str | Path, notes: list[str] | None = None) -> Project:
    """Read a project file without loading its clips. `notes` is as in `data.from_data`. Raises FileError."""
    path = Path(path)
    return _decoded(_content(path), path, notes)


def _content(path: Path) -> bytes:
    return read_file(path, TEXT_FILE)


def _decoded(content: bytes, path: Path, notes: list[str] | None = None, to_look_at: bool = False) -> Project:
    try:
        return parse_project(content.decode("utf-8-sig"), path, notes, to_look_at)
    except UnicodeDecodeError as error:
        raise FileError(
            path,
            phrase("is not text"),
            phrase("byte {start}", start=error.start),
            phrase("Choose a Metagraph project file."),
        ) from None


def read_with_digest(path: Path, notes: list[str] | None = None) -> tuple[Project, str]:
    """Read a project file without loading its clips; return the project and the digest of exactly what was
    read. Raises FileError.
    """
    content = _content(path)
    return _decoded(content, path, notes), compute_content_digest(content)


def open_project(path: str | Path, progress: Callable[[int, int], None] | None = None) -> Opened:
    """Read a project file and load its clips. Clips with missing or broken files have no motion, and a note
    says so; so does one for a file that a newer Metagraph wrote. Raises FileError.
    """
    path = Path(path)
    notes: list[str] = []
    content = _content(path)
    project, found = _decoded(content, path, notes, True), compute_content_digest(content)
    newer = find_newer_version(content) is not None
    if newer:
        notes.insert(0, ONLY_LOOKED_AT)
    opened = load_motions(project, path.resolve().parent, progress)  # relative paths start at a link's target
    if names := list_closed_paths(opened.project):
        notes.append(describe_closed_paths(names))
    found_props, told = find_prop_files(opened.project, path.resolve().parent)
    opened = replace(opened, project=found_props)
    notes += told
    notes += _describe_missing_picture(opened.project, path.resolve().parent)
    return replace(opened, notes=(*notes, *opened.notes), digest=found, newer=newer)


def _describe_missing_picture(project: Project, folder: Path) -> list[str]:
    """Return a note on the picture behind the character, if its file is not there."""
    name = project.backdrop.path
    if project.backdrop.kind != "picture" or is_closed(name) or is_file(folder / name):
        return []
    return [
        phrase(
            "the background is not drawn: there is no file '{path}'. Put it back, or choose another one",
            path=name,
        )
    ]
