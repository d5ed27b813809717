"""The face for Unreal: packets as Live Link Face sends them."""

from __future__ import annotations

import asyncio
import struct
from pathlib import Path

import pytest

import sample_clips
from metagraph.graph.model import Project
from metagraph.live.face_link import SHAPES, write_face_packet
from metagraph.live.live_session import LiveSession
from metagraph.live.server import Options, Server
from metagraph.live.wire import exchange

SAMPLE = Path(sample_clips.__file__).with_name("sample.metagraph.yaml")


@pytest.fixture(scope="module")
def whole_sample() -> Project:
    """The sample with its character's face, as `metagraph live` opens it."""
    from app.project.opening import open_whole

    return open_whole(SAMPLE).project


def read_packet(data: bytes) -> tuple[str, str, int, float, tuple[int, int], list[float]]:
    """Read a packet as the engine's plugin does."""
    assert data[0] == 6
    at, names = 1, []
    for _ in range(2):
        (size,) = struct.unpack_from(">i", data, at)
        names.append(data[at + 4 : at + 4 + size].decode())
        at += 4 + size
    frame, part, rate, per, count = struct.unpack_from(">ifiiB", data, at)
    values = struct.unpack_from(f">{count}f", data, at + 17)
    assert len(data) == at + 17 + 4 * count
    return names[0], names[1], frame, part, (rate, per), list(values)


def test_a_packet_has_the_shapes_at_the_engines_places() -> None:
    weights = {"jawOpen": 0.5, "eyeBlinkLeft": 1.0, "tongueOut": 0.25, "jawLeft": 2.0, "nothing": 1.0}
    _, subject, frame, part, rate, values = read_packet(write_face_packet(weights, 2.51))
    assert subject == "Metagraph" and rate == (60, 1) and (frame, part) == (150, pytest.approx(0.6, abs=1e-4))
    assert len(values) == 61 and len(set(SHAPES)) == 52
    assert {n: value for n, value in enumerate(values) if value} == {0: 1.0, 15: 1.0, 17: 0.5, 51: 0.25}


def test_the_mouth_opens_in_unreal_while_something_is_said(whole_sample: Project) -> None:
    got: list[bytes] = []

    class Ears(asyncio.DatagramProtocol):
        def datagram_received(self, data: bytes, address: object) -> None:
            got.append(data)

    async def play() -> None:
        loop = asyncio.get_running_loop()
        transport, _ = await loop.create_datagram_endpoint(Ears, ("127.0.0.1", 0))
        port = transport.get_extra_info("sockname")[1]
        server = Server(Options(port=None, osc=None, face=("127.0.0.1", port)), loop.time)
        await server.open()
        session, now = LiveSession(whole_sample), 0.0
        session.receive(9, '{"do": "say", "text": "Over and over again"}')
        for _ in range(60):
            server.hub.give(exchange(session, now, server.hub.take()))
            now += 1 / 60
            await asyncio.sleep(0)
        await asyncio.sleep(0.05)
        await server.close()
        transport.close()

    asyncio.run(play())
    jaw = [read_packet(data)[5][17] for data in got]
    assert len(jaw) > 20 and max(jaw) > 0.1
