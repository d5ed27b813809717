"""`metagraph study perceive mismatched`: the plan, and the videos, of which sound belongs to a motion."""

from __future__ import annotations

import sys
from argparse import ArgumentParser, Namespace
from collections.abc import Callable
from os.path import relpath
from pathlib import Path
from re import fullmatch
from typing import TYPE_CHECKING

from metagraph.errors import FileError

if TYPE_CHECKING:  # reading a command line must not wait for arrays
    from metagraph.graph.conversation.model import Conversation

Action = Callable[[str, str, Callable[[Namespace], int]], ArgumentParser]


def add_arguments(action: Action, make: Callable[[Namespace], int]) -> None:
    """Add the action. make: renders a plan's videos."""
    words = "ask which sound belongs to a motion: its own, or that of another stretch"
    made = action("mismatched", words, lambda options: write_mismatched(options, make))
    made.add_argument("out", type=Path, metavar="plan", help="the plan to write, such as perceive.yaml")
    made.add_argument("--project", type=Path, required=True, help="the project with the conversation")
    made.add_argument("--conversation", required=True, help="its name; the planner's motion is asked about")
    made.add_argument(
        "--recorded", action="store_true", help="also ask about the motion as recorded with the conversation"
    )
    made.add_argument(
        "--motion",
        action="append",
        default=[],
        metavar="NAME=FILE,FILE",
        help="also ask about motion of a file for each side, from 'motion-graph synthesize' or 'generate'; "
        "may be given several times",
    )
    made.add_argument(
        "--graph",
        action="append",
        default=[],
        metavar="NAME=FOLDER",
        help="also make and ask about motion of a motion graph of this folder's takes",
    )
    made.add_argument(
        "--model",
        action="append",
        default=[],
        metavar="NAME=FILE",
        help="also make and ask about motion of this learned model (.mgmodel); may be given several times",
    )
    made.add_argument("--no-planner", action="store_true", help="do not ask about the planner's motion")
    made.add_argument("--seconds", type=float, default=8.0, help="length of a stretch (default: 8)")
    made.add_argument("--items", type=int, default=12, help="number of stretches at most (default: 12)")
    made.add_argument("--participants", type=int, default=24, help="number of participants (default: 24)")
    made.add_argument(
        "--each", type=int, help="answers of each participant (default: each stretch of each system)"
    )
    made.add_argument(
        "--into", type=Path, metavar="FOLDER", help="also render the study into this folder, as 'make' does"
    )


def _make_motion(
    options: Namespace, talk: Conversation, folder: Path, known: set[str]
) -> dict[str, list[Path]]:
    """Make the motion of graphs and models that are asked for; return system -> a file for each side. Raises
    FileError, ValueError.
    """
    from app.cli.mismatched_motion import write_graph_motion, write_model_motion
    from metagraph.formats.outputs import claim

    asked = [(words, True) for words in options.graph] + [(words, False) for words in options.model]
    for words, is_graph in asked:
        name, found, path = words.partition("=")
        if not (found and path and fullmatch(r"[\w-]+", name)) or name in known:
            raise ValueError(f"--graph and --model take another name and a path, as NAME=PATH, not {words!r}")
        known.add(name)
        if not Path(path).exists():
            raise FileError(path, "does not exist", f"--{'graph' if is_graph else 'model'}")
        claim(*(folder / f"{name}_{n}.glb" for n in range(1, len(talk.sides) + 1)))
    if asked:
        folder.mkdir(parents=True, exist_ok=True)
    out = {}
    for words, is_graph in asked:
        name, _, path = words.partition("=")
        print(f"making the motion of '{name}'", file=sys.stderr)
        out[name] = (
            write_graph_motion(talk, Path(path), folder / name)
            if is_graph
            else write_model_motion(talk, options.project.resolve().parent, Path(path), folder / name)
        )
    return out


def write_mismatched(options: Namespace, make: Callable[[Namespace], int]) -> int:
    from app.cli.command_output import say
    from metagraph.formats.atomic import write_atomically
    from metagraph.formats.outputs import claim
    from metagraph.formats.store import read_project
    from metagraph.research.study.perceive.mismatched import list_stretches, make_mismatched_plan
    from metagraph.research.study.perceive.perceive_plan import parse_perceive_plan

    if not 0.5 <= options.seconds <= 600 or options.items < 1:
        raise ValueError("--seconds must be 0.5 to 600, and --items at least 1")
    project = read_project(options.project)
    talk = next((c for c in project.conversations.values() if c.name == options.conversation), None)
    if talk is None:
        kept = ", ".join(f"'{c.name}'" for c in project.conversations.values()) or "none"
        raise ValueError(f"there is no conversation '{options.conversation}' in the project; it has {kept}")
    folder = options.out.resolve().parent
    base = {"conversation": options.conversation}
    systems: dict[str, dict[str, object]] = {} if options.no_planner else {"planner": {**base}}
    if options.recorded:
        systems["recorded"] = {**base, "taken": True}
    for words in options.motion:
        name, found, files = words.partition("=")
        paths = [Path(f) for f in files.split(",") if f]
        if not found or not name or len(paths) != len(talk.sides) or name in systems:
            raise ValueError(
                f"--motion takes another name and a file for each of the {len(talk.sides)} sides, as "
                f"NAME=FILE,FILE, not {words!r}"
            )
        systems[name] = {**base, "motion": [Path(relpath(p.resolve(), folder)).as_posix() for p in paths]}
    for name, paths in _make_motion(options, talk, folder / "motion", set(systems)).items():
        systems[name] = {**base, "motion": [Path(relpath(p.resolve(), folder)).as_posix() for p in paths]}
    text = make_mismatched_plan(
        f"Which sound belongs to the motion? {options.conversation}",
        options.participants,
        systems,
        list_stretches(talk.length, options.seconds, options.items),
        Path(relpath(options.project.resolve(), folder)).as_posix(),
        options.each,
    )
    plan = parse_perceive_plan(text, options.out)
    claim(options.out)
    write_atomically(options.out, text.encode())
    if options.into is not None:
        options.plan = options.out
        return make(options)
    from app.typed_command import list_program_words, quote_command

    command = quote_command([*list_program_words(), "study", "perceive", "make", str(options.out)])
    say(
        options,
        f"{options.out}: {len(systems)} systems, {len(plan.items)} stretches. Render it with: "
        f"{command} --into FOLDER",
        {"plan": str(options.out), "systems": list(systems), "items": len(plan.items)},
    )
    return 0
