"""Roles, parts and sides with the user's corrections; masks; the base pose."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from metagraph.graph import anatomy, edits
from metagraph.graph.model import BasePose, Project
from metagraph.motion.skeleton import Skeleton


def test_a_project_without_clips_has_no_anatomy() -> None:
    project = Project()
    assert (
        anatomy.project_roles(project) == {}
        and anatomy.project_parts(project) == ()
        and anatomy.project_sides(project) == ()
    )
    with pytest.raises(ValueError, match="no base pose"):
        anatomy.get_base_pose(project)


def test_corrections_override_what_was_found_and_unknown_joints_are_ignored(toy: Any) -> None:
    project = toy.project()
    s = project.skeleton
    assert anatomy.project_roles(project)["head"] == s.index("Head")
    corrected = edits.set_role(edits.set_part(project, ["Neck", "Nowhere"], "spine"), "head", "Neck")
    assert anatomy.project_roles(corrected)["head"] == s.index("Neck")
    assert anatomy.project_parts(corrected)[s.index("Neck")] == "spine"
    assert "head" not in anatomy.project_roles(edits.set_role(project, "head", "Nowhere"))
    assert anatomy.project_roles(project)["head"] == s.index("Head"), (
        "the project corrected from is as it was"
    )


def test_an_action_of_both_arms_moves_every_joint(toy: Any) -> None:
    project = toy.project()
    assert anatomy.make_action_mask(project, project.action(toy.id(project, "rest long"))) is None


def test_a_one_armed_action_leaves_the_other_arm_to_the_stance(toy: Any) -> None:
    project = toy.project()
    mask = anatomy.make_action_mask(project, project.action(toy.id(project, "rest beat lf")))
    still = {project.skeleton.names[i] for i in np.flatnonzero(mask == 0)}
    assert still == {"RightUpperArm", "RightLowerArm", "RightHand"}


def test_named_joints_are_the_only_ones_moved(toy: Any) -> None:
    project = toy.project()
    ident = toy.id(project, "rest beat lf")
    project = edits.update_actions(project, [ident], joints=("LeftHand", "RightHand", "Nowhere"))
    mask = anatomy.make_action_mask(project, project.action(ident))
    assert {project.skeleton.names[i] for i in np.flatnonzero(mask)} == {"LeftHand"}


def test_joints_move_as_far_as_their_weights_say_where_the_action_moves_them_at_all(toy: Any) -> None:
    project = toy.project()
    ident = toy.id(project, "rest beat lf")
    weights = (("Head", 0.25), ("RightHand", 0.5), ("LeftHand", 0.5), ("Nowhere", 0.5))
    project = edits.update_actions(project, [ident], joints=("Head", "RightHand"), joint_weights=weights)
    mask = anatomy.make_action_mask(project, project.action(ident))
    found = {project.skeleton.names[i]: float(mask[i]) for i in np.flatnonzero(mask)}
    assert found == {"Head": 0.25}, "one hand is the other arm's, the other is not among its joints"
    assert anatomy.list_unknown_joints(project.skeleton, project.action(ident)) == ["Nowhere"]
    assert anatomy.list_unknown_joints(None, project.action(ident)) == []


def test_a_mask_is_told_by_what_does_not_move_wholly(toy: Any) -> None:
    project = toy.project()
    skeleton = project.skeleton
    assert anatomy.as_joint_mask(skeleton, {}) == {"joints": (), "joint_weights": ()}
    soft = anatomy.as_joint_mask(skeleton, {"Head": 0.25, "Neck": 1.0, "Nowhere": 0.5})
    assert soft == {"joints": (), "joint_weights": (("Head", 0.25),)}
    hard = anatomy.as_joint_mask(skeleton, {"Head": 0.0, "Neck": -3.0, "LeftHand": 7.0})
    assert hard["joint_weights"] == () and set(skeleton.names) - {*hard["joints"]} == {"Head", "Neck"}
    ident = toy.id(project, "rest long")
    placed = edits.update_actions(
        project, [ident], **anatomy.as_joint_mask(skeleton, {"Head": 0.5, "Neck": 0})
    )
    mask = anatomy.make_action_mask(placed, placed.action(ident))
    assert mask[skeleton.index("Head")] == 0.5 and mask[skeleton.index("Neck")] == 0 and (mask == 1).sum() > 5


def chained(*parts: str) -> tuple[Skeleton, tuple[Any, ...]]:
    """Hips, and on them a chain of joints of these parts, and a leg."""
    names = ("Hips", "Leg", *(f"{part}{n}" for n, part in enumerate(parts)))
    parents = np.array([-1, 0, 0, *range(2, len(names) - 1)])
    count = len(names)
    skeleton = Skeleton(names, parents, np.tile([0.0, 0, 0, 1], (count, 1)), np.zeros((count, 3)))
    return skeleton, ("legs", "legs", *parts)


def test_a_soft_edge_rises_over_the_spine_and_leaves_the_legs() -> None:
    skeleton, parts = chained("spine", "spine", "spine", "head", "head")
    found = anatomy.make_soft_edge(skeleton, parts, dict.fromkeys(skeleton.names, 1.0), 3)
    assert [*found.values()] == [1, 1, 0.25, 0.5, 0.75, 1, 1]
    again = anatomy.make_soft_edge(skeleton, parts, found, 1)
    assert [*again.values()] == [1, 1, 0.5, 1, 1, 1, 1], "a second one takes the place of the first"


def test_a_soft_edge_begins_where_the_mask_does_and_is_no_longer_than_the_chain() -> None:
    skeleton, parts = chained("spine", "spine", "arms", "arms", "arms")
    weights = {name: float(name.startswith("arms")) for name in skeleton.names}
    assert [*anatomy.make_soft_edge(skeleton, parts, weights, 9).values()] == [
        0, 0, 0, 0, pytest.approx(1 / 3), pytest.approx(2 / 3), 1,
    ]  # fmt: skip
    only = {name: float(name == "arms4") for name in skeleton.names}
    alone = anatomy.make_soft_edge(skeleton, parts, {**only, "arms3": 1.0}, 2)
    assert alone["arms3"] == 0.5 and alone["arms4"] == 1


def test_a_mask_of_one_joint_or_of_none_has_no_soft_edge() -> None:
    skeleton, parts = chained("spine", "head")
    one = {name: float(name == "head1") for name in skeleton.names}
    assert anatomy.make_soft_edge(skeleton, parts, one, 3) == one
    none = dict.fromkeys(skeleton.names, 0.0)
    assert anatomy.make_soft_edge(skeleton, parts, none, 3) == none


def test_the_base_pose_is_a_frame_of_a_clip_kept_inside_it(toy: Any) -> None:
    project = toy.project()
    clip = next(e for e in project.clips.values() if e.name == "rest to up")
    last = anatomy.get_base_pose(edits.set_base(project, clip.id, 24))
    assert np.allclose(last.rotations, clip.motion.rotations[-1], atol=1e-6)
    beyond = anatomy.get_base_pose(replace(project, base=BasePose(clip.id, 500)))
    assert np.allclose(beyond.rotations, last.rotations)


def test_without_a_clip_the_rest_pose_stands_in(toy: Any) -> None:
    project = edits.set_base(toy.project(), None)
    assert np.allclose(anatomy.get_base_pose(project).rotations, toy.skeleton.rest_rotations)
    lost = edits.set_base(toy.project(), "c1")
    lost = replace(lost, clips={**lost.clips, "c1": replace(lost.clips["c1"], motion=None)})
    assert np.allclose(anatomy.get_base_pose(lost).translations, toy.skeleton.rest_translations)
