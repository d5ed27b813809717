"""Requests being moved, or copied, in time: silently until the button is released, then one edit."""

from __future__ import annotations

from typing import Protocol

from PySide6.QtCore import QPointF

from app.stage.performance import Performance
from app.stage.session import Session
from app.widgets.gesture import PressDrag
from app.widgets.lane_geometry import time_of


class LanesHost(Protocol):
    """The timeline as its drags see it. each: pixels a second."""

    session: Session
    performance: Performance
    each: float


class RequestDrag(PressDrag):
    """idents: what is moved; ident: the one that is held. by: seconds. copy: copies of them go there. lone:
    let go without being moved, the held one is selected no longer.
    """

    catch = 3.0

    def __init__(self, host: LanesHost, idents: tuple[str, ...], ident: str, lone: bool) -> None:
        super().__init__()
        self.host, self.idents, self.ident, self.lone = host, idents, ident, lone
        self.by = 0.0
        self.copy = False

    def update(self, at: QPointF, free: bool = False) -> None:
        """free: they are copied."""
        if self.caught(QPointF(at.x(), self.origin.y())):
            self.copy = free
            self.by = self._within(round((at.x() - self.origin.x()) / self.host.each, 2))

    def _within(self, by: float) -> float:
        """Return by how much they can be moved: none to before the beginning."""
        performance = self.host.performance
        answers = performance.answers()
        return max(
            by,
            -min(
                (time_of(x, answers.get(x.id)) for x in performance.asks if x.id in self.idents), default=0.0
            ),
        )

    def finish(self, at: QPointF) -> None:
        requests, onstage = self.host.performance.requests, self.host.session.onstage
        if self.begun and self.by and self.copy:
            requests.copy(self.idents, self.by)
        elif self.begun and self.by:
            requests.move(self.idents, self.by)
        elif self.lone and not self.begun:
            onstage.select_requests(tuple(i for i in onstage.requests if i != self.ident))
