"""Keypoints that a pose estimator found in a video: the JSON of OpenPose, MediaPipe, MMPose and AlphaPose, in
the ways in which programs write it.

Read: a folder of OpenPose frames (`video_000000000012_keypoints.json`), or one file: a list of frames, an
object that holds one, or one object a line. A frame is OpenPose's (`people`, each with `pose_keypoints_2d` or
`_3d`) or MediaPipe's (33 landmarks of one person or several, however `worldLandmarks`, `poseLandmarks`,
`pose_landmarks` ... is spelt), or COCO's (`keypoints`), with MMPose's scores beside them (`instances`,
`keypoint_scores`). OpenPose's people have `pose_keypoints` before 1.2, `body_parts` in 1.0 and `joints` (of
`bodies`) before. Points count 15, 17, 18, 25, 26, 33 or 133. Markers of motion capture (TRC, C3D) are read
by `metagraph.formats.markers`.
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

from metagraph.common.budgets import KEYPOINT_FRAMES, KEYPOINT_SECONDS, KEYPOINTS_FILE
from metagraph.common.files import guard_reader, read_file
from metagraph.errors import FileError
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
from metagraph.formats.markers.marker_clips import read_marker_track
from metagraph.mimicry.keypoint_layouts import (
    BY_COUNT,
    H36M,
    LAYOUTS,
    PLACE,
    POINTS,
    KeypointTrack,
    choose_points,
)
from metagraph.mimicry.people import SeenPerson, follow_person

Array = NDArray[Any]

FPS = 30.0  # frames a second, if nothing says how many
PICTURE = (16.0, 9.0)  # what a picture measures, if nothing says it
_CUT = "Correct them, or cut the recording into pieces."
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
        raise FileError(path, f"it has more than {KEYPOINT_FRAMES:,} frames", "", _CUT)
    if not frames:
        raise FileError(path, "there are no frames in it", "", REMEDY)
    notes: list[str] = []
    if head.h36m:
        notes.append("its points are Human3.6M's, as it says")
        for frame in frames:
            frame.flat, frame.space = ([_from_h36m(p) for p in some] for some in (frame.flat, frame.space))
    return make_keypoint_track(path, frames, fps or head.fps, picture or _size(head), notes)


def make_keypoint_track(
    path: Path,
    frames: list[KeypointFrame],
    fps: float | None,
    picture: tuple[float, float] | None,
    notes: list[str],
) -> KeypointTrack:
    """Follow one person through frames. path: for messages; fps: where frames have no times; picture: its
    width and height; notes: what was found out before. Raises FileError.
    """
    times = _times(frames, fps, notes)
    lasts = float(np.max(times, initial=0.0))
    if not lasts <= KEYPOINT_SECONDS:
        raise FileError(path, f"its frames lie {lasts:.3g} s apart", "their times or numbers", _CUT)
    kept = np.flatnonzero(np.concatenate([[True], np.diff(np.maximum.accumulate(times)) > 0]))
    if len(kept) < len(times):
        notes.append(
            f"{_many(len(times) - len(kept), 'frame')} left out that came no later than the one before"
        )
    times, frames = times[kept], [frames[n] for n in kept]
    return _gathered(path, times, frames, picture, notes)


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
        yield read_frame(path, item, f"frame {n}")


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
        yield read_frame(path, item, f"line {n}")


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


# --- all of it


def _times(frames: Sequence[KeypointFrame], fps: float | None, notes: list[str]) -> Array:
    """Return seconds of frames, from 0: as they say, else from their numbers."""
    said = [f.time for f in frames]
    if all(t is not None for t in said) and len(said) > 1:
        times = np.array(said, float)
        step = float(np.median(np.diff(times)))
        unit = 1.0 if step < 5 else 1e-3 if step < 5000 else 1e-6 if step < 5e6 else 1e-9
        return np.asarray((times - times[0]) * unit)
    if fps is None and len(frames) > 1:
        notes.append(f"how many frames a second there are is not said; {FPS:g} were taken")
    numbers = [f.number for f in frames]
    known = all(n is not None for n in numbers)
    count = np.array(numbers if known else range(len(frames)), float)
    return np.asarray((count - count[0]) / (fps or FPS))


def _size(head: _Head) -> tuple[float, float] | None:
    return (head.width, head.height) if head.width and head.height else None


def _gathered(
    path: Path,
    times: Array,
    frames: Sequence[KeypointFrame],
    picture: tuple[float, float] | None,
    notes: list[str],
) -> KeypointTrack:
    """Follow one person and bring them into our axes."""
    deep = sum(bool(f.space) for f in frames) * 2 >= sum(bool(f.space or f.flat) for f in frames) and any(
        f.space for f in frames
    )
    people = [f.space if deep else f.flat for f in frames]
    counts = {len(p.points) for some in people for p in some}
    if not counts:
        raise FileError(path, _why_nobody(frames), f"{_many(len(frames), 'frame')}", REMEDY)
    if len(counts) > 1:
        raise FileError(
            path,
            f"people have {' and '.join(map(str, sorted(counts)))} points",
            "in its frames",
            "Keep to one layout.",
        )
    count = counts.pop()
    scale = np.ones(3) if deep else _stretch(people, picture, notes)
    middle = picture[0] / 2 if picture and not deep else None
    points, confidence = np.zeros((len(frames), count, 3)), np.zeros((len(frames), count))
    stretched = [[SeenPerson(p.points * scale, p.confidence, p.ident) for p in some] for some in people]
    for n, person in enumerate(follow_person(times.tolist(), stretched, middle)):
        if person is not None:
            points[n], confidence[n] = person.points, person.confidence
    if max(map(len, people)) > 1:
        notes.append("several people are seen; the one who is largest and nearest to the middle is followed")
    names = LAYOUTS[BY_COUNT[count]]
    return KeypointTrack(
        times, _upright(points, confidence, deep, notes), confidence, names, 3 if deep else 2, tuple(notes)
    )


def _why_nobody(frames: Sequence[KeypointFrame]) -> str:
    """Return why no frame has anybody's points."""
    keys = next((k for f in frames for k in f.kept if k), None)
    if keys is None:
        return "nobody is in any of its frames"
    named = ", ".join(repr(k[:30]) for k in keys[:8])
    return f"its people have no body's keypoints that are known, only {named}"


def _stretch(
    people: Sequence[Sequence[SeenPerson]], picture: tuple[float, float] | None, notes: list[str]
) -> Array:
    """Return what to multiply points by: shares of a picture become lengths that are as long down as
    across.
    """
    found = [
        np.abs(p.points[p.confidence > 0, :2]) for some in people for p in some if (p.confidence > 0).any()
    ]
    if not found or float(np.quantile(np.concatenate(found), 0.9)) > 2.0:
        return np.ones(3)
    if picture is None:
        notes.append("how wide and tall the picture is is not said; 16:9 was taken")
        picture = PICTURE
    return np.array([picture[0], picture[1], picture[0]])


def _upright(points: Array, confidence: Array, deep: bool, notes: list[str]) -> Array:
    """Return points with y up and z towards the camera, whichever way the file has them: heads are above
    hips, noses before ears.
    """
    where, sure = zip(*(choose_points(p, c) for p, c in zip(points, confidence, strict=True)), strict=True)
    at, seen = np.array(where), np.array(sure) > 0.2

    def middle(*names: str) -> tuple[Array, Array]:
        places = [PLACE[n] for n in names]
        return np.asarray(at[:, places].mean(1)), np.asarray(seen[:, places].all(1))

    top, has_top = middle("left_shoulder", "right_shoulder")
    low, has_low = middle("left_hip", "right_hip")
    standing = has_top & has_low
    if deep and standing.any():
        trunk = np.median((top - low)[standing], axis=0)
        if abs(trunk[2]) > 1.5 * abs(trunk[1]):
            notes.append("z grows upwards in it" if trunk[2] > 0 else "z grows downwards in it")
            across = (at[:, PLACE["left_shoulder"]] - at[:, PLACE["right_shoulder"]])[standing, 0]
            return _turn_z_up(points, float(np.sign(trunk[2])), float(np.median(across)) < 0)
    nose, has_nose = middle("nose")
    up, known = (top - low)[:, 1], has_top & has_low
    if not known.any():
        up, known = (nose - top)[:, 1], has_nose & has_top
    upwards = bool(known.any()) and float(np.median(up[known])) > 0
    if upwards:
        notes.append("y grows upwards in it")
    signs = np.array([1.0, 1.0 if upwards else -1.0, -1.0])
    if not deep:
        return np.asarray(points * [signs[0], signs[1], 0.0])
    ears, has_ears = middle("left_ear", "right_ear")
    known = has_nose & has_ears & has_top
    if known.any():
        across = (at[:, PLACE["left_shoulder"]] - at[:, PLACE["right_shoulder"]]) * signs
        ahead = (nose - ears) * signs
        facing = across[:, 0] * ahead[:, 2] - across[:, 2] * ahead[:, 0]  # along across x up
        if float(np.median(facing[known])) < 0:
            signs[2] = 1.0
    return np.asarray(points * signs)


def _turn_z_up(points: Array, up: float, away: bool) -> Array:
    """Return points whose z is vertical, with y up. up: -1 if z grows downwards. away: whether the body's
    left is at smaller x, so that it is turned round to face the camera.
    """
    turned = points[..., [0, 2, 1]] * [1.0, up, -up]
    return np.asarray(turned * ([-1.0, 1.0, -1.0] if away else [1.0, 1.0, 1.0]))


def _many(count: int, word: str) -> str:
    return f"{count} {word}{'s' if count != 1 else ''}"
