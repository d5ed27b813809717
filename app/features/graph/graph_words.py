"""Describe in words what is under the pointer on the canvas, and the machine that nobody had to draw."""

from __future__ import annotations

from collections.abc import Mapping

from app.features.graph.graph_layout import GraphHit, Layout
from app.look.domain_words import KIND_MEANINGS
from app.look.names import describe_name_in_tooltip
from app.translation import tr, tr_plural
from app.widgets.vocabulary import get_vocabulary_title, get_vocabulary_word
from metagraph.graph.expand import count_machine_size
from metagraph.graph.model import LAYERS, Project, Stance


def describe_graph_hit(
    project: Project,
    layout: Layout,
    hit: GraphHit,
    other: str | None,
    misfits: Mapping[str, str],
    same: Mapping[str, tuple[Stance, ...]] | None = None,
) -> str:
    """Return words about what is under the pointer. other: the stance in which dropped transitions end.
    misfits: problems of the ends of actions. same: see `find_same_stances`.
    """
    action = project.action(hit.ident) if hit.ident else None
    if hit.area == "bar" and action is not None:
        return tr(
            "Likelihood {likelihood:g}: how often this action plays compared with the others in "
            "its node. Drag to change it.",
            likelihood=action.likelihood,
        )
    if action is not None:
        row = layout.row(action.id)
        name = describe_name_in_tooltip(row.words if row is not None else action.name, action.name)
        head = tr("Drag the arrow onto the stance where this transition should end")
        plain = head if hit.area == "head" else tr("Click to play it in context, drag to move it")
        note = project.notes.get(action.id, "")
        return "\n".join(x for x in (name, note, misfits.get(action.id) or plain) if x)
    stance = project.stance(other if hit.area == "other" else hit.ident)
    name = "" if stance is None else stance.name
    if name and hit.area == "other":
        name = tr("to {name}", name=name)
    words = {
        "chip": tr(
            "Click to edit this stance. Drag it onto another to merge them, or between two to reorder them."
        ),
        "card": tr("Click to select its loops, double-click to rename it"),
        "find": tr("Find a stance by its name (Ctrl+G)"),
        "add": tr("New stance: drop a clip here, or click"),
        "other": tr("Transitions that you drop end in this stance"),
    }.get(hit.area, "")
    alike = (same or {}).get(hit.ident or "") if hit.area == "chip" else None
    if alike:
        layers = ", ".join(
            tr("{layer}: {stance}", layer=get_vocabulary_title(s.layer), stance=s.name) for s in alike
        )
        words = "\n".join((tr("One posture with {stances}. A click shows it on all.", stances=layers), words))
    if hit.kind is not None and hit.area in ("node", "card"):
        words = "\n".join(x for x in (KIND_MEANINGS[hit.kind], words) if x)
    return "\n".join(x for x in (name, words) if x) if words else ""


def describe_same_stances(same: Mapping[str, tuple[Stance, ...]]) -> dict[str, str]:
    """Return for each stance, by id, the other layers that it is on, too: "+ body, head"."""
    return {i: "+ " + ", ".join(get_vocabulary_word(s.layer) for s in rest) for i, rest in same.items()}


def count_machine(project: Project) -> str:
    """Count the states and connections of the expanded machine."""
    whole = count_machine_size(project)
    if not whole.clips:
        return tr("Drop clips on the nodes. Metagraph connects them for you.")
    layers = sum(1 for layer in LAYERS if project.graphs[layer].actions)
    over = tr(" on {layers} layers", layers=layers) if layers > 1 else ""
    clips, states, links = (
        tr_plural("{count:,} clip", "{count:,} clips", whole.clips),
        tr_plural("{count:,} state", "{count:,} states", whole.states),
        tr_plural("{count:,} connection", "{count:,} connections", whole.connections),
    )
    return tr(
        "You placed {clips}{over}. Drawn by hand, this state machine has {states} and {links}.",
        clips=clips,
        over=over,
        states=states,
        links=links,
    )
