"""Hands that touch their own body, brought over."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import settings as hypothesis_settings
from hypothesis import strategies as st

from metagraph.formats.clips import read_clips
from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.motion.joint_map import JointMap, propose_joint_map
from metagraph.motion.own_contact import OwnContact
from metagraph.motion.retarget import retarget
from metagraph.motion.standing import find_standing_pose
from tests.retarget_measures import contact_errors, figures, motion, variant

CLIPS = Path(__file__).parents[2] / "sample_clips" / "clips"


def ours(name: str) -> Clip:
    return read_clips(CLIPS / f"{name}.glb")[0]


def both(clip: Clip, target: Any) -> list[Clip]:
    """Brought over without contacts, and with."""
    joint_map = propose_joint_map(clip.skeleton, target)
    return [retarget(clip, target, replace(joint_map, contacts=on)) for on in (False, True)]


@pytest.mark.nightly
@given(st.floats(0.9, 1.3), st.floats(0.8, 1.4), st.floats(0.8, 1.2))
@hypothesis_settings(max_examples=8, deadline=None)
def test_hands_meet_their_own_body_on_figures_built_otherwise(
    arms: float, shoulders: float, trunk: float
) -> None:
    clip = ours("hands_clasped__stance").trimmed(0, 40)
    target = variant(clip.skeleton, arms, shoulders, trunk)
    rest = clip.skeleton.rest
    off, on = (contact_errors(clip, target, rest, target.rest, carried) for carried in (False, True))
    assert len(on[1])
    assert np.percentile(on[1], 95) < max(
        0.006, 0.25 * np.percentile(off[1], 95)
    )  # of its height: a centimetre


@pytest.mark.parametrize("name", ["arms_crossed__stance", "hand_to_chin__stance", "on_hips__stance"])
def test_a_touch_is_nearer_its_place_on_a_broader_figure(name: str) -> None:
    clip = ours(name)
    target = variant(clip.skeleton)
    off, on = (
        contact_errors(clip, target, clip.skeleton.rest, target.rest, carried) for carried in (False, True)
    )
    assert np.percentile(on[0], 95) < 0.7 * np.percentile(off[0], 95)


def test_hands_that_only_hang_beside_the_thighs_stay_where_they_are() -> None:
    clip = ours("hands_at_sides__stance").trimmed(0, 40)
    for target in (variant(clip.skeleton), variant(clip.skeleton, 1.1, 0.8, 1.1)):
        off, on = both(clip, target)
        assert np.array_equal(off.rotations, on.rotations)


def test_onto_itself_nothing_moves() -> None:
    clip = ours("hands_clasped__stance")
    off, on = both(clip, clip.skeleton)
    assert np.degrees(rotation.measure_angle_between(off.rotations, on.rotations).max()) < 0.3


def test_frames_far_from_a_touch_and_all_but_the_arms_stay_to_the_bit() -> None:
    clip = ours("hands_at_sides__wave_hello_rt_01")
    target = variant(clip.skeleton)
    off, on = both(clip, target)
    pair = figures(clip, target, propose_joint_map(clip.skeleton, target), clip.skeleton.rest, target.rest)
    near = OwnContact(*pair, *motion(pair[0], clip)).near["right"]
    arm = {target.index(f"Right{part}") for part in ("UpperArm", "LowerArm", "Hand")}
    free = np.flatnonzero(np.convolve(near > 0, np.ones(41), "same") == 0)
    assert len(free) > 5
    np.testing.assert_array_equal(
        off.rotations[np.ix_(free, sorted(arm))], on.rotations[np.ix_(free, sorted(arm))]
    )
    arms = arm | {target.index(f"Left{part}") for part in ("UpperArm", "LowerArm", "Hand")}
    rest = [j for j in range(len(target)) if j not in arms]
    np.testing.assert_array_equal(off.rotations[:, rest], on.rotations[:, rest])


def test_hands_keep_their_turn_in_the_room() -> None:
    clip = ours("hands_clasped__stance")
    off, on = both(clip, variant(clip.skeleton))
    hands = [clip.skeleton.index(f"{side}Hand") for side in ("Left", "Right")]
    turned = rotation.measure_angle_between(*(x.skeleton.globals(x.poses())[0][:, hands] for x in (off, on)))
    assert np.degrees(turned.max()) < 0.2


@pytest.mark.parametrize("name", ["hands_at_sides__to__hands_clasped", "hands_at_sides__to__hand_to_chin"])
def test_hands_come_to_a_touch_and_leave_it_without_a_jerk(name: str) -> None:
    clip = ours(name)
    target = variant(clip.skeleton)
    off, on = (
        contact_errors(clip, target, clip.skeleton.rest, target.rest, carried) for carried in (False, True)
    )
    assert on[2] < 1.5 * off[2] + 1  # heights / s2


def test_a_place_far_out_of_reach_is_not_reached_for() -> None:
    clip = ours("hands_clasped__stance")
    stubs = variant(clip.skeleton, arms=0.35)
    off, on = both(clip, stubs)
    wrists = [x.skeleton.globals(x.poses())[1][:, stubs.index("LeftHand")] for x in (off, on)]
    assert np.isfinite(on.rotations).all()
    assert np.linalg.norm(wrists[1] - wrists[0], axis=-1).max() < 0.35 * 0.6


@pytest.mark.parametrize("frames", [1, 2, 3])
def test_a_clip_of_hardly_any_frames_comes_through(frames: int) -> None:
    clip = ours("hands_clasped__stance").trimmed(0, frames)
    _, on = both(clip, variant(clip.skeleton))
    assert on.frames == frames and np.isfinite(on.rotations).all()


def test_a_map_remembers_that_hands_are_left_alone(toy: Any) -> None:
    free = replace(propose_joint_map(toy.skeleton, toy.skeleton), contacts=False)
    assert JointMap.from_json(free.to_json()) == free == free.reversed
    assert JointMap.from_json({**free.to_json(), "contacts": True}).contacts
    assert (
        "contacts" not in replace(free, contacts=True).to_json()
    )  # files of those who never ask stay as they are


def test_hands_of_a_real_talker_touch_on_another(shared_data: Path) -> None:
    mannequin = ours("hands_clasped__stance").skeleton
    target = variant(mannequin)
    gaps: list[list[np.ndarray]] = [[], []]
    for name in ("Idle01_ScratchChest01", "Idle01_Contemplate01", "Idle01_SqueezeHand01"):
        clip = read_clips(next((shared_data / "smartbody-brad").rglob(f"*{name}.bvh")))[0]
        for carried in (False, True):
            gaps[carried].append(
                contact_errors(clip, target, find_standing_pose(clip), target.rest, carried)[0]
            )
    off, on = (np.concatenate(some) for some in gaps)
    assert len(on) > 30 and np.median(on) < 0.5 * np.median(off)
