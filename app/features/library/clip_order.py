"""Orders in which the library lists clips: what a clip is compared by, and the words for it."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import PurePosixPath
from typing import Any

from metagraph.graph.model import KINDS, LAYERS, ClipEntry, Project

Key = Callable[[Project, ClipEntry], Any]
GIVEN = "given"  # as the project has them


def natural(name: str) -> tuple[tuple[int, int, str], ...]:
    """Return a name so that 'beat 2' comes before 'beat 10', in whatever capitals."""
    return tuple(
        (0, int(part), "") if part.isdecimal() and part.isascii() else (1, 0, part)
        for part in re.split(r"(\d+)", name.casefold())
        if part
    )


def _use(project: Project, entry: ClipEntry) -> tuple[int, int]:
    """Return layer and kind of a clip's first use; what has none comes last."""
    uses = project.uses.get(entry.id, ())
    return min(((LAYERS.index(a.layer), KINDS.index(a.kind)) for a in uses), default=(len(LAYERS), 0))


def _stance(project: Project, entry: ClipEntry) -> tuple[int, Any]:
    uses = project.uses.get(entry.id, ())
    names = [s.name for a in uses if (s := project.stance(a.stance)) is not None]
    return (0, min(natural(name) for name in names)) if names else (1, ())


def _count(project: Project, entry: ClipEntry) -> int:
    return len(project.uses.get(entry.id, ()))


def _folder(project: Project, entry: ClipEntry) -> Any:
    path = PurePosixPath(entry.path)
    return natural(path.parent.as_posix()), natural(path.name), entry.take


ORDERS: dict[str, tuple[str, Key]] = {
    GIVEN: ("As imported", lambda project, entry: ()),
    "name": ("Name", lambda project, entry: natural(entry.name)),
    "length": ("Length", lambda project, entry: (entry.duration, natural(entry.name))),
    "use": ("Layer and kind", lambda project, entry: (_use(project, entry), natural(entry.name))),
    "stance": ("Stance", lambda project, entry: (_stance(project, entry), natural(entry.name))),
    "uses": ("Times used", lambda project, entry: (-_count(project, entry), natural(entry.name))),
    "folder": ("Folder and file", _folder),
    "missing": ("Missing ones first", lambda project, entry: (entry.motion is not None, natural(entry.name))),
}  # fmt: skip
