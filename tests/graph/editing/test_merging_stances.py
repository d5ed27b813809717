"""Two stances made one: everything is that stance's, and whatever asked for the other asks for it."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from metagraph.graph import edits
from metagraph.graph.check import check_project
from metagraph.graph.edit_error import EditError
from metagraph.graph.editing.merging_stances import merge_stances
from metagraph.graph.model import Project
from metagraph.graph.requests import Go, Line, Performance
from tests.conftest import Toy

TOY = Toy()
TOYS = TOY.project()
STANCES = list(TOYS.graphs["arms"].stances)


@given(st.permutations(STANCES).map(lambda x: x[:2]))
def test_every_action_but_the_ways_between_the_two_is_kept_and_is_the_others(two: list[str]) -> None:
    merged, into = two
    after = merge_stances(TOYS, merged, into)
    before, graph = TOYS.graphs["arms"], after.graphs["arms"]
    assert list(graph.stances) == [s for s in STANCES if s != merged] and graph.start in graph.stances
    # A transition that leads from a stance to itself is odd, and not the merge's to remove.
    between = {
        a.id
        for a in before.actions.values()
        if a.kind == "transition" and {a.stance, a.end_stance} == set(two)
    }
    assert set(graph.actions) == set(before.actions) - between
    for ident, action in graph.actions.items():
        old = before.actions[ident]
        assert action == replace(
            old,
            stance=into if old.stance == merged else old.stance,
            end_stance=into if old.end_stance == merged else old.end_stance,
        )
    assert not [p for p in check_project(after) if p.severity == "error"]


def test_the_start_follows(toy: Any) -> None:
    project = edits.set_start_stance(toy.project(), toy.id(toy.project(), "far"))
    after = merge_stances(project, toy.id(project, "far"), toy.id(project, "rest"))
    assert after.graphs["arms"].start == toy.id(project, "rest")


def test_requests_for_the_merged_stance_are_for_the_other(toy: Any) -> None:
    project: Project = toy.project()
    up, rest, far = (toy.id(project, name) for name in ("up", "rest", "far"))
    asks = (
        Go(id="a", stance=up),
        Go(id="b", stance="up"),
        Go(id="c", stance=far),
        Go(id="d", stance=up, layer="body"),
    )
    project = replace(
        project,
        performances={"p1": Performance(name="p", asks=asks, stances={"arms": up, "body": up})},
        lines={"l1": Line(asks=asks)},
    )
    after = merge_stances(project, up, rest)
    performance = after.performances["p1"]
    assert [ask.stance for ask in performance.asks if isinstance(ask, Go)] == [rest, rest, far, up]
    assert after.lines["l1"].asks == performance.asks
    assert performance.stances == {"arms": rest, "body": up}, "the other layer's stance is another"


def test_a_name_that_means_another_layers_stance_goes_on_meaning_it(toy: Any) -> None:
    project = edits.add_stance(toy.project(), "body", "up")
    up, rest = toy.id(toy.project(), "up"), toy.id(toy.project(), "rest")
    asks = (Go(id="a", stance="up"), Go(id="b", stance="up", layer="arms"))
    project = replace(project, lines={"l1": Line(asks=asks)})
    after = merge_stances(project, up, rest).lines["l1"].asks
    assert [ask.stance for ask in after if isinstance(ask, Go)] == ["up", rest], "the body's comes first"


def test_a_transition_of_a_third_stance_to_itself_stays(toy: Any) -> None:
    project = toy.project()
    way, far = toy.id(project, "up to far"), toy.id(project, "far")
    graph = project.graphs["arms"]
    round_trip = replace(graph.actions[way], stance=far, end_stance=far)
    project = project.with_graph(graph.with_actions({way: round_trip}))
    assert merge_stances(project, toy.id(project, "up"), toy.id(project, "rest")).action(way) == round_trip


def test_what_is_no_pair_of_stances_of_one_layer_is_refused(toy: Any) -> None:
    project = edits.add_stance(toy.project(), "body", "stand")
    up, stand = toy.id(project, "up"), toy.id(project, "stand")
    for two in ((up, up), (up, "s99"), ("s99", up), (up, stand)):
        with pytest.raises(EditError, match="two stances of one layer"):
            merge_stances(project, *two)
