"""Which stretch of time the lanes show, and how it is changed: by the wheel, to all, to what is selected."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtGui import QWheelEvent
from PySide6.QtWidgets import QWidget

from app.features.timeline.lane_keys import ZOOM
from app.stage.performance import StagePerformance
from app.stage.session import StageSession
from app.widgets.lane_geometry import LEFT, LaneScale, RequestMark

NEAREST, FARTHEST = 400.0, 0.25  # pixels a second


class LaneSpan(QWidget):
    """first: seconds at the left of the lanes. each: pixels a second."""

    session: StageSession
    performance: StagePerformance
    each = 44.0
    first = 0.0

    def scale(self) -> LaneScale:
        return LaneScale(self.first, self.each)

    def marks(self) -> list[RequestMark]:
        """Return the requests as they are drawn now."""
        raise NotImplementedError

    def wheelEvent(self, event: QWheelEvent) -> None:
        delta = event.angleDelta()
        if event.modifiers() & Qt.KeyboardModifier.ShiftModifier or abs(delta.x()) > abs(delta.y()):
            self.go_to(self.first - (delta.x() or delta.y()) / 2 / self.each)
        else:
            self.zoom(ZOOM ** (delta.y() / 120), event.position().x())
        event.accept()

    def zoom(self, by: float, x: float) -> None:
        """Zoom about a place on the screen."""
        at = self.scale().seconds(x)
        self.each = min(NEAREST, max(FARTHEST, self.each * by))
        self.go_to(at - (x - LEFT) / self.each)

    def go_to(self, first: float) -> None:
        """Let the lanes begin at a time."""
        self.first = max(0.0, first)
        self.update()

    def show_span(self, start: float, end: float) -> None:
        """Zoom so that a stretch of time is seen whole, with a little on either side."""
        room = max(40, self.width() - LEFT)
        self.each = min(NEAREST, max(FARTHEST, room / max(0.1, 1.1 * (end - start))))
        self.go_to((start + end) / 2 - room / 2 / self.each)

    def zoom_all(self) -> None:
        """Show all there is: what is kept to its end, else as far as it is planned."""
        self.each = max(
            FARTHEST,
            min(NEAREST, 0.98 * max(40, self.width() - LEFT) / max(0.1, self.performance.shown.length)),
        )
        self.go_to(0.0)

    def zoom_selection(self) -> None:
        """Show what is selected: requests and what plays for them, or an action's cues; else the range."""
        chosen, shown = self.session.onstage.requests, self.performance.shown
        spans = [(m.at, m.at) for m in self.marks() if m.ask.id in chosen]
        for of in shown.plan.layers.values():
            for cue in of.cues:
                if cue.meta.partition("+")[0] in chosen or (
                    not chosen and cue.action.id in self.session.selection.actions
                ):
                    spans.append((cue.start, cue.end))
        if not spans and self.performance.timeline.range is not None:
            spans = [self.performance.timeline.range]
        if spans:
            self.show_span(min(s for s, _ in spans), max(e for _, e in spans))
