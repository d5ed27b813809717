"""What drags of an action share."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtGui import QMouseEvent

from app.features.graph.drags.host import GraphHost
from app.widgets.gesture import PressDrag


class ActionDrag(PressDrag):
    """A click shows the action, and selects it alone."""

    def __init__(self, host: GraphHost, action: str) -> None:
        super().__init__()
        self.host, self.action = host, action

    def click(self, event: QMouseEvent) -> None:
        hit, keys = self.host.layout_now().hit(event.position()), Qt.KeyboardModifier
        plain = not event.modifiers() & (keys.ControlModifier | keys.ShiftModifier)
        if plain and hit.ident == self.action:
            self.host.hover.stay()
            self.host.session.selection.select_actions((self.action,))
            self.host.session.show_context(self.action)
