"""Roles, parts and sides with the user's corrections; masks; the base pose."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from metagraph.graph import anatomy, edits
from metagraph.graph.model import BasePose, Project


def test_a_project_without_clips_has_no_anatomy() -> None:
    project = Project()
    assert anatomy.roles(project) == {} and anatomy.parts(project) == () and anatomy.sides(project) == ()
    with pytest.raises(ValueError, match="no base pose"):
        anatomy.base_pose(project)


def test_corrections_override_what_was_found_and_unknown_joints_are_ignored(toy: Any) -> None:
    project = toy.project()
    s = project.skeleton
    assert anatomy.roles(project)["head"] == s.index("Head")
    corrected = edits.set_role(edits.set_part(project, ["Neck", "Nowhere"], "spine"), "head", "Neck")
    assert anatomy.roles(corrected)["head"] == s.index("Neck")
    assert anatomy.parts(corrected)[s.index("Neck")] == "spine"
    assert "head" not in anatomy.roles(edits.set_role(project, "head", "Nowhere"))
    assert anatomy.roles(project)["head"] == s.index("Head"), "the project corrected from is as it was"


def test_an_action_of_both_arms_moves_every_joint(toy: Any) -> None:
    project = toy.project()
    assert anatomy.mask(project, project.action(toy.id(project, "rest long"))) is None


def test_a_one_armed_action_leaves_the_other_arm_to_the_stance(toy: Any) -> None:
    project = toy.project()
    mask = anatomy.mask(project, project.action(toy.id(project, "rest beat lf")))
    still = {project.skeleton.names[i] for i in np.flatnonzero(mask == 0)}
    assert still == {"RightUpperArm", "RightLowerArm", "RightHand"}


def test_named_joints_are_the_only_ones_moved(toy: Any) -> None:
    project = toy.project()
    ident = toy.id(project, "rest beat lf")
    project = edits.update_actions(project, [ident], joints=("LeftHand", "RightHand", "Nowhere"))
    mask = anatomy.mask(project, project.action(ident))
    assert {project.skeleton.names[i] for i in np.flatnonzero(mask)} == {"LeftHand"}


def test_the_base_pose_is_a_frame_of_a_clip_kept_inside_it(toy: Any) -> None:
    project = toy.project()
    clip = next(e for e in project.clips.values() if e.name == "rest to up")
    last = anatomy.base_pose(edits.set_base(project, clip.id, 24))
    assert np.allclose(last.rotations, clip.motion.rotations[-1], atol=1e-6)
    beyond = anatomy.base_pose(replace(project, base=BasePose(clip.id, 500)))
    assert np.allclose(beyond.rotations, last.rotations)


def test_without_a_clip_the_rest_pose_stands_in(toy: Any) -> None:
    project = edits.set_base(toy.project(), None)
    assert np.allclose(anatomy.base_pose(project).rotations, toy.skeleton.rest_rotations)
    lost = edits.set_base(toy.project(), "c1")
    lost = replace(lost, clips={**lost.clips, "c1": replace(lost.clips["c1"], motion=None)})
    assert np.allclose(anatomy.base_pose(lost).translations, toy.skeleton.rest_translations)
