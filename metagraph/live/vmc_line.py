"""The line to a program that receives VMC: a client that listens and asks for nothing."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import Any

from metagraph.live.hub import BACKLOG, Hub
from metagraph.live.messages import Hello, Poses, encode
from metagraph.live.vmc import split_bundles

RATE = 60.0  # poses a second


class VmcLine(asyncio.DatagramProtocol):
    """Sends every pose to one address."""

    formats = ("vmc",)

    def __init__(self, hub: Hub, clock: Callable[[], float]) -> None:
        self.hub, self.clock = hub, clock
        self.transport: Any = None  # asyncio.DatagramTransport, whose types lack how much waits

    def connection_made(self, transport: Any) -> None:
        self.transport = transport
        number = self.hub.open(self, self.clock(), proven=True)
        if number:
            self.hub.message(number, encode(Hello(name="VMC", poses=Poses(rate=RATE, format="vmc"))))

    def send(self, messages: list[tuple[bytes, bool]]) -> None:
        """Send poses as bundles. Replies are of no use to who only listens."""
        for data, binary in messages:
            if binary and self.transport is not None and self.transport.get_write_buffer_size() <= BACKLOG:
                for bundle in split_bundles(data):
                    self.transport.sendto(bundle)

    def error_received(self, error: Exception) -> None:
        """Nobody listens where the poses go yet; they may later."""

    def answered(self, messages: int) -> None:
        """Nothing depends on it."""

    def backlog(self) -> int:
        """Datagrams do not wait."""
        return 0

    def close(self, code: int, reason: str) -> None:
        """Stop sending."""
        if self.transport is not None:
            self.transport.close()
