"""Keypoints in three dimensions become motion."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from metagraph.formats.clips import read_clips
from metagraph.graph.model import Project
from metagraph.mimicry.keypoint_layouts import POINTS, KeypointTrack
from metagraph.mimicry.keypoint_take import KeypointTakeError, make_clip_from_keypoints
from metagraph.motion.clip import Clip
from metagraph.motion.roles import find_roles
from metagraph.motion.skeleton import Skeleton

Array = NDArray[Any]
FROM = {
    "shoulder": "upper_arm",
    "elbow": "lower_arm",
    "wrist": "hand",
    "hip": "upper_leg",
    "knee": "lower_leg",
    "ankle": "foot",
}


def seen(clip: Clip, noise: float = 0.0) -> KeypointTrack:
    """What an estimator without mistakes would see of a clip: joints, and a face before the head's joint."""
    roles = find_roles(clip.skeleton)
    turns, places = clip.skeleton.globals(clip.poses())
    rest_turns = clip.skeleton.globals(clip.skeleton.rest)[0]
    from metagraph.motion import rotation

    head = roles["head"]
    turned = rotation.multiply(turns[:, head], rotation.conjugate(rest_turns[head]))
    size = clip.skeleton.height
    face = {"nose": (0, 0.03, 0.075), "left_ear": (0.045, 0.05, 0), "right_ear": (-0.045, 0.05, 0)}
    face |= {"left_eye": (0.02, 0.055, 0.06), "right_eye": (-0.02, 0.055, 0.06)}
    points = []
    for name in POINTS:
        if name in face:
            points.append(places[:, head] + rotation.rotate_vectors(turned, size * np.array(face[name])))
        else:
            side, part = name.split("_")
            points.append(places[:, roles[f"{side}_{FROM[part]}"]])
    shown = np.stack(points, 1) + np.random.default_rng(1).normal(0, noise, (len(places), len(POINTS), 3))
    return KeypointTrack(np.arange(len(places)) / clip.fps, shown, np.ones(shown.shape[:2]), POINTS, 3)


def off(clip: Clip, made: Clip) -> Array:
    """How far the hands, elbows, knees and the head are off, seen from the hips, in heights `[F, 7]`."""
    roles = find_roles(clip.skeleton)
    names = [f"{s}_{r}" for s in ("left", "right") for r in ("hand", "lower_arm", "lower_leg")] + ["head"]
    out = []
    for one in (clip, made):
        places = one.skeleton.globals(one.poses())[1]
        at = np.arange(made.frames) / made.fps
        own = np.arange(len(places)) / one.fps
        joints = [roles[n] for n in names]
        from_hips = places[:, joints] - places[:, [roles["hips"]]]
        out.append(
            np.stack(
                [[np.interp(at, own, from_hips[:, j, x]) for x in range(3)] for j in range(7)]
            ).transpose(2, 0, 1)
        )
    return np.linalg.norm(out[0] - out[1], axis=-1) / clip.skeleton.height


def test_flat_or_single_keypoints_are_refused_with_what_to_do(sample: Project) -> None:
    clip = next(c.motion for c in sample.clips.values() if c.motion is not None)
    whole = seen(clip)
    with pytest.raises(KeypointTakeError, match="no depth"):
        make_clip_from_keypoints(replace(whole, dims=2), clip.skeleton, "x")
    one = KeypointTrack(whole.times[:1], whole.points[:1], whole.confidence[:1], POINTS, 3)
    with pytest.raises(KeypointTakeError, match="one frame"):
        make_clip_from_keypoints(one, clip.skeleton, "x")
    blind = whole.confidence.copy()
    blind[:, POINTS.index("left_wrist")] = 0
    with pytest.raises(KeypointTakeError, match="left wrist"):
        make_clip_from_keypoints(replace(whole, confidence=blind), clip.skeleton, "x")
    ball = Skeleton(("root",), np.array([-1]), np.array([[0, 0, 0, 1.0]]), np.zeros((1, 3)))
    with pytest.raises(KeypointTakeError, match="no hips"):
        make_clip_from_keypoints(whole, ball, "x")


def test_the_samples_gestures_are_made_again_from_what_is_seen_of_them(sample: Project) -> None:
    clips = [c.motion for c in sample.clips.values() if c.motion is not None][::12]
    errors = np.concatenate(
        [off(c, make_clip_from_keypoints(seen(c), c.skeleton, c.name)).reshape(-1, 7) for c in clips]
    )
    assert np.median(errors) < 0.02 and np.percentile(errors, 95) < 0.06


def test_a_face_that_is_not_seen_lets_the_head_follow_the_chest(sample: Project) -> None:
    clip = next(c.motion for c in sample.clips.values() if c.motion is not None)
    whole = seen(clip)
    hidden = whole.confidence.copy()
    hidden[:, :5] = 0
    made = make_clip_from_keypoints(replace(whole, confidence=hidden), clip.skeleton, "x")
    assert np.isfinite(made.rotations).all()


def test_gaps_are_bridged_and_noise_does_not_tremble(sample: Project) -> None:
    clip = next(c.motion for c in sample.clips.values() if c.motion is not None and c.motion.duration > 2)
    whole = seen(clip, noise=0.004)
    gone = whole.confidence.copy()
    gone[20:28, POINTS.index("left_wrist")] = 0
    made = make_clip_from_keypoints(replace(whole, confidence=gone), clip.skeleton, "x")
    assert np.percentile(off(clip, made), 95) < 0.08
    steps = np.abs(np.diff(made.rotations, 3, axis=0)).max()
    assert steps < 0.2


def test_feet_stay_on_the_floor_whatever_size_the_person_has(sample: Project) -> None:
    clip = next(c.motion for c in sample.clips.values() if c.motion is not None)
    small = seen(clip)
    small = replace(small, points=small.points * 0.4)
    made, same = (
        make_clip_from_keypoints(small, clip.skeleton, "x"),
        make_clip_from_keypoints(seen(clip), clip.skeleton, "x"),
    )
    assert np.abs(made.rotations - same.rotations).max() < 1e-4
    roles = find_roles(clip.skeleton)
    feet = made.skeleton.globals(made.poses())[1][:, [roles["left_foot"], roles["right_foot"]], 1].min(-1)
    floor = made.skeleton.globals(made.skeleton.rest)[1][[roles["left_foot"], roles["right_foot"]], 1].min()
    assert np.abs(feet - floor).max() < 0.03


def test_other_studios_takes_are_made_again_too(shared_data: Path) -> None:
    """Skeletons nobody here made: other rests, names and proportions."""
    some = sorted((shared_data / "bandai-namco-1").rglob("*.bvh"))[:4]
    errors = []
    for path in some:
        clip = read_clips(path)[0]
        errors.append(
            off(clip, make_clip_from_keypoints(seen(clip), clip.skeleton, clip.name)).reshape(-1, 7)
        )
    assert np.median(np.concatenate(errors)) < 0.045


def test_elbows_and_knees_bend_in_one_plane_of_the_upper_limb(sample: Project) -> None:
    """An arm may be where it should and yet be twisted: it bends in a plane that stays with it."""
    from metagraph.motion import rotation

    clips = [c.motion for c in sample.clips.values() if c.motion is not None][::24]
    turned = []
    for clip in clips:
        made = make_clip_from_keypoints(seen(clip), clip.skeleton, clip.name)
        roles = find_roles(clip.skeleton)
        turns, places = made.skeleton.globals(made.poses())
        for side in ("left", "right"):
            upper, lower, hand = (roles[f"{side}_{r}"] for r in ("upper_arm", "lower_arm", "hand"))
            one, two = places[:, lower] - places[:, upper], places[:, hand] - places[:, lower]
            plane = np.cross(one, two)
            plane /= np.linalg.norm(one, axis=-1, keepdims=True) * np.linalg.norm(two, axis=-1, keepdims=True)
            bent = np.linalg.norm(plane, axis=-1) > 0.35  # clearly: straighter arms keep the plane they had
            own = rotation.rotate_vectors(rotation.conjugate(turns[bent, upper]), plane[bent])
            turned.append(own / np.linalg.norm(own, axis=-1, keepdims=True) * (1 if side == "left" else -1))
    for side in (0, 1):
        planes = np.concatenate(turned[side::2])
        assert len(planes) > 100
        middle = planes.mean(0) / np.linalg.norm(planes.mean(0))
        assert np.degrees(np.arccos(np.clip(planes @ middle, -1, 1))).max() < 5


def test_who_is_unseen_for_long_stays_as_last_seen(sample: Project) -> None:
    clip = next(c.motion for c in sample.clips.values() if c.motion is not None)
    whole = seen(clip)
    still = np.repeat(whole.points[:1], 90, 0)
    wrist = POINTS.index("left_wrist")
    elbow = still[0, POINTS.index("left_elbow")]
    bent = np.linalg.norm(still[0, wrist] - elbow)
    angle = np.linspace(0, np.pi / 2, 90)
    still[:, wrist] = elbow + bent * np.stack([0 * angle, np.sin(angle) - 0.5, np.cos(angle)], -1)
    sure = np.ones(still.shape[:2])
    sure[20:70, wrist] = 0
    made = make_clip_from_keypoints(
        KeypointTrack(np.arange(90) / 30, still, sure, POINTS, 3), clip.skeleton, "x"
    )
    hand = find_roles(clip.skeleton)["left_hand"]
    places = made.skeleton.globals(made.poses())[1][:, hand]
    gap = places[26:64]
    assert np.linalg.norm(gap - gap[0], axis=-1).max() < 1e-6
    assert np.linalg.norm(places[80] - gap[0]) > 0.05


def test_somebody_seen_from_the_hips_up_stands_on_straight_legs(sample: Project) -> None:
    clip = next(c.motion for c in sample.clips.values() if c.motion is not None and "open_palms" in c.name)
    whole = seen(clip)
    hidden = whole.confidence.copy()
    hidden[:, [n for n, name in enumerate(POINTS) if name.endswith(("knee", "ankle"))]] = 0.0
    made = make_clip_from_keypoints(replace(whole, confidence=hidden), clip.skeleton, "x")
    assert made.notes == ("knees or feet were not seen, so the character stands on straight legs",)
    roles = find_roles(clip.skeleton)
    places = made.skeleton.globals(made.poses())[1]
    for side in ("left", "right"):
        leg = places[:, roles[f"{side}_foot"]] - places[:, roles[f"{side}_upper_leg"]]
        assert (-leg[:, 1] > 0.99 * np.linalg.norm(leg, axis=-1)).all()
    arms = [0, 1, 3, 4]
    np.testing.assert_allclose(
        off(clip, made)[:, arms],
        off(clip, make_clip_from_keypoints(whole, clip.skeleton, "x"))[:, arms],
        atol=1e-3,
    )


def test_somebody_without_hips_is_refused(sample: Project) -> None:
    clip = next(c.motion for c in sample.clips.values() if c.motion is not None)
    whole = seen(clip)
    hidden = whole.confidence.copy()
    hidden[:, POINTS.index("left_hip")] = 0.0
    with pytest.raises(KeypointTakeError, match="the left hip was never seen"):
        make_clip_from_keypoints(replace(whole, confidence=hidden), clip.skeleton, "x")
