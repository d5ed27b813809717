"""SMPL's parameters: a body that stands, bends its knee and walks as the numbers say, whichever way is up."""

from __future__ import annotations

import io
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from metagraph.errors import FileError
from metagraph.formats.clips import find_clip_files, read_clips
from metagraph.motion.clip import Clip

COUNTS = {"SMPL": 24, "SMPL-H": 52, "SMPL-X": 55, "SMPL-X's body": 22}


def body(joints: int, frames: int = 20, z_up: bool = False) -> tuple[np.ndarray, np.ndarray]:
    """Rotation vectors and places: who goes a metre along +Z, the left knee bent by half a right angle."""
    poses, trans = np.zeros((frames, joints, 3)), np.zeros((frames, 3))
    poses[:, 4, 0] = np.pi / 4
    trans[:, 2], trans[:, 1] = np.linspace(0, 1, frames), 0.9
    if z_up:  # AMASS turns the hips by a right angle about X
        poses[:, 0, 0] = np.pi / 2
        trans = np.stack([trans[:, 0], -trans[:, 2], trans[:, 1]], 1)
    return poses, trans


def write(path: Path, **arrays: Any) -> Path:
    np.savez(path, **arrays)
    return path


def amass(path: Path, joints: int = 52, z_up: bool = True, **more: Any) -> Path:
    poses, trans = body(joints, z_up=z_up)
    arrays = {
        "poses": poses.reshape(len(poses), -1),
        "trans": trans,
        "mocap_framerate": 120.0,
        "gender": "female",
        "betas": np.zeros(16),
    }
    return write(path, **(arrays | more))


def places(clip: Clip) -> dict[str, np.ndarray]:
    _, at = clip.skeleton.globals(clip.poses())
    return {name: at[:, n] for n, name in enumerate(clip.skeleton.names)}


@pytest.mark.parametrize("joints", COUNTS.values(), ids=COUNTS)
@pytest.mark.parametrize("z_up", [True, False])
def test_a_body_stands_and_walks_with_y_up(tmp_path: Path, joints: int, z_up: bool) -> None:
    (clip,) = read_clips(amass(tmp_path / "a.npz", joints, z_up))
    at = places(clip)
    assert clip.fps == 120 and clip.frames == 20 and len(clip.skeleton) == joints
    assert (at["head"][:, 1] > at["pelvis"][:, 1]).all() and at["head"][0, 1] == pytest.approx(1.54, abs=0.03)
    assert at["pelvis"][-1] - at["pelvis"][0] == pytest.approx([0, 0, 1], abs=1e-6)
    assert at["left_wrist"][0, 0] > 0.7 > 0 > at["right_wrist"][0, 0]  # arms to the sides, left at +X
    assert min(at["left_foot"][:, 1].min(), at["right_foot"][:, 1].min()) == pytest.approx(0.02, abs=0.02)
    assert (
        at["left_ankle"][0, 2] < -0.2 and abs(at["right_ankle"][0, 2]) < 1e-6
    )  # the bent knee puts it behind
    assert any("its Z axis points up" in note for note in clip.notes) == z_up


def test_beat2_is_read_with_its_jaw_and_without_its_expressions(tmp_path: Path) -> None:
    poses, trans = body(55)
    poses[:, 22, 0] = 0.3
    path = write(
        tmp_path / "a.npz",
        poses=poses.reshape(20, -1),
        trans=trans,
        mocap_frame_rate=np.array(30),
        model=np.array("smplx2020"),
        gender=np.array("neutral"),
        betas=np.zeros(300),
        expressions=np.zeros((20, 100)),
    )
    (clip,) = read_clips(path)
    jaw = clip.rotations[0, clip.skeleton.names.index("jaw")]
    assert clip.fps == 30 and 2 * np.arctan2(np.linalg.norm(jaw[:3]), jaw[3]) == pytest.approx(0.3, abs=1e-6)
    assert any("expressions" in note for note in clip.notes)


def test_parts_of_a_pose_are_joined_in_the_published_order(tmp_path: Path) -> None:
    poses, trans = body(55)
    flat = poses.reshape(20, -1)
    parts = {
        "root_orient": flat[:, :3],
        "pose_body": flat[:, 3:66],
        "pose_jaw": flat[:, 66:69],
        "pose_eye": flat[:, 69:75],
        "pose_hand": flat[:, 75:],
    }
    (one,) = read_clips(write(tmp_path / "a.npz", trans=trans, mocap_frame_rate=30.0, **parts))
    (other,) = read_clips(write(tmp_path / "b.npz", trans=trans, mocap_frame_rate=30.0, poses=flat))
    assert np.array_equal(one.rotations, other.rotations)


@pytest.mark.parametrize(
    ("turn", "way", "told"),
    [
        (np.pi, [1, -1, -1], "its Y axis points down"),
        (-np.pi / 2, None, "its Z axis points down"),
        (0.3, None, ""),
    ],
    ids=["a camera's axes", "Z down", "leaning"],
)
def test_a_body_that_is_upside_down_is_turned_upright(
    tmp_path: Path, turn: float, way: list[int] | None, told: str
) -> None:
    poses, trans = body(24)
    poses[:, 0, 0] = turn
    trans = trans * (way or [1, 1, 1])
    (clip,) = read_clips(write(tmp_path / "a.npz", poses=poses.reshape(20, -1), trans=trans, fps=30))
    at = places(clip)
    assert (at["head"][:, 1] > at["pelvis"][:, 1] + 0.4).all()
    assert at["left_wrist"][0, 0] > 0.7 > 0 > at["right_wrist"][0, 0]
    assert any(" axis points down" in note for note in clip.notes) == bool(told)
    assert not told or any(note.startswith(told) for note in clip.notes)
    if way:
        assert at["pelvis"][-1] - at["pelvis"][0] == pytest.approx([0, 0, 1], abs=1e-6)


@pytest.mark.parametrize(("unit", "name"), [(1.0, ""), (100.0, "centimetres"), (1000.0, "millimetres")])
def test_a_body_that_would_be_too_fast_goes_in_smaller_units(tmp_path: Path, unit: float, name: str) -> None:
    poses, trans = body(52)
    (clip,) = read_clips(
        write(tmp_path / "a.npz", poses=poses.reshape(20, -1), trans=trans * unit, mocap_framerate=30)
    )
    assert places(clip)["pelvis"][-1] - places(clip)["pelvis"][0] == pytest.approx([0, 0, 1], abs=1e-6)
    assert any("was read as" in note for note in clip.notes) == bool(name)
    assert not name or f"'trans' was read as {name}: in metres it would go too far" in clip.notes


def test_the_scaling_of_aist_is_undone(tmp_path: Path) -> None:
    poses, trans = body(24)
    path = write(
        tmp_path / "a.npz",
        smpl_poses=poses.reshape(20, -1),
        smpl_trans=trans * 93.8,
        smpl_scaling=np.array([93.8]),
        fps=60,
    )
    (clip,) = read_clips(path)
    assert places(clip)["pelvis"][-1] - places(clip)["pelvis"][0] == pytest.approx([0, 0, 1], abs=1e-6)
    assert any("smpl_scaling" in note for note in clip.notes)


def test_what_is_not_said_is_told(tmp_path: Path) -> None:
    poses, _ = body(24)
    (clip,) = read_clips(write(tmp_path / "a.npz", poses=poses))
    assert clip.fps == 30 and any("30 frames a second were assumed" in n for n in clip.notes)
    assert any("stays in its place" in n for n in clip.notes)
    assert find_clip_files(tmp_path) == [tmp_path / "a.npz"]


@pytest.mark.parametrize(
    ("arrays", "cause"),
    [
        ({"poses": np.zeros((4, 60))}, "4x60, which fits none of the known joints"),
        ({"poses": np.zeros(72)}, "72, which fits none"),
        ({"poses": np.full((4, 72), np.nan)}, "not a possible number"),
        ({"poses": np.zeros((0, 72))}, "no frames"),
        ({"poses": np.array([{}], object)}, "not an array of numbers"),
        ({"poses": np.array(["a"])}, "not an array of numbers"),
        ({"poses": np.zeros((4, 72)), "trans": np.zeros((3, 3))}, "three numbers for each frame"),
        ({"poses": np.zeros((4, 72)), "mocap_framerate": 0}, "frame rate is 0"),
        ({"root_orient": np.zeros((4, 3)), "pose_body": np.zeros((5, 63))}, "different numbers of frames"),
        ({"vertices": np.zeros(3)}, "only 'vertices'"),
    ],
)
def test_what_is_wrong_is_named(tmp_path: Path, arrays: dict[str, Any], cause: str) -> None:
    with pytest.raises(FileError) as caught:
        read_clips(write(tmp_path / "a.npz", **arrays))
    assert cause in str(caught.value) and caught.value.remedy


def test_a_small_file_that_claims_a_large_array_is_refused_at_once(tmp_path: Path) -> None:
    head = io.BytesIO()
    np.lib.format.write_array_header_1_0(head, {"descr": "<f8", "fortran_order": False, "shape": (10**9, 72)})
    with zipfile.ZipFile(tmp_path / "a.npz", "w") as archive:
        archive.writestr("poses.npy", head.getvalue())
    with pytest.raises(FileError, match="not an array of numbers"):
        read_clips(tmp_path / "a.npz")


def test_an_archive_that_is_cut_off_is_refused(tmp_path: Path) -> None:
    path = amass(tmp_path / "a.npz")
    path.write_bytes(path.read_bytes()[:-50])
    with pytest.raises(FileError, match="not an archive"):
        read_clips(path)
