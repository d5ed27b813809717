"""Pointing transitions at another stance: what letting the head of an arrow go on a stance's chip does."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from app.features.graph.graph_drops import Drop
from app.features.graph.graph_layout import GraphHit
from app.translation import tr, tr_error, tr_plural
from metagraph.graph import edits
from metagraph.graph.edit_error import EditError
from metagraph.graph.model import Project

if TYPE_CHECKING:
    pass

NOWHERE = GraphHit("nothing")


def repoint_at(project: Project, actions: Sequence[str], hit: GraphHit) -> Drop:
    """Return what letting the heads of transitions go on `hit` does."""
    stance = project.stance(hit.ident) if hit.area == "chip" else None
    if stance is None:
        return Drop(False, tr("drop the arrow on a stance"))
    chosen = [a for i in actions if (a := project.action(i)) is not None and a.kind == "transition"]
    if all(a.end_stance == stance.id for a in chosen):
        return Drop(False, tr("already ends in *{name}*", name=stance.name), "transition", None, stance.id)
    try:
        edits.set_ends(project, actions, stance.id)
    except EditError as error:
        return Drop(False, tr_error(error), "transition", None, stance.id)
    words = tr_plural(
        "release to end {count:,} transition in *{name}*",
        "release to end {count:,} transitions in *{name}*",
        len(chosen),
        name=stance.name,
    )
    return Drop(True, words, "transition", None, stance.id)
