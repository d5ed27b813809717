"""Measures, on motion of which they are known."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from metagraph.generation.features import encode_activity
from metagraph.generation.landmarks import HEAD, LANDMARKS, NOSE, WRISTS, place_landmarks
from metagraph.generation.poses import encode_clip, encode_rotations, find_rig
from metagraph.generation.statistics import (
    MEASURES,
    MotionSample,
    compute_measures,
    cut_blocks,
    make_motion_sample,
    mean_pose,
    measure_diversity,
    measure_system,
    measure_wasserstein,
    mismatch_speech,
    tabulate_measures,
)
from metagraph.generation.takes import Take, TakeMarks, TakeSource
from metagraph.motion import rotation
from tests.generation.makers import moving, rig

FPS = 25


def _talker(seed: int, seconds: float = 60, hear: int | None = None, wander: float = 0.3) -> MotionSample:
    """Somebody whose hands are fast at own peaks and who nods with responses. hear: seed of what is said."""
    say = np.random.default_rng(1000 + (seed if hear is None else hear))
    chance = np.random.default_rng(seed)
    count = round(seconds * FPS)
    at = np.arange(4, seconds - 4, 4.0)
    own = say.permutation(len(at)) % 2 == 0
    at = at + say.uniform(-1, 1, len(at))
    peaks, responses = at[own], at[~own]
    t = np.arange(count) / FPS
    points = np.tile(np.arange(27.0).reshape(1, 9, 3) / 20, (count, 1, 1))
    points += 0.004 * np.cumsum(chance.standard_normal((count, 9, 3)), 0) * wander
    for peak in peaks:
        points[:, list(WRISTS), 1] += 0.3 * np.exp(-(((t - peak) / 0.12) ** 2))[:, None]
    for begin in responses:
        inside = (t >= begin) & (t < begin + 0.8)
        points[inside, NOSE, 1] += 0.03 * np.sin(8 * (t[inside] - begin))
    speaking = np.zeros(count, bool)
    for peak in peaks:
        speaking |= np.abs(t - peak) < 1.5
    poses = points.reshape(count, 27)
    return MotionSample(
        points, poses, encode_activity(speaking, ~speaking), TakeMarks(tuple(peaks), tuple(responses))
    )


TRUE = [_talker(1), _talker(2)]
RESTING = [_talker(1, wander=0.02), _talker(2, wander=0.02)]


def test_motion_beside_itself_is_perfect():
    same = compute_measures(TRUE, TRUE)
    assert tuple(same) == MEASURES
    for name, value in {
        "distance": 0,
        "speed": 1,
        "speed_w1": 0,
        "acceleration": 1,
        "wrist_range": 1,
        "still": 1,
        "trembling": 1,
    }.items():
        assert same[name] == pytest.approx(value, abs=1e-9)
    assert same["role_w1"] == pytest.approx(0, abs=1e-9)
    assert same["profile"] == pytest.approx(1)
    assert same["frechet"] == pytest.approx(0, abs=1e-6)
    assert same["role"] > 1.2
    assert same["stroke"] > 2
    assert same["nods_responses"] > 1.5
    assert np.isnan(same["nods_hesitations"])  # nobody hesitates


def test_other_speech_takes_the_coupling_and_leaves_the_space():
    wrong, same = compute_measures(mismatch_speech(TRUE), TRUE), compute_measures(TRUE, TRUE)
    assert wrong["speed"] == pytest.approx(1, abs=0.03)
    assert wrong["distance"] < 0.01
    assert wrong["stroke"] < 0.5 * same["stroke"]
    assert wrong["nods_responses"] < 0.8 * same["nods_responses"]
    assert wrong["profile"] < 0.8
    alone = compute_measures(mismatch_speech(TRUE[:1]), TRUE[:1])
    assert alone["stroke"] < 0.6 * same["stroke"]


def test_a_mean_pose_stands_still_in_the_middle():
    held = compute_measures(mean_pose(TRUE), TRUE)
    assert held["speed"] == pytest.approx(0)
    assert held["wrist_range"] == pytest.approx(0)
    assert held["distance"] > 0.5
    assert held["frechet"] > 1
    assert np.isnan(held["profile"])


def test_trembling_shows_in_the_acceleration_most():
    chance = np.random.default_rng(3)
    trembling = [
        replace(m, landmarks=m.landmarks + 0.004 * chance.standard_normal(m.landmarks.shape)) for m in TRUE
    ]
    shaken = compute_measures(trembling, TRUE)
    assert shaken["acceleration"] > shaken["speed"] > 1.2
    assert shaken["distance"] < 0.2


def test_hands_that_rest_tremble_by_what_they_do_while_they_rest_and_not_by_gestures():
    chance = np.random.default_rng(3)
    little = [
        replace(m, landmarks=m.landmarks + 3e-4 * chance.standard_normal(m.landmarks.shape)) for m in RESTING
    ]
    shaken, calm = compute_measures(little, RESTING), compute_measures(RESTING, RESTING)
    assert calm["still"] == pytest.approx(1) and calm["trembling"] == pytest.approx(1)
    assert shaken["still"] == pytest.approx(1, abs=0.05)
    assert shaken["trembling"] > 3
    assert shaken["trembling"] > shaken["acceleration"]  # of all, gestures too
    restless = [
        replace(m, landmarks=m.landmarks + 5e-3 * chance.standard_normal(m.landmarks.shape)) for m in RESTING
    ]
    never = compute_measures(restless, RESTING)
    assert never["still"] == 0 and np.isnan(never["trembling"])


def test_half_the_size_is_half_the_speed():
    middle = np.concatenate([m.landmarks for m in TRUE]).mean(0)
    small = [replace(m, landmarks=middle + 0.5 * (m.landmarks - middle)) for m in TRUE]
    half = compute_measures(small, TRUE)
    assert half["speed"] == pytest.approx(0.5)
    assert half["acceleration"] == pytest.approx(0.5)
    assert half["wrist_range"] == pytest.approx(0.5, abs=0.02)
    assert half["role"] == pytest.approx(compute_measures(TRUE, TRUE)["role"])


def test_the_distance_between_sets_is_how_far_one_is_moved():
    chance = np.random.default_rng(1)
    a = chance.standard_normal(3000)
    assert measure_wasserstein(a, a + 2) == pytest.approx(2)
    assert measure_wasserstein(a, np.concatenate([a, a])) < 0.02
    assert measure_wasserstein(a, 3 * a) == pytest.approx(2 * np.abs(a).mean(), rel=0.02)
    assert np.isnan(measure_wasserstein(a, a[:0]))


def test_seeds_that_move_alike_have_no_diversity():
    moved = [replace(m, landmarks=m.landmarks + [0.03, 0, 0.04]) for m in TRUE]
    assert measure_diversity([TRUE, TRUE]) == 0
    assert measure_diversity([TRUE, moved]) == pytest.approx(5)
    assert np.isnan(measure_diversity([TRUE]))


def test_blocks_are_fifteen_seconds_and_keep_their_marks():
    pieces = cut_blocks([_talker(1, 37), _talker(2, 7)])
    assert [len(p) for p in pieces] == [375, 550, 175]
    marks = [m + at for p, at in zip(pieces[:2], (0, 15), strict=True) for m in p.marks.peaks]
    assert sorted(marks) == pytest.approx(sorted(_talker(1, 37).marks.peaks))


def test_a_row_has_an_interval_about_its_value():
    made = [[_talker(11, hear=1), _talker(12, hear=2)], [_talker(21, hear=1), _talker(22, hear=2)]]
    found = measure_system("good", made, TRUE, draws=40)
    low, high = found.spread["stroke"]
    assert low < found.values["stroke"] < high
    assert high - low < found.values["stroke"]
    assert found.values["diversity"] > 0
    assert measure_system("good", made, TRUE, draws=40).spread == found.spread
    assert "nods_hesitations" not in found.spread


def test_a_table_has_what_must_stand_beside():
    rows = tabulate_measures({"model": [TRUE]}, TRUE, draws=3)
    assert [r.name for r in rows] == ["floor", "mismatched", "mean pose", "model"]
    assert rows[0].values["frechet"] < rows[2].values["frechet"]
    other = tabulate_measures({}, TRUE, floor=[_talker(11, hear=1), _talker(12, hear=2)], draws=2)
    assert other[0].values["distance"] > 0


def test_nothing_to_compare_is_told():
    with pytest.raises(ValueError, match="no motion to compare"):
        compute_measures([], TRUE)
    with pytest.raises(ValueError, match="no motion to compare"):
        compute_measures([TRUE[0].part(0, 2)], TRUE)


def test_the_nose_is_before_the_head_and_hands_follow_the_arms():
    own = rig()
    still = place_landmarks(own, encode_rotations(own, own.base)[None])[0]
    place = dict(zip(LANDMARKS, still, strict=True))
    assert np.allclose(place["nose"] - place["head"], [0, 0, 0.12], atol=0.02)
    assert place["left_wrist"][0] > 0.1 > -0.1 > place["right_wrist"][0]
    assert place["sternum"][1] < place["head"][1]
    assert abs(place["sternum"][0]) < 0.01
    turned = own.base.copy()
    joint = own.joints[own.roles.index("right_upper_arm")]
    turned[joint] = rotation.multiply(turned[joint], rotation.from_axis_angle([1, 0, 0], 1.0))
    moved = np.linalg.norm(place_landmarks(own, encode_rotations(own, turned)[None])[0] - still, axis=-1)
    assert moved[WRISTS[1]] > 0.1
    assert moved[[WRISTS[0], HEAD, NOSE]].max() < 1e-4


def test_landmarks_are_where_the_whole_skeleton_has_them():
    own, clip = rig(), moving(2, fps=25.0)
    seen = place_landmarks(own, encode_clip(own, clip, 25.0))
    _, points = clip.skeleton.globals(clip.poses())
    hand = own.joints[own.roles.index("left_hand")]
    assert np.abs(seen[:, WRISTS[0]] - points[:, hand]).max() < 1e-3


def test_a_skeleton_without_collar_bones_has_a_sternum():
    own = rig()
    roles = dict(zip(own.roles, own.joints, strict=True))
    for role in ("left_shoulder", "right_shoulder", "neck"):
        del roles[role]
    few = find_rig(own.skeleton, roles)
    seen = place_landmarks(few, encode_rotations(few, few.base)[None])[0]
    assert np.isfinite(seen).all()
    assert np.allclose(seen[0], seen[1:3].mean(0))


def test_generated_poses_are_measured_with_what_a_take_hears():
    clip, own = moving(5, fps=25.0), rig()
    poses = encode_clip(own, clip, 25.0)
    features = np.concatenate(
        [np.zeros((len(poses), 27)), encode_activity(poses[:, 0] > 9, poses[:, 0] < 9)], 1
    )
    take = Take(TakeSource("x"), poses, features.astype(np.float32), TakeMarks((1.0,)))
    made = make_motion_sample(own, poses[:100], take)
    assert len(made) == 100
    assert made.marks.peaks == (1.0,)
    assert made.activity.shape == (100, 4)
