"""Writes pictures to an MP4 (H.264), through PyAV."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable
from concurrent.futures import Future, ThreadPoolExecutor
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.errors import FileError
from metagraph.formats.outputs import being_written

Array = NDArray[Any]

IN_FLIGHT = 3  # pictures that wait for the encoder


class Cancelled(Exception):  # noqa: N818 - not an error: the user asked for it
    """The user stopped a video; nothing was left behind."""


def write_video(
    path: str | Path,
    frames: Iterable[Array],
    fps: float,
    size: tuple[int, int] | None = None,
    progress: Callable[[int], None] | None = None,
    cancelled: Callable[[], bool] | None = None,
    quality: int = 20,
    sound: tuple[Array, int] | None = None,
) -> int:
    """Write `frames` (uint8 `[H, W, 3 or 4]`, sRGB, all of one size) at `fps` and return how many there were.

    size: width and height of the video; by default that of the first frame, made even as H.264 needs. Frames
    that differ are scaled. quality: x264's rate factor, 0 (lossless) .. 51. progress is called with the
    number of frames written. sound: mono samples `[N]`, -1..1, and how many there are a second; cut or filled
    with silence to the pictures' length. Pictures are encoded while the next are drawn, `IN_FLIGHT` of them
    at most; `frames` is asked, and progress told, in the caller's thread. The file appears only when it is
    complete. Raises FileError (no frames, not writable), Cancelled.
    """
    import av

    path = Path(path)
    if not (fps > 0 and np.isfinite(fps)):
        raise FileError(path, f"{fps} frames per second is no frame rate")
    part = path.with_name(f".{path.name}.part.mp4")
    count = 0
    try:
        with (
            av.open(str(part), "w", format="mp4", options={"movflags": "faststart"}) as container,
            ThreadPoolExecutor(1) as encoder,
        ):
            stream: Any = None
            voice: Any = None
            encoding: deque[Future[None]] = deque()

            def encode(frame: Any) -> None:
                for packet in stream.encode(frame):  # scales to the stream's size where it differs
                    container.mux(packet)

            def encoded(waiting: int) -> None:
                """Come back when no more than so many wait."""
                nonlocal count
                while len(encoding) > waiting:
                    encoding.popleft().result()
                    count += 1
                    if progress is not None:
                        progress(count)

            for picture in frames:
                if cancelled is not None and cancelled():
                    raise Cancelled
                if stream is None:
                    height, width = picture.shape[:2]
                    width, height = size or (width, height)
                    stream = container.add_stream("libx264", rate=Fraction(fps).limit_denominator(1001))
                    stream.width, stream.height = max(2, width + width % 2), max(2, height + height % 2)
                    stream.pix_fmt = "yuv420p"
                    stream.options = {"preset": "veryfast", "crf": str(quality), "tune": "animation"}
                    if sound is not None:
                        voice = container.add_stream("aac", rate=sound[1], layout="mono")
                frame = _frame(picture)  # a copy: who draws may draw into the same memory again
                encoded(IN_FLIGHT - 1)
                encoding.append(encoder.submit(encode, frame))
            encoded(0)
            if stream is None:
                raise FileError(
                    path, "there are no frames to write", remedy="Choose a time span longer than one frame."
                )
            for packet in stream.encode():
                container.mux(packet)
            if voice is not None and sound is not None:
                _write_sound(container, voice, sound[0], round(count / fps * sound[1]))
        with being_written(path):
            part.replace(path)
    except OSError as error:
        raise FileError(
            path, f"the video could not be written ({error})", remedy="Check the folder and the free space."
        ) from error
    finally:
        part.unlink(missing_ok=True)
    return count


def _frame(picture: Array) -> Any:
    """Copy a picture to where the encoder takes it from; it may lie in memory from below."""
    import av

    height, width, channels = picture.shape
    frame = av.VideoFrame(width, height, "rgba" if channels == 4 else "rgb24")
    plane: Any = frame.planes[0]
    rows = np.frombuffer(plane, np.uint8).reshape(height, plane.line_size)
    rows[:, : width * channels].reshape(height, width, channels)[...] = picture
    return frame


def _write_sound(container: Any, stream: Any, samples: Array, count: int) -> None:
    """Encode `count` samples, in the blocks AAC has."""
    import av

    whole = np.zeros(count, np.float32)
    whole[: min(count, len(samples))] = samples[:count]
    size = 1024
    for first in range(0, count, size):
        frame = av.AudioFrame.from_ndarray(
            np.ascontiguousarray(whole[None, first : first + size]), format="fltp", layout="mono"
        )
        frame.sample_rate, frame.pts = stream.rate, first
        for packet in stream.encode(frame):
            container.mux(packet)
    for packet in stream.encode():
        container.mux(packet)
