"""What was asked in a session, kept small, so that it can be performed again."""

from __future__ import annotations

import math
from collections.abc import Sequence

import msgspec

from metagraph.graph import requests as a

MOST = 32 * 1024 * 1024  # bytes

_read = msgspec.msgpack.Decoder(list[a.AnyRequest])


class Tape:
    """Asks in the order in which they became known (`told`). most: bytes it holds. until: seconds from which
    on it holds nothing more, inf while it holds all there were.
    """

    def __init__(self, most: int = MOST) -> None:
        self.most, self.until = most, math.inf
        self._data = bytearray()

    def __len__(self) -> int:
        return len(self._data)

    def keep(self, asks: Sequence[a.AnyRequest], now: float) -> None:
        """Add the asks of one moment; from the one on at which it would grow too long, it keeps nothing."""
        data = msgspec.msgpack.encode(asks)
        if asks and len(self._data) + len(data) >= self.most:
            self.until = min(self.until, now)
        elif asks and self.until == math.inf:
            self._data += len(data).to_bytes(4, "little") + data

    def asks(self) -> tuple[a.AnyRequest, ...]:
        """Return all of it."""
        out: list[a.AnyRequest] = []
        place = 0
        while place < len(self._data):
            begin = place + 4
            place = begin + int.from_bytes(self._data[place:begin], "little")
            out += _read.decode(bytes(self._data[begin:place]))
        return tuple(out)
