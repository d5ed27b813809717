"""Describe the difference of two states of a project in lines: clips, actions, stances and settings that were
added, removed or changed.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, fields, is_dataclass
from typing import Any, Literal

import msgspec

from metagraph.common.wording import Phrase, phrase
from metagraph.graph.model import LAYERS, Project

_NAMED = {
    "clips": phrase("Clip"),
    "lines": phrase("Line"),
    "points": phrase("Point"),
    "props": phrase("Prop"),
    "parameters": phrase("Parameter"),
    "performances": phrase("Performance"),
    "conversations": phrase("Conversation"),
}
_KINDS = {
    "stance": phrase("Stance loop"),
    "gesture": phrase("Gesture"),
    "fidget": phrase("Fidget"),
    "transition": phrase("Transition"),
}
_REST = {
    "name": phrase("Name"),
    "character": phrase("Character"),
    "hidden": phrase("Hidden meshes"),
    "base": phrase("Base pose"),
    "roles": phrase("Roles"),
    "parts": phrase("Body parts"),
    "markov": phrase("Markov models"),
    "settings": phrase("Settings"),
    "language": phrase("Language"),
    "life": phrase("Life"),
    "face": phrase("Face"),
    "backdrop": phrase("Background"),
    "tiers": phrase("Tiers"),
    "labels": phrase("Labels"),
    "notes": phrase("Notes"),
    "marks": phrase("Marks"),
    "joint_maps": phrase("Joint maps"),
    "skeleton": phrase("Skeleton"),
}
_UNSEEN = ("id", "digest", "clip_name", "clip_sha256")  # of no use to a reader


Fate = Literal["added", "removed", "changed"]


@dataclass(frozen=True)
class Difference:
    """A thing that differs in two states of a project. words: a line about it. part: what of the project it
    is in, such as "clips", "stances" or "actions". ident: its id there, "" for what there is one of.
    """

    fate: Fate
    words: str
    part: str
    ident: str = ""


def describe_differences(before: Project, after: Project) -> list[str]:
    """Return what was done to `before` to make it `after`, one line a thing, in the order of the project
    file.
    """
    return [one.words for one in list_differences(before, after)]


def list_differences(before: Project, after: Project) -> list[Difference]:
    """Return what differs in `after` from `before`, in the order of the project file."""
    if before is after:
        return []
    out: list[Difference] = []
    for name, word in _REST.items():
        old, new = getattr(before, name), getattr(after, name)
        if old is not new and old != new:
            out.append(_difference(name, word, "changed", _what(old, new)))
    for name, word in _NAMED.items():
        out += _keyed(name, word, getattr(before, name), getattr(after, name))
    for layer in LAYERS:
        old, new = before.graphs[layer], after.graphs[layer]
        out += _keyed("stances", phrase("Stance"), old.stances, new.stances, layer)
        both = [i for i in old.stances if i in new.stances]
        if both != (order := [i for i in new.stances if i in old.stances]):
            listed = ", ".join(" ".join(new.stances[i].name.split()) for i in order)
            words = phrase("Order of the stances of {layer}: {names}", layer=_plain(layer), names=listed)
            out.append(Difference("changed", words, "start"))
        out += _keyed("actions", "", old.actions, new.actions, layer)
        if old.start != new.start:
            names = [
                f"'{g.stances[g.start].name}'"
                if g.start is not None and g.start in g.stances
                else phrase("none")
                for g in (old, new)
            ]
            first, then = (" ".join(n.split()) if n.startswith("'") else n for n in names)
            words = phrase(
                "Start stance of {layer}: {before} → {after}", layer=_plain(layer), before=first, after=then
            )
            out.append(Difference("changed", words, "start"))
        if old.weights != new.weights:
            weights = phrase("Weights of {layer}", layer=_plain(layer))
            out.append(_difference("weights", weights, "changed", _what(old.weights, new.weights)))
        old_machine, new_machine = before.manual.get(layer), after.manual.get(layer)
        if old_machine != new_machine:
            machine = phrase("Manual state machine ({layer})", layer=_plain(layer))
            out.append(_difference("manual", machine, _fate(old_machine, new_machine)))
    return out


def _difference(part: str, what: str, fate: Fate, how: str = "", ident: str = "") -> Difference:
    """Return a difference: what it is, what became of it, and which fields differ."""
    return Difference(fate, _line(what, fate, how), part, ident)


def _line(what: str, fate: Fate, how: str) -> str:
    if fate == "added":
        return phrase("{what} added", what=what)
    if fate == "removed":
        return phrase("{what} removed", what=what)
    if not how:
        return phrase("{what} changed", what=what)
    return phrase("{what} changed: {how}", what=what, how=" ".join(how.split()))  # values may hold anything


def _plain(word: str) -> str:
    """Return a word of the project file, as words that know their template."""
    return Phrase(word, {})


def _fate(old: object, new: object) -> Fate:
    return "added" if old is None else "removed" if new is None else "changed"


def _keyed(
    part: str, word: str, before: Mapping[str, Any], after: Mapping[str, Any], layer: str = ""
) -> Iterator[Difference]:
    if before is after:
        return
    for ident in dict.fromkeys((*before, *after)):
        old, new = before.get(ident), after.get(ident)
        if old is new or old == new:
            continue
        if old is not None and new is not None and all(a == b for _, a, b in _fields(old, new)):
            continue  # only what no reader sees
        some: Any = old if new is None else new
        kind = word or _KINDS[some.kind]
        name = " ".join(_title(some, ident).split())  # names may hold anything
        title = (
            phrase("{kind} '{name}' ({layer})", kind=kind, name=name, layer=_plain(layer))
            if layer
            else phrase("{kind} '{name}'", kind=kind, name=name)
        )
        fate = _fate(old, new)
        yield _difference(part, title, fate, _what(old, new) if fate == "changed" else "", ident)


def _title(value: Any, ident: str) -> str:
    return str(getattr(value, "name", "") or getattr(value, "text", "") or ident)


def _what(old: Any, new: Any) -> str:
    """Return which fields differ, with their values where those are short."""
    words = [word for name, a, b in _fields(old, new) if a != b and (word := _change(name, a, b))]
    return ", ".join(words)


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
    """Return a value in a few characters, "" if it takes more."""
    if isinstance(value, tuple) and all(isinstance(x, str) for x in value):
        value = ", ".join(value) or None
    if value is None:
        return "none"
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, int | float):
        return f"{value:g}"
    if isinstance(value, tuple) and len(value) == 3 and all(isinstance(x, int | float) for x in value):
        return f"({', '.join(f'{x:g}' for x in value)})"
    return f"'{value}'" if isinstance(value, str) and len(value) <= 40 else ""
