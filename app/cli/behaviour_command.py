"""`metagraph behaviour`: what a character does by itself in an hour, next to what people do."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from typing import Any

from app.cli.command_output import open_for_command, say
from metagraph.graph.words import LASTING_MODES, MODES

LEAST, MOST = 60.0, 86400.0  # seconds that are counted


def add_arguments(parser: ArgumentParser) -> None:
    """Add the options."""
    parser.add_argument(
        "--mode", choices=MODES, help="count this mode only (default: idle, listening and talking)"
    )
    parser.add_argument(
        "-s", "--seconds", type=float, default=3600.0, help="how long to play (default: an hour)"
    )
    parser.add_argument(
        "--seed",
        type=int,
        help="random seed; another seed gives another performance (default: the project's seed)",
    )


def run(options: Namespace) -> int:
    """Count and print."""
    from metagraph.playback.behaviour import describe_lack, measure_behaviour

    if not LEAST <= options.seconds <= MOST:
        raise ValueError(f"--seconds must be {LEAST:g} to {MOST:g}")
    project = open_for_command(options.project)
    words: list[str] = []
    data: dict[str, Any] = {}
    for mode in [options.mode] if options.mode else LASTING_MODES:
        found = measure_behaviour(project, mode, options.seconds, options.seed)
        words.append(f"{mode}, {options.seconds:g} s:")
        for row in found.rows:
            source = f" ({row.source})" if row.source else ""
            words.append(f"  {row.name:<50} {row.amount:<20} {row.compared}{source}".rstrip())
        words += [f"  {describe_lack(project, lack)}" for lack in found.lacks]
        data[mode] = {
            "rows": [
                {
                    "name": row.name,
                    "value": round(row.value, 3),
                    "unit": row.unit,
                    "people": [row.least, row.most],
                    "source": row.source or "",
                }
                for row in found.rows
            ],
            "lacks": [
                {"layer": x.layer, "stance": x.stance, "kind": x.kind, "have": x.have, "more": x.more}
                for x in found.lacks
            ],
        }
    say(options, "\n".join(words), data)
    return 0
