"""What drags of a node share."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtGui import QMouseEvent

from app.features.manual.drags.host import ManualHost
from app.widgets.gesture import PressDrag
from metagraph.graph.manual.machine import ANY


class NodeDrag(PressDrag):
    """nodes: all that are selected, if the one that was pressed is one of them; else that one. A click
    selects it alone.
    """

    def __init__(self, host: ManualHost, node: str) -> None:
        super().__init__()
        self.host, self.node = host, node
        chosen = host.session.selection.states
        self.nodes = chosen if node in chosen else (node,)

    def click(self, event: QMouseEvent) -> None:
        hit = self.host.scene().hit(self.host.view.back(event.position()), self.host.view.scale)
        plain = not event.modifiers() and event.button() == Qt.MouseButton.LeftButton
        if plain and hit.ident == self.node != ANY:
            self.host.session.selection.select_states((hit.ident,))
