"""Read pictures and sound of a video, with PyAV, to show videos of others like our own."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from metagraph.common.budgets import MOTION_FILE, PICTURE_PIXELS
from metagraph.common.files import check_file
from metagraph.errors import FileError

Array = NDArray[Any]
JUMP = 2.0  # seconds; farther pictures are reached by seeking
_REMEDY = "Convert it to MP4 (H.264), and check that it plays."


def measure_video_seconds(path: str | Path) -> float:
    """Return how long a video lasts, in seconds. Raises FileError."""
    import av

    path = check_file(path, MOTION_FILE)
    try:
        with av.open(str(path)) as container:
            stream = container.streams.video[0]
            if stream.width * stream.height > PICTURE_PIXELS:
                raise FileError(
                    path, "its pictures are too large", f"{stream.width} x {stream.height}", _REMEDY
                )
            if container.duration:
                return float(container.duration / av.time_base)
            return float((stream.duration or 0) * (stream.time_base or 0))
    except (OSError, ValueError, IndexError) as error:
        raise FileError(path, f"is no video that can be read ({error})", "", _REMEDY) from None


def read_pictures(path: str | Path, times: Array, size: tuple[int, int]) -> Iterator[Array]:
    """Yield the picture, uint8 `[H, W, 3]`, that is shown at each of the ascending times (seconds), fitted
    into width and height with black borders. Raises FileError if the video ends before the last time.
    """
    import av

    path = check_file(path, MOTION_FILE)
    wanted = iter(np.asarray(times, np.float64).tolist())
    at = next(wanted, None)
    shown: Array | None = None
    try:
        with av.open(str(path)) as container:
            for frame in container.decode(video=0):
                moment = float(frame.time or 0.0)
                while at is not None and shown is not None and moment > at + 1e-6:
                    yield shown
                    at = next(wanted, None)
                if at is None:
                    return
                shown = _fitted(frame.to_ndarray(format="rgb24"), size)
            last = float(np.asarray(times)[-1]) + 0.05
            while at is not None and shown is not None and at <= last and moment + 0.2 >= at:
                yield shown  # the last picture is shown for a while
                at = next(wanted, None)
    except (OSError, ValueError, IndexError) as error:
        raise FileError(path, f"is no video that can be read ({error})", "", _REMEDY) from None
    if at is not None:
        raise FileError(path, "ends too early", f"{at:.2f} s", "Give a longer video, or a shorter item.")


class VideoPictures:
    """The pictures of a video at any time: fast forwards, with a seek backwards. Use it from one thread.
    Raises FileError.

    `path` is the file. `most` is the largest width and height of the pictures. `seconds` is how long it
    lasts.
    """

    def __init__(self, path: str | Path, most: tuple[int, int] = (960, 540)) -> None:
        import av

        self.path = check_file(path, MOTION_FILE)
        self.seconds = measure_video_seconds(path)
        try:
            self._container = av.open(str(self.path))
            self._stream = self._container.streams.video[0]
            self._stream.thread_type = "AUTO"
            wide, high = max(1, self._stream.width), max(1, self._stream.height)
        except (OSError, ValueError, IndexError) as error:
            raise FileError(self.path, f"is no video that can be read ({error})", "", _REMEDY) from None
        scale = min(1.0, most[0] / wide, most[1] / high)
        self.size = max(2, round(wide * scale)), max(2, round(high * scale))
        self._frames: Iterator[Any] | None = None
        self._now: Any = None  # the frame that is shown, and the next
        self._next: Any = None
        self._picture: tuple[Any, Array] | None = None

    def at(self, seconds: float) -> Array:
        """Return the picture, uint8 `[H, W, 3]`, that is shown at a time: the first before the beginning, the
        last after the end. The same array is returned as long as it is the same picture.
        """
        try:
            self._go_to(max(0.0, seconds))
        except (OSError, ValueError) as error:
            raise FileError(self.path, f"cannot be read on ({error})", f"{seconds:.2f} s", _REMEDY) from None
        if self._now is None:
            raise FileError(self.path, "has no pictures", "", _REMEDY)
        if self._picture is None or self._picture[0] is not self._now:
            width, height = self.size
            picture = self._now.to_ndarray(format="rgb24", width=width, height=height)
            self._picture = self._now, np.ascontiguousarray(picture)
        return self._picture[1]

    def _go_to(self, seconds: float) -> None:
        far = self._now is not None and seconds > self._moment(self._now) + JUMP
        if self._now is None or far or seconds < self._moment(self._now) - 1e-6:
            begin = int(seconds / (self._stream.time_base or 1))
            self._container.seek(max(0, begin), stream=self._stream, backward=True)
            self._frames = self._container.decode(self._stream)
            self._now, self._next = next(self._frames, None), None
            if self._now is None and seconds > 0:  # nothing begins there: from the start on, to the end
                self._container.seek(0, stream=self._stream)
                self._frames = self._container.decode(self._stream)
                self._now = next(self._frames, None)
        while self._frames is not None:
            if self._next is None:
                self._next = next(self._frames, None)
            if self._next is None or self._moment(self._next) > seconds + 1e-6:
                return
            self._now, self._next = self._next, None

    def _moment(self, frame: Any) -> float:
        return float(frame.time or 0.0)

    def close(self) -> None:
        self._frames = self._now = self._next = None
        self._container.close()


def _fitted(picture: Array, size: tuple[int, int]) -> Array:
    width, height = size
    high, wide = picture.shape[:2]
    if (wide, high) == size:
        return picture
    scale = min(width / wide, height / high)
    inner = (max(1, round(wide * scale)), max(1, round(high * scale)))
    out = np.zeros((height, width, 3), np.uint8)
    x, y = (width - inner[0]) // 2, (height - inner[1]) // 2
    small = np.asarray(Image.fromarray(picture).resize(inner, Image.Resampling.LANCZOS))
    out[y : y + inner[1], x : x + inner[0]] = small
    return out


def read_video_sound(path: str | Path, rate: int) -> Array | None:
    """Return a video's sound, mono float32 `[N]` at `rate`; None if it has none. Raises FileError."""
    import av

    path = check_file(path, MOTION_FILE)
    try:
        with av.open(str(path)) as container:
            if not container.streams.audio:
                return None
            resampler = av.AudioResampler(format="flt", layout="mono", rate=rate)
            parts = [
                part.to_ndarray().reshape(-1)
                for frame in container.decode(audio=0)
                for part in resampler.resample(frame)
            ]
            parts += [part.to_ndarray().reshape(-1) for part in resampler.resample(None)]
    except (OSError, ValueError, IndexError) as error:
        raise FileError(path, f"its sound cannot be read ({error})", "", _REMEDY) from None
    return np.concatenate(parts).astype(np.float32) if parts else None
