"""What is drawn in each part of a canvas, so that what shows in one row is painted in that row alone."""

from __future__ import annotations

from collections.abc import Hashable, Mapping
from typing import Any

from PySide6.QtCore import QRectF
from PySide6.QtGui import QRegion

from app.features.graph.graph_layout import Layout
from app.features.graph.graph_look import GraphLook

EDGE = 4  # pixels that what is drawn reaches beyond its part: rounded corners, the round of a bar
EVERYTHING = "everything"

# By part: where it lies, and all that decides what is drawn there, but for pictures, what the pointer is on
# and what is dragged, which let the whole canvas be painted when they change.
Parts = Mapping[Hashable, tuple[QRectF, Any]]


def list_graph_parts(layout: Layout, look: GraphLook) -> Parts:
    """Return what is drawn in each part of a canvas."""
    project, whole = look.project, QRectF(0, 0, layout.size.width(), layout.size.height())
    joined = tuple((node.rect, bool(node.count)) for node in layout.nodes.values())
    out: dict[Hashable, tuple[QRectF, Any]] = {
        EVERYTHING: (whole, (look.theme.name, layout.size, layout.stance, layout.card, joined)),
        "foot": (layout.foot, look.sentence),
    }
    stance = project.stance(layout.stance)
    graph = project.graphs[stance.layer] if stance is not None else None
    names = tuple(chip.name for chip in layout.chips)
    for place, chip in enumerate(layout.chips):
        loop = graph.of(chip.stance, "stance")[:1] if graph is not None and chip.stance is not None else ()
        out["chip", place] = chip.rect, (chip, names, [a.clip for a in loop])
    if stance is not None and graph is not None:
        loops = graph.of(stance.id, "stance")
        chosen = any(a.id in look.selected for a in loops)
        hero = loops[0].clip if loops else None
        out["card"] = layout.card, (stance.name, len(loops), hero, chosen, graph.start == stance.id)
    beside = tuple(row.words for node in layout.nodes.values() for row in node.rows)
    other = project.stance(look.other)
    for kind, node in layout.nodes.items():
        leads = other.name if kind == "transition" and other is not None else ""
        out["node", kind] = node.rect, (node.count, node.scroll, node.most, len(node.rows), node.other, leads)
        for place, row in enumerate(node.rows):
            action = row.action
            out["row", kind, place] = (
                row.rect,
                (
                    action.id,
                    action.clip,
                    action.likelihood,
                    row.words,
                    beside,
                    (row.bar, row.picture),
                    action.id in look.selected,
                    action.id in look.fresh,
                    action.id == look.focus,
                    action.id in look.playing,
                    action.id in look.misfits,
                ),
            )
    return out


def find_stale_region(before: Parts, after: Parts) -> QRegion | None:
    """Return where something else is drawn than before; None for everywhere."""
    if before.get(EVERYTHING) != after.get(EVERYTHING):
        return None
    out = QRegion()
    for part in {**before, **after}:
        was, now = before.get(part), after.get(part)
        if was != now:
            for rect, _ in (x for x in (was, now) if x is not None):
                out += QRegion(rect.toAlignedRect().adjusted(-EDGE, -EDGE, EDGE, EDGE))
    return out
