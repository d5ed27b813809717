"""Drags of the mouse on the canvas as objects, from press to release."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

from PySide6.QtCore import QPointF, Qt
from PySide6.QtGui import QDrag
from PySide6.QtWidgets import QApplication

from app.features.graph.graph_layout import likelihood_at
from app.widgets.mime import drag_picture, mime
from metagraph.graph import edits

if TYPE_CHECKING:
    from app.features.graph.graph_canvas import Canvas


class MouseGesture(Protocol):
    """One drag of the mouse, from press to release. Only `finish` changes the project for good."""

    def update(self, at: QPointF) -> None: ...
    def finish(self, at: QPointF) -> None: ...
    def cancel(self) -> None: ...


class LikelihoodDrag:
    """Drags a likelihood bar; all selected actions follow when the bar is of one of them. One undo step."""

    def __init__(self, canvas: Canvas, action: str) -> None:
        self.canvas, self.action = canvas, action
        chosen = canvas.session.selection.actions
        self.actions = chosen if action in chosen else (action,)
        self.row = canvas.layout_now().row(action)

    def update(self, at: QPointF) -> None:
        if self.row is not None:
            value = likelihood_at(self.row, at.x())
            self.canvas.document.edit(
                "Change likelihood", lambda p: edits.update_actions(p, self.actions, likelihood=value), merge="likelihood"
            )

    def finish(self, at: QPointF) -> None:
        self.update(at)
        self.canvas.document.finish_merging()

    def cancel(self) -> None:
        self.canvas.document.cancel_merging("likelihood")


class RowDrag:
    """Drags actions onto another node or stance, as a real drag so that everything that takes drops can take them."""

    def __init__(self, canvas: Canvas, action: str, at: QPointF) -> None:
        self.canvas, self.action, self.origin = canvas, action, at
        self.dragging = False

    def update(self, at: QPointF) -> None:
        if self.dragging or (at - self.origin).manhattanLength() < QApplication.startDragDistance():
            return
        self.dragging = True
        chosen = self.canvas.session.selection.actions
        actions = chosen if self.action in chosen else (self.action,)
        drag = QDrag(self.canvas)
        drag.setMimeData(mime(actions=actions))
        drag.setPixmap(drag_picture(f"{len(actions)} actions" if len(actions) > 1 else self._name(), self.canvas))
        self.canvas.gesture = None
        drag.exec(Qt.DropAction.MoveAction)

    def _name(self) -> str:
        found = self.canvas.document.project.action(self.action)
        return found.name if found is not None else ""

    def finish(self, at: QPointF) -> None:
        pass

    def cancel(self) -> None:
        pass
