"""`metagraph study freeze`, `withdraw`, `delete` and `gaze`: record a study's files, withdraw or delete
participants, and read where people looked.
"""

from __future__ import annotations

import sys
from argparse import ArgumentParser, Namespace
from collections.abc import Callable
from pathlib import Path

Action = Callable[[str, str, Callable[[Namespace], int]], ArgumentParser]


def add_arguments(action: Action) -> None:
    """Add the actions."""
    frozen = action(
        "freeze", "record digests of the study's files, or check the files against them", freeze_study
    )
    frozen.add_argument("study", type=Path, help="the study's folder, or its study.yaml")
    frozen.add_argument(
        "--force", action="store_true", help="record the digests again for files that changed"
    )
    gone = action(
        "withdraw",
        "withdraw a participant: leave the data out of all reports and exports from now on",
        withdraw_participant,
    )
    _who(gone)
    gone.add_argument("--why", default="", help="the reason, which the log keeps")
    deleted = action("delete", "delete all data of a participant, and log the deletion", delete_participant)
    _who(deleted)
    deleted.add_argument("--yes", action="store_true", help="do not ask for confirmation")

    brought = action(
        "import", "add a participant's log of tasks done in Unreal, Unity, Godot or Blender", merge_sites
    )
    _who(brought)
    brought.add_argument("log", type=Path, help="the log file that the engine's script wrote")
    looked = action(
        "gaze",
        "list the panels and nodes that a participant looked at, from an eye-tracking recording",
        import_gaze,
    )
    _who(looked)
    looked.add_argument(
        "recording", type=Path, help="an export of Tobii Pro Lab, Pupil Player or Pupil Cloud"
    )
    looked.add_argument("--clap", type=float, help="time of the first clap in the recording, in seconds")
    looked.add_argument("--out", type=Path, help="the table to write (default: gaze.csv next to the log)")


def _who(parser: ArgumentParser) -> None:
    parser.add_argument("study", type=Path, help="the study's folder, or its study.yaml")
    parser.add_argument("participant", help="the participant's pseudonym")


def freeze_study(options: Namespace) -> int:
    from app.cli.command_output import say
    from metagraph.research.study.plan.freeze import freeze_files as write
    from metagraph.research.study.plan.freeze import read_frozen, seal
    from metagraph.research.study.study_plan import read_study

    study = read_study(options.study)
    path = write(study, options.force)
    digests = read_frozen(study) or {}
    say(
        options,
        f"{path}: {len(digests)} digests, together {seal(digests)}",
        {"written": str(path), "seal": seal(digests), "digests": digests},
    )
    return 0


def withdraw_participant(options: Namespace) -> int:
    from app.cli.command_output import say
    from metagraph.research.study.logs.withdrawal import find_mentions
    from metagraph.research.study.logs.withdrawal import note_withdrawal as note
    from metagraph.research.study.study_plan import read_study

    study = read_study(options.study)
    new = note(study, options.participant, options.why)
    say(
        options,
        f"{options.participant}: {'left out from now on' if new else 'withdrawn earlier'}",
        {"participant": options.participant, "new": new},
    )
    _told(find_mentions(study, options.participant))
    return 0


def delete_participant(options: Namespace) -> int:
    from app.cli.command_output import may_delete, say
    from metagraph.research.study.logs.withdrawal import delete_data as remove
    from metagraph.research.study.logs.withdrawal import find_mentions
    from metagraph.research.study.study_plan import read_study

    study = read_study(options.study)
    study.plan.known(options.participant)
    folder = study.data(options.participant)
    if not may_delete(options, folder):
        return 1
    note = remove(study, options.participant)
    say(options, f"{options.participant}: {note['files']} files deleted", {"deleted": note})
    _told(find_mentions(study, options.participant))
    return 0


def _told(paths: list[Path]) -> None:
    """Print the files that still have the pseudonym."""
    for path in paths[:10]:
        print(f"note: {path} still has their name; write it again", file=sys.stderr)
    if len(paths) > 10:
        print(f"note: and {len(paths) - 10} more files", file=sys.stderr)


def import_gaze(options: Namespace) -> int:
    from app.cli.command_output import say
    from metagraph.formats.atomic import write_atomically
    from metagraph.formats.outputs import claim
    from metagraph.research.study.logs.gaze import read_gaze, tabulate_dwell
    from metagraph.research.study.logs.log import read_log
    from metagraph.research.study.reports.tables import format_rows
    from metagraph.research.study.study_plan import read_study

    study = read_study(options.study)
    study.plan.known(options.participant)
    out = options.out or study.data(options.participant) / "gaze.csv"
    claim(out)
    found = tabulate_dwell(
        read_log(study.log(options.participant)), read_gaze(options.recording), options.clap
    )
    write_atomically(out, format_rows(*found).encode())
    lines = [f"{row[2]} ({row[1]}): {row[3]} {row[4]:.1f} s, {row[5]:.0%}" for row in found[1]]
    say(options, "\n".join([*lines, str(out)]), {"written": str(out), "rows": len(found[1])})
    return 0


def merge_sites(options: Namespace) -> int:
    from app.cli.command_output import say
    from metagraph.research.study.logs.engine_import import import_engine
    from metagraph.research.study.study_plan import read_study

    log, odd = import_engine(read_study(options.study), options.participant, options.log)
    for words in odd:
        print(f"note: {words}", file=sys.stderr)
    lines = [f"{r.task} ({r.condition}): {r.seconds:.0f} s, {r.edits} edits" for r in log.tasks()]
    say(options, "\n".join(lines), {"tasks": len(lines), "notes": odd})
    return 0
