"""`metagraph extras`: lists, installs and removes what a bundle does not bring along."""

from __future__ import annotations

import sys
from argparse import ArgumentParser, Namespace
from pathlib import Path

from app.cli.command_output import say
from metagraph.common.extra_steps import ExtraError, install_extra, remove_extra
from metagraph.common.extras import EXTRAS, is_installed, make_download_command


def add_arguments(parser: ArgumentParser) -> None:
    """Add the options."""
    parser.add_argument("action", nargs="?", choices=("list", "add", "remove"), default="list")
    parser.add_argument("name", nargs="?", choices=tuple(EXTRAS), help="the extra to add or to remove")
    parser.add_argument(
        "--from",
        dest="folder",
        type=Path,
        metavar="FOLDER",
        help="a folder of files to add it from, without a network",
    )


def run(options: Namespace) -> int:
    """List extras, or add or remove one."""
    if options.action != "list" and options.name is None:
        raise ValueError(f"name the extra: {', '.join(EXTRAS)}")
    if options.folder is not None and not options.folder.is_dir():
        raise ValueError(
            f"there is no folder {options.folder}. Load it with: {make_download_command(options.name)}"
        )
    try:
        if options.action == "add":
            install_extra(options.name, _Teller(), folder=options.folder)
        elif options.action == "remove":
            size = remove_extra(options.name)
            if not size:
                print(f"metagraph: {options.name} was not installed by Metagraph", file=sys.stderr)
                return 1
            print(f"{size / 1e6:.0f} MB are free again", file=sys.stderr)
    except ExtraError as error:
        print(f"metagraph: {error}", file=sys.stderr)
        return 1
    rows = {name: is_installed(name) for name in EXTRAS}
    lines = [
        f"{name:9} {'installed' if rows[name] else 'missing':10} {extra.megabytes:4} MB  {extra.licence:13} "
        f"{extra.brings}"
        for name, extra in EXTRAS.items()
    ]
    data = {
        name: {"installed": rows[name], "megabytes": extra.megabytes, "licence": extra.licence}
        for name, extra in EXTRAS.items()
    }
    say(options, "\n".join(lines), data)
    return 0


class _Teller:
    """Prints what is done, each step once."""

    last = ""

    def __call__(self, share: float, words: str) -> None:
        if words != self.last:
            self.last = words
            print(words, file=sys.stderr)
