"""Orders in which the library lists clips: what a clip is compared by, and the words for it."""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import lru_cache
from pathlib import PurePosixPath
from typing import Any

from app.features.library.clip_facts import ClipFacts
from app.translation import make_lazy_texts, tr
from metagraph.graph.clip_mark import COLORS
from metagraph.graph.model import KINDS, LAYERS, ClipEntry
from metagraph.motion.moving import PARTS

Key = Callable[[ClipFacts, ClipEntry], Any]
GIVEN = "given"  # as the project has them


@lru_cache(maxsize=8192)
def make_natural_key(name: str) -> tuple[tuple[int, int, str], ...]:
    """Return a name so that 'beat 2' comes before 'beat 10', in whatever capitals."""
    return tuple(
        (0, int(part), "") if part.isdecimal() and part.isascii() else (1, 0, part)
        for part in re.split(r"(\d+)", name.casefold())
        if part
    )


def find_first_use(facts: ClipFacts, entry: ClipEntry) -> tuple[int, int]:
    """Return layer and kind of a clip's first use; what has none comes last."""
    return min(
        ((LAYERS.index(a.layer), KINDS.index(a.kind)) for a in facts.uses(entry)), default=(len(LAYERS), 0)
    )


def list_stance_names(facts: ClipFacts, entry: ClipEntry) -> list[str]:
    """Return the names of the stances that a clip is used in, in order."""
    found = {s.name for a in facts.uses(entry) if (s := facts.project.stance(a.stance)) is not None}
    return sorted(found, key=make_natural_key)


def _stance(facts: ClipFacts, entry: ClipEntry) -> tuple[int, Any]:
    names = list_stance_names(facts, entry)
    return (0, make_natural_key(names[0])) if names else (1, ())


def _moves(facts: ClipFacts, entry: ClipEntry) -> Any:
    found = facts.moved(entry)
    return not found, [PARTS.index(part) for part in found]


def _folder(facts: ClipFacts, entry: ClipEntry) -> Any:
    path = PurePosixPath(entry.path)
    return make_natural_key(path.parent.as_posix()), make_natural_key(path.name), entry.take


def _color(facts: ClipFacts, entry: ClipEntry) -> int:
    color = facts.mark(entry).color
    return COLORS.index(color) if color else len(COLORS)


def _by(first: Key) -> Key:
    """Return an order by something, and by name if that is the same."""
    return lambda facts, entry: (first(facts, entry), make_natural_key(entry.name))


ORDERS: dict[str, tuple[str, Key]] = make_lazy_texts(
    lambda: {
        GIVEN: (tr("As imported"), lambda facts, entry: ()),
        "name": (tr("Name"), lambda facts, entry: make_natural_key(entry.name)),
        "length": (tr("Length"), _by(lambda facts, entry: entry.duration)),
        "moves": (tr("What moves"), _by(_moves)),
        "use": (tr("Layer and kind"), _by(find_first_use)),
        "stance": (tr("Stance"), _by(_stance)),
        "uses": (tr("Times used"), _by(lambda facts, entry: -len(facts.uses(entry)))),
        "problems": (tr("Problems"), _by(lambda facts, entry: -facts.problems(entry))),
        "rating": (tr("Stars"), _by(lambda facts, entry: -facts.mark(entry).rating)),
        "color": (tr("Colour label"), _by(_color)),
        "favourite": (tr("Favourites first"), _by(lambda facts, entry: not facts.mark(entry).favourite)),
        "folder": (tr("Folder and file"), _folder),
        "missing": (tr("Missing files first"), _by(lambda facts, entry: entry.motion is not None)),
    }
)
