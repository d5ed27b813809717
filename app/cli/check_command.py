"""`metagraph check`: what is wrong with a project, and what to do about it."""

from __future__ import annotations

import json
from argparse import ArgumentParser, Namespace
from collections import Counter

from app.cli.command_output import open_for_command
from app.cli.journal_note import warn_of_journals
from metagraph.graph.check import check_project as find_problems
from metagraph.graph.check import grave


def add_arguments(parser: ArgumentParser) -> None:
    """Add the options."""
    parser.add_argument(
        "--strict", action="store_true", help="warnings count as problems for the exit code, too"
    )


def run(options: Namespace) -> int:
    problems = find_problems(open_for_command(options.project))
    warn_of_journals(options.project)
    counts = Counter(p.severity for p in problems)
    if options.json:
        fields = ("severity", "code", "message", "remedy", "layer", "stance", "action", "clip")
        print(json.dumps({"problems": [{f: getattr(p, f) for f in fields} for p in problems]}))
    else:
        for p in problems:
            print(f"{p.severity:8}{f'{p.layer}: ' if p.layer else ''}{p.message}\n        {p.remedy}")
        print(f"{counts['error']} errors, {counts['warning']} warnings, {counts['hint']} hints")
    return 3 if grave(problems, options.strict) else 0
