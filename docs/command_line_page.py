"""Write the pages of commands from the argument parsers: `python docs/command_line_page.py`."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))
REFERENCE = ROOT / "docs" / "reference"
# Pages of commands for research, by name: the command, the page's title, and what the command is for.
GROUPS = {
    "command-line-study": ("study", "Commands for studies", "studies of how fast people work"),
    "command-line-perceive": (
        "study perceive",
        "Commands for perceptual studies",
        "studies of what viewers see and prefer",
    ),
    "command-line-motion-graph": (
        "motion-graph",
        "Commands for motion graphs",
        "motion graphs from long takes",
    ),
    "command-line-generate": ("generate", "Commands for learned models", "learned models of conversations"),
}
RESEARCH = ("study", "motion-graph", "generate", "reproduce")
WORK = """# Commands

After this page you know every command and option of `metagraph`, except those [for
research](command-line-research.md).

[Command line by example](command-line-examples.md) shows commands at work, and the rules that all of them
keep. `metagraph COMMAND --help` prints the same.
"""
STUDIES = """# Commands for research

After this page you know which commands there are for studies, motion graphs, learned models and the papers'
tables, and where their options are listed.

[Command line by example](command-line-examples.md) shows commands at work. The other commands have
[their own page](command-line.md).
"""


def pages() -> Mapping[Path, str]:
    """Return the pages by file."""
    from app.cli.parser import COMMANDS

    work = [name for name in COMMANDS if name not in RESEARCH]
    alone = [name for name in RESEARCH if name not in _own_pages()]
    out = {
        "command-line": [WORK, *_contents(work), *(_section(name) for name in work)],
        "command-line-research": [STUDIES, *_contents(RESEARCH), *(_section(name) for name in alone)],
        **{page: [*_head(page), _section(GROUPS[page][0])] for page in GROUPS},
    }
    return {REFERENCE / f"{page}.md": "\n".join(parts) for page, parts in out.items()}


def _own_pages() -> dict[str, str]:
    """Return the pages of commands that have one of their own, by the command."""
    return {command: page for page, (command, _, _) in GROUPS.items()}


def _head(page: str) -> Iterator[str]:
    """Yield how the page of one command begins."""
    command, title, about = GROUPS[page]
    yield f"# {title}\n"
    yield f"After this page you know every option of `metagraph {command}`, for {about}.\n"
    yield "[Commands for research](command-line-research.md) lists the other commands for research.\n"


def _contents(names: Sequence[str]) -> Iterator[str]:
    """Yield a table of commands, each with a link to where its options are."""
    from app.cli.parser import COMMANDS

    own = _own_pages()
    places = {name: f"{own[name]}.md" if name in own else f"#metagraph-{name}" for name in names}
    rows = "".join(f"| [`{n}`]({place}) | {_cell(COMMANDS[n][2])} |\n" for n, place in places.items())
    yield f"| Command | What it does |\n|---|---|\n{rows}"


def _section(command: str) -> str:
    """Return the section of a command, such as "study perceive", and of its own commands."""
    from app.cli.parser import _parser

    parser = _parser(command.split()[0])
    for word in command.split():
        parser = _choices(parser)[word]
    return "\n".join(_sections(parser, 2))


def _sections(parser: argparse.ArgumentParser, depth: int) -> Iterator[str]:
    inner = _choices(parser)
    said = " ".join((parser.description or "").split())
    yield f"{'#' * depth} {parser.prog}\n\n{_escaped(said)}\n"
    rows = "".join(_row(parser, action) for action in parser._actions if _shown(action))
    if rows:
        yield f"| Option | What it does |\n|---|---|\n{rows}"
    for name, action in inner.items():
        page = _own_pages().get(f"{parser.prog} {name}".removeprefix("metagraph "))
        if page is None:
            yield from _sections(action, depth + 1)
        else:
            said = _escaped(" ".join((action.description or "").split()))
            yield f"{'#' * (depth + 1)} {action.prog}\n\n{said}\n\nSee [its own page]({page}.md).\n"


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
