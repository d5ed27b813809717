"""Project files: YAML, one line a clip, stance or action, in a stable order; written whole or not at all.

Clip paths are relative to the project file and carry the file's SHA-256, so a moved or renamed file is found again.
"""

from __future__ import annotations

import json
import os
import re
import tempfile
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import yaml

from metagraph.errors import FileError
from metagraph.formats.clips import digest, read_clips
from metagraph.formats.data import FORMAT, Data, DataError, from_data, to_data
from metagraph.graph.model import ClipEntry, Project
from metagraph.motion.adopt import SkeletonMismatchError, adopt
from metagraph.motion.clip import Clip

SUFFIX = ".metagraph.yaml"
HEADER = "# A Metagraph project. One line a clip, stance or action; times in seconds.\n"
SEARCHED = 20_000  # files looked at when a clip has moved

# Upgrades of the plain data, from the version they are listed under to the next.
UPGRADES: dict[int, Callable[[Data], Data]] = {}


@dataclass(frozen=True)
class Opened:
    """A project read from a file. notes: what was repaired or is worth knowing, in words."""

    project: Project
    notes: tuple[str, ...] = ()


# --- text ------------------------------------------------------------------------------------------------------------

_PLAIN = re.compile(r"[A-Za-z_][A-Za-z0-9_ ./()+-]*\Z")
_WORDS = {"y", "n", "yes", "no", "on", "off", "true", "false", "null", "none", "nan", "inf"}


def _scalar(value: Any) -> str:
    if isinstance(value, str):
        plain = _PLAIN.match(value) and not value.endswith(" ") and value.lower() not in _WORDS
        return value if plain else json.dumps(value, ensure_ascii=False).replace("\x7f", "\\x7f").replace("\u0085", "\\x85")
    if isinstance(value, list):
        return "[" + ", ".join(map(_scalar, value)) + "]"
    if isinstance(value, dict):
        return "{" + ", ".join(f"{_scalar(k)}: {_scalar(v)}" for k, v in value.items()) + "}"
    if value is None:
        return "null"
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, float):
        text = repr(value)
        return re.sub(r"^(-?\d+)e", r"\1.0e", text)  # YAML wants the point
    return str(value)


def to_text(data: Data) -> str:
    """Return the canonical YAML text of plain project data."""
    lines = [HEADER.rstrip("\n")]

    def section(key: str, value: Any, indent: str) -> None:
        if isinstance(value, list) and value and isinstance(value[0], dict | list):
            lines.append(f"{indent}{key}:")
            lines.extend(f"{indent}- {_scalar(item)}" for item in value)
        elif isinstance(value, dict) and value and indent == "":
            lines.append(f"{key}:")
            for inner, content in value.items():
                if isinstance(content, dict) and key in ("layers", "markov"):
                    lines.append(f"  {_scalar(inner)}:")
                    for name, part in content.items():
                        section(name, part, "    ")
                else:
                    lines.append(f"  {_scalar(inner)}: {_scalar(content)}")
        else:
            lines.append(f"{indent}{key}: {_scalar(value)}")

    for key, value in data.items():
        section(key, value, "")
    return "\n".join(lines) + "\n"


def from_text(text: str, path: Path) -> Project:
    """Return the project written in a file's text, its clips without motion. Raises FileError."""
    loader = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
    try:
        data = yaml.load(text, Loader=loader)
    except yaml.MarkedYAMLError as error:
        line = f"line {error.problem_mark.line + 1}" if error.problem_mark else ""
        raise FileError(
            path, f"not valid YAML ({error.problem})", line, "Undo the last change made by hand, or restore a backup."
        ) from None
    except (yaml.YAMLError, RecursionError, ValueError) as error:
        raise FileError(path, f"not valid YAML ({str(error).splitlines()[0]})", "", "Restore a backup.") from None
    try:
        return from_data(_upgraded(data, path))
    except DataError as error:
        raise FileError(path, f"{error.where} {error}", _line_of(text, error.where), "Correct the line, or restore a backup.") from None


def _upgraded(data: Any, path: Path) -> Any:
    version = data.get("metagraph") if isinstance(data, Mapping) else None
    if version is None:
        return data
    if not isinstance(version, int) or isinstance(version, bool) or version < 1:
        raise DataError("metagraph", f"should be the format's version, found {version!r}")
    if version > FORMAT:
        raise FileError(
            path, f"was written by a newer Metagraph (format {version}, this one reads up to {FORMAT})", "", "Update Metagraph."
        )
    while version < FORMAT:
        data = {**UPGRADES[version](dict(data)), "metagraph": version + 1}
        version += 1
    return data


def _line_of(text: str, where: str) -> str:
    """Return "line n" for a field named like `layers.arms.actions[3] 'a7'.kind`, found by its id."""
    ident = re.search(r"'([^']+)'", where)
    if ident:
        for n, line in enumerate(text.splitlines(), 1):
            if re.search(rf"\bid: [\"']?{re.escape(ident.group(1))}\b", line):
                return f"line {n}"
    key = where.split(".")[-1].split("[")[0]
    for n, line in enumerate(text.splitlines(), 1):
        if re.match(rf"\s*{re.escape(key)}:", line):
            return f"line {n}"
    return ""


# --- files -----------------------------------------------------------------------------------------------------------


def write_atomically(path: Path, content: bytes) -> None:
    """Write a file whole or not at all. Raises FileError."""
    temporary = None
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        handle, name = tempfile.mkstemp(prefix=f".{path.name}.", dir=path.parent)
        temporary = Path(name)
        with os.fdopen(handle, "wb") as file:
            file.write(content)
            file.flush()
            os.fsync(file.fileno())
        if path.exists():
            temporary.chmod(path.stat().st_mode & 0o777)
        else:
            mask = os.umask(0)
            os.umask(mask)
            temporary.chmod(0o666 & ~mask)
        temporary.replace(path)
    except OSError as error:
        if temporary is not None:
            temporary.unlink(missing_ok=True)
        raise FileError(
            path, f"cannot be written ({error.strerror or error})", "", "Choose a folder you may write to, with space left."
        ) from None


def save_project(project: Project, path: str | Path, was_at: Path | None = None) -> Project:
    """Save; return the project with its paths relative to the new place when `was_at`, the old file, is elsewhere."""
    path = Path(path)
    project = moved(project, was_at, path)
    write_atomically(path, to_text(to_data(project)).encode())
    return project


def moved(project: Project, old: Path | None, new: Path) -> Project:
    """Return the project with paths relative to `old` made relative to `new`. Both are project files; None means absolute paths."""
    source = old.parent if old is not None else None

    def renew(text: str) -> str:
        whole = Path(text) if source is None else source / text
        return relative(whole, new.parent)

    clips = {i: replace(e, path=renew(e.path)) for i, e in project.clips.items()}
    character = renew(project.character) if project.character else None
    return replace(project, clips=clips, character=character)


def absolute(project: Project, folder: Path) -> Project:
    """Return the project with its paths, relative to `folder`, made absolute: for a project without a file."""
    clips = {i: replace(e, path=(folder / e.path).resolve().as_posix()) for i, e in project.clips.items()}
    character = (folder / project.character).resolve().as_posix() if project.character else None
    return replace(project, clips=clips, character=character)


def relative(path: Path, folder: Path) -> str:
    """Return `path` relative to `folder` with `/` between parts; absolute where there is no way (another drive)."""
    try:
        return Path(os.path.relpath(path, folder)).as_posix()
    except ValueError:
        return path.resolve().as_posix()


def read_project(path: str | Path) -> Project:
    """Read a project file without loading its clips. Raises FileError."""
    path = Path(path)
    try:
        text = path.read_bytes().decode("utf-8-sig")
    except OSError as error:
        raise FileError(path, f"cannot be read ({error.strerror or error})", "", "Check that it is there.") from None
    except UnicodeDecodeError as error:
        raise FileError(path, f"is not text (byte {error.start})", "", "Choose a Metagraph project file.") from None
    return from_text(text, path)


def open_project(path: str | Path, progress: Callable[[int, int], None] | None = None) -> Opened:
    """Read a project file and load its clips; missing or broken clip files leave their clips without motion, with a note."""
    path = Path(path)
    return load_motions(read_project(path), path.parent, progress)


def load_motions(project: Project, folder: Path, progress: Callable[[int, int], None] | None = None) -> Opened:
    """Load the motion of every clip that has none; `folder` is what paths are relative to."""
    notes: list[str] = []
    clips = dict(project.clips)
    by_path: dict[str, list[ClipEntry]] = {}
    for entry in clips.values():
        if entry.motion is None:
            by_path.setdefault(entry.path, []).append(entry)
    lost = {p: e for p, e in by_path.items() if not (folder / p).is_file()}
    found = _find(lost, folder) if lost else {}
    skeleton = project.skeleton
    for n, (name, entries) in enumerate(by_path.items()):
        if progress is not None:
            progress(n, len(by_path))
        place = found.get(name, folder / name)
        if name in found:
            notes.append(f"'{name}' has moved to '{relative(place, folder)}'")
        if not place.is_file():
            notes.append(f"'{name}' is missing")
            continue
        try:
            takes = read_clips(place)
            now = digest(place)
        except FileError as error:
            notes.append(str(error))
            continue
        for entry in entries:
            if entry.take >= len(takes):
                notes.append(f"'{name}' no longer has take {entry.take + 1}")
                continue
            if entry.digest and now != entry.digest:
                notes.append(f"'{name}' has changed since it was imported")
            motion = takes[entry.take].renamed(entry.name)
            if skeleton is None:
                skeleton = motion.skeleton
            motion = _adopted(motion, skeleton)
            clips[entry.id] = replace(entry, path=relative(place, folder), digest=now, frames=motion.frames, fps=motion.fps, motion=motion)
    return Opened(replace(project, clips=clips, skeleton=skeleton), tuple(dict.fromkeys(notes)))


def relocate(project: Project, folder: Path | None, where: Path, progress: Callable[[int, int], None] | None = None) -> Project:
    """Return the project with missing clips loaded from anywhere below `where`, their paths corrected; found by name or content."""
    lost: dict[str, list[ClipEntry]] = {}
    for entry in project.clips.values():
        if entry.motion is None:
            lost.setdefault(entry.path, []).append(entry)
    found = _find(lost, where)
    base = folder or Path()
    clips = dict(project.clips)
    for path, place in found.items():
        name = relative(place, base) if folder is not None else place.as_posix()
        clips.update({e.id: replace(e, path=name) for e in lost[path]})
    return load_motions(replace(project, clips=clips), base, progress).project


def _adopted(clip: Clip, skeleton: Any) -> Clip:
    try:
        return adopt(clip, skeleton)
    except SkeletonMismatchError:
        return clip  # `check` says so


def _find(lost: Mapping[str, Iterable[ClipEntry]], folder: Path) -> dict[str, Path]:
    """Look for moved files below the project's folder: same name first, any name with the same content after that."""
    by_digest = {e.digest: path for path, entries in lost.items() for e in entries if e.digest}
    suffixes = {Path(p).suffix.lower() for p in lost}
    names: dict[str, list[str]] = {}
    for path in lost:
        names.setdefault(Path(path).name.lower(), []).append(path)
    found: dict[str, Path] = {}
    others: list[Path] = []
    seen = 0
    for top, folders, files in os.walk(folder):
        folders[:] = sorted(f for f in folders if not f.startswith("."))
        for file in sorted(files):
            seen += 1
            candidate = Path(top) / file
            if candidate.suffix.lower() not in suffixes:
                continue
            wanted = names.get(file.lower())
            if wanted and digest(candidate) in by_digest:
                found[by_digest[digest(candidate)]] = candidate
            else:
                others.append(candidate)
        if seen > SEARCHED:
            break
    for candidate in others:
        if len(found) == len(lost):
            break
        same = by_digest.get(digest(candidate))
        if same is not None:
            found.setdefault(same, candidate)
    return found
