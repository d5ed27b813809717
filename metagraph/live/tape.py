"""What was asked in a session, kept small, so that it can be performed again."""

from __future__ import annotations

from collections.abc import Sequence

import msgspec

from metagraph.graph import requests as a

MOST = 32 * 1024 * 1024  # bytes

_read = msgspec.msgpack.Decoder(list[a.AnyRequest])


class Tape:
    """Asks in the order in which they became known (`told`). whole: whether it holds all there were."""

    def __init__(self, most: int = MOST) -> None:
        self.most, self.whole = most, True
        self._data = bytearray()

    def __len__(self) -> int:
        return len(self._data)

    def keep(self, asks: Sequence[a.AnyRequest]) -> None:
        """Add asks; from where it would grow too long on, it keeps nothing more."""
        data = msgspec.msgpack.encode(asks)
        self.whole = self.whole and len(self._data) + len(data) < self.most
        if asks and self.whole:
            self._data += len(data).to_bytes(4, "little") + data

    def asks(self) -> tuple[a.AnyRequest, ...]:
        """Return all of it. Raises RequestError when there was more than it could hold."""
        if not self.whole:
            raise a.RequestError(
                f"more was asked than is kept of a session, {self.most / 1024 / 1024:g} MiB; it cannot be "
                "replayed"
            )
        out: list[a.AnyRequest] = []
        place = 0
        while place < len(self._data):
            begin = place + 4
            place = begin + int.from_bytes(self._data[place:begin], "little")
            out += _read.decode(bytes(self._data[begin:place]))
        return tuple(out)
