"""`metagraph doctor`: what this computer has of what Metagraph needs, for a report of a fault."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace

from app.cli.command_output import say
from app.shell.system_report import format_report, make_system_report


def add_arguments(parser: ArgumentParser) -> None:
    """Add no options."""


def run(options: Namespace) -> int:
    """Print the report."""
    report = make_system_report()
    say(options, format_report(report), report)
    return 0 if report["OpenGL"].startswith("3.3 or later") else 3
