"""The line that an action is said with, known before anything is performed."""

from __future__ import annotations

from dataclasses import replace

import pytest

from metagraph.graph import edits
from metagraph.graph.requests import Fidget, Gesture, Line, Nod, Performance, Play, Say
from metagraph.playback.planning.asked_lines import AskedLine, find_asked_line
from metagraph.playback.planning.understand import lead


@pytest.fixture(scope="module")
def project(toy):
    project = toy.project()
    return edits.update_actions(project, [toy.id(project, "rest long")], tags=("unsure", "slow"))


@pytest.fixture
def action(toy, project):
    return project.action(toy.id(project, "rest long"))


def lines(project, *asks, **more):
    return replace(project, lines={"l1": Line(text="well", duration=1.0, asks=asks, **more)})


def test_without_lines_or_asks_there_is_none(project, action):
    assert find_asked_line(project, action) is None
    assert find_asked_line(lines(project), action) is None
    assert find_asked_line(lines(project, Gesture(tags=("gone",), at=0.1)), action) is None
    assert find_asked_line(lines(project, Fidget(tags=("unsure",), at=0.1)), action) is None
    assert find_asked_line(lines(project, Gesture(layer="head", at=0.1)), action) is None


def test_a_line_that_asks_for_its_tags_is_said_with_it(project, action):
    assert find_asked_line(lines(project, Gesture(tags=("unsure",), at=0.4)), action) == AskedLine("l1", -0.4)
    found = find_asked_line(lines(project, Gesture(tags=("slow", "unsure"), stroke=0.9)), action)
    assert found.at == pytest.approx(lead(project, action) - 0.9)
    assert find_asked_line(lines(project, Gesture()), action) == AskedLine("l1", 0.0), "from its beginning"


def test_the_line_that_names_it_goes_before_those_that_would_take_any(project, action):
    found = lines(project, Gesture(at=0.2))
    named = Line(text="so", asks=(Play(action=action.name, at=0.3),))
    found = replace(found, lines={**found.lines, "l2": named})
    assert find_asked_line(found, action) == AskedLine("l2", -0.3)
    assert find_asked_line(replace(found, lines={"l2": Line(asks=(Play(action="other"),))}), action) is None


def test_a_nod_is_called_or_tagged_so(toy, project):
    project = edits.add_stance(project, "head", "ahead", list(project.clips)[:1])
    stance = list(project.graphs["head"].stances)[-1]
    project = edits.place_clips(project, list(project.clips)[1:2], "head", "gesture", stance)
    head = project.graphs["head"].of(stance, "gesture")[0]
    nodding = edits.update_actions(project, [head.id], name="Agree_NOD_1")
    assert find_asked_line(lines(nodding, Nod(at=0.5)), nodding.action(head.id)) == AskedLine("l1", -0.5)
    other = edits.update_actions(project, [head.id], name="tilt")
    assert find_asked_line(lines(other, Nod(at=0.5)), other.action(head.id)) is None


def test_a_kept_performance_says_what_is_said_meanwhile_and_nothing_else(project, action):
    length = project.span(action)[1] - project.span(action)[0]

    def kept(say):
        asks = (say, Play(id="p", action=action.id, at=5.0))
        return replace(lines(project), performances={"p1": Performance(name="take", asks=asks)})

    assert find_asked_line(kept(Say(id="s", line="l1", at=4.5)), action) == AskedLine("l1", -0.5)
    assert find_asked_line(kept(Say(id="s", line="l1", at=3.9)), action) is None, "it is over by then"
    assert find_asked_line(kept(Say(id="s", line="l1", at=5.0 + length)), action) is None
    assert find_asked_line(kept(Say(id="s", line="gone", at=5.0)), action) is None
    assert find_asked_line(kept(Say(id="s", text="well", at=5.0)), action) is None
