"""Find stances of several layers that are one posture, so that they can be shown and chosen as one."""

from __future__ import annotations

from collections.abc import Mapping

from metagraph.graph.model import LAYERS, Layer, MetaGraph, Project, Stance

_Ways = tuple[
    frozenset[str], frozenset[str]
]  # clips of the transitions that leave a stance, and that end in it


def find_same_stances(project: Project, layer: Layer) -> Mapping[str, tuple[Stance, ...]]:
    """Return for each stance of a layer, by id, the stances of other layers that are the same posture, at
    most
    one a layer, in the order of the layers. Stances without any are left out.

    Two are the same if they have the same name, in any case, or if the same clips lead to both and away from
    both: then they always change together.
    """
    graph, out = project.graphs[layer], {}
    others = [_Known(project.graphs[x]) for x in LAYERS if x != layer and project.graphs[x].stances]
    if not others:
        return {}
    for stance in graph.stances.values():
        same = tuple(found for other in others if (found := other.find(stance, graph)) is not None)
        if same:
            out[stance.id] = same
    return out


class _Known:
    """The stances of a layer by their names and by their transitions."""

    def __init__(self, graph: MetaGraph) -> None:
        self.named = {s.name.casefold(): s for s in reversed(tuple(graph.stances.values()))}
        self.moved = {_find_ways(graph, s.id): s for s in reversed(tuple(graph.stances.values()))}

    def find(self, stance: Stance, graph: MetaGraph) -> Stance | None:
        ways = _find_ways(graph, stance.id)
        return self.named.get(stance.name.casefold()) or (self.moved.get(ways) if any(ways) else None)


def _find_ways(graph: MetaGraph, stance: str) -> _Ways:
    leaving = frozenset(a.clip for a in graph.of(stance, "transition"))
    return leaving, frozenset(a.clip for a in graph.into.get(stance, ()))
