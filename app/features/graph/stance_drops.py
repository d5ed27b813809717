"""What letting a stance's chip go does: on the middle of another it merges the two, between two it is listed
there.
"""

from __future__ import annotations

from PySide6.QtCore import QPointF, QRectF

from app.features.graph.graph_drops import Drop, merge_at
from app.features.graph.graph_frames import GRID
from app.features.graph.graph_layout import Chip, GraphHit, Layout
from app.features.graph.repoint import NOWHERE
from app.translation import tr
from metagraph.graph.editing.listing import reorder_stances
from metagraph.graph.model import Project

EDGE = 0.25  # of a chip's width at each side, where it is not merged but listed beside it
OVER = 3.0  # pixels that the mark between two chips reaches above and below them


def drop_stance_at(
    project: Project, layout: Layout, stance: str, at: QPointF
) -> tuple[Drop, GraphHit, QRectF | None]:
    """Return what letting a stance's chip go at a point does, what is hit, and the mark between two chips
    where it would be listed, None if it would not.
    """
    chips = [c for c in layout.chips if c.stance is not None]
    line = [c for c in chips if c.rect.adjusted(-GRID, -GRID, GRID, GRID).contains(at)]
    near = min(line, key=lambda c: abs(at.x() - c.rect.center().x()), default=None)
    if near is None:
        return merge_at(project, stance, NOWHERE), NOWHERE, None
    part = (at.x() - near.rect.left()) / near.rect.width()
    if EDGE <= part <= 1 - EDGE:
        hit = GraphHit("chip", near.stance)
        return merge_at(project, stance, hit), hit, None
    place = chips.index(near) + (part > 0.5)
    drop = list_stance(project, chips, stance, place)
    x = near.rect.right() + GRID / 2 if part > 0.5 else near.rect.left() - GRID / 2
    mark = QRectF(x - 1.5, near.rect.top() - OVER, 3, near.rect.height() + 2 * OVER)
    return drop, NOWHERE, mark if drop.possible else None


def list_stance(project: Project, chips: list[Chip], stance: str, place: int) -> Drop:
    """Return what listing a stance in front of the chip at a place does, or behind the last one."""
    before = next((c for c in chips[place:] if c.stance != stance), None)
    target = before.stance if before is not None else None
    if reorder_stances(project, stance, target) is project:
        return Drop(False, tr("already here"), stance=stance, reorder=True)
    found = project.stance(stance)
    name = found.name if found is not None else "?"
    words = (
        tr("move *{stance}* before *{other}*", stance=name, other=before.name)
        if before is not None
        else tr("move *{stance}* to the end", stance=name)
    )
    return Drop(True, words, stance=stance, reorder=True, before=target)
