"""Write the pages of commands from the argument parsers: `python docs/command_line_page.py`."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))
REFERENCE = ROOT / "docs" / "reference"
RESEARCH = ("study", "motion-graph", "generate", "reproduce")
WORK = """# Commands

After this page you know every command and option of `metagraph`, except those [for
research](command-line-research.md).

[Command line by example](command-line-examples.md) shows commands at work, and the rules that all of them
keep. `metagraph COMMAND --help` prints the same.
"""
STUDIES = """# Commands for research

After this page you know every option of the commands for studies, motion graphs, learned models and the
papers' tables.

[Command line by example](command-line-examples.md) shows commands at work. The other commands have
[their own page](command-line.md).
"""


def pages() -> Mapping[Path, str]:
    """Return the pages by file."""
    from app.cli.parser import COMMANDS

    work = [name for name in COMMANDS if name not in RESEARCH]
    return {
        REFERENCE / "command-line.md": "\n".join([WORK, *_contents(work), *_commands(work)]),
        REFERENCE / "command-line-research.md": "\n".join(
            [STUDIES, *_contents(RESEARCH), *_commands(RESEARCH)]
        ),
    }


def _contents(names: Sequence[str]) -> Iterator[str]:
    """Yield a table of commands."""
    from app.cli.parser import COMMANDS

    rows = "".join(f"| [`{n}`](#metagraph-{n}) | {_cell(COMMANDS[n][2])} |\n" for n in names)
    yield f"| Command | What it does |\n|---|---|\n{rows}"


def _commands(names: Sequence[str]) -> Iterator[str]:
    """Yield the sections of commands and of their actions."""
    from app.cli.parser import _parser

    for name in names:
        yield from _sections(_choices(_parser(name))[name], 2)


def _sections(parser: argparse.ArgumentParser, depth: int) -> Iterator[str]:
    inner = _choices(parser)
    said = " ".join((parser.description or "").split())
    yield f"{'#' * depth} {parser.prog}\n\n{_escaped(said)}\n"
    rows = "".join(_row(parser, action) for action in parser._actions if _shown(action))
    if rows:
        yield f"| Option | What it does |\n|---|---|\n{rows}"
    for action in inner.values():
        yield from _sections(action, depth + 1)


def _choices(parser: argparse.ArgumentParser) -> Mapping[str, argparse.ArgumentParser]:
    """Return a command's own commands by name."""
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            return action.choices
    return {}


def _shown(action: argparse.Action) -> bool:
    return action.help != argparse.SUPPRESS and not isinstance(
        action, (argparse._SubParsersAction, argparse._HelpAction)
    )


def _row(parser: argparse.ArgumentParser, action: argparse.Action) -> str:
    formatter = argparse.HelpFormatter(parser.prog, width=10_000)
    value = formatter._format_args(action, formatter._get_default_metavar_for_optional(action))
    if action.option_strings:
        words = ", ".join(f"`{' '.join([o, value]).strip()}`" for o in action.option_strings)
    else:
        value = formatter._format_args(action, formatter._get_default_metavar_for_positional(action))
        words = f"`{value}`"
    words = words.replace("|", "\\|")
    return f"| {words} | {_cell(formatter._expand_help(action) if action.help else '')} |\n"


def _cell(text: str) -> str:
    return _escaped(" ".join(text.split())).replace("|", "\\|")


def _escaped(text: str) -> str:
    return text.replace("<", "\\<").replace("*", "\\*").replace("_", "\\_")


if __name__ == "__main__":
    for path, text in pages().items():
        path.write_text(text, encoding="utf-8")
