"""Motion laid over a plan: above the hips as it says, below as the plan does, without a jump at its ends."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from metagraph.graph import anatomy
from metagraph.graph.life import Life
from metagraph.graph.model import Project
from metagraph.graph.touch import Touch
from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.playback.planner import make_plan
from metagraph.playback.posing.overlay import BLEND, Overlay, find_overlaid_joints, make_clip_overlay
from tests.posing import overlaid, pose_at

TIMES = np.linspace(0.0, 6.0, 181)


@pytest.fixture(scope="module")
def plan(sample: Project):
    return make_plan(sample, 6.0, ())


@pytest.fixture(scope="module")
def clip(sample: Project) -> Clip:
    """Four seconds of the base pose with the right arm out."""
    base = anatomy.get_base_pose(sample)
    rotations = np.repeat(base.rotations[None], 101, 0)
    arm = anatomy.project_roles(sample)["right_upper_arm"]
    turn = rotation.exp(np.array([0.0, 0.0, 0.8]))
    rotations[:, arm] = rotation.multiply(rotations[:, arm], turn)
    root = np.repeat(base.translations[None, :1] + 0.5, 101, 0)  # half a metre off, which is not to be seen
    return Clip("made", sample.skeleton, 25.0, rotations, root)


def joints(project: Project, *parts: str) -> list[int]:
    return [j for j, part in enumerate(anatomy.project_parts(project)) if part in parts]


def full(project: Project, **shares: float) -> Overlay:
    at = find_overlaid_joints(project)
    turns = np.zeros((1, len(at), 4), np.float32)
    turns[..., 3] = 1
    values = {"weight": 1.0, "arms": 0.0, "head": 0.0, **shares}
    return Overlay(at, turns, *(np.array([values[k]]) for k in ("weight", "arms", "head")))


def test_legs_and_root_stay_with_the_plan(sample, plan, clip):
    sample = replace(sample, life=Life(follow_through=0))  # nobody answers arms that are not seen
    plain, made = (
        pose_at(plan, sample, TIMES),
        overlaid(plan, sample, TIMES, make_clip_overlay(sample, clip, TIMES)),
    )
    legs = joints(sample, "legs")
    assert np.abs(plain.rotations[:, legs] - made.rotations[:, legs]).max() < 1e-6
    assert np.abs(plain.translations - made.translations).max() < 1e-6
    arm = anatomy.project_roles(sample)["right_upper_arm"]
    assert np.abs(plain.rotations[60, arm] - made.rotations[60, arm]).max() > 0.2


def test_it_comes_and_goes_without_a_jump_and_ends_in_the_plan(sample, plan, clip):
    over = make_clip_overlay(sample, clip, TIMES)
    assert over.weight[0] == 0 and over.weight[TIMES > 4.0].max() == 0
    inside = (TIMES > BLEND) & (TIMES < 4.0 - BLEND)
    assert over.weight[inside].min() == 1.0
    sample = replace(sample, touch=Touch(guard=False))  # which brings hands out of what they pass through
    made = overlaid(plan, sample, TIMES, over, alive=False).rotations
    steps = np.abs(np.diff(made, axis=0)).max((1, 2))
    assert steps.max() < 0.12
    assert np.abs(made[-1] - pose_at(plan, sample, TIMES, alive=False).rotations[-1]).max() < 1e-6


def test_a_clip_shorter_than_both_blends_still_comes_and_goes(sample, clip):
    weight = make_clip_overlay(sample, clip.trimmed(0, 6), np.linspace(0, 0.2, 21)).weight
    assert weight[0] == 0 and weight[-1] == 0 and weight.max() > 0.9


def test_what_is_asked_of_the_arms_shows_the_plan_alone(sample, plan):
    asked = overlaid(plan, sample, 2.0, full(sample, arms=1.0))
    assert np.allclose(asked.rotations, pose_at(plan, sample, 2.0).rotations, atol=1e-5)


def test_what_is_asked_of_the_head_takes_the_head_alone(sample, plan):
    sample = replace(sample, touch=Touch(guard=False))  # which brings hands out of what they pass through
    arms = joints(sample, "arms")
    free, nod = (overlaid(plan, sample, 2.0, full(sample, head=x), alive=False) for x in (0.0, 1.0))
    assert np.allclose(free.rotations[arms], nod.rotations[arms], atol=1e-6)


def test_no_overlay_is_the_plan_bit_for_bit(sample, plan):
    for over in (None, full(sample, weight=0.0)):
        assert (overlaid(plan, sample, 2.0, over).rotations == pose_at(plan, sample, 2.0).rotations).all()


def test_one_time_gives_what_many_do(sample, plan, clip):
    many = overlaid(plan, sample, TIMES, make_clip_overlay(sample, clip, TIMES))
    one = overlaid(plan, sample, float(TIMES[50]), make_clip_overlay(sample, clip, TIMES[50:51]))
    assert np.allclose(one.rotations, many.rotations[50], atol=1e-6)


def test_a_clip_of_another_skeleton_is_refused(sample, clip):
    from dataclasses import replace

    from metagraph.motion.skeleton import Skeleton

    s = clip.skeleton
    names = tuple(f"x{n}" for n in s.names)
    other = replace(clip, skeleton=Skeleton(names, s.parents, s.rest_rotations, s.rest_translations))
    with pytest.raises(ValueError, match="another skeleton"):
        make_clip_overlay(sample, other, TIMES)
