"""What one project takes from another joins what is there, is never there twice, and plays as it did."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from metagraph.graph import edits
from metagraph.graph.check import check_project
from metagraph.graph.editing.taking import describe_taking, take, take_piece
from metagraph.graph.model import Project
from metagraph.motion.clip import Clip
from metagraph.motion.contact_spans import ContactKey, ContactSpan
from metagraph.motion.skeleton import Skeleton
from sample_clips.make.mannequin_skeleton import mannequin_skeleton


def with_digests(project: Project) -> Project:
    clips = {i: replace(e, digest=f"{n:064x}") for n, (i, e) in enumerate(project.clips.items(), 1)}
    return replace(project, clips=clips)


@pytest.fixture
def other(toy: Any) -> Project:
    return with_digests(toy.project())


def became(taking: Any, kind: str) -> dict[str, str]:
    return {x.name: x.becomes for x in taking.things if x.kind == kind}


def graph_of(project: Project) -> set[tuple[object, ...]]:
    """What plays, told by names."""
    out = set()
    for a in project.actions():
        stance, end = project.stance(a.stance), project.stance(a.end_stance)
        out.add(
            (a.layer, a.kind, a.name, stance.name, end and end.name, project.clips[a.clip].name, a.timing)
        )
    return out


def test_nothing_comes_of_an_empty_project(other: Project) -> None:
    assert take(other, Project()).things == () and take(other, Project()).project == other
    assert take(Project(), Project()).project == Project()


def test_an_empty_project_becomes_what_the_other_is(other: Project) -> None:
    taking = take(Project("mine"), other)
    assert graph_of(taking.project) == graph_of(other) and taking.project.name == "mine"
    assert taking.project.skeleton == other.skeleton
    base = taking.project.base.clip
    assert base is not None and taking.project.clips[base].name == other.clips[other.base.clip].name
    assert not [p for p in check_project(taking.project) if p.severity == "error"]
    assert [words.split()[0] for words in describe_taking(taking).split(", ")] == ["3", "16", "16"]


def test_taking_twice_changes_nothing_more(other: Project) -> None:
    once = take(Project(), other).project
    again = take(once, other)
    assert again.project == once and set(became(again, "action").values()) == {"there"}
    assert "16 actions" in describe_taking(again)


def test_a_stance_of_the_same_name_is_joined_and_its_new_actions_added(other: Project, toy: Any) -> None:
    mine = edits.remove_actions(other, [toy.id(other, "rest wave rt"), toy.id(other, "up yawn")])
    mine = edits.set_settings(mine, seed=9)
    taking = take(mine, other)
    assert became(taking, "stance") == {"rest": "joined", "up": "joined", "far": "joined"}
    assert graph_of(taking.project) == graph_of(other) and taking.project.settings.seed == 9
    new = [x.name for x in taking.things if x.kind == "action" and x.becomes == "new"]
    assert new == ["rest wave rt", "up yawn"] and taking.count("clip") == 0


def test_a_clip_of_the_same_name_and_another_content_is_another_clip(other: Project, toy: Any) -> None:
    first = next(iter(other.clips))
    clips = {**other.clips, first: replace(other.clips[first], digest="ff" * 32, path="elsewhere.glb")}
    taking = take(other, replace(other, clips=clips))
    assert became(taking, "clip")["rest loop"] == "renamed"
    assert {"rest loop", "rest loop 2"} <= {e.name for e in taking.project.clips.values()}


def test_a_chosen_action_brings_its_stance_with_a_loop_and_nothing_else(other: Project, toy: Any) -> None:
    point = toy.id(other, "up point")
    piece = take_piece(other, actions=[point])
    assert {s.name for s in piece.graphs["arms"].stances.values()} == {"up"}
    taking = take(Project(), piece, actions=[point])
    assert {a.name for a in taking.project.actions()} == {"up loop", "up point"}
    there = take(other, piece, actions=[point])
    assert became(there, "action") == {"up point": "there"} and there.project == other


def test_a_chosen_transition_brings_both_stances(other: Project, toy: Any) -> None:
    way = toy.id(other, "up to far")
    taking = take(Project(), take_piece(other, actions=[way]), actions=[way])
    assert {a.name for a in taking.project.actions()} == {"up loop", "far loop", "up to far"}
    assert not [p for p in check_project(taking.project) if p.severity == "error"]


def test_a_chosen_stance_brings_all_that_is_placed_on_it(other: Project, toy: Any) -> None:
    up = toy.id(other, "up")
    piece = take_piece(other, stances=[up])
    wanted = [a.id for a in piece.actions() if a.stance == up]
    names = {a.name for a in take(Project(), piece, actions=wanted).project.actions()}
    assert names == {
        "up loop",
        "up beat",
        "up point",
        "up yawn",
        "up to rest",
        "up to far",
        "rest loop",
        "far loop",
    }


def test_unused_clips_come_with_a_whole_project_alone(other: Project, toy: Any) -> None:
    more = edits.add_clips(other, [("unused.glb", 0, "ab" * 32, toy.clip("unused"))])
    assert "unused" in became(take(Project(), more), "clip")
    assert "unused" not in {e.name for e in take(Project(), more, actions=[]).project.clips.values()}


def strange() -> Project:
    """A project of another skeleton: a stance, and a gesture of a masked arm that touches the head."""
    skeleton = mannequin_skeleton()
    still = np.tile(skeleton.rest_rotations, (31, 1, 1))
    moves = np.tile(skeleton.rest_translations[:1], (31, 1, 1))
    clips = [Clip(name, skeleton, 30, still, moves) for name in ("their pose", "their touch")]
    theirs = edits.add_clips(
        Project(), [(f"{c.name}.glb", 0, f"{n:064x}", c) for n, c in enumerate(clips, 100)]
    )
    pose, touch = theirs.clips
    theirs = edits.add_stance(theirs, "arms", "other rest", [pose])
    theirs = edits.place_clips(theirs, [touch], "arms", "gesture", next(iter(theirs.graphs["arms"].stances)))
    key = ContactKey(0.5, (0.0, 0.1, 0.1), (0.0, 0.0, 0.0, 1.0))
    return edits.update_actions(
        theirs,
        [[*theirs.actions()][-1].id],
        joints=("LeftUpperArm", "LeftIndexProximal"),
        joint_weights=(("LeftUpperArm", 0.5),),
        contacts=(ContactSpan("left", "palm", "Head", 0.2, 0.8, (key,)),),
    )


def renamed(project: Project) -> Project:
    """The project with joints of other names, so that nothing but their places tells what they are."""
    skeleton = project.skeleton
    assert skeleton is not None
    names = {name: f"x_{name}" for name in skeleton.names}
    other = Skeleton(
        tuple(names.values()), skeleton.parents, skeleton.rest_rotations, skeleton.rest_translations
    )
    clips = {
        i: replace(e, motion=replace(e.motion, skeleton=other)) for i, e in project.clips.items() if e.motion
    }
    return replace(project, skeleton=other, clips=clips)


def test_clips_of_another_skeleton_are_retargeted_with_the_joints_that_actions_name(other: Project) -> None:
    mine = renamed(other)
    taking = take(mine, strange())
    entries = {e.name: e for e in taking.project.clips.values()}
    for name in ("their pose", "their touch"):
        entry = entries[name]
        assert entry.motion is not None and entry.motion.skeleton == mine.skeleton
        assert entry.brought_from in taking.project.joint_maps
    (touch,) = (a for a in taking.project.actions() if a.name == "their touch")
    assert touch.joints == ("x_LeftUpperArm",) and touch.joint_weights == (("x_LeftUpperArm", 0.5),)
    assert touch.contacts == (), "they are places on another body"
    (words,) = (x.words for x in taking.things if x.kind == "action" and x.name == "their touch")
    assert "contacts" in words and "not copied" in words
    assert not [p for p in check_project(taking.project) if p.code == "mask"]


def test_an_action_that_moves_no_joint_of_this_project_is_left_out(other: Project) -> None:
    theirs = strange()
    touch = [*theirs.actions()][-1].id
    taking = take(renamed(other), edits.update_actions(theirs, [touch], joints=("LeftIndexProximal",)))
    assert became(taking, "action") == {"their pose": "new", "their touch": "left out"}
    assert "1 action skipped" in describe_taking(taking)


def test_without_retargeting_clips_are_left_out_and_so_are_stances_that_would_be_empty(
    other: Project,
) -> None:
    mine = renamed(other)
    left = take(mine, strange(), retarget=False)
    assert set(became(left, "clip").values()) == set(became(left, "action").values()) == {"left out"}
    assert became(left, "stance") == {"other rest": "left out"}
    assert left.project == mine and all(x.words for x in left.things)
    assert "2 actions" in describe_taking(left)


def test_a_stance_that_has_nothing_in_the_other_project_comes_as_it_is(other: Project) -> None:
    bare = edits.add_stance(Project(), "arms", "to be filled")
    assert became(take(other, bare), "stance") == {"to be filled": "new"}


def test_an_empty_project_begins_where_the_other_does_with_its_weights(other: Project, toy: Any) -> None:
    far = edits.set_weight(edits.set_start_stance(other, toy.id(other, "far")), "arms", "legs", 0.5)
    after = take(Project(), far).project
    graph = after.graphs["arms"]
    assert graph.stances[graph.start or ""].name == "far" and graph.weights == {"legs": 0.5}


def test_ids_of_this_project_stay_and_no_id_is_given_twice(other: Project) -> None:
    mine = replace(other, name="mine")
    strange = {i: replace(e, digest=f"z{e.digest[1:]}") for i, e in other.clips.items()}
    after = take(mine, replace(other, clips=strange)).project
    assert [*after.clips][: len(mine.clips)] == [*mine.clips]
    assert len(after.clips) == 2 * len(mine.clips)
    assert len({a.id for a in after.actions()}) == len([*after.actions()]) == 2 * len([*mine.actions()])
    for a in mine.actions():
        assert after.action(a.id) == a


def test_motion_comes_along(other: Project) -> None:
    after = take(Project(), other).project
    by_name = {e.name: e for e in other.clips.values()}
    for entry in after.clips.values():
        assert entry.motion is not None
        assert np.array_equal(entry.motion.rotations, by_name[entry.name].motion.rotations)
