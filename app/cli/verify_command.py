"""`metagraph verify`: check that the files of a project or an export are intact."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from collections.abc import Sequence
from pathlib import Path

from app.cli.command_output import say
from metagraph.engines.verifying_exports import verify
from metagraph.formats.project.verified import Verified, count_in_words

INDENT = 2


def add_arguments(parser: ArgumentParser) -> None:
    """Add the options."""
    parser.add_argument(
        "path", type=Path, help="a project, an export's JSON or GLB, or a folder of projects and exports"
    )


def run(options: Namespace) -> int:
    found = verify(options.path)
    faults = [fault for one in found for fault in one.faults]
    data = {
        "whole": not faults,
        "checked": [
            {
                "path": one.file,
                "kind": one.kind,
                "whole": not one.faults,
                "parts": [
                    {
                        "name": part.name,
                        "words": part.words,
                        "problems": [
                            {"place": f.place, "message": f.words, "remedy": f.remedy} for f in part.faults
                        ],
                    }
                    for part in one.parts
                ],
            }
            for one in found
        ],
    }
    say(options, "\n".join([*format_verification(found), format_verdict(len(faults))]), data)
    return 3 if faults else 0


def format_verification(found: Sequence[Verified]) -> list[str]:
    """Return the report on each project and export: a heading, and a line for each part."""
    lines = []
    for one in found:
        lines.append(f"{one.file} ({one.kind})")
        width = max(len(part.name) for part in one.parts)
        for part in one.parts:
            lines.append(f"{'':{INDENT}}{part.name:{width}}  {part.words}")
            for fault in part.faults:
                lines.append(f"{'':{INDENT * 2}}{fault.place}: {fault.words}")
                lines.append(f"{'':{INDENT * 3}}{fault.remedy}")
    return lines


def format_verdict(count: int) -> str:
    """Return the last line, on everything."""
    return (
        f"{count_in_words(count, 'thing is', 'things are')} not whole." if count else "Everything is intact."
    )
