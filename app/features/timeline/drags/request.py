"""The drag of requests, moved or copied in time: silently until the button is released, then one edit."""

from __future__ import annotations

from PySide6.QtCore import QPointF, Qt
from PySide6.QtGui import QMouseEvent

from app.features.timeline.drags.host import LanesHost
from app.features.timeline.drags.lane import LaneDrag
from app.widgets.lane_geometry import get_ask_time


class RequestDrag(LaneDrag):
    """chosen: what is moved; following: with what goes along; ident: the one that is held. by: seconds. copy:
    copies of what is chosen go there. lone: let go without being moved, the held one is selected no longer.
    """

    def __init__(
        self,
        host: LanesHost,
        chosen: tuple[str, ...],
        ident: str,
        lone: bool,
        following: tuple[str, ...] = (),
    ) -> None:
        super().__init__(host)
        self.chosen, self.ident, self.lone = chosen, ident, lone
        self.following = following or chosen
        self.by = 0.0
        self.copy = False

    @property
    def cursor(self) -> Qt.CursorShape:
        return Qt.CursorShape.DragCopyCursor if self.copy else super().cursor

    @property
    def idents(self) -> tuple[str, ...]:
        """Return all that is shown elsewhere while it is dragged."""
        return self.chosen if self.copy else self.following

    def update(self, at: QPointF, free: bool = False) -> None:
        """free: they are copied."""
        if self.caught(at):
            self.copy = free
            by = round((at.x() - self.origin.x()) / self.host.each, 2)
            held = self._times().get(self.ident, 0.0)
            self.by = self._within(round(self.host.magnet.snap(held + by, self.host.each) - held, 3))

    def _within(self, by: float) -> float:
        """Return by how much they can be moved: none to before the beginning."""
        return max(by, -min(self._times().values(), default=0.0))

    def _times(self) -> dict[str, float]:
        """Return when each that is moved stands."""
        performance = self.host.performance
        answers = performance.answers()
        return {x.id: get_ask_time(x, answers.get(x.id)) for x in performance.asks if x.id in self.idents}

    def finish(self, at: QPointF) -> None:
        requests = self.host.performance.requests
        if self.begun and self.by and self.copy:
            requests.copy(self.chosen, self.by)
        elif self.begun and self.by:
            requests.move(self.chosen, self.by)

    def click(self, event: QMouseEvent) -> None:
        if self.lone:
            onstage = self.host.session.onstage
            onstage.select_requests(tuple(i for i in onstage.requests if i != self.ident))
