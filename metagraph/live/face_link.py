"""The face for Unreal: ARKit's blend shapes as the app Live Link Face sends them over UDP.

The layout is that of Unreal Engine's plugin AppleARKitFaceSupport (packets of version 6; numbers are
big-endian): a byte for the version; the device's id and the subject's name, each after its length in an
int32; the frame's number (int32), its part (float32), the rate's numerator and denominator (int32 each); the
count of values (byte); and so many float32, in the order of the engine's `EARFaceBlendShape`: 52 shapes, then
yaw, pitch and roll of the head, the left and the right eye.
"""

from __future__ import annotations

import asyncio
import struct
from collections.abc import Callable, Mapping
from typing import Any

import msgspec

from metagraph.live.hub import BACKLOG, Hub
from metagraph.live.messages import Hello, Poses, encode

VERSION = 6
RATE = 60  # frames a second
DEVICE, SUBJECT = "Metagraph", "Metagraph"  # the subject's name in Unreal's Live Link window
SHAPES = (
    *(f"eye{what}Left" for what in ("Blink", "LookDown", "LookIn", "LookOut", "LookUp", "Squint", "Wide")),
    *(f"eye{what}Right" for what in ("Blink", "LookDown", "LookIn", "LookOut", "LookUp", "Squint", "Wide")),
    "jawForward", "jawLeft", "jawRight", "jawOpen", "mouthClose", "mouthFunnel", "mouthPucker", "mouthLeft",
    "mouthRight", "mouthSmileLeft", "mouthSmileRight", "mouthFrownLeft", "mouthFrownRight", "mouthDimpleLeft",
    "mouthDimpleRight", "mouthStretchLeft", "mouthStretchRight", "mouthRollLower", "mouthRollUpper",
    "mouthShrugLower", "mouthShrugUpper", "mouthPressLeft", "mouthPressRight", "mouthLowerDownLeft",
    "mouthLowerDownRight", "mouthUpperUpLeft", "mouthUpperUpRight", "browDownLeft", "browDownRight",
    "browInnerUp", "browOuterUpLeft", "browOuterUpRight", "cheekPuff", "cheekSquintLeft", "cheekSquintRight",
    "noseSneerLeft", "noseSneerRight", "tongueOut",
)  # fmt: skip
TURNS = 9  # yaw, pitch and roll of head and eyes, which the character's joints show: sent as 0


def write_face_packet(weights: Mapping[str, float], seconds: float) -> bytes:
    """Return the packet of one moment. weights: of morph targets called as ARKit's shapes, 0..1; what is not
    there is 0. seconds: of the session.
    """
    frame, part = divmod(max(seconds, 0.0) * RATE, 1.0)
    values = [min(max(float(weights.get(name, 0.0)), 0.0), 1.0) for name in SHAPES] + [0.0] * TURNS
    names = b"".join(struct.pack(">i", len(x)) + x for x in (DEVICE.encode(), SUBJECT.encode()))
    time = struct.pack(">ifii", int(frame) & 0x7FFFFFFF, part, RATE, 1)
    return struct.pack("B", VERSION) + names + time + struct.pack(f">B{len(values)}f", len(values), *values)


class FaceLinkLine(asyncio.DatagramProtocol):
    """Sends the face to one address: a client that listens and asks for nothing."""

    formats = ("json",)

    def __init__(self, hub: Hub, clock: Callable[[], float]) -> None:
        self.hub, self.clock = hub, clock
        self.transport: Any = None

    def connection_made(self, transport: Any) -> None:
        self.transport = transport
        number = self.hub.open(self, self.clock(), proven=True)
        if number:
            poses = Poses(rate=float(RATE), format="json", joints=())
            self.hub.message(number, encode(Hello(name="Live Link Face", poses=poses)))

    def send(self, messages: list[tuple[bytes, bool]]) -> None:
        """Send the weights of poses. Replies are of no use to who only listens."""
        for data, binary in messages:
            told = {} if binary else msgspec.json.decode(data)
            if "weights" in told and self.transport.get_write_buffer_size() <= BACKLOG:
                self.transport.sendto(write_face_packet(told["weights"], told["t"]))

    def error_received(self, error: Exception) -> None:
        """Nobody listens where the face goes yet; they may later."""

    def answered(self, messages: int) -> None:
        """Nothing depends on it."""

    def backlog(self) -> int:
        """Datagrams do not wait."""
        return 0

    def close(self, code: int, reason: str) -> None:
        """Stop sending."""
        if self.transport is not None:
            self.transport.close()
