"""Automatic layout: states in columns by how many links they are from the start, each beside what it is
joined to.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import ceil, sqrt

from metagraph.graph.manual.machine import ANY, Manual

ACROSS, DOWN = 280.0, 92.0  # units from one node to the next
SWEEPS = 6


def arrange_nodes(manual: Manual) -> Mapping[str, tuple[float, float]]:
    """Return where every node goes, ANY among them: x, y of its left upper corner.

    A column that would grow tall is broken into several. Within columns nodes stand at the mean height of
    those they are joined to (barycentres, swept back and forth), so that arrows cross less.
    """
    columns = _columns(manual)
    joined: dict[str, list[str]] = {i: [] for i in manual.states}
    for link in manual.links.values():
        if link.source in joined and link.target in joined and link.source != link.target:
            joined[link.source].append(link.target)
            joined[link.target].append(link.source)
    group = {s: n for n, a in enumerate(manual.aliases.values()) if not a.every for s in manual.members(a)}
    height: dict[str, float] = {}
    for column in columns:
        column.sort(key=lambda s: group.get(s, len(group)))  # what an alias stands for stands together
        _stand(column, height)
    for sweep in range(SWEEPS):
        for column in columns if sweep % 2 else reversed(columns):
            heights = dict(height)

            def mean(ident: str, at: Mapping[str, float] = heights) -> float:
                near = joined[ident]
                return sum(at[n] for n in near) / len(near) if near else at[ident]

            column.sort(key=mean)
            _stand(column, height)
    tallest = max(4, ceil(sqrt(len(manual.states) * 1.6)))
    out: dict[str, tuple[float, float]] = {}
    x = 0.0
    for column in columns:
        parts = [column[n : n + tallest] for n in range(0, len(column), tallest)]
        for part in parts:
            top = -(len(part) - 1) / 2 * DOWN
            for n, ident in enumerate(part):
                out[ident] = (round(x), round(top + n * DOWN))
            x += ACROSS
        x += 60 if len(parts) > 1 else 0
    left = min((y for _, y in out.values()), default=0.0)
    out[ANY] = (0.0, round(left - DOWN))
    middle = {a.id: _mean([out[s][1] for s in manual.members(a)]) for a in manual.aliases.values()}
    top = -(len(middle) - 1) / 2 * DOWN
    for n, ident in enumerate(sorted(middle, key=lambda i: middle[i])):
        out[ident] = (-ACROSS, round(top + n * DOWN))
    return out


def _mean(values: Sequence[float]) -> float:
    return sum(values) / len(values) if values else 0.0


def _columns(manual: Manual) -> list[list[str]]:
    """Return the states by their distance from the start; those that cannot be reached come after all
    others.
    """
    depth: dict[str, int] = {}
    if manual.start in manual.states:
        _walk(manual, manual.start or "", 0, depth)
    last = max(depth.values(), default=-1) + 1
    for entered in (False, True):  # those that nothing leads to draw the others after them
        for state in manual.states:
            if entered or not manual.entering(state):
                _walk(manual, state, last, depth)
    columns: list[list[str]] = [[] for _ in range(max(depth.values(), default=-1) + 1)]
    for ident, n in depth.items():
        columns[n].append(ident)
    return [c for c in columns if c]


def _walk(manual: Manual, first: str, at: int, depth: dict[str, int]) -> None:
    """Give a state and all that can be reached from it their distances, those they have not yet."""
    if first in depth or first not in manual.states:
        return
    depth[first] = at
    queue = [first]
    for state in queue:
        for link in manual.leaving(state):
            if link.target not in depth:
                depth[link.target] = depth[state] + 1
                queue.append(link.target)


def _stand(column: Sequence[str], height: dict[str, float]) -> None:
    for n, ident in enumerate(column):
        height[ident] = n - (len(column) - 1) / 2
