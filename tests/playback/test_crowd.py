"""The crowd: compiled loops that agree with the player."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from metagraph.graph import edits
from metagraph.graph.model import Project
from metagraph.graph.touch import Touch
from metagraph.playback.crowd import Crowd
from metagraph.playback.plan import MetaRequest, Plan
from metagraph.playback.planner import make_plan
from metagraph.playback.player import pose_at

ROOT = Path(__file__).parents[2]


def assert_agrees(project: Project, plans: list[Plan], times: np.ndarray) -> None:
    crowd = Crowd(project, plans)
    pose = crowd.poses(times)
    for n, plan in enumerate(plans):
        one = pose_at(plan, project, times[n], alive=False)
        assert np.abs(one.rotations - pose.rotations[n]).max() < 1e-5, (n, times[n])
        assert np.abs(one.translations - pose.translations[n]).max() < 1e-5
    for ours, theirs in zip(crowd.globals(times), project.skeleton.globals(pose), strict=True):
        assert np.abs(ours - theirs).max() < 1e-5


def test_nobody_is_a_crowd_too(toy: Any) -> None:
    crowd = Crowd(toy.project(), [])
    assert len(crowd) == 0 and crowd.poses(np.zeros(0)).rotations.shape == (0, 16, 4)


def test_a_project_without_a_skeleton_has_no_crowd() -> None:
    with pytest.raises(ValueError, match="cannot be posed"):
        Crowd(Project(), [])


def test_a_crowd_on_the_sample_agrees_with_the_player(sample: Project) -> None:
    sample = replace(sample, touch=Touch(False, False))
    plans = [make_plan(sample, 20, seed=seed) for seed in range(8)] * 40  # enough for several threads
    assert_agrees(sample, plans, np.random.default_rng(1).uniform(-1, 22, len(plans)))


def test_weights_masks_seams_early_exits_and_missing_clips_agree_too(toy: Any) -> None:
    project = toy.project()
    opened = edits.add_clips(project, [("open.glb", 0, "", toy.clip("open", 2.0, 0.0, 0.5))])
    clip = list(opened.clips)[-1]
    project = edits.update_actions(
        opened, [toy.id(project, "rest loop")], clip=clip, timing={"blend_in": 0.4}
    )
    project = edits.update_actions(
        project, [toy.id(project, "rest long")], timing={"earliest_exit": 0.5, "blend_out": 0.3}
    )
    project = edits.update_actions(project, [toy.id(project, "rest scratch")], joints=("Head", "LeftHand"))
    soft = (("Head", 0.25), ("LeftUpperArm", 0.5), ("Spine", 0.75), ("Hips", 0.3))
    for name in ("rest beat lf", "rest wave rt", "rest scratch"):
        project = edits.update_actions(project, [toy.id(project, name)], joint_weights=soft)
    project = edits.set_weight(edits.set_weight(project, "arms", "arms", 0.5), "arms", "legs", 1.7)
    missing = project.action(toy.id(project, "rest short")).clip
    project = replace(project, clips={**project.clips, missing: replace(project.clips[missing], motion=None)})
    busy = [
        MetaRequest(f"r{n}", "arms", ("gesture", "fidget", "transition")[n % 3], n * 1.1, 0.4)
        for n in range(30)
    ]
    plans = [make_plan(project, 40, busy, seed) for seed in range(150)] + [Plan(1, 0.0)]
    assert_agrees(project, plans, np.random.default_rng(2).uniform(-1, 42, len(plans)))


def test_a_pose_is_the_same_whatever_others_are_beside_it(toy: Any) -> None:
    project = toy.project()
    plans = [make_plan(project, 20, seed=seed) for seed in range(131)]
    times = np.random.default_rng(3).uniform(0, 20, len(plans))
    turns, places = Crowd(project, plans).globals(times)
    for count in (1, 2, 3, 4, 5, 127, 128, 129):
        some = Crowd(project, plans[:count]).globals(times[:count])
        assert np.array_equal(some[0], turns[:count]) and np.array_equal(some[1], places[:count])
    behind = np.full((131, 16, 4), 7, np.float32), np.full((131, 16, 3), 7, np.float32)
    Crowd(project, plans[:130]).globals(times[:130], (behind[0][:130], behind[1][:130]))
    assert (behind[0][130] == 7).all() and (behind[1][130] == 7).all(), "nothing is written behind the last"


def test_one_time_serves_all(toy: Any) -> None:
    project = toy.project()
    crowd = Crowd(project, [make_plan(project, 10)] * 3)
    pose = crowd.poses(2.5)
    assert np.array_equal(pose.rotations[0], pose.rotations[2])
    assert np.array_equal(pose.rotations, crowd.poses(np.full(3, 2.5)).rotations)


def test_a_frame_can_be_written_over_the_last(toy: Any) -> None:
    project = toy.project()
    crowd = Crowd(project, [make_plan(project, 10, seed=n) for n in range(4)])
    pose, model = crowd.poses(1.0), crowd.globals(1.0)
    assert crowd.poses(2.0, pose) is pose and np.array_equal(pose.rotations, crowd.poses(2.0).rotations)
    assert crowd.globals(3.0, model)[1] is model[1] and np.array_equal(model[1], crowd.globals(3.0)[1])


def test_making_a_crowd_and_importing_it_do_not_load_numba() -> None:
    code = (
        "import sys; import metagraph.playback.crowd, metagraph.playback.player;"
        "assert not {'numba', 'scipy', 'torch', 'trimesh'} & set(sys.modules)"
    )
    subprocess.run([sys.executable, "-c", code], cwd=ROOT, check=True, timeout=300)
