"""The drag of what is seen of the machine."""

from __future__ import annotations

from PySide6.QtCore import QPointF, Qt
from PySide6.QtGui import QMouseEvent

from app.features.manual.drags.host import ManualHost
from app.widgets.gesture import PressDrag, Reason


class ManualPan(PressDrag):
    """Moves what is seen; a click of the right button opens the menu."""

    def __init__(self, host: ManualHost) -> None:
        super().__init__()
        self.host, self.last = host, QPointF()

    def begin(self, at: QPointF) -> None:
        super().begin(at)
        self.last = at

    def update(self, at: QPointF, free: bool = False) -> None:
        if not self.caught(at):
            return
        self.host.look_at(self.host.view.panned(at - self.last))
        self.last = at

    def finish(self, at: QPointF) -> None:
        self.host.settle()

    def cancel(self, reason: Reason) -> None:
        self.host.settle()

    def click(self, event: QMouseEvent) -> None:
        if event.button() == Qt.MouseButton.RightButton:
            self.host.open_menu(event.position())
