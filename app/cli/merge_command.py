"""`metagraph merge`: what two people did to copies of one project, in one. Also Git's merge driver."""

from __future__ import annotations

import os
import sys
from argparse import ArgumentParser, Namespace, RawDescriptionHelpFormatter
from pathlib import Path

from app.cli.command_output import say
from app.cli.outputs import ProjectOutput
from metagraph.common.wording import phrase
from metagraph.errors import FileError
from metagraph.formats.outputs import claim, note_written
from metagraph.formats.project.merging import MergeError, merge_projects
from metagraph.formats.store import SUFFIX, read_project
from metagraph.graph.model import Project


def add_arguments(parser: ArgumentParser) -> None:
    """Add the options."""
    parser.add_argument("base", nargs="?", type=Path, help="the project before either side changed it")
    parser.add_argument(
        "ours", nargs="?", type=Path, help="the project with our changes; the result is written here"
    )
    parser.add_argument("theirs", nargs="?", type=Path, help="the project with their changes")
    parser.add_argument(
        "--setup", action="store_true", help="print how to set up Metagraph as Git's merge driver"
    )
    parser.add_argument("-o", "--output", type=Path, help="write the result here, not over OURS")
    parser.add_argument(
        "--prefer",
        choices=("ours", "theirs"),
        default="ours",
        help="the side that wins where both changed the same value (default: ours)",
    )
    parser.add_argument("--name", help="the name of the project in messages (Git passes %%P)")
    parser.formatter_class = RawDescriptionHelpFormatter
    parser.epilog = f"with Git:\n{SETUP.format(driver='metagraph', suffix=SUFFIX)}"


SETUP = """\
Run this in each clone of the repository:
  git config merge.metagraph.driver '{driver} merge %O %A %B --name %P'
Put this into its .gitattributes, once for everybody:
  *{suffix} merge=metagraph
and this into its .gitignore:
  *{suffix}.[0-9]*
  .*{suffix}.*
  *.labels*.html"""


def run(options: Namespace) -> int:
    if options.setup:
        driver = f'"{find_program()}"'
        say(options, SETUP.format(driver=driver, suffix=SUFFIX), {"driver": driver})
        return 0
    if options.theirs is None:
        print("metagraph merge: give three projects: BASE OURS THEIRS", file=sys.stderr)
        return 2
    for given in (options.base, options.ours, options.theirs):
        if not given.exists():
            raise FileError(
                given,
                phrase("does not exist"),
                phrase("the project"),
                phrase("Give three projects: BASE OURS THEIRS."),
            )
    path = options.output or options.ours
    if not (path.exists() and path.samefile(options.ours)):
        claim(path)
    # What Git merges is a passing file of its own, and it keeps the versions itself.
    with ProjectOutput(path, 0 if options.name is not None else None) as output:
        code = _merged(options, output)
    if not path.samefile(options.ours):
        note_written(path)
    return code


def find_program() -> Path:
    """Return where the `metagraph` command is that belongs to this Python."""
    return Path(sys.executable).with_name("metagraph.exe" if os.name == "nt" else "metagraph")


def _merged(options: Namespace, output: ProjectOutput) -> int:
    base, ours, theirs = (_read(path) for path in (options.base, options.ours, options.theirs))
    name = options.name or options.ours.name
    sides = (phrase("in ours"), phrase("in theirs"))
    try:
        if options.prefer == "theirs":
            found = merge_projects(base, theirs, ours, sides[::-1])
        else:
            found = merge_projects(base, ours, theirs, sides)
    except MergeError as error:
        raise FileError(
            options.theirs,
            phrase("cannot be merged with ours: {error}", error=error),
            phrase("the project"),
            phrase("Open one of the two and import the other into it (File > Import > Import project)."),
        ) from None
    output.save(found.project)
    for line in found.kept:
        print(f"{name}: {line}", file=sys.stderr)
    count = len(found.kept)
    words = f"{name}: merged" + (f"; look at the {count} listed above" if count else "")
    say(options, words, {"output": str(output.path), "conflicts": list(map(str, found.kept))})
    return 3 if found.kept else 0


def _read(path: Path) -> Project:
    """Return a project; an empty one for an empty file, which Git gives where both sides added theirs."""
    try:
        if path.stat().st_size == 0:
            return Project()
    except OSError:
        pass  # the reader says why
    return read_project(path)
