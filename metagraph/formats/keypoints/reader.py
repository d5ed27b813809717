"""Keypoints that a pose estimator found in a video: the JSON of OpenPose, MediaPipe, MMPose and AlphaPose, in
the ways in which programs write it.

Read: a folder of OpenPose frames (`video_000000000012_keypoints.json`), or one file: a list of frames, an
object that holds one, or one object a line. A frame is OpenPose's (`people`, each with `pose_keypoints_2d` or
`_3d`) or MediaPipe's (33 landmarks of one person or several, however `worldLandmarks`, `poseLandmarks`,
`pose_landmarks` ... is spelt), or COCO's (`keypoints`), with MMPose's scores beside them (`instances`,
`keypoint_scores`). OpenPose's people have `pose_keypoints` before 1.2, `body_parts` in 1.0 and `joints` (of
`bodies`) before. Points count 15, 17, 18, 25, 26, 33, 133 or 136. Markers of motion capture (TRC, C3D) are
read by `metagraph.formats.markers`.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import islice
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from metagraph.common.budgets import KEYPOINT_FRAMES, KEYPOINTS_FILE
from metagraph.common.files import guard_reader, read_file
from metagraph.errors import FileError
from metagraph.formats.clip_readers import KnownTool
from metagraph.formats.keypoints.frames import (
    REMEDY,
    KeypointFrame,
    has_people,
    is_json_number,
    is_person,
    is_untimed_person,
    normalize_key,
    read_frame,
)
from metagraph.formats.keypoints.movenet import NOTE, put_x_first, unpack_people
from metagraph.formats.keypoints.tracks import CUT, make_keypoint_track
from metagraph.formats.markers.marker_clips import read_marker_track
from metagraph.mimicry.keypoint_layouts import H36M, POINTS, KeypointTrack
from metagraph.mimicry.people import SeenPerson

Array = NDArray[Any]

# What the manual's table says (`docs/readers_page.py`).
KEYPOINT_TOOLS = (
    KnownTool("OpenPose", "1.0 to 1.7: BODY_25, COCO, MPI; a file a frame, or one", "all points, 2D or 3D"),
    KnownTool("MediaPipe Pose", "33 landmarks, in lists or a frame a line", "landmarks, in space and 2D"),
    KnownTool("MMPose", "1.x `instance_info`; 17, 26 or 133 points", "all points with their scores"),
    KnownTool("AlphaPose", "COCO's 17, Halpe's 26 or 136; a list of people", "all points with their scores"),
    KnownTool("COCO", "17 keypoints", "all points with their visibility"),
    KnownTool(
        "TensorFlow (PoseNet, MoveNet)", "named keypoints with scores; MoveNet's raw y, x, score", "17 points"
    ),
    KnownTool("Human3.6M", "17 points, where a name tells it", "points of the body"),
)
_WHOLE = ("frames", "data", "results", "poses", "predictions", "instance_info")
_FRAME_NAME = re.compile(r"(\d+)(?:_keypoints)?\.json$", re.I)


@dataclass
class _Head:
    """What a file says of all its frames. unit: of plain times, in seconds."""

    fps: float | None = None
    width: float | None = None
    height: float | None = None
    h36m: bool = False


def read_keypoints(
    path: str | Path, fps: float | None = None, picture: tuple[float, float] | None = None
) -> KeypointTrack:
    """Read the keypoints of a file, or of a folder of OpenPose frames, and follow one person through them.

    fps: frames a second, where the file gives no times. picture: width and height, for coordinates given as
    shares of them. Times begin at 0. Points come in three dimensions where the file has them. Raises
    FileError.
    """
    if fps is not None and not 0 < fps <= 1000:
        raise ValueError("there are more than 0 and at most 1000 frames a second")
    return _read(Path(path), fps, picture)


@guard_reader
def _read(path: str | Path, fps: float | None, picture: tuple[float, float] | None) -> KeypointTrack:
    path = Path(path)
    if path.suffix.lower() in (".trc", ".c3d"):
        return read_marker_track(path)
    head = _Head()
    found = _folder(path) if path.is_dir() else _file(path, head)
    frames = _joined(islice(found, KEYPOINT_FRAMES + 1))
    if len(frames) > KEYPOINT_FRAMES:
        raise FileError(path, f"it has more than {KEYPOINT_FRAMES:,} frames", "", CUT)
    if not frames:
        raise FileError(path, "there are no frames in it", "", REMEDY)
    notes: list[str] = []
    if not head.h36m and _looks_h36m(frames):
        head.h36m = True
        notes.append(
            "its points were read as those of Human3.6M's: the first lies between the second and the fifth"
        )
    elif head.h36m:
        notes.append("its points are Human3.6M's, as it says")
    if head.h36m:
        for frame in frames:
            frame.flat, frame.space = ([_from_h36m(p) for p in some] for some in (frame.flat, frame.space))
    elif put_x_first(frames):
        notes.append(NOTE)
    return make_keypoint_track(path, frames, fps or head.fps, picture or _size(head), notes)


def _joined(found: Iterable[KeypointFrame]) -> list[KeypointFrame]:
    """Return frames, those that follow each other with one number as one: AlphaPose and COCO list people."""
    out: list[KeypointFrame] = []
    for frame in found:
        if out and frame.number is not None and frame.number == out[-1].number and frame.time is None:
            out[-1].flat += frame.flat
            out[-1].space += frame.space
        else:
            out.append(frame)
    return out


def _looks_h36m(frames: Sequence[KeypointFrame]) -> bool:
    """Return whether 17 points are Human3.6M's and not COCO's: the first lies in the middle of the second and
    the fifth, the hips, which are closer to each other than a thigh or a shank is long.
    """
    people = [p for f in frames for some in (f.flat, f.space) for p in some if len(p.points) == len(H36M)]
    seen = [p.points for p in people if (p.confidence[:5] > 0).all()]
    if not seen:
        return False
    at = np.array(seen)
    wide = np.linalg.norm(at[:, 1] - at[:, 4], axis=-1)
    off = np.linalg.norm(at[:, 0] - (at[:, 1] + at[:, 4]) / 2, axis=-1)
    legs = np.linalg.norm(np.diff(at[:, 1:4], axis=1), axis=-1).min(1)
    return bool(np.median(off - 0.08 * wide) < 0 and np.median(legs - 1.2 * wide) > 0)


def _from_h36m(person: SeenPerson) -> SeenPerson:
    """Return somebody's Human3.6M points as COCO's; eyes and ears were not found."""
    if len(person.points) != len(H36M):
        return person
    order = np.array([H36M.index(name) if name in H36M else -1 for name in POINTS])
    confidence = np.where(order < 0, 0.0, person.confidence[order])
    points = person.points
    spine = np.abs(points[H36M.index("neck")] - points[H36M.index("hips")])
    if spine[2] > spine[1]:  # MMPose turns its people so that z is up and y towards the camera
        points = -points[:, [0, 2, 1]]
    return SeenPerson(np.where(order[:, None] < 0, 0.0, points[order]), confidence, person.ident)


# --- files


def _folder(path: Path) -> Iterator[KeypointFrame]:
    found = []
    try:
        for file in path.iterdir():
            match = _FRAME_NAME.search(file.name)
            if match is not None:
                found.append((int(match[1][-15:]), file))
    except OSError as error:
        raise FileError(
            path, f"cannot be read ({error.strerror})", "on opening it", "Check that it is there."
        ) from None
    if not found:
        raise FileError(
            path, "it holds no frames called ..._000000000012_keypoints.json", "in the folder", REMEDY
        )
    for number, file in sorted(found):
        data = _decoded(file, _bytes(file))
        if not isinstance(data, dict | list):
            raise FileError(file, "it is not a frame of OpenPose's or MMPose's", "", REMEDY)
        frame = read_frame(file, data, file.name)
        frame.number = number
        yield frame


def _file(path: Path, head: _Head) -> Iterator[KeypointFrame]:
    text = _bytes(path)
    try:
        data = msgspec.json.decode(text)
    except (msgspec.DecodeError, UnicodeError, RecursionError) as error:
        lines = [(n, line) for n, line in enumerate(text.splitlines(), 1) if line.strip()]
        if len(lines) < 2 or not _is_json(lines[0][1]):
            raise _broken(path, error) from None
        yield from _lines(path, lines, head)
        return
    if isinstance(data, dict) and (whole := next((k for k in _WHOLE if isinstance(data.get(k), list)), None)):
        _heading(path, data, head)
        data = data[whole]
    elif isinstance(data, dict):
        data = [data]
    elif isinstance(data, list) and data and all(is_untimed_person(p) for p in data):
        data = [data]  # MMPose's people of one picture
    if not isinstance(data, list):
        raise FileError(path, "it is neither an object nor a list", "", REMEDY)
    if is_person(data) or (data and all(is_person(p) for p in data) and is_json_number(data[0][0])):
        data = [data] if is_person(data) else data
    for n, item in enumerate(data):
        yield read_frame(path, unpack_people(item), f"frame {n}")


def _lines(path: Path, lines: Sequence[tuple[int, bytes]], head: _Head) -> Iterator[KeypointFrame]:
    for place, (n, line) in enumerate(lines):
        try:
            item = msgspec.json.decode(line)
        except (msgspec.DecodeError, UnicodeError, RecursionError) as error:
            if place == len(lines) - 1:
                return  # a recording that was interrupted
            raise _broken(path, error, f"line {n}") from None
        if place == 0 and isinstance(item, dict) and not has_people(item):
            _heading(path, item, head)
            continue
        yield read_frame(path, unpack_people(item), f"line {n}")


def _bytes(path: Path) -> bytes:
    return read_file(path, KEYPOINTS_FILE)


def _decoded(path: Path, text: bytes) -> Any:
    try:
        return msgspec.json.decode(text)
    except (msgspec.DecodeError, UnicodeError, RecursionError) as error:
        raise _broken(path, error) from None


def _broken(path: Path, error: Exception, where: str = "") -> FileError:
    why = "it nests too deep" if isinstance(error, RecursionError) else str(error)
    return FileError(path, f"it is not JSON ({why})", where, REMEDY)


def _is_json(line: bytes) -> bool:
    try:
        return isinstance(msgspec.json.decode(line), dict | list)
    except (msgspec.DecodeError, UnicodeError, RecursionError):
        return False


def _heading(path: Path, data: Mapping[str, Any], head: _Head) -> None:
    said = {normalize_key(k): v for k, v in data.items()}
    meta = said.get("metainfo")
    if isinstance(meta, dict):
        named = {normalize_key(str(k)): v for k, v in meta.items()}
        points = named.get("keypointid2name")
        first = points.get("0") if isinstance(points, dict) else None
        head.h36m = (
            normalize_key(str(named.get("datasetname", ""))) in ("h36m", "human36m") or first == "root"
        )
    for name, keys in {
        "fps": ("fps", "framerate"),
        "width": ("width", "imagewidth"),
        "height": ("height", "imageheight"),
    }.items():
        value = next((said[k] for k in keys if k in said), None)
        if value is not None:
            if not is_json_number(value) or not 0 < value <= (1000 if name == "fps" else 1e6):
                raise FileError(
                    path,
                    f"{name} is {str(value)[:40]!r}, not a number that could be",
                    "at its beginning",
                    "Correct it.",
                )
            setattr(head, name, float(value))


def _size(head: _Head) -> tuple[float, float] | None:
    return (head.width, head.height) if head.width and head.height else None
