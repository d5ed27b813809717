"""Exporting without a window: for a target, again whenever the project is saved, with vectors."""

from __future__ import annotations

import sys
import time
from argparse import ArgumentParser, Namespace
from pathlib import Path
from typing import Any

from app.cli.command_output import open_for_command, run_until_stopped, say
from metagraph.common.files import is_inside
from metagraph.engines.export_error import ExportError
from metagraph.errors import FileError

LOOK = 0.3  # seconds between two looks at the project file
SHOWN = 8  # files named on the screen


def add_arguments(parser: ArgumentParser) -> None:
    """Add the options."""
    parser.add_argument("project", type=Path, nargs="?", help="the project file")
    parser.add_argument("-o", "--out", type=Path, help="the folder to write into")
    parser.add_argument(
        "-t",
        "--target",
        default="metagraph",
        help="the engine or format to write for (default: metagraph, one JSON and one GLB)",
    )
    parser.add_argument("--targets", action="store_true", help="list the targets")
    parser.add_argument(
        "--watch", action="store_true", help="keep running, and export again whenever the project is saved"
    )
    parser.add_argument(
        "--serve",
        action="store_true",
        help="keep running, and serve the web page to a browser on this computer",
    )
    parser.add_argument("--vectors", action="store_true", help="also write conformance vectors for runtimes")
    parser.add_argument(
        "--tools", action="store_true", help="also write the requests as tools for a language model"
    )
    parser.add_argument(
        "--expanded", action="store_true", help="also write the expanded state machine into the JSON"
    )
    parser.add_argument(
        "--compress",
        action="store_true",
        help="compress the GLB with EXT_meshopt_compression: half the size, for runtimes and viewers "
        "that support it; the targets web and javascript do so by themselves",
    )
    parser.add_argument(
        "--no-compress", action="store_true", help="do not compress the GLB, for other viewers of it"
    )
    parser.add_argument(
        "--pretty",
        action="store_true",
        help="break and indent the JSON, for people and for comparing versions; more than twice the size",
    )
    parser.add_argument(
        "--overwrite",
        action="store_true",
        help="also replace files of another export, or files that Metagraph did not write",
    )
    parser.add_argument(
        "--sounds",
        type=Path,
        action="append",
        default=[],
        metavar="FOLDER",
        help="also copy sounds of lines from this folder outside the project's folder",
    )
    parser.add_argument("--no-mesh", action="store_true", help="write the GLB without the character's mesh")


def run(options: Namespace) -> int:
    """Write a project for a target; with `watch` and `serve` keep running until the user stops it."""
    from metagraph.engines.targets import registry

    if options.targets:
        for target in registry.list_targets().values():
            print(
                f"{target.name:18} {target.title}: "
                f"{target.files}{' (experimental)' if target.untried else ''}"
            )
        return 0
    if options.project is None or options.out is None:
        from app.typed_command import list_program_words, quote_command

        print(
            "metagraph export: give a project and a folder, such as: "
            f"{quote_command(list_program_words())} export my.metagraph.yaml -o game/",
            file=sys.stderr,
        )
        return 2
    registry.get_target(options.target)  # a wrong name is reported before anything is read
    if options.vectors:
        from metagraph.engines.vectors import NAME
        from metagraph.formats.outputs import claim

        claim(options.out / NAME)
    if options.serve and options.target != "web":
        print("metagraph export: --serve needs --target web", file=sys.stderr)
        return 2
    if not (options.watch or options.serve):
        _once(options)
        return 0
    with run_until_stopped():
        _go_on(options)
    print("stopped", file=sys.stderr)
    return 0


def _go_on(options: Namespace) -> None:
    """Export and go on: serving, watching, or both."""
    from metagraph.engines.serve import Served

    if not options.watch:
        _once(options)
    if options.serve:
        options.out.mkdir(parents=True, exist_ok=True)
        print(f"the page is at {Served(options.out).url} (stop with Ctrl+C)", file=sys.stderr, flush=True)
    if options.watch:
        _watch(options)
    while True:
        time.sleep(3600)


def _watch(options: Namespace) -> None:
    """Export, and export again after each save. An error is printed, and the next save is tried."""
    seen: tuple[int, int] | None = None
    while True:
        now = _state(options.project)
        if now is not None and now != seen:
            seen = now
            try:
                _once(options)
            except (FileError, ExportError) as error:
                print(f"error: {error}", file=sys.stderr, flush=True)
        time.sleep(LOOK)


def _state(path: Path) -> tuple[int, int] | None:
    """Return what changes when a file is saved; None while it is not there, as in the middle of saving."""
    try:
        found = path.stat()
    except OSError:
        return None
    return found.st_mtime_ns, found.st_size


def _once(options: Namespace) -> None:
    from metagraph.engines.targets import registry
    from metagraph.engines.targets.target import Contents
    from metagraph.graph.manual.meta import make_exportable

    project, differences = make_exportable(open_for_command(options.project))
    character = (
        options.project.resolve().parent / project.character
        if project.character and not options.no_mesh
        else None
    )
    if options.tools:
        from metagraph.engines.export import make_export_stem
        from metagraph.engines.tools_file import name_tools_file
        from metagraph.formats.outputs import claim

        claim(options.out / name_tools_file(make_export_stem(project)))
    contents = Contents(
        character,
        options.expanded,
        options.project.resolve().parent,
        lambda p: any(is_inside(p, x) for x in options.sounds),
        options.compress or (registry.get_target(options.target).packs and not options.no_compress),
        options.pretty,
    )
    made = registry.write_for_target(
        project, options.target, options.out, contents, overwrite=options.overwrite
    )
    files = list(made.files)
    if options.tools:
        from metagraph.engines.tools_file import write_tools

        files.append(write_tools(project, options.out))
    if options.vectors:
        from metagraph.engines.vectors import write_vectors

        graph = next(
            (path for path in files if path.suffix == ".json" and path.with_suffix(".glb") in files), None
        )
        if graph is None:
            print(
                f"note: target '{options.target}' has no runtime, so there are no vectors for it",
                file=sys.stderr,
            )
        else:
            files.append(write_vectors(graph))
    for warning in made.warnings:
        print(f"warning: {warning}", file=sys.stderr)
    untried = registry.get_target(options.target).untried
    if untried:
        print(f"experimental: {untried}", file=sys.stderr)
    for words in differences:
        print(f"differs: {words}", file=sys.stderr)
    for loss in made.losses:
        print(f"loses: {loss}", file=sys.stderr)
    for number, step in enumerate(made.steps, 1):
        print(f"next {number}: {step}", file=sys.stderr)
    data: dict[str, Any] = {
        **{path.suffix[1:]: str(path) for path in made.files[:2] if made.target == registry.DEFAULT},
        "target": made.target,
        "files": [str(path) for path in files],
        "clips": made.clips,
        "losses": list(made.losses),
        "next": list(made.steps),
        **({"differences": differences} if differences else {}),
        "warnings": list(made.warnings),
    }
    shown = (
        data["files"]
        if len(files) <= SHOWN
        else [*data["files"][: SHOWN - 1], f"... and {len(files) - SHOWN + 1} more in {options.out}"]
    )
    say(options, "\n".join(shown), data)
    sys.stdout.flush()
