"""Find actions and stances by id or name."""

from __future__ import annotations

from collections.abc import Sequence

from metagraph.graph.model import Action, Layer, MetaGraph, Stance


def action_called(graphs: Sequence[MetaGraph], word: str, layer: Layer | None) -> Action | None:
    """Return the action with an id or, failing that, with a name; of several with the same name, the
    likeliest. layer: None for any.
    """
    for graph in graphs:
        found = graph.actions.get(word)
        if found is not None and (layer is None or layer == graph.layer):
            return found
    best: Action | None = None
    for graph in graphs:
        if layer is None or layer == graph.layer:
            for action in graph.actions.values():
                if action.name == word and (best is None or action.likelihood > best.likelihood):
                    best = action
    return best


def stance_called(graphs: Sequence[MetaGraph], word: str, layer: Layer | None) -> Stance | None:
    """Return the stance with an id or, failing that, with a name, in the first layer that has one."""
    for graph in graphs:
        if layer is None or layer == graph.layer:
            found = graph.stances.get(word)
            if found is not None:
                return found
            for stance in graph.stances.values():
                if stance.name == word:
                    return stance
    return None
