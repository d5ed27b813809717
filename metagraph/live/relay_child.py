"""The child process of `metagraph.live.relay`: it opens a session's connections and passes batches on until
its parent ends.
"""

from __future__ import annotations

import asyncio
import contextlib
import os
import queue
import signal
import threading
import time

import msgspec

from metagraph.common.child_channel import ChildChannel, connect_to_parent
from metagraph.live.relay import send
from metagraph.live.server import LiveError, Options, Server
from metagraph.live.wire import BatchResult, Ready, RequestBatch, pack, unpack_result

PATIENCE = 1.0  # seconds for the last words to be heard


def main() -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the window decides when it is over
    channel = connect_to_parent()
    with contextlib.suppress(EOFError):  # the parent is gone before it said anything
        asyncio.run(_serve(channel, msgspec.msgpack.decode(channel.receive(), type=Options)))


async def _serve(channel: ChildChannel, options: Options) -> None:
    out: queue.SimpleQueue[bytes | None] = queue.SimpleQueue()
    sender = threading.Thread(target=send, args=(channel, out), daemon=True)
    sender.start()
    try:
        await _talk(channel, options, out)
    finally:
        out.put(None)
        sender.join(PATIENCE)


async def _talk(channel: ChildChannel, options: Options, out: queue.SimpleQueue[bytes | None]) -> None:
    server = Server(options, time.monotonic)
    try:
        out.put(pack(await server.open()))
    except LiveError as error:
        out.put(pack(Ready(error=str(error))))
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
                while data := channel.receive():
                    loop.call_soon_threadsafe(take, data)
            except EOFError:
                pass
            loop.call_soon_threadsafe(take, None)

    def step(batch: RequestBatch | None = None) -> BatchResult | None:
        batch = server.hub.take() if batch is None else batch
        if batch is not None:
            out.put(pack(batch))
        return None

    def wake() -> None:
        loop.call_soon(step)  # once all that waits on the lines is read

    server.hub.wake = wake
    threading.Thread(target=listen, daemon=True).start()
    await server.run(step)
    await server.close()


if __name__ == "__main__":
    main()
    os._exit(0)  # a thread still listens to the parent
