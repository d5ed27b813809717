"""The ordinary state machine a meta-graph stands for: what an animator would have had to draw by hand.

A state is an action. An action that ends in a stance connects to every action that starts in it: to its
loops, its gestures and fidgets, and the transitions that leave it.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import field

from metagraph.graph.model import KINDS, LAYERS, Action, Layer, MetaGraph, Project
from metagraph.records import dataclass


@dataclass(frozen=True, slots=True)
class Connection:
    """source, target: action ids. leave: clip seconds of the source at which it may be left, None for at any
    time. blend: seconds.
    """

    source: str
    target: str
    leave: float | None
    blend: float


@dataclass(frozen=True)
class Size:
    """How large the expanded machine is; `clips` counts the different clips that were placed."""

    clips: int
    states: int
    connections: int


def ends_in(action: Action) -> str | None:
    """Return the stance an action leaves the layer in."""
    return action.end_stance if action.kind == "transition" else action.stance


def size(project: Project, layer: Layer | None = None, stance: str | None = None) -> Size:
    """Count states and connections without listing them; for one layer, or for what starts or ends in one
    stance.
    """
    clips: set[str] = set()
    states = connections = 0
    for graph in (project.graphs[layer],) if layer else tuple(project.graphs[x] for x in LAYERS):
        arriving: Counter[str] = Counter()
        leaving: Counter[str] = Counter()
        itself = 0
        # Whole nodes are counted rather than their actions: the window asks after each edit.
        for (start, kind), bucket in graph.index.items():
            if kind == "transition" or stance is not None:
                bucket = tuple(a for a in bucket if stance is None or stance in (a.stance, ends_in(a)))
            if stance is not None:
                clips.update(a.clip for a in bucket)
            states += len(bucket)
            leaving[start] += len(bucket)
            ends = (
                Counter(e for a in bucket if (e := ends_in(a)) is not None)
                if kind == "transition"
                else Counter({start: len(bucket)})
            )
            for end, count in ends.items():
                if end in graph.stances:
                    arriving[end] += count
                    itself += count if end == start else 0
        if stance is None:
            clips.update(graph.uses)
        connections += sum(n * leaving[s] for s, n in arriving.items()) - itself
    return Size(len(clips), states, connections)


@dataclass(slots=True)
class Columns:
    """Connections in columns: number n leads from action `sources[n]` to `targets[n]`, places in
    `MetaGraph.actions`. leave: as of `Connection`, -1 for at any time.
    """

    sources: list[int] = field(default_factory=list)
    targets: list[int] = field(default_factory=list)
    leave: list[float] = field(default_factory=list)
    blend: list[float] = field(default_factory=list)


def columns(project: Project, graph: MetaGraph) -> Columns:
    """Return every connection of a layer: sources in the order they were placed, each with its targets in
    that order. Nodes are gone through, not single connections: of those there may be millions.
    """
    out = Columns()
    place = {ident: n for n, ident in enumerate(graph.actions)}
    nodes: dict[str, tuple[list[int], list[float], int]] = {}  # stance -> targets, blends, how many are loops
    for number, source in enumerate(graph.actions.values()):
        end = ends_in(source)
        if end is None or end not in graph.stances:
            continue
        if end not in nodes:
            node = [t for kind in KINDS for t in graph.of(end, kind)]
            loops = len(graph.of(end, "stance"))
            nodes[end] = [place[t.id] for t in node], [t.timing.blend_in for t in node], loops
        targets, blends, loops = nodes[end]
        targets, blends = targets[:], [source.timing.blend_out] * loops + blends[loops:]
        if source.stance == end:
            itself = targets.index(number)
            del targets[itself], blends[itself]
        leave = -1.0
        if source.kind != "stance":
            exit_at = source.timing.earliest_exit
            leave = project.span(source)[1] if exit_at is None else exit_at
        out.sources += [number] * len(targets)
        out.targets += targets
        out.leave += [leave] * len(targets)
        out.blend += blends
    return out


def connections(project: Project, graph: MetaGraph) -> Iterator[Connection]:
    """Yield every connection of a layer, in the order of `columns`."""
    idents, found = list(graph.actions), columns(project, graph)
    for source, target, leave, blend in zip(
        found.sources, found.targets, found.leave, found.blend, strict=True
    ):
        yield Connection(idents[source], idents[target], None if leave < 0 else leave, blend)


def chain(graph: MetaGraph, start: str, goal: str) -> tuple[str, ...] | None:
    """Return the stances after `start` on the shortest way of transitions to `goal`; () if already there,
    None if there is no way.

    Among equally short ways the one whose transitions were placed first is taken.
    """
    if start == goal:
        return ()
    before: dict[str, str] = {start: start}
    queue = [start]
    for stance in queue:
        for action in graph.of(stance, "transition"):
            end = action.end_stance
            if end is None or end in before or end not in graph.stances:
                continue
            before[end] = stance
            if end == goal:
                way = [end]
                while before[way[-1]] != start:
                    way.append(before[way[-1]])
                return tuple(reversed(way))
            queue.append(end)
    return None


def reachable(graph: MetaGraph, start: str) -> frozenset[str]:
    """Return the stances that transitions lead to from `start`, itself included."""
    seen = {start}
    queue = [start]
    for stance in queue:
        for action in graph.of(stance, "transition"):
            end = action.end_stance
            if end is not None and end in graph.stances and end not in seen:
                seen.add(end)
                queue.append(end)
    return frozenset(seen)
