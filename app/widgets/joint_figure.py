"""Show a skeleton's joints as a figure from the front. A click or a drag sets which joints move, and how
much.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np
from PySide6.QtCore import QEvent, QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QColor, QFont, QHelpEvent, QMouseEvent, QPainter, QPaintEvent, QPen, QWheelEvent
from PySide6.QtWidgets import QToolTip, QWidget

from app.look.theme import get_theme
from app.translation import format_number, tr
from metagraph.motion.skeleton import Skeleton
from preview.joints import is_control

MARGIN, LEAST, MOST, NEAR = 18.0, 2.5, 6.0, 11.0  # pixels
NUMBERS = 8.0  # points


class JointFigure(QWidget):
    """clicked: the joint that was clicked. circled: the joints within a drag's rectangle, and whether they
    are to move: by the left button, or, with Alt or the right one, not. turned: the joint under the pointer,
    "" if there is none, and by how many notches the wheel was turned there.
    """

    clicked = Signal(str)
    circled = Signal(object, bool)
    turned = Signal(str, int)

    def __init__(self, skeleton: Skeleton, look: str, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._skeleton, self._look = skeleton, get_theme(look)
        self._seen = measure_front_positions(skeleton)
        self._helpers = [is_control(name) for name in skeleton.names]  # no bone leads to them
        self._weights: Mapping[str, float] = {}
        self._wheel = 0  # eighths of a degree that are no whole notch yet
        self._under: int | None = None  # the joint under the pointer
        self._from: QPointF | None = None  # where a drag began
        self._to = QPointF()
        self.setMouseTracking(True)
        self.setAccessibleName(tr("Joints as a figure"))
        self.setAccessibleDescription(tr("For the mouse. The list beside it has the same joints."))

    def sizeHint(self) -> QSize:
        return QSize(300, 480)

    def show_weights(self, weights: Mapping[str, float]) -> None:
        """Show how far joints move, 0..1; not at all those that are not named."""
        self._weights = dict(weights)
        self.update()

    def place_of(self, joint: str) -> QPointF:
        """Return where a joint is drawn."""
        return QPointF(*self._places()[self._skeleton.index(joint)])

    def _places(self) -> np.ndarray:
        """Return `[J, 2]` where joints are drawn, pixels."""
        low, high = self._seen.min(0), self._seen.max(0)
        span = np.maximum(high - low, 1e-6)
        room = np.array([self.width(), self.height()]) - 2 * MARGIN
        scale = float((room / span).min())
        middle = np.array([self.width(), self.height()]) / 2
        return (self._seen - (low + high) / 2) * [scale, -scale] + middle

    def _joint_at(self, point: QPointF) -> int | None:
        away = np.hypot(*(self._places() - [point.x(), point.y()]).T)
        nearest = int(away.argmin())
        return nearest if away[nearest] <= NEAR else None

    def paintEvent(self, event: QPaintEvent) -> None:
        places, skeleton, t = self._places(), self._skeleton, self._look
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        weights = [self._weights.get(name, 0.0) for name in skeleton.names]
        moving = [weight > 0 for weight in weights]
        strong, weak = t.fill("gesture"), QColor(t.line)
        shades = [_between(QColor(t.panel), strong, weight) for weight in weights]
        for on in (False, True):  # what moves is drawn over what does not
            for joint, parent in enumerate(skeleton.parents):
                if parent >= 0 and moving[joint] is on:
                    line = _between(weak, strong, weights[joint]) if on else weak
                    pen = QPen(line, 5 if on else 3, Qt.PenStyle.SolidLine, Qt.PenCapStyle.RoundCap)
                    painter.setPen(QPen(line, 1, Qt.PenStyle.DotLine) if self._helpers[joint] else pen)
                    painter.drawLine(QPointF(*places[parent]), QPointF(*places[joint]))
        for joint, radius in enumerate(self._radii(places)):
            chosen = joint == self._under
            painter.setPen(QPen(QColor(t.text), 2 if chosen else 1))
            # Filled or hollow, so that no colour is needed to tell.
            painter.setBrush(shades[joint])
            painter.drawEllipse(QPointF(*places[joint]), radius + 2 * chosen, radius + 2 * chosen)
        self._write_numbers(painter, places, weights)
        if self._from is not None and (self._to - self._from).manhattanLength() > 4:
            painter.setPen(QPen(QColor(t.text), 1, Qt.PenStyle.DashLine))
            painter.setBrush(Qt.BrushStyle.NoBrush)
            painter.drawRect(QRectF(self._from, self._to).normalized())
        painter.end()

    def _write_numbers(self, painter: QPainter, places: np.ndarray, weights: Sequence[float]) -> None:
        """Write how far joints move beside those that move in part, wherever there is room."""
        painter.setFont(QFont(self.font().family(), int(NUMBERS)))
        painter.setPen(QColor(self._look.text))
        taken: list[QRectF] = []
        for joint, weight in enumerate(weights):
            if not 0 < weight < 1:
                continue
            words = format_weight(weight)
            box = QRectF(painter.fontMetrics().boundingRect(words))
            box.moveCenter(QPointF(places[joint][0] + 10 + box.width() / 2, places[joint][1]))
            box.moveRight(min(box.right(), self.width() - 2.0))
            if joint == self._under or not any(box.intersects(other) for other in taken):
                painter.fillRect(box, QColor(self._look.panel))
                painter.drawText(box, Qt.AlignmentFlag.AlignCenter, words)
                taken.append(box)

    def _radii(self, places: np.ndarray) -> np.ndarray:
        """Return how large joints are drawn: smaller where they are close together, as in hands."""
        away = np.hypot(*(places[:, None] - places[None]).transpose(2, 0, 1))
        away[away < 1e-6] = np.inf  # the same place: one covers the other
        return np.clip(away.min(1) / 2.5, LEAST, np.where(self._helpers, LEAST, MOST))

    def mousePressEvent(self, event: QMouseEvent) -> None:
        self._from = self._to = event.position()

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        self._to = event.position()
        self._under = self._joint_at(event.position()) if self._from is None else None
        self.setCursor(
            Qt.CursorShape.PointingHandCursor if self._under is not None else Qt.CursorShape.ArrowCursor
        )
        self.update()

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        if self._from is None:
            return
        begun, self._from = self._from, None
        if (event.position() - begun).manhattanLength() <= 4:
            joint = self._joint_at(event.position())
            if joint is not None:
                self.clicked.emit(self._skeleton.names[joint])
        else:
            area = QRectF(begun, event.position()).normalized()
            inside = [
                name
                for name, at in zip(self._skeleton.names, self._places(), strict=True)
                if area.contains(QPointF(*at))
            ]
            off = event.button() == Qt.MouseButton.RightButton or bool(
                event.modifiers() & Qt.KeyboardModifier.AltModifier
            )
            self.circled.emit(tuple(inside), not off)
        self.update()

    def wheelEvent(self, event: QWheelEvent) -> None:
        self._wheel += event.angleDelta().y()
        notches, self._wheel = int(self._wheel / 120), int(math.fmod(self._wheel, 120))
        joint = self._joint_at(event.position())
        if notches:
            self.turned.emit(self._skeleton.names[joint] if joint is not None else "", notches)
        event.accept()

    def leaveEvent(self, event: QEvent) -> None:
        self._under = None
        self.update()

    def event(self, event: QEvent) -> bool:
        if event.type() == QEvent.Type.ToolTip and isinstance(event, QHelpEvent):
            joint = self._joint_at(QPointF(event.pos()))
            name = self._skeleton.names[joint] if joint is not None else ""
            words = f"{name}  {format_weight(self._weights.get(name, 0.0))}" if name else ""
            QToolTip.showText(event.globalPos(), words, self)
            return True
        return super().event(event)


def format_weight(weight: float) -> str:
    """Return a weight as it is shown, such as 0.25, and 1."""
    return format_number(round(weight, 2), "g")


def _between(low: QColor, high: QColor, share: float) -> QColor:
    return QColor.fromRgbF(
        low.redF() + (high.redF() - low.redF()) * share,
        low.greenF() + (high.greenF() - low.greenF()) * share,
        low.blueF() + (high.blueF() - low.blueF()) * share,
    )


def measure_front_positions(skeleton: Skeleton) -> np.ndarray:
    """Return `[J, 2]` where joints are, right and up, metres, of somebody in the rest pose who is looked at
    from the front.
    """
    _, positions = skeleton.globals(skeleton.rest)
    return np.asarray(positions[:, :2], float)
