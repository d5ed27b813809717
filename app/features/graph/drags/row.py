"""Drag actions by their rows."""

from __future__ import annotations

from PySide6.QtCore import QPoint, QPointF, Qt
from PySide6.QtGui import QDrag

from app.features.graph.drags.action import ActionDrag
from app.translation import tr_plural
from app.widgets.mime import drag_picture, make_mime


class RowDrag(ActionDrag):
    """Drags actions onto another node or stance. It is a system drag, so that every drop target
    accepts them.
    """

    def update(self, at: QPointF, free: bool = False) -> None:
        if self.begun or not self.caught(at):
            return
        chosen = self.host.session.selection.actions
        actions = chosen if self.action in chosen else (self.action,)
        widget = self.host.widget
        drag = QDrag(widget)
        drag.setMimeData(make_mime(actions=actions))
        action = self.host.document.project.action(self.action)
        picture = self.host.thumbnails.picture(action.clip, bare=True) if action is not None else None
        words = (
            tr_plural("{count:,} action", "{count:,} actions", len(actions))
            if len(actions) > 1
            else self._name()
        )
        drag.setPixmap(drag_picture(words, widget, picture))
        drag.setHotSpot(QPoint(-14, -10))
        self.host.hand.drop("taken over")
        drag.exec(Qt.DropAction.MoveAction)

    def _name(self) -> str:
        found = self.host.document.project.action(self.action)
        return found.name if found is not None else ""

    def finish(self, at: QPointF) -> None:
        """Treat the drag as a click."""
