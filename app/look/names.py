"""How actions and clips are called where the place says the rest: without their stance in front."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

from app.look.plural import split_name, split_name_at, strip_stance
from metagraph.graph.model import KINDS, Action, Kind, Layer, Limb, MetaGraph, Project

MANY = 1 << 14  # names that are remembered, with what is made of them: after each edit all are asked for
_TAKE = re.compile(r"[\s.#(-]*\d+\)?$")  # the number of a take, at a name's end
_MARK = re.compile(r"[\s_@|:.#]+")  # between the words of a name
_LETTER = re.compile(r"[^\W\d_]")
_SIDES: Mapping[str, tuple[Limb, str]] = {
    **dict.fromkeys(("left", "l", "lf", "lft"), ("left", "L")),
    **dict.fromkeys(("right", "r", "rt", "rgt"), ("right", "R")),
    **dict.fromkeys(("both", "bt"), ("both", "")),
}


def make_readable_name(name: str, stance: str = "", limb: Limb | None = None) -> str:
    """Return a name as it is read: without its stance's in front, blanks for underscores. limb: the arm that
    moves; a word for that very arm becomes L or R, and one for both is left out.
    """
    words = strip_stance(name, stance).replace("_", " ").split() if stance else name.replace("_", " ").split()
    if limb is not None and len(words) > 1:
        sides = ((w, _SIDES.get(w.lower())) for w in words)
        words = [w if side is None or side[0] != limb else side[1] for w, side in sides]
    return " ".join(w for w in words if w) or name


@lru_cache(maxsize=MANY)
def _without_take(name: str) -> str:
    return _TAKE.sub("", name).strip() or name


def tell_apart(names: Sequence[str]) -> list[str]:
    """Return names that stand together without the numbers of their takes, where they differ without."""
    bare = [_without_take(name) for name in names]
    count = Counter(bare)
    return [short_ if count[short_] == 1 else name for name, short_ in zip(names, bare, strict=True)]


def _shared(project: Project, action: Action) -> int:
    """Return how many words all names on an action's stance begin with alike, its loop's among them: a stance
    may be called after its loop.
    """
    graph = project.graphs[action.layer]
    if not graph.of(action.stance, "stance"):
        return 0
    names = [split_name(a.name) for kind in KINDS for a in graph.of(action.stance, kind)]
    alike = 0
    for words in zip(*names, strict=False):
        if len(set(words)) > 1:
            break
        alike += 1
    return min(alike, min(map(len, names)) - 1) if len(names) > 1 else 0


def _row_name(name: str, stance: str, shared: int, limb: Limb | None) -> str:
    """Return a name as it is read without its stance's in front, or else without the words that all on the
    stance share.
    """
    out = strip_stance(name, stance)
    return _read(name[split_name_at(name)[shared][1] :] if out == name and shared > 0 else out, limb)


@lru_cache(maxsize=MANY)
def _read(name: str, limb: Limb | None) -> str:
    return make_readable_name(name, "", limb)


def name_rows(project: Project, actions: Iterable[Action]) -> dict[str, str]:
    """Return by id how the actions of one node are called in it: transitions by where they lead."""
    some = tuple(actions)
    told: list[str] = []
    shared = _shared(project, some[0]) if some else 0
    called = {s.id: s.name for graph in project.graphs.values() for s in graph.stances.values()}
    for action in some:
        limb, stance = action.limb if action.layer == "arms" else None, called.get(action.stance)
        name = (
            make_readable_name(action.name, "", limb)
            if stance is None
            else _row_name(action.name, stance, shared, limb)
        )
        if action.kind == "transition":
            end = project.stance(action.end_stance)
            name = end.name if end is not None else f"?  {name}"
        told.append(name)
    if any(a.kind == "transition" for a in some):  # several ways to one stance go by their own names
        ways = Counter(told)
        told = [
            name if ways[name] == 1 else f"{name}: {make_readable_name(a.name)}"
            for name, a in zip(told, some, strict=True)
        ]
    # The number of a stance is no take's.
    bare = [
        whole if a.kind == "transition" else name
        for a, whole, name in zip(some, told, tell_apart(told), strict=True)
    ]
    return {a.id: name for a, name in zip(some, bare, strict=True)}


def describe_name_in_tooltip(words: str, name: str) -> str:
    """Return what a tooltip says of something called `words` in its place: that, and its name if that is
    another.
    """
    return words if words == name else f"{words}\n{name}"


@dataclass
class _Kept:
    """Names of a node's rows, the graph they were made for last, and all they were made of."""

    graph: MetaGraph
    of: tuple[Any, ...]
    names: dict[str, str]


_KEPT: dict[tuple[Layer, str, Kind], _Kept] = {}


def name_node_rows(project: Project, layer: Layer, stance: str, kind: Kind) -> dict[str, str]:
    """Return `name_rows` of a node, made again only where what is called there is."""
    graph, key = project.graphs[layer], (layer, stance, kind)
    kept = _KEPT.get(key)
    if kept is not None and kept.graph is graph:
        return kept.names
    called = tuple((s.id, s.name) for s in graph.stances.values())
    groups = tuple(graph.of(stance, k) for k in KINDS)
    if kept is not None and _called_alike(kept.of, called, groups):
        kept.graph, kept.of = graph, (called, groups)
        return kept.names
    if len(_KEPT) >= 64:
        _KEPT.clear()
    _KEPT[key] = _Kept(graph, (called, groups), name_rows(project, graph.of(stance, kind)))
    return _KEPT[key].names


def _called_alike(
    kept: tuple[Any, ...], called: tuple[tuple[str, str], ...], groups: tuple[tuple[Action, ...], ...]
) -> bool:
    """Return whether stances and actions are called as they were."""
    if kept[0] != called:
        return False
    for before, after in zip(kept[1], groups, strict=True):
        if before is after:
            continue
        if len(before) != len(after):
            return False
        for a, b in zip(before, after, strict=True):
            if a is not b and (a.id, a.name, a.limb, a.end_stance) != (b.id, b.name, b.limb, b.end_stance):
                return False
    return True


def drop_common_start(names: Sequence[str]) -> list[str]:
    """Return names without what all of them begin with, up to the last mark between words
    ("ChrRachel_ChrBrad@Idle01" is "Idle01" among others of that set).
    """
    first, last = min(names, default=""), max(names, default="")
    alike = next((n for n, (a, b) in enumerate(zip(first, last, strict=False)) if a != b), len(first))
    start = first[:alike] if len(names) > 1 else ""
    marks = [found.end() for found in _MARK.finditer(start)]
    fits = (n for n in reversed(marks) if all(_LETTER.search(name[n:]) for name in names))  # no bare numbers
    cut = next(fits, 0)
    return [name[cut:] for name in names]
