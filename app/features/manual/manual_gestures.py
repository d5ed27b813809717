"""Drags of the mouse in the editor as objects, from press to release. Only `finish` changes the project."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtWidgets import QApplication

from app.features.manual.manual_scene import Hit
from metagraph.graph import manual_edits

if TYPE_CHECKING:
    from app.features.manual.manual_canvas import ManualCanvas

SNAP = 8.0  # units to which nodes come to rest


class Drag(Protocol):
    """One drag. Points are the widget's, pixels."""

    def update(self, at: QPointF) -> None: ...
    def finish(self, at: QPointF) -> None: ...
    def cancel(self) -> None: ...


class Pan:
    """Moves what is seen."""

    def __init__(self, canvas: ManualCanvas, at: QPointF) -> None:
        self.canvas, self.last = canvas, at
        self.begun = False
        self._origin = at

    def update(self, at: QPointF) -> None:
        if not self.begun and (at - self._origin).manhattanLength() < QApplication.startDragDistance():
            return
        self.begun = True
        self.canvas.look_at(self.canvas.view.panned(at - self.last))
        self.last = at

    def finish(self, at: QPointF) -> None:
        self.canvas.settle()

    def cancel(self) -> None:
        self.canvas.settle()


class Move:
    """Moves the selected nodes, or the one that was pressed; they come to rest on the grid. One undo step."""

    def __init__(self, canvas: ManualCanvas, node: str, at: QPointF) -> None:
        self.canvas, self.node, self.origin = canvas, node, at
        chosen = canvas.session.selection.states
        self.nodes = chosen if node in chosen else (node,)
        self.begun = False

    def update(self, at: QPointF) -> None:
        if not self.begun and (at - self.origin).manhattanLength() < QApplication.startDragDistance():
            return
        self.begun = True
        self.canvas.drag_nodes(self._places(at))

    def _places(self, at: QPointF) -> dict[str, tuple[float, float]]:
        by = (at - self.origin) / self.canvas.view.scale
        first = self.canvas.scene().nodes[self.node].topLeft()
        x, y = (round((first.x() + by.x()) / SNAP) * SNAP - first.x(), round((first.y() + by.y()) / SNAP) * SNAP - first.y())
        nodes = self.canvas.scene().nodes
        return {i: (nodes[i].left() + x, nodes[i].top() + y) for i in self.nodes if i in nodes}

    def finish(self, at: QPointF) -> None:
        places = self._places(at) if self.begun else {}
        self.canvas.drag_nodes({})
        if places:
            layer = self.canvas.session.place.layer
            text = "Move node" if len(places) == 1 else f"Move {len(places)} nodes"
            self.canvas.document.edit(text, lambda p: manual_edits.move_nodes(p, layer, places))

    def cancel(self) -> None:
        self.canvas.drag_nodes({})


class Band:
    """Selects with a rubber band. kept: what stays selected besides."""

    def __init__(self, canvas: ManualCanvas, at: QPointF, kept: tuple[tuple[str, ...], tuple[str, ...]]) -> None:
        self.canvas, self.origin, self.kept = canvas, canvas.view.back(at), kept

    def update(self, at: QPointF) -> None:
        band = QRectF(self.origin, self.canvas.view.back(at)).normalized()
        self.canvas.show_band(band)
        states, links = self.canvas.scene().inside(band)
        both = (dict.fromkeys((*self.kept[0], *states)), dict.fromkeys((*self.kept[1], *links)))
        self.canvas.session.selection.select_states(tuple(both[0]), tuple(both[1]) if not both[0] else self.kept[1])

    def finish(self, at: QPointF) -> None:
        self.canvas.show_band(None)

    def cancel(self) -> None:
        self.canvas.show_band(None)
        self.canvas.session.selection.select_states(*self.kept)


class DrawLink:
    """Draws a link from a node to where the mouse is let go. sticky: begun from a menu, it follows the mouse until it is pressed."""

    def __init__(self, canvas: ManualCanvas, source: str, at: QPointF, sticky: bool = False) -> None:
        self.canvas, self.source, self.sticky = canvas, source, sticky
        self.origin, self.begun = at, sticky
        self.target = ""
        self.words = ""

    def update(self, at: QPointF) -> None:
        if not self.begun and (at - self.origin).manhattanLength() < QApplication.startDragDistance():
            return
        self.begun = True
        hit: Hit = self.canvas.scene().hit(self.canvas.view.back(at), self.canvas.view.scale)
        self.target, self.words = "", ""
        if hit.area in ("node", "edge"):
            why = manual_edits.link_refusal(self.canvas.document.project, self.canvas.session.place.layer, self.source, hit.ident)
            self.target, self.words = (hit.ident, "") if why is None else ("", why)
        self.canvas.setCursor(Qt.CursorShape.ForbiddenCursor if self.words else Qt.CursorShape.CrossCursor)
        self.canvas.show_link(self.source, at, self.target)

    def finish(self, at: QPointF) -> None:
        self.update(at)
        self.canvas.show_link("", at, "")
        if not self.begun or (self.target == self.source and (at - self.origin).manhattanLength() < 24 and not self.sticky):
            return
        if self.words:
            self.canvas.refused.emit(self.words)
        elif self.target:
            self.canvas.add_link(self.source, self.target)
        else:
            self.canvas.refused.emit("let a link go on a state")

    def cancel(self) -> None:
        self.canvas.show_link("", QPointF(), "")
