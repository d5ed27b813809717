"""The `metagraph` command: the window by default, and the same work without one."""

from __future__ import annotations

import argparse
import json
import os
import sys
from collections.abc import Sequence
from difflib import get_close_matches
from importlib import import_module
from pathlib import Path
from typing import Any

from app.cli.outputs import claim_outputs, offer_overwrite
from app.cli.system_libraries import describe_missing_library
from app.typed_command import list_program_words, quote_command
from metagraph import __version__
from metagraph.common.network_paths import allow
from metagraph.common.programs import leave_working_folder

ERROR = 1
NETWORK = "--network"  # of any command: open files on other computers that a project names

DESCRIPTION = """\
Drop motion clips onto stance, gesture, fidget and transition; the state machine draws itself.

Without a command the window opens. A project is a file ending in .metagraph.yaml."""

EXAMPLES = """\
examples:
  metagraph                                   open the window
  metagraph my.metagraph.yaml                 open a project in the window
  metagraph import my.metagraph.yaml clips/   add all clips of a folder (the project is made if need be)
  metagraph check my.metagraph.yaml           list what is wrong, and what to do about it
  metagraph verify my.metagraph.yaml          compare all files with their digests; game/ for an export
  metagraph plan my.metagraph.yaml -s 20      print a performance of 20 seconds
  metagraph render my.metagraph.yaml -o show.mp4 -s 20
  metagraph annotate my.metagraph.yaml talk.eaf --learn
  metagraph export my.metagraph.yaml -o game/
  metagraph mimic my.metagraph.yaml keypoints.json -o show.mp4
  metagraph speech talk.wav --words talk.TextGrid -o talk.eaf
  metagraph live my.metagraph.yaml            play, and do what agents ask
  metagraph study report my-study/            what a timing study found

files on other computers (\\\\server\\share) that a project or a study names are opened only with --network

exit codes: 0 done, 1 an error, 2 wrong usage, 3 done but with problems"""


# Commands by name: the module that adds their options and runs them, whether they take a project first, and
# what they do.
COMMANDS: dict[str, tuple[str, bool, str]] = {
    "window": ("window_command", False, "open the window"),
    "import": ("import_command", True, "add clips to a project, and make the project if it does not exist"),
    "label": (
        "label_command",
        False,
        "label the clips of a folder by their names and motion, and explain each label",
    ),
    "check": ("check_command", True, "list the problems of a project"),
    "verify": (
        "verify_command",
        False,
        "check that the files of a project or an export are intact, and list those that are not",
    ),
    "merge": (
        "merge_command",
        False,
        "merge two people's changes to copies of a project; Git's merge driver",
    ),
    "contacts": (
        "contacts_command",
        True,
        "find where hands touch the body, and write these contacts into the project",
    ),
    "behaviour": (
        "behaviour_command",
        True,
        "count what the character does by itself in an hour, and compare it with people",
    ),
    "plan": ("plan_command", True, "plan a performance and print its actions"),
    "render": (
        "render_command",
        True,
        "draw a performance, or one clip: a contact sheet (.png), a video (.mp4), or motion (.glb, .usda, "
        ".npz, .bvh)",
    ),
    "annotate": (
        "annotate_command",
        True,
        "learn from an ELAN annotation which action follows which, or perform it",
    ),
    "export": (
        "export_command",
        False,
        "export for an engine: the graph for a runtime, or the engine's own format",
    ),
    "live": ("live_command", True, "play, and take requests from programs: JSON lines, WebSocket, OSC"),
    "author": (
        "author_command",
        True,
        "let a language model label, edit, check and export a project, by the Model Context Protocol",
    ),
    "mimic": (
        "mimic_command",
        True,
        "recognise stances in a person's keypoints, and let the character mimic them",
    ),
    "speech": ("speech_command", False, "read a conversation into clauses, responses and hesitations"),
    "moods": ("moods_command", True, "show or set the moods of a character and its lines"),
    "study": (
        "study_command",
        False,
        "measure how fast people work: reports, data for other tools, simulated studies",
    ),
    "motion-graph": (
        "motion_graph_command",
        False,
        "build motion graphs from long takes, make motion for speech, and evaluate it",
    ),
    "generate": (
        "generate_command",
        False,
        "generate motion for conversations with learned models: train, sample, evaluate",
    ),
    "reproduce": (
        "reproduce_command",
        False,
        "make the papers' tables and figures again, next to the published ones",
    ),
    "extras": ("extras_command", False, "list, add and remove what is installed only when it is needed"),
    "doctor": ("doctor_command", False, "report what this computer has of what Metagraph needs"),
    "info": ("info_command", False, "describe a project, an export or a clip file"),
    "demo": (
        "demo_command",
        False,
        "make a performance, pictures, a video and an export of the sample project, without a window",
    ),
}
GROUPS = ("study", "motion-graph", "generate")  # their own commands take --json


def _parser(chosen: str) -> argparse.ArgumentParser:
    """Return the parser of all commands, with the options of the chosen one alone: the others' modules are
    not imported.
    """
    started = quote_command(list_program_words())
    parser = argparse.ArgumentParser(
        prog=started,
        description=DESCRIPTION,
        epilog=EXAMPLES.replace("  metagraph ", f"  {started} "),
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--version", action="version", version=f"metagraph {__version__}")
    commands = parser.add_subparsers(dest="command", metavar="command")
    for name, (_, project, words) in COMMANDS.items():
        command = commands.add_parser(name, help=words, description=words[:1].upper() + words[1:] + ".")
        if name != chosen:
            continue
        if project:
            command.add_argument("project", type=Path, help="the project file")
        if name not in GROUPS:
            command.add_argument("--json", action="store_true", help="print JSON for programs")
        _module(name).add_arguments(command)
        offer_overwrite(command, name)
    return parser


def _module(name: str) -> Any:
    return import_module(f"app.cli.{COMMANDS[name][0]}")


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a command line; return the exit code. Wrong usage and --help raise SystemExit, as argparse does."""
    leave_working_folder()
    # Before NumPy is there. Its threads only wait for each other in a small model's sums; what is large
    # shares its blocks among threads itself.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    given = list(sys.argv[1:] if arguments is None else arguments)
    try:
        return _run(given)
    except ImportError as error:
        if words := describe_missing_library(error):
            return _fail("--json" in given, words)
        raise


def _run(given: list[str]) -> int:
    allow(NETWORK in given)
    given = [word for word in given if word != NETWORK]
    parser = _parser(given[0] if given else "window")
    if not given or given[0] not in (*COMMANDS, "-h", "--help", "--version"):
        if given and not given[0].startswith("-") and "." not in given[0] and not Path(given[0]).exists():
            near = get_close_matches(given[0], COMMANDS, 1)
            hint = f"did you mean '{near[0]}'?" if near else f"the commands are {', '.join(COMMANDS)}"
            parser.error(f"'{given[0]}' is neither a command nor a project; {hint}")
        given = ["window", *given]
        parser = _parser("window")
    options = parser.parse_args(given)
    from metagraph.errors import FileError
    from metagraph.formats.outputs import check_outputs

    try:
        with check_outputs(claim_outputs(options)):
            return int(_module(options.command).run(options))
    except BrokenPipeError:  # whoever read our words has read enough
        sys.stdout = None  # nothing is left to flush
        return 0
    except (FileError, ValueError, RuntimeError) as error:
        return _fail(options.json, str(error))
    except OSError as error:
        place = f"{error.filename}: " if error.filename else ""
        return _fail(
            options.json,
            f"{place}{error.strerror or error}. Choose another place, or check that you may write there.",
        )
    except MemoryError:
        return _fail(options.json, "there is not enough memory for this")
    except KeyboardInterrupt:
        return _fail(options.json, "stopped")


def _fail(as_json: bool, words: str) -> int:
    if as_json:
        print(json.dumps({"error": words}))
    else:
        print(f"metagraph: {words}", file=sys.stderr)
    return ERROR
