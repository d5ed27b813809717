"""Merge two states of a project that have a common one: what was done in either is in the result.

Where both changed the same thing differently, mine is kept and reported. What one removed and the other
changed, or used again, stays and is reported. What both made under one id becomes two things.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Container, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, fields
from itertools import count
from typing import Any

from metagraph.common.wording import phrase
from metagraph.formats.project.data import from_data, to_data
from metagraph.formats.project.fields import Data, DataError
from metagraph.graph.ids import derive_id
from metagraph.graph.model import Project, Timing

_GONE: Any = object()
_MADE = re.compile(r"[a-z]+\d+")  # ids that the program makes
# Values that are one thing however many fields they have: parts of two would not fit each other.
_WHOLE = ("markov", "joint_maps", "conversations", "points", "parameters")
_NAMED = ("lines", "props", "performances", "timelines", "notes", "marks", "tiers", "labels")
_SETS = ("tags", "joints", "hidden", "locked")  # lists in which the order says nothing
_TIMES = frozenset(f.name for f in fields(Timing))
_TEXTS = ("name", "text", "path", "sha256", "notes", "note", "made_by")  # texts that may look like ids
HERE_AND_ON_DISK = phrase("here"), phrase("on disk")  # where the window's project and its file are
_LONGEST = 60  # characters of a value that is shown in a report


class MergeError(ValueError):
    """The two do not go together; the message says what does not."""


@dataclass(frozen=True)
class Merged:
    """project: without motion. kept: what the two sides disagree on and what was kept, in words."""

    project: Project
    kept: tuple[str, ...]


def merge_projects(
    common: Project, mine: Project, theirs: Project, sides: tuple[str, str] = HERE_AND_ON_DISK
) -> Merged:
    """Return what was done in `mine` and in `theirs` since they were `common`.

    sides: where mine and theirs are, as reports say it. Raises MergeError.
    """
    base, ours, others = to_data(common), to_data(mine), to_data(theirs)
    merger = _Merger(sides)
    try:
        ours = _apart(base, ours, others)
        data = merger.mapping(base, ours, others, _Place())
        merger.bring_back(data, base, ours, others)
        return Merged(from_data(data), tuple(merger.kept))
    except (DataError, KeyError, TypeError, ValueError) as error:
        where = getattr(error, "where", "")
        raise MergeError(f"{where} {error}".strip()) from None


# --- what both have made


def _apart(base: Data, mine: Data, theirs: Data) -> Data:
    """Return mine with other ids for what was made on both sides under the same."""
    known, others, own = dict(_made(base)), dict(_made(theirs)), dict(_made(mine))
    taken = {*known, *others, *own}
    renamed: dict[str, str] = {}
    for ident, made in own.items():
        if ident not in known and others.get(ident, made) != made:
            renamed[ident] = _other_id(ident, taken)
            taken.add(renamed[ident])
    return _renamed(mine, renamed) if renamed else mine


def _other_id(ident: str, taken: Container[str]) -> str:
    letter = ident.rstrip("0123456789")
    return next(i for n in count() if (i := derive_id(letter, ident, n)) not in taken)


def _made(data: Any, where: str = "") -> Iterator[tuple[str, tuple[str, Any]]]:
    """Give the id of everything that has one of the program's making, with where it stands and what it is.
    Requests and markers have theirs within their performance or timeline alone.
    """
    if isinstance(data, Mapping):
        for key, value in data.items():
            # Parameters have names of people's choosing for keys.
            if isinstance(value, Mapping) and _MADE.fullmatch(key) and where != ".parameters":
                yield key, (where, value)
            if where not in (".performances", ".timelines"):
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


def _is_keyed(data: Any) -> bool:
    return isinstance(data, list) and all(
        isinstance(x, Mapping) and isinstance(x.get("id"), str) for x in data
    )


# --- three ways


_KINDS = {
    "clips": phrase("clip"),
    "stances": phrase("stance"),
    "actions": phrase("action"),
    "states": phrase("state"),
    "aliases": phrase("alias"),
    "links": phrase("link"),
    "asks": phrase("request"),
    "markers": phrase("marker"),
    "lines": phrase("line"),
    "performances": phrase("performance"),
    "conversations": phrase("conversation"),
    "timelines": phrase("timeline"),
    "points": phrase("point"),
    "props": phrase("prop"),
    "parameters": phrase("parameter"),
    "notes": phrase("note"),
    "marks": phrase("mark"),
    "tiers": phrase("tier"),
    "labels": phrase("label"),
    "joint_maps": phrase("joint map"),
    "markov": phrase("model"),
}


@dataclass(frozen=True)
class _Place:
    """Where in a project something stands. path: keys from the top. words: how a report calls it."""

    path: tuple[str, ...] = ()
    words: str = ""

    def field(self, key: str, name: str = "") -> _Place:
        """Return the place of a field, or of a thing that is called `name`."""
        path = (*self.path, key)
        if path == ("layers",) or (path[0] in ("layers", "manual") and len(path) == 2):
            return _Place(path, phrase(key) if len(path) == 2 else "")
        if name and len(path) == 2:
            return _Place(path, phrase("{kind} '{name}'", kind=_KINDS[self.path[0]], name=name))
        field = phrase(key.replace("_", " "))
        return _Place(path, phrase("{what}, {field}", what=self.words, field=field) if self.words else field)

    def item(self, ident: str, name: str) -> _Place:
        """Return the place of one of a list of things with ids."""
        path, kind = (*self.path, ident), _KINDS[self.path[-1]]
        if self.path[0] in ("layers", "manual"):
            layer = phrase(self.path[1])
            return _Place(path, phrase("{kind} '{name}' ({layer})", kind=kind, name=name, layer=layer))
        thing = phrase("{kind} '{name}'", kind=kind, name=name)
        if len(self.path) == 1:
            return _Place(path, thing)
        about = self.words.removesuffix(", asks")
        return _Place(path, phrase("{what}, {thing}", what=about, thing=thing))


class _Merger:
    """Merges plain data and notes in words what the sides disagree on."""

    def __init__(self, sides: tuple[str, str]) -> None:
        self.here, self.there = sides
        self.kept: list[str] = []

    def value(self, base: Any, mine: Any, theirs: Any, place: _Place, thing: bool = False) -> Any:
        """thing: whether what is not there was removed, and has not merely its default."""
        if mine == theirs or theirs == base:
            return mine
        if mine == base:
            return theirs
        if thing and (mine is _GONE or theirs is _GONE):
            gone, left = (self.here, self.there) if mine is _GONE else (self.there, self.here)
            self.kept.append(
                phrase(
                    "{what}: removed {gone}, changed {left}; kept the version {left}",
                    what=place.words,
                    gone=gone,
                    left=left,
                )
            )
            return theirs if mine is _GONE else mine
        lists = [x for x in (base, mine, theirs) if x is not _GONE]
        if place.path != ("skeleton",) and all(map(_is_keyed, lists)) and any(lists):
            return self.things(base, mine, theirs, place)
        if place.path[-1] in _SETS and all(isinstance(x, list) for x in lists):
            return _united(*(x if x is not _GONE else [] for x in (base, mine, theirs)))
        whole = len(place.path) >= 2 and place.path[0] in _WHOLE
        if isinstance(mine, Mapping) and isinstance(theirs, Mapping) and not whole:
            old = base if isinstance(base, Mapping) else {}
            return self.mapping(old, mine, theirs, place)
        self.differ(mine, theirs, place)
        return mine

    def differ(self, mine: Any, theirs: Any, place: _Place) -> None:
        shown = [_shown(mine), _shown(theirs)]
        if all(shown):
            words = phrase(
                "{what}: {mine} {here}, {theirs} {there}; kept {mine}",
                what=place.words,
                mine=shown[0],
                here=self.here,
                theirs=shown[1],
                there=self.there,
            )
        else:
            words = phrase(
                "{what}: changed {here} and {there}; kept the version {here}",
                what=place.words,
                here=self.here,
                there=self.there,
            )
        self.kept.append(words)

    def mapping(
        self,
        base: Mapping[str, Any],
        mine: Mapping[str, Any],
        theirs: Mapping[str, Any],
        place: _Place,
    ) -> Data:
        top = place.path[0] if len(place.path) == 1 else ""
        named = top in (*_NAMED, *_WHOLE)

        def of(key: str) -> _Place:
            return place.field(key, _called(key, mine, theirs) if named else "")

        return self.fields(base, mine, theirs, of, named or top == "manual")

    def fields(
        self,
        base: Mapping[str, Any],
        mine: Mapping[str, Any],
        theirs: Mapping[str, Any],
        place: Callable[[str], _Place],
        things: bool,
    ) -> Data:
        out: Data = {}
        for key in [*theirs, *(k for k in mine if k not in theirs)]:
            old, ours, others = (side.get(key, _GONE) for side in (base, mine, theirs))
            if things and all(isinstance(x, Mapping) for x in (old, ours, others)):
                others = self.timed(old, ours, others, place(key))
            value = self.value(old, ours, others, place(key), things)
            if value is not _GONE:
                out[key] = value
        return out

    def timed(self, base: Data, mine: Data, theirs: Data, place: _Place) -> Data:
        """Return theirs with my timing where both have changed it: moments of two would not be in order."""
        old, ours, others = ({k: x[k] for k in x if k in _TIMES} for x in (base, mine, theirs))
        if old in (ours, others) or ours == others:
            return theirs
        self.differ(ours, others, place.field("timing"))
        return {**{k: v for k, v in theirs.items() if k not in _TIMES}, **ours}

    def things(self, base: Any, mine: Any, theirs: Any, place: _Place) -> list[Any]:
        """Merge lists of things with ids, in their order, each new one of mine after its neighbour."""
        if place.path[-1] in ("asks", "markers"):
            mine = _apart_within(base, mine, theirs)
        old, ours, others = (
            {x["id"]: x for x in (side if side is not _GONE else [])} for side in (base, mine, theirs)
        )
        names = {i: x.get("name") or i for i, x in [*others.items(), *ours.items(), *old.items()]}
        merged = self.fields(old, ours, others, lambda i: place.item(i, names[i]), True)
        order = [i for i in others if i in merged]
        before: str | None = None
        for ident in ours:
            if ident in merged and ident not in others:
                order.insert(order.index(before) + 1 if before in order else len(order), ident)
            before = ident
        out = [merged[i] for i in order]
        return sorted(out, key=lambda one: one.get("at", 0.0)) if place.path[-1] == "markers" else out

    def bring_back(self, data: Data, *sides: Data) -> None:
        """Keep clips, stances and states that one side removed where what the other side made needs them."""
        layers = data["layers"]
        for layer, machine in data.get("manual", {}).items():
            self._return_states(machine, [side.get("manual", {}).get(layer, {}) for side in sides])
        clips = [a["clip"] for graph in layers.values() for a in graph["actions"]]
        clips += [s["clip"] for machine in data.get("manual", {}).values() for s in machine.get("states", ())]
        self._return_to(data["clips"], clips, [side["clips"] for side in sides], phrase("clip"))
        for layer, graph in layers.items():
            needed = [a[key] for a in graph["actions"] for key in ("stance", "end_stance") if a.get(key)]
            found = [side["layers"][layer]["stances"] for side in sides]
            self._return_to(graph["stances"], needed, found, phrase("stance"))

    def _return_states(self, machine: Data, known: Sequence[Data]) -> None:
        """Keep the states and aliases of a machine drawn by hand that its links and aliases need."""
        ends = [link[key] for link in machine.get("links", ()) for key in ("source", "target")]
        aliases = machine.setdefault("aliases", [])
        self._return_to(aliases, ends, [one.get("aliases", []) for one in known], phrase("alias"))
        ends += [state for alias in aliases for state in alias.get("states", ())]
        ends += [alias["entry"] for alias in aliases if alias.get("entry")]
        ends += [machine["start"]] if machine.get("start") else []
        states = machine.setdefault("states", [])
        self._return_to(states, ends, [one.get("states", []) for one in known], phrase("state"))

    def _return_to(
        self, there: list[Data], needed: Iterable[str], known: Iterable[list[Data]], kind: str
    ) -> None:
        gone = dict.fromkeys(needed)
        for one in there:
            gone.pop(one["id"], None)
        before = {one["id"]: one for some in known for one in some}
        for ident in gone:
            if ident in before:
                there.append(before[ident])
                self.kept.append(
                    phrase(
                        "{kind} '{name}': removed on one side and used on the other; kept",
                        kind=kind,
                        name=before[ident]["name"],
                    )
                )


def _united(base: list[Any], mine: list[Any], theirs: list[Any]) -> list[Any]:
    """Return what neither side removed and what either side added, each once."""
    gone = [x for x in base if x not in mine or x not in theirs]
    return [x for x in dict.fromkeys([*theirs, *mine]) if x not in gone]


def _apart_within(base: Any, mine: list[Data], theirs: Any) -> list[Data]:
    """Return mine with other ids for what both sides added under one id to a list that has its own ids."""
    known = {x["id"] for x in base} if base is not _GONE else set()
    others = {x["id"]: x for x in theirs} if theirs is not _GONE else {}
    taken = {*known, *others, *(x["id"] for x in mine)} if mine is not _GONE else set()
    out = []
    for one in mine if mine is not _GONE else ():
        ident = one["id"]
        if ident not in known and others.get(ident, one) != one:
            letter = ident.rstrip("0123456789") or "r"
            ident = next(i for n in count(1) if (i := f"{letter}{n}") not in taken)
            taken.add(ident)
        out.append({**one, "id": ident})
    return out


def _called(key: str, *sides: Mapping[str, Any]) -> str:
    """Return the name of what stands under a key, the key where it has none."""
    found = next((side[key] for side in sides if key in side), None)
    name = found.get("name") if isinstance(found, Mapping) else None
    return name if isinstance(name, str) and name else key


def _shown(value: Any) -> str:
    """Return a value as a report shows it; "" for one that is too long."""
    if value is _GONE:
        return phrase("the default")
    if isinstance(value, Mapping):
        text = ", ".join(f"{k.replace('_', ' ')} {_shown(v)}" for k, v in value.items())
        return text if 0 < len(text) <= _LONGEST else ""
    if isinstance(value, list):
        text = ", ".join(map(_shown, value))
        return text if 0 < len(text) <= _LONGEST else ""
    if isinstance(value, str):
        return f"'{value}'" if len(value) <= _LONGEST else ""
    if value is None or isinstance(value, bool):
        return phrase("none") if value is None else phrase("on") if value else phrase("off")
    return str(value)
