"""The character's mesh as targets write it."""

from __future__ import annotations

from metagraph.engines.export import place_mesh_on
from metagraph.engines.targets.target import ExportOrder
from metagraph.motion.character_mesh import CharacterMesh


def find_ordered_mesh(order: ExportOrder) -> tuple[CharacterMesh | None, tuple[str, ...]]:
    """Return the mesh that goes with an order, and what there is to say about it. Raises FileError."""
    body, notes = place_mesh_on(order.project, order.contents.character)
    return body, tuple(notes)
