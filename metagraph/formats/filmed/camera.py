"""Read the pictures of a camera as they come, through PyAV: V4L2 on Linux, AVFoundation on macOS, DirectShow
on Windows. A video file in the place of a device is played in real time, to try all this without a camera.
"""

from __future__ import annotations

import sys
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from metagraph.common.files import is_file
from metagraph.formats.filmed.video import FilmedPicture, VideoFile, to_upright_picture

PATIENCE = 5.0  # seconds without a picture after which a camera counts as gone
SIZE = "640x480"  # that every camera has; an estimator looks at less


class CameraError(RuntimeError):
    """A camera cannot be read; the message says why and what to do."""


class CameraFeed:
    """A camera that is read on a thread, which keeps only the newest picture: whoever is slower than the
    camera misses some and is never late. Raises CameraError, and FileError for a file that is no video.

    device: a number from 0, the system's name for a camera (/dev/video0 on Linux; on Windows the name that
    the system shows), or a video file. Close it.
    """

    def __init__(self, device: str, clock: Callable[[], float] = time.monotonic) -> None:
        self.device, self._clock = device, clock
        self._video = VideoFile(Path(device)) if is_file(device) else None
        self._container = None if self._video is not None else _open_device(device)
        self._new = threading.Condition()
        self._picture: FilmedPicture | None = None
        self._ended, self._why = False, ""
        self._thread = threading.Thread(target=self._work, daemon=True, name="camera")
        self._thread.start()

    def read(self) -> Iterator[FilmedPicture]:
        """Yield the newest picture that was not yielded before, with seconds since the first one, until the
        camera is closed or its file ends. Raises CameraError if the camera fails.
        """
        begin: float | None = None
        while True:
            with self._new:
                if not self._new.wait_for(lambda: self._picture is not None or self._ended, PATIENCE):
                    raise CameraError(
                        f"The camera {self.device} sends no pictures. Close other programs that use it, and "
                        "check that it is switched on."
                    )
                picture, self._picture = self._picture, None
            if picture is None:
                if self._why:
                    raise CameraError(f"The camera {self.device} has stopped: {self._why}.")
                return
            begin = picture.seconds if begin is None else begin
            yield FilmedPicture(picture.seconds - begin, picture.picture)

    def close(self) -> None:
        """Let go of the camera."""
        with self._new:
            self._ended = True
            self._new.notify_all()
        self._thread.join(PATIENCE)
        if self._video is not None:
            self._video.close()

    def _work(self) -> None:
        try:
            for picture in self._played() if self._video is not None else self._filmed():
                with self._new:
                    if self._ended:
                        return
                    self._picture = picture
                    self._new.notify_all()
        except Exception as error:  # on a thread of its own, whatever it is goes to the reader
            self._why = str(error) or type(error).__name__
        finally:
            if self._container is not None:
                self._container.close()
            with self._new:
                self._ended = True
                self._new.notify_all()

    def _filmed(self) -> Iterator[FilmedPicture]:
        assert self._container is not None
        for frame in self._container.decode(video=0):
            yield FilmedPicture(self._clock(), to_upright_picture(frame))

    def _played(self) -> Iterator[FilmedPicture]:
        assert self._video is not None
        begin: float | None = None
        for picture in self._video.read():
            begin = self._clock() - picture.seconds if begin is None else begin
            wait = begin + picture.seconds - self._clock()
            with self._new:
                if wait > 0 and self._new.wait_for(lambda: self._ended, wait):
                    return
            yield FilmedPicture(begin + picture.seconds, picture.picture)


def _open_device(device: str) -> Any:
    """Return PyAV's container of a camera. Raises CameraError."""
    import av

    place, kind, options = name_device(device, sys.platform)
    try:
        return av.open(place, format=kind, options=options, timeout=PATIENCE)
    except (OSError, ValueError) as error:
        words = (error.strerror or str(error)) if isinstance(error, OSError) else str(error)
        raise CameraError(
            f"The camera {device} cannot be opened: {words}. Check that it is plugged in, that you may use "
            "it, and that no other program does."
        ) from None


def name_device(device: str, platform: str) -> tuple[str, str, dict[str, str]]:
    """Return the place, FFmpeg's format and its options for a camera on a platform of `sys.platform`."""
    if platform == "darwin":
        return device, "avfoundation", {"framerate": "30", "video_size": SIZE}
    if platform == "win32":
        return f"video={device}", "dshow", {"video_size": SIZE}
    return f"/dev/video{device}" if device.isdecimal() else device, "v4l2", {"video_size": SIZE}
