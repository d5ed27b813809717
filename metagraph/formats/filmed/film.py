"""From a video or a camera to the keypoints of one person."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable
from contextlib import closing
from dataclasses import dataclass
from itertools import takewhile
from pathlib import Path
from typing import Any

from metagraph.common.budgets import KEYPOINT_FRAMES
from metagraph.common.wording import phrase
from metagraph.errors import FileError
from metagraph.formats.atomic import write_atomically
from metagraph.formats.filmed.camera import CameraFeed
from metagraph.formats.filmed.estimator import PoseEstimator
from metagraph.formats.filmed.video import RATE, FilmedPicture, VideoFile
from metagraph.formats.keypoints.frames import read_frame
from metagraph.formats.keypoints.tracks import make_keypoint_track
from metagraph.mimicry.keypoint_layouts import KeypointTrack

RARE = 0.98  # share of the pictures with somebody in them below which it is said
_FILM = phrase("Film one person from the front, at least from the head to the hips, in good light.")

Tell = Callable[[int, int], None]


class FilmStoppedError(RuntimeError):
    """Whoever asked for the keypoints stopped it."""


@dataclass(frozen=True, eq=False)
class FilmedKeypoints:
    """What was seen. track: of one person; frames: as the estimator says them; estimator: its name."""

    track: KeypointTrack
    frames: tuple[dict[str, Any], ...]
    estimator: str


def film_video(
    path: str | Path,
    tell: Tell = lambda done, total: None,
    is_stopped: Callable[[], bool] = lambda: False,
) -> FilmedKeypoints:
    """Return the keypoints of the person in a video. tell: called with how many pictures are done, and of how
    many there are about. Raises FileError, EstimatorError, and FilmStoppedError.
    """
    path = Path(path)
    with closing(VideoFile(path)) as video:
        notes = ["its sound is not used"] if video.has_sound else []
        about = max(1, round(video.seconds * RATE))
        with closing(PoseEstimator()) as estimator:
            frames = _look_at(video.read(), estimator, lambda done: tell(done, max(about, done)), is_stopped)
        tell(len(frames), len(frames))
        if video.broken:
            last = frames[-1]["time"]
            notes.append(f"it breaks off after {last:.1f} s ({video.broken}); what comes before is used")
        if video.left_out:
            notes.append(f"{RATE:g} of its pictures a second are looked at")
    return _gather(path, frames, estimator.name, notes)


def film_camera(
    device: str,
    seconds: float | None = None,
    tell: Callable[[float], None] = lambda seconds: None,
    is_stopped: Callable[[], bool] = lambda: False,
) -> FilmedKeypoints:
    """Return the keypoints of the person before a camera (`CameraFeed`), filmed until `is_stopped` or for so
    many seconds. tell: called with the seconds that were filmed. Raises CameraError, FileError,
    EstimatorError.
    """
    with closing(PoseEstimator()) as estimator, closing(CameraFeed(device)) as camera:
        pictures = takewhile(
            lambda picture: not is_stopped() and (seconds is None or picture.seconds <= seconds),
            camera.read(),
        )
        frames = _look_at(pictures, estimator, lambda done: None, lambda: False, tell)
    if not frames:
        raise FileError(Path(device), phrase("nothing was filmed"), "", _FILM)
    return _gather(Path(device), frames, estimator.name, [])


def _look_at(
    pictures: Iterable[FilmedPicture],
    estimator: PoseEstimator,
    done: Callable[[int], None],
    is_stopped: Callable[[], bool],
    at: Callable[[float], None] = lambda seconds: None,
) -> list[dict[str, Any]]:
    frames: list[dict[str, Any]] = []
    for picture in pictures:
        if is_stopped():
            raise FilmStoppedError("stopped")
        frames.append(estimator.look(picture))
        done(len(frames))
        at(picture.seconds)
        if len(frames) >= KEYPOINT_FRAMES:
            break
    return frames


def _gather(path: Path, frames: list[dict[str, Any]], estimator: str, notes: list[str]) -> FilmedKeypoints:
    seen = sum("worldLandmarks" in frame for frame in frames)
    count = f"{len(frames):,} picture{'s' if len(frames) != 1 else ''}"
    if not seen:
        raise FileError(path, phrase("nobody was found in it"), count, _FILM)
    if seen < RARE * len(frames):
        notes.append(f"nobody was found in {len(frames) - seen:,} of its {count}")
    read = [read_frame(path, frame, f"picture {n}") for n, frame in enumerate(frames)]
    track = make_keypoint_track(path, read, None, None, [*notes, f"found by {estimator}"])
    return FilmedKeypoints(track, tuple(frames), estimator)


def write_filmed_keypoints(filmed: FilmedKeypoints, path: str | Path) -> None:
    """Write what the estimator said, one JSON object a line, as `read_keypoints` reads it."""
    head = {"note": f"Found by {filmed.estimator}."}
    lines = [json.dumps(line, separators=(",", ":")) for line in (head, *filmed.frames)]
    write_atomically(Path(path), ("\n".join(lines) + "\n").encode())
