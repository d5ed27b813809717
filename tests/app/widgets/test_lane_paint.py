"""What stands on the bars of the timeline."""

from __future__ import annotations

import pytest

from app.widgets.lane_paint import describe_cue
from metagraph.graph import edits


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("rest_beat_small_rt_01", "beat small rt"),
        ("rest_nod", "nod"),
        ("rest_01", "01"),
        ("wave (2)", "wave"),
        ("1984", "1984"),
    ],
)
def test_a_bar_says_what_tells_an_action_from_the_others_of_its_stance(toy, name, words):
    project = toy.project()
    action = next(a for a in project.actions() if a.kind == "gesture" and a.stance == toy.id(project, "rest"))
    project = edits.update_actions(project, [action.id], name=name)
    assert describe_cue(project, project.action(action.id)) == words
