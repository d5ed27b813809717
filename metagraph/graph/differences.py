"""What differs between two states of a project, as lines to read: clips, actions, stances and settings added,
removed, changed.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import fields, is_dataclass
from typing import Any

import msgspec

from metagraph.graph.model import LAYERS, Project

_NAMED = {
    "clips": "Clip",
    "lines": "Line",
    "points": "Point",
    "performances": "Performance",
    "conversations": "Conversation",
}
_REST = (
    "name",
    "character",
    "hidden",
    "base",
    "roles",
    "parts",
    "markov",
    "settings",
    "language",
    "life",
    "face",
    "tiers",
    "labels",
    "notes",
    "marks",
    "joint_maps",
    "skeleton",
)
_UNSEEN = ("id", "digest", "clip_name", "clip_sha256")  # of no use to a reader


def differences(before: Project, after: Project) -> list[str]:
    """Return what was done to `before` to make it `after`, one line a thing, in the order of the project
    file.
    """
    if before is after:
        return []
    lines: list[str] = []
    for name in _REST:
        old, new = getattr(before, name), getattr(after, name)
        if old is not new and old != new:
            lines.append(f"{name.replace('_', ' ').capitalize()} changed{_what(old, new)}")
    for name, word in _NAMED.items():
        lines += _keyed(word, getattr(before, name), getattr(after, name))
    for layer in LAYERS:
        old, new = before.graphs[layer], after.graphs[layer]
        lines += _keyed("Stance", old.stances, new.stances, f" ({layer})")
        lines += _keyed("", old.actions, new.actions, f" ({layer})")
        if old.start != new.start:
            names = [
                f"'{g.stances[g.start].name}'" if g.start is not None and g.start in g.stances else "none"
                for g in (old, new)
            ]
            lines.append(f"First stance of {layer}: {names[0]} → {names[1]}")
        if old.weights != new.weights:
            lines.append(f"Weights of {layer} changed{_what(old.weights, new.weights)}")
        old_machine, new_machine = before.manual.get(layer), after.manual.get(layer)
        if old_machine != new_machine:
            lines.append(f"Manual state machine ({layer}) {_fate(old_machine, new_machine)}")
    return [" ".join(line.split()) for line in lines]  # names may hold anything


def _fate(old: object, new: object) -> str:
    return "added" if old is None else "removed" if new is None else "changed"


def _keyed(word: str, before: Mapping[str, Any], after: Mapping[str, Any], where: str = "") -> Iterator[str]:
    if before is after:
        return
    for ident in dict.fromkeys((*before, *after)):
        old, new = before.get(ident), after.get(ident)
        if old is new or old == new:
            continue
        some: Any = old if new is None else new
        title = (
            f"{word or ('Stance loop' if some.kind == 'stance' else some.kind.capitalize())} "
            f"'{_title(some, ident)}'{where}"
        )
        yield f"{title} {_fate(old, new)}{_what(old, new) if old is not None and new is not None else ''}"


def _title(value: Any, ident: str) -> str:
    return str(getattr(value, "name", "") or getattr(value, "text", "") or ident)


def _what(old: Any, new: Any) -> str:
    """Return which fields differ, with their values where those are short."""
    words = [word for name, a, b in _fields(old, new) if a != b and (word := _change(name, a, b))]
    return f": {', '.join(words)}" if words else ""


def _fields(old: Any, new: Any, prefix: str = "") -> Iterator[tuple[str, Any, Any]]:
    if is_dataclass(old) and type(old) is type(new):
        names = [f.name for f in fields(old) if f.compare and f.name not in _UNSEEN]
    elif isinstance(old, msgspec.Struct) and type(old) is type(new):
        names = list(old.__struct_fields__)
    elif isinstance(old, Mapping) and isinstance(new, Mapping):
        for name in dict.fromkeys((*old, *new)):
            yield f"{prefix}{name}", old.get(name), new.get(name)
        return
    else:
        yield prefix.rstrip("."), old, new
        return
    for name in names:
        a, b = getattr(old, name), getattr(new, name)
        if is_dataclass(a) and is_dataclass(b):
            yield from _fields(a, b)
        else:
            yield f"{prefix}{name}", a, b


def _change(name: str, old: Any, new: Any) -> str:
    name = name.replace("_", " ")
    a, b = _shown(old), _shown(new)
    return f"{name} {a} → {b}".strip() if a and b else name


def _shown(value: Any) -> str:
    """Return a value in a few characters, "" where it takes more."""
    if isinstance(value, tuple) and all(isinstance(x, str) for x in value):
        value = ", ".join(value) or None
    if value is None:
        return "none"
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, int | float):
        return f"{value:g}"
    return f"'{value}'" if isinstance(value, str) and len(value) <= 40 else ""
