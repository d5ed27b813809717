"""How actions and clips are called where the place says the rest: without their stance in front, and cut so
that what tells them apart from their neighbours is still seen.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import lru_cache

from PySide6.QtGui import QFont, QFontMetricsF

from app.look.plural import parts, short
from metagraph.graph.model import KINDS, Action, Kind, Layer, Limb, MetaGraph, Project

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


def _shared(project: Project, action: Action) -> int:
    """Return how many words all names on an action's stance begin with alike, its loop's among them: a stance
    may be called after its loop.
    """
    graph = project.graphs[action.layer]
    if not graph.of(action.stance, "stance"):
        return 0
    names = [parts(a.name) for kind in KINDS for a in graph.of(action.stance, kind)]
    alike = 0
    for words in zip(*names, strict=False):
        if len({w for w, *_ in words}) > 1:
            break
        alike += 1
    return min(alike, min(map(len, names)) - 1) if len(names) > 1 else 0


def _without(name: str, stance: str, shared: int) -> str:
    """Return a name without its stance's in front, or else without the words that all on the stance share."""
    out = short(name, stance)
    return name[parts(name)[shared][1] :] if out == name and shared > 0 else out


def row_names(project: Project, actions: Iterable[Action]) -> dict[str, str]:
    """Return by id how the actions of one node are called in it: transitions by where they lead."""
    some = tuple(actions)
    told: list[str] = []
    shared = _shared(project, some[0]) if some else 0
    for action in some:
        stance, end = project.stance(action.stance), project.stance(action.end_stance)
        limb = action.limb if action.layer == "arms" else None
        name = _without(action.name, stance.name, shared) if stance is not None else action.name
        name = plain(name, "", limb)
        if action.kind == "transition":
            name = end.name if end is not None else f"?  {name}"
        told.append(name)
    if any(a.kind == "transition" for a in some):  # several ways to one stance go by their own names
        ways = Counter(told)
        told = [
            name if ways[name] == 1 else f"{name}: {plain(a.name)}"
            for name, a in zip(told, some, strict=True)
        ]
    # The number of a stance is no take's.
    bare = [
        whole if a.kind == "transition" else name
        for a, whole, name in zip(some, told, apart(told), strict=True)
    ]
    return {a.id: name for a, name in zip(some, bare, strict=True)}


def told_names(words: str, name: str) -> str:
    """Return what a tooltip says of something called `words` in its place: that, and its name where that is
    another.
    """
    return words if words == name else f"{words}\n{name}"


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


def fitting(
    text: str, width: float, measure: Callable[[str], float], others: Iterable[str] = (), sure: bool = False
) -> str:
    """Return as much of a text as a width has room for, its middle left out, or both ends. others: what
    stands beside it; what is left is to be none of theirs, where that can be. sure: "" where it cannot.
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
        return "" if sure else GAP
    alike, lost, _, head = min(found, key=lambda f: (f[0], f[1] // 3, f[2]))
    best = text[:head].rstrip() + GAP + _end(text, whole - head - lost)
    if alike:
        same, inner = _inner(text, width, measure, rivals)
        if same < alike:
            alike, best = same, inner
    return "" if sure and alike else best


def _inner(
    text: str, width: float, measure: Callable[[str], float], rivals: Sequence[str]
) -> tuple[int, str]:
    """Return the part of a text that fewest rivals have, both ends left out, after how many have it."""
    starts = {_common(text, o) for o in rivals} | {
        text.rfind(" ", 0, _common(text, o) + 1) + 1 for o in rivals
    }
    best = len(rivals) + 1, 0, ""
    for start in sorted(starts):
        end = start
        while end < len(text) and measure(GAP + text[start : end + 1] + GAP) <= width:
            end += 1
        piece = text[start:end].strip()
        if len(piece) < 2:
            continue
        alike = sum(1 for o in rivals if piece in o)
        front, back = GAP if start else "", GAP if end < len(text) else ""
        best = min(best, (alike, -len(piece), front + piece + back))
    return best[0], best[2]


def _common(one: str, other: str) -> int:
    """Return how many letters two texts begin with alike."""
    return next(
        (n for n, (a, b) in enumerate(zip(one, other, strict=False)) if a != b), min(len(one), len(other))
    )


def _end(text: str, letters: int) -> str:
    return text[len(text) - letters :].lstrip() if letters else ""


@lru_cache(maxsize=8192)
def fitted(text: str, width: int, font: str, others: tuple[str, ...] = (), sure: bool = False) -> str:
    """Return `fitting` in a font, given as `QFont.toString` does; made once."""
    return fitting(text, width, measured(font).horizontalAdvance, others, sure)


@lru_cache(maxsize=8)
def measured(font: str) -> QFontMetricsF:
    """Return the measures of a font, given as `QFont.toString` does."""
    made = QFont()
    made.fromString(font)
    return QFontMetricsF(made)
