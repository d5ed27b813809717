"""Edits of what is listed: clips once more, actions in another order within their node."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace

from metagraph.graph import ids
from metagraph.graph.model import Action, ClipEntry, Project


def duplicate_clips(project: Project, clips: Collection[str]) -> Project:
    """Add clips once more, each behind the first of it, under a name of its own and with what is on it; both
    play the same file, and can be played faster, slower or held each for itself.
    """
    taken = {e.name for e in project.clips.values()}
    out: dict[str, ClipEntry] = {}
    marks = dict(project.marks)
    for ident, entry in project.clips.items():
        out[ident] = entry
        if ident in clips:
            name = _copy_name(entry.name, taken)
            taken.add(name)
            new = ids.make_id(project, "c", entry.path, entry.take, name, more=out)
            twin = replace(entry, id=new, name=name)
            out[twin.id] = twin
            if ident in marks:
                marks[twin.id] = marks[ident]
    if len(out) == len(project.clips):
        return project
    return replace(project, clips=out, marks=marks)


def _copy_name(name: str, taken: Collection[str]) -> str:
    n, out = 2, f"{name} copy"
    while out in taken:
        out, n = f"{name} copy {n}", n + 1
    return out


def reorder_actions(project: Project, actions: Collection[str], before: str | None) -> Project:
    """List actions of one node in front of another of it, or at its end for None, in the order they have.
    Which of them plays does not change: that is drawn by their ids.
    """
    moving = [a for a in project.actions() if a.id in actions]
    if not moving or (before is not None and before in actions):
        return project
    first = moving[0]
    graph = project.graphs[first.layer]
    node = graph.of(first.stance, first.kind)
    moving = [a for a in node if a.id in actions]
    rest = [a for a in node if a.id not in actions]
    at = next((n for n, a in enumerate(rest) if a.id == before), len(rest))
    return _listed(project, node, [*rest[:at], *moving, *rest[at:]])


def reorder_stances(project: Project, stance: str, before: str | None) -> Project:
    """List a stance in front of another of its layer, or at the end for None. This does not change what
    plays.
    """
    found = project.stance(stance)
    if found is None or before == stance:
        return project
    graph = project.graphs[found.layer]
    rest = [i for i in graph.stances if i != stance]
    at = rest.index(before) if before in rest else len(rest)
    order = [*rest[:at], stance, *rest[at:]]
    if order == list(graph.stances):
        return project
    return project.with_graph(graph.but(stances={i: graph.stances[i] for i in order}))


def shift_stance(project: Project, stance: str, steps: int) -> Project:
    """List a stance a place earlier in its layer (-1) or later (1), if there is one."""
    found = project.stance(stance)
    if found is None:
        return project
    order = list(project.graphs[found.layer].stances)
    at = order.index(stance) + steps
    if not 0 <= at < len(order):
        return project
    rest = [i for i in order if i != stance]
    return reorder_stances(project, stance, rest[at] if at < len(rest) else None)


def is_listed_differently(before: Project, after: Project) -> bool:
    """Return whether two projects that are equal list their actions or stances in another order."""
    graphs = [(before.graphs[layer], after.graphs[layer]) for layer in before.graphs]
    pairs = (pair for a, b in graphs for pair in ((a.actions, b.actions), (a.stances, b.stances)))
    return any(one is not other and list(one) != list(other) for one, other in pairs)


def shift_actions(project: Project, actions: Collection[str], steps: int) -> Project:
    """List actions a place earlier in their nodes (-1) or later (1), as far as there is one; those that stand
    beside each other stay so.
    """
    nodes = dict.fromkeys((a.layer, a.stance, a.kind) for a in project.actions() if a.id in actions)
    for layer, stance, kind in nodes:
        node = project.graphs[layer].of(stance, kind)
        order = list(node)
        places = [n for n, a in enumerate(order) if a.id in actions]
        edge = 0 if steps < 0 else len(order) - 1
        for n in places if steps < 0 else reversed(places):
            if n == edge:  # it is at the end, or beside one that is
                edge -= steps
            else:
                order[n], order[n + steps] = order[n + steps], order[n]
        project = _listed(project, node, order)
    return project


def _listed(project: Project, before: tuple[Action, ...], after: list[Action]) -> Project:
    """Put a node's actions into the places that they have among all of their layer, in another order."""
    if list(before) == after:
        return project
    graph = project.graphs[before[0].layer]
    ids = {a.id for a in before}
    queue = iter(after)
    actions: dict[str, Action] = {}
    for ident, action in graph.actions.items():
        each = next(queue) if ident in ids else action
        actions[each.id] = each
    return project.with_graph(replace(graph, actions=actions))
