"""What motion graphs moved with live, kept in a file: of it, and of the same takes, the same motion can be
made again.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import msgspec
from msgspec import Struct

from metagraph.errors import FileError
from metagraph.formats.atomic import write_atomically
from metagraph.live.graph_motion import KeptMotion, LiveGraph
from metagraph.motion.clip import Clip

GIVE = "Give a file of `metagraph live --keep`."
FORMAT, VERSION = "metagraph live motion", 1
MOST = 64 * 1024 * 1024  # bytes of such a file


class KeptMotions(Struct, frozen=True):
    """A file's content, motions in the order in which they were shown."""

    format: str
    version: int
    motions: tuple[KeptMotion, ...]


def write_kept(path: Path, motions: Sequence[KeptMotion]) -> None:
    """Write what motions can be made again of. Raises FileError."""
    write_atomically(path, msgspec.json.encode(KeptMotions(FORMAT, VERSION, tuple(motions))))


def read_kept(path: Path) -> tuple[KeptMotion, ...]:
    """Return the motions of a file, at least one. Raises FileError."""
    try:
        if path.stat().st_size > MOST:
            raise FileError(path, f"it has more than {MOST // 1024**2} MiB", "", GIVE)
        read = msgspec.json.decode(path.read_bytes(), type=KeptMotions)
    except OSError as error:
        raise FileError(path, error.strerror or str(error), "", GIVE) from error
    except (msgspec.DecodeError, RecursionError) as error:
        raise FileError(path, f"is not a motion of a live session: {error}", "", GIVE) from None
    if read.format != FORMAT or read.version > VERSION:
        raise FileError(
            path,
            f"has the format '{read.format}' {read.version}",
            "",
            "Give a file of `live --keep`, or use a newer Metagraph.",
        )
    if not read.motions:
        raise FileError(
            path,
            "has no motion",
            "",
            "Give a file of a session in which a motion graph moved the character.",
        )
    return read.motions


def remake_motion(graph: LiveGraph, kept: KeptMotion, name: str) -> Clip:
    """Return the motion of a session again, as a clip. Raises ValueError if the takes are others than those
    it was made of.
    """
    from metagraph.synthesis.assemble import assemble
    from metagraph.synthesis.extending.path import replay_path

    size = graph.size
    if kept.size != size:
        raise ValueError(
            f"was made with a graph of {kept.size[0]:,} states and {kept.size[1]:,} transitions, but these "
            f"takes have {size[0]:,} and {size[1]:,}: give the takes and the speech that the session had"
        )
    path = replay_path(graph.driver, kept.told, kept.frames, kept.seed)
    return assemble(graph.driver.states, graph.takes, path, name, onward=True)
