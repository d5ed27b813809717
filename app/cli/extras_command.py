"""`metagraph extras`: lists, installs and removes what a bundle does not bring along."""

from __future__ import annotations

import sys
from argparse import ArgumentParser, Namespace

from app.cli.command_output import say
from metagraph.common.extras import EXTRAS, ExtraError, install_extra, is_installed, remove_extra


def add_arguments(parser: ArgumentParser) -> None:
    """Add the options."""
    parser.add_argument("action", nargs="?", choices=("list", "add", "remove"), default="list")
    parser.add_argument("name", nargs="?", choices=tuple(EXTRAS), help="the extra to add or to remove")


def run(options: Namespace) -> int:
    """List extras, or add or remove one."""
    if options.action != "list" and options.name is None:
        raise ValueError(f"name the extra: {', '.join(EXTRAS)}")
    if options.action == "add":
        print(f"installing {options.name} (about {EXTRAS[options.name].megabytes} MB) ...", file=sys.stderr)
        try:
            install_extra(options.name)
        except ExtraError as error:
            print(f"metagraph: {error}", file=sys.stderr)
            return 1
    elif options.action == "remove" and not remove_extra(options.name):
        print(f"metagraph: {options.name} was not installed by Metagraph", file=sys.stderr)
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
