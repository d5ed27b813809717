"""`metagraph check`: what is wrong with a project, and what to do about it."""

from __future__ import annotations

import json
from argparse import ArgumentParser, ArgumentTypeError, Namespace
from collections import Counter

from app.cli.command_output import LONGEST, open_for_command
from app.cli.journal_note import warn_of_journals
from metagraph.formats.project.verified import count_in_words
from metagraph.graph.check import check_project as find_problems
from metagraph.graph.check import grave

PLAYED = 600.0  # seconds


def add_arguments(parser: ArgumentParser) -> None:
    """Add the options."""
    parser.add_argument(
        "--strict", action="store_true", help="warnings count as problems for the exit code, too"
    )
    parser.add_argument(
        "--play",
        type=_seconds,
        nargs="?",
        const=PLAYED,
        metavar="SECONDS",
        help="also play the character untouched for so many seconds, and each action once, and report what a "
        f"viewer would see go wrong ({PLAYED:.0f} s without a number)",
    )


def _seconds(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise ArgumentTypeError(f"'{text}' is no number of seconds; the project comes before it") from None


def run(options: Namespace) -> int:
    project = open_for_command(options.project)
    problems = find_problems(project)
    if options.play is not None:
        from metagraph.playback.rehearsal import rehearse

        if not 0 < options.play <= LONGEST:
            raise ValueError(f"--play takes more than 0 and at most {LONGEST} seconds")
        problems += rehearse(project, options.play)
    warn_of_journals(options.project)
    counts = Counter(p.severity for p in problems)
    if options.json:
        fields = ("severity", "code", "message", "remedy", "layer", "stance", "action", "clip", "moment")
        print(json.dumps({"problems": [{f: getattr(p, f) for f in fields} for p in problems]}))
    else:
        for p in problems:
            print(f"{p.severity:8}{f'{p.layer}: ' if p.layer else ''}{p.message}\n        {p.remedy}")
        print(", ".join(count_in_words(counts[one], one) for one in ("error", "warning", "hint")))
    return 3 if grave(problems, options.strict) else 0
