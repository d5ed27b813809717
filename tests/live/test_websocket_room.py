"""Lines that never say hello: they may be as many as they like, others come in at once."""

from __future__ import annotations

import asyncio

from metagraph.live.hub import CLIENTS
from metagraph.live.server import Options, Server


def test_five_hundred_half_open_lines_lock_nobody_out() -> None:
    async def play() -> None:
        from websockets.asyncio.client import connect

        server = Server(Options(port=0, osc=None), asyncio.get_running_loop().time)
        ready = await server.open()
        assert ready.websocket is not None
        port = int(ready.websocket.rpartition(":")[2])
        silent = [await asyncio.open_connection("127.0.0.1", port) for _ in range(500)]
        try:
            for _ in range(3):
                async with connect(ready.websocket, open_timeout=2):
                    assert len(server.hub.clients) == 1
                await asyncio.sleep(0.05)
            assert server.connections <= CLIENTS + 3
        finally:
            for _, writer in silent:
                writer.transport.abort()
            await server.close()

    asyncio.run(play())
