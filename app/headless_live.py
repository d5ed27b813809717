"""`metagraph live`: a character that plays and listens, without a window."""

from __future__ import annotations

import asyncio
import contextlib
import os
import signal
import sys
import time
from argparse import ArgumentParser, Namespace
from pathlib import Path

import msgspec

from metagraph.formats.store import open_project
from metagraph.live.messages import encode
from metagraph.live.server import OSC_PORT, PORT, Options, Server, checked
from metagraph.live.session import LiveSession
from metagraph.live.wire import Batch, Ready, Result, exchange


def arguments(parser: ArgumentParser) -> None:
    """Add the command's options."""
    parser.add_argument("--host", default="", help="listen there instead of on this machine alone; needs a token")
    parser.add_argument("--port", type=int, default=PORT, help=f"of the WebSocket, 0 for any free one (default: {PORT})")
    parser.add_argument("--osc-port", type=int, default=OSC_PORT, help=f"of OSC over UDP, 0 for any free one (default: {OSC_PORT})")
    parser.add_argument("--no-websocket", action="store_true", help="do not listen for WebSocket")
    parser.add_argument("--no-osc", action="store_true", help="do not listen for OSC")
    parser.add_argument("--no-stdin", action="store_true", help="do not read requests from standard input, nor end with it")
    parser.add_argument("--token", help="what clients must say first (default: $METAGRAPH_TOKEN)")
    parser.add_argument("--origin", action="append", default=[], help='let web pages of this origin connect; "null" for files')
    parser.add_argument("--seed", type=int, help="another performance of the same project (default: the project's seed)")
    parser.add_argument("--no-idle", action="store_true", help="do nothing that is not asked for")
    parser.add_argument("--record", type=Path, help="write what was asked, with its times, to this JSON file at the end")


def live(options: Namespace) -> int:
    """Play until standard input ends or the program is interrupted."""
    wanted = Options(
        host=options.host,
        port=None if options.no_websocket else options.port,
        osc=None if options.no_osc else options.osc_port,
        token=options.token or os.environ.get("METAGRAPH_TOKEN") or None,
        origins=tuple(options.origin),
        stdio=not options.no_stdin,
    )
    checked(wanted)
    opened = open_project(options.project)
    for note in opened.notes:
        print(f"note: {note}", file=sys.stderr)
    session = LiveSession(opened.project, options.seed, idle=not options.no_idle)
    session.warm()
    with contextlib.suppress(KeyboardInterrupt):
        asyncio.run(_play(session, wanted, options.json))
    if options.record is not None:
        options.record.write_bytes(msgspec.json.format(encode(session.performance(options.record.stem)), indent=1))
    return 0


async def _play(session: LiveSession, options: Options, as_json: bool) -> None:
    server = Server(options, time.monotonic)
    ready = await server.open()
    loop = asyncio.get_running_loop()
    for number in (signal.SIGINT, signal.SIGTERM):
        with contextlib.suppress(NotImplementedError):  # Windows interrupts otherwise
            loop.add_signal_handler(number, server.stopped.set)
    if as_json:
        line = encode({"event": "ready"} | msgspec.to_builtins(ready))
        if options.stdio:
            server.say(line)
        else:
            print(line.decode(), flush=True)
    else:
        print(_words(ready, options), file=sys.stderr, flush=True)
    begin = time.monotonic()

    def step(batch: Batch | None) -> Result:
        return exchange(session, time.monotonic() - begin, batch)

    try:
        await server.run(step)
    finally:
        await server.close()


def _words(ready: Ready, options: Options) -> str:
    ways = []
    if options.stdio:
        ways.append("JSON lines on standard input")
    if ready.websocket is not None:
        ways.append(f"WebSocket on {ready.websocket}")
    if ready.osc is not None:
        ways.append(f"OSC on {ready.osc[0]}, port {ready.osc[1]}")
    token = "; clients need the token" if ready.token else ""
    return f"The character listens: {', '.join(ways) or 'to nobody'}{token}. Ctrl+C ends it."
