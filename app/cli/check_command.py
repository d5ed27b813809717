"""`metagraph check`: what is wrong with a project, and what to do about it."""

from __future__ import annotations

import json
from argparse import ArgumentParser, ArgumentTypeError, Namespace
from collections import Counter

from app.cli.command_output import LONGEST, explain_code_3, open_for_command
from app.cli.journal_note import warn_of_journals
from app.cli.showing_command import name_showing_command
from metagraph.formats.project.verified import count_in_words
from metagraph.graph.check import check_project as find_problems
from metagraph.graph.check import list_grave_problems
from metagraph.graph.problem_groups import group_problems

PLAYED = 600.0  # seconds


def add_arguments(parser: ArgumentParser) -> None:
    """Add the options."""
    parser.add_argument(
        "--strict", action="store_true", help="also end with exit code 3 if there are only warnings"
    )
    parser.add_argument(
        "--play",
        type=_seconds,
        nargs="?",
        const=PLAYED,
        metavar="SECONDS",
        help="also play the character for this many seconds without requests, then each action, and report "
        f"visible faults ({PLAYED:.0f} s without a number)",
    )


def _seconds(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise ArgumentTypeError(
            f"'{text}' is not a number of seconds; give the project before --play"
        ) from None


def run(options: Namespace) -> int:
    project = open_for_command(options.project)
    problems = find_problems(project)
    if options.play is not None:
        from app.cli.progress_line import ProgressLine
        from metagraph.playback.rehearsal import rehearse

        if not 0 < options.play <= LONGEST:
            raise ValueError(f"--play must be more than 0 and at most {LONGEST} seconds")
        problems += rehearse(project, options.play, ProgressLine(options, "Playing it").tell)
        order = ("error", "warning", "hint")
        problems.sort(key=lambda p: order.index(p.severity))
    warn_of_journals(options.project)
    counts = Counter(p.severity for p in problems)
    if options.json:
        fields = ("severity", "code", "message", "remedy", "layer", "stance", "action", "clip", "moment")
        print(json.dumps({"problems": [{f: getattr(p, f) for f in fields} for p in problems]}))
    else:
        for group in group_problems(project, problems):
            first = group.problems[0]
            where = f"{first.layer}: " if first.layer else ""
            print(f"{first.severity:8}{where}{group.words}\n        {first.remedy}")
            for p in group.problems if len(group.problems) > 1 else ():
                print(f"          {p.message}")
            for p in group.problems[:1]:
                if command := name_showing_command(project, p, options.project):
                    print(f"        See it: {command}")
        print(", ".join(count_in_words(counts[one], one) for one in ("error", "warning", "hint")))
    failing = list_grave_problems(problems, options.strict)
    if failing:
        explain_code_3(f"{count_in_words(len(failing), 'problem')} to solve")
    return 3 if failing else 0
