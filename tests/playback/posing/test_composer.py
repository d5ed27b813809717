"""The composer: offsets from the base pose, added layer by layer."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from metagraph.graph import edits
from metagraph.graph.model import PARTS, Project
from metagraph.motion import rotation
from tests.posing import rig


@pytest.fixture
def project(toy: Any) -> Project:
    """Every layer reaches every joint."""
    project = toy.project()
    for layer in ("body", "arms", "head"):
        for part in PARTS:
            project = edits.set_weight(project, layer, part, 1.0)  # type: ignore[arg-type]
    return project


def turns(toy: Any, axis: list[float], angle: float) -> tuple[np.ndarray, np.ndarray]:
    count = len(toy.skeleton)
    q = rotation.from_axis_angle(np.tile(axis, (1, count, 1)), np.full((1, count), angle)).astype(np.float32)
    return q, np.full((1, count, 3), angle, np.float32)


def test_a_project_without_clips_cannot_be_posed() -> None:
    with pytest.raises(ValueError, match="cannot be posed"):
        rig(Project())


def test_no_layers_give_the_base_pose_however_many_times(project: Project) -> None:
    frame = rig(project)
    pose = frame.compose({}, 3)
    assert pose.rotations.shape == (3, 16, 4) and np.allclose(pose.rotations[1], frame.ground.base.rotations)
    assert frame.compose({}, 0).rotations.shape == (0, 16, 4)


def test_offsets_are_multiplied_on_the_right_body_first_then_arms_then_head(
    project: Project, toy: Any
) -> None:
    frame = rig(edits.set_base(project, "c2", 0))
    body, arms, head = turns(toy, [1, 0, 0], 0.5), turns(toy, [0, 1, 0], 0.4), turns(toy, [0, 0, 1], 0.3)
    pose = frame.compose({"head": head, "body": body, "arms": arms}, 1)  # the order given does not matter
    expected = frame.ground.base.rotations
    for offset in (body, arms, head):
        expected = rotation.multiply(expected, offset[0][0])
    assert np.all(rotation.measure_angle_between(pose.rotations[0], expected) < 1e-6)
    assert np.allclose(pose.translations[0], frame.ground.base.translations + 1.2, atol=1e-6)
    swapped = rotation.multiply(rotation.multiply(frame.ground.base.rotations, arms[0][0]), body[0][0])
    assert not np.all(
        rotation.measure_angle_between(frame.compose({"body": body, "arms": arms}, 1).rotations[0], swapped)
        < 1e-3
    )


@pytest.mark.parametrize("weight", [0.0, 0.5, 1.0, 2.0])
def test_a_weight_takes_part_of_the_turn_and_of_the_way(project: Project, toy: Any, weight: float) -> None:
    for part in PARTS:
        project = edits.set_weight(project, "arms", part, weight)
    frame = rig(project)
    joints = frame.reach["arms"].joints
    q, t = turns(toy, [0, 0.6, 0.8], 0.7)
    pose = frame.compose({"arms": (q[:, joints], t[:, joints])}, 1)
    base = frame.ground.base
    assert np.allclose(
        rotation.measure_angle_between(base.rotations, pose.rotations[0]), weight * 0.7, atol=1e-5
    )
    assert np.allclose(pose.translations[0] - base.translations, weight * 0.7, atol=1e-6)
    assert (len(joints) == 0) == (weight == 0)


def test_the_papers_layers_reach_the_papers_parts(toy: Any) -> None:
    project = toy.project()
    frame = rig(project)
    names = {layer: {project.skeleton.names[j] for j in reach.joints} for layer, reach in frame.reach.items()}
    arms = {n for n in project.skeleton.names if "Arm" in n or "Hand" in n}
    legs = {n for n in project.skeleton.names if "Leg" in n or "Foot" in n}
    assert legs <= names["body"] and not arms & names["body"]
    assert arms <= names["arms"] and not legs & names["arms"]
    assert not (arms | legs) & names["head"] and "Head" in names["body"] & names["arms"] & names["head"]


def test_a_clip_without_its_base_is_its_offset(toy: Any) -> None:
    project = toy.project()
    frame = rig(project)
    clip = next(e.motion for e in project.clips.values() if e.name == "rest wave rt")
    for reach in frame.reach.values():
        offsets = frame.ground.offsets(clip, reach)
        back = rotation.multiply(frame.ground.base.rotations[reach.joints], offsets.rotations)
        assert np.all(rotation.measure_angle_between(back, clip.dense.rotations[:, reach.joints]) < 1e-6)
        assert frame.ground.offsets(clip, reach) is offsets, "worked out once"


def test_a_clip_of_another_skeleton_is_refused(toy: Any) -> None:
    from dataclasses import replace

    from metagraph.motion.skeleton import Skeleton

    s = toy.skeleton
    frame = rig(toy.project())
    other = replace(
        toy.clip("big"), skeleton=Skeleton(s.names, s.parents, s.rest_rotations, s.rest_translations * 2)
    )
    with pytest.raises(ValueError, match="'big' has another skeleton"):
        frame.ground.offsets(other, frame.reach["arms"])


def test_the_rig_is_made_once_until_what_it_is_made_of_changes(toy: Any) -> None:
    project = toy.project()
    assert rig(project) is rig(edits.rename_project(project, "other"))
    assert rig(edits.set_weight(project, "arms", "spine", 0.3)) is not rig(project)
    assert rig(edits.set_base(project, "c2")) is not rig(project)
    assert rig(edits.set_part(project, ["Neck"], "arms")) is not rig(project)
