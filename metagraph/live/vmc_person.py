"""VMC in: a person who is tracked by another program, whom the character mimics.

Programs that track people send the bones of Unity's humanoid and expressions as OSC messages
(protocol.vmc.info, performer to marionette). The bones become keypoints, as those of a camera
(`camera_mimicry`), the expressions what the partner feels.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.graph.words import Feeling
from metagraph.live.hub import Hub
from metagraph.live.messages import Hello, Keypoints, Partner, encode
from metagraph.live.osc_bytes import OscError, read_osc_messages
from metagraph.motion import rotation

Array = NDArray[Any]

RATE = 30.0  # frames a second that are looked at, at most
LARGEST = 64 * 1024  # bytes of a datagram that is read
BONES = 100  # different bones that are remembered
EXPRESSES = 0.5  # from which on an expression is a mood
# Bone -> the bone it hangs on; where that one is not sent, on the next above it.
ABOVE = {
    "Spine": "Hips", "Chest": "Spine", "UpperChest": "Chest", "Neck": "UpperChest", "Head": "Neck",
    "LeftEye": "Head", "RightEye": "Head",
} | {
    f"{side}{bone}": above.format(side=side)
    for side in ("Left", "Right")
    for bone, above in (
        ("Shoulder", "UpperChest"), ("UpperArm", "{side}Shoulder"), ("LowerArm", "{side}UpperArm"),
        ("Hand", "{side}LowerArm"), ("UpperLeg", "Hips"), ("LowerLeg", "{side}UpperLeg"),
        ("Foot", "{side}LowerLeg"),
    )
}  # fmt: skip
# Where COCO's points of the face are, in metres from the head's joint: Unity's space, left at -x.
FACE = ((0.0, 0.06, 0.12), (-0.03, 0.09, 0.09), (0.03, 0.09, 0.09), (-0.075, 0.07, 0.0), (0.075, 0.07, 0.0))
# Bones at COCO's other points, in their order.
POINTS = tuple(
    f"{side}{bone}"
    for bone in ("UpperArm", "LowerArm", "Hand", "UpperLeg", "LowerLeg", "Foot")
    for side in ("Left", "Right")
)
# Expressions of VRM 0.x and 1.0, in small letters, and the moods they show.
MOODS: dict[str, Feeling] = {
    "joy": "happy", "happy": "happy", "fun": "warm", "relaxed": "calm", "sorrow": "sad", "sad": "sad",
    "angry": "angry", "surprised": "excited",
}  # fmt: skip


class VmcPerson:
    """What is known of a tracked person: bones, each with its place `[3]`, metres, and turn `[4]`, xyzw,
    below the bone it hangs on, in Unity's space (left-handed, y up, the person looks along +z); expressions,
    0..1.
    """

    def __init__(self) -> None:
        self.bones: dict[str, tuple[Array, Array]] = {}
        self.expressions: dict[str, float] = {}
        self.tracked = True

    def hear(self, address: str, values: Sequence[Any]) -> None:
        """Take in one message; what is not of these addresses, or malformed, is passed over."""
        match address, *values:
            case ["/VMC/Ext/OK", int(loaded), *more]:
                # loaded; then, in newer versions, state and mode of the calibration, and whether it tracks
                self.tracked = loaded != 0 and (len(more) < 3 or more[2] != 0)
            case ["/VMC/Ext/Bone/Pos" | "/VMC/Ext/Root/Pos", str(name), *numbers] if _are_numbers(numbers):
                bone = name if address == "/VMC/Ext/Bone/Pos" else "root"
                turn = np.array(numbers[3:7], float)
                length = float(np.linalg.norm(turn))
                if length > 1e-6 and (bone in self.bones or len(self.bones) < BONES):
                    self.bones[bone] = np.array(numbers[:3], float), turn / length
            case ["/VMC/Ext/Blend/Val", str(name), int() | float() as value] if np.isfinite(value):
                if name in self.expressions or len(self.expressions) < 4 * BONES:
                    self.expressions[name] = float(value)
            case _:
                pass

    def find_place(self, bone: str) -> tuple[Array, Array] | None:
        """Return where a bone is, `[3]`, and how it is turned, `[4]`, in Unity's space; None if it was not
        sent.
        """
        if bone not in self.bones:
            return None
        above = ABOVE.get(bone)
        while above is not None and above not in self.bones:
            above = ABOVE.get(above)
        root = self.bones.get("root") if bone != "root" else None
        parent = root if above is None else self.find_place(above)
        place, turn = self.bones[bone]
        if parent is None:
            return place, turn
        return parent[0] + rotation.rotate_vectors(parent[1], place), rotation.multiply(parent[1], turn)

    def list_keypoints(self) -> tuple[tuple[float, ...], ...] | None:
        """Return COCO's 17 points as a camera before the person sees them, metres: x to the right, where the
        person's left is, y downwards, z away from the camera. None while bones are missing.
        """
        found = [self.find_place(bone) for bone in ("Head", *POINTS)]
        if not self.tracked or any(one is None for one in found):
            return None
        (head, turn), *others = [one for one in found if one is not None]
        places = [head + rotation.rotate_vectors(turn, np.array(at)) for at in FACE]
        places += [place for place, _ in others]
        return tuple((-float(x), -float(y), -float(z)) for x, y, z in places)

    def find_mood(self) -> Feeling | None:
        """Return the mood of the strongest expression, None if none is strong."""
        shown = {
            MOODS[name.lower()]: value for name, value in self.expressions.items() if name.lower() in MOODS
        }
        mood = max(shown, key=lambda name: shown[name], default=None)
        return mood if mood is not None and shown[mood] >= EXPRESSES else None


def _are_numbers(values: Sequence[Any]) -> bool:
    return len(values) >= 7 and all(isinstance(x, int | float) and np.isfinite(x) for x in values[:7])


class VmcPersonLine(asyncio.DatagramProtocol):
    """Listens for VMC; a client that asks as the tracked person moves."""

    formats = ()

    def __init__(self, hub: Hub, clock: Callable[[], float]) -> None:
        self.hub, self.clock, self.person = hub, clock, VmcPerson()
        self.transport: Any = None
        self._number, self._seen = 0, 0.0
        self._mood: Feeling | None = None

    def connection_made(self, transport: Any) -> None:
        self.transport = transport
        self._number = self.hub.open(self, self.clock(), proven=True)
        if self._number:
            self.hub.message(self._number, encode(Hello(name="VMC person")))

    def datagram_received(self, data: bytes, address: Any) -> None:
        """Take a datagram in; ask for what follows from it, `RATE` times a second at most."""
        try:
            for path, values in read_osc_messages(data[:LARGEST]):
                self.person.hear(path, values)
        except OscError:
            return
        now = self.clock()
        if not self._number or now < self._seen + 1 / RATE:
            return
        points = self.person.list_keypoints()
        if points is not None:
            self._seen = now
            self.hub.message(self._number, encode(Keypoints(points=points)))
        mood = self.person.find_mood()
        if mood != self._mood:
            self._mood = mood
            self.hub.message(self._number, encode(Partner(mood=mood)))

    def error_received(self, error: Exception) -> None:
        """Nothing is sent that could fail."""

    def send(self, messages: list[tuple[bytes, bool]]) -> None:
        """Replies are of no use to who only sends."""

    def answered(self, messages: int) -> None:
        """Nothing depends on it."""

    def backlog(self) -> int:
        """Nothing waits."""
        return 0

    def close(self, code: int, reason: str) -> None:
        """Stop listening."""
        self._number = 0
        if self.transport is not None:
            self.transport.close()
