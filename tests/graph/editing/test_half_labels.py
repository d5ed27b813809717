"""Labels that are known in part."""

from __future__ import annotations

import pytest

from metagraph.formats.store import open_project, save_project
from metagraph.graph import edits
from metagraph.graph.clip_mark import HalfLabel
from metagraph.graph.edit_error import EditError
from metagraph.graph.editing.half_labels import (
    find_half_label,
    follow_stance_name,
    has_half_label,
    place_complete,
    set_half_labels,
)
from metagraph.graph.editing.marks import mark, mark_of
from metagraph.graph.editing.merging_stances import merge_stances


@pytest.fixture
def project(toy):
    """The toy with three clips that are in no stance yet: c20, c21 and c22."""
    return edits.add_clips(
        toy.project(), [(f"{name}.glb", 0, "", toy.clip(name, 1.0)) for name in ("one", "two", "three")]
    )


@pytest.fixture
def free(project):
    return [clip for clip in project.clips if clip not in project.uses]


def uses(project, clip):
    return [
        (a.kind, a.layer, project.stance(a.stance).name, a.limb, a.tags) for a in project.uses.get(clip, ())
    ]


def test_a_clip_with_a_kind_alone_waits_and_is_placed_when_its_stance_is_known(project, free):
    half = set_half_labels(project, {free[0]: {"kind": "gesture", "tags": ("hello",), "limb": "left"}})
    assert half.graphs is project.graphs
    assert has_half_label(half, free[0])
    assert not has_half_label(half, free[1])
    whole = set_half_labels(half, {free[0]: {"stance": "REST"}})
    assert uses(whole, free[0]) == [("gesture", "arms", "rest", "left", ("hello",))]
    assert not has_half_label(whole, free[0])
    assert whole.marks == {}


def test_a_stance_alone_waits_too_in_any_order(project, free):
    half = set_half_labels(project, {clip: {"stance": "up"} for clip in free})
    assert half.graphs is project.graphs
    whole = set_half_labels(half, {clip: {"kind": "fidget"} for clip in free})
    assert [uses(whole, clip) for clip in free] == [[("fidget", "arms", "up", "both", ())]] * 3


def test_a_transition_waits_for_its_end_and_may_not_end_where_it_begins(project, free):
    half = set_half_labels(project, {free[0]: {"kind": "transition", "stance": "rest"}})
    assert has_half_label(half, free[0])
    with pytest.raises(EditError, match="another stance"):
        set_half_labels(half, {free[0]: {"end_stance": "rest"}})
    whole = set_half_labels(half, {free[0]: {"end_stance": "far"}})
    (action,) = whole.uses[free[0]]
    assert whole.stance(action.end_stance).name == "far"


def test_a_loop_makes_its_stance_once_its_layer_is_known_and_places_those_that_wait_for_it(project, free):
    half = set_half_labels(
        project, {free[0]: {"kind": "gesture", "stance": "sit"}, free[1]: {"kind": "stance", "stance": "sit"}}
    )
    assert half.graphs is project.graphs
    whole = set_half_labels(half, {free[1]: {"layer": "body"}})
    assert uses(whole, free[0]) == [("gesture", "body", "sit", "both", ())]
    assert uses(whole, free[1]) == [("stance", "body", "sit", "both", ())]


def test_two_loops_of_one_new_stance_make_one_stance(project, free):
    whole = set_half_labels(
        project, {clip: {"kind": "stance", "stance": "sit", "layer": "body"} for clip in free[:2]}
    )
    assert [s.name for s in whole.graphs["body"].stances.values()] == ["sit"]
    assert len(whole.uses[free[0]]) == len(whole.uses[free[1]]) == 1


def test_a_stance_of_a_name_that_two_layers_have_waits_for_the_layer(project, free):
    project = edits.add_stance(project, "head", "rest")
    half = set_half_labels(project, {free[0]: {"kind": "gesture", "stance": "rest"}})
    assert has_half_label(half, free[0])
    whole = set_half_labels(half, {free[0]: {"layer": "head"}})
    assert uses(whole, free[0])[0][:3] == ("gesture", "head", "rest")


def test_a_stance_of_another_layer_makes_the_layer_unknown_again(project, free):
    project = edits.add_stance(project, "head", "nodding")
    half = set_half_labels(project, {free[0]: {"layer": "arms"}})
    assert find_half_label(set_half_labels(half, {free[0]: {"stance": "nodding"}}), free[0]) == HalfLabel(
        stance="nodding"
    )


def test_what_is_placed_by_other_means_no_longer_waits(project, free):
    half = set_half_labels(project, {free[0]: {"kind": "gesture"}})
    placed = edits.place_clips(half, [free[0]], "arms", "fidget", next(iter(half.graphs["arms"].stances)))
    assert find_half_label(placed, free[0]) == HalfLabel()
    assert place_complete(placed).marks == {}


def test_a_label_goes_and_other_marks_stay(project, free):
    half = set_half_labels(mark(project, free, rating=4), {free[0]: {"kind": "gesture"}})
    cleared = set_half_labels(half, {free[0]: {"kind": ""}})
    assert mark_of(cleared, free[0]) == mark_of(cleared, free[1])
    assert cleared.marks[free[0]].rating == 4


def test_clips_with_actions_and_clips_that_are_gone_stay_as_they_are(project):
    used = next(iter(project.uses))
    assert set_half_labels(project, {used: {"kind": "gesture"}, "gone": {"kind": "gesture"}}) is project


def test_labels_follow_a_stance_that_is_renamed_or_merged(project, free):
    half = set_half_labels(project, {free[0]: {"stance": "up"}})
    assert find_half_label(follow_stance_name(half, "arms", "up", "raised"), free[0]).stance == "raised"
    assert follow_stance_name(half, "head", "other", "raised") is half
    ids = {s.name: s.id for s in half.graphs["arms"].stances.values()}
    assert find_half_label(merge_stances(half, ids["up"], ids["far"]), free[0]).stance == "far"


def test_half_labels_are_saved_with_the_project(project, free, tmp_path):
    label = {"kind": "transition", "layer": "arms", "stance": "up", "limb": "left", "tags": ("a", "b")}
    half = set_half_labels(project, {free[0]: label})
    save_project(half, tmp_path / "p.metagraph.yaml")
    again = open_project(tmp_path / "p.metagraph.yaml").project
    assert mark_of(again, free[0]) == mark_of(half, free[0])
    assert mark_of(again, free[0]).label == HalfLabel("transition", "arms", "up", "", "left", ("a", "b"))
