"""Read the pictures of a video file, the way up that a player shows them, each with its time."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.common.budgets import KEYPOINT_SECONDS, MOTION_FILE, PICTURE_PIXELS
from metagraph.common.files import check_file
from metagraph.common.wording import phrase
from metagraph.errors import FileError

Array = NDArray[Any]

# Endings of videos, for dialogs and to tell them from keypoints; what is in a file is found out on opening.
VIDEO_ENDINGS = (".mp4", ".mov", ".m4v", ".mkv", ".webm", ".avi", ".mpg", ".mpeg", ".wmv", ".mts", ".3gp")
RATE = 30.0  # pictures a second at most; others between are left out
LARGEST = 960  # pixels of the longer side that an estimator is given; its models look at 256
REMEDY = phrase("Convert it to MP4 (H.264), and check that it plays.")


@dataclass(frozen=True, eq=False)
class FilmedPicture:
    """seconds: when it is shown, by the file's or the camera's clock. picture: uint8 `[H, W, 3]`, red, green,
    blue.
    """

    seconds: float
    picture: Array


@dataclass
class VideoFile:
    """A video to be read once. Raises FileError for what is none. seconds: how long it lasts, 0 if it does
    not say. has_sound: whether it has sound, which is not read. left_out: pictures that came faster than
    RATE. broken: why it could not be read to its end, else "".
    """

    path: Path
    seconds: float = 0.0
    has_sound: bool = False
    left_out: int = 0
    broken: str = ""
    _container: Any = field(default=None, repr=False)
    _aspect: float = 1.0

    def __post_init__(self) -> None:
        import av

        check_file(self.path, MOTION_FILE)
        try:
            self._container = av.open(str(self.path))
        except (OSError, ValueError) as error:
            raise _describe_unread(self.path, error) from None
        try:
            self._look()
        except BaseException:
            self.close()
            raise

    def _look(self) -> None:
        import av

        if not self._container.streams.video:
            raise FileError(
                self.path, phrase("it has no pictures"), "", phrase("Choose a video of a person.")
            )
        stream = self._container.streams.video[0]
        if stream.width * stream.height > PICTURE_PIXELS:
            size = f"{stream.width} x {stream.height}"
            raise FileError(self.path, phrase("its pictures are too large"), size, REMEDY)
        stream.thread_type = "AUTO"
        self._aspect = float(stream.sample_aspect_ratio or 1.0)
        self.has_sound = bool(self._container.streams.audio)
        self.seconds = max(0.0, float((self._container.duration or 0) / av.time_base))

    def read(self) -> Iterator[FilmedPicture]:
        """Yield its pictures in order, RATE a second at most. A file that breaks off yields what it has; one
        without a single picture raises FileError.
        """
        last, count = None, 0
        try:
            for frame in self._container.decode(video=0):
                count += 1
                seconds = frame.time if frame.time is not None else (count - 1) / self._rate()
                if last is not None and seconds < last + 0.9 / RATE:
                    self.left_out += seconds > last
                    continue
                if last is not None and seconds - last > KEYPOINT_SECONDS:
                    self.broken = f"its pictures lie {seconds - last:.3g} s apart"
                    break
                last = float(seconds)
                yield FilmedPicture(last, to_upright_picture(frame, self._aspect))
        except (OSError, ValueError) as error:
            if last is None:
                raise _describe_unread(self.path, error) from None
            self.broken = str(error)
        if last is None:
            raise FileError(self.path, phrase("it has no pictures"), "", REMEDY)

    def _rate(self) -> float:
        return float(self._container.streams.video[0].average_rate or RATE)

    def close(self) -> None:
        """Close the file."""
        if self._container is not None:
            self._container.close()


def to_upright_picture(frame: Any, aspect: float = 1.0) -> Array:
    """Return a frame of PyAV's as a picture `[H, W, 3]` of at most LARGEST pixels a side, turned as the file
    says and with square pixels. aspect: width of its pixels, in heights of them.
    """
    wide, high = frame.width * (aspect if 0.1 < aspect < 10 else 1.0), float(frame.height)
    scale = min(1.0, LARGEST / max(wide, high))
    width, height = max(2, round(wide * scale)), max(2, round(high * scale))
    picture = frame.to_ndarray(format="rgb24", width=width, height=height)
    quarters = round(getattr(frame, "rotation", 0) / 90) % 4  # counter-clockwise, as np.rot90 turns
    return np.ascontiguousarray(np.rot90(picture, quarters))


def is_video(path: str | Path) -> bool:
    """Return whether a file's name ends as those of videos do."""
    return Path(path).suffix.lower() in VIDEO_ENDINGS


def _describe_unread(path: Path, error: Exception) -> FileError:
    words = (error.strerror or str(error)) if isinstance(error, OSError) else str(error)
    return FileError(path, phrase("it is not a video that can be read ({words})", words=words), "", REMEDY)
