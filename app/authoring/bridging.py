"""Join the stances of clips that were just labelled: all of a new graph, or the new ones of one that is
there, whose own settings stay as they are.
"""

from __future__ import annotations

from dataclasses import replace

from metagraph.graph.model import LAYERS, Project
from metagraph.suggest.jumps.bridges import Bridge, bridge_all, bridge_stance


def join_labelled(
    before: Project, labelled: Project, bridge: bool = True
) -> tuple[Project, tuple[Bridge, ...]]:
    """Return a project whose clips were labelled, with bridges, if wanted, to the stances that it did not
    have `before`, and these bridges.
    """
    if not any(True for _ in before.actions()):
        return bridge_all(labelled) if bridge else (labelled, ())
    graphs = dict(labelled.graphs)
    for layer in LAYERS:
        if before.graphs[layer].stances:
            graphs[layer] = replace(graphs[layer], weights=before.graphs[layer].weights)
    labelled = replace(labelled, graphs=graphs)
    made: list[Bridge] = []
    for layer in LAYERS if bridge else ():
        new = [s for s in labelled.graphs[layer].stances if s not in before.graphs[layer].stances]
        for stance in new:
            labelled, some = bridge_stance(labelled, stance)
            made += some
    return labelled, tuple(made)
