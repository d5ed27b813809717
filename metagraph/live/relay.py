"""A session's lines in a process of their own, for a window that must not wait: reading, checking, writing
happen there. What came in by a tick is left for the window's thread.
"""

from __future__ import annotations

import contextlib
import queue
import threading
from typing import TYPE_CHECKING

import msgspec

from metagraph.common.child_channel import Child, ChildChannel
from metagraph.live.server import Options, check_live_options
from metagraph.live.wire import Ready, RequestBatch, pack, unpack_batch

if TYPE_CHECKING:
    from metagraph.live.live_session import LiveSession

STOP = 2.0  # seconds for the child to end by itself

_ready = msgspec.msgpack.Decoder(Ready)


class Relay:
    """The window's end; nothing here waits. Raises LiveError for options that are not safe; what goes wrong
    later is in `error`.
    """

    def __init__(self, options: Options) -> None:
        self.options = check_live_options(options)
        self.ready: Ready | None = None
        self.error = ""
        self._in: queue.SimpleQueue[bytes | None] = queue.SimpleQueue()
        self._out: queue.SimpleQueue[bytes | None] = queue.SimpleQueue()
        self._child: Child | None = None

    def start(self) -> None:
        """Start the child; `ready` is set by a later `tick`."""
        child = self._child = Child("metagraph.live.relay_child")
        self._out.put(pack(self.options))
        threading.Thread(target=receive, args=(child, self._in), daemon=True).start()
        threading.Thread(target=send, args=(child, self._out), daemon=True).start()

    def tick(self, session: LiveSession, now: float) -> None:
        """Answer what came in and send what happened; at most as long as the session's tick takes."""
        from metagraph.live.wire import exchange, join_batches

        batches: list[RequestBatch] = []
        while True:
            try:
                data = self._in.get_nowait()
            except queue.Empty:
                break
            if data is None:
                self.error = self.error or "the process that serves clients has ended"
                break
            if self.ready is None:
                self.ready = _ready.decode(data)
                self.error = self.ready.error or ""
                continue
            batches.append(unpack_batch(data))
        result = exchange(session, now, join_batches(batches))
        if result.number or result.events or result.poses:
            self._out.put(pack(result))

    def close(self, wait: bool = False) -> None:
        """Hang up on all clients and end the child, which takes a moment; wait: until it has ended."""
        self._out.put(None)
        child, self._child = self._child, None
        if child is None:
            return
        ending = threading.Thread(target=child.end, args=(STOP,), daemon=True)
        ending.start()
        if wait:
            ending.join()


def receive(channel: ChildChannel, target: queue.SimpleQueue[bytes | None]) -> None:
    """Put what comes in into a queue, and None when nothing more will."""
    with contextlib.suppress(EOFError):
        while data := channel.receive():
            target.put(data)
    target.put(None)


def send(channel: ChildChannel, source: queue.SimpleQueue[bytes | None]) -> None:
    """Send what a queue is given, until that is None."""
    with contextlib.suppress(OSError):
        while (data := source.get()) is not None:
            channel.send(data)
    with contextlib.suppress(OSError):
        channel.send(b"")  # the end
