"""The one evaluator: poses of a plan at any time, forwards and backwards, one or many."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from metagraph.graph import edits
from metagraph.graph.model import LAYERS, PARTS, Project
from metagraph.motion import rotation
from metagraph.motion.skeleton import Pose
from metagraph.playback.plan import LayerPlan, MetaRequest, Plan, Rest
from metagraph.playback.planner import make_plan
from metagraph.playback.posing.layers import compute_cue_weight, compute_loop_seconds, ease_blend, keep_to
from tests.posing import compute_morphs_at, pose_at

pytestmark = pytest.mark.usefixtures("numbered_ids")


def clip_pose_at(project, action, seconds):
    """A clip's own pose at clip seconds, not composed."""
    return project.clips[action.clip].motion.pose_at(seconds)


@pytest.fixture
def project(toy: Any) -> Project:
    return toy.project()


def everywhere(project: Project) -> Project:
    """The arms layer reaches every joint, alone."""
    for part in PARTS:
        project = edits.set_weight(project, "arms", part, 1.0)
    return project


def apart(a: Pose, b: Pose) -> float:
    """The largest difference: radians or metres."""
    return max(
        float(rotation.measure_angle_between(a.rotations, b.rotations).max()),
        float(np.abs(a.translations - b.translations).max()),
    )


def shown(project: Project, toy: Any, name: str, start: float = 1.0) -> Plan:
    action = project.action(toy.id(project, name))
    return make_plan(
        project, 10, [MetaRequest("r", action.layer, action.kind, start, action=action.id)], idle=False
    )


# --- base + (clip - base) = clip


@pytest.mark.parametrize("name", ["rest long", "rest wave rt", "rest scratch"])
def test_a_clip_that_reaches_everything_comes_back_as_it_was(project: Project, toy: Any, name: str) -> None:
    project = edits.update_actions(everywhere(project), [toy.id(project, name)], limb="both")
    plan = shown(project, toy, name)
    [cue] = plan.layers["arms"].cues
    times = np.linspace(cue.start + cue.blend_in, cue.end - cue.blend_out - 1e-9, 40)
    assert apart(pose_at(plan, project, times), clip_pose_at(project, cue.action, times - cue.start)) < 1e-6


def test_whatever_the_base_pose_the_clip_comes_back(project: Project, toy: Any) -> None:
    for base, frame in ((None, 0), ("c3", 0), ("c7", 13)):
        other = edits.set_base(everywhere(project), base, frame)
        plan = shown(other, toy, "rest long")
        cue = plan.layers["arms"].cues[0]
        times = np.linspace(cue.start + cue.blend_in, cue.end - cue.blend_out - 1e-9, 10)
        assert apart(pose_at(plan, other, times), clip_pose_at(other, cue.action, times - cue.start)) < 1e-6


def test_a_trimmed_clip_begins_at_its_start(project: Project, toy: Any) -> None:
    project = edits.update_actions(
        everywhere(project), [toy.id(project, "rest long")], timing={"start": 0.5, "blend_in": 0.0}
    )
    plan = shown(project, toy, "rest long")
    cue = plan.layers["arms"].cues[0]
    assert apart(pose_at(plan, project, cue.start), clip_pose_at(project, cue.action, 0.5)) < 1e-6


def test_the_stance_is_its_loop(project: Project, toy: Any) -> None:
    project = everywhere(project)
    plan = make_plan(project, 10, idle=False)
    loop = plan.layers["arms"].rests[0].action
    times = np.linspace(0, 9, 50)
    assert apart(pose_at(plan, project, times), clip_pose_at(project, loop, times % 2.0)) < 1e-6


# --- time


def test_one_time_and_many_forwards_and_backwards_agree(sample: Project) -> None:
    plan = make_plan(sample, 30)
    times = np.linspace(-1, 32, 150)
    many = pose_at(plan, sample, times)
    backwards = pose_at(plan, sample, times[::-1])
    assert np.array_equal(backwards.rotations[::-1], many.rotations) and np.array_equal(
        backwards.translations[::-1], many.translations
    )
    for n in reversed(range(len(times))):
        one = pose_at(plan, sample, times[n])
        assert np.abs(one.rotations - many.rotations[n]).max() < 1e-7
        assert np.abs(one.translations - many.translations[n]).max() < 1e-7


@pytest.mark.parametrize("shape", [(), (0,), (1,), (3,), (2, 3), (2, 0)])
def test_poses_have_the_shape_of_the_times(project: Project, shape: tuple[int, ...]) -> None:
    pose = pose_at(make_plan(project, 10), project, np.ones(shape))
    assert pose.rotations.shape == (*shape, 16, 4) and pose.translations.shape == (*shape, 16, 3)


def test_before_the_beginning_and_after_the_end_the_stances_rest(project: Project, toy: Any) -> None:
    project = everywhere(project)
    plan = make_plan(
        project, 10, [MetaRequest("r", "arms", "transition", 1, stance=toy.id(project, "up"))], idle=False
    )
    rest, up = (project.action(toy.id(project, f"{n} loop")) for n in ("rest", "up"))
    assert apart(pose_at(plan, project, -0.5), clip_pose_at(project, rest, 1.5)) < 1e-6
    late = 1000.0 - plan.layers["arms"].rests[-1].start
    assert apart(pose_at(plan, project, 1000.0), clip_pose_at(project, up, late % 2.0)) < 1e-5


# --- what is missing


def test_a_plan_of_nothing_gives_the_base_pose(project: Project) -> None:
    base = project.clips[project.base.clip].motion.pose_at(0)
    assert apart(pose_at(Plan(1, 0.0), project, 3.0), base) < 1e-6
    assert pose_at(Plan(1, 0.0), project, np.zeros(4)).rotations.shape == (4, 16, 4)


def test_a_project_without_a_skeleton_has_no_poses() -> None:
    with pytest.raises(ValueError, match="cannot be posed"):
        pose_at(Plan(1, 0.0), Project(), 0.0)


def test_where_a_clip_is_missing_the_stance_shows(project: Project, toy: Any) -> None:
    plan = shown(project, toy, "rest long")
    resting = make_plan(project, 10, idle=False)
    clip = plan.layers["arms"].cues[0].action.clip
    lost = replace(project, clips={**project.clips, clip: replace(project.clips[clip], motion=None)})
    assert apart(pose_at(plan, lost, 1.1), pose_at(resting, lost, 1.1)) < 1e-6
    assert pose_at(plan, lost, np.linspace(0, 5, 20)).rotations.shape == (20, 16, 4)
    gone = edits.remove_clips(project, [clip])
    assert apart(pose_at(plan, gone, 1.1), pose_at(resting, project, 1.1)) < 1e-6


def test_where_the_loop_is_missing_the_base_pose_shows(project: Project, toy: Any) -> None:
    plan = make_plan(project, 10, idle=False)
    loop = plan.layers["arms"].rests[0].action.clip
    other = edits.set_base(project, "c5")
    lost = replace(other, clips={**other.clips, loop: replace(other.clips[loop], motion=None)})
    assert apart(pose_at(plan, lost, 1.1), other.clips["c5"].motion.pose_at(0)) < 1e-6


# --- weights and masks


@pytest.mark.parametrize("weight", [0.0, 0.5, 1.0, 2.0])
def test_a_layers_weight_scales_what_it_adds(project: Project, toy: Any, weight: float) -> None:
    project = edits.set_weight(project, "arms", "arms", weight)
    plan = shown(project, toy, "rest long")
    joint = project.skeleton.index("LeftUpperArm")
    base = pose_at(Plan(1, 0.0), project, 0.0).rotations[joint]
    at = 2.2
    alone = clip_pose_at(project, plan.layers["arms"].cues[0].action, at - 1.0).rotations[joint]
    turn = rotation.measure_angle_between(base, pose_at(plan, project, at).rotations[joint])
    assert turn == pytest.approx(weight * rotation.measure_angle_between(base, alone), abs=1e-5)


def test_a_one_armed_action_leaves_the_other_arm_in_its_stance(project: Project, toy: Any) -> None:
    plan = shown(project, toy, "rest beat lf")
    resting = Plan(plan.seed, plan.end, {**plan.layers, "arms": replace(plan.layers["arms"], cues=())})
    times = np.linspace(0.9, 2.1, 60)
    pose, still = pose_at(plan, project, times), pose_at(resting, project, times)
    right, left = (project.skeleton.index(f"{side}UpperArm") for side in ("Right", "Left"))
    assert np.allclose(pose.rotations[:, right], still.rotations[:, right], atol=1e-6)
    assert rotation.measure_angle_between(pose.rotations[:, left], still.rotations[:, left]).max() > 0.3


def test_named_joints_are_the_only_ones_that_move(project: Project, toy: Any) -> None:
    project = edits.update_actions(project, [toy.id(project, "rest long")], joints=("RightUpperArm",))
    plan = shown(project, toy, "rest long")
    resting = Plan(plan.seed, plan.end, {**plan.layers, "arms": replace(plan.layers["arms"], cues=())})
    moved = (
        rotation.measure_angle_between(
            pose_at(plan, project, 2.2).rotations, pose_at(resting, project, 2.2).rotations
        )
        > 1e-3
    )
    assert [project.skeleton.names[j] for j in np.flatnonzero(moved)] == ["RightUpperArm"]


@pytest.mark.parametrize("weight", [0.25, 0.5, 0.75])
def test_a_soft_joint_goes_as_far_from_its_stance_as_its_weight_says(
    project: Project, toy: Any, weight: float
) -> None:
    ident, joint = toy.id(project, "rest long"), project.skeleton.index("LeftUpperArm")
    soft = edits.update_actions(project, [ident], joint_weights=(("LeftUpperArm", weight),))
    plan = shown(project, toy, "rest long")
    cue = replace(plan.layers["arms"].cues[0], action=soft.action(ident))
    partly = Plan(plan.seed, plan.end, {**plan.layers, "arms": replace(plan.layers["arms"], cues=(cue,))})
    resting = Plan(plan.seed, plan.end, {**plan.layers, "arms": replace(plan.layers["arms"], cues=())})
    times = np.linspace(cue.start, cue.end, 40)  # blends, too
    whole, rest = pose_at(plan, project, times), pose_at(resting, project, times)
    found = pose_at(partly, soft, times)
    far = rotation.measure_angle_between(rest.rotations[:, joint], whole.rotations[:, joint])
    gone = rotation.measure_angle_between(rest.rotations[:, joint], found.rotations[:, joint])
    expected = rotation.nlerp(rest.rotations[:, joint], whole.rotations[:, joint], np.full(40, weight))
    assert far.max() > 0.3 and np.allclose(
        gone, rotation.measure_angle_between(rest.rotations[:, joint], expected), atol=1e-5
    )
    others = np.delete(np.arange(len(project.skeleton)), joint)
    assert np.array_equal(found.rotations[:, others], whole.rotations[:, others])


def test_a_soft_joint_that_turns_halfway_round_takes_the_shorter_way_and_stays_a_rotation() -> None:
    stance = (np.tile(np.float32([0, 0, 0, 1]), (1, 2, 1)), np.zeros((1, 2, 3), np.float32))
    turned = np.float32([[[0, 0, 1, 0], [0, 0, -0.6, -0.8]]])
    shown_ = (turned.copy(), np.ones((1, 2, 3), np.float32))
    keep_to(shown_, stance, np.float32([0.5, 0.5]))
    assert np.allclose(np.linalg.norm(shown_[0], axis=-1), 1)
    assert np.allclose(rotation.measure_angle_between(shown_[0][0, 0], stance[0][0, 0]), np.pi / 2)
    assert rotation.measure_angle_between(shown_[0][0, 1], stance[0][0, 1]) < rotation.measure_angle_between(
        turned[0, 1], stance[0][0, 1]
    )
    assert np.allclose(shown_[1], 0.5)


# --- blends and seams


def test_the_blend_curve_starts_and_ends_flat_and_is_clamped() -> None:
    assert ease_blend(np.array([-1.0, 0, 0.5, 1, 2])).tolist() == [0, 0, 0.5, 1, 1]


def test_a_cues_weight_is_0_outside_it_and_1_in_its_middle(project: Project, toy: Any) -> None:
    cue = shown(project, toy, "rest long").layers["arms"].cues[0]
    times = np.array(
        [cue.start - 0.01, cue.start, cue.start + cue.blend_in, cue.end - cue.blend_out, cue.end, cue.end + 1]
    )
    assert compute_cue_weight(cue, times).tolist() == pytest.approx([0, 0, 1, 1, 0, 0])
    hard = replace(cue, blend_in=0.0, blend_out=0.0)
    assert compute_cue_weight(hard, times).tolist() == [0, 1, 1, 1, 0, 0]


def jump(plan: Plan, project: Project, moment: float, step: float = 1e-4) -> float:
    """How far the pose moves within `step` about a moment; radians or metres."""
    a, b = (
        pose_at(plan, project, moment - step / 2),
        pose_at(plan, project, moment + step / 2),
    )
    return apart(a, b)


def test_nothing_jumps_where_actions_begin_blend_and_end(project: Project, toy: Any) -> None:
    for name in ("rest beat lf", "rest long", "rest scratch", "rest to up", "rest short"):
        plan = shown(everywhere(project), toy, name)
        cue = plan.layers["arms"].cues[0]
        for moment in (cue.start, cue.start + cue.blend_in, cue.end - cue.blend_out, cue.end):
            assert jump(plan, everywhere(project), moment) < 2e-3, (name, moment)


def test_an_action_left_early_leads_to_its_stance_without_a_jump(project: Project, toy: Any) -> None:
    ident = toy.id(project, "rest long")
    project = edits.update_actions(
        everywhere(project), [ident], timing={"earliest_exit": 0.9, "blend_out": 0.3}
    )
    asked = [
        MetaRequest("a", "arms", "gesture", 1.0, 0.5, action=ident),
        MetaRequest("b", "arms", "gesture", 1.6),
    ]
    plan = make_plan(project, 10, asked, idle=False)
    cue = plan.layers["arms"].cues[0]
    assert cue.end - cue.start == pytest.approx(1.2), "left in the middle of its swing"
    for moment in np.linspace(cue.start, cue.end + 0.3, 60):
        assert jump(plan, project, moment) < 2e-3


def test_a_clip_far_from_its_stance_is_led_in_and_out_too(project: Project, toy: Any) -> None:
    project = edits.move_actions(
        everywhere(project), [toy.id(project, "up point")], "gesture", toy.id(project, "rest")
    )
    plan = shown(project, toy, "up point")
    cue = plan.layers["arms"].cues[0]
    assert all(
        jump(plan, project, moment) < 2e-3 for moment in np.linspace(cue.start - 0.1, cue.end + 0.1, 60)
    )
    middle = (cue.start + cue.end) / 2
    assert apart(pose_at(plan, project, middle), clip_pose_at(project, cue.action, middle - cue.start)) < 1e-6


def test_a_clip_that_begins_far_from_its_stance_does_its_own_movement_no_more_than_it_shows(
    project: Project, toy: Any
) -> None:
    far = edits.add_clips(everywhere(project), [("waves.glb", 0, "", toy.clip("waves", 1.0, 1.5, swing=0.9))])
    [clip] = [e.id for e in far.clips.values() if e.name == "waves"]
    far = edits.update_actions(far, [toy.id(far, "rest long")], clip=clip)
    plan = shown(far, toy, "rest long")
    cue = plan.layers["arms"].cues[0]
    times = np.linspace(cue.start, cue.start + cue.blend_in, 30)
    stance = pose_at(make_plan(far, 10, idle=False), far, times).rotations
    own = clip_pose_at(far, cue.action, times - cue.start).rotations
    weight = np.broadcast_to(compute_cue_weight(cue, times)[:, None], own.shape[:2])
    arm = toy.skeleton.index("LeftUpperArm")
    expected = rotation.nlerp(stance, own, weight)[:, arm]
    there = pose_at(plan, far, times).rotations[:, arm]
    assert rotation.measure_angle_between(there, expected).max() < 1e-3


def test_a_clip_that_begins_in_its_stance_keeps_its_own_speed_while_it_blends_in(
    project: Project, toy: Any
) -> None:
    still = edits.add_clips(everywhere(project), [("still.glb", 0, "", toy.clip("still", 2.0, swing=0.0))])
    [clip] = [e.id for e in still.clips.values() if e.name == "still"]
    still = edits.update_actions(still, [toy.id(still, "rest loop")], clip=clip)
    plan = shown(still, toy, "rest long")
    cue = plan.layers["arms"].cues[0]
    times = np.linspace(cue.start, cue.end - 1e-6, 50)
    assert apart(pose_at(plan, still, times), clip_pose_at(still, cue.action, times - cue.start)) < 1e-5


def test_a_loop_comes_round_without_a_jump_with_and_without_a_seam(project: Project, toy: Any) -> None:
    opened = edits.add_clips(everywhere(project), [("open.glb", 0, "", toy.clip("open", 2.0, 0.0, 0.5))])
    [clip] = [e.id for e in opened.clips.values() if e.name == "open"]
    ident = toy.id(project, "rest loop")
    for blend, period in ((0.4, 1.6), (1.5, 1.0)):  # a seam is at most half the loop
        seamed = edits.update_actions(opened, [ident], clip=clip, timing={"blend_in": blend})
        plan = make_plan(seamed, 20, idle=False)
        assert all(jump(plan, seamed, m) < 1e-3 for m in np.arange(-1.0, 8, 0.05).round(6))
        assert all(jump(plan, seamed, n * period) < 1e-3 for n in range(1, 5))
        a, b = (
            pose_at(plan, seamed, 2 * period + 0.3),
            pose_at(plan, seamed, 5 * period + 0.3),
        )
        assert apart(a, b) < 1e-5, "each round is the same"
    assert jump(make_plan(project, 20, idle=False), project, 2.0) < 1e-3


def test_morph_targets_of_a_loop_come_round_without_a_jump_where_it_has_a_seam(
    project: Project, toy: Any
) -> None:
    clip = toy.clip("open", 2.0, 0.0, 0.5)
    rising = np.linspace(0.0, 1.0, clip.frames, dtype=np.float32)[:, None]
    opened = edits.add_clips(
        everywhere(project), [("open.glb", 0, "", replace(clip, morphs=("smile",), weights=rising))]
    )
    [ident] = [e.id for e in opened.clips.values() if e.name == "open"]

    def smiles(seam: float, times: Any) -> Any:
        seamed = edits.update_actions(
            opened, [toy.id(project, "rest loop")], clip=ident, timing={"blend_in": seam}
        )
        plan = make_plan(seamed, 20, idle=False)
        return np.array(
            [compute_morphs_at(plan, seamed, float(time), alive=False)["smile"] for time in times]
        )

    times = np.arange(1.0, 6.0, 0.01)
    assert np.abs(np.diff(smiles(0.4, times))).max() < 0.05
    assert np.abs(np.diff(smiles(0.0, times))).max() > 0.9
    middle, edges = smiles(0.4, [1.8])[0], (0.1, 0.9)
    assert middle == pytest.approx(sum(edges) / 2, abs=1e-3)


def test_a_seamed_loop_begins_anew_after_an_action_without_a_jump_even_where_the_action_leaves_joints_alone(
    project: Project, toy: Any
) -> None:
    opened = edits.add_clips(everywhere(project), [("open.glb", 0, "", toy.clip("open", 2.0, 0.0, 0.5))])
    [clip] = [e.id for e in opened.clips.values() if e.name == "open"]
    seamed = edits.update_actions(opened, [toy.id(project, "rest loop")], clip=clip, timing={"blend_in": 0.4})
    for name in ("rest beat lf", "rest short"):
        plan = shown(seamed, toy, name, 2.7)
        cue = plan.layers["arms"].cues[0]
        assert all(jump(plan, seamed, m) < 2e-3 for m in np.linspace(cue.start - 0.2, cue.end + 0.5, 200))


@pytest.mark.parametrize(("seconds", "seam"), [(0.0, 0.0), (1 / 30, 0.4), (2.0, -1.0)])
def test_loops_of_one_frame_and_odd_seams_stay_within_their_clip(
    toy: Any, seconds: float, seam: float
) -> None:
    project = edits.add_stance(
        edits.add_clips(Project(), [("a.glb", 0, "", toy.clip("a", seconds))]), "arms", "rest", ["c1"]
    )
    [action] = project.actions()
    project = edits.update_actions(project, [action.id], timing={"blend_in": seam})
    [action] = project.actions()
    elapsed = np.linspace(-3, 9, 200)
    for at in compute_loop_seconds(project, action, elapsed)[:2]:
        assert at.min() >= 0 and at.max() <= seconds + 1e-9
    assert np.isfinite(pose_at(make_plan(project, 5), project, elapsed).rotations).all()


@given(st.lists(st.floats(-5, 40), min_size=1, max_size=5), st.integers(0, 3))
@settings(max_examples=25, deadline=None)
def test_every_pose_is_finite_and_every_rotation_of_unit_length(times: list[float], seed: int) -> None:
    pose = pose_at(make_plan(PROJECT, 30, seed=seed), PROJECT, np.array(times))
    assert np.isfinite(pose.translations).all()
    assert np.allclose(np.linalg.norm(pose.rotations, axis=-1), 1, atol=1e-5)


def test_several_rests_at_one_moment_do_not_confuse_it(project: Project, toy: Any) -> None:
    plan = make_plan(project, 10, idle=False)
    rest = plan.layers["arms"].rests[0]
    twice = LayerPlan(
        "arms",
        (),
        (),
        (rest, Rest(rest.stance, rest.action, 1.0, 1.0, 0.0), Rest(rest.stance, rest.action, 1.0, 1.0, 0.5)),
    )
    both = Plan(1, 10.0, {**plan.layers, "arms": twice})
    assert np.isfinite(pose_at(both, project, np.linspace(0, 3, 31)).rotations).all()


# --- morphs


def test_morph_weights_add_up_over_layers_and_stay_between_0_and_1(toy: Any) -> None:
    clip = toy.clip("smile", 1.0, swing=0.0)
    smiling = replace(clip, morphs=("smile",), weights=np.full((clip.frames, 1), 0.7, np.float32))
    project = edits.add_clips(Project(), [("smile.glb", 0, "", smiling)])
    project = edits.add_stance(project, "head", "happy", ["c1"])
    assert compute_morphs_at(make_plan(project, 5), project, 1.0) == {"smile": pytest.approx(0.7)}
    project = edits.add_stance(project, "body", "happy", ["c1"])
    assert compute_morphs_at(make_plan(project, 5), project, 1.0) == {"smile": 1.0}
    assert compute_morphs_at(Plan(1, 0.0), project, 1.0) == {}


PROJECT = Project()


@pytest.fixture(autouse=True, scope="module")
def _project(toy: Any) -> None:
    global PROJECT
    PROJECT = toy.project()
    assert list(PROJECT.graphs) == list(LAYERS)


def test_a_face_that_is_asked_for_after_its_pose_is_the_one_it_would_be_alone(sample):
    plan, other = make_plan(sample, 20.0, seed=3), make_plan(sample, 20.0, seed=4)
    alone = {seconds: compute_morphs_at(plan, sample, seconds) for seconds in (2.0, 7.3)}
    for seconds, face in alone.items():
        pose_at(other, sample, seconds)
        assert compute_morphs_at(plan, sample, seconds) == face
        pose = pose_at(plan, sample, seconds)
        assert compute_morphs_at(plan, sample, seconds) == face
        assert np.array_equal(pose_at(plan, sample, seconds).rotations, pose.rotations)
