"""Add the option of the language to commands that read words."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:  # reading a command line must not wait for arrays
    from metagraph.formats.conversations.languages import Speaking


def add_language_arguments(parser: ArgumentParser, usual: str = "auto") -> None:
    """Add the options. usual: what is said of the default."""
    parser.add_argument(
        "--language",
        metavar="CODE",
        help="the spoken language, to identify responses and hesitations: en, de, fr, es, it, pt, "
        f"nl, ja, zh, hi, or auto to detect it (default: {usual})",
    )
    parser.add_argument(
        "--words-list",
        type=Path,
        action="append",
        default=[],
        metavar="FILE",
        help="your own word list, YAML or JSON; it is the language unless --language names one; repeat "
        "for more",
    )


def read_speaking(options: Namespace, project: str = "auto") -> Speaking:
    """Return what to read words by. project: what the project is set to. Raises FileError, ValueError."""
    from metagraph.formats.conversations.languages import Speaking
    from metagraph.formats.language_files import gather_packs, read_pack
    from metagraph.graph.conversation.model import AUTO

    packs = gather_packs(options.words_list)
    asked: str | None = options.language
    if asked is not None:
        asked = asked.casefold()
    elif len(options.words_list) == 1:
        asked = read_pack(options.words_list[0]).code
    elif project in packs:
        asked = project
    return Speaking(asked or AUTO, project, packs)
