"""Read and write project files: YAML, one line for each clip, stance or action, in a stable order; written
whole or not at all.

Clip paths are relative to the project file and have the file's SHA-256, so a moved or renamed file is found
again.
"""

from __future__ import annotations

import hashlib
import os
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import Any

import msgspec

from metagraph.common.budgets import TEXT_FILE
from metagraph.common.files import is_file, is_text, make_unforeseen_error, read_file
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
from metagraph.formats.atomic import write_atomically
from metagraph.formats.clip_identity import with_clip_identity
from metagraph.formats.clips import digest
from metagraph.formats.fbx.processes import batch
from metagraph.formats.motion_cache import read_or_kept
from metagraph.formats.new_file import Access
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
from metagraph.formats.project.text import TextError, as_text, read_text_data, to_text
from metagraph.graph.clip_source import get_source_clip, with_changed_file, with_source
from metagraph.graph.conversation.model import Conversation, Side
from metagraph.graph.editing.retargeting import Bringing
from metagraph.graph.face.takes import FACE_TAKE, is_face_take, put_on_body
from metagraph.graph.model import ClipEntry, Project
from metagraph.graph.prop import Prop
from metagraph.graph.requests import Line
from metagraph.motion.adopt import SkeletonMismatchError, adopt
from metagraph.motion.clip import Clip, ClipError
from metagraph.motion.joint_map import RetargetError

SUFFIX = ".metagraph.yaml"
SEARCHED = 20_000  # files looked at when clips have moved
_CONFLICT = re.compile(r"^<{7} ", re.MULTILINE)
COMPARED = 2 << 30  # bytes of those files that are compared by content

# Upgrades of the plain data, from the version under which they are listed to the next.
UPGRADES: dict[int, Callable[[Data], Data]] = {
    1: lambda data: {key: value for key, value in data.items() if key != "next_id"},
}


@dataclass(frozen=True)
class Opened:
    """A project read from a file.

    `notes` say in words what was repaired or is worth knowing. `digest` is the file's SHA-256 in hex. `newer`
    says that a newer Metagraph wrote the file, so that it may only be read.
    """

    project: Project
    notes: tuple[str, ...] = ()
    digest: str | None = None
    newer: bool = False


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
                return _closed_below(read_known_part(data, notes), path.parent)
            except DataError:
                raise make_newer_error(path, version) from None
        return _closed_below(from_data(_upgraded(data, path), notes), path.parent)
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
            conversations=once(project.conversations, lambda _: _conversations(project, renew)),
        )

    return [once(project, move) for project in projects]


def _with_paths(project: Project, make: Callable[[str], str]) -> Project:
    """Return the project with every path to another file remade by `make`. Closed paths stay closed."""
    return _each_path(project, lambda name: name if is_closed(name) else make(name))


def _closed_below(project: Project, folder: Path) -> Project:
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
        conversations=_conversations(project, renew),
    )


def list_project_files(project: Project, folder: Path) -> tuple[Path, ...]:
    """Return every file that a project in a folder names: clips, the character, props, sounds,
    other projects.
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
    notes += _describe_missing_props(opened.project, path.resolve().parent)
    return replace(opened, notes=(*notes, *opened.notes), digest=found, newer=newer)


def _describe_missing_props(project: Project, folder: Path) -> list[str]:
    """Return a note on each prop whose file is not there."""
    return [
        phrase(
            "the prop '{name}' is not drawn: there is no file '{path}'. Put it back, or remove the prop",
            name=prop.name,
            path=prop.path,
        )
        for prop in project.props.values()
        if not is_closed(prop.path) and not is_file(folder / prop.path)
    ]


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


def load_motions(
    project: Project, folder: Path | None, progress: Callable[[int, int], None] | None = None
) -> Opened:
    """Load the motion of every clip that has none. Paths are relative to `folder`; None if all are
    absolute.
    """
    if folder is not None and folder.parent == folder:
        folder = None  # the root folder is never a project's folder; nothing is searched there
    if folder is not None:
        project = _closed_below(project, folder)  # a journal's project was read without one
    return _load(
        project,
        folder,
        find_moved_files(list_missing_clips(project, folder), folder) if folder is not None else {},
        progress,
    )


def relocate(
    project: Project, folder: Path | None, where: Path, progress: Callable[[int, int], None] | None = None
) -> Project:
    """Return the project with missing clips loaded from anywhere below `where`, and their paths corrected.

    They are found by content, or by name if the content has changed. Those that are back in their places are
    read there.
    """
    return _load(
        project, folder, find_moved_files(list_missing_clips(project, folder), where, by_name=True), progress
    ).project


def load_returned(
    project: Project, folder: Path | None, progress: Callable[[int, int], None] | None = None
) -> Opened:
    """Load the motion of clips without one whose files are in their places. Nothing is searched."""
    return _load(project, folder, {}, progress)


def find_clip_place(entry: ClipEntry, folder: Path | None) -> Path:
    """Return where a clip's file should be. Backslashes, as in paths written by hand on Windows, are
    understood, too.
    """
    place = (folder or Path()) / entry.path
    return (
        place
        if "\\" not in entry.path or is_file(place)
        else (folder or Path()) / entry.path.replace("\\", "/")
    )


def list_missing_clips(project: Project, folder: Path | None) -> dict[str, list[ClipEntry]]:
    """Return the clips whose file is not where it should be, by path."""
    out: dict[str, list[ClipEntry]] = {}
    for entry in project.clips.values():
        if entry.motion is None and not is_file(find_clip_place(entry, folder)):
            out.setdefault(entry.path, []).append(entry)
    return out


@batch()
def _load(
    project: Project,
    folder: Path | None,
    found: Mapping[str, Path],
    progress: Callable[[int, int], None] | None,
) -> Opened:
    """Load the clips without motion; `found` says where moved files are now."""
    by_path: dict[str, list[ClipEntry]] = {}
    for entry in project.clips.values():
        if entry.motion is None:
            by_path.setdefault(entry.path, []).append(entry)
    loading = _Loading(project, folder, found)
    for n, (name, entries) in enumerate(by_path.items()):
        if progress is not None:
            progress(n, len(by_path))
        loading.load(name, entries)
    return loading.opened()


class _Loading:
    """Clips while their files are read.

    `found` has the files that are elsewhere than their path says. `strangers` has the ids of clips that do
    not fit the skeleton.
    """

    def __init__(self, project: Project, folder: Path | None, found: Mapping[str, Path]) -> None:
        self.project, self.folder, self.found = project, folder, found
        self.clips = dict(project.clips)
        self.skeleton = project.skeleton
        self.notes: list[str] = []
        self.strangers: list[str] = []

    def opened(self) -> Opened:
        """Return the project with what was read, and the notes."""
        project = replace(self.project, clips=self.clips, skeleton=self.skeleton)
        if self.strangers:
            project = _brought(project, self.strangers, self.notes)
        return Opened(project, tuple(dict.fromkeys(self.notes)))

    def load(self, name: str, entries: Sequence[ClipEntry]) -> None:
        """Read the file of some clips. `name` is its path in the project."""
        place = self.found.get(name) or find_clip_place(entries[0], self.folder)
        path = self._path(name, place)
        if name in self.found:
            self.notes.append(f"'{recover_original_path(name)}' has moved to '{path}'")
        if is_closed(name) and name not in self.found:
            return  # one note says so for all of them
        if not is_file(place):
            self.notes.append(f"'{clean_text(name)}' is missing")
            return
        try:
            now = digest(place)
            read = {a: read_or_kept(place, now, a) for a in dict.fromkeys(e.as_is for e in entries)}
        except Exception as error:  # one bad file never spoils a project
            self.notes.append(str(make_unforeseen_error(place, error)))
            return
        if any(e.digest and now != e.digest for e in entries):
            self.notes.append(f"'{path}' has changed since it was imported")
        for entry in entries:
            takes = read[entry.as_is]
            if 0 <= entry.take < len(takes):
                motion = self._fitted(entry, takes[entry.take].renamed(entry.name))
                self.clips[entry.id] = with_changed_file(replace(entry, path=path), motion, now)
            else:
                self.notes.append(f"'{path}' no longer has take {entry.take + 1} ('{entry.name}')")

    def _path(self, name: str, place: Path) -> str:
        """Return the path by which the project names this file from now on."""
        if name not in self.found and "\\" not in name:
            return name
        if self.folder is None or Path(name).is_absolute():
            return place.resolve().as_posix()
        return make_path_relative(place, self.folder)

    def _fitted(self, entry: ClipEntry, motion: Clip) -> Clip:
        """Return motion on the project's skeleton. If the project has none, it takes that of the first clip
        with a body. Motion that does not fit is returned as it is, and its clip becomes a stranger.
        """
        if is_face_take(motion):
            self.strangers.append(entry.id)
            return motion
        if self.skeleton is None:
            self.skeleton = motion.skeleton
        try:
            return adopt(motion, self.skeleton)
        except SkeletonMismatchError:
            self.strangers.append(entry.id)
            return motion


def _brought(project: Project, strangers: Iterable[str], notes: list[str]) -> Project:
    """Return the project with those clips retargeted for whose skeleton it has a joint map. `check` reports
    the others.
    """
    bringing = Bringing(project)
    clips = dict(project.clips)
    for ident in strangers:
        entry = clips[ident]
        motion: Clip = get_source_clip(entry)  # type: ignore[assignment]
        joint_map = bringing.known(motion)
        if is_face_take(motion):
            try:
                clips[ident] = with_source(
                    replace(entry, brought_from=FACE_TAKE), put_on_body(project, motion)
                )
            except RetargetError as error:
                notes.append(f"'{entry.path}': {error}")
            continue
        if joint_map is None:
            if entry.brought_from:
                notes.append(
                    f"'{entry.path}' was retargeted, but its joint map is not in the project: import it again"
                )
            continue
        try:
            motion = bringing.bring(motion, joint_map)
        except (RetargetError, ClipError) as error:
            notes.append(
                f"'{entry.path}' could not be retargeted: {error}. Import it again to map its joints anew."
            )
            continue
        clips[ident] = with_source(replace(entry, brought_from=motion.brought_from), motion)
    return replace(project, clips=clips)


def find_moved_files(
    lost: Mapping[str, Iterable[ClipEntry]], folder: Path, by_name: bool = False
) -> dict[str, Path]:
    """Search below a folder for files with the content of lost ones, those of the same name first.

    With `by_name`, a file of the same name is taken if no file has the content; of several, the one whose
    folders match longest.
    """
    paths: dict[str, list[str]] = {}  # by content
    names: dict[str, list[str]] = {}
    for path, entries in lost.items():
        names.setdefault(_parts(path)[-1], []).append(path)
        for wanted in {e.digest for e in entries if e.digest}:
            paths.setdefault(wanted, []).append(path)
    if not lost:
        return {}
    suffixes = {Path(name).suffix for name in names}
    candidates: list[Path] = []
    seen = 0
    for top, folders, files in os.walk(folder):
        folders[:] = sorted(f for f in folders if not f.startswith("."))
        candidates += [Path(top) / f for f in sorted(files) if Path(f).suffix.lower() in suffixes]
        seen += len(files)
        if seen > SEARCHED:
            break
    candidates.sort(key=lambda p: p.name.lower() not in names)
    found: dict[str, Path] = {}
    read = 0
    for candidate in candidates:
        if len(found) == len(lost) or read > COMPARED:
            break
        try:
            read += candidate.stat().st_size
            same = paths.get(digest(candidate), [])
        except (OSError, FileError):
            continue
        for path in same:
            if path not in found or _alike(candidate, path) > _alike(found[path], path):
                found[path] = candidate
    for name, missing in names.items() if by_name else ():
        called = [c for c in candidates if c.name.lower() == name]
        for path in missing:
            if path not in found and called:
                found[path] = max(called, key=lambda c: _alike(c, path))
    return found


def _parts(path: str) -> list[str]:
    return re.split(r"[\\/]+", path.lower())


def _alike(place: Path, path: str) -> int:
    """Return how many names at the ends of two paths match."""
    same = 0
    for a, b in zip(reversed(place.parts), reversed(_parts(path)), strict=False):
        if a.lower() != b:
            break
        same += 1
    return same
