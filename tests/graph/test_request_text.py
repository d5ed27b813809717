"""Requests on the clipboard: gaps are kept, what the other project has is found by name, the rest is
reported.
"""

from __future__ import annotations

import json

import pytest

from metagraph.graph import requests as a
from metagraph.graph.edit_error import EditError
from metagraph.graph.editing import performances as edits
from metagraph.graph.request_text import holds_requests, paste_requests, write_request_text


@pytest.fixture
def two(toy):
    project = toy.project()
    action = next(x for x in project.actions() if x.kind == "gesture")
    asks = (
        a.Play(id="x", action=action.id, at=3.0),
        a.Gesture(id="y", stroke=5.5),
        a.Say(id="z", line="7", at=8.0),
    )
    project = edits.set_line(project, "7", a.Line(text="So it is."))
    project, first = edits.add_performance(project, a.Performance(name="One", asks=asks))
    project, second = edits.add_performance(project, a.Performance(name="Two", asks=(a.Nod(id="x", at=1.0),)))
    return project, first, second, action


def test_gaps_are_kept_and_ids_are_new(two):
    project, first, second, _ = two
    text = write_request_text(project, first, ("x", "y", "z"))
    made = paste_requests(project, second, text, 10.0)
    asks = made.project.performances[second].asks
    assert holds_requests(text) and len({x.id for x in asks}) == 4 and made.left_out == ()
    assert [edits.ask_time(x) for x in asks if x.id in made.idents] == [10.0, 12.5, 15.0]
    assert made.project.performances[first] == project.performances[first]


def test_another_project_s_action_is_found_by_its_name_and_what_is_missing_is_told(two):
    project, first, second, action = two
    text = write_request_text(project, first, ("x", "z"))
    renamed = text.replace(json.dumps(action.id), '"a999"')
    found = paste_requests(project, second, renamed, 0.0)
    assert found.project.performances[second].asks[1].action == action.id
    gone = paste_requests(
        edits.set_line(project, "7", None), second, renamed.replace(action.name, "no such"), 0.0
    )
    assert gone.left_out == ("action 'no such'", "the sound of line '7'")
    (said,) = (x for x in gone.project.performances[second].asks if x.id in gone.idents)
    assert (said.text, said.line, said.at) == ("So it is.", None, 0.0)


@pytest.mark.parametrize(
    "text",
    [
        "",
        "hello",
        "[1]",
        '{"metagraph": "requests", "version": 9, "requests": []}',
        '{"metagraph": "requests", "version": 1, "requests": [{"do": "fly"}]}',
    ],
)
def test_another_text_is_refused(two, text):
    with pytest.raises(EditError, match="clipboard"):
        paste_requests(two[0], two[2], text, 0.0)
