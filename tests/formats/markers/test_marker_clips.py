"""Optical motion capture becomes clips: markers at joints and on the skin, metres and millimetres, gaps."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from metagraph.errors import FileError
from metagraph.formats.clips import read_clips
from metagraph.formats.keypoints.reader import read_keypoints
from metagraph.formats.markers.marker_clips import measure_skeleton, read_marker_clip, read_marker_track
from metagraph.formats.markers.marker_reading import read_markers
from metagraph.formats.markers.marker_take import find_metres
from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.motion.roles import find_roles
from tests.formats.markers.made_markers import joint_markers, skin_markers, write_c3d, write_trc

Array = NDArray[Any]
CLIPS = Path(__file__).resolve().parents[3] / "sample_clips" / "clips"
LIMBS = ("upper_arm", "lower_arm", "upper_leg", "lower_leg")
ENDS = {"upper_arm": "lower_arm", "lower_arm": "hand", "upper_leg": "lower_leg", "lower_leg": "foot"}


@pytest.fixture(scope="module")
def clip() -> Clip:
    return read_clips(next(CLIPS.glob("*open_palms_bt_01*")))[0]


def off(one: Clip, other: Clip) -> float:
    """How far limbs point another way, degrees, the worst of all at the frames of the first."""
    times = np.arange(one.frames) / one.fps
    ways = []
    for clip in (one, other):
        roles, poses = find_roles(clip.skeleton), clip.pose_at(np.minimum(times, clip.duration))
        at = clip.skeleton.globals(poses)[1].astype(float)
        lines = [
            at[:, roles[f"{s}_{ENDS[r]}"]] - at[:, roles[f"{s}_{r}"]]
            for s in ("left", "right")
            for r in LIMBS
        ]
        line = np.stack(lines, 1)
        ways.append(line / np.linalg.norm(line, axis=-1, keepdims=True))
    return float(np.degrees(np.arccos(np.clip((ways[0] * ways[1]).sum(-1), -1, 1))).max())


@pytest.mark.parametrize("made", [joint_markers, skin_markers], ids=["at joints", "on the skin"])
@pytest.mark.parametrize("kind", ["trc mm", "trc m, z up", "c3d"])
def test_limbs_point_where_those_of_who_wore_the_markers_did(tmp_path, clip, made, kind):
    markers = made(clip)
    path = tmp_path / f"take.{kind[:3]}"
    if kind == "c3d":
        path.write_bytes(write_c3d(markers, clip.fps, "Subject:"))
    else:
        path.write_bytes(write_trc(markers, clip.fps, kind.split()[1].strip(","), "z up" in kind))
    found = read_clips(path)[0]
    assert found.name == "take" and abs(found.duration - clip.duration) < 1.5 / clip.fps
    assert off(clip, found) < 6.0, "degrees; what is smoothed over 15 ms"
    assert "its skeleton was measured on the markers" in found.notes
    own, made_of = found.skeleton, clip.skeleton
    for role in LIMBS:
        lengths = []
        for skeleton in (own, made_of):
            roles, at = find_roles(skeleton), skeleton.globals(skeleton.rest)[1]
            lengths.append(np.linalg.norm(at[roles[f"left_{role}"]] - at[roles[f"left_{ENDS[role]}"]]))
        assert lengths[0] == pytest.approx(lengths[1], abs=0.01)


def test_it_stands_on_the_floor_and_looks_ahead_wherever_the_laboratory_looks(tmp_path, clip):
    about = rotation.from_axis_angle(np.array([0.0, 1.0, 0.0]), np.array(2.2))
    turned = {n: rotation.rotate_vectors(about, p) + [3.0, 0.0, -5.0] for n, p in joint_markers(clip).items()}
    path = tmp_path / "away.trc"
    path.write_bytes(write_trc(turned, clip.fps))
    found = read_marker_clip(path)
    roles, at = find_roles(found.skeleton), found.skeleton.globals(found.poses())[1]
    assert np.allclose(at[:, [roles["left_toes"], roles["right_toes"]], 1].min(1), 0.03, atol=0.005)
    left = at[0, roles["left_upper_leg"]] - at[0, roles["right_upper_leg"]]
    assert left[0] > 0 and abs(left[2]) < 0.1 * left[0]


def test_a_marker_that_was_not_seen_for_a_moment_is_bridged(tmp_path, clip):
    markers = {n: p.copy() for n, p in joint_markers(clip).items()}
    markers["LWrist"][5:12] = np.nan
    for name, data in (("a.trc", write_trc(markers, clip.fps)), ("a.c3d", write_c3d(markers, clip.fps))):
        path = tmp_path / name
        path.write_bytes(data)
        assert np.isnan(read_markers(path).places).any(), "what was not seen is no place"
        assert off(clip, read_marker_clip(path)) < 15.0


@pytest.mark.parametrize("kind", ["trc", "c3d"])
def test_a_marker_in_the_origin_was_not_seen(tmp_path, clip, kind):
    markers = joint_markers(clip)
    gone = {name: places.copy() for name, places in markers.items()}
    gone["LWrist"][3:6] = 0.0
    data = write_trc(gone, 30.0) if kind == "trc" else write_c3d(gone, 30.0)
    path = tmp_path / f"take.{kind}"
    path.write_bytes(data)
    take = read_markers(path)
    seen = np.isfinite(take.places[:, take.names.index("LWrist")]).all(-1)
    assert np.flatnonzero(~seen).tolist() == [3, 4, 5]


def test_of_two_subjects_one_is_read_and_not_a_mixture(tmp_path, clip):
    ann = {f"Ann:{name}": at + [3.0, 0.0, 0.0] for name, at in joint_markers(clip).items()}
    bob = {f"Bob:{name}": at for name, at in joint_markers(clip).items() if name != "LElbow"}
    path = tmp_path / "take.c3d"
    path.write_bytes(write_c3d(bob | ann, 30.0))
    track = read_marker_track(path)
    assert "it has several subjects: Ann is read, not Bob" in track.notes
    alone = tmp_path / "alone.c3d"
    alone.write_bytes(write_c3d(ann, 30.0))
    assert np.abs(track.points - read_marker_track(alone).points).max() < 1e-6


def test_a_trc_marker_without_a_name_moves_no_others(tmp_path, clip):
    markers = joint_markers(clip)
    text = write_trc({"X": next(iter(markers.values())) + 5.0} | markers, 30.0)
    path = tmp_path / "take.trc"
    path.write_bytes(text.replace(b"Time\tX\t", b"Time\t\t"))
    take = read_markers(path)
    assert take.names == ("unnamed 1", *markers)
    assert take.places[:, 1] == pytest.approx(next(iter(markers.values())), abs=1e-3)


@pytest.mark.parametrize(("word", "metres"), [("inches", 0.0254), ("Inch", 0.0254), ("feet", 0.3048)])
def test_units_are_known_by_their_whole_words(tmp_path, word, metres):
    assert find_metres(tmp_path, word) == metres


def test_decimal_commas_of_a_trc_file_are_points(tmp_path, clip):
    markers = joint_markers(clip)
    path = tmp_path / "take.trc"
    path.write_bytes(write_trc(markers, 29.97).replace(b"take.trc", b"take").replace(b".", b","))
    take = read_markers(path)
    assert take.rate == 29.97 and take.notes == ("its decimal commas were read as points",)
    assert take.places[:, 0] == pytest.approx(next(iter(markers.values())), abs=1e-3)


@pytest.mark.parametrize(("unit", "said", "way"), [("mm", "m", "smaller"), ("m", "mm", "larger")])
def test_a_file_that_names_the_wrong_unit_has_a_person_all_the_same(tmp_path, clip, unit, said, way):
    path = tmp_path / "take.trc"
    right = write_trc(joint_markers(clip), 30.0, unit)
    path.write_bytes(right)
    want = read_marker_clip(path)
    path.write_bytes(right.replace(f"\t{unit}\t".encode(), f"\t{said}\t".encode()))
    found = read_marker_clip(path)
    assert found.skeleton.height == pytest.approx(want.skeleton.height, rel=0.01)
    assert any(f"1000 times {way}" in note for note in found.notes) and not any(
        "1000 times" in note for note in want.notes
    )


def test_mimic_reads_markers_as_keypoints_in_three_dimensions(tmp_path, clip):
    path = tmp_path / "a.c3d"
    path.write_bytes(write_c3d(skin_markers(clip), clip.fps))
    track = read_keypoints(path)
    assert track.dims == 3 and len(track) == clip.frames
    assert measure_skeleton(track).height > 1.2


def test_one_marker_of_a_joint_is_taken_and_reported(tmp_path, clip):
    markers = {n: p for n, p in skin_markers(clip).items() if n not in ("LMEL", "RMEL", "LKNM", "RKNM")}
    path = tmp_path / "a.trc"
    path.write_bytes(write_trc(markers, clip.fps))
    assert read_marker_track(path).notes == (
        "only one marker of the shoulder, elbow, knee is known, and it is on the skin",
    )


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (
            lambda m: {f"M{n}": p for n, p in enumerate(m.values())},
            "do not show both of each shoulder, elbow",
        ),
        (lambda m: {n: p for n, p in m.items() if "ASI" not in n}, "do not show both of each hip; they are"),
        (lambda m: {n: p[:1] for n, p in m.items()}, "one frame is no motion"),
    ],
)
def test_markers_that_show_no_body_are_refused_by_name(tmp_path, clip, change, says):
    path = tmp_path / "a.trc"
    path.write_bytes(write_trc(change(skin_markers(clip)), clip.fps))
    with pytest.raises(FileError, match=says):
        read_marker_clip(path)


@pytest.mark.parametrize(
    ("before", "after", "says"),
    [
        (b"\tmm\t", b"\tparsec\t", "its unit is 'parsec'"),
        (b"\n30", b"\n0", "0 frames a second"),
        (b"LSHO", b"", "."),
    ],
)
def test_a_head_that_cannot_be_is_refused(tmp_path, clip, before, after, says):
    path = tmp_path / "a.trc"
    path.write_bytes(write_trc(skin_markers(clip), 30.0).replace(before, after))
    with pytest.raises(FileError, match=says):
        read_marker_clip(path)


def test_a_c3d_file_that_ends_early_keeps_what_it_has(tmp_path, clip):
    data = write_c3d(joint_markers(clip), clip.fps)
    path = tmp_path / "a.c3d"
    path.write_bytes(data[: len(data) * 3 // 4])
    found = read_marker_clip(path)
    assert any("it ends after" in note for note in found.notes) and found.duration < clip.duration
    path.write_bytes(data[:700])
    with pytest.raises(FileError, match=r"whole C3D file|frames"):
        read_marker_clip(path)
