"""The floor from above: props are moved and turned on it with the mouse."""

from __future__ import annotations

from dataclasses import dataclass
from math import atan2, cos, degrees, hypot, radians, sin

import msgspec
import numpy as np
from PySide6.QtCore import QEvent, QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QColor, QKeyEvent, QMouseEvent, QPainter, QPaintEvent, QPen, QPolygonF
from PySide6.QtWidgets import QWidget

from app.features.props.placing import Placing
from app.features.props.prop_drag import PropDrag
from app.look.theme import get_theme
from app.stage.props import PropMeshes, put_prop_down
from app.stage.session import StageSession
from app.translation import tr
from app.widgets.gesture import PointerHand
from metagraph.graph.prop import Prop

LEAST = 1.5  # metres from the character that are always in sight
ROOM = 1.15  # of the farthest prop, what is in sight then
GRID, STEP = 0.05, 15.0  # metres and degrees that a drag snaps to
HANDLE = 5.0  # pixels: the radius of what a prop is turned by
UNKNOWN = 0.15  # metres: half of a prop whose file is not read yet
NUDGES = {
    Qt.Key.Key_Left: (-GRID, 0.0),
    Qt.Key.Key_Right: (GRID, 0.0),
    Qt.Key.Key_Up: (0.0, -GRID),
    Qt.Key.Key_Down: (0.0, GRID),
}


@dataclass(frozen=True)
class Outline:
    """A prop from above: the corners of its box, and where it is turned, in pixels."""

    corners: QPolygonF
    handle: QPointF


class FloorPlan(QWidget):
    """Shows the props that stand, the character in the middle, and the side of the viewer below. `chosen` has
    the id of a prop that was clicked. change: called with each step of a drag.
    """

    chosen = Signal(str)

    def __init__(self, session: StageSession, meshes: PropMeshes, placing: Placing, parent: QWidget) -> None:
        super().__init__(parent)
        self.session, self.meshes, self.placing = session, meshes, placing
        self.current = ""
        self.hand = PointerHand()
        self._held = 0.0  # metres in sight, kept while a drag lasts
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setMinimumSize(160, 110)
        self.setAccessibleName(tr("Floor from above"))
        words = tr("Drag a prop to move it, its dot to turn it. Alt: no snapping. Arrow keys move it by 5 cm")
        self.setToolTip(words)
        self.setAccessibleDescription(words)

    def sizeHint(self) -> QSize:
        return QSize(260, 220)

    @property
    def props(self) -> dict[str, Prop]:
        """The props that stand, by id."""
        return {i: p for i, p in self.session.document.project.props.items() if not p.joint}

    def _scale(self) -> float:
        """Return pixels a metre."""
        return max(1, min(self.width(), self.height())) / 2 / (self._held or self._find_span())

    def _find_span(self) -> float:
        """Return how many metres from the character are in sight."""
        far = [max(abs(p.at[0]), abs(p.at[2])) for p in self.props.values()]
        return max(LEAST, ROOM * max(far, default=0.0))

    def to_pixels(self, x: float, z: float) -> QPointF:
        """Return where a place on the floor is, in pixels. x, z: metres."""
        scale = self._scale()
        return QPointF(self.width() / 2 + x * scale, self.height() / 2 + z * scale)

    def to_floor(self, at: QPointF) -> tuple[float, float]:
        """Return the place on the floor at pixels, metres."""
        scale = self._scale()
        return (at.x() - self.width() / 2) / scale, (at.y() - self.height() / 2) / scale

    def find_corners(self, prop: Prop) -> list[tuple[float, float]]:
        """Return the corners of the box round a prop from above, x and z in metres; its back's are first."""
        mesh = self.meshes.meshes.get(self.meshes.locate(prop.path))
        low, high = np.full(3, -UNKNOWN), np.full(3, UNKNOWN)
        if mesh is not None:
            low, high = mesh.positions.min(0) * prop.scale, mesh.positions.max(0) * prop.scale
        turn = radians(prop.turn[1])
        corners = [(low[0], low[2]), (high[0], low[2]), (high[0], high[2]), (low[0], high[2])]
        return [
            (
                prop.at[0] + float(x) * cos(turn) + float(z) * sin(turn),
                prop.at[2] - float(x) * sin(turn) + float(z) * cos(turn),
            )
            for x, z in corners
        ]

    def find_outline(self, prop: Prop) -> Outline:
        """Return a prop from above."""
        corners = [self.to_pixels(x, z) for x, z in self.find_corners(prop)]
        turn = radians(prop.turn[1])
        front = (corners[2] + corners[3]) / 2 + QPointF(sin(turn), cos(turn)) * (2.2 * HANDLE)
        return Outline(QPolygonF(corners), front)

    def find_prop(self, at: QPointF) -> str:
        """Return the id of the smallest prop at pixels, "" for none: what lies on a desk is above it."""
        found = []
        for ident, prop in self.props.items():
            corners = self.find_outline(prop).corners
            box = corners.boundingRect().adjusted(-3, -3, 3, 3)
            if corners.containsPoint(at, Qt.FillRule.WindingFill) or (
                box.contains(at) and min(box.width(), box.height()) < 16
            ):
                found.append((box.width() * box.height(), ident))
        return min(found, default=(0.0, ""))[1]

    def put_down(self, ident: str, prop: Prop, to: tuple[float, float]) -> Prop:
        """Return a prop at another place of the floor, x and z in metres. What lay on the floor or on a
        larger prop lies on what is below it there; what was lifted off stays as high.
        """
        return put_prop_down(self.session.document.project, self.meshes, ident, prop, to)

    def set_current(self, ident: str) -> None:
        """Show which prop is chosen."""
        self.current = ident
        self.update()

    # --- painting

    def paintEvent(self, event: QPaintEvent) -> None:
        look = get_theme(self.session.look.name)
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.fillRect(self.rect(), QColor(look.ground))
        painter.setPen(QPen(QColor(look.line), 1))
        metres = int(max(self.width(), self.height()) / 2 / self._scale()) + 1
        for n in range(-metres, metres + 1):
            across, down = self.to_pixels(n, 0), self.to_pixels(0, n)
            painter.drawLine(QPointF(across.x(), 0), QPointF(across.x(), self.height()))
            painter.drawLine(QPointF(0, down.y()), QPointF(self.width(), down.y()))
        painter.setPen(QColor(look.dim))
        words = QRectF(6, self.height() - 20, self.width() - 12, 18)
        painter.drawText(words, Qt.AlignmentFlag.AlignRight, tr("Viewer's side"))
        middle, radius = self.to_pixels(0, 0), 0.2 * self._scale()
        painter.setBrush(QColor(look.dim))
        painter.setPen(Qt.PenStyle.NoPen)
        painter.drawEllipse(middle, radius, 0.6 * radius)
        painter.drawEllipse(middle + QPointF(0, 0.25 * radius), 0.45 * radius, 0.45 * radius)
        for ident, prop in self.props.items():
            outline, chosen = self.find_outline(prop), ident == self.current
            fill = QColor(look.text if chosen else look.dim)
            fill.setAlpha(50)
            painter.setBrush(fill)
            painter.setPen(QPen(QColor(look.text if chosen else look.dim), 2 if chosen else 1))
            painter.drawPolygon(outline.corners)
            if chosen:
                painter.setBrush(QColor(look.text))
                painter.drawEllipse(outline.handle, HANDLE, HANDLE)
        painter.end()

    # --- mouse and keys

    def mousePressEvent(self, event: QMouseEvent) -> None:
        if event.button() != Qt.MouseButton.LeftButton:
            return
        at, now = event.position(), self.props.get(self.current)
        self._held = self._find_span()
        if now is not None:
            handle = self.find_outline(now).handle
            if hypot(handle.x() - at.x(), handle.y() - at.y()) <= 2 * HANDLE:
                self.hand.take(TurnDrag(self, self.current, now), at)
                return
        ident = self.find_prop(at)
        self.chosen.emit(ident)
        if ident:
            self.hand.take(MoveDrag(self, ident, self.props[ident]), at)

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        self.hand.move(event.position(), bool(event.modifiers() & Qt.KeyboardModifier.AltModifier))

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        self.hand.release(event)
        self._held = 0.0
        self.update()

    def event(self, event: QEvent) -> bool:
        """Keep Escape from the window's shortcuts while a drag lasts."""
        if (
            isinstance(event, QKeyEvent)
            and event.type() == QEvent.Type.ShortcutOverride
            and event.key() == Qt.Key.Key_Escape
            and self.hand.gesture is not None
        ):
            event.accept()
            return True
        return super().event(event)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        if event.key() == Qt.Key.Key_Escape and self.hand.drop("escape"):
            return
        nudge, now = NUDGES.get(Qt.Key(event.key())), self.props.get(self.current)
        if nudge is None or now is None:
            super().keyPressEvent(event)
            return
        to = (now.at[0] + nudge[0], now.at[2] + nudge[1])
        self.placing.drag(
            tr("Move {name}", name=now.name), self.current, self.put_down(self.current, now, to)
        )
        if not event.isAutoRepeat():
            self.placing.end()


class _PlanDrag(PropDrag):
    """Drags a prop on the plan."""

    def __init__(self, plan: FloorPlan, ident: str, before: Prop) -> None:
        super().__init__(plan.placing, ident, before)
        self.plan = plan


class MoveDrag(_PlanDrag):
    """Moves a prop over the floor."""

    def words(self) -> str:
        return tr("Move {name}", name=self.before.name)

    def place(self, at: QPointF, free: bool) -> Prop:
        (x0, z0), (x, z) = self.plan.to_floor(self.origin), self.plan.to_floor(at)
        to = (self.before.at[0] + x - x0, self.before.at[2] + z - z0)
        if not free:
            to = (round(to[0] / GRID) * GRID, round(to[1] / GRID) * GRID)
        return self.plan.put_down(self.ident, self.before, to)


class TurnDrag(_PlanDrag):
    """Turns a prop about the vertical, so that its front is towards the mouse."""

    def words(self) -> str:
        return tr("Turn {name}", name=self.before.name)

    def place(self, at: QPointF, free: bool) -> Prop:
        x, z = self.plan.to_floor(at)
        angle = degrees(atan2(x - self.before.at[0], z - self.before.at[2]))
        if not free:
            angle = round(angle / STEP) * STEP
        turn = (self.before.turn[0], round(angle, 1), self.before.turn[2])
        return msgspec.structs.replace(self.before, turn=turn)
