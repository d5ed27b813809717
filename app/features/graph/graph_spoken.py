"""What screen readers report about the graph's canvas: stances, the actions of each node, and buttons."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from PySide6.QtGui import QAccessible

from app.features.graph.graph_layout import Layout
from app.features.graph.graph_look import GraphLook
from app.look.names import make_readable_name
from app.translation import tr, tr_plural
from app.widgets.spoken_items import SpokenItem
from app.widgets.vocabulary import get_vocabulary_title

Role = QAccessible.Role


def list_graph_items(layout: Layout, look: GraphLook, misfits: Mapping[str, str]) -> Sequence[SpokenItem]:
    """Return the items of a canvas, from the strip of stances to the nodes."""
    out = []
    for chip in layout.chips:
        if chip.stance is None:
            name = tr("Find stance") if chip.finds else tr("New stance")
            out.append(SpokenItem(name, chip.rect, Role.Button))
            continue
        more = [tr_plural("{count:,} action", "{count:,} actions", chip.count), chip.words, chip.same]
        name = tr("Stance: {name}", name=make_readable_name(chip.name))
        current = chip.stance == layout.stance
        out.append(SpokenItem(name, chip.rect, Role.PageTab, ", ".join(filter(None, more)), selected=current))
    stance = look.project.stance(layout.stance)
    if stance is not None:
        loops = look.project.graphs[stance.layer].of(stance.id, "stance")
        words = tr_plural("{count:,} loop", "{count:,} loops", len(loops))
        name = tr("{name}, its loops", name=make_readable_name(stance.name))
        chosen = any(a.id in look.selected for a in loops)
        out.append(SpokenItem(name, layout.card, description=words, selected=chosen))
    for kind, node in layout.nodes.items():
        title = get_vocabulary_title(kind)
        counted = tr_plural("{count:,} action", "{count:,} actions", node.count)
        out.append(SpokenItem(title, node.header, Role.Heading, counted))
        for row in node.rows:
            action = row.action
            name = tr("{kind}: {name}", kind=title, name=make_readable_name(row.words))
            value = tr("Likelihood {likelihood:g}", likelihood=action.likelihood)
            words = ", ".join(
                filter(None, (value, misfits.get(action.id, ""), look.project.notes.get(action.id, "")))
            )
            selected, focused = action.id in look.selected, action.id == look.focus
            out.append(SpokenItem(name, row.rect, Role.ListItem, words, value, selected, focused))
    return out
