"""A camera of this computer as a client: the character mimics the person before it (`camera_mimicry`)."""

from __future__ import annotations

import asyncio
import sys
import threading
from collections.abc import Callable
from contextlib import closing
from typing import Any

from metagraph.formats.filmed.camera import CameraFeed
from metagraph.formats.filmed.estimator import PoseEstimator
from metagraph.live.hub import Hub
from metagraph.live.messages import Hello, Keypoints, encode


class CameraLine:
    """A client that asks as the person before a camera moves. A thread looks at one picture after another,
    always the newest. Raises what `CameraFeed` and `PoseEstimator` do; what goes wrong later is said by
    `tell`.
    """

    formats = ()

    def __init__(
        self,
        hub: Hub,
        clock: Callable[[], float],
        device: str,
        mirror: bool = True,
        tell: Callable[[str], None] = lambda words: print(f"note: {words}", file=sys.stderr, flush=True),
    ) -> None:
        self.hub, self._mirror, self._tell = hub, mirror, tell
        self.pictures = 0
        self._loop = asyncio.get_running_loop()
        self._estimator = PoseEstimator()
        try:
            self._camera = CameraFeed(device)
        except BaseException:
            self._estimator.close()
            raise
        self._number = hub.open(self, clock(), proven=True)
        hub.message(self._number, encode(Hello(name="camera")))
        self._thread = threading.Thread(target=self._work, daemon=True, name="person before the camera")
        self._thread.start()

    def _work(self) -> None:
        with closing(self._estimator), closing(self._camera):
            try:
                for picture in self._camera.read():
                    message = read_message(self._estimator.look(picture), self._mirror)
                    self._loop.call_soon_threadsafe(self._see, message)
            except RuntimeError as error:  # the camera or the estimator has failed, or the loop has ended
                if self._number:
                    self._tell(str(error))
            else:
                if self._number:
                    self._tell("the camera has ended")

    def _see(self, message: Keypoints | None) -> None:
        self.pictures += 1
        if message is not None and self._number:
            self.hub.message(self._number, encode(message))

    def send(self, messages: list[tuple[bytes, bool]]) -> None:
        """Replies are of no use to who only sends."""

    def answered(self, messages: int) -> None:
        """Nothing depends on it."""

    def backlog(self) -> int:
        """Nothing waits."""
        return 0

    def close(self, code: int, reason: str) -> None:
        """Let go of the camera."""
        self._number = 0
        self._camera.close()


def read_message(frame: dict[str, Any], mirror: bool) -> Keypoints | None:
    """Return what to ask for a frame of the estimator's; None if nobody was seen."""
    marks = frame.get("landmarks")  # where stances are seen better than in MediaPipe's space
    if not marks:
        return None
    return Keypoints(
        points=tuple((x, y) for x, y, *_ in marks),
        confidence=tuple(sure for *_, sure in marks),
        mirror=mirror,
    )
