"""Write pictures to a video with PyAV: MP4 (H.264), or MOV (ProRes 4444) and WebM (VP9), which hold alpha."""

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
from metagraph.formats.outputs import claim_output

Array = NDArray[Any]

IN_FLIGHT = 3  # pictures that wait for the encoder
# By the end of the file's name: container, encoder, pixels and sound.
ENCODINGS = {
    ".mp4": ("mp4", "libx264", "yuv420p", "aac"),
    ".mov": ("mov", "prores_ks", "yuva444p10le", "aac"),
    ".webm": ("webm", "libvpx-vp9", "yuva420p", "libopus"),
}
OPUS_RATE = 48000  # Hz: the sound of WebM


class Cancelled(Exception):  # noqa: N818 - not an error: the user asked for it
    """Raised if the user stops a video. No file is left."""


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
    The end of the file's name says how, see `ENCODINGS`: MOV and WebM keep alpha, which is not premultiplied.

    `size` is the width and height of the video, by default that of the first frame, made even as H.264 needs;
    frames of another size are scaled. `quality` is x264's rate factor, 0 (lossless) .. 51. `progress` is
    called with the number of frames written. `sound` is mono samples `[N]`, -1..1, and their rate in Hz; it
    is cut or filled with silence to the length of the pictures.

    Pictures are encoded while the next ones are drawn, at most `IN_FLIGHT` of them. `frames` is read and
    `progress` called in the caller's thread. The file appears only when it is complete. Raises FileError (no
    frames, not writable) and Cancelled.
    """
    import av

    path = Path(path)
    if not (fps > 0 and np.isfinite(fps)):
        raise FileError(path, f"{fps} frames per second is no frame rate")
    ending = path.suffix.lower() if path.suffix.lower() in ENCODINGS else ".mp4"
    part = find_part_path(path)
    options = {} if ending == ".webm" else {"movflags": "faststart"}
    try:
        with (
            av.open(str(part), "w", format=ENCODINGS[ending][0], options=options) as container,
            ThreadPoolExecutor(1) as encoder,
        ):
            video = _Video(container, encoder, progress, ending)
            for picture in frames:
                if cancelled is not None and cancelled():
                    raise Cancelled
                if video.stream is None:
                    height, width = picture.shape[:2]
                    video.begin(size or (width, height), fps, quality, None if sound is None else sound[1])
                video.add(picture)
            if video.stream is None:
                raise FileError(
                    path, "there are no frames to write", remedy="Choose a time span longer than one frame."
                )
            video.end()
            if sound is not None:
                _write_sound(container, video.voice, sound, video.count / fps)
        with claim_output(path):
            part.replace(path)
    except OSError as error:
        raise FileError(
            path, f"the video could not be written ({error})", remedy="Check the folder and the free space."
        ) from error
    finally:
        part.unlink(missing_ok=True)
    return video.count


def find_part_path(path: Path) -> Path:
    """Return where a video is written until it is complete."""
    return path.with_name(f".{path.name}.part{path.suffix}")


class _Video:
    """A video while it is written. `stream` and `voice` are the streams of pictures and of sound, None until
    it begins. `count` is the number of pictures written.
    """

    def __init__(
        self,
        container: Any,
        encoder: ThreadPoolExecutor,
        progress: Callable[[int], None] | None,
        ending: str,
    ) -> None:
        self.ending = ending
        self.container, self.encoder, self.progress = container, encoder, progress
        self.stream: Any = None
        self.voice: Any = None
        self.count = 0
        self._encoding: deque[Future[None]] = deque()

    def begin(self, size: tuple[int, int], fps: float, quality: int, rate: int | None) -> None:
        """Make the streams. `rate` is the number of sound samples a second, None without sound."""
        width, height = size
        _, encoder, pixels, voice = ENCODINGS[self.ending]
        self.stream = self.container.add_stream(encoder, rate=Fraction(fps).limit_denominator(1001))
        self.stream.width, self.stream.height = max(2, width + width % 2), max(2, height + height % 2)
        self.stream.pix_fmt = pixels
        if self.ending == ".mov":
            self.stream.options = {"profile": "4444", "vendor": "apl0", "alpha_bits": "16"}
        elif self.ending == ".webm":
            self.stream.options = {"crf": str(quality + 4), "b": "0", "deadline": "good", "cpu-used": "5"}
            self.stream.metadata["alpha_mode"] = "1"  # readers look for alpha only then
        else:
            self.stream.options = {"preset": "veryfast", "crf": str(quality), "tune": "animation"}
        if rate is not None:
            rate = OPUS_RATE if self.ending == ".webm" else rate
            self.voice = self.container.add_stream(voice, rate=rate, layout="mono")

    def add(self, picture: Array) -> None:
        """Give a picture to the encoder, once there is room for one more."""
        frame = _frame(picture)  # a copy: the caller may draw into the same memory again
        self._wait(IN_FLIGHT - 1)
        self._encoding.append(self.encoder.submit(self._encode, frame))

    def end(self) -> None:
        """Write what the encoder still holds."""
        self._wait(0)
        for packet in self.stream.encode():
            self.container.mux(packet)

    def _encode(self, frame: Any) -> None:
        for packet in self.stream.encode(frame):  # scales pictures of another size to that of the stream
            self.container.mux(packet)

    def _wait(self, waiting: int) -> None:
        """Return when at most `waiting` pictures wait."""
        while len(self._encoding) > waiting:
            self._encoding.popleft().result()
            self.count += 1
            if self.progress is not None:
                self.progress(self.count)


def _frame(picture: Array) -> Any:
    """Return a copy of a picture for the encoder. The rows of the picture may lie in memory from below."""
    import av

    height, width, channels = picture.shape
    frame = av.VideoFrame(width, height, "rgba" if channels == 4 else "rgb24")
    plane: Any = frame.planes[0]
    rows = np.frombuffer(plane, np.uint8).reshape(height, plane.line_size)
    rows[:, : width * channels].reshape(height, width, channels)[...] = picture
    return frame


def _write_sound(container: Any, stream: Any, sound: tuple[Array, int], seconds: float) -> None:
    """Encode samples that have a rate, as many as seconds need, in blocks of the size that AAC uses."""
    import av

    samples, rate = sound
    if rate != stream.rate:
        times = np.arange(round(len(samples) * stream.rate / rate)) * (rate / stream.rate)
        samples = np.interp(times, np.arange(len(samples)), samples).astype(np.float32)
    count = round(seconds * stream.rate)
    whole = np.zeros(count, np.float32)
    whole[: min(count, len(samples))] = samples[:count]
    if stream.codec_context.format.name.startswith("s16"):
        whole = np.asarray(np.clip(whole, -1, 1) * 32767, np.int16)
    size, kind = stream.codec_context.frame_size or 1024, stream.codec_context.format.name
    for first in range(0, count, size):
        frame = av.AudioFrame.from_ndarray(
            np.ascontiguousarray(whole[None, first : first + size]), format=kind, layout="mono"
        )
        frame.sample_rate, frame.pts = stream.rate, first
        for packet in stream.encode(frame):
            container.mux(packet)
    for packet in stream.encode():
        container.mux(packet)
