"""What the canvas says: of what is under the pointer, and of the machine that was not drawn."""

from __future__ import annotations

from collections.abc import Mapping

from app.features.graph.graph_layout import GraphHit, Layout
from app.look.names import names_in_tooltip
from app.translation import tr, tr_plural
from metagraph.graph.expand import count_machine_size
from metagraph.graph.model import LAYERS, Project


def describe_graph_hit(
    project: Project, layout: Layout, hit: GraphHit, other: str | None, misfits: Mapping[str, str]
) -> str:
    """Say what is under the pointer. other: the stance that dropped transitions end in. misfits: what is
    wrong with the ends of actions.
    """
    action = project.action(hit.ident) if hit.ident else None
    if hit.area == "bar" and action is not None:
        return tr("Likelihood {likelihood:g}: drag to change", likelihood=action.likelihood)
    if action is not None:
        row = layout.row(action.id)
        name = names_in_tooltip(row.words if row is not None else action.name, action.name)
        head = tr("Drag the arrow onto another stance to end there")
        plain = head if hit.area == "head" else tr("Click plays it in context, drag moves it")
        note = project.notes.get(action.id, "")
        return "\n".join(x for x in (name, note, misfits.get(action.id) or plain) if x)
    stance = project.stance(other if hit.area == "other" else hit.ident)
    name = "" if stance is None else stance.name
    if name and hit.area == "other":
        name = tr("to {name}", name=name)
    words = {
        "chip": tr("Click to make this the current stance"),
        "card": tr("Click selects its loops, double-click renames it"),
        "add": tr("New stance: drop a clip here, or click"),
        "other": tr("The stance that dropped transitions end in"),
    }.get(hit.area, "")
    return "\n".join(x for x in (name, words) if x) if words else ""


def count_machine(project: Project) -> str:
    """Count the machine that was not drawn."""
    whole = count_machine_size(project)
    if not whole.clips:
        return tr("Drop clips on the nodes; every connection between them is implied.")
    layers = sum(1 for layer in LAYERS if project.graphs[layer].actions)
    over = tr(" over {layers} layers", layers=layers) if layers > 1 else ""
    clips, states, links = (
        tr_plural("{count:,} clip", "{count:,} clips", whole.clips),
        tr_plural("{count:,} state", "{count:,} states", whole.states),
        tr_plural("{count:,} connection", "{count:,} connections", whole.connections),
    )
    return tr(
        "You placed {clips}{over}. This is the machine you did not have to draw: {states}, {links}.",
        clips=clips,
        over=over,
        states=states,
        links=links,
    )
