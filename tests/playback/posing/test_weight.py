"""Bodies that answer their arms, on the sample."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from metagraph.formats.store import open_project
from metagraph.graph import anatomy, edits
from metagraph.graph.model import Project
from metagraph.motion import rotation
from metagraph.motion.skeleton import Pose
from metagraph.playback.plan import MetaRequest, Plan
from metagraph.playback.planner import make_plan
from metagraph.playback.planning.running_plan import improvise
from metagraph.playback.posing.follow_through import (
    KNOTS,
    NUMBERS,
    OFFSET,
    STEP,
    driven,
    knot_before,
    knot_time,
)
from metagraph.playback.posing.weight import find_arm_track_rows
from tests.posing import pose_at, weight_of

SAMPLE = Path(__file__).resolve().parents[3] / "sample_clips" / "sample.metagraph.yaml"
TIMES = np.arange(0.0, 40.0, 1 / 15)


@lru_cache(maxsize=1)
def sample() -> Project:
    return open_project(SAMPLE).project


@lru_cache(maxsize=1)
def plan() -> Plan:
    return improvise(sample(), 60.0, seed=3)


def with_dials(project: Project, **dials: float) -> Project:
    return replace(project, life=msgspec.structs.replace(project.life, **dials))


def stiff() -> Project:
    return with_dials(sample(), follow_through=0.0, shoulder_lift=0.0)


@lru_cache(maxsize=2)
def posed(answers: bool) -> Pose:
    return pose_at(plan(), sample() if answers else stiff(), TIMES)


@lru_cache(maxsize=2)
def placed(answers: bool) -> tuple[Any, Any]:
    skeleton = sample().skeleton
    assert skeleton is not None
    return skeleton.globals(posed(answers))


@pytest.mark.nightly
def test_hips_give_way_under_gestures_and_feet_stay_where_they_are() -> None:
    roles = anatomy.project_roles(sample())
    (turned, at), (before, were) = placed(True), placed(False)
    hips = roles["hips"]
    travel = np.linalg.norm(at[:, hips] - were[:, hips], axis=-1)
    assert 0.008 < travel.max() < 0.035 * 1.5  # metres
    assert np.degrees(rotation.measure_angle_between(turned[:, hips], before[:, hips]).max()) > 1
    for foot in ("left_foot", "right_foot", "left_toes", "right_toes"):
        assert np.abs(at[:, roles[foot]] - were[:, roles[foot]]).max() < 2e-6
        assert rotation.measure_angle_between(turned[:, roles[foot]], before[:, roles[foot]]).max() < 1e-4


def test_the_hips_go_against_the_arms() -> None:
    project, found = sample(), plan()
    hips = anatomy.project_roles(project)["hips"]
    ahead = placed(True)[1][:, hips, 2] - placed(False)[1][:, hips, 2]
    cue = max(
        (c for c in found.layers["arms"].cues if c.end < 39),
        key=lambda c: max(
            r[2] + r[5] for r in find_arm_track_rows(weight_of(project), project, c.action.clip)
        ),
    )
    inside = np.flatnonzero((TIMES - cue.start > 0.3) & (TIMES - cue.end < 0))
    assert ahead[inside].min() < -0.005  # arms ahead, hips back


@pytest.mark.nightly
def test_turned_off_poses_are_the_composed_ones_to_the_bit() -> None:
    layers = pose_at(plan(), with_dials(stiff(), planted_feet=0.0), TIMES)
    still = with_dials(sample(), stillness=1.0)
    dead = replace(sample(), life=msgspec.structs.replace(sample().life, on=False))
    for project in (with_dials(still, planted_feet=0.0), dead):
        rigid = with_dials(project, follow_through=0.0, shoulder_lift=0.0)
        a, b = (pose_at(plan(), p, TIMES[:200]) for p in (project, rigid))
        assert_array_equal(a.rotations, b.rotations)
        assert_array_equal(a.translations, b.translations)
    assert_array_equal(pose_at(plan(), sample(), TIMES, alive=False).translations, layers.translations)


def test_a_stance_at_rest_is_answered_by_nothing() -> None:
    resting = make_plan(sample(), 10.0, [], idle=False)
    times = np.linspace(0, 10, 61)
    a, b = (pose_at(resting, project, times) for project in (sample(), stiff()))
    assert_array_equal(a.rotations, b.rotations)
    assert_array_equal(a.translations, b.translations)


def test_each_pose_depends_on_plan_and_time_alone() -> None:
    order = np.random.default_rng(1).permutation(len(TIMES))
    shuffled = pose_at(plan(), sample(), TIMES[order])
    assert_allclose(shuffled.rotations, posed(True).rotations[order], atol=2e-7)
    for n in (40, 13, 300, 299):  # to and fro, with nothing remembered of another plan's object
        fresh = improvise(sample(), 60.0, seed=3)
        one = pose_at(fresh, sample(), float(TIMES[n]))
        assert_allclose(one.rotations, posed(True).rotations[n], atol=2e-7)
        assert_allclose(one.translations, posed(True).translations[n], atol=2e-7)


def test_the_head_keeps_its_direction_and_hands_theirs() -> None:
    roles, (turned, at), (before, were) = anatomy.project_roles(sample()), placed(True), placed(False)
    assert (
        np.degrees(rotation.measure_angle_between(turned[:, roles["head"]], before[:, roles["head"]])).max()
        < 1.5
    )
    for side in ("left", "right"):
        moved = np.linalg.norm(at[:, roles[f"{side}_hand"]] - were[:, roles[f"{side}_hand"]], axis=-1)
        assert moved.max() < 0.04


@pytest.mark.nightly
def test_knees_do_not_pop() -> None:
    roles, speeds = anatomy.project_roles(sample()), []
    times = np.arange(0.0, 40.0, 1 / 60)
    skeleton = sample().skeleton
    assert skeleton is not None
    for project in (sample(), stiff()):
        _, at = skeleton.globals(pose_at(plan(), project, times))
        for side in ("left", "right"):
            hip, knee, foot = (at[:, roles[f"{side}_{p}"]] for p in ("upper_leg", "lower_leg", "foot"))
            a, b = knee - hip, foot - knee
            cosine = (a * b).sum(-1) / np.linalg.norm(a, axis=-1) / np.linalg.norm(b, axis=-1)
            speeds.append(np.abs(np.diff(np.degrees(np.arccos(np.clip(cosine, -1, 1))))).max() * 60)
    assert max(speeds[:2]) < max(speeds[2:]) + 60  # degrees a second


def test_a_clip_that_the_body_plays_too_brings_its_own_hips() -> None:
    project = sample()
    arms = project.graphs["arms"]
    gesture = arms.of(arms.start or "", "gesture")[0]
    both = edits.place_clips(project, [gesture.clip], "body", "gesture", project.graphs["body"].start or "")
    other = [*both.graphs["body"].actions][-1]
    asks = [MetaRequest("a", "arms", "gesture", 1.0, action=gesture.id)]
    once, twice = (
        make_plan(both, 8.0, some, idle=False)
        for some in (asks, [*asks, MetaRequest("b", "body", "gesture", 1.0, action=other)])
    )
    times = np.arange(0, 8, 1 / 15)
    apart = []
    for found in (once, twice):
        a = pose_at(found, both, times)
        b = pose_at(found, with_dials(both, follow_through=0.0, shoulder_lift=0.0), times)
        apart.append(np.abs(a.translations - b.translations).max())
    assert apart[0] > 0.0005
    assert apart[1] < 0.2 * apart[0]


def test_collar_bones_rise_only_where_the_clip_leaves_them() -> None:
    project = sample()
    roles = anatomy.project_roles(project)
    arms = project.graphs["arms"]
    clip = project.clips[arms.of(arms.start or "", "gesture")[0].clip].motion
    assert clip is not None
    base = anatomy.get_base_pose(project).rotations
    rotations = np.array(clip.rotations)
    upper, collar = roles["left_upper_arm"], roles["left_shoulder"]
    raised = rotation.from_axis_angle(np.array([0.0, 0.0, 1.0]), np.radians(120))
    rotations[:, upper], rotations[:, collar] = rotation.multiply(raised, base[upper]), base[collar]
    entry = next(e for e in project.clips.values() if e.motion is clip)
    lifted = replace(
        project, clips={**project.clips, entry.id: replace(entry, motion=replace(clip, rotations=rotations))}
    )
    assert (
        np.array(find_arm_track_rows(weight_of(lifted), lifted, entry.id))[:, 6].max()
        > np.array(find_arm_track_rows(weight_of(project), project, entry.id))[:, 6].max()
    )
    up = rotation.from_axis_angle(np.array([0.0, 0.0, 1.0]), np.radians(25))
    rotations = np.array(rotations)
    rotations[:, collar] = rotation.multiply(up, rotations[:, collar])
    own = replace(
        lifted, clips={**lifted.clips, entry.id: replace(entry, motion=replace(clip, rotations=rotations))}
    )
    assert (
        np.array(find_arm_track_rows(weight_of(own), own, entry.id))[:, 6].max()
        < np.array(find_arm_track_rows(weight_of(lifted), lifted, entry.id))[:, 6].max()
    )


@pytest.mark.parametrize("role", ["hips", "left_foot", "right_lower_leg", "left_hand"])
def test_a_skeleton_that_lacks_what_it_takes_is_left_alone(role: str) -> None:
    project = replace(sample(), roles={role: "nothing"})
    assert weight_of(project).rig is None
    pose = pose_at(plan(), project, TIMES[:60])
    rigid = pose_at(plan(), with_dials(project, follow_through=0.0, shoulder_lift=0.0), TIMES[:60])
    assert_array_equal(pose.rotations, rigid.rotations)


def test_who_sits_does_not_sway() -> None:
    project, found = sample(), plan()
    roles, rotations = anatomy.project_roles(project), {}
    for entry in project.clips.values():
        clip = entry.motion
        if clip is None or not any(a.clip == entry.id for a in project.graphs["body"].actions.values()):
            continue
        turns = np.array(clip.rotations)
        for side in ("left", "right"):
            for part, angle in (("upper_leg", -90.0), ("lower_leg", 90.0)):
                turn = rotation.from_axis_angle(np.array([1.0, 0.0, 0.0]), np.radians(angle))
                joint = roles[f"{side}_{part}"]
                turns[:, joint] = rotation.multiply(turns[:, joint], turn)
        rotations[entry.id] = replace(entry, motion=replace(clip, rotations=turns))
    seated = replace(project, clips={**project.clips, **rotations})
    a, b = (
        pose_at(found, p, TIMES[:300])
        for p in (seated, with_dials(seated, follow_through=0.0, shoulder_lift=0.0))
    )
    assert_array_equal(a.translations, b.translations)


def test_what_moves_the_body_is_smooth_and_late_by_two_steps() -> None:
    rows = {n: [np.sin(1.3 * knot_time(n))] * NUMBERS for n in range(-10, 200)}

    def at(time: float) -> list[float]:
        last = knot_before(time)
        return driven([rows[n] for n in range(last - KNOTS + 1, last + 1)], time)

    times = np.linspace(0.5, 8, 2000)
    found = np.array([at(t) for t in times])
    assert_allclose(found[:, 0], np.sin(1.3 * (times - 2 * STEP)), atol=0.005)
    assert_allclose(found[:, NUMBERS], 1.3 * np.cos(1.3 * (times - 2 * STEP)), atol=0.01)
    knot = OFFSET + 20 * STEP
    assert_allclose(at(knot - 1e-9), at(knot + 1e-9), atol=1e-6)
