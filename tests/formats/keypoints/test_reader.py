"""Keypoints as programs write them: the same person out of every spelling, and a reason for what cannot be
read.
"""

from __future__ import annotations

import json
import random
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from metagraph.errors import FileError
from metagraph.formats.keypoints.reader import read_keypoints
from metagraph.mimicry.keypoint_layouts import H36M, LAYOUTS, PLACE, KeypointTrack
from tests.mimicry.test_pose_measures import FIGURE

SAMPLES = Path(__file__).resolve().parents[3] / "sample_clips" / "keypoints"


def figure(layout: str) -> np.ndarray:
    """Somebody's points `[K, 3]`, metres, y up; those FIGURE does not have stand at the neck."""
    return np.array([FIGURE.get(name, (0, 1.45, 0)) for name in LAYOUTS[layout]], float)


def picture(layout: str, x: float = 400.0, size: float = 200.0) -> list[list[float]]:
    """Somebody in a picture of 800 by 600, y down, with confidence."""
    return [[round(x + size * p[0], 2), round(500 - size * p[1], 2), 0.9] for p in figure(layout)]


def flat(rows: list[list[float]]) -> list[float]:
    return [n for row in rows for n in row]


def openpose(*people: list[list[float]], key: str = "pose_keypoints_2d", **more: Any) -> dict[str, Any]:
    return {
        "version": 1.3,
        "people": [{"person_id": [-1], key: flat(p), "face_keypoints_2d": [], **more} for p in people],
    }


def marks(names: str = "xyz") -> list[dict[str, float]]:
    """MediaPipe's world landmarks: from the hips, y down, z away from the camera."""
    at = figure("mediapipe") - [0, 0.95, 0]
    return [
        {**dict(zip(names, (p * [1, -1, -1]).round(4).tolist(), strict=True)), "visibility": 0.8} for p in at
    ]


@pytest.fixture
def read(tmp_path: Path):
    def inner(data: Any, name: str = "talk.json", **options: Any) -> KeypointTrack:
        path = tmp_path / name
        path.write_bytes(
            data
            if isinstance(data, bytes)
            else data.encode()
            if isinstance(data, str)
            else json.dumps(data).encode()
        )
        return read_keypoints(path, **options)

    return inner


def upright(found: KeypointTrack) -> None:
    points, sure = found.canonical
    assert (sure > 0).any()
    frames = sure[:, [PLACE[n] for n in ("nose", "left_hip", "left_shoulder", "right_shoulder")]].min(1) > 0
    assert (points[frames][:, PLACE["nose"], 1] > points[frames][:, PLACE["left_hip"], 1]).all()
    assert (
        points[frames][:, PLACE["left_shoulder"], 0] > points[frames][:, PLACE["right_shoulder"], 0]
    ).all()


# --- what cannot be read


@pytest.mark.parametrize(
    ("data", "words"),
    [
        (b"", "not JSON"),
        (b"nonsense", "not JSON"),
        (b"\xff\xfe\x00", "not JSON"),
        (b"[" * 100000, "nests too deep"),
        ("12", "neither an object"),
        ("[]", "no frames"),
        ("{}", "it has nothing"),
        ({"cats": 1, "dogs": 2}, "cats, dogs"),
        ([1, 2, 3], "frame 0: "),
        ({"people": 3}, "'people' is not a list"),
        ({"people": [4]}, "'people' is not a list"),
        ({"people": []}, "1 frame: nobody"),
        (openpose([[1.0, 2.0, 0.5]] * 7), "7 points "),
        ({"landmarks": [{"x": 1, "y": 2}] * 21}, "21 points are none"),
        ({"landmarks": 5}, "not a list"),
        ({"landmarks": "x" * 33}, "not a list"),
        ({"landmarks": [["a", "b", "c"]] * 33}, "33 points are none"),
        ({"landmarks": [[1, "b", 2]] * 33}, "not all numbers"),
        ({"landmarks": [{"x": True, "y": 1}] * 33}, "not all numbers"),
        ([{"t": "soon", "landmarks": []}], "'soon', not a number"),
        ({"fps": "many", "frames": []}, "fps is 'many'"),
        ({"fps": 0, "frames": []}, "fps is '0'"),
        ({"width": -3, "frames": []}, "width is '-3'"),
        ([openpose(picture("coco")), openpose(picture("mediapipe"))], "people have 17 and 33 points"),
    ],
)
def test_what_cannot_be_read_says_where_why_and_what_to_do(read: Any, data: Any, words: str) -> None:
    with pytest.raises(FileError) as caught:
        read(data)
    assert words in str(caught.value).replace("talk.json, ", "")
    assert caught.value.remedy


def test_a_file_that_is_not_there_says_so(tmp_path: Path) -> None:
    with pytest.raises(FileError, match=r"none\.json"):
        read_keypoints(tmp_path / "none.json")


def test_a_broken_line_is_named(read: Any) -> None:
    lines = [json.dumps({"t": n, "worldLandmarks": marks()}) for n in range(3)]
    with pytest.raises(FileError, match="line 2"):
        read(f"{lines[0]}\n{lines[1][:-9]}\n{lines[2]}")


def test_a_recording_that_broke_off_is_read_as_far_as_it_goes(read: Any) -> None:
    lines = [json.dumps({"t": n / 10, "worldLandmarks": marks()}) for n in range(3)]
    assert len(read("\n".join(lines)[:-20])) == 2


def test_a_folder_without_frames_says_what_they_would_be_called(tmp_path: Path) -> None:
    (tmp_path / "readme.txt").write_text("nothing")
    with pytest.raises(FileError, match="_keypoints"):
        read_keypoints(tmp_path)


def test_frames_a_second_that_cannot_be_are_refused(read: Any) -> None:
    with pytest.raises(ValueError, match="frames a second"):
        read(openpose(picture("coco")), fps=0.0)


# --- OpenPose


@pytest.mark.parametrize("layout", ["coco", "openpose coco", "openpose body_25"])
def test_openposes_layouts_come_upright_with_their_names(read: Any, layout: str) -> None:
    found = read([openpose(picture(layout))] * 3, fps=25)
    assert found.names == LAYOUTS[layout] and found.dims == 2 and len(found) == 3
    assert found.times.tolist() == [0, 0.04, 0.08]
    upright(found)
    wrist = found.points[0, LAYOUTS[layout].index("left_wrist")]
    assert wrist == pytest.approx([400 + 200 * 0.1, -(500 - 200 * 1.1), 0])
    assert (found.confidence == 0.9).all()


def test_a_folder_is_read_in_the_order_of_its_numbers_with_gaps(tmp_path: Path) -> None:
    for number in (7, 100, 9):
        (tmp_path / f"video_{number:012}_keypoints.json").write_text(
            json.dumps(openpose(picture("coco", x=number)))
        )
    (tmp_path / "notes.json.bak").write_text("{")
    found = read_keypoints(tmp_path, fps=10)
    assert found.times == pytest.approx([0, 0.2, 9.3])
    nose = found.points[:, 0, 0]
    assert nose.tolist() == [7, 9, 100]
    (note,) = read_keypoints(tmp_path).notes
    assert "frames a second" in note and "30" in note


def test_a_broken_frame_in_a_folder_is_named(tmp_path: Path) -> None:
    (tmp_path / "a_0_keypoints.json").write_text("{")
    with pytest.raises(FileError, match=r"a_0_keypoints\.json: "):
        read_keypoints(tmp_path)


def test_zeros_are_what_was_not_found(read: Any) -> None:
    rows = picture("coco")
    rows[PLACE["left_wrist"]] = [0, 0, 0.7]
    found = read([openpose(rows)])
    assert found.confidence[0, PLACE["left_wrist"]] == 0 and found.confidence[0].sum() == pytest.approx(
        16 * 0.9
    )


def test_three_dimensions_are_read_where_they_are_and_turned_to_the_camera(read: Any) -> None:
    away = [[*(p * [1, -1, -1]), 0.8] for p in figure("openpose body_25")]
    both = {
        "people": [{"pose_keypoints_2d": flat(picture("openpose body_25")), "pose_keypoints_3d": flat(away)}]
    }
    found = read([both, {"people": []}])
    assert found.dims == 3 and found.confidence[1].sum() == 0
    assert found.points[0] == pytest.approx(figure("openpose body_25"))
    up = {"people": [{"pose_keypoints_3d": flat([[*p, 0.8] for p in figure("openpose body_25")])}]}
    other = read([up])
    assert other.points[0] == pytest.approx(found.points[0]) and any(
        "upwards" in note for note in other.notes
    )


def test_frames_in_which_nobody_is_are_kept_with_nobody_in_them(read: Any) -> None:
    found = read({"fps": 5, "frames": [{"people": []}, openpose(picture("coco")), {"people": []}]})
    assert (found.confidence.sum(1) > 0).tolist() == [False, True, False]
    assert found.times.tolist() == [0, 0.2, 0.4] and found.notes == ()


def test_one_of_several_is_followed_and_that_is_told(read: Any) -> None:
    frames = [openpose(picture("coco", 100 + n, 80.0), picture("coco", 500 - n, 200.0)) for n in range(5)]
    found = read({"width": 800, "height": 600, "frames": frames})
    assert found.points[:, 0, 0].tolist() == [500, 499, 498, 497, 496]
    assert any("several people" in note for note in found.notes)


# --- MediaPipe

WORLD = ("worldLandmarks", "world_landmarks", "poseWorldLandmarks", "pose_world_landmarks")


@pytest.mark.parametrize("key", WORLD)
@pytest.mark.parametrize("shape", ["one", "several", "protobuf", "rows"])
def test_world_landmarks_however_they_are_spelt(read: Any, key: str, shape: str) -> None:
    rows = [[m["x"], m["y"], m["z"], m["visibility"]] for m in marks()]
    value = {"one": marks(), "several": [marks()], "protobuf": {"landmark": marks()}, "rows": rows}[shape]
    found = read([{"timestampMs": 40 * n, key: value} for n in range(3)])
    assert found.dims == 3 and found.names == LAYOUTS["mediapipe"]
    assert found.times == pytest.approx([0, 0.04, 0.08])
    assert found.points[1] == pytest.approx(figure("mediapipe") - [0, 0.95, 0], abs=1e-4)
    assert (found.confidence == 0.8).all()


@pytest.mark.parametrize("key", ["landmarks", "poseLandmarks", "pose_landmarks"])
def test_landmarks_in_shares_of_the_picture_are_as_long_down_as_across(read: Any, key: str) -> None:
    shares = [{"x": x / 800, "y": y / 600, "z": 0.1, "visibility": c} for x, y, c in picture("mediapipe")]
    for found in (
        read({"width": 800, "height": 600, "fps": 30, "frames": [{key: shares}]}),
        read([{key: shares}], picture=(800, 600)),
    ):
        assert found.dims == 2
        upright(found)
        assert found.points[0, :, :2] == pytest.approx(np.array(picture("mediapipe"))[:, :2] * [1, -1])
    guessed = read([{key: shares}])
    assert "16:9" in " ".join(guessed.notes)


def test_world_landmarks_are_taken_before_those_in_the_picture(read: Any) -> None:
    shares = [{"x": 0.5, "y": 0.5}] * 33
    assert read([{"landmarks": [shares], "worldLandmarks": [marks()]}]).dims == 3


def test_lines_with_a_head_are_read(read: Any) -> None:
    lines = ['{"note": "made", "fps": 20}', *(json.dumps({"poseWorldLandmarks": marks()}) for _ in range(3))]
    assert read("\n".join(lines) + "\n", "talk.jsonl").times == pytest.approx([0, 0.05, 0.1])


@pytest.mark.parametrize(
    ("unit", "key"), [(1, "t"), (1e3, "timestamp"), (1e6, "timestamp"), (1e3, "timestamp_ms"), (1, "time")]
)
def test_times_are_seconds_whatever_they_are_counted_in(read: Any, unit: float, key: str) -> None:
    found = read(
        [
            {key: (1700000000 + n / 25) * unit if unit > 1 else n / 25, "worldLandmarks": marks()}
            for n in range(4)
        ]
    )
    assert found.times == pytest.approx([0, 0.04, 0.08, 0.12], abs=1e-3)


def test_times_that_do_not_ascend_are_left_out_with_a_note(read: Any) -> None:
    found = read([{"t": t, "worldLandmarks": marks()} for t in (0, 0.1, 0.1, 0.05, 0.2)])
    assert found.times == pytest.approx([0, 0.1, 0.2])
    assert any(note.startswith("2 frames left out") for note in found.notes)


def test_what_is_null_was_not_found(read: Any) -> None:
    some = marks()
    some[15] = {"x": None, "y": 0.1, "z": 0}  # type: ignore[dict-item]
    some[16] = {"x": 1e300, "y": 0.1, "z": 0}
    found = read([{"worldLandmarks": some}])
    assert found.confidence[0, 15] == found.confidence[0, 16] == 0 and (found.points[0, 15:17] == 0).all()


def test_keypoints_of_coco_and_tensorflow_are_read(read: Any) -> None:
    rows = picture("coco")
    names = LAYOUTS["coco"]
    tensorflow = [{"x": x, "y": y, "score": c, "name": n} for (x, y, c), n in zip(rows, names, strict=True)]
    for data in (
        [{"image_id": f"{n:03}.jpg", "keypoints": flat(rows)} for n in range(2)],
        [{"frame": n, "keypoints": rows} for n in range(2)],
        [{"keypoints": tensorflow}] * 2,
        [tensorflow] * 2,
    ):
        found = read(data, fps=10)
        assert found.points[1, :, :2] == pytest.approx(np.array(rows)[:, :2] * [1, -1]) and found.confidence[
            0
        ] == pytest.approx(0.9)
        assert found.times == pytest.approx([0, 0.1])


# --- whatever it is


def test_the_samples_are_read_whole() -> None:
    flat_one, deep = (
        read_keypoints(SAMPLES / "conversation.openpose.json"),
        read_keypoints(SAMPLES / "conversation.mediapipe.jsonl"),
    )
    assert (len(flat_one), flat_one.dims, flat_one.notes) == (1200, 2, ())
    assert (len(deep), deep.dims, deep.notes) == (200, 3, ())
    for found in (flat_one, deep):
        upright(found)
        assert 0.9 < (found.canonical[1] > 0).mean() < 1.0


def test_files_with_bytes_changed_are_read_or_refused(tmp_path: Path) -> None:
    rng, path = random.Random(4), tmp_path / "broken.json"
    texts = [
        json.dumps([openpose(picture("coco"))] * 2).encode(),
        "\n".join(json.dumps({"t": n, "worldLandmarks": marks()}) for n in range(2)).encode(),
    ]
    for n in range(400):
        text = bytearray(texts[n % 2])
        for _ in range(rng.randint(1, 6)):
            place = rng.randrange(len(text))
            if rng.random() < 0.5:
                text[place] = rng.choice(b'0123456789.-e,:[]{}"ntf x\xff')
            else:
                del text[place : place + rng.randint(1, 40)]
        path.write_bytes(bytes(text))
        try:
            found = read_keypoints(path)
        except FileError:
            continue
        assert np.isfinite(found.points).all() and (np.diff(found.times) > 0).all()
        assert ((found.confidence >= 0) & (found.confidence <= 1)).all()


leaves = (
    st.none()
    | st.booleans()
    | st.integers(-(10**20), 10**20)
    | st.floats(allow_nan=False, allow_infinity=False)
    | st.text(max_size=5)
)
keys = st.sampled_from(
    [
        "people",
        "landmarks",
        "worldLandmarks",
        "keypoints",
        "pose_keypoints_2d",
        "pose_keypoints_3d",
        "t",
        "timestampMs",
        "frame",
        "frames",
        "fps",
        "width",
        "height",
        "x",
        "y",
        "z",
        "visibility",
        "landmark",
        "person_id",
        "image_id",
    ]
)
trees = st.recursive(
    leaves,
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(keys, inner, max_size=4),
    max_leaves=25,
)


@given(trees)
def test_any_json_is_read_or_refused(tmp_path_factory: pytest.TempPathFactory, tree: Any) -> None:
    path = tmp_path_factory.getbasetemp() / "any.json"
    path.write_text(json.dumps(tree))
    try:
        found = read_keypoints(path)
    except FileError:
        return
    assert len(found) == len(found.points) == len(found.confidence)


# --- layouts of other programs and versions


@pytest.mark.parametrize(
    "frame",
    [
        {"people": [{"pose_keypoints": flat(picture("openpose coco")), "face_keypoints": []}]},  # 1.1
        {"version": 1.0, "people": [{"body_parts": flat(picture("openpose coco"))}]},
        {"version": 0.1, "bodies": [{"joints": flat(picture("openpose coco"))}]},
        {"people": [{"pose_keypoints_2d": flat(picture("openpose mpi"))}]},  # has neither eyes nor nose
    ],
)
def test_openpose_before_one_two_and_its_mpi_model_are_read(read: Any, frame: dict[str, Any]) -> None:
    found = read({"frames": [frame, frame]})
    assert len(found) == 2
    upright(found)


def mmpose(layout: str, **more: Any) -> dict[str, Any]:
    rows = picture(layout)
    return {
        "keypoints": [r[:2] for r in rows],
        "keypoint_scores": [r[2] for r in rows],
        "bbox": [[1, 2, 3, 4]],
        "bbox_score": 0.9,
        **more,
    }


@pytest.mark.parametrize("layout", ["coco", "halpe", "coco whole body"])
def test_mmpose_people_are_read_with_their_scores(read: Any, layout: str) -> None:
    low = {**mmpose(layout), "keypoint_scores": [0.25] * len(LAYOUTS[layout])}
    frames = [{"frame_id": n, "instances": [low]} for n in (1, 2, 5)]
    found = read({"meta_info": {"dataset_name": "coco"}, "instance_info": frames}, fps=10)
    assert found.times.tolist() == [0.0, 0.1, 0.4]
    assert found.canonical[1].max() == 0.25
    upright(found)
    assert len(read([mmpose(layout), mmpose(layout)])) == 1  # both are in one picture


def test_mmpose_scores_that_do_not_fit_their_points_are_refused(read: Any) -> None:
    with pytest.raises(FileError, match="17 points have 3 scores"):
        read({"instance_info": [{"instances": [{**mmpose("coco"), "keypoint_scores": [1, 1, 1]}]}]})


@pytest.mark.parametrize("turned", [False, True])
def test_points_of_human36m_are_told_from_those_of_coco_by_their_names(read: Any, turned: bool) -> None:
    at = np.array([FIGURE.get(name, (0, 1.45, 0)) for name in H36M], float)
    rows = at * [-1, 1, 1] if turned else at * [1, -1, -1]
    rows = rows[:, [0, 2, 1]] if turned else rows
    person = {"keypoints": rows.tolist(), "keypoint_scores": [1.0] * 17}
    data = {"meta_info": {"dataset_name": "h36m"}, "instance_info": [{"instances": [person]}]}
    found = read(data)
    upright(found)
    points, sure = found.canonical
    assert points[0, PLACE["left_wrist"]] == pytest.approx(FIGURE["left_wrist"], abs=1e-6)
    assert sure[0, PLACE["left_ear"]] == 0 and any("Human3.6M" in n for n in found.notes)


def test_points_of_human36m_are_told_by_where_they_lie(read: Any) -> None:
    at = np.array([FIGURE.get(name, (0, 1.45, 0)) for name in H36M], float)
    at[0] = (at[H36M.index("left_hip")] + at[H36M.index("right_hip")]) / 2
    found = read({"fps": 30, "frames": [{"keypoints_3d": (at * [1, -1, -1]).tolist()}] * 3})
    upright(found)
    assert found.canonical[0][0, PLACE["left_wrist"]] == pytest.approx(FIGURE["left_wrist"], abs=1e-6)
    assert any("read as those of Human3.6M's" in note for note in found.notes)
    coco = read([{"keypoints": flat(picture("coco"))}] * 3)
    assert not any("Human3.6M" in note for note in coco.notes)


def test_people_of_one_picture_in_a_list_are_one_frame(read: Any) -> None:
    rows = [
        {"image_id": f"{n}.jpg", "keypoints": flat(picture("coco", x)), "score": 2.0, "idx": n}
        for n in range(3)
        for x in (300.0, 500.0)
    ]
    found = read(rows)
    assert len(found) == 3 and any("several people" in n for n in found.notes)


def test_people_without_a_body_say_what_they_have_instead(read: Any) -> None:
    with pytest.raises(FileError, match="only 'face_keypoints_2d'"):
        read({"people": [{"face_keypoints_2d": [1, 2, 3]}]})


def test_mediapipes_people_in_space_keep_their_places_in_the_picture(read: Any) -> None:
    seen = [[x, y, 0.0, 0.9] for x, y, _ in picture("mediapipe")]
    both = {"landmarks": seen, "worldLandmarks": marks()}
    found = read([{"t": n / 10, **both} for n in range(3)])
    assert found.dims == 3 and found.flat is not None and found.flat.dims == 2
    assert found.flat.points[0, 0, 0] == pytest.approx(seen[0][0]) and found.flat.flat is None
    swapped, in_picture = found.mirrored(), found.flat
    assert swapped.flat is not None and (swapped.flat.points[..., 0] == -in_picture.points[..., 0]).all()
    alone = read([{"t": n / 10, "worldLandmarks": marks()} for n in range(3)])
    assert alone.dims == 3 and alone.flat is None
