"""The drag of the head of a transition's arrow."""

from __future__ import annotations

from PySide6.QtCore import QPointF

from app.features.graph.drags.action import ActionDrag
from app.features.graph.drags.host import GraphHost
from app.features.graph.repoint import NOWHERE, repoint_at
from app.widgets.gesture import Reason


class HeadDrag(ActionDrag):
    """Drags the head of a transition's arrow; all selected transitions follow when it is one of them."""

    def __init__(self, host: GraphHost, action: str) -> None:
        super().__init__(host, action)
        chosen = [a.id for a in host.session.selection.selected_actions() if a.kind == "transition"]
        self.actions = tuple(chosen) if action in chosen else (action,)

    def update(self, at: QPointF, free: bool = False) -> None:
        if not self.caught(at):
            return
        layout = self.host.layout_now()
        hit = layout.hit(at, dragging=True)
        drop = repoint_at(self.host.document.project, self.actions, hit)
        chip = next((c.rect for c in layout.chips if hit.area == "chip" and c.stance == hit.ident), None)
        row = layout.row(self.action)
        start = QPointF(row.head.center()) if row is not None else self.origin
        end = QPointF(chip.center().x(), chip.bottom() + 2) if chip is not None else at
        self.host.point(drop, hit if chip is not None else NOWHERE, (start, end))

    def finish(self, at: QPointF) -> None:
        if not self.begun:
            return
        hit = self.host.layout_now().hit(at, dragging=True)
        drop = repoint_at(self.host.document.project, self.actions, hit)
        self.host.point(None, NOWHERE, None)
        if drop.possible:
            self.host.end_in(self.actions, str(drop.end))
        elif hit.area == "chip":
            self.host.refuse(drop.words.replace("*", ""))

    def cancel(self, reason: Reason) -> None:
        self.host.point(None, NOWHERE, None)
