"""The `metagraph` command: the window by default, and the same work without one."""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Sequence
from difflib import get_close_matches
from pathlib import Path
from typing import Any

from app.cli.label_command import arguments as label_arguments
from app.cli.live_command import arguments as live_arguments
from app.cli.mimic_command import arguments as mimic_arguments
from app.cli.motion_graph_command import arguments as motion_graph_arguments
from app.cli.speech_command import arguments as speech_arguments
from app.cli.study_command import arguments as study_arguments
from metagraph import __version__

ERROR = 1

DESCRIPTION = """\
Drop motion clips onto stance, gesture, fidget and transition; the state machine draws itself.

Without a command the window opens. A project is a file ending in .metagraph.yaml."""

EXAMPLES = """\
examples:
  metagraph                                   open the window
  metagraph my.metagraph.yaml                 open a project in the window
  metagraph import my.metagraph.yaml clips/   add all clips of a folder (the project is made if need be)
  metagraph check my.metagraph.yaml           list what is wrong, and what to do about it
  metagraph plan my.metagraph.yaml -s 20      print a performance of 20 seconds
  metagraph render my.metagraph.yaml -o show.mp4 -s 20
  metagraph annotate my.metagraph.yaml talk.eaf --learn
  metagraph export my.metagraph.yaml -o game/
  metagraph mimic my.metagraph.yaml keypoints.json -o show.mp4
  metagraph speech talk.wav --words talk.TextGrid -o talk.eaf
  metagraph live my.metagraph.yaml            play, and do what agents ask
  metagraph study report my-study/            what a timing study found

exit codes: 0 done, 1 an error, 2 wrong usage, 3 done but with problems"""


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="metagraph", description=DESCRIPTION, epilog=EXAMPLES, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--version", action="version", version=f"metagraph {__version__}")
    commands = parser.add_subparsers(dest="command", metavar="command")

    def command(name: str, words: str, project: bool = True) -> argparse.ArgumentParser:
        out = commands.add_parser(name, help=words, description=words[:1].upper() + words[1:] + ".")
        if project:
            out.add_argument("project", type=Path, help="the project file")
        out.add_argument("--json", action="store_true", help="print what a program can read")
        return out

    window = command("window", "open the window", project=False)
    window.add_argument("project", type=Path, nargs="?", help="a project file")
    window.add_argument("--sample", action="store_true", help="open the sample project")
    clips = command("import", "add clips to a project, made if it is not there")
    clips.add_argument("paths", type=Path, nargs="+", help="clip files and folders: BVH, GLB, glTF, VRM animation, FBX")
    clips.add_argument("--retarget", action="store_true", help="bring clips of other skeletons onto the project's")
    checked = command("check", "list the problems of a project")
    checked.add_argument("--strict", action="store_true", help="warnings count as problems for the exit code, too")
    label_arguments(command("label", "label the clips of a folder by their names and motion, and say why", project=False))
    planned = command("plan", "plan a performance and print its actions")
    _performance(planned, 20.0)
    rendered = command("render", "draw a performance, or one clip: a contact sheet (.png), a video (.mp4), or plain motion (.glb, .bvh)")
    _performance(rendered, 10.0)
    rendered.add_argument("-o", "--out", type=Path, required=True, help="a .png, .mp4, .glb or .bvh file")
    rendered.add_argument("--progress", action="store_true", help="tell after each picture of a video how many there are")
    rendered.add_argument("--clip", help="draw this clip of the project alone")
    rendered.add_argument("--conversation", metavar="NAME", help="draw both sides of this conversation, with their sound")
    rendered.add_argument("--size", default="960x540", help="width x height in pixels (default: 960x540)")
    rendered.add_argument("--fps", type=float, default=30.0, help="pictures a second of a video (default: 30)")
    rendered.add_argument("--frames", type=int, default=24, help="pictures on a contact sheet (default: 24)")
    rendered.add_argument("--theme", choices=("dark", "light"), default="dark")
    exported = command("export", "write what an engine plays: the graph for a runtime, or an engine's own format", project=False)
    exported.add_argument("project", type=Path, nargs="?", help="the project file")
    exported.add_argument("-o", "--out", type=Path, help="a folder")
    exported.add_argument("-t", "--target", default="metagraph", help="what to write for (default: metagraph, one JSON and one GLB)")
    exported.add_argument("--targets", action="store_true", help="list the targets there are")
    exported.add_argument("--watch", action="store_true", help="go on, and write again whenever the project is saved")
    exported.add_argument("--serve", action="store_true", help="go on, and show the web page to this machine's browser")
    exported.add_argument("--vectors", action="store_true", help="write conformance vectors for runtimes as well")
    exported.add_argument("--expanded", action="store_true", help="list the expanded state machine in the JSON as well")
    exported.add_argument("--no-mesh", action="store_true", help="leave the character's mesh out of the GLB")
    annotated = command("annotate", "learn from an ELAN annotation what follows what, or perform it")
    annotated.add_argument("annotation", type=Path, help="an .eaf file")
    annotated.add_argument("--tier", action="append", default=[], metavar="NAME=ROLE",
                           help="what a tier stands for: left arm, right arm, arms, head action, head stance, body, ignore")  # fmt: skip
    annotated.add_argument("--label", action="append", default=[], metavar="LABEL=MEANING",
                           help='what a label means: gesture, fidget, transition, ignore ..., then tags ("gesture positive")')  # fmt: skip
    meaning = annotated.add_mutually_exclusive_group()
    meaning.add_argument("--states", action="store_true", help="positive and negative gestures are states of their own")
    meaning.add_argument("--shares", action="store_true", help="they are shares of all gestures (the default)")
    annotated.add_argument("--smoothing", type=float, default=0.0, help="added to every count (default: 0, as in the paper)")
    annotated.add_argument("--learn", action="store_true", help="learn the models of all layers that were annotated")
    annotated.add_argument("--perform", metavar="NAME", help="keep it as a performance")
    played = command("live", "play, and listen to what programs ask: JSON lines, WebSocket, OSC")
    live_arguments(played)
    mimicked = command("mimic", "tell what stances a person's keypoints show, and let the character do as they do")
    mimic_arguments(mimicked)
    speech_arguments(command("speech", "read a conversation of two into clauses, responses and hesitations", project=False))
    words = "time people at work: reports, data for other tools, simulated studies"
    study_arguments(commands.add_parser("study", help=words, description=words[:1].upper() + words[1:] + "."))
    words = "graphs over the frames of long takes, motion that goes with speech, and how well that works"
    motion_graph_arguments(commands.add_parser("motion-graph", help=words, description=words[:1].upper() + words[1:] + "."))
    info = command("info", "tell what is in a project, an export or a clip file", project=False)
    info.add_argument("path", type=Path, help="a project, an exported JSON, or a clip file")
    demo = command("demo", "the main job without a window: sample project to performance, pictures, video and export", project=False)
    demo.add_argument("-o", "--out", type=Path, default=Path("out"), help="a folder (default: out)")
    _performance(demo, 60.0)
    return parser


def _performance(parser: argparse.ArgumentParser, seconds: float) -> None:
    parser.add_argument("-s", "--seconds", type=float, help=f"length of the performance (default: its own, else {seconds:g})")
    parser.set_defaults(usual_seconds=seconds)
    parser.add_argument("--performance", metavar="NAME", help="a performance that is kept in the project (default: improvise)")
    parser.add_argument("--seed", type=int, help="another performance of the same project (default: the project's seed)")


COMMANDS = (
    "window", "import", "label", "check", "plan", "render", "annotate", "export", "live", "mimic", "speech", "study", "motion-graph",
    "info", "demo",
)  # fmt: skip


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a command line; return the exit code. Wrong usage and --help raise SystemExit, as argparse does."""
    given = list(sys.argv[1:] if arguments is None else arguments)
    parser = _parser()
    if not given or given[0] not in (*COMMANDS, "-h", "--help", "--version"):
        if given and not given[0].startswith("-") and "." not in given[0] and not Path(given[0]).exists():
            near = get_close_matches(given[0], COMMANDS, 1)
            hint = f"did you mean '{near[0]}'?" if near else f"the commands are {', '.join(COMMANDS)}"
            parser.error(f"there is no command and no project '{given[0]}'; {hint}")
        given = ["window", *given]
    options = parser.parse_args(given)
    from metagraph.errors import FileError

    try:
        from app.cli import basic_commands as headless

        run: Any = getattr(headless, {"import": "import_clips"}.get(options.command, options.command.replace("-", "_")))
        return int(run(options))
    except BrokenPipeError:  # whoever read our words has read enough
        sys.stdout = None  # type: ignore[assignment]  # nothing is left to flush
        return 0
    except (FileError, ValueError, RuntimeError) as error:
        return _fail(options, str(error))
    except OSError as error:
        place = f"{error.filename}: " if error.filename else ""
        return _fail(options, f"{place}{error.strerror or error}. Choose another place, or see whether you may write there.")
    except MemoryError:
        return _fail(options, "there is not enough memory for that")
    except KeyboardInterrupt:
        return _fail(options, "stopped")


def _fail(options: argparse.Namespace, words: str) -> int:
    if options.json:
        print(json.dumps({"error": words}))
    else:
        print(f"metagraph: {words}", file=sys.stderr)
    return ERROR
