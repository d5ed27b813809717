"""`metagraph plan`: a performance as a list of actions."""

from __future__ import annotations

import json
import sys
from argparse import ArgumentParser, Namespace

from app.cli.command_output import add_performance_arguments, choose_plan, open_for_command
from metagraph.graph.model import LAYERS


def add_arguments(parser: ArgumentParser) -> None:
    """Add the options."""
    add_performance_arguments(parser, 20.0)


def run(options: Namespace) -> int:
    project = open_for_command(options.project)
    made = choose_plan(project, options)
    rows = [
        {
            "layer": layer,
            "start": round(cue.start, 4),
            "end": round(cue.end, 4),
            "kind": cue.action.kind,
            "action": cue.action.id,
            "name": cue.action.name,
            "stance": cue.stance,
            "then": cue.then,
        }
        for layer in LAYERS
        for cue in made.layers[layer].cues
    ]
    if options.json:
        reports = [
            {"request": r.request, "outcome": r.outcome, "message": r.message, "layer": r.layer}
            for r in made.reports
        ]
        print(json.dumps({"seed": made.seed, "end": made.end, "cues": rows, "reports": reports}))
        return 0
    for row in sorted(rows, key=lambda r: (r["start"], r["layer"])):
        print(f"{row['start']:8.2f} {row['end']:8.2f}  {row['layer']:5} {row['kind']:11} {row['name']}")
    if not rows:
        print(
            "Nothing plays, because no layer has a stance with a loop and actions. Label clips first.",
            file=sys.stderr,
        )
    return 0
