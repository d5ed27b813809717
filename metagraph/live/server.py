"""The lines of a session, opened and closed: WebSocket, OSC, LSL, standard input and output, on one asyncio
loop.

Nothing listens beyond this machine unless a host is named, and then only with a token.
"""

from __future__ import annotations

import asyncio
import contextlib
import ipaddress
import secrets
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

from msgspec import Struct

from metagraph.live import OSC_PORT, PORT
from metagraph.live.hub import Hub
from metagraph.live.stdio import StdioLine
from metagraph.live.wire import BatchResult, Ready, RequestBatch

if TYPE_CHECKING:
    from metagraph.graph.model import Project
    from metagraph.live.camera_line import CameraLine
    from metagraph.live.lsl_in import LslListener

TICK = 1 / 60  # seconds
LAST = 2.0  # seconds at most for answering what was asked before the end
CHECK = 1.0  # seconds between looks at who is still there


class Options(Struct, frozen=True):
    """Where to listen. host: loopback, on both IP versions, where it is empty. port, osc: 0 for any free one,
    None for none. origins: web pages that may connect besides those of this machine, "null" for those from
    files. stdio: whether standard input and output are a client. mcp: whether that speaks the Model Context
    Protocol. vmc, face: host and port of a program that receives VMC, and of an Unreal Engine that receives
    Live Link Face, None for none. person: the UDP port at which VMC of a tracked person is read, on this
    machine alone, None for none. camera: the camera whose person is mimicked, None for none; mirror: as in a
    mirror. lsl: whether poses and events are streams of the Lab Streaming Layer.
    lsl_in: which of its streams are heard, as `lsl_in.parse_wish` reads them. lsl_network: whether it may
    talk to other machines.
    """

    host: str = ""
    port: int | None = PORT
    osc: int | None = OSC_PORT
    token: str | None = None
    origins: tuple[str, ...] = ()
    stdio: bool = False
    mcp: bool = False
    vmc: tuple[str, int] | None = None
    face: tuple[str, int] | None = None
    person: int | None = None
    camera: str | None = None
    mirror: bool = True
    lsl: bool = False
    lsl_in: tuple[str, ...] = ()
    lsl_network: bool = False


class LiveError(ValueError):
    """A session cannot be opened as asked; the message says why and what to do."""


def check_live_options(options: Options) -> Options:
    """Return options that are safe. Raises LiveError for those that are not."""
    if options.token is not None and not options.token:
        raise LiveError("the token is empty; give a token, or leave the option out")
    if not is_loopback(options.host) and options.token is None:
        words = (
            f"listening on {options.host} needs a token, so that not everyone there can control the "
            "character; "
        )
        raise LiveError(words + f"choose one, for example --token {secrets.token_urlsafe(12)}")
    sent = [to[1] for to in (options.vmc, options.face) if to is not None]
    for port in (options.port, options.osc, options.person, *sent):
        if port is not None and not 0 <= port <= 65535:
            raise LiveError(f"a port is a number from 0 to 65535, not {port}")
    if options.lsl or options.lsl_in:
        _load_lsl(options)
    return options


def _load_lsl(options: Options) -> tuple[Any, list[tuple[str, str]]]:
    """Return the module pylsl, and which streams are wanted. Raises LiveError."""
    from metagraph.common.lab_streaming import load_lsl
    from metagraph.live.lsl_in import parse_wish

    try:
        wishes = [parse_wish(text) for text in options.lsl_in]
        return load_lsl("--lsl" if options.lsl else "--lsl-in", options.lsl_network), wishes
    except ValueError as error:
        raise LiveError(str(error)) from None


def is_loopback(host: str) -> bool:
    """Whether a host can be reached from this machine alone."""
    if host in ("", "localhost"):
        return True
    try:
        return ipaddress.ip_address(host.strip("[]")).is_loopback
    except ValueError:
        return False


class Server:
    """Opens the lines and passes batches on. clock: seconds, of any beginning. pipes: what to read lines from
    and write them to. project: whose tools are reported, where the Model Context Protocol is spoken, and
    whose character LSL shows. tell: takes a sentence for people.
    """

    def __init__(
        self,
        options: Options,
        clock: Callable[[], float],
        pipes: tuple[int, int] = (0, 1),
        project: Project | None = None,
        tell: Callable[[str], None] = lambda _: None,
    ) -> None:
        self.project, self.tell = project, tell
        self.begin = 0.0  # the clock's time at which the session began
        self.options, self.clock, self.pipes = check_live_options(options), clock, pipes
        self.hub = Hub(options.token)
        self.stopped = asyncio.Event()
        self._sockets: set[Any] = set()
        self._servers: list[asyncio.Server] = []
        self._osc: Any = None
        self.person_port = 0  # at which VMC of a tracked person is read, once it is
        self.camera: CameraLine | None = None
        self._stdio: StdioLine | None = None
        self._stdio_number = 0
        self._listener: LslListener | None = None

    @property
    def connections(self) -> int:
        """How many WebSocket connections are open, those that were not greeted yet included."""
        return len(self._sockets)

    async def open(self) -> Ready:
        """Open the lines; return where they are. Raises LiveError when a port is taken."""
        options, websocket, osc = self.options, None, None
        hosts = [options.host.strip("[]")] if options.host else ["127.0.0.1", "::1"]
        try:
            if options.port is not None:
                websocket = await self._open_websocket(hosts, options.port)
            if options.osc is not None:
                osc = await self._open_osc(hosts[0], options.osc)
            if options.vmc is not None:
                await self._open_vmc(*options.vmc)
            if options.face is not None:
                await self._open_face(*options.face)
            if options.person is not None:
                await self._open_person(options.person)
            if options.camera is not None:
                self._open_camera(options.camera)
            if options.lsl or options.lsl_in:
                self._open_lsl()
        except OSError as error:
            await self.close()
            words = error.strerror or str(error)
            raise LiveError(
                f"cannot listen on {hosts[0]}: {words}. Choose another port, or 0 for any free one."
            ) from None
        if options.stdio:
            call = asyncio.get_running_loop().call_soon_threadsafe
            if options.mcp and self.project is not None:
                from metagraph.live.mcp import McpLine

                self._stdio = McpLine(self.project, call, self._line, *self.pipes)
            else:
                self._stdio = StdioLine(call, self._line, *self.pipes)
            self._stdio_number = self.hub.open(self._stdio, self.clock(), proven=True)
            self._stdio.start()
        return Ready(websocket, osc, options.token is not None)

    async def _open_websocket(self, hosts: Sequence[str], port: int) -> str:
        from metagraph.live.websocket import WebSocketLine  # only those who listen pay for its import

        loop, local = asyncio.get_running_loop(), is_loopback(self.options.host)

        def line() -> WebSocketLine:
            return WebSocketLine(self.hub, self._sockets, self.options.origins, local)

        for place, host in enumerate(hosts):
            try:
                self._servers.append(await loop.create_server(line, host, port))
            except OSError:
                if place == 0:
                    raise
                continue  # this machine has no IPv6
            port = port or int(self._servers[0].sockets[0].getsockname()[1])
        shown = f"[{hosts[0]}]" if ":" in hosts[0] else hosts[0]
        return f"ws://{shown}:{port}"

    async def _open_osc(self, host: str, port: int) -> tuple[str, int]:
        from metagraph.live.osc import OscLine

        loop = asyncio.get_running_loop()
        transport, self._osc = await loop.create_datagram_endpoint(
            lambda: OscLine(self.hub, self.clock), (host, port)
        )
        return host, int(transport.get_extra_info("sockname")[1])

    async def _open_vmc(self, host: str, port: int) -> None:
        from metagraph.live.vmc_line import VmcLine

        loop = asyncio.get_running_loop()
        await loop.create_datagram_endpoint(
            lambda: VmcLine(self.hub, self.clock), remote_addr=(host.strip("[]"), port)
        )

    async def _open_face(self, host: str, port: int) -> None:
        from metagraph.live.face_link import FaceLinkLine

        loop = asyncio.get_running_loop()
        await loop.create_datagram_endpoint(
            lambda: FaceLinkLine(self.hub, self.clock), remote_addr=(host.strip("[]"), port)
        )

    async def _open_person(self, port: int) -> None:
        from metagraph.live.vmc_person import VmcPersonLine

        loop = asyncio.get_running_loop()
        transport, _ = await loop.create_datagram_endpoint(
            lambda: VmcPersonLine(self.hub, self.clock), ("127.0.0.1", port)
        )
        self.person_port = int(transport.get_extra_info("sockname")[1])

    def _open_camera(self, device: str) -> None:
        from metagraph.live.camera_line import CameraLine  # only who has a camera loads PyAV

        self.camera = CameraLine(self.hub, self.clock, device, self.options.mirror)

    def _open_lsl(self) -> None:
        from metagraph.common.lab_streaming import LabStreamError
        from metagraph.live.lsl_in import HeardStream, LslInLine, LslListener
        from metagraph.live.lsl_out import LslOutLine

        project = self.project
        if project is None:
            raise LiveError("LSL needs a project")
        lsl, wishes = _load_lsl(self.options)
        own: set[str] = set()
        if self.options.lsl:
            try:
                line = LslOutLine(lsl, project, self.clock, lambda: self.begin)
            except LabStreamError as error:
                raise LiveError(str(error)) from None
            line.join(self.hub)
            own = line.list_own()

        def open_line(stream: HeardStream) -> LslInLine:
            return LslInLine(self.hub, self.clock, stream, project, self.tell)

        if wishes:
            call = asyncio.get_running_loop().call_soon_threadsafe
            self._listener = LslListener(lsl, wishes, own, call, open_line, self.tell)
            self._listener.start()

    def _line(self, line: bytes | None) -> None:
        if line is not None:
            self.hub.message(self._stdio_number, line)
        else:
            self.stopped.set()

    def say(self, data: bytes) -> None:
        """Write a line of our own to standard output."""
        if self._stdio is not None:
            self._stdio.send([(data, False)])

    async def run(self, step: Callable[[RequestBatch | None], BatchResult | None]) -> None:
        """Pass batches to `step` and its results on, every tick, until stopped; what was asked by then is
        answered first.
        """
        checks, following, end = 0.0, self.clock(), float("inf")
        while True:
            last = self.stopped.is_set()
            result = step(self.hub.take())
            if result is not None:
                self.hub.give(result)
            now = self.clock()
            if now >= checks:
                checks = now + CHECK
                self._check(now)
            end = min(end, now + LAST) if last else end
            if last and (self.hub.idle or now >= end):
                return
            following = max(following + TICK, now)
            if last:
                await asyncio.sleep(following - now)
            else:
                with contextlib.suppress(TimeoutError):
                    await asyncio.wait_for(self.stopped.wait(), following - now)

    def _check(self, now: float) -> None:
        self.hub.check(now)
        loop_now = asyncio.get_running_loop().time()
        for line in list(self._sockets):
            line.ask(loop_now)
        if self._osc is not None:
            self._osc.check()

    async def close(self) -> None:
        """Hang up and stop listening."""
        if self._listener is not None:
            await asyncio.get_running_loop().run_in_executor(None, self._listener.finish)
        self.hub.close()
        for server in self._servers:
            server.close()
        if self._osc is not None and self._osc.transport is not None:
            self._osc.transport.close()
        if self._stdio is not None:
            await asyncio.get_running_loop().run_in_executor(None, self._stdio.finish)
        deadline = self.clock() + 1.0
        while self._sockets and self.clock() < deadline:
            await asyncio.sleep(0.01)
        for line in list(self._sockets):
            line.cut()
        await asyncio.sleep(0)
