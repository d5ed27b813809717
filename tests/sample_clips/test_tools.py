"""The toolkit the clips are made with: limbs that reach, steps that add up, hands that mirror."""

from __future__ import annotations

import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from metagraph.formats.gltf.reader import read_gltf_clips
from metagraph.motion import rotation
from metagraph.playback.posing.contacts import measure_contact_depths
from sample_clips.make import before_after, ik, key_poses, motion_tracks, secondary
from sample_clips.make.hands import SHAPES, finger_rotations
from sample_clips.make.mannequin_rig import REST, SIDES, SKELETON, at
from sample_clips.make.motion_tracks import Move, Step
from sample_clips.make.recipe import Recipe, animate, go, home
from sample_clips.make.stance_clips import BASE, HIP
from tests.posing import contact_rig

CLIPS = Path(__file__).resolve().parents[2] / "sample_clips" / "clips"


def ends(first: np.ndarray, second: np.ndarray, upper: float, lower: float) -> np.ndarray:
    return first * upper + second * lower


def test_two_bones_reach_a_target_within_reach() -> None:
    target = np.array([[0.2, -0.3, 0.1], [0.0, 0.4, 0.05]])
    first, second, _ = ik.two_bones(np.zeros(3), target, np.array([0.0, 0, 1.0]), 0.3, 0.25)
    assert np.allclose(ends(first, second, 0.3, 0.25), target, atol=1e-9)


def test_two_bones_stretch_towards_a_target_out_of_reach_without_becoming_quite_straight() -> None:
    first, second, hinge = ik.two_bones(
        np.zeros(3), np.array([0.0, -2.0, 0.0]), np.array([0.0, 0, 1.0]), 0.3, 0.25
    )
    end = ends(first, second, 0.3, 0.25)
    assert end[1] < -0.54
    assert 0.9 < first @ second < 1
    assert np.allclose(np.abs(hinge), [1, 0, 0])


def test_two_bones_bear_a_target_at_their_own_root() -> None:
    first, second, _ = ik.two_bones(np.zeros(3), np.zeros(3), np.array([0.0, 0, 1.0]), 0.3, 0.25)
    assert np.isfinite(first).all()
    assert np.isfinite(second).all()


def test_an_arm_s_wrist_is_where_the_posture_says_and_both_sides_mirror() -> None:
    posture = replace(BASE, left=HIP, right=HIP)
    turns = key_poses.solve(posture)
    _, places = SKELETON.globals(type(SKELETON.rest)(turns, SKELETON.rest_translations))
    assert np.allclose(places[at("LeftHand")], HIP.at, atol=1e-6)
    assert np.allclose(places[at("RightHand")], np.array(HIP.at) * [-1, 1, 1], atol=1e-6)


def test_feet_stay_where_they_are_while_the_hips_move() -> None:
    numbers = np.tile(key_poses.channels(BASE), (5, 1))
    numbers[:, 0] = np.linspace(-0.05, 0.05, 5)
    turns, root = key_poses.legs(np.tile(key_poses.solve(BASE), (5, 1, 1)), numbers)
    translations = np.tile(SKELETON.rest_translations, (5, 1, 1))
    translations[:, 0] = root
    _, places = SKELETON.globals(type(SKELETON.rest)(turns, translations))
    for side in SIDES:
        assert np.ptp(places[:, at(side + "Toes")], axis=0).max() < 1e-6
    assert places[0, at("LeftToes"), 1] == pytest.approx(REST[at("LeftToes"), 1], abs=1e-6)


@pytest.mark.parametrize("shape", sorted(SHAPES))
def test_every_hand_shape_turns_all_fifteen_finger_joints(shape: str) -> None:
    turns = finger_rotations(shape)
    assert len(turns) == 15
    assert all(np.isclose(np.linalg.norm(q), 1) for q in turns.values())


@pytest.mark.parametrize("peak", [0.3, 0.42, 0.5, 0.65])
def test_an_ease_goes_from_nothing_to_all_without_turning_back_and_is_fastest_at_its_peak(
    peak: float,
) -> None:
    u = np.linspace(0, 1, 401)
    w = motion_tracks.ease(u, peak)
    assert w[0] == 0
    assert w[-1] == pytest.approx(1)
    assert (np.diff(w) >= 0).all()
    assert u[np.argmax(np.diff(w))] == pytest.approx(peak, abs=0.02)
    assert motion_tracks.ease(-1.0, peak) == 0
    assert motion_tracks.ease(2.0, peak) == pytest.approx(1)


def test_a_step_with_anticipation_and_overshoot_dips_back_runs_over_and_ends_at_one() -> None:
    move = Move(Step(0.5, hold=0.3, overshoot=0.08, anticipation=0.06), 1.0, 1.5, 2.2)
    w = motion_tracks.progress(move, np.linspace(0, 3, 301))
    assert w[0] == 0
    assert w[-1] == pytest.approx(1)
    assert w.min() < -0.01
    assert w.max() > 1.03


@pytest.mark.parametrize("loop", [True, False])
@pytest.mark.parametrize("frames", [2, 10, 200])
def test_drifts_are_nothing_on_the_first_and_last_frame(frames: int, loop: bool) -> None:
    out = motion_tracks.wander(np.random.default_rng(1), frames, 0.5, 3, loop)
    assert out.shape == (frames, 3)
    assert np.allclose(out[[0, -1]], 0)


def test_a_recipe_that_does_not_come_home_is_refused_by_name() -> None:
    recipe = Recipe("lost", "arms", "gesture", "hands_at_sides", "hands_at_sides", (go(0.4, rt=HIP),))
    with pytest.raises(ValueError, match="lost does not end"):
        animate(recipe)


def test_a_recipe_of_one_step_home_stands_still_but_for_its_life() -> None:
    clip = animate(
        Recipe("still", "arms", "gesture", "hands_at_sides", "hands_at_sides", (home(0.8),), life=0.0)
    )
    turns = rotation.measure_angle_between(clip.rotations.astype(float), clip.rotations[:1].astype(float))
    assert np.degrees(turns.max()) < 0.1


def test_a_pinned_hand_stays_where_it_was_while_the_torso_bends() -> None:
    turns = np.tile(key_poses.solve(replace(BASE, left=HIP, right=HIP)), (4, 1, 1))
    turns[:, at("Chest")] = rotation.from_axis_angle(np.array([1.0, 0, 0]), np.radians([0.0, 2, 4, 6]))
    _, loose = secondary.globals_of(turns)
    _, held = secondary.globals_of(secondary.pin(turns, "Left", "Hips"))
    assert np.ptp(loose[:, at("LeftHand")], axis=0).max() > 0.005
    assert np.ptp(held[:, at("LeftHand")], axis=0).max() < 1e-6


@pytest.mark.nightly
def test_a_clip_is_drawn_before_and_after_a_change(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for folder in ("old", "new"):
        (tmp_path / folder).mkdir()
    name = "hands_at_sides__flick_fingers_rt_01"
    shutil.copy(CLIPS / f"{name}.glb", tmp_path / "new")
    shutil.copy(CLIPS / "on_hips__stance.glb", tmp_path / "new")
    for other in (f"{name}.glb", "on_hips__stance.glb"):
        shutil.copy(CLIPS / "on_hips__stance.glb", tmp_path / "old" / other)
    said = ["x", str(tmp_path / "out"), "--before", str(tmp_path / "old"), "--after", str(tmp_path / "new")]
    monkeypatch.setattr("sys.argv", [*said, "--columns", "2"])
    before_after.main()
    assert [p.stem for p in (tmp_path / "out").iterdir()] == [name]  # the other did not change


def test_a_transition_plays_to_its_end_with_its_hands_where_they_touch() -> None:
    (clip,) = read_gltf_clips(CLIPS / "hands_at_sides__to__arms_crossed.glb")
    project = before_after.base_project()
    pose = before_after.played(project, clip, np.array([0.0, clip.duration]))
    rig = contact_rig(project)
    assert rig is not None
    assert measure_contact_depths(rig, pose).max() < 0.004
    assert np.linalg.norm(np.diff(SKELETON.globals(pose)[1][:, at("RightHand")], axis=0)) > 0.3
