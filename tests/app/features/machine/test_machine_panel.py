"""Where the states of the expanded machine are drawn."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QRectF

from app.features.machine.machine_panel import arrange_states
from metagraph.graph import edits
from metagraph.graph.model import MetaGraph

AREAS = [(280, 240), (400, 700), (900, 300), (900, 900), (1600, 1000)]


@pytest.mark.parametrize("area", AREAS)
def test_every_state_is_drawn_once_and_inside(toy, sample, area):
    rect = QRectF(0, 0, *area)
    many = toy.project()
    for n in range(8):
        many = edits.add_stance(many, "arms", f"more {n}", list(many.clips)[:1])
    many = edits.place_clips(many, list(many.clips) * 8, "arms", "gesture", toy.id(many, "far"))
    graphs = [toy.project().graphs["arms"], many.graphs["arms"], *sample.graphs.values()]
    for graph in graphs:
        found = arrange_states(graph, rect)
        assert set(found) == set(graph.actions)
        for ident, at in found.items():
            assert rect.contains(at), f"{graph.actions[ident].name} at {at} is outside {rect}"


def test_nothing_has_no_places():
    assert arrange_states(MetaGraph("arms"), QRectF(0, 0, 400, 400)) == {}


def test_a_transition_to_nowhere_or_from_a_stance_without_a_loop_is_left_out(toy):
    project = toy.project()
    project = edits.remove_actions(project, [toy.id(project, "far loop")])
    graph = project.graphs["arms"]
    loops = [a.id for a in graph.actions.values() if a.name == "far loop"]
    project = edits.remove_actions(project, loops)
    found = arrange_states(project.graphs["arms"], QRectF(0, 0, 500, 500))
    gone = {project.graphs["arms"].actions[i].name for i in project.graphs["arms"].actions if i not in found}
    assert gone == {"up to far", "far to up"}
