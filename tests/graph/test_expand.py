"""The expanded state machine: its size, its connections, the chains of transitions in it."""

from __future__ import annotations

from typing import Any

import pytest

from metagraph.graph import edits
from metagraph.graph.expand import (
    Size,
    count_machine_size,
    find_chain,
    find_end_stance,
    find_reachable,
    list_connections,
)
from metagraph.graph.model import LAYERS, MetaGraph, Project

pytestmark = pytest.mark.usefixtures("numbered_ids")


def listed(project: Project) -> int:
    return sum(1 for layer in LAYERS for _ in list_connections(project, project.graphs[layer]))


def test_an_empty_project_is_an_empty_machine() -> None:
    assert count_machine_size(Project()) == Size(0, 0, 0)
    assert list(list_connections(Project(), MetaGraph("arms"))) == []


def test_a_lone_loop_is_connected_to_nothing(toy: Any) -> None:
    project = edits.add_stance(
        edits.add_clips(Project(), [("a.glb", 0, "", toy.clip("a"))]), "arms", "rest", ["c1"]
    )
    assert count_machine_size(project) == Size(1, 1, 0)


def test_two_loops_lead_to_each_other_but_not_to_themselves(toy: Any) -> None:
    project = edits.add_stance(
        edits.add_clips(Project(), [("a.glb", 0, "", toy.clip("a"))]), "arms", "rest", ["c1", "c1"]
    )
    assert count_machine_size(project) == Size(1, 2, 2)


def test_the_size_is_what_listing_every_connection_gives(toy: Any, sample: Project) -> None:
    for project in (toy.project(), sample):
        assert count_machine_size(project).connections == listed(project)
        for layer in LAYERS:
            assert count_machine_size(project, layer).connections == len(
                list(list_connections(project, project.graphs[layer]))
            )
    assert count_machine_size(sample) == Size(152, 152, listed(sample))


def test_broken_projects_are_counted_like_they_are_listed(toy: Any) -> None:
    project = toy.project()
    graph = project.graphs["arms"]
    no_end = edits.update_actions(project, [toy.id(project, "rest to up")], end_stance=None)
    gone = edits.update_actions(project, [toy.id(project, "rest to up")], end_stance="s999")
    itself = edits.update_actions(
        project, [toy.id(project, "rest to up")], end_stance=toy.id(project, "rest")
    )
    lost = project.with_graph(graph.but(stances={i: s for i, s in graph.stances.items() if s.name != "up"}))
    for broken in (no_end, gone, lost):
        assert count_machine_size(broken).connections == listed(broken)
    assert count_machine_size(itself).connections == listed(itself)


def test_one_stance_is_counted_with_what_starts_or_ends_in_it(toy: Any) -> None:
    project = toy.project()
    far = toy.id(project, "far")
    assert count_machine_size(project, "arms", far) == Size(3, 3, 4)  # its loop, the way in, the way out


def test_an_action_leads_to_everything_in_the_stance_it_ends_in(toy: Any) -> None:
    project = toy.project()
    way = toy.id(project, "up to far")
    out = [c for c in list_connections(project, project.graphs["arms"]) if c.source == way]
    assert [project.action(c.target).name for c in out] == ["far loop", "far to up"]
    assert out[0].leave == pytest.approx(0.8) and out[0].blend == project.action(way).timing.blend_out
    assert out[1].blend == project.action(out[1].target).timing.blend_in


def test_a_stance_may_be_left_at_any_time_and_an_action_from_its_earliest_exit(toy: Any) -> None:
    project = toy.project()
    beat = toy.id(project, "up beat")
    project = edits.update_actions(project, [beat], timing={"earliest_exit": 0.4})
    leave = {c.source: c.leave for c in list_connections(project, project.graphs["arms"])}
    assert leave[beat] == 0.4 and leave[toy.id(project, "up loop")] is None


def test_the_shortest_chain_is_found_and_none_where_there_is_no_way(toy: Any) -> None:
    project = toy.project()
    graph = project.graphs["arms"]
    rest, up, far = (toy.id(project, name) for name in ("rest", "up", "far"))
    assert find_chain(graph, rest, rest) == ()
    assert find_chain(graph, rest, up) == (up,)
    assert find_chain(graph, rest, far) == (up, far)
    short = edits.place_clips(project, ["c1"], "arms", "transition", rest, far).graphs["arms"]
    assert find_chain(short, rest, far) == (far,)
    cut = edits.remove_actions(project, [toy.id(project, "up to far")]).graphs["arms"]
    assert find_chain(cut, rest, far) is None and find_chain(cut, far, rest) == (up, rest)


def test_of_two_ways_as_short_the_first_placed_is_taken(toy: Any) -> None:
    project = edits.add_stance(toy.project(), "arms", "other")
    rest, far, other = (toy.id(project, name) for name in ("rest", "far", "other"))
    project = edits.place_clips(project, ["c1"], "arms", "transition", rest, other)
    project = edits.place_clips(project, ["c1"], "arms", "transition", other, far)
    assert find_chain(project.graphs["arms"], rest, far) == (toy.id(project, "up"), far)


def test_what_can_be_reached_follows_transitions_whose_end_exists(toy: Any) -> None:
    project = toy.project()
    graph = project.graphs["arms"]
    assert find_reachable(graph, toy.id(project, "rest")) == frozenset(graph.stances)
    lost = edits.update_actions(project, [toy.id(project, "rest to up")], end_stance="s999").graphs["arms"]
    assert find_reachable(lost, toy.id(project, "rest")) == {toy.id(project, "rest")}


def test_only_a_transition_ends_elsewhere(toy: Any) -> None:
    project = toy.project()
    assert find_end_stance(project.action(toy.id(project, "up yawn"))) == toy.id(project, "up")
    assert find_end_stance(project.action(toy.id(project, "up to far"))) == toy.id(project, "far")
