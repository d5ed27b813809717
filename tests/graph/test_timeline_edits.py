"""What is noted on a timeline: ranges, markers, locks; and what follows a request goes along with it."""

from __future__ import annotations

import pytest

from metagraph.formats.project.data import from_data, to_data
from metagraph.formats.project.journal import find_changes
from metagraph.graph import requests as a
from metagraph.graph import timeline_edits as t
from metagraph.graph.edit_error import EditError
from metagraph.graph.editing import performances as edits
from metagraph.graph.model import Project
from metagraph.graph.timeline import Cut

pytestmark = pytest.mark.usefixtures("numbered_ids")


@pytest.fixture
def project():
    asks = (
        a.Gesture(id="g1", at=1.0),
        a.Nod(id="n1", at=4.0),
        a.Gesture(id="g2", stroke=6.0),
        a.Say(id="s", text="so", at=8.0),
    )
    return edits.add_performance(Project(), a.Performance(name="One", asks=asks))


def test_a_range_ends_after_it_begins():
    project = t.change_timeline(Project(), "", range=(1.0, 3.0))
    assert t.get_timeline(project, "").range == (1.0, 3.0)
    with pytest.raises(EditError, match="range"):
        t.change_timeline(project, "", range=(3.0, 1.0))


def test_markers_stand_by_time_and_none_twice_at_a_time():
    project, late = t.add_marker(Project(), "p1", 5.0, "late")
    project, early = t.add_marker(project, "p1", 2.0)
    project, again = t.add_marker(project, "p1", 5.001)
    assert again == late and [m.id for m in t.get_timeline(project, "p1").markers] == [early, late]
    project = t.change_marker(project, "p1", early, at=9.0, name="last")
    assert [m.name for m in t.get_timeline(project, "p1").markers] == ["late", "last"]
    assert t.remove_markers(project, "p1", {early, late}).timelines == {}, "defaults are not kept"


def test_what_is_noted_is_saved_and_goes_with_its_performance(project):
    project, ident = project
    project = t.change_timeline(
        project,
        ident,
        range=(0.5, 2.5),
        locked=("arms",),
        captions=True,
        cuts=(Cut(at=1.0, shot="close", side=1),),
    )
    project, _ = t.add_marker(project, ident, 1.5, "Punch line")
    assert from_data(to_data(project)) == project
    assert "timelines" not in to_data(Project()), "old files and new ones without notes are alike"
    assert edits.remove_performance(project, ident).timelines == {}


def test_a_note_alone_is_told_from_other_edits(project):
    before, ident = project
    after, _ = t.add_marker(before, ident, 1.0)
    assert t.differs_only_in_timeline(before, after) and set(find_changes(before, after)) == {"timelines"}
    assert not t.differs_only_in_timeline(before, edits.add_request(after, ident, a.Nod(at=2.0)))
    assert not t.differs_only_in_timeline(before, before)


def test_closing_up_moves_what_follows_by_what_is_gone_before_it(project):
    before, ident = project
    after = edits.close_up_after(before, ident, {"n1"}, [(4.0, 5.5)]).performances[ident]
    assert {x.id: edits.ask_time(x) for x in after.asks} == {"g1": 1.0, "g2": 4.5, "s": 6.5}
    both = edits.close_up_after(
        before, ident, {"g1", "n1"}, [(1.0, 3.0), (2.0, 3.0), (4.0, 5.0)], {"s"}
    ).performances[ident]
    assert {x.id: edits.ask_time(x) for x in both.asks} == {"g2": 3.0, "s": 8.0}, "what is locked stays"


def test_what_follows_a_request_goes_along_but_for_what_stays(project):
    kept = project[0].performances[project[1]]
    assert edits.find_following_asks(kept, ("n1",)) == ("n1", "g2", "s")
    assert edits.find_following_asks(kept, ("n1",), {"g2"}) == ("n1", "s")


def test_requests_stand_on_the_lane_of_their_layer():
    lanes = [
        t.find_lane(ask, Project())
        for ask in (a.Gesture(), a.Nod(), a.Fidget(layer="body"), a.Say(text="so"))
    ]
    assert lanes == ["arms", "head", "body", "stage"]
