"""Read takes and models for the actions of `metagraph generate`, and report on them."""

from __future__ import annotations

import sys
from argparse import ArgumentParser, Namespace
from pathlib import Path
from typing import TYPE_CHECKING

from app.cli.progress_line import ProgressLine

if TYPE_CHECKING:  # reading a command line must not wait for arrays
    from metagraph.generation.poses import PoseRig
    from metagraph.generation.stored import Model
    from metagraph.generation.take_files import TakeBatch

SHOWN = 8  # notes that are printed


def add_takes_arguments(parser: ArgumentParser) -> None:
    """Add the options that say which takes."""
    parser.add_argument(
        "takes",
        type=Path,
        nargs="+",
        metavar="TAKES",
        help="clips, or folders of clips, each with its sound in the same folder: talk.bvh and "
        "talk.wav, or talk_1.bvh and talk_2.bvh for the two speakers of talk.wav",
    )
    add_speech_argument(parser)


def add_speech_argument(parser: ArgumentParser) -> None:
    from app.cli.language_options import add_language_arguments

    parser.add_argument(
        "--speech",
        type=Path,
        nargs="+",
        default=[],
        metavar="FILE",
        help="sounds and transcripts, or folders of them (default: the clips' folders)",
    )
    add_language_arguments(parser)


def read_all(options: Namespace, rig: PoseRig | None = None, tracks: int = 1) -> TakeBatch:
    """Read the requested takes, and print notes on them. Raises ValueError if none can be used."""
    from app.cli.language_options import read_speaking
    from metagraph.errors import FileError
    from metagraph.generation.take_files import find_takes, read_take_batch

    for path in (*options.takes, *options.speech):
        if not path.exists():
            raise FileError(path, "there is no such file or folder", remedy="Check where the takes are.")
    speech = [p for p in options.speech if p.is_dir()]
    single = [p.parent for p in options.speech if p.is_file()]
    files, without = find_takes(options.takes, list(dict.fromkeys((*speech, *single))))
    show = ProgressLine(options, "Reading takes").tell
    speaking = read_speaking(options)
    batch = read_take_batch(
        files, rig, tracks=tracks, progress=lambda n, _: show(n, len(files)), speaking=speaking
    )
    failures = (*without, *batch.failures)
    for words in failures:
        print(f"left out: {words}", file=sys.stderr)
    print_notes(batch.notes)
    if not batch.takes:
        place = ", ".join(str(p) for p in options.takes)
        if not failures:
            raise FileError(
                place, "has no takes", remedy="Give clips that have their sound in the same folder."
            )
        raise ValueError(f"cannot use any of the {len(failures)} takes in {place}: {failures[0]}")
    return batch


def print_notes(notes: tuple[str, ...]) -> None:
    """Print notes, the first of many."""
    for note in notes[:SHOWN]:
        print(f"note: {note}", file=sys.stderr)
    if len(notes) > SHOWN:
        print(f"note: and {len(notes) - SHOWN} more", file=sys.stderr)


def read_models(paths: list[Path]) -> dict[str, Model]:
    """Return models by the names of their files. Raises FileError, ValueError."""
    from metagraph.generation.stored import read_model

    names = [p.stem for p in paths]
    twice = next((n for n in names if names.count(n) > 1), None)
    if twice is not None:
        raise ValueError(f"two models are called '{twice}': rename one of them")
    return {p.stem: read_model(p) for p in paths}
