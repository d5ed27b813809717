"""`metagraph generate`: motion for conversations that is learned from takes."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from pathlib import Path
from typing import Any


def add_arguments(parser: ArgumentParser) -> None:
    """Add the actions of `generate`, each with its options."""
    actions = parser.add_subparsers(dest="action", metavar="action", required=True)

    def action(name: str, words: str, run: Any) -> ArgumentParser:
        out = actions.add_parser(name, help=words, description=words[:1].upper() + words[1:] + ".")
        out.add_argument("--json", action="store_true", help="print JSON for programs")
        out.set_defaults(run=run)
        return out

    from app.cli import generate_judging, generate_motion, generate_training

    generate_training.add_arguments(action("train", "learn a model from takes", generate_training.train))
    new = action("sample", "generate motion for speech", generate_motion.write_motion)
    generate_motion.add_model_argument(new)
    generate_motion.add_heard_arguments(new, needed=True)
    new.add_argument("-o", "--out", type=Path, required=True, help="the .bvh or .glb file to write")
    new.add_argument(
        "--project",
        type=Path,
        help="the project whose character it is: hips, legs, fingers, gaze and face move as in its window "
        "(default: the sample project)",
    )
    new.add_argument(
        "--bare", action="store_true", help="write what the model moves alone: nothing else is added"
    )
    judged = action("evaluate", "evaluate models on takes they have not seen", generate_judging.judge_models)
    generate_judging.add_arguments(judged)
    ablated = action(
        "ablate",
        "train variants of a model with one change each, and compare them",
        generate_training.run_ablation,
    )
    generate_training.add_ablation_arguments(ablated)
    pieces = action("cut", "generate minutes of motion and cut them into clips", generate_motion.write_pieces)
    generate_motion.cut_arguments(pieces)
    generate_motion.add_model_argument(action("info", "describe a model", generate_motion.print_model))
    made = action(
        "planted", "make synthetic takes with a known ground truth, to test models", write_planted_takes
    )
    made.add_argument("-o", "--out", type=Path, required=True, help="the folder to write into")
    made.add_argument(
        "--count", type=int, default=25, help="number of conversations, of two takes each (default: 25)"
    )
    made.add_argument(
        "-s", "--seconds", type=float, default=180.0, help="seconds of each conversation (default: 180)"
    )
    made.add_argument("--seed", type=int, default=1, help="random seed of the speech (default: 1)")
    made.add_argument(
        "--moves",
        type=int,
        default=1,
        help="random seed of the motion; another seed gives another performance of the same speech "
        "(default: 1)",
    )
    made.add_argument(
        "--project",
        type=Path,
        help="the project whose graph moves both speakers (default: the sample project)",
    )


def run(options: Namespace) -> int:
    """Do the action that was asked for."""
    return int(options.run(options))


def write_planted_takes(options: Namespace) -> int:
    """Write planted takes."""
    from app.cli.command_output import open_for_command, say
    from app.cli.demo_command import SAMPLE
    from app.cli.progress_line import ProgressLine
    from metagraph.research.generation.planted import Planted, write_planted

    own = options.project is None
    project = open_for_command(SAMPLE if own else options.project)
    for name in ("seed", "moves"):
        if getattr(options, name) < 0:
            raise ValueError(f"--{name} must be a whole number, 0 or more")
    asked = Planted(count=options.count, seconds=options.seconds, seed=options.seed, moves=options.moves)
    licence = "MIT: synthetic speech, and motion of Metagraph's own sample clips." if own else ""
    new = write_planted(
        project, options.out, asked, licence, ProgressLine(options, "Writing conversations").tell
    )
    hours = 2 * asked.count * asked.seconds / 3600
    words = (
        f"{asked.count} conversations, {2 * asked.count} takes, {hours:.2f} h in {options.out} "
        f"({new} new, {asked.count - new} made earlier)"
    )
    data = {"folder": str(options.out), "conversations": asked.count, "new": new, "hours": round(hours, 4)}
    say(options, words, data)
    return 0
