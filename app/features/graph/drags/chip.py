"""The drag of a stance's chip: onto another, which merges the two, or between two, which lists it there."""

from __future__ import annotations

from PySide6.QtCore import QPointF
from PySide6.QtGui import QMouseEvent

from app.features.graph.drags.host import GraphHost
from app.features.graph.repoint import NOWHERE
from app.features.graph.stance_drops import drop_stance_at
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
        drop, hit, mark = drop_stance_at(self.host.document.project, layout, self.stance, at)
        chips = {c.stance: c.rect for c in layout.chips}
        own, chip = chips.get(self.stance), chips.get(hit.ident or "")
        start = QPointF(own.center()) if own is not None else self.origin
        end = QPointF(chip.center()) if chip is not None else at
        self.host.point(drop, hit, None if mark is not None else (start, end), mark)

    def finish(self, at: QPointF) -> None:
        if not self.begun:
            return
        drop, _, _ = drop_stance_at(self.host.document.project, self.host.layout_now(), self.stance, at)
        self.host.point(None, NOWHERE, None)
        if drop.possible and drop.reorder:
            self.host.list_stance(self.stance, drop.before)
        elif drop.possible:
            self.host.merge(self.stance, str(drop.stance))

    def cancel(self, reason: Reason) -> None:
        self.host.point(None, NOWHERE, None)
