"""Find clip files that are not where the project says, by their content or their name."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Protocol

from metagraph.common.files import is_file
from metagraph.errors import FileError
from metagraph.formats.clips import digest
from metagraph.graph.model import ClipEntry, Project

SEARCHED = 20_000  # files looked at when clips have moved
COMPARED = 2 << 30  # bytes of those files that are compared by content


class Digested(Protocol):
    """What has a file whose content is known."""

    @property
    def digest(self) -> str: ...


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


def find_moved_files(
    lost: Mapping[str, Iterable[Digested]], folder: Path, by_name: bool = False
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
