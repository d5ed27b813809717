"""Two states of a project that were one once, merged: what was done in either is in the whole.

Where both changed the same thing differently, the first is kept, and that is told. What one removed and the
other changed stays. What both made under one id is two things.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import fields
from typing import Any

from metagraph.formats.data import from_data, to_data
from metagraph.formats.fields import Data, DataError
from metagraph.graph.model import Project, Timing
from metagraph.records import dataclass

_GONE: Any = object()
_MADE = re.compile(r"[a-z]+\d+")  # ids that the program makes
# What is one thing however many fields it has: its parts would not fit those of another.
_WHOLE = ("skeleton", "markov", "joint_maps", "performances", "conversations", "points", "timelines")
_THINGS = (
    "lines",
    "performances",
    "conversations",
    "timelines",
    "points",
    "notes",
    "marks",
    "tiers",
    "labels",
    "joint_maps",
    "manual",
)
_TIMES = frozenset(f.name for f in fields(Timing))
_TEXTS = ("name", "text", "path", "sha256", "notes", "note", "made_by")  # texts that may look like ids


class MergeError(ValueError):
    """The two do not go together; the message says what does not."""


@dataclass(frozen=True)
class Merged:
    """project: without motion. kept: what both had changed, in words; mine stands."""

    project: Project
    kept: tuple[str, ...]


def merge(common: Project, mine: Project, theirs: Project) -> Merged:
    """Return what was done in `mine` and in `theirs` since they were `common`. Raises MergeError."""
    base, ours, others = to_data(common), to_data(mine), to_data(theirs)
    others["next_id"] = ours["next_id"] = max(ours["next_id"], others["next_id"])
    ours = _apart(base, ours, others)
    kept: list[str] = []
    try:
        data = _merged(base, ours, others, "", kept, 0)
        return Merged(from_data(data), tuple(kept))
    except (DataError, KeyError, TypeError, ValueError) as error:
        where = getattr(error, "where", "")
        raise MergeError(f"{where} {error}".strip()) from None


# --- what both have made


def _apart(base: Data, mine: Data, theirs: Data) -> Data:
    """Return mine with other ids for what was made on both sides under the same."""
    number = mine["next_id"]
    renamed: dict[str, str] = {}
    known, others = dict(_made(base)), dict(_made(theirs))
    for ident, made in _made(mine):
        if ident not in known and others.get(ident, made) != made:
            number += 1
            renamed[ident] = re.sub(r"\d+\Z", str(number), ident)
    if not renamed:
        return mine
    theirs["next_id"] = number + 1
    return {**_renamed(mine, renamed), "next_id": number + 1}


def _made(data: Any, where: str = "") -> Iterator[tuple[str, tuple[str, Any]]]:
    """Give the id of everything that has one of the program's making, with where it stands and what it is."""
    if isinstance(data, Mapping):
        for key, value in data.items():
            if isinstance(value, Mapping) and _MADE.fullmatch(key):
                yield key, (where, value)
            yield from _made(value, f"{where}.{key}")
    elif isinstance(data, list) and _is_keyed(data):
        for item in data:
            if _MADE.fullmatch(item["id"]):
                yield item["id"], (where, item)


def _renamed(data: Any, names: Mapping[str, str]) -> Any:
    if isinstance(data, Mapping):
        return {
            names.get(key, key): value if key in _TEXTS and isinstance(value, str) else _renamed(value, names)
            for key, value in data.items()
        }
    if isinstance(data, list):
        return [_renamed(value, names) for value in data]
    return names.get(data, data) if isinstance(data, str) else data


# --- three ways


def _is_keyed(data: Any) -> bool:
    return isinstance(data, list) and all(
        isinstance(x, Mapping) and isinstance(x.get("id"), str) for x in data
    )


def _merged(
    base: Any, mine: Any, theirs: Any, where: str, kept: list[str], depth: int, thing: bool = False
) -> Any:
    """thing: whether what is not there was removed, and has not merely its default."""
    if mine == theirs or theirs == base:
        return mine
    if mine == base:
        return theirs
    if thing and (mine is _GONE or theirs is _GONE):
        left = theirs if mine is _GONE else mine
        kept.append(
            f"{where}: removed {'here' if mine is _GONE else 'on disk'}, and kept since it was changed"
        )
        return left
    lists = [x for x in (base, mine, theirs) if x is not _GONE]
    if where != "skeleton" and all(map(_is_keyed, lists)) and any(lists):
        return _of_lists(base, mine, theirs, where, kept, depth)
    if isinstance(mine, Mapping) and isinstance(theirs, Mapping) and not _is_one(where, depth):
        old = base if isinstance(base, Mapping) else {}
        name = lambda key: f"{where}.{key}" if where else str(key)  # noqa: E731
        return _of_fields(old, mine, theirs, name, kept, depth, where in _THINGS)
    kept.append(f"{where}: changed on both sides")
    return mine


def _is_one(where: str, depth: int) -> bool:
    return depth >= 2 and where.split(".")[0] in _WHOLE


def _of_fields(
    base: Mapping[str, Any],
    mine: Mapping[str, Any],
    theirs: Mapping[str, Any],
    place: Callable[[str], str],
    kept: list[str],
    depth: int,
    things: bool,
) -> Data:
    out: Data = {}
    for key in [*theirs, *(k for k in mine if k not in theirs)]:
        old, ours, others = (side.get(key, _GONE) for side in (base, mine, theirs))
        if things and all(isinstance(x, Mapping) for x in (old, ours, others)):
            others = _timed(old, ours, others, place(key), kept)
        value = _merged(old, ours, others, place(key), kept, depth + 1, things)
        if value is not _GONE:
            out[key] = value
    return out


def _timed(base: Data, mine: Data, theirs: Data, where: str, kept: list[str]) -> Data:
    """Return theirs with my timing where both have changed it: moments of two would not be in order."""
    old, ours, others = ({k: x[k] for k in x if k in _TIMES} for x in (base, mine, theirs))
    if old in (ours, others) or ours == others:
        return theirs
    kept.append(f"{where}, its timing: changed on both sides")
    return {**{k: v for k, v in theirs.items() if k not in _TIMES}, **ours}


def _of_lists(base: Any, mine: Any, theirs: Any, where: str, kept: list[str], depth: int) -> list[Any]:
    """Merge things with ids; in the order of theirs, each new one of mine behind what it stands behind."""
    old, ours, others = (
        {x["id"]: x for x in (side if side is not _GONE else [])} for side in (base, mine, theirs)
    )
    names = {i: x.get("name") or i for i, x in [*old.items(), *others.items(), *ours.items()]}
    what = where.rpartition(".")[2].removesuffix("s")
    merged = _of_fields(old, ours, others, lambda i: f"{what} '{names[i]}'", kept, depth, True)
    order = [i for i in others if i in merged]
    before: str | None = None
    for ident in ours:
        if ident in merged and ident not in others:
            order.insert(order.index(before) + 1 if before in order else len(order), ident)
        before = ident
    return [merged[i] for i in order]
