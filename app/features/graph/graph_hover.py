"""What lies under the pointer on the canvas, and what happens where it rests there."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import Qt, QTimer
from PySide6.QtWidgets import QWidget

from app.features.graph.graph_layout import GraphHit
from app.features.graph.graph_look import NOWHERE
from app.look.comfort import get_comfort
from app.stage.session import StageSession

PAUSE = 350  # milliseconds over a row before it plays, over a chip during a drag before it becomes current
ROWS = ("row", "head")
PRESSED = ("chip", "add", "other", "row", "bar", "card", "head")  # what a press does something with


class Hover:
    """A row plays in context where the pointer rests on it, and the performance goes on where it leaves.

    hit: what is under the pointer. held: where something is held over the canvas, None if nothing is.
    """

    def __init__(self, session: StageSession, held: Callable[[], GraphHit | None], widget: QWidget) -> None:
        self.session, self.held, self.widget = session, held, widget
        self.hit = NOWHERE
        self._shown = False  # it plays only as long as the pointer is there
        self.timer = QTimer(widget, singleShot=True, interval=PAUSE)
        self.timer.timeout.connect(self._rested)

    def move(self, hit: GraphHit) -> None:
        """Take over what is under the pointer now."""
        if hit == self.hit:
            return
        left = self.hit.area in ROWS and hit.area not in ROWS
        self.hit = hit
        shapes = Qt.CursorShape
        pressed = shapes.PointingHandCursor if hit.area in PRESSED else shapes.ArrowCursor
        self.widget.setCursor(shapes.SizeHorCursor if hit.area == "bar" else pressed)
        if hit.area in ROWS:
            self.timer.start()
        else:
            self.timer.stop()
            if left and self._shown:
                self._shown = False
                self.session.transport.show_plan()
        self.widget.update()

    def stay(self) -> None:
        """What plays was asked for: it goes on when the pointer leaves."""
        self._shown = False

    def _rested(self) -> None:
        held = self.held()
        if held is not None:
            if held.area == "chip" and held.ident:
                self.session.place.set_stance(held.ident)
        elif get_comfort().still:
            return  # nothing plays until it is asked for
        elif self.hit.area in ROWS and self.hit.ident and self.session.transport.show != "clip":
            self._shown = self.session.transport.show == "plan" or self._shown
            self.session.show_context(self.hit.ident)
