"""The planner without what Borer et al. do not have, for figures that are compared with theirs."""

from __future__ import annotations

from dataclasses import replace

from metagraph.graph.edits import set_settings
from metagraph.graph.model import LAYERS, Project
from metagraph.playback.planning import markov


def plan_as_in_paper(project: Project) -> Project:
    """Return a project that may repeat itself, and whose models do the same whether one talks or not."""
    models = {layer: replace(markov.model(project, layer), modes=()) for layer in LAYERS}
    return replace(set_settings(project, variety=0.0), markov=models)
