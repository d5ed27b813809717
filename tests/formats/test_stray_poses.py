"""Bind poses and stray frames in takes: found by whole poses and the steps from them."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from metagraph.formats.stray_poses import find_stray_poses
from metagraph.formats.takes import BIND_POSE, LONE_FRAME, drop_stray_poses
from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.motion.skeleton import Pose
from tests.benchmarks import bench_stray_poses as made

Array = NDArray[Any]
ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="module")
def takes() -> list[Clip]:
    return made.takes_of([ROOT / "sample_clips"])[::15]


def share(takes: list[Clip], make: Callable[[Clip], Iterator[made.Case]]) -> dict[str, float]:
    """Return for each kind of case the share of right answers."""
    out: dict[str, list[bool]] = {}
    for clip in takes:
        for case in make(clip):
            if case[2:] == (0, 0, ()) or made.seen(case):
                out.setdefault(case[0], []).append(made.right(case, made.found))
    return {name: float(np.mean(right)) for name, right in out.items()}


@pytest.mark.nightly
def test_every_bind_pose_put_into_the_sample_clips_goes_and_nothing_else(takes: list[Clip]) -> None:
    shares = share(takes, made.with_stray_poses)
    assert len(shares) > 30
    assert not {name: part for name, part in shares.items() if part < 0.9}
    assert np.mean(list(shares.values())) > 0.98


@pytest.mark.nightly
def test_sample_clips_that_start_fast_or_from_a_bind_pose_stay_whole(takes: list[Clip]) -> None:
    shares = share(takes, made.without_stray_poses)
    # A rest pose taken out of the middle of a swing is the one thing that may deceive.
    assert not {name: part for name, part in shares.items() if part < 1 and "rests as it is cut" not in name}


@pytest.mark.nightly
def test_real_clips_lose_the_bind_poses_they_have_and_no_frame_more(shared_data: Path) -> None:
    from metagraph.errors import FileError
    from metagraph.formats.clips import find_clip_files, read_clips

    dropped = {}
    for path in find_clip_files(shared_data):
        if path.suffix == ".fbx" or ("bandai" in str(path) and "_sad_" not in path.name):
            continue
        try:
            for clip in read_clips(path):
                for repair in clip.repairs:
                    if repair.name in (BIND_POSE, LONE_FRAME):
                        dropped[path.name, clip.name] = repair.words
        except FileError:
            continue
    first = "its first frame was the bind pose and was removed"
    assert dropped == {
        ("01_01.bvh", "01_01"): first,
        ("cmu_12_01_walk.bvh", "cmu_12_01_walk"): first,
        ("sample.bvh", "sample"): first,
    }


def bound(clip: Clip, first: bool = True, last: bool = False) -> Clip:
    rest = made.row(clip, clip.skeleton.rest, False, 0)
    return made.joined(clip, [rest] * first + [made.whole(clip)] + [rest] * last)


def test_a_pose_of_a_frame_or_two_is_no_take_to_clean(takes: list[Clip]) -> None:
    for frames in (1, 2, 3):
        clip = bound(takes[0].trimmed(0, frames))
        assert drop_stray_poses([clip])[0] is clip


def test_a_take_made_of_held_poses_keeps_the_one_at_rest(takes: list[Clip]) -> None:
    clip = takes[0]
    rest = made.row(clip, clip.skeleton.rest, False, 0)
    poses = [(clip.rotations[n : n + 1], clip.translations[n : n + 1]) for n in (0, clip.frames // 2)]
    held = made.joined(clip, [part for pose in (rest, *poses, rest) for part in [pose] * 10])
    assert made.found(held) == (0, 0, ())


def test_fingers_that_shiver_do_not_hide_a_bind_pose(takes: list[Clip]) -> None:
    clip = next(c for c in takes if "LeftHand" in c.skeleton)
    tips = [j for j in range(len(clip.skeleton)) if not clip.skeleton.children[j]]
    turns = clip.rotations.copy()
    jitter = rotation.from_axis_angle(np.array([1.0, 0, 0]), np.radians(60) * (np.arange(clip.frames) % 2))
    turns[:, tips] = rotation.multiply(turns[:, tips], jitter[:, None].astype(np.float32))
    assert made.found(bound(replace(clip, rotations=turns))) == (1, 0, ())


def test_what_is_dropped_at_both_ends_is_one_repair_that_can_be_left_out(takes: list[Clip]) -> None:
    clip = bound(takes[0], last=True)
    [clean] = drop_stray_poses([clip])
    assert clean.frames == takes[0].frames
    (repair,) = clean.repairs
    assert repair.name == BIND_POSE and repair.made
    assert "first frame" in repair.words and "last frame" in repair.words and repair.words in clean.notes
    [left] = drop_stray_poses([clip], (BIND_POSE,))
    assert left.frames == clip.frames and not left.repairs[0].made and "left as it is" in left.notes[-1]


def test_a_lone_frame_is_made_anew_between_its_neighbours_and_can_be_left(takes: list[Clip]) -> None:
    clip = takes[0]
    middle = clip.frames // 2
    one, two = made.whole(clip.trimmed(0, middle)), made.whole(clip.trimmed(middle))
    broken = made.joined(clip, [one, made.row(clip, clip.skeleton.rest, False, middle), two])
    [mended] = drop_stray_poses([broken])
    assert mended.frames == broken.frames and [r.name for r in mended.repairs] == [LONE_FRAME]
    assert f"frame {middle + 1} " in mended.repairs[0].words
    near = rotation.measure_angle_between(
        mended.rotations[middle].astype(float), clip.rotations[middle].astype(float)
    )
    assert near.max() < np.radians(10)
    [left] = drop_stray_poses([broken], (LONE_FRAME,))
    np.testing.assert_array_equal(left.rotations, broken.rotations)


def test_a_pose_that_the_nodes_hold_counts_as_a_bind_pose_where_the_reader_knows_it(
    takes: list[Clip],
) -> None:
    clip = quick(takes)
    odd = odd_pose(clip)
    take = made.joined(clip, [made.row(clip, odd, False, 0), made.whole(clip)])
    assert find_stray_poses([take])[0].first == 0
    assert find_stray_poses([take], [odd])[0].first == 1


def odd_pose(clip: Clip) -> Pose:
    """Return a pose that is neither the rest pose nor one with its arms out."""
    rest = clip.skeleton.rest
    noise = np.random.default_rng(1).normal(size=(len(clip.skeleton), 4))
    return replace(
        rest, rotations=rotation.multiply(rest.rotations, rotation.normalize(noise * 0.3 + [0, 0, 0, 1.0]))
    )


def quick(takes: list[Clip]) -> Clip:
    """Return the take that turns most, at six times its speed."""

    def turned(clip: Clip) -> float:
        return float(rotation.measure_angle_between(clip.rotations[1:], clip.rotations[:-1]).sum(1).max())

    clip = max(takes, key=turned)
    return replace(
        clip, rotations=clip.rotations[::6], translations=clip.translations[::6], weights=None, morphs=()
    )


@pytest.mark.parametrize("backwards", [False, True])
def test_any_pose_that_a_step_far_above_all_others_leaves_is_stray(
    takes: list[Clip], backwards: bool
) -> None:
    clip = next(c for c in takes if c.frames > 60)
    rows = [made.row(clip, odd_pose(clip), False, 0), made.whole(clip)]
    take = made.joined(clip, rows[::-1] if backwards else rows)
    found = find_stray_poses([take])[0]
    assert (found.first, found.last) == ((0, 1) if backwards else (1, 0))
