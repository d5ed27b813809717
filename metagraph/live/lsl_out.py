"""LSL out: what happens, the character's pose and its face as streams of the Lab Streaming Layer.

Samples have the time, by LSL's own clock, at which they hold: a pose that of the moment it belongs to, an
event that at which it happened, not at which it was sent. The channels of poses are described as XDF's page
on metadata of motion capture says (github.com/sccn/xdf/wiki/MoCap-Meta-Data): orientations are quaternions
whose A is the scalar, and B, C, D the axes x, y, z.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import msgspec
import numpy as np

from metagraph import __version__
from metagraph.common.lab_streaming import OutletPlan, StreamChannel, open_outlet
from metagraph.graph.model import Project
from metagraph.live.hub import Hub
from metagraph.live.messages import FASTEST, Hello, Poses, encode
from metagraph.live.pose_stream import HEADER, Stream

RATE = 60.0  # poses a second: one each tick of the session
NAME = "Metagraph"
WISH = Poses(rate=FASTEST, format="binary", space="model", translations=True)  # FASTEST: at each tick
PLACES = ("X", "Y", "Z")
TURNS = ("A", "B", "C", "D")
MAKER = (("acquisition", "manufacturer"), "Metagraph"), (("acquisition", "model"), __version__)
SPACE = "metres, right-handed, y up, the character's own space"


def plan_outlets(project: Project) -> dict[str, OutletPlan]:
    """Return the streams of a character, by what they carry: "events", and where it has them "pose" and
    "face".
    """

    def source(what: str) -> str:
        return f"metagraph-live-{project.name}-{what}"

    more: tuple[tuple[tuple[str, ...], str], ...] = MAKER
    out = {
        "events": OutletPlan(
            f"{NAME} events",
            "Markers",
            source("events"),
            (StreamChannel("event", "Marker", "json"),),
            more=more,
        )
    }
    if project.skeleton is None:
        return out
    stream = Stream.of(WISH, project, 0.0)
    joints = [
        StreamChannel(f"{joint} {axis}", kind + axis, unit, joint)
        for joint in stream.names
        for kind, unit, axes in (("Position", "meters", PLACES), ("Orientation", "quaternion", TURNS))
        for axis in axes
    ]
    space = (*more, (("setup", "name"), SPACE))
    out["pose"] = OutletPlan(f"{NAME} pose", "MoCap", source("pose"), joints, RATE, "float32", space)
    if stream.morphs:
        shapes = [StreamChannel(name, "Weight", "normalized") for name in stream.morphs]
        out["face"] = OutletPlan(f"{NAME} face", "Face", source("face"), shapes, RATE, "float32", more)
    return out


class LslOutLine:
    """Sends poses and events to LSL: a client that listens and asks for nothing.

    lsl: the module pylsl. clock: of the session's server, seconds. begin: returns the clock's time at which
    the session began. Raises LabStreamError if a stream cannot be opened.
    """

    formats = ("binary",)

    def __init__(
        self, lsl: Any, project: Project, clock: Callable[[], float], begin: Callable[[], float]
    ) -> None:
        self.clock, self.begin, self._lsl = clock, begin, lsl
        self.outlets = {what: open_outlet(lsl, plan) for what, plan in plan_outlets(project).items()}

    def join(self, hub: Hub) -> None:
        """Become a client of a session."""
        number = hub.open(self, self.clock(), proven=True)
        if number:
            poses = WISH if "pose" in self.outlets else msgspec.UNSET
            hub.message(number, encode(Hello(name="LSL", events="all", poses=poses)))

    def list_own(self) -> set[str]:
        """Return LSL's ids of the streams, which differ each time."""
        return {str(outlet.get_info().uid()) for outlet in self.outlets.values()}

    def find_time(self, seconds: float) -> float:
        """Return what LSL's clock shows at a second of the session."""
        return float(self._lsl.local_clock()) + seconds - (self.clock() - self.begin())

    def send(self, messages: list[tuple[bytes, bool]]) -> None:
        """Send poses and events. LSL's own threads pass them on, so this never waits."""
        for data, binary in messages:
            if binary:
                self._send_pose(data)
            elif data.startswith(b'{"event"'):
                self._send_event(data)

    def _send_pose(self, data: bytes) -> None:
        _, _, joints, morphs, _, seconds = HEADER.unpack_from(data)
        numbers = np.frombuffer(data, "<f4", offset=HEADER.size)[
            3:
        ]  # without the root, which is a joint, too
        turns = numbers[: 4 * joints].reshape(joints, 4)
        places = numbers[4 * joints : 7 * joints].reshape(joints, 3)
        stamp = self.find_time(seconds)
        if "pose" in self.outlets:
            sample = np.concatenate([places, turns[:, [3, 0, 1, 2]]], axis=1).reshape(1, -1)
            self.outlets["pose"].push_chunk(sample.astype(np.float32), stamp)
        if "face" in self.outlets and morphs:
            weights = numbers[7 * joints :].reshape(1, -1)
            self.outlets["face"].push_chunk(np.ascontiguousarray(weights, np.float32), stamp)

    def _send_event(self, data: bytes) -> None:
        if "events" in self.outlets:
            self.outlets["events"].push_sample([data.decode()], self.find_time(find_moment(data)))

    def answered(self, messages: int) -> None:
        """Nothing depends on it."""

    def backlog(self) -> int:
        """LSL keeps what waits, and drops the oldest."""
        return 0

    def close(self, code: int, reason: str) -> None:
        """Close the streams."""
        self.outlets.clear()


def find_moment(event: bytes) -> float:
    """Return the second of the session at which an event happened: `at` of what began, `until` of what ended;
    else when it was reported.
    """
    told = msgspec.json.decode(event)
    now = float(told["t"])
    happened = told.get({"started": "at", "ended": "until"}.get(told["event"], "t"))
    return now if happened is None else min(now, float(happened))
