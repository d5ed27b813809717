"""Options of `metagraph live` for a motion graph that moves the character, and for a voice that it plays."""

from __future__ import annotations

import sys
from argparse import ArgumentParser, Namespace
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from app.cli.takes import add_speech_arguments

if TYPE_CHECKING:  # reading a command line must not wait for arrays
    from metagraph.graph.model import Project
    from metagraph.live.graph_motion import LiveGraph
    from metagraph.live.live_session import LiveSession
    from metagraph.live.played_voice import PlayedVoice
    from metagraph.motion.clip import Clip

NAME = "takes"  # what clients call the graph
SUFFIX = ".motion.json"


def add_arguments(parser: ArgumentParser) -> None:
    """Add the options."""
    parser.add_argument(
        "--takes",
        type=Path,
        nargs="+",
        default=[],
        metavar="PATH",
        help="long takes: clip files, folders of them, or projects, whose motion graph clients may ask to "
        f'`generate` motion, as "{NAME}"; with --speech',
    )
    add_speech_arguments(parser, required=False)
    parser.add_argument(
        "--retarget", action="store_true", help="retarget takes of another skeleton to the character's"
    )
    parser.add_argument(
        "--voice",
        type=Path,
        metavar="FILE",
        help="a sound file to which the character moves from the start, heard as it plays; with --takes",
    )
    parser.add_argument(
        "--announce",
        type=float,
        metavar="SECONDS",
        help="announce the clauses of --voice this many seconds ahead (default: not announced)",
    )


def require_consistent_options(options: Namespace) -> None:
    """Raise ValueError for options that do not go together."""
    if options.takes and not options.speech:
        raise ValueError(
            "--takes needs --speech: a file for each take, with the same name, that has what was said"
        )
    if not options.takes and (options.speech or options.retarget):
        raise ValueError("--speech and --retarget need --takes")
    if options.announce is not None and options.voice is None:
        raise ValueError("--announce needs --voice")
    if options.announce is not None and not 0 <= options.announce <= 60:
        raise ValueError("--announce must be 0 to 60 seconds")


def read_graphs(options: Namespace, project: Project) -> dict[str, LiveGraph]:
    """Return the motion graph of the given takes, or else of the project's own takes, by name. Raises
    FileError and ValueError.
    """
    from metagraph.live.graph_motion import list_recorded_takes, make_live_graph

    if not options.takes:
        own, told = list_recorded_takes(project)
        if not own:
            return {}
        try:
            graph = make_live_graph(own, told)
            graph.warm(project)
        except (ValueError, RuntimeError) as error:
            print(
                f"note: no motion graph can be built from the project's own takes: {error}", file=sys.stderr
            )
            return {}
        return {NAME: graph}
    from app.cli.takes import match_speech

    clips, speech = match_speech(options)
    graph = make_live_graph(_brought(clips, project, options.retarget), speech)
    kept, edges = graph.driver.graph.size
    if not graph.fits(project):
        raise ValueError(
            f"take '{clips[0].name}' has another skeleton than the character: bring the takes onto it with "
            "--retarget, or give takes of the character itself"
        )
    graph.warm(project)
    print(f"note: the motion graph has {kept:,} states and {edges:,} transitions", file=sys.stderr)
    return {NAME: graph}


def _brought(clips: list[Clip], project: Project, retarget: bool) -> list[Clip]:
    if not retarget or project.skeleton is None:
        return clips
    from metagraph.graph.editing.retargeting import Bringing

    bringing = Bringing(project)
    return [
        c
        if c.skeleton == project.skeleton
        else bringing.bring(c, bringing.known(c) or bringing.propose(c.skeleton))
        for c in clips
    ]


def read_live_voice(options: Namespace, graphs: Mapping[str, LiveGraph]) -> PlayedVoice | None:
    """Return the voice that was given, None for none. Raises FileError, and ValueError where no graph could
    move to it.
    """
    if options.voice is None:
        return None
    if NAME not in graphs:
        raise ValueError("--voice needs --takes, or a project that has its own long takes")
    from metagraph.live.played_voice import read_played_voice

    return read_played_voice(options.voice, NAME, options.announce)


def keep_motion(session: LiveSession, options: Namespace) -> None:
    """Save data to make the graph's motion again, in a file beside the project. Raises FileError."""
    motions = session.generating.motions()
    if not motions:
        return
    from metagraph.common.file_names import make_file_stem
    from metagraph.formats.store import SUFFIX as PROJECT
    from metagraph.live.kept_motion import write_kept

    stem = make_file_stem(f"{options.project.name.removesuffix(PROJECT)} - {options.keep}", most=200)
    path = options.project.resolve().parent / f"{stem}{SUFFIX}"
    write_kept(path, motions)
    print(
        f"saved '{path}'; make the motion again with: metagraph motion-graph synthesize ... --again",
        file=sys.stderr,
    )
