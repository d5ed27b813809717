"""What may be asked of a character as tools for a language model, in a file beside its export."""

from __future__ import annotations

from pathlib import Path

import msgspec

from metagraph.engines.export import stem_of
from metagraph.formats.atomic import write_atomically
from metagraph.graph.model import Project
from metagraph.graph.offered import tools


def tools_name(stem: str) -> str:
    """Return what the file is called beside an export that is called so."""
    return f"{stem}.tools.json"


def write_tools(project: Project, folder: Path) -> Path:
    """Write `offered.tools` as JSON into a folder; return the file. Raises FileError if it cannot
    be written.
    """
    path = folder / tools_name(stem_of(project))
    write_atomically(path, msgspec.json.format(msgspec.json.encode(tools(project)), indent=1))
    return path
