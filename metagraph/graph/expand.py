"""The ordinary state machine a meta-graph stands for: what an animator would have had to draw by hand.

A state is an action. An action that ends in a stance connects to every action that starts in it: to its
loops, its gestures and fidgets, and the transitions that leave it.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import NamedTuple

from metagraph.graph.model import KINDS, LAYERS, Action, Layer, MetaGraph, Project


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


def find_end_stance(action: Action) -> str | None:
    """Return the stance an action leaves the layer in."""
    return action.end_stance if action.kind == "transition" else action.stance


def count_machine_size(project: Project, layer: Layer | None = None, stance: str | None = None) -> Size:
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
                bucket = tuple(
                    a for a in bucket if stance is None or stance in (a.stance, find_end_stance(a))
                )
            if stance is not None:
                clips.update(a.clip for a in bucket)
            states += len(bucket)
            leaving[start] += len(bucket)
            ends = (
                Counter(e for a in bucket if (e := find_end_stance(a)) is not None)
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


@dataclass(frozen=True, slots=True)
class ExpandedNode:
    """What an action that ends in a stance leads to: loops first. targets: places in `MetaGraph.actions`.
    blends: seconds in which each comes in; the first `loops` of them blend as their source goes out. at:
    target -> its place among them.
    """

    stance: str
    targets: tuple[int, ...]
    blends: tuple[float, ...]
    loops: int
    at: Mapping[int, int]


class Fan(NamedTuple):
    """All connections of one action. source: its place in `MetaGraph.actions`. itself: its own place among
    the node's targets, which is no connection, -1 where it is none of them. leave: as of `Connection`, -1
    for at any time. blend: seconds, into loops.
    """

    source: int
    node: ExpandedNode
    itself: int
    leave: float
    blend: float


def list_fans(project: Project, graph: MetaGraph) -> Iterator[Fan]:
    """Yield every action of a layer that leads to others, in the order they were placed. Connections are not
    gone through one by one: of those there may be millions.
    """
    place = {ident: n for n, ident in enumerate(graph.actions)}
    nodes: dict[str, ExpandedNode] = {}
    for number, source in enumerate(graph.actions.values()):
        end = find_end_stance(source)
        if end is None or end not in graph.stances:
            continue
        node = nodes.get(end)
        if node is None:
            node = nodes[end] = _node(graph, end, place)
        leave = -1.0
        if source.kind != "stance":
            exit_at = source.timing.earliest_exit
            leave = project.span(source)[1] if exit_at is None else exit_at
        itself = node.at[number] if source.stance == end else -1
        yield Fan(number, node, itself, leave, source.timing.blend_out)


def _node(graph: MetaGraph, stance: str, place: Mapping[str, int]) -> ExpandedNode:
    actions = [action for kind in KINDS for action in graph.of(stance, kind)]
    targets = tuple(place[action.id] for action in actions)
    return ExpandedNode(
        stance,
        targets,
        tuple(action.timing.blend_in for action in actions),
        len(graph.of(stance, "stance")),
        {target: n for n, target in enumerate(targets)},
    )


def list_connections(project: Project, graph: MetaGraph) -> Iterator[Connection]:
    """Yield every connection of a layer: sources in the order they were placed, each with its targets."""
    idents = list(graph.actions)
    for fan in list_fans(project, graph):
        node, source, leave = fan.node, idents[fan.source], None if fan.leave < 0 else fan.leave
        for n, target in enumerate(node.targets):
            if n != fan.itself:
                blend = fan.blend if n < node.loops else node.blends[n]
                yield Connection(source, idents[target], leave, blend)


def find_chain(graph: MetaGraph, start: str, goal: str) -> tuple[str, ...] | None:
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


def find_reachable(graph: MetaGraph, start: str) -> frozenset[str]:
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
