"""`metagraph doctor`: what this computer has of what Metagraph needs, for a report of a fault."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace

from app.cli.command_output import say
from app.cli.system_libraries import find_missing_packages
from app.shell.system_report import format_report, make_system_report


def add_arguments(parser: ArgumentParser) -> None:
    """Add the options."""
    parser.add_argument(
        "--commands", action="store_true", help="list the window's commands, as a studio's file names them"
    )


def list_commands() -> dict[str, str]:
    """Return what each command of the window says, by its id. It needs a screen, or Qt's own without one."""
    import os

    from app.cli.window_command import has_screen

    if not has_screen():
        os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")
    from app.main import make_window, prepare_application

    prepare_application()
    window = make_window()
    found = {command.id: command.plain for command in window.shell.actions.commands}
    window.close()
    return found


def run(options: Namespace) -> int:
    """Print the report, or the window's commands."""
    if options.commands:
        commands = list_commands()
        say(options, "\n".join(f"{name:28} {words}" for name, words in commands.items()), commands)
        return 0
    report = make_system_report()
    if packages := find_missing_packages():
        report["Missing"] = f"on Debian or Ubuntu: apt install {' '.join(packages)}"
    say(options, format_report(report), report)
    return 0 if report["OpenGL"].startswith("3.3 or later") else 3
