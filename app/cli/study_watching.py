"""`metagraph study watch`: who is where, on this machine."""

from __future__ import annotations

import sys
import time
from argparse import ArgumentParser, Namespace
from collections.abc import Callable
from pathlib import Path

Action = Callable[[str, str, Callable[[Namespace], int]], ArgumentParser]


def add_arguments(action: Action) -> None:
    """Add the action."""
    made = action("watch", "show the progress of participants on this computer, as they work", watch_study)
    made.add_argument("study", type=Path, help="the study's folder, or its study.yaml")
    made.add_argument("--once", action="store_true", help="show it once and stop")
    made.add_argument("--every", type=float, default=2.0, help="seconds between updates (default: 2)")


def watch_study(options: Namespace) -> int:
    from dataclasses import asdict

    from app.cli.command_output import run_until_stopped, say
    from metagraph.research.study.logs.watching import tabulate_participants
    from metagraph.research.study.logs.watching import watch_participants as look
    from metagraph.research.study.study_plan import read_study

    study = read_study(options.study)
    if options.once or options.json:
        found = look(study)
        say(options, "\n".join(tabulate_participants(found)), {"participants": [asdict(s) for s in found]})
        return 0
    with run_until_stopped():
        while True:
            lines = [
                f"{study.plan.title}   {time.strftime('%H:%M:%S')}   Ctrl+C ends",
                *tabulate_participants(look(study)),
            ]
            clear = "\x1b[H\x1b[2J" if sys.stdout.isatty() else ""
            print(clear + "\n".join(lines), flush=True)
            time.sleep(max(0.2, options.every))
    return 0
