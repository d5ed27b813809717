"""From frames of keypoints to one person over time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.common.budgets import KEYPOINT_SECONDS
from metagraph.errors import FileError
from metagraph.formats.keypoints.frames import REMEDY, KeypointFrame
from metagraph.mimicry.keypoint_layouts import BY_COUNT, LAYOUTS, PLACE, KeypointTrack, choose_points
from metagraph.mimicry.people import SeenPerson, follow_person

Array = NDArray[Any]

FPS = 30.0  # frames a second, if nothing says how many
GUESSED = 33  # points of MediaPipe, whose depth comes from one picture
PICTURE = (16.0, 9.0)  # what a picture measures, if nothing says it
CUT = "Correct them, or cut the recording into pieces."


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
        raise FileError(path, f"its frames lie {lasts:.3g} s apart", "their times or numbers", CUT)
    kept = np.flatnonzero(np.concatenate([[True], np.diff(np.maximum.accumulate(times)) > 0]))
    if len(kept) < len(times):
        notes.append(
            f"{_many(len(times) - len(kept), 'frame')} left out that came no later than the one before"
        )
    times, frames = times[kept], [frames[n] for n in kept]
    track = _gathered(path, times, frames, picture, notes)
    if track.dims == 3 and len(track.names) == GUESSED and _have_pictures(frames):
        flat = [replace(frame, space=[]) for frame in frames]
        return replace(track, flat=_gathered(path, times, flat, picture, list(notes)))
    return track


def _have_pictures(frames: Sequence[KeypointFrame]) -> bool:
    """Return whether the points of people in space come with those of the same people in the picture."""
    return all(
        len(frame.flat) == len(frame.space) and all(len(person.points) == GUESSED for person in frame.flat)
        for frame in frames
    )


def _times(frames: Sequence[KeypointFrame], fps: float | None, notes: list[str]) -> Array:
    """Return seconds of frames, from 0: as they say, else from their numbers."""
    said = [f.time for f in frames]
    if all(t is not None for t in said) and len(said) > 1:
        times = np.array(said, float)
        step = float(np.median(np.diff(times)))
        unit = 1.0 if step < 5 else 1e-3 if step < 5000 else 1e-6 if step < 5e6 else 1e-9
        return np.asarray((times - times[0]) * unit)
    if fps is None and len(frames) > 1:
        notes.append(f"it does not give its frame rate; {FPS:g} frames a second were assumed")
    numbers = [f.number for f in frames]
    known = all(n is not None for n in numbers)
    count = np.array(numbers if known else range(len(frames)), float)
    return np.asarray((count - count[0]) / (fps or FPS))


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
    if count not in BY_COUNT:
        raise FileError(
            path,
            f"people have {count} points, which no known layout has",
            "in its frames",
            f"Known are {', '.join(f'{n} ({name})' for n, name in sorted(BY_COUNT.items()))}.",
        )
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
