"""How actions and clips are called where the place says the rest: without their stance in front, and cut so
that what tells them apart from their neighbours is still seen.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence

from app.look.plural import short
from metagraph.graph.model import Action, Kind, Layer, Limb, MetaGraph, Project

GAP = "…"
_TAKE = re.compile(r"[\s.#(-]*\d+\)?$")  # the number of a take, at a name's end
_SIDES: Mapping[str, tuple[Limb, str]] = {
    **dict.fromkeys(("left", "l", "lf", "lft"), ("left", "L")),
    **dict.fromkeys(("right", "r", "rt", "rgt"), ("right", "R")),
    **dict.fromkeys(("both", "bt"), ("both", "")),
}


def plain(name: str, stance: str = "", limb: Limb | None = None) -> str:
    """Return a name as it is read: without its stance's in front, blanks for underscores. limb: the arm that
    moves; a word for that very arm becomes L or R, and one for both is left out.
    """
    words = short(name, stance).replace("_", " ").split() if stance else name.replace("_", " ").split()
    if limb is not None and len(words) > 1:
        sides = ((w, _SIDES.get(w.lower())) for w in words)
        words = [w if side is None or side[0] != limb else side[1] for w, side in sides]
    return " ".join(w for w in words if w) or name


def apart(names: Sequence[str]) -> list[str]:
    """Return names that stand together without the numbers of their takes, where they differ without."""
    bare = [_TAKE.sub("", name).strip() or name for name in names]
    count = Counter(bare)
    return [short_ if count[short_] == 1 else name for name, short_ in zip(names, bare, strict=True)]


def row_names(project: Project, actions: Iterable[Action]) -> dict[str, str]:
    """Return by id how the actions of one node are called in it: transitions by where they lead."""
    some = tuple(actions)
    told: list[str] = []
    for action in some:
        stance, end = project.stance(action.stance), project.stance(action.end_stance)
        limb = action.limb if action.layer == "arms" else None
        name = plain(action.name, stance.name if stance is not None else "", limb)
        if action.kind == "transition":
            name = end.name if end is not None else f"?  {name}"
        told.append(name)
    if any(a.kind == "transition" for a in some):  # several ways to one stance go by their own names
        ways = Counter(told)
        told = [
            name if ways[name] == 1 else f"{name}: {plain(a.name)}"
            for name, a in zip(told, some, strict=True)
        ]
    return {a.id: name for a, name in zip(some, apart(told), strict=True)}


_KEPT: dict[tuple[int, str, Kind], tuple[MetaGraph, dict[str, str]]] = {}  # by a graph, which it holds on to


def node_names(project: Project, layer: Layer, stance: str, kind: Kind) -> dict[str, str]:
    """Return `row_names` of a node, made once as long as its layer is as it is."""
    graph = project.graphs[layer]
    key = (id(graph), stance, kind)
    if key not in _KEPT:
        if len(_KEPT) >= 64:
            _KEPT.clear()
        _KEPT[key] = graph, row_names(project, graph.of(stance, kind))
    return _KEPT[key][1]


def fitting(text: str, width: float, measure: Callable[[str], float], others: Iterable[str] = ()) -> str:
    """Return as much of a text as a width has room for, its middle left out. others: what stands beside it;
    what is left out is chosen so that the rest is not what is left of one of them, where that can be.
    """
    if measure(text) <= width:
        return text
    if measure(GAP) > width:
        return ""
    rivals = [o for o in set(others) if o != text]
    whole = len(text)
    found: list[tuple[int, int, int, int]] = []  # collisions, letters lost, how uneven, letters in front
    tail = whole
    for head in range(whole):
        while tail and measure(text[:head].rstrip() + GAP + _end(text, tail)) > width:
            tail -= 1
        if measure(text[:head].rstrip() + GAP + _end(text, tail)) > width:
            break
        last = min(tail, whole - head - 1)
        begin, end = text[:head].rstrip(), _end(text, last)
        alike = sum(1 for o in rivals if o.startswith(begin) and o.endswith(end))
        found.append((alike, whole - head - last, abs(head - last), head))
    if not found:
        return GAP
    _, lost, _, head = min(found, key=lambda f: (f[0], f[1] // 3, f[2]))
    return text[:head].rstrip() + GAP + _end(text, whole - head - lost)


def _end(text: str, letters: int) -> str:
    return text[len(text) - letters :].lstrip() if letters else ""
