"""The drag of nodes."""

from __future__ import annotations

from PySide6.QtCore import QPointF

from app.features.manual.drags.node import NodeDrag
from app.translation import tr_plural
from app.widgets.gesture import Reason
from metagraph.graph.manual import edits as manual_edits

SNAP = 8.0  # units to which nodes come to rest


class Move(NodeDrag):
    """Moves the selected nodes, or the one that was pressed; they come to rest on the grid. One undo step."""

    def update(self, at: QPointF, free: bool = False) -> None:
        if not self.caught(at):
            return
        self.host.drag_nodes(self._places(at))

    def _places(self, at: QPointF) -> dict[str, tuple[float, float]]:
        by = (at - self.origin) / self.host.view.scale
        first = self.host.scene().nodes[self.node].topLeft()
        x, y = (
            round((first.x() + by.x()) / SNAP) * SNAP - first.x(),
            round((first.y() + by.y()) / SNAP) * SNAP - first.y(),
        )
        nodes = self.host.scene().nodes
        return {i: (nodes[i].left() + x, nodes[i].top() + y) for i in self.nodes if i in nodes}

    def finish(self, at: QPointF) -> None:
        places = self._places(at) if self.begun else {}
        self.host.drag_nodes({})
        if places:
            layer = self.host.session.place.layer
            text = tr_plural("Move {count:,} node", "Move {count:,} nodes", len(places))
            self.host.document.edit(text, lambda p: manual_edits.move_nodes(p, layer, places))

    def cancel(self, reason: Reason) -> None:
        self.host.drag_nodes({})
