"""Stances of several layers that are one posture."""

from __future__ import annotations

from metagraph.graph import edits
from metagraph.graph.same_stances import find_same_stances


def with_body(toy):
    """The toy on the arms, and three stances of the body."""
    project = toy.project()
    for name in ("Rest", "low", "high"):
        project = edits.add_stance(project, "body", name)
    return project


def test_stances_of_one_name_are_one_posture_whatever_the_case(toy):
    project = with_body(toy)
    same = find_same_stances(project, "arms")
    assert {project.stance(i).name: [s.name for s in found] for i, found in same.items()} == {
        "rest": ["Rest"]
    }
    back = find_same_stances(project, "body")
    assert [[s.layer for s in found] for found in back.values()] == [["arms"]]


def test_stances_that_the_same_clips_lead_to_and_away_from_always_change_together(toy):
    project = with_body(toy)
    low, high = toy.id(project, "low"), toy.id(project, "high")
    clip = {e.name: e.id for e in project.clips.values()}
    for name, start, end in (("up to far", low, high), ("far to up", high, low)):
        project = edits.place_clips(project, [clip[name]], "body", "transition", start, end)
    assert low not in find_same_stances(project, "body"), "up is left and reached by other clips, too"
    others = [
        a.id
        for a in project.graphs["arms"].actions.values()
        if a.kind == "transition" and a.name not in ("up to far", "far to up")
    ]
    project = edits.remove_actions(project, others)
    same = find_same_stances(project, "body")
    assert {project.stance(i).name: [s.name for s in f] for i, f in same.items()} == {
        "Rest": ["rest"],
        "low": ["up"],
        "high": ["far"],
    }


def test_stances_without_transitions_are_not_the_same_for_that(toy):
    project = edits.add_stance(edits.add_stance(toy.project(), "body", "low"), "head", "straight")
    assert not find_same_stances(project, "body")
