"""Write the requests to a character as tools for a language model, in a file beside the export."""

from __future__ import annotations

from pathlib import Path

import msgspec

from metagraph.engines.export import make_export_stem
from metagraph.formats.atomic import write_atomically
from metagraph.graph.model import Project
from metagraph.graph.offered import list_tools


def name_tools_file(stem: str) -> str:
    """Return the name of the tools file beside an export of this name."""
    return f"{stem}.tools.json"


def write_tools(project: Project, folder: Path) -> Path:
    """Write `offered.list_tools` as JSON into a folder; return the file. Raises FileError if it cannot
    be written.
    """
    path = folder / name_tools_file(make_export_stem(project))
    write_atomically(path, msgspec.json.format(msgspec.json.encode(list_tools(project)), indent=1))
    return path
