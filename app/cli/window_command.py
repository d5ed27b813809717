"""`metagraph window`: the window, on a project if one is given. Without a screen, the demo runs instead."""

from __future__ import annotations

import os
import sys
from argparse import ArgumentParser, Namespace
from pathlib import Path

from app.project.given_files import sort_paths
from metagraph.errors import FileError


def add_arguments(parser: ArgumentParser) -> None:
    """Add the options."""
    parser.add_argument(
        "paths", type=Path, nargs="*", metavar="project", help="the project to open, or clips for a new one"
    )
    parser.add_argument("--sample", action="store_true", help="open the sample project")
    parser.add_argument("--clip", metavar="NAME", help="select this clip of the project, and play it")


def has_screen() -> bool:
    """Return whether a window can be shown."""
    return not sys.platform.startswith("linux") or bool(
        os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")
    )


def run(options: Namespace) -> int:
    project, clips = sort_paths(options.paths)
    if not has_screen() and os.environ.get("QT_QPA_PLATFORM") is None:
        if clips:
            from app.typed_command import list_program_words, quote_command

            command = quote_command([*list_program_words(), "label", str(clips[0])])
            raise FileError(
                clips[0],
                "there is no screen to open a window on",
                "while opening it",
                f"Label clips without a window: {command}",
            )
        if not options.json:
            print("There is no screen, so Metagraph runs the demo without a window.\n")
        from app.cli import demo_command

        parser = ArgumentParser()
        demo_command.add_arguments(parser)
        wanted = Namespace(json=options.json, project=project)
        return demo_command.run(parser.parse_args([], wanted))
    from app.main import run_window
    from app.project.second_start import StartRequest, send_start_request
    from metagraph.formats.outputs import allow_all_outputs

    given = tuple(str(path.resolve()) for path in options.paths)
    token = os.environ.get("XDG_ACTIVATION_TOKEN", "")
    if send_start_request(StartRequest(given, options.sample, options.clip, token)):
        return 0
    with allow_all_outputs():  # what it saves to, it has read
        return run_window(project, options.sample, options.clip, clips)
