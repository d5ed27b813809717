"""A session that plays, with its lines open on this machine's loopback."""

from __future__ import annotations

import asyncio
import time
from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import asynccontextmanager

from metagraph.graph.model import Project
from metagraph.live.live_session import LiveSession
from metagraph.live.server import Options, Server
from metagraph.live.wire import BatchResult, Ready, RequestBatch, exchange

FREE = Options(port=0, osc=0)


@asynccontextmanager
async def serving(
    project: Project, options: Options = FREE
) -> AsyncIterator[tuple[Server, Ready, LiveSession]]:
    """A session that plays while the block runs."""
    server, session = Server(options, time.monotonic), LiveSession(project)
    ready = await server.open()
    begin = time.monotonic()

    def step(batch: RequestBatch | None) -> BatchResult:
        return exchange(session, time.monotonic() - begin, batch)

    running = asyncio.create_task(server.run(step))
    try:
        yield server, ready, session
    finally:
        server.stopped.set()
        await asyncio.wait_for(running, 10)
        await server.close()


def play(
    project: Project, work: Callable[[Server, Ready, LiveSession], Awaitable[None]], options: Options = FREE
) -> None:
    async def run() -> None:
        async with serving(project, options) as (server, ready, session):
            await asyncio.wait_for(work(server, ready, session), 30)

    asyncio.run(run())
