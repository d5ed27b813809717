"""`metagraph author`: let a program, such as a language model, work on a project."""

from __future__ import annotations

import contextlib
import sys
from argparse import ArgumentParser, Namespace
from pathlib import Path


def add_arguments(parser: ArgumentParser) -> None:
    """Add the options."""
    parser.add_argument(
        "--folder",
        type=Path,
        action="append",
        default=[],
        metavar="FOLDER",
        help="also let it read and write in this folder (default: in the project's folder only)",
    )
    parser.add_argument(
        "--look-only", action="store_true", help="let it look, propose and plan, but edit nothing"
    )


def run(options: Namespace) -> int:
    """Answer calls until standard input ends."""
    from PySide6.QtCore import QCoreApplication

    from app.authoring.author_line import AuthorLine
    from app.authoring.desk import AuthorDesk
    from app.authoring.project_file import AuthoredFile
    from app.authoring.relaying import connect_to_window
    from app.cli.outputs import with_project_ending
    from metagraph.errors import FileError

    path: Path = options.project if options.project.is_file() else with_project_ending(options.project)
    for folder in (path.resolve().parent, *options.folder):
        if not folder.is_dir():
            raise FileError(folder, "there is no such folder", "", "Make it, or name another one.")
    QCoreApplication.setApplicationName("Metagraph")  # whose history has the steps
    QCoreApplication.setOrganizationName("Metagraph")
    authored = AuthoredFile(path, options.folder, options.look_only)
    try:
        with authored.hold():  # says at once what is wrong with the file
            pass
    except FileError:
        if connect_to_window(path, options.folder, options.look_only):
            return 0
        raise
    for note in authored.notes:
        print(f"note: {note}", file=sys.stderr)
    line = AuthorLine(AuthorDesk(authored))
    line.start()
    print(
        f"{path.name} can be edited: send the Model Context Protocol to standard input. Stop with Ctrl+C.",
        file=sys.stderr,
        flush=True,
    )
    with contextlib.suppress(KeyboardInterrupt):
        line.work()
    line.finish()
    return 0
