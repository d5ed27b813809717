"""One frame of keypoints: whose points it holds, in whichever way they are written, and when it was."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.errors import FileError
from metagraph.mimicry.keypoint_layouts import BY_COUNT, describe_layouts
from metagraph.mimicry.people import SeenPerson

Array = NDArray[Any]

FARTHEST = 1e7  # of a coordinate, in any unit
MOST_PEOPLE = 200  # in one frame
# How keys are spelt, without capitals, hyphens and underscores.
_SPACE = ("worldlandmarks", "poseworldlandmarks", "keypoints3d", "posekeypoints3d")
# `posekeypoints` is OpenPose's 1.0 and 1.1, `bodyparts` 1.0, `joints` before it.
_FLAT = ("landmarks", "poselandmarks", "keypoints", "posekeypoints2d", "posekeypoints", "bodyparts", "joints")
_PEOPLE = ("people", "instances", "bodies", "persons")  # OpenPose, MMPose, OpenPose before 1.0
_SCORES = ("keypointscores", "scores")  # of points that stand without their confidence, as MMPose writes
_SECONDS = ("t", "time", "seconds", "timestamp", "timesec", "timestampsec")
_MILLISECONDS = ("timestampms", "timems", "ms", "milliseconds")
_NUMBER = ("frame", "frameid", "frameindex", "framenumber", "frameidx", "imageid")
_SURE = ("visibility", "confidence", "score", "presence", "c", "v")
REMEDY = "Choose what OpenPose writes with --write_json, MediaPipe's pose landmarks, or MMPose's predictions."


@dataclass
class KeypointFrame:
    """A frame while it is being read. where: for messages. time: seconds; number: of the frame; either may be
    unknown.
    """

    where: str
    time: float | None = None
    number: int | None = None
    flat: list[SeenPerson] = field(default_factory=list)
    kept: list[list[str]] = field(default_factory=list)  # of each person, what the file has
    space: list[SeenPerson] = field(default_factory=list)


def normalize_key(key: str) -> str:
    """Return a key in small letters, without underscores and hyphens."""
    return key.replace("_", "").replace("-", "").lower()


def has_people(item: Mapping[str, Any]) -> bool:
    return any(normalize_key(k) in (*_SPACE, *_FLAT, *_PEOPLE) for k in item)


def is_json_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def is_person(value: Any) -> bool:
    """Whether a list is somebody's points: objects or rows, as many as a layout has, or all numbers of
    such.
    """
    if not isinstance(value, list) or not value:
        return False
    if is_json_number(value[0]):
        return (len(value) % 3 == 0 and len(value) // 3 in BY_COUNT) or (
            len(value) % 4 == 0 and len(value) // 4 in BY_COUNT
        )
    first = value[0]
    point = (isinstance(first, dict) and "x" in first) or (
        isinstance(first, list) and 2 <= len(first) <= 5 and is_json_number(first[0])
    )
    return len(value) in BY_COUNT and point


def is_untimed_person(item: Any) -> bool:
    """Return whether an entry of a list is one of several people in a picture, as MMPose writes them: points
    with their scores and a box, and neither a time nor a number of a frame.
    """
    if not isinstance(item, dict):
        return False
    said = {normalize_key(str(k)) for k in item}
    timed = said & {*_SECONDS, *_MILLISECONDS, *_NUMBER}
    return "keypoints" in said and "bbox" in said and bool(said & set(_SCORES)) and not timed


def read_frame(path: Path, item: Any, where: str) -> KeypointFrame:
    """Return what a frame holds. Raises FileError for what is no frame."""
    out = KeypointFrame(where)
    if isinstance(item, list) and item and all(isinstance(p, dict) and has_people(p) for p in item):
        item = {"people": item}  # MMPose's list of the people of one picture
    if isinstance(item, list):
        out.flat = list(_people(path, item, where, False))
        return out
    if not isinstance(item, dict):
        raise FileError(path, "it is no frame: an object or a list is expected", where, REMEDY)
    said = {normalize_key(k): v for k, v in item.items()}
    _when(path, said, out)
    several = next((k for k in _PEOPLE if k in said), None)
    if several is not None:
        people = said[several]
        if not isinstance(people, list) or not all(isinstance(p, dict) for p in people):
            raise FileError(path, f"'{several}' is not a list of people", where, REMEDY)
        out.kept = [sorted(map(str, p)) for p in people]
        for person in people[:MOST_PEOPLE]:
            _take(path, _with_scores(path, {normalize_key(k): v for k, v in person.items()}, where), out)
    elif any(k in said for k in (*_SPACE, *_FLAT)):
        _take(path, _with_scores(path, said, where), out)
    elif out.time is None and out.number is None:
        keys = ", ".join(list(map(str, item))[:6]) or "nothing"
        raise FileError(path, f"it holds no keypoints; it has {keys}", where, REMEDY)
    return out


def _with_scores(path: Path, said: dict[str, Any], where: str) -> dict[str, Any]:
    """Return a person's values, with points `[[x, y], ...]` that stand beside their scores joined to `[[x, y,
    score], ...]`, or `[[x, y, z, score], ...]` as points in space. Raises FileError.
    """
    scores = next((said[k] for k in _SCORES if isinstance(said.get(k), list)), None)
    points = said.get("keypoints")
    if scores is None or not isinstance(points, list) or not points or not isinstance(points[0], list):
        return said
    if len(scores) != len(points) or not all(isinstance(p, list) for p in points):
        raise FileError(
            path, f"{len(points)} points have {len(scores)} scores", where, "Correct them, or leave one out."
        )
    joined = [[*p, s] for p, s in zip(points, scores, strict=True)]
    if len(points[0]) == 3:
        return {**{k: v for k, v in said.items() if k != "keypoints"}, "keypoints3d": joined}
    return {**said, "keypoints": joined}


def _when(path: Path, said: Mapping[str, Any], out: KeypointFrame) -> None:
    for keys, unit in ((_MILLISECONDS, 1e-3), (_SECONDS, 1.0)):
        value = next((said[k] for k in keys if k in said), None)
        if value is not None:
            if not is_json_number(value) or not abs(value) <= 1e18:
                raise FileError(
                    path,
                    f"its time is {str(value)[:40]!r}, not a number",
                    out.where,
                    "Correct it, or leave times out.",
                )
            out.time = float(value) * unit
            return
    value = next((said[k] for k in _NUMBER if k in said), None)
    if isinstance(value, str):
        digits = re.findall(r"\d+", value)
        value = int(digits[-1][-15:]) if digits else None
    if is_json_number(value) and 0 <= value <= 1e15:  # type: ignore[operator]
        out.number = int(value)  # type: ignore[arg-type]


def _take(path: Path, said: Mapping[str, Any], out: KeypointFrame) -> None:
    ident = said.get("personid", said.get("id", said.get("idx")))
    ident = ident[0] if isinstance(ident, list) and ident else ident
    number = ident if isinstance(ident, int) and not isinstance(ident, bool) and ident >= 0 else None
    for keys, people, space in ((_SPACE, out.space, True), (_FLAT, out.flat, False)):
        value = next((said[k] for k in keys if said.get(k)), None)
        if value is not None:
            people += _people(
                path,
                value,
                out.where,
                space,
                number,
                said_sure=any(
                    k in said for k in ("posekeypoints2d", "posekeypoints", "keypoints", "bodyparts")
                ),
            )


def _people(
    path: Path, value: Any, where: str, space: bool, ident: int | None = None, said_sure: bool = False
) -> Iterator[SeenPerson]:
    """Yield the people of a list of points, or of a list of such lists. said_sure: rows of three end in the
    confidence.
    """
    if isinstance(value, dict):
        value = value.get("landmark", value.get("landmarks"))
    if isinstance(value, list) and not value:
        return
    if not isinstance(value, list):
        raise FileError(path, "its keypoints are not a list", where, REMEDY)
    if is_person(value):
        points, confidence = _points(path, value, where, space, said_sure)
        yield SeenPerson(points, confidence, ident)
        return
    several = [
        v.get("landmark", v.get("landmarks")) if isinstance(v, dict) and "x" not in v else v for v in value
    ]
    if several and all(is_person(v) or v == [] for v in several):
        for one in several[:MOST_PEOPLE]:
            if one:
                points, confidence = _points(path, one, where, space, said_sure)
                yield SeenPerson(points, confidence)
        return
    numbers = len(value) // 3 if value and is_json_number(value[0]) else len(value)
    raise FileError(
        path, f"{numbers} points are none of the layouts that are known: {describe_layouts()}", where, REMEDY
    )


def _points(path: Path, value: list[Any], where: str, space: bool, said_sure: bool) -> tuple[Array, Array]:
    """Return somebody's points `[K, 3]` and confidence `[K]`; what is null or not a number that could be was
    not found.
    """
    if is_json_number(value[0]):
        size = 4 if space and len(value) % 4 == 0 and len(value) // 4 in BY_COUNT else 3
        value = [value[n : n + size] for n in range(0, len(value), size)]
        said_sure = True
    out = np.zeros((len(value), 4))
    for row, point in zip(out, value, strict=True):
        if isinstance(point, dict):
            numbers = [point.get("x"), point.get("y"), point.get("z", 0.0)]
            sure = next((point[k] for k in _SURE if point.get(k) is not None), 1.0)
        elif isinstance(point, list):
            flat = (said_sure and not space) or len(point) == 2
            numbers = [*point[:2], 0.0] if flat else [*point[:3]]
            rest = point[2:] if flat else point[3:]
            sure = rest[0] if rest else 1.0
        else:
            raise FileError(path, f"a point is {str(point)[:40]!r}, not an object or a list", where, REMEDY)
        if len(numbers) < 3 or any(n is None for n in (*numbers, sure)):
            continue
        if not all(map(is_json_number, (*numbers, sure))):
            raise FileError(
                path, f"a point holds {str(point)[:60]}, which are not all numbers", where, "Correct it."
            )
        if max(map(abs, numbers)) <= FARTHEST:
            row[:3], row[3] = numbers, min(1.0, max(0.0, sure))
    out[~out[:, :3].any(1), 3] = 0.0  # zeros stand for what was not found
    return out[:, :3], out[:, 3]
