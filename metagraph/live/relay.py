"""A session's lines in a process of their own, for a window that must not wait: reading, checking, writing
happen there, and what is left for the window's thread is one batch a tick.
"""

from __future__ import annotations

import asyncio
import contextlib
import multiprocessing
import queue
import signal
import threading
import time
from typing import TYPE_CHECKING, Any

import msgspec

from metagraph.live.server import LiveError, Options, Server, checked
from metagraph.live.wire import Batch, Ready, Result, pack, unpack_batch, unpack_result

if TYPE_CHECKING:
    from metagraph.live.live_session import LiveSession

STOP = 2.0  # seconds for the child to end by itself

_ready = msgspec.msgpack.Decoder(Ready)


class Relay:
    """The window's end; nothing here waits. Raises LiveError for options that are not safe; what goes wrong
    later is in `error`.
    """

    def __init__(self, options: Options) -> None:
        self.options = checked(options)
        self.ready: Ready | None = None
        self.error = ""
        self._in: queue.SimpleQueue[bytes | None] = queue.SimpleQueue()
        self._out: queue.SimpleQueue[bytes | None] = queue.SimpleQueue()
        self._process: Any = None

    def start(self) -> None:
        """Start the child; `ready` is set by a later `tick`."""
        context = multiprocessing.get_context("spawn")
        ours, theirs = context.Pipe()
        self._process = context.Process(
            target=serve, args=(theirs, pack(self.options)), name="metagraph live", daemon=True
        )
        self._process.start()
        theirs.close()
        threading.Thread(target=_receive, args=(ours, self._in), daemon=True).start()
        threading.Thread(target=_send, args=(ours, self._out), daemon=True).start()

    def tick(self, session: LiveSession, now: float) -> None:
        """Answer what came in and send what happened; at most as long as the session's tick takes."""
        from metagraph.live.wire import exchange

        batch = Batch()
        while batch.number == 0:
            try:
                data = self._in.get_nowait()
            except queue.Empty:
                break
            if data is None:
                self.error = self.error or "the process that talks to clients has ended"
                break
            if self.ready is None:
                self.ready = _ready.decode(data)
                self.error = self.ready.error or ""
                continue
            batch = unpack_batch(data)
        result = exchange(session, now, batch)
        if result.number or result.events or result.poses:
            self._out.put(pack(result))

    def close(self, wait: bool = False) -> None:
        """Hang up on all clients and end the child, which takes a moment; wait: until it has ended."""
        self._out.put(None)
        process, self._process = self._process, None
        if process is None:
            return
        ending = threading.Thread(target=_end, args=(process,), daemon=True)
        ending.start()
        if wait:
            ending.join()


def _end(process: Any) -> None:
    process.join(STOP)
    if process.is_alive():
        process.terminate()
        process.join(STOP)
    process.close()


def _receive(pipe: Any, target: queue.SimpleQueue[bytes | None]) -> None:
    with contextlib.suppress(EOFError, OSError):
        while data := pipe.recv_bytes():
            target.put(data)
    target.put(None)


def _send(pipe: Any, source: queue.SimpleQueue[bytes | None]) -> None:
    with contextlib.suppress(OSError, ValueError):
        while (data := source.get()) is not None:
            pipe.send_bytes(data)
    with contextlib.suppress(OSError):
        pipe.send_bytes(b"")  # the end


def serve(pipe: Any, options: bytes) -> None:
    """The child: open the lines and pass batches on, until the pipe ends."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the window decides when it is over
    asyncio.run(_serve(pipe, msgspec.msgpack.decode(options, type=Options)))


async def _serve(pipe: Any, options: Options) -> None:
    out: queue.SimpleQueue[bytes | None] = queue.SimpleQueue()
    threading.Thread(target=_send, args=(pipe, out), daemon=True).start()
    server = Server(options, time.monotonic)
    try:
        out.put(pack(await server.open()))
    except LiveError as error:
        out.put(pack(Ready(error=str(error))))
        out.put(None)
        await asyncio.sleep(0.2)
        return
    loop = asyncio.get_running_loop()

    def take(data: bytes | None) -> None:
        if data:
            server.hub.give(unpack_result(data))
            step()
        else:
            server.stopped.set()

    def listen() -> None:
        with contextlib.suppress(RuntimeError):  # the loop has ended
            try:
                while data := pipe.recv_bytes():
                    loop.call_soon_threadsafe(take, data)
            except (EOFError, OSError):
                pass
            loop.call_soon_threadsafe(take, None)

    def step(batch: Batch | None = None) -> Result | None:
        batch = server.hub.take() if batch is None else batch
        if batch is not None:
            out.put(pack(batch))
        return None

    threading.Thread(target=listen, daemon=True).start()
    await server.run(step)
    await server.close()
    out.put(None)
