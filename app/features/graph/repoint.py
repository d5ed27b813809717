"""Pointing transitions at another stance: dragging the head of a transition's arrow onto a stance's chip."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QPainter, QPainterPath, QPen
from PySide6.QtWidgets import QApplication

from app.features.graph.graph_drops import Drop
from app.features.graph.graph_layout import Hit
from metagraph.graph import edits
from metagraph.graph.model import Project

if TYPE_CHECKING:
    from app.features.graph.graph_canvas import Canvas

NOWHERE = Hit("nothing")
TIP = 9.0  # pixels of an arrow's head


def repoint_at(project: Project, actions: Sequence[str], hit: Hit) -> Drop:
    """Return what letting the heads of transitions go on `hit` does."""
    stance = project.stance(hit.ident) if hit.area == "chip" else None
    if stance is None:
        return Drop(False, "let the arrow go on a stance")
    chosen = [a for i in actions if (a := project.action(i)) is not None and a.kind == "transition"]
    if all(a.end_stance == stance.id for a in chosen):
        return Drop(False, f"already ends in *{stance.name}*", "transition", None, stance.id)
    try:
        edits.set_ends(project, actions, stance.id)
    except edits.EditError as error:
        return Drop(False, str(error), "transition", None, stance.id)
    what = "this transition ends" if len(chosen) == 1 else f"{len(chosen)} transitions end"
    return Drop(True, f"let go and {what} in *{stance.name}*", "transition", None, stance.id)


class HeadDrag:
    """Drags the head of a transition's arrow; all selected transitions follow when it is one of them. One undo step."""

    def __init__(self, canvas: Canvas, action: str, at: QPointF) -> None:
        self.canvas, self.action, self.origin = canvas, action, at
        self.dragging = False
        chosen = [a.id for a in canvas.session.selection.selected_actions() if a.kind == "transition"]
        self.actions = tuple(chosen) if action in chosen else (action,)

    def update(self, at: QPointF) -> None:
        if not self.dragging and (at - self.origin).manhattanLength() < QApplication.startDragDistance():
            return
        self.dragging = True
        canvas = self.canvas
        hit = canvas.layout_now().hit(at, dragging=True)
        drop = repoint_at(canvas.document.project, self.actions, hit)
        chip = next((c.rect for c in canvas.layout_now().chips if hit.area == "chip" and c.stance == hit.ident), None)
        row = canvas.layout_now().row(self.action)
        start = QPointF(row.head.center()) if row is not None else self.origin
        end = QPointF(chip.center().x(), chip.bottom() + 2) if chip is not None else at
        canvas.point(drop, hit if chip is not None else NOWHERE, (start, end))

    def finish(self, at: QPointF) -> None:
        if not self.dragging:
            return
        hit = self.canvas.layout_now().hit(at, dragging=True)
        drop = repoint_at(self.canvas.document.project, self.actions, hit)
        self.cancel()
        if drop.possible:
            self.canvas.end_in(self.actions, str(drop.end))
        elif hit.area == "chip":
            self.canvas.refused.emit(drop.words.replace("*", ""))

    def cancel(self) -> None:
        self.canvas.point(None, NOWHERE, None)


def draw_arrow(painter: QPainter, start: QPointF, end: QPointF, color: QColor, sure: bool) -> None:
    """Draw an arrow in a curve that leaves and arrives upright."""
    pen = QPen(color, 2.0)
    if not sure:
        pen.setDashPattern([4, 3])
    bend = min(120.0, max(24.0, abs(end.y() - start.y()) * 0.4))
    up = 1.0 if end.y() <= start.y() else -1.0
    path = QPainterPath(start)
    foot = end + QPointF(0, up * TIP)
    path.cubicTo(start - QPointF(0, up * bend), foot + QPointF(0, up * bend), foot)
    painter.save()
    painter.setPen(pen)
    painter.setBrush(Qt.BrushStyle.NoBrush)
    painter.drawPath(path)
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(color)
    painter.drawPolygon([end, foot + QPointF(TIP * 0.55, 0), foot - QPointF(TIP * 0.55, 0)])
    painter.drawEllipse(QRectF(start - QPointF(3, 3), start + QPointF(3, 3)))
    painter.restore()
