"""Messages between the side that serves clients and the side that plans, once a tick, as values or as bytes
for a pipe.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import msgspec
from msgspec import Struct

from metagraph.live.messages import HeardMessage, encode

if TYPE_CHECKING:
    from metagraph.live.live_session import LiveSession


class RequestBatch(Struct, frozen=True, array_like=True):
    """Requests that came in since the last batch. number: counts up. joined, left: clients. asked: client and
    request, in order.
    """

    number: int = 0
    joined: tuple[int, ...] = ()
    left: tuple[int, ...] = ()
    asked: tuple[tuple[int, HeardMessage], ...] = ()


class PosePicture(Struct, frozen=True, array_like=True):
    """A pose for some clients."""

    clients: tuple[int, ...]
    data: bytes
    binary: bool


class BatchResult(Struct, frozen=True, array_like=True):
    """What batches are answered with. number: of the last one, 0 for none. replies: JSON, one to each request
    of all since the result before, in order. events: client and JSON.
    """

    number: int = 0
    replies: tuple[bytes, ...] = ()
    events: tuple[tuple[int, bytes], ...] = ()
    poses: tuple[PosePicture, ...] = ()


class Ready(Struct, frozen=True, omit_defaults=True):
    """Where a server listens, or why it does not. websocket: an address; osc: host and port; token: whether
    one is asked for.
    """

    websocket: str | None = None
    osc: tuple[str, int] | None = None
    token: bool = False
    error: str | None = None


def join_batches(batches: Sequence[RequestBatch]) -> RequestBatch:
    """Return batches that follow each other as one, which has the last one's number."""
    return RequestBatch(
        max((batch.number for batch in batches), default=0),
        tuple(client for batch in batches for client in batch.joined),
        tuple(client for batch in batches for client in batch.left),
        tuple(asked for batch in batches for asked in batch.asked),
    )


def exchange(session: LiveSession, now: float, batch: RequestBatch | None) -> BatchResult:
    """Let a session answer a batch at `now`. None: only report what happens without requests."""
    batch = RequestBatch() if batch is None else batch
    for client in batch.joined:
        session.join(client)
    out = session.tick(now, batch.asked)
    for client in batch.left:
        session.leave(client)
    return BatchResult(
        batch.number,
        tuple(reply if isinstance(reply, bytes) else encode(reply) for reply in out.replies),
        tuple((client, encode(event)) for client, event in out.events),
        tuple(PosePicture(frame.clients, frame.data, frame.binary) for frame in out.frames),
    )


pack = msgspec.msgpack.Encoder().encode
unpack_batch = msgspec.msgpack.Decoder(RequestBatch).decode
unpack_result = msgspec.msgpack.Decoder(BatchResult).decode
