"""The process that looks for a person in pictures, with MediaPipe's pose models. It imports MediaPipe from
the folder of the extra, which the program itself never does.

Its parent (`metagraph.formats.filmed.estimator`) sends pictures through a `ChildChannel`: HEAD (seconds,
height, width) and the bytes of red, green and blue. Each answer is a JSON object, the first one before any
picture: {"estimator": "MediaPipe 0.10.21"} or {"error": "..."}. Those of pictures have `time` in seconds and,
if somebody is seen, `landmarks` (pixels) and `worldLandmarks` (metres from the hips) of 33 points [x, y, z,
visibility], in MediaPipe's order and axes. Nothing is loaded from the network: only the models in the package
are used.
"""

from __future__ import annotations

import json
import os
import signal
import struct
import sys
import types
from contextlib import suppress
from pathlib import Path
from typing import Any

from metagraph.common.child_channel import ChildChannel, connect_to_parent

HEAD = struct.Struct("<dII")  # seconds, height, width
FULL = 1  # the model in the package; 0 and 2 would be loaded from the network
# Packages whose __init__ imports every other solution, and OpenCV, JAX and Matplotlib with them.
_BARE = ("mediapipe", "mediapipe.python.solutions")


def main() -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the parent decides when it is over
    channel = connect_to_parent()
    os.dup2(os.open(os.devnull, os.O_WRONLY), 2)  # what the libraries say of themselves is no news
    with suppress(EOFError, OSError):  # the parent has no more pictures, or is gone
        _serve(channel, Path(sys.argv[1]))


def _serve(channel: ChildChannel, folder: Path) -> None:
    try:
        pose, name = _load(folder)
    except Exception as error:  # a library that a system lacks, a processor without AVX, ...
        channel.send(_encode({"error": str(error) or type(error).__name__}))
        return
    channel.send(_encode({"estimator": name}))
    while True:
        content = channel.receive()
        try:
            answer = _look(pose, content)
        except Exception as error:
            answer = {"error": str(error) or type(error).__name__}
        channel.send(_encode(answer))


def _load(folder: Path) -> tuple[Any, str]:
    """Return MediaPipe's `Pose` and its name with the version. Raises what its import does."""
    sys.path.insert(0, str(folder))
    for name in _BARE:
        bare = types.ModuleType(name)
        bare.__path__ = [str(folder.joinpath(*name.split(".")))]
        sys.modules[name] = bare
    from importlib.metadata import version

    from mediapipe.python.solutions import pose as solution

    made = solution.Pose(static_image_mode=False, model_complexity=FULL)
    return made, f"MediaPipe {version('mediapipe')}"


def _look(pose: Any, content: bytes) -> dict[str, Any]:
    import numpy as np

    seconds, height, width = HEAD.unpack_from(content)
    picture = np.frombuffer(content, np.uint8, offset=HEAD.size).reshape(height, width, 3)
    # It counts 30 frames a second by itself; its filters get the picture's own time instead.
    step = round(seconds * 1e6) - pose._simulated_timestamp
    pose._simulated_timestamp += max(step, 1) - 33333
    found = pose.process(picture)
    answer: dict[str, Any] = {"time": seconds}
    if found.pose_landmarks is not None and found.pose_world_landmarks is not None:
        answer["landmarks"] = _list_points(found.pose_landmarks, width, height, 1)
        answer["worldLandmarks"] = _list_points(found.pose_world_landmarks, 1, 1, 4)
    return answer


def _list_points(marks: Any, width: int, height: int, digits: int) -> list[list[float]]:
    return [
        [
            round(float(mark.x) * width, digits),
            round(float(mark.y) * height, digits),
            round(float(mark.z) * width, digits),
            round(min(1.0, max(0.0, float(mark.visibility))), 3),
        ]
        for mark in marks.landmark
    ]


def _encode(answer: dict[str, Any]) -> bytes:
    return json.dumps(answer, separators=(",", ":")).encode()


if __name__ == "__main__":
    main()
    sys.stdout.flush()
    os._exit(0)  # the graph's threads are not waited for
