"""`metagraph live`: a character that plays and listens, without a window."""

from __future__ import annotations

import contextlib
import os
import signal
import sys
import time
from argparse import ArgumentParser, Namespace
from pathlib import Path
from typing import TYPE_CHECKING

from app.cli import live_graph_options
from app.cli.filmed_keypoints import DEFAULT_CAMERA, require_estimator
from app.cli.kept_options import check_kept_name, parse_kept_seed
from app.cli.outputs import ProjectOutput
from metagraph.live import FACE_PORT, OSC_PORT, PORT, VMC_PORT

if TYPE_CHECKING:
    from metagraph.graph.model import Project
    from metagraph.graph.requests import Performance
    from metagraph.live.live_session import LiveSession
    from metagraph.live.played_voice import PlayedVoice
    from metagraph.live.server import Options, Server
    from metagraph.live.wire import BatchResult, Ready, RequestBatch


def add_arguments(parser: ArgumentParser) -> None:
    """Add the command's options."""
    parser.add_argument(
        "--port", type=int, help=f"the port of the WebSocket, 0 for any free port (default: {PORT})"
    )
    parser.add_argument("--osc-port", type=int, metavar="PORT",
                        help=f"the UDP port of OSC, 0 for any free port (default: {OSC_PORT})")  # fmt: skip
    parser.add_argument(
        "--vmc", nargs="?", const="", metavar="[HOST:]PORT",
        help="send poses to a program that receives VMC, such as VSeeFace, VNyan or Warudo "
        f"(default: 127.0.0.1:{VMC_PORT})",
    )  # fmt: skip
    parser.add_argument(
        "--vmc-in", nargs="?", type=int, const=VMC_PORT, metavar="PORT",
        help="mimic a person whom another program tracks, as it sends VMC to this UDP port "
        f"(default: {VMC_PORT})",
    )  # fmt: skip
    parser.add_argument(
        "--camera", nargs="?", const=DEFAULT_CAMERA, metavar="DEVICE",
        help="mimic the person before a camera of this computer: a number from 0, or the system's name for "
        "it, such as /dev/video0 (default: 0)",
    )  # fmt: skip
    parser.add_argument(
        "--no-mirror", action="store_true",
        help="match left with left, instead of mirroring the person before the camera",
    )  # fmt: skip
    parser.add_argument(
        "--face", nargs="?", const="", metavar="[HOST:]PORT",
        help="send the face to Unreal as the app Live Link Face does "
        f"(default: 127.0.0.1:{FACE_PORT})",
    )  # fmt: skip
    parser.add_argument(
        "--lsl", action="store_true",
        help="open streams of the Lab Streaming Layer: events (Markers), the pose (MoCap) and the face; "
        "needs the extra lab",
    )  # fmt: skip
    parser.add_argument(
        "--lsl-in", action="append", default=[], metavar="STREAM",
        help="do what a stream of the Lab Streaming Layer says, by its name or as type=Markers: markers are "
        "requests or names of actions, keypoints of a person are mimicked; may be repeated",
    )  # fmt: skip
    parser.add_argument(
        "--lsl-network", action="store_true",
        help="let the Lab Streaming Layer find, and be found by, other computers (default: this computer "
        "only, unless you have settings for LSL of your own)",
    )  # fmt: skip
    parser.add_argument("--no-websocket", action="store_true", help="do not listen for WebSocket")
    parser.add_argument("--no-osc", action="store_true", help="do not listen for OSC")
    parser.add_argument(
        "--no-stdin",
        action="store_true",
        help="do not read requests from standard input, and keep running when it ends",
    )
    parser.add_argument(
        "--mcp", action="store_true",
        help="speak the Model Context Protocol on standard input and output, for language models; "
             "WebSocket and OSC listen only if a port is given",
    )  # fmt: skip
    parser.add_argument(
        "--host",
        default="",
        help="the network address to listen on (default: this computer only); needs a token",
    )
    parser.add_argument("--token", help="the token that clients must send first (default: $METAGRAPH_TOKEN)")
    parser.add_argument(
        "--origin",
        action="append",
        default=[],
        help='let web pages of this origin connect; "null" for pages opened from disk',
    )
    parser.add_argument(
        "--seed",
        type=parse_kept_seed,
        help="random seed; another seed gives another performance (default: the project's seed)",
    )
    parser.add_argument(
        "--no-idle", action="store_true", help="play only what is requested, without idle actions"
    )
    parser.add_argument(
        "--keep",
        metavar="NAME",
        type=check_kept_name,
        help="save the requests as a performance of the project at the end, and the motion of a motion "
        "graph in a file next to it",
    )
    live_graph_options.add_arguments(parser)


def run(options: Namespace) -> int:
    """Play until standard input ends or the program is interrupted."""
    import asyncio
    import gc

    from app.project.opening import open_whole
    from metagraph.generation.offered import list_models
    from metagraph.live.live_session import LiveSession
    from metagraph.live.server import Options, check_live_options

    wanted = check_live_options(
        Options(
            host=options.host,
            port=_port(options, options.no_websocket, options.port, PORT),
            osc=_port(options, options.no_osc, options.osc_port, OSC_PORT),
            token=options.token or os.environ.get("METAGRAPH_TOKEN") or None,
            origins=tuple(options.origin),
            stdio=options.mcp or not options.no_stdin,
            mcp=options.mcp,
            vmc=_parse_receiver("--vmc", options.vmc, VMC_PORT),
            face=_parse_receiver("--face", options.face, FACE_PORT),
            person=options.vmc_in,
            camera=options.camera,
            mirror=not options.no_mirror,
            lsl=options.lsl,
            lsl_in=tuple(options.lsl_in),
            lsl_network=options.lsl_network,
        )
    )
    if options.camera is not None:
        require_estimator(options)
    live_graph_options.require_consistent_options(options)
    opened = open_whole(options.project)
    for note in opened.notes:
        print(f"note: {note}", file=sys.stderr)
    if wanted.vmc is not None:
        _require_humanoid(opened.project)
    graphs = live_graph_options.read_graphs(options, opened.project)
    voice = live_graph_options.read_live_voice(options, graphs)
    session = LiveSession(
        opened.project,
        options.seed,
        idle=not options.no_idle,
        models=list_models(options.project.resolve().parent),
        graphs=graphs,
    )
    session.warm()
    gc.freeze()  # what was loaded stays; looking through it again and again would show as a hitch
    with contextlib.suppress(KeyboardInterrupt):
        asyncio.run(_play(session, wanted, options.json, voice))
    if options.keep is not None:
        live_graph_options.keep_motion(session, options)
        _keep(session, options)
    return 0


def _port(options: Namespace, none: bool, named: int | None, usual: int) -> int | None:
    """Return the port to listen on, or None."""
    if none or (options.mcp and named is None):
        return None
    return usual if named is None else named


def _parse_receiver(name: str, text: str | None, usual: int) -> tuple[str, int] | None:
    """Return host and port of a receiver: "", "39539", "host" or "host:39539"; None for None. name: of the
    option. Raises LiveError.
    """
    from metagraph.live.server import LiveError

    if text is None:
        return None
    host, _, port = text.rpartition(":") if ":" in text or text.isdecimal() else (text, "", "")
    try:
        return host or "127.0.0.1", int(port or usual)
    except ValueError:
        raise LiveError(f"{name}: '{text}' is no host and port, such as 127.0.0.1:{usual}") from None


def _require_humanoid(project: Project) -> None:
    """Raise LiveError for a character that VMC cannot show."""
    from metagraph.graph.requests import RequestError
    from metagraph.live.server import LiveError
    from metagraph.live.vmc import VmcBody

    try:
        VmcBody.of(project)
    except RequestError as error:
        raise LiveError(f"--vmc: {error}") from None


async def _play(
    session: LiveSession, options: Options, as_json: bool, voice: PlayedVoice | None = None
) -> None:
    from metagraph.live.server import Server
    from metagraph.live.wire import exchange

    server = Server(options, time.monotonic, project=session.project, tell=_tell)
    ready = await server.open()
    _end_by_signals(server)
    _greet(server, ready, options, as_json)
    server.begin = begin = time.monotonic()

    def step(batch: RequestBatch | None) -> BatchResult:
        now = time.monotonic() - begin
        if voice is not None:
            voice.play(session, now)
        return exchange(session, now, batch)

    try:
        await server.run(step)
    finally:
        await server.close()


def _tell(words: str) -> None:
    print(words, file=sys.stderr, flush=True)


def _end_by_signals(server: Server) -> None:
    import asyncio

    loop = asyncio.get_running_loop()
    for number in (signal.SIGINT, signal.SIGTERM):
        with contextlib.suppress(NotImplementedError):  # Windows interrupts otherwise
            loop.add_signal_handler(number, server.stopped.set)


def _greet(server: Server, ready: Ready, options: Options, as_json: bool) -> None:
    """Print the addresses: for programs as a line of JSON on standard output, for people in words."""
    if as_json and not options.mcp:
        import msgspec

        line = msgspec.json.encode({"event": "ready"} | msgspec.to_builtins(ready))
        if options.stdio:
            server.say(line)
        else:
            print(line.decode(), flush=True)
        return
    spoken = "the Model Context Protocol" if options.mcp else "JSON lines"
    ways = [f"{spoken} on standard input"] if options.stdio else []
    ways += [f"WebSocket on {ready.websocket}"] if ready.websocket is not None else []
    ways += [f"OSC on {ready.osc[0]}, port {ready.osc[1]}"] if ready.osc is not None else []
    sent = f" It sends VMC to {options.vmc[0]}:{options.vmc[1]}." if options.vmc is not None else ""
    sent += f" It sends the face to {options.face[0]}:{options.face[1]}." if options.face is not None else ""
    sent += f" It mimics whom VMC on port {options.person} shows." if options.person is not None else ""
    sent += f" It mimics the person before camera {options.camera}." if options.camera is not None else ""
    sent += _describe_lsl(options)
    token = "; clients need the token" if ready.token else ""
    where = f": {', '.join(ways)}" if ways else " to no one"
    print(
        f"The character listens{where}{token}.{sent} Stop with Ctrl+C.",
        file=sys.stderr,
        flush=True,
    )


def _describe_lsl(options: Options) -> str:
    """Return which streams of the Lab Streaming Layer a session has, and who finds them."""
    from metagraph.common.lab_streaming import find_own_settings

    ways = ["opens LSL streams"] if options.lsl else []
    ways += [f"hears the LSL stream {text}" for text in options.lsl_in]
    if not ways:
        return ""
    own = find_own_settings()
    where = f"as {own} says" if own else "in the local network" if options.lsl_network else "on this computer"
    return f" It {' and '.join(ways)} {where}."


def _keep(session: LiveSession, options: Namespace) -> None:
    """Add the session to the project as it is saved now; if that cannot be, to a project beside it. Raises
    FileError, which says where the session is.
    """
    from metagraph.errors import FileError
    from metagraph.formats.store import open_project
    from metagraph.graph.editing.performances import add_performance

    played = session.performance(options.keep)
    lacks = session.kept_words()
    if lacks:
        print(f"note: {lacks}", file=sys.stderr)
    try:
        with ProjectOutput(options.project) as output:
            project, ident = add_performance(open_project(options.project).project, played)
            output.save(project)
    except (FileError, ValueError, RuntimeError) as error:
        place = _kept_beside(session.project, played, options.project)
        remedy = f"The performance was saved in '{place}', which you can open." if place is not None else ""
        if place is None:
            import msgspec

            print(msgspec.json.encode(played).decode(), flush=True)
            remedy = "No file could be written, so the performance was printed to standard output."
        cause = error.cause if isinstance(error, FileError) else str(error)
        raise FileError(options.project, cause, getattr(error, "where", ""), remedy) from None
    print(f"saved as '{project.performances[ident].name}'", file=sys.stderr)


def _kept_beside(project: Project, played: Performance, path: Path) -> Path | None:
    """Save a project with what was played beside another one, or where this computer keeps passing files;
    return where, None when nothing can be written.
    """
    import tempfile

    from metagraph.common.file_names import make_file_stem
    from metagraph.errors import FileError
    from metagraph.formats.store import SUFFIX, save_project
    from metagraph.graph.editing.performances import add_performance

    whole, _ = add_performance(project, played)
    own = path.name.removesuffix(SUFFIX)
    stem = make_file_stem(f"{own} - {played.name} {time.strftime('%Y-%m-%d %H.%M.%S')}", most=200)
    for folder in (path.resolve().parent, Path(tempfile.gettempdir())):
        place = folder / f"{stem}{SUFFIX}"
        with contextlib.suppress(FileError, OSError):
            save_project(whole, place, path)
            return place
    return None
