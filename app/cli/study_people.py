"""`metagraph study freeze`, `withdraw` and `delete`: what a study is made of, and who is in it no more."""

from __future__ import annotations

import sys
from argparse import ArgumentParser, Namespace
from collections.abc import Callable
from pathlib import Path

Action = Callable[[str, str, Callable[[Namespace], int]], ArgumentParser]


def arguments(action: Action) -> None:
    """Add the actions."""
    frozen = action(
        "freeze", "write down by digest what the study is made of, or see whether it still is", freeze
    )
    frozen.add_argument("study", type=Path, help="the study's folder, or its study.yaml")
    frozen.add_argument("--force", action="store_true", help="freeze anew what has changed since")
    gone = action(
        "withdraw", "leave a participant's data out of all reports and exports from now on", withdraw
    )
    _who(gone)
    gone.add_argument("--why", default="", help="in words, kept in the log")
    deleted = action("delete", "delete all data of a participant, and note that it was done", delete)
    _who(deleted)
    deleted.add_argument("--yes", action="store_true", help="do not ask")


def _who(parser: ArgumentParser) -> None:
    parser.add_argument("study", type=Path, help="the study's folder, or its study.yaml")
    parser.add_argument("participant", help="the pseudonym")


def freeze(options: Namespace) -> int:
    from app.cli.command_output import say
    from metagraph.study.freeze import freeze as write
    from metagraph.study.freeze import frozen, seal
    from metagraph.study.study_plan import read_study

    study = read_study(options.study)
    path = write(study, options.force)
    digests = frozen(study) or {}
    say(
        options,
        f"{path}: {len(digests)} digests, together {seal(digests)}",
        {"written": str(path), "seal": seal(digests), "digests": digests},
    )
    return 0


def withdraw(options: Namespace) -> int:
    from app.cli.command_output import say
    from metagraph.study.study_plan import read_study
    from metagraph.study.withdrawal import mentions
    from metagraph.study.withdrawal import withdraw as note

    study = read_study(options.study)
    new = note(study, options.participant, options.why)
    say(
        options,
        f"{options.participant}: {'left out from now on' if new else 'had withdrawn before'}",
        {"participant": options.participant, "new": new},
    )
    _told(mentions(study, options.participant))
    return 0


def delete(options: Namespace) -> int:
    from app.cli.command_output import say
    from metagraph.study.study_plan import read_study
    from metagraph.study.withdrawal import delete as remove
    from metagraph.study.withdrawal import mentions

    study = read_study(options.study)
    study.plan.known(options.participant)
    folder = study.data(options.participant)
    if not options.yes:
        if options.json or not sys.stdin.isatty():
            raise ValueError(f"deleting {folder} cannot be taken back: say --yes")
        if input(f"Delete {folder} and all that is in it? It cannot be taken back. [y/N] ").lower() != "y":
            return 1
    note = remove(study, options.participant)
    say(options, f"{options.participant}: {note['files']} files deleted", {"deleted": note})
    _told(mentions(study, options.participant))
    return 0


def _told(paths: list[Path]) -> None:
    """Tell what still holds the pseudonym."""
    for path in paths[:10]:
        print(f"note: {path} still names them; write it anew", file=sys.stderr)
    if len(paths) > 10:
        print(f"note: and {len(paths) - 10} more files", file=sys.stderr)
