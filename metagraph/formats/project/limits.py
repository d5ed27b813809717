"""Edits held to what the readers of project files take: what cannot be opened cannot be made."""

from __future__ import annotations

from metagraph.formats.project.data import FORMAT, from_data
from metagraph.formats.project.fields import Data, DataError
from metagraph.formats.project.journal import KEYED, find_changes
from metagraph.formats.project.manual_data import make_manual_data
from metagraph.graph.model import Project


def find_unwritable(before: Project, after: Project) -> str | None:
    """Return why a project file could not hold what an edit has changed, in words; None when it can. Costs
    what the edit is large.
    """
    try:
        change = find_changes(before, after)
        if change:
            from_data(_part(change, after))
    except DataError as error:
        return f"{error.where.removeprefix('layers.')} {error}".strip()
    return None


def _part(change: Data, after: Project) -> Data:
    """Return what was changed as a project of its own."""
    part: Data = {"metagraph": FORMAT, **_listed(change)}
    part["layers"] = {layer: _listed(some) for layer, some in change.get("layers", {}).items()}
    if "manual" in change:
        part["manual"] = {layer: make_manual_data(machine) for layer, machine in after.manual.items()}
    return part


def _listed(change: Data) -> Data:
    out: Data = {}
    for key, value in change.items():
        if key in KEYED:
            out[key] = [item for item in value.values() if item is not None]
        elif not key.endswith(("_order", "_after")):
            out[key] = value
    return out
