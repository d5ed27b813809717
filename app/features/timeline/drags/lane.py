"""What drags along in time share."""

from __future__ import annotations

from PySide6.QtCore import QPointF, Qt

from app.features.timeline.drags.host import LanesHost
from app.widgets.gesture import PressDrag


class LaneDrag(PressDrag):
    """It begins once the mouse has moved far enough to either side; up and down do not count."""

    catch = 3.0

    def __init__(self, host: LanesHost) -> None:
        super().__init__()
        self.host = host

    @property
    def cursor(self) -> Qt.CursorShape:
        return Qt.CursorShape.SizeHorCursor

    def caught(self, at: QPointF) -> bool:
        return super().caught(QPointF(at.x(), self.origin.y()))
