"""Poses brought to life: added to what the layers play, pure in time, without a jump, on any body."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
import pytest

from metagraph.formats.imports import import_files
from metagraph.graph import edits
from metagraph.graph.face.rig import CHANNELS, LIDS, find_face, with_morphs
from metagraph.graph.life import Life, with_life
from metagraph.graph.model import Project
from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.motion.skeleton import Pose, Skeleton
from metagraph.playback.life.lane import lane
from metagraph.playback.life.schedule import Schedule, schedule
from metagraph.playback.life.track import BlinkAt, LookAt, ModeFrom, Speech, Track, track_of
from metagraph.playback.planner import make_plan
from tests import zoo
from tests.posing import enliven, face_weights, pose_at
from tests.thorough import many

Array = np.ndarray[Any, Any]
OFF = Life(on=False)
QUIET = Life(breathing=0, gaze=0, saccades=0, aversion_rate=0, blinks=0)
QUIET_GAZE = Life(breathing=0, saccades=0, aversion_rate=0, blinks=0)
TEXT = "Papa may have many memories of the farm."


def alone(life: Life, **changes: float) -> Life:
    """Nothing but what is changed."""
    return with_life(life, **changes)


def drawn(project: Project, track: Track, end: float = 40.0) -> Schedule:
    return schedule(project.life, track, project.voices, 1, end, Schedule(), 0.0)


def layers(project: Project, times: Array, seed: int = 1) -> Pose:
    """What the layers compose, without life."""
    return pose_at(make_plan(replace(project, life=OFF), 40.0, seed=seed), replace(project, life=OFF), times)


def resting(project: Project, count: int) -> Pose:
    assert project.skeleton is not None
    rest = project.skeleton.rest
    return Pose(
        np.tile(rest.rotations, (count, 1, 1)).astype(np.float32),
        np.tile(rest.translations, (count, 1, 1)).astype(np.float32),
    )


def alive(
    project: Project, life: Life, track: Track | None = None, times: Any = None, pose: Pose | None = None
) -> tuple[Pose, Pose]:
    """Composed poses and the same with life."""
    project, track = replace(project, life=life), track or Track()
    times = np.asarray(times if times is not None else np.arange(0, 20, 1 / 30), float)
    pose = pose if pose is not None else resting(project, len(times))
    return pose, enliven(pose, project, drawn(project, track), track, times)


def moved(project: Project, before: Pose, after: Pose) -> set[str]:
    assert project.skeleton is not None
    apart = rotation.measure_angle_between(before.rotations.astype(float), after.rotations.astype(float)).max(
        0
    )
    shifted = np.abs(before.translations - after.translations).max((0, 2))
    return {n for n, a, s in zip(project.skeleton.names, apart, shifted, strict=True) if a > 1e-4 or s > 1e-6}


def joint(project: Project, name: str) -> int:
    assert project.skeleton is not None
    return project.skeleton.index(name)


def gaze_error(project: Project, pose: Pose, target: Any) -> Array:
    """Degrees between where each of the mannequin's eyes looks and a point, `[N, 2]`."""
    assert project.skeleton is not None
    turned, at = project.skeleton.globals(Pose(pose.rotations.astype(float), pose.translations.astype(float)))
    eyes = [joint(project, "LeftEye"), joint(project, "RightEye")]
    wish = np.asarray(target) - at[:, eyes]
    wish /= np.linalg.norm(wish, axis=-1, keepdims=True)
    looks = rotation.rotate_vectors(turned[:, eyes], np.array([0, 0, 1.0]))
    return np.degrees(np.arccos(np.clip((wish * looks).sum(-1), -1, 1)))


# --- nothing to do


def test_life_that_is_off_leaves_the_pose_itself(sample: Project) -> None:
    before, after = alive(sample, OFF)
    assert after is before


def test_no_times_are_no_poses(sample: Project) -> None:
    before, after = alive(sample, Life(), times=np.zeros(0))
    assert after.rotations.shape == before.rotations.shape


def test_an_empty_schedule_moves_nothing(sample: Project) -> None:
    times = np.linspace(0, 5, 20)
    pose = resting(sample, 20)
    assert moved(sample, pose, enliven(pose, sample, Schedule(), Track(), times)) == set()


def test_the_pose_that_came_in_is_not_changed(sample: Project) -> None:
    times = np.linspace(0, 5, 20)
    pose = layers(sample, times)
    copy = Pose(pose.rotations.copy(), pose.translations.copy())
    for array in (pose.rotations, pose.translations):
        array.setflags(write=False)
    after = enliven(pose, sample, drawn(sample, Track()), Track(), times)
    assert (
        np.array_equal(pose.rotations, copy.rotations)
        and after.rotations.dtype == pose.rotations.dtype == np.float32
    )


# --- pure in time

BUSY = track_of(
    [
        Speech("s", 1.0, 4.0, text=TEXT),
        LookAt("l", 5, 8, (1.0, 1.4, 0.8)),
        LookAt("m", 8, 9, (-1.0, 1.9, 0.8), strict=True),
        BlinkAt("b", 2.22),
        ModeFrom("q", 10, "listening"),
    ]
)


@pytest.mark.parametrize("track", [Track(), BUSY])
def test_any_times_in_any_order_give_the_same_bits(sample: Project, track: Track) -> None:
    times = np.arange(0, 14, 1 / 30)
    pose = layers(sample, times)
    found = drawn(sample, track)
    whole = enliven(pose, sample, found, track, times)
    order = np.random.default_rng(0).permutation(len(times))
    shuffled = enliven(pose[order], sample, found, track, times[order])
    assert np.array_equal(shuffled.rotations, whole.rotations[order]) and np.array_equal(
        shuffled.translations, whole.translations[order]
    )
    for n in order[:150]:
        one = enliven(pose[n : n + 1], sample, found, track, times[n : n + 1])
        assert np.array_equal(one.rotations[0], whole.rotations[n]), times[n]


def test_rotations_stay_rotations(sample: Project) -> None:
    times = np.arange(0, 14, 1 / 30)
    _, after = alive(sample, Life(), BUSY, times, layers(sample, times))
    assert np.abs(np.linalg.norm(after.rotations, axis=-1) - 1).max() < 1e-5


@pytest.mark.nightly
@pytest.mark.parametrize("seed", range(1, many(2, 3)))
def test_nothing_jumps(sample: Project, seed: int) -> None:
    rate = 240
    times = np.arange(0.5, 14, 1 / rate)
    before, after = alive(sample, Life(), BUSY, times, layers(sample, times, seed))
    added = rotation.multiply(
        rotation.conjugate(before.rotations.astype(float)), after.rotations.astype(float)
    )
    speed = np.degrees(rotation.measure_angle_between(added[:-1], added[1:])).max(0) * rate
    assert sample.skeleton is not None
    limits = {"Eye": 700, "UpperLid": 1200, "LowerLid": 500, "Jaw": 160, "Head": 190, "Neck": 130}
    for name, fast in zip(sample.skeleton.names, speed, strict=True):
        part = name.removeprefix("Left").removeprefix("Right")
        assert fast < limits.get(part, 25), (name, fast)


# --- breathing


def test_breathing_moves_spine_head_and_shoulders_and_nothing_else(sample: Project) -> None:
    before, after = alive(sample, alone(QUIET, breathing=1))
    assert moved(sample, before, after) == {
        "Spine",
        "Chest",
        "UpperChest",
        "Neck",
        "Head",
        "LeftShoulder",
        "RightShoulder",
    }
    assert np.array_equal(before.translations, after.translations)


def test_the_face_stays_level_while_the_chest_rises(sample: Project) -> None:
    _, after = alive(sample, alone(QUIET, breathing=1))
    assert sample.skeleton is not None
    turned, at = sample.skeleton.globals(after)
    head = np.degrees(
        rotation.measure_angle_between(turned[:, joint(sample, "Head")].astype(float), rotation.IDENTITY)
    )
    assert head.max() < 0.5
    lift = np.ptp(at[:, joint(sample, "LeftUpperArm"), 1]), np.ptp(at[:, joint(sample, "RightUpperArm"), 1])
    assert lift[0] == pytest.approx(lift[1], rel=0.05) and 0.002 < lift[0] < 0.008, (
        "slight, and the same on both sides"
    )
    assert np.ptp(at[:, joint(sample, "LeftHand")], axis=0).max() < 0.02


def test_a_deeper_breath_moves_more(sample: Project) -> None:
    sizes = []
    for amount in (0.5, 1.0, 2.0):
        before, after = alive(sample, alone(QUIET, breathing=amount))
        sizes.append(
            float(
                rotation.measure_angle_between(
                    before.rotations.astype(float), after.rotations.astype(float)
                ).max()
            )
        )
    assert sizes[1] == pytest.approx(2 * sizes[0], rel=0.01) and sizes[2] == pytest.approx(
        4 * sizes[0], rel=0.01
    )


# --- looking


@pytest.mark.parametrize("seed", range(8))
def test_both_eyes_look_at_a_near_target_whatever_the_layers_play(sample: Project, seed: int) -> None:
    rng = np.random.default_rng(seed)
    target = rng.uniform((-0.8, 1.1, 0.8), (0.8, 1.9, 3.0))
    times = np.linspace(3, 30, 200)
    track = track_of([LookAt("l", 0.0, 99, tuple(target.tolist()), strict=True)])
    _, after = alive(sample, alone(QUIET, gaze=1), track, times, layers(sample, times, seed))
    error = gaze_error(sample, after, target).max(1)
    assert np.median(error) < 0.05 and np.percentile(error, 90) < 6
    assert error.max() < 15, "a head that a clip turns far away has eyes at their limit"


@pytest.mark.parametrize(
    "target", [(2.0, 1.6, 0.5), (-2.0, 1.2, 0.3), (0.3, 0.4, 0.8), (0.0, 2.6, 0.9), (0.4, 1.5, 0.5)]
)
def test_far_targets_are_met_with_the_help_of_the_head(
    sample: Project, target: tuple[float, float, float]
) -> None:
    track = track_of([LookAt("l", 0.0, 99, target, strict=True)])
    _, after = alive(sample, alone(QUIET, gaze=1), track, [20.0])
    assert gaze_error(sample, after, target).max() < (0.02 if target[2] == 0.5 and target[0] < 1 else 3), (
        "where the head has taken the eyes"
    )
    eye = np.degrees(
        rotation.measure_angle_between(
            after.rotations[0, joint(sample, "LeftEye")].astype(float), rotation.IDENTITY
        )
    )
    assert eye < 32


def test_what_is_beside_is_looked_for_as_far_as_a_neck_goes_and_what_is_behind_ever_less(
    sample: Project,
) -> None:
    def turned(target: tuple[float, float, float]) -> float:
        _, after = alive(sample, alone(QUIET, gaze=1), track_of([LookAt("l", 0.0, 99, target)]), [20.0])
        assert sample.skeleton is not None
        turns, _ = sample.skeleton.globals(after)
        x, _, z = rotation.rotate_vectors(turns[0, joint(sample, "Head")], np.array([0, 0, 1.0]))
        return float(np.degrees(np.arctan2(x, z)))

    for side in (1.0, -1.0):
        far = [
            side * turned((2 * side * np.sin(np.radians(a)), 1.5, 2 * np.cos(np.radians(a))))
            for a in (100, 118, 140, 160, 179)
        ]
        assert 55 < far[0] < 75 and 55 < far[1] < 75
        assert far[1] > far[2] > far[3] > far[4] and abs(far[4]) < 3, "no side is left to snap from"


def test_the_gaze_holds_while_the_head_nods_and_shakes(sample: Project) -> None:
    life = alone(QUIET, gaze=1)
    for word in ("nod_single_01", "shake_01"):
        clip = next(c for c in sample.clips.values() if c.name.endswith(word)).motion
        assert clip is not None
        times = np.linspace(0, clip.duration, 60)
        track = track_of([LookAt("l", 0.0, 99, (0.0, 1.6, 1.2), strict=True)])
        pose = clip.pose_at(times)
        before, after = alive(sample, life, track, times, pose)
        head = [joint(sample, "Head")]
        swing = rotation.measure_angle_between(
            before.rotations[:, head].astype(float), before.rotations[:1, head].astype(float)
        ).max()
        assert np.degrees(swing) > 3 and gaze_error(sample, after, (0.0, 1.6, 1.2)).max() < 0.5
        kept = rotation.measure_angle_between(
            after.rotations[:, head].astype(float), before.rotations[:, head].astype(float)
        )
        assert np.degrees(np.ptp(kept)) < 0.6, "the nod itself is left as it is"


def test_eyes_do_not_roll(sample: Project) -> None:
    _, after = alive(sample, Life(), BUSY)
    for name in ("LeftEye", "RightEye"):
        vector = rotation.log(after.rotations[:, joint(sample, name)].astype(float))
        assert np.abs(vector[:, 2]).max() < 1e-6, "no turn about the direction they look in"


def test_eyes_that_a_clip_moves_are_added_to(sample: Project) -> None:
    pose = resting(sample, 1)
    eye = joint(sample, "LeftEye")
    pose.rotations[:, eye] = rotation.from_axis_angle([0, 1.0, 0], np.radians(12))
    _, after = alive(sample, alone(QUIET, gaze=1), None, [5.0], pose)
    assert gaze_error(sample, after, (0, 1.6, 1.2))[0, 0] == pytest.approx(12, abs=1.5)


def test_half_a_look_goes_half_the_way(sample: Project) -> None:
    target = (0.5, 1.6, 1.0)
    errors = []
    for amount in (0.0, 0.5, 1.0):
        track = track_of([LookAt("l", 0.0, 99, target, amount, strict=True)])
        _, after = alive(sample, alone(QUIET, gaze=1), track, [20.0])
        errors.append(float(gaze_error(sample, after, target).mean()))
    assert errors[0] > 20 and 0.3 * errors[0] < errors[1] < 0.7 * errors[0] and errors[2] < 0.05


def test_ahead_leaves_eyes_and_head_to_the_layers(sample: Project) -> None:
    before, after = alive(
        sample,
        alone(QUIET, gaze=1),
        track_of([LookAt("l", 0.0, 99, "ahead", strict=True)]),
        np.linspace(3, 9, 30),
    )
    assert moved(sample, before, after) == set()


# --- lids and blinks


def lids(project: Project, pose: Pose) -> Array:
    """Degrees that upper and lower lid of the left eye are turned about X, `[N, 2]`."""
    names = ("LeftUpperLid", "LeftLowerLid")
    return np.degrees(
        np.stack([rotation.log(pose.rotations[:, joint(project, n)].astype(float))[:, 0] for n in names], 1)
    )


def test_a_blink_shuts_the_lids_in_70_and_opens_them_in_100_milliseconds(sample: Project) -> None:
    times = 3.0 + np.array([-0.001, 0.0, 0.035, 0.07, 0.12, 0.17, 0.2])
    _, after = alive(sample, QUIET, track_of([BlinkAt("b", 3.0)]), times)
    upper = lids(sample, after)[:, 0]
    assert upper == pytest.approx([0, 0, 20, 40, 20, 0, 0], abs=0.01)
    assert lids(sample, after)[3, 1] == pytest.approx(-15, abs=0.01)


def test_an_incomplete_blink_shuts_the_lids_by_three_fifths(sample: Project) -> None:
    project, times = replace(sample, life=QUIET), 3.0 + np.array([0.0, 0.07, 0.17])
    found = Schedule(blinks=lane(1).plus([3.0], [(3,)]))
    after = enliven(resting(project, len(times)), project, found, Track(), times)
    assert lids(sample, after)[:, 0] == pytest.approx([0, 0.6 * 40, 0], abs=0.01)


@pytest.mark.parametrize("squint", [-8.0, 12.0])
def test_a_blink_shuts_lids_that_a_clip_has_moved_and_no_farther(sample: Project, squint: float) -> None:
    pose = resting(sample, 1)
    pose.rotations[:, joint(sample, "LeftUpperLid")] = rotation.from_axis_angle(
        [1.0, 0, 0], np.radians(squint)
    )
    _, after = alive(sample, QUIET, track_of([BlinkAt("b", 3.0)]), [3.07], pose)
    assert lids(sample, after)[0, 0] == pytest.approx(40, abs=0.3)


@pytest.mark.parametrize(("target", "sign"), [((0, 0.9, 1.0), 1), ((0, 2.3, 1.0), -1)])
def test_lids_go_with_the_eyes(sample: Project, target: tuple[float, float, float], sign: int) -> None:
    life, track = alone(QUIET, gaze=1), track_of([LookAt("l", 0.0, 99, target, strict=True)])
    _, after = alive(sample, life, track, [20.0])
    pitch = np.degrees(rotation.log(after.rotations[0, joint(sample, "LeftEye")].astype(float))[0])
    upper, lower = lids(sample, after)[0]
    assert (
        pitch * sign > 5
        and upper == pytest.approx(0.6 * pitch, abs=0.05)
        and lower == pytest.approx(0.35 * pitch, abs=0.05)
    )
    _, stiff = alive(sample, alone(life, lids=0), track, [20.0])
    assert lids(sample, stiff)[0] == pytest.approx([0, 0], abs=1e-4)


def test_slow_blinks_meet_without_opening_at_once(sample: Project) -> None:
    project = replace(sample, life=alone(QUIET, blink_close=0.5, blink_open=1.0))
    times = np.arange(2.5, 7, 1 / 120)
    found = Schedule(blinks=lane(1).plus([3.0, 3.9], [(0,), (0,)]))
    after = enliven(resting(project, len(times)), project, found, Track(), times)
    assert np.abs(np.diff(lids(sample, after)[:, 0])).max() * 120 < 200


def test_lids_go_with_eyes_that_a_clip_moves(sample: Project) -> None:
    pose = resting(sample, 1)
    pose.rotations[:, joint(sample, "LeftEye")] = rotation.from_axis_angle([1.0, 0, 0], np.radians(12))
    _, after = alive(sample, QUIET, None, [5.0], pose)
    assert lids(sample, after)[0] == pytest.approx([0.6 * 12, 0.35 * 12], abs=0.1)


# --- lips


def test_only_the_jaw_of_the_mannequin_speaks(sample: Project) -> None:
    times = np.linspace(1, 4, 120)
    before, after = alive(sample, QUIET, track_of([Speech("s", 1, 4, text=TEXT)]), times)
    assert moved(sample, before, after) == {
        "Jaw",
        "LeftUpperLid",
        "LeftLowerLid",
        "RightUpperLid",
        "RightLowerLid",
    } or moved(sample, before, after) == {"Jaw"}
    angle = np.degrees(rotation.log(after.rotations[:, joint(sample, "Jaw")].astype(float))[:, 0])
    assert angle.min() >= -1e-5 and 6 < angle.max() < 12 and angle.min() < 0.5, (
        "opens for vowels, shuts for lips that meet"
    )


def test_lip_sync_can_be_turned_off_and_up(sample: Project) -> None:
    times = np.linspace(1, 4, 60)
    sizes = []
    for lips in (0.0, 1.0, 2.0):
        _, after = alive(
            sample, alone(QUIET, lips=lips, accent_blinks=0), track_of([Speech("s", 1, 4, text=TEXT)]), times
        )
        sizes.append(
            float(
                np.degrees(rotation.log(after.rotations[:, joint(sample, "Jaw")].astype(float))[:, 0]).max()
            )
        )
    assert sizes[0] == pytest.approx(0, abs=1e-6) and sizes[2] == pytest.approx(2 * sizes[1], rel=0.01)


# --- the dial of stillness


def test_at_full_stillness_only_lips_and_what_is_asked_for_move(sample: Project) -> None:
    times = np.arange(0, 20, 1 / 30)
    before, after = alive(sample, Life(stillness=1), None, times)
    assert moved(sample, before, after) == set()
    before, after = alive(sample, Life(stillness=1), track_of([Speech("s", 1, 4, text=TEXT)]), times)
    assert moved(sample, before, after) == {"Jaw"}
    before, after = alive(sample, Life(stillness=1), track_of([LookAt("l", 1, 9, (0.8, 1.6, 1.0))]), times)
    assert {"LeftEye", "Head"} <= moved(sample, before, after)
    before, after = alive(sample, Life(stillness=1), track_of([BlinkAt("b", 3)]), times)
    assert "LeftUpperLid" in moved(sample, before, after)


def test_stillness_calms_what_moves(sample: Project) -> None:
    sizes = []
    for stillness in (0.0, 0.5, 0.9):
        _, after = alive(sample, Life(stillness=stillness, blinks=0))
        steps = rotation.measure_angle_between(
            after.rotations[:-1].astype(float), after.rotations[1:].astype(float)
        )
        sizes.append(float(steps.sum()))
    assert sizes[0] > 1.8 * sizes[1] > 5 * sizes[2] > 0


# --- other bodies


def skeletons() -> list[Skeleton]:
    one = Skeleton(("Root",), np.array([-1]), np.array([[0, 0, 0, 1.0]]), np.zeros((1, 3)))
    line = Skeleton(
        ("Hips", "Spine", "Chest"),
        np.array([-1, 0, 1]),
        np.tile([0, 0, 0, 1.0], (3, 1)),
        np.array([[0, 1.0, 0]] * 3),
    )
    return [one, line]


@pytest.mark.parametrize("skeleton", skeletons(), ids=lambda s: s.names[-1])
def test_bodies_without_a_head_are_survived(skeleton: Skeleton) -> None:
    project = replace(Project(), skeleton=skeleton)
    before, after = alive(project, Life(), BUSY)
    assert np.isfinite(after.rotations).all()
    assert moved(project, before, after) <= {"Spine", "Chest"}


def test_a_body_without_a_face_turns_its_head_and_breathes(toy: Any) -> None:
    project = toy.project()
    target = (1.2, 1.7, 0.8)
    before, after = alive(project, Life(), track_of([LookAt("l", 2, 99, target)]))
    assert moved(project, before, after) == {"Spine", "Neck", "Head"}
    turned, _ = toy.skeleton.globals(after)
    x, _, z = rotation.rotate_vectors(turned[-1, joint(project, "Head")], np.array([0, 0, 1.0]))
    assert 15 < np.degrees(np.arctan2(x, z)) < 65


def test_real_bodies_without_faces_are_brought_to_life(shared_data: Path) -> None:
    brought_to_life(shared_data / "bandai-namco-1" / "dataset-1_bow_normal_001.bvh", {"Neck", "Head"})


@pytest.mark.parametrize("name", zoo.ANIMALS)
def test_bodies_of_the_zoo_are_brought_to_life(zoo_files: dict[str, Path], name: str) -> None:
    brought_to_life(zoo_files[name], {str(zoo.ANIMALS[name].called(joint)) for joint in ("neck", "head")})


def brought_to_life(path: Path, upper: set[str]) -> None:
    project = import_files(Project(), path.parent, [path]).into(Project())
    assert project.skeleton is not None
    clip = next(iter(project.clips.values())).motion
    assert clip is not None
    project = edits.set_base(project, next(iter(project.clips)), 0)
    times = np.arange(0, clip.duration, 1 / 30)
    before, after = alive(project, Life(), BUSY, times, clip.pose_at(times))
    assert np.isfinite(after.rotations).all() and upper & moved(project, before, after)
    apart = np.degrees(
        rotation.measure_angle_between(before.rotations.astype(float), after.rotations.astype(float))
    )
    assert apart.max() < 45


@pytest.mark.parametrize("host", ["adult_female", "alien"])
def test_real_hosts_shut_their_lids_as_their_own_blink_does(shared_data: Path, host: str) -> None:
    folder = shared_data / "sumerian-hosts" / "glTF" / "animations" / host
    project = import_files(
        Project(), folder, [folder / f"{n}.glb" for n in ("stand_idle", "blink", "lipsync")]
    ).into(Project())
    assert project.skeleton is not None
    blink = next(c for c in project.clips.values() if c.name == "blink_med").motion
    assert isinstance(blink, Clip)
    _, after = alive(project, QUIET, track_of([BlinkAt("b", 3.0)]), [3.07])
    upper = [int(find_face(project).lid_joints[n]) for n in (0, 1)]
    theirs = rotation.measure_angle_between(
        blink.rotations[:, upper].astype(float), blink.rotations[:1, upper].astype(float)
    ).max(0)
    frame = int(
        rotation.measure_angle_between(
            blink.rotations[:, upper[0]].astype(float), blink.rotations[0, upper[0]].astype(float)
        ).argmax()
    )
    rest = resting(project, 1)
    ours = rotation.measure_angle_between(
        after.rotations[0, upper].astype(float), rest.rotations[0, upper].astype(float)
    )
    assert np.degrees(np.abs(ours - theirs)).max() < 1
    shut = blink.poses()[frame].translations - blink.poses()[0].translations
    assert np.allclose((after.translations - rest.translations)[0, upper], shut[upper], atol=1e-3)


def test_real_hosts_speak_with_lips(shared_data: Path) -> None:
    folder = shared_data / "sumerian-hosts" / "glTF" / "animations" / "adult_female"
    project = import_files(
        Project(), folder, [folder / f"{n}.glb" for n in ("stand_idle", "blink", "lipsync")]
    ).into(Project())
    before, after = alive(project, QUIET, track_of([Speech("s", 1, 4, text=TEXT)]), np.linspace(1, 4, 60))
    names = moved(project, before, after)
    assert {"char:def_c_upLip", "char:def_c_lowLip", "char:def_l_cornerLip", "char:def_c_jaw"} <= names
    assert not any("elbow" in n or "hip" in n for n in names)


# --- faces of morph targets

ARKIT = (
    "eyeBlinkLeft",
    "eyeBlinkRight",
    "eyeWideLeft",
    "eyeLookUpLeft",
    "eyeLookDownLeft",
    "eyeLookInLeft",
    "eyeLookOutLeft",
    "jawOpen",
    "mouthFunnel",
    "mouthPucker",
    "mouthPressLeft",
)


@pytest.fixture
def morphed(toy: Any) -> Project:
    return with_morphs(toy.project(), ARKIT)


def weights(
    project: Project, life: Life, track: Track, at: float, pose: Pose | None = None
) -> dict[str, float]:
    project = replace(project, life=life)
    return face_weights(project, drawn(project, track), track, at, pose)


def test_faces_of_joints_have_no_weights(sample: Project) -> None:
    assert weights(sample, Life(), BUSY, 3.0) == {}


def test_a_morph_face_blinks_and_is_open_otherwise(morphed: Project) -> None:
    track = track_of([BlinkAt("b", 3.0)])
    assert weights(morphed, QUIET, track, 3.07) == {"eyeBlinkLeft": 1.0, "eyeBlinkRight": 1.0}
    assert weights(morphed, QUIET, track, 2.9) == {} and weights(morphed, OFF, track, 3.07) == {}


def test_a_morph_face_looks_and_its_lids_follow(morphed: Project) -> None:
    life = alone(QUIET, gaze=1)
    left = weights(morphed, life, track_of([LookAt("l", 0, 99, (0.4, 1.65, 1.0), strict=True)]), 9.0)
    assert left["eyeLookOutLeft"] > 0.3 and "eyeLookInLeft" not in left
    down = weights(morphed, life, track_of([LookAt("l", 0, 99, (0, 1.2, 1.0), strict=True)]), 9.0)
    assert down["eyeLookDownLeft"] > 0.3 and 0.1 < down["eyeBlinkLeft"] < 0.6
    up = weights(morphed, life, track_of([LookAt("l", 0, 99, (0, 2.2, 1.0), strict=True)]), 9.0)
    assert up["eyeLookUpLeft"] > 0.3 and up["eyeWideLeft"] > 0.05 and "eyeBlinkLeft" not in up


def test_a_morph_faces_eyes_hold_while_the_head_moves(morphed: Project) -> None:
    life, track = alone(QUIET, gaze=1), track_of([LookAt("l", 0, 99, "user", strict=True)])
    pose = resting(morphed, 1)[0]
    assert "eyeLookOutLeft" not in weights(morphed, life, track, 9.0, pose)
    pose.rotations[joint(morphed, "Head")] = rotation.from_axis_angle([0, 1.0, 0], np.radians(-15))
    assert weights(morphed, life, track, 9.0, pose)["eyeLookOutLeft"] == pytest.approx(0.5, abs=0.1)


@pytest.mark.nightly
def test_a_morph_face_speaks_within_0_and_1(morphed: Project) -> None:
    track = track_of([Speech("s", 1, 4, text=TEXT)])
    shown: dict[str, float] = {}
    for at in np.linspace(0.5, 5, 150):
        for name, weight in weights(morphed, alone(QUIET, lips=2, accent_blinks=0), track, float(at)).items():
            assert 0 <= weight <= 1
            shown[name] = max(shown.get(name, 0.0), weight)
    assert {"jawOpen", "mouthPressLeft", "mouthFunnel"} <= shown.keys() and shown["jawOpen"] > 0.5


def test_channels_are_in_the_order_that_arrays_have() -> None:
    assert (
        CHANNELS[:4] == LIDS and CHANNELS[4] == "blink" and CHANNELS[5] == "jaw_open" and len(CHANNELS) == 20
    )
    assert msgspec.structs.fields(Life), "life is a struct"


def test_a_look_far_aside_turns_the_trunk_along_and_a_glance_does_not(sample: Project) -> None:
    def turns(degrees: float) -> tuple[float, float]:
        """How far the upper chest and the head have turned, degrees."""
        away = np.radians(degrees)
        look = LookAt("k", 1.0, 9.0, (2 * np.sin(away), 1.6, 2 * np.cos(away)))
        pose, after = alive(sample, QUIET_GAZE, track_of([look]), [8.0])
        assert sample.skeleton is not None
        both = [sample.skeleton.globals(p)[0][0] for p in (pose, after)]
        chest, head = (
            float(
                np.degrees(
                    rotation.measure_angle_between(*(x[joint(sample, name)].astype(float) for x in both))
                )
            )
            for name in ("UpperChest", "Head")
        )
        return chest, head

    near, far = turns(12.0), turns(60.0)
    assert near[0] < 1.0
    assert 8.0 < far[0] < 0.35 * far[1]
