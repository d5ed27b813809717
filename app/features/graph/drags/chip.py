"""The drag of a stance's chip onto another, which merges the two."""

from __future__ import annotations

from PySide6.QtCore import QPointF
from PySide6.QtGui import QMouseEvent

from app.features.graph.drags.host import GraphHost
from app.features.graph.graph_drops import merge_at
from app.features.graph.repoint import NOWHERE
from app.widgets.gesture import PressDrag, Reason


class ChipDrag(PressDrag):
    """Drags a stance by its chip. A click only shows the stance."""

    def __init__(self, host: GraphHost, stance: str) -> None:
        super().__init__()
        self.host, self.stance = host, stance

    def click(self, event: QMouseEvent) -> None:
        """The press has shown the stance."""

    def update(self, at: QPointF, free: bool = False) -> None:
        if not self.caught(at):
            return
        layout = self.host.layout_now()
        hit = layout.hit(at, dragging=True)
        drop = merge_at(self.host.document.project, self.stance, hit)
        chips = {c.stance: c.rect for c in layout.chips}
        chip = chips.get(hit.ident or "") if hit.area == "chip" else None
        own = chips.get(self.stance)
        start = QPointF(own.center()) if own is not None else self.origin
        end = QPointF(chip.center()) if chip is not None else at
        self.host.point(drop, hit if chip is not None else NOWHERE, (start, end))

    def finish(self, at: QPointF) -> None:
        if not self.begun:
            return
        hit = self.host.layout_now().hit(at, dragging=True)
        drop = merge_at(self.host.document.project, self.stance, hit)
        self.host.point(None, NOWHERE, None)
        if drop.possible:
            self.host.merge(self.stance, str(drop.stance))

    def cancel(self, reason: Reason) -> None:
        self.host.point(None, NOWHERE, None)
