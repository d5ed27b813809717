"""Edit: make two stances one."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import msgspec

from metagraph.common.wording import phrase
from metagraph.graph.edit_error import EditError
from metagraph.graph.editing.half_labels import follow_stance_name
from metagraph.graph.edits import remove_stance, set_start_stance
from metagraph.graph.model import LAYERS, Action, Project
from metagraph.graph.requests import AnyRequest, Go


def merge_stances(project: Project, merged: str, into: str) -> Project:
    """Return the project with the stance `merged` made part of `into`, both by id: its loops, gestures,
    fidgets and transitions are that stance's, and requests for it are for that stance.

    Transitions between the two are removed, because nothing is left for them to do. Raises EditError for
    stances that are not there, are the same or are on different layers.
    """
    before, gone, kept = project, project.stance(merged), project.stance(into)
    if gone is None or kept is None or gone.layer != kept.layer or merged == into:
        raise EditError(phrase("only two stances of one layer can be merged"))
    graph = project.graphs[kept.layer]
    changes: dict[str, Action | None] = {}
    for action in graph.actions.values():
        start = into if action.stance == merged else action.stance
        end = into if action.end_stance == merged else action.end_stance
        if action.kind == "transition" and {action.stance, action.end_stance} == {merged, into}:
            changes[action.id] = None
        elif (start, end) != (action.stance, action.end_stance):
            changes[action.id] = replace(action, stance=start, end_stance=end)
    starts_there = graph.start == merged
    project = project.with_graph(graph.with_actions(changes))
    project = remove_stance(project, merged)
    if starts_there:
        project = set_start_stance(project, into)

    def means_merged(ask: Go) -> bool:
        """Return whether a request's stance, by id or name, is the merged one."""
        layers = [layer for layer in LAYERS if ask.layer in (None, layer)]
        named = [
            s.id for layer in layers for s in before.graphs[layer].stances.values() if s.name == ask.stance
        ]
        return ask.layer in (None, kept.layer) and (ask.stance == merged or named[:1] == [merged])

    def renamed(asks: Iterable[AnyRequest]) -> tuple[AnyRequest, ...]:
        return tuple(
            msgspec.structs.replace(ask, stance=into) if isinstance(ask, Go) and means_merged(ask) else ask
            for ask in asks
        )

    names = {merged: into, gone.name: into}
    performances = {
        ident: msgspec.structs.replace(
            p,
            asks=renamed(p.asks),
            stances={layer: names.get(s, s) if layer == kept.layer else s for layer, s in p.stances.items()},
        )
        for ident, p in project.performances.items()
    }
    lines = {i: msgspec.structs.replace(line, asks=renamed(line.asks)) for i, line in project.lines.items()}
    project = follow_stance_name(project, kept.layer, gone.name, kept.name)
    return replace(project, performances=performances, lines=lines)
