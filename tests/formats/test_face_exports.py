"""Faces of Audio2Face and Azure: ARKit's curves out of each, and reasons for what is none."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from metagraph.errors import FileError
from metagraph.formats.clips import find_clip_files, read_clips
from metagraph.graph.face.arkit import ARKIT
from metagraph.graph.face.takes import is_face_take
from metagraph.motion.clip import Clip


def audio2face(**changes: object) -> dict[str, object]:
    rows = [[n / 10, 0.0, 0.25] for n in range(10)]
    names = ["jawOpen", "browLowerL", "mouthPucker"]
    return {
        "exportFps": 24.0,
        "trackPath": "a.wav",
        "numPoses": 3,
        "numFrames": 10,
        "facsNames": names,
        "weightMat": rows,
    } | changes


def azure(count: int = 10) -> dict[str, object]:
    rows = [[0.0] * 55 for _ in range(count)]
    for n, row in enumerate(rows):
        row[ARKIT.index("jawOpen")] = n / 10
        row[52] = 0.5
    return {"FrameIndex": 0, "BlendShapes": rows}


def later() -> dict[str, object]:
    rows = azure()["BlendShapes"]
    assert isinstance(rows, list)
    return {"FrameIndex": 4, "BlendShapes": rows[4:]}


def table(split: str = ",", rate: float = 30.0) -> str:
    point = "," if split == ";" else "."
    head = [
        "timeCode",
        "blendShapes.JawOpen",
        "blendShapes.MouthPucker",
        "blendShapes.EyeBlinkLeft",
        "blendShapes.EyeBlinkRight",
    ]
    rows = [[n / rate, n / 10, 0.25, 0, 0] for n in range(10)]
    lines = [split.join(f"{x:.6f}".replace(".", point) for x in row) for row in rows]
    return "\n".join([split.join(head), *lines]) + "\n"


def curve(clip: Clip, name: str) -> np.ndarray:
    assert clip.weights is not None
    return np.asarray(clip.weights[:, clip.morphs.index(name)])


@pytest.mark.parametrize(
    ("name", "text", "rate"),
    [
        ("a.json", json.dumps(audio2face()), 24.0),
        ("a.json", json.dumps(azure()), 60.0),
        (
            "a.json",
            f"{json.dumps(azure(4))}\n{json.dumps(later())}",
            60.0,
        ),
        ("a.csv", table(), 30.0),
        ("a.csv", table(";"), 30.0),
        ("a.csv", table(rate=60.0), 60.0),
    ],
)
def test_curves_of_a_face_are_read_at_their_rate(tmp_path: Path, name: str, text: str, rate: float) -> None:
    (tmp_path / name).write_text(text)
    (clip,) = read_clips(tmp_path / name)
    assert is_face_take(clip) and clip.fps == rate and clip.frames == 10
    assert curve(clip, "jawOpen") == pytest.approx(np.arange(10) / 10, abs=1e-5)
    if "mouthPucker" in clip.morphs and "BlendShapes" not in text:
        assert curve(clip, "mouthPucker") == pytest.approx(0.25)
    assert find_clip_files(tmp_path) == [tmp_path / name]


@pytest.mark.parametrize(
    ("starts", "want", "told"),
    [
        ([4, 0, 8], list(range(12)), ""),
        ([0, 8], [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11], "4 frames without an event were filled in"),
        ([0, 4, 0], [0, 1, 2, 3, 4, 5, 6, 7, 0, 1, 2, 3], "its 2 utterances follow each other"),
    ],
    ids=["out of order", "one lost", "two utterances"],
)
def test_events_of_azure_lie_where_their_index_says(
    tmp_path: Path, starts: list[int], want: list[int], told: str
) -> None:
    def event(first: int) -> dict[str, object]:
        rows = [[0.0] * 55 for _ in range(4)]
        for n, row in enumerate(rows):
            row[ARKIT.index("jawOpen")] = (first + n) / 20
        return {"FrameIndex": first, "BlendShapes": rows}

    (tmp_path / "a.json").write_text(json.dumps([event(first) for first in starts]))
    (clip,) = read_clips(tmp_path / "a.json")
    assert curve(clip, "jawOpen") * 20 == pytest.approx(want, abs=1e-5)
    assert not told or any(told in note for note in clip.notes)


def test_an_index_far_beyond_the_frames_is_refused(tmp_path: Path) -> None:
    (tmp_path / "a.json").write_text(json.dumps(azure() | {"FrameIndex": 100_000}))
    with pytest.raises(FileError, match="its times lie too far apart"):
        read_clips(tmp_path / "a.json")


def test_what_was_left_out_or_taken_is_told(tmp_path: Path) -> None:
    for data, told in ((audio2face(), "browLowerL"), (azure(), "60 frames a second were assumed")):
        (tmp_path / "a.json").write_text(json.dumps(data))
        assert any(told in note for note in read_clips(tmp_path / "a.json")[0].notes)


@pytest.mark.parametrize(
    ("text", "cause"),
    [
        (json.dumps(audio2face(facsNames=["browLowerL", "x", "y"])), "not ARKit's names"),
        (json.dumps(audio2face(facsNames=3)), "not a list of names"),
        (json.dumps(audio2face(exportFps="x")), "not a number"),
        (json.dumps(audio2face(exportFps=0)), "its frame rate is 0"),
        (json.dumps(audio2face(weightMat=[[1, 2]])), "not have 3 numbers"),
        (json.dumps(audio2face(weightMat=[[1, 2, "x"]])), "not a number"),
        (json.dumps(audio2face(weightMat=[[1, 2, 99]])), "not from 0 to 1"),
        (json.dumps(audio2face(weightMat=[])), "no frames"),
        ('{"BlendShapes": 3}', "neither 'weightMat'"),
        (json.dumps({"BlendShapes": [[0.0] * 54]}), "not have 55 numbers"),
        ('{"BlendShapes": [', "not JSON"),
    ],
)
def test_what_is_wrong_is_named(tmp_path: Path, text: str, cause: str) -> None:
    (tmp_path / "a.json").write_text(text)
    with pytest.raises(FileError) as caught:
        read_clips(tmp_path / "a.json")
    assert cause in str(caught.value) and caught.value.remedy


def test_other_json_is_no_clip(tmp_path: Path) -> None:
    (tmp_path / "a.json").write_text('{"words": []}')
    assert find_clip_files(tmp_path) == []
