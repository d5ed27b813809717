"""What commands share: they read a project, plan a performance, and print words or JSON."""

from __future__ import annotations

import contextlib
import json
import signal
import sys
from argparse import ArgumentParser, Namespace
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from app.project.opening import open_whole
from metagraph.formats.outputs import declare_inputs
from metagraph.formats.project.paths import list_project_files
from metagraph.graph.model import Project
from metagraph.graph.requests import Performance
from metagraph.graph.words import MODES
from metagraph.playback.plan import Plan
from metagraph.playback.planning.running_plan import improvise, list_kept_asks, plan_performance

LONGEST = 36000  # seconds of one performance, ten hours


@contextlib.contextmanager
def run_until_stopped() -> Iterator[None]:
    """Leave what runs inside by Ctrl+C or SIGTERM, also where the program was started with interrupts
    ignored, as `nohup` and background jobs of scripts do: Python itself does not listen to them there. Call
    it in the main thread.
    """

    def stop(*_: object) -> None:
        raise KeyboardInterrupt

    before = {number: signal.signal(number, stop) for number in (signal.SIGINT, signal.SIGTERM)}
    try:
        with contextlib.suppress(KeyboardInterrupt):
            yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def open_for_command(path: Path) -> Project:
    """Read a project, protect the files that it names from the command, and print what is odd about it."""
    found = open_whole(path)
    declare_inputs(*list_project_files(found.project, path.resolve().parent))
    for note in found.notes:
        print(f"note: {note}", file=sys.stderr)
    return found.project


def explain_code_3(why: str) -> None:
    """Say on the terminal why a command that did its work ends with exit code 3."""
    print(f"exit code 3: {why}", file=sys.stderr)


def choose_plan(project: Project, options: Namespace) -> Plan:
    """Return the requested performance, or an improvised one, and set the option of its length."""
    kept = _kept(project, options.performance) if options.performance is not None else None
    if options.seconds is None:
        length = kept.length if kept is not None else options.usual_seconds
        options.seconds = max(0.0, length - options.start)
    if not 0 < options.seconds <= LONGEST:
        raise ValueError(f"--seconds must be more than 0 and at most {LONGEST}")
    length = options.start + options.seconds
    if options.start and kept is not None:  # a part is the same as in the whole
        length = max(length, kept.length)
    if kept is None:
        return improvise(project, length, options.seed, options.mode or "talking")
    if options.mode is not None:
        raise ValueError("--mode sets how the character improvises; a saved performance has its own mode")
    seed = kept.seed if options.seed is None else options.seed
    return plan_performance(project, list_kept_asks(kept), length, seed, dict(kept.stances), kept.idle)


def _kept(project: Project, name: str) -> Performance:
    found = next((p for i, p in project.performances.items() if name in (i, p.name)), None)
    if found is None:
        names = ", ".join(f"'{p.name}'" for p in project.performances.values()) or "none"
        raise ValueError(f"there is no performance '{name}' in the project; it has {names}")
    return found


def say(options: Namespace, words: str, data: Any) -> None:
    print(json.dumps(data) if options.json else words)


def may_delete(options: Namespace, folder: Path) -> bool:
    """Return whether a folder may be deleted: `--yes` says so, or somebody who is asked. Raises ValueError if
    nobody can be asked.
    """
    if options.yes:
        return True
    if options.json or not sys.stdin.isatty():
        raise ValueError(f"deleting {folder} cannot be undone: confirm with --yes")
    asked = f"Delete {folder} and everything in it? This cannot be undone. [y/N] "
    return input(asked).lower() == "y"


def add_performance_arguments(parser: ArgumentParser, seconds: float) -> None:
    """Add the options that say which performance, and how much of it. seconds: the usual length."""
    parser.add_argument(
        "-s", "--seconds", type=float, help=f"length of the performance (default: its own, else {seconds:g})"
    )
    parser.set_defaults(usual_seconds=seconds, start=0.0)
    parser.add_argument(
        "--performance",
        metavar="NAME",
        help="play this saved performance of the project (default: improvise)",
    )
    parser.add_argument(
        "--mode",
        choices=MODES,
        help="what the character does while it improvises (default: talking); not with --performance",
    )
    parser.add_argument(
        "--seed",
        type=int,
        help="random seed; another seed gives another performance (default: the project's seed)",
    )
