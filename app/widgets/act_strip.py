"""Acts in time: a strip for each layer, the left arm above, the right below, both across. Shows what was seen
and what a model makes.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from PySide6.QtCore import QEvent, QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QFontMetricsF, QHelpEvent, QMouseEvent, QPainter, QPaintEvent, QWheelEvent
from PySide6.QtWidgets import QToolTip, QWidget

from app.look.theme import KIND_MARKS, WindowTheme, get_theme
from app.stage.session import StageSession
from app.translation import format_number, tr
from app.widgets.vocabulary import get_vocabulary_title
from metagraph.graph.model import KINDS, Layer
from metagraph.playback.learning.learn import Act, describe_state, get_act_state

LEFT, RULER, LANE = 56, 20, 34
STEPS = (0.5, 1.0, 2.0, 5.0, 10.0, 15.0, 30.0, 60.0, 120.0, 300.0, 600.0, 1800.0, 3600.0)
NARROWEST, ROUND = 2.0, 4.0  # pixels of an act, and from how many on it has round corners


def place_act(lane: QRectF, act: Act, layer: Layer) -> tuple[float, float]:
    """Return top and height of an act in its lane: only arms have sides."""
    if layer != "arms" or act.limb == "both":
        return lane.top(), lane.height()
    half = (lane.height() - 2) / 2
    return (lane.top(), half) if act.limb == "left" else (lane.bottom() - half, half)


def format_clock(seconds: float) -> str:
    """Return "12 s", "1:05", "1:00:05"."""
    if seconds < 60:
        return f"{format_number(seconds, 'g')} s"
    hours, rest = divmod(round(seconds), 3600)
    minutes, left = divmod(rest, 60)
    return f"{hours}:{minutes:02d}:{left:02d}" if hours else f"{minutes}:{left:02d}"


class ActStrip(QWidget):
    """The wheel zooms where the pointer is, dragging moves along; hovering tells what an act is."""

    def __init__(self, session: StageSession, parent: QWidget, titles: bool = True) -> None:
        super().__init__(parent)
        self.session = session
        self.left = LEFT if titles else 8
        self.acts: Mapping[Layer, Sequence[Act]] = {}
        self.seconds = 60.0
        self.first, self.zoom = 0.0, 1.0
        self._grip: float | None = None
        self.setMouseTracking(True)
        self.setAccessibleName(tr("Activity of each layer"))
        session.look.changed.connect(self.update)

    def show_acts(self, acts: Mapping[Layer, Sequence[Act]], seconds: float | None = None) -> None:
        """Show acts by layer; seconds: how long the strip is, None for as long as it takes."""
        whole = (
            seconds
            if seconds is not None
            else max((a.end for some in acts.values() for a in some), default=0.0) or 60.0
        )
        if whole != self.seconds:
            self.first, self.zoom = 0.0, 1.0
        self.acts, self.seconds = acts, whole
        self.setMinimumHeight(RULER + LANE * max(1, len(acts)) + 2)
        self.update()

    # --- geometry

    def each(self) -> float:
        """Pixels a second."""
        return max(1.0, self.width() - self.left - 8) / self.seconds * self.zoom

    def x_at(self, seconds: float) -> float:
        return self.left + (seconds - self.first) * self.each()

    def lane(self, row: int) -> QRectF:
        height = min(46.0, max(18.0, (self.height() - RULER) / max(1, len(self.acts))))
        return QRectF(self.left, RULER + row * height + 3, max(1, self.width() - self.left - 8), height - 6)

    def act_at(self, at: QPointF) -> tuple[Layer, Act] | None:
        """Return the act under a point, the last drawn first."""
        for row, (layer, acts) in enumerate(self.acts.items()):
            lane = self.lane(row)
            for act in reversed(acts):
                top, height = place_act(lane, act, layer)
                width = max(NARROWEST, act.length * self.each())
                if QRectF(self.x_at(act.start), top, width, height).contains(at):
                    return layer, act
        return None

    # --- painting

    def paintEvent(self, event: QPaintEvent) -> None:
        t = get_theme(self.session.look.name)
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        self._ruler(painter, t)
        for row, (layer, acts) in enumerate(self.acts.items()):
            lane = self.lane(row)
            if self.left >= LEFT:
                painter.setPen(QColor(t.dim))
                painter.drawText(
                    QRectF(2, lane.top(), LEFT - 8, lane.height()),
                    Qt.AlignmentFlag.AlignVCenter,
                    get_vocabulary_title(layer),
                )
            painter.setPen(Qt.PenStyle.NoPen)
            painter.setBrush(QColor(t.field))
            painter.drawRoundedRect(lane, 4, 4)
            painter.save()
            painter.setClipRect(lane)
            each, fills = self.each(), {kind: t.fill(kind) for kind in KINDS}
            for act in acts:
                left, width = self.left + (act.start - self.first) * each, max(NARROWEST, act.length * each)
                if left + width >= lane.left() and left <= lane.right():
                    top, height = place_act(lane, act, layer)
                    if width < ROUND:
                        painter.fillRect(QRectF(left, top, width, height), fills[act.kind])
                    else:
                        self._act(painter, QRectF(left, top, width - 1, height), act, fills[act.kind])
            painter.restore()
        painter.end()

    def _ruler(self, painter: QPainter, t: WindowTheme) -> None:
        each = self.each()
        step = next((s for s in STEPS if s * each >= 58), STEPS[-1])
        painter.setPen(QColor(t.dim))
        n = int(self.first // step)
        while (x := self.x_at(n * step)) < self.width() - 4:
            if x >= self.left - 1:
                width = 80.0
                box = (
                    QRectF(x - 2, 0, width, RULER)
                    if x < self.left + 2
                    else QRectF(x - width / 2, 0, width, RULER)
                )
                side = Qt.AlignmentFlag.AlignLeft if x < self.left + 2 else Qt.AlignmentFlag.AlignHCenter
                if x + width / 4 < self.width():
                    painter.drawText(box, side | Qt.AlignmentFlag.AlignVCenter, format_clock(n * step))
            n += 1

    def _act(self, painter: QPainter, rect: QRectF, act: Act, fill: QColor) -> None:
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(fill)
        painter.drawRoundedRect(rect, 3, 3)
        sign = {"positive": "+", "negative": "−"}.get(act.tags[0] if act.tags else "", "")
        if rect.width() > 12 and rect.height() > 12:
            metrics, mark = QFontMetricsF(painter.font()), KIND_MARKS[act.kind]
            words = next(
                (w for w in (mark + sign, mark) if metrics.horizontalAdvance(w) + 3 < rect.width()), ""
            )
            painter.setPen(QColor("#17181b"))
            painter.drawText(rect, Qt.AlignmentFlag.AlignCenter, words)

    # --- the mouse

    def wheelEvent(self, event: QWheelEvent) -> None:
        at = self.first + (event.position().x() - self.left) / self.each()
        self.zoom = min(
            max(1.0, self.seconds / 4), max(1.0, self.zoom * 1.2 ** (event.angleDelta().y() / 120))
        )
        self._move_to(at - (event.position().x() - self.left) / self.each())
        event.accept()

    def _move_to(self, first: float) -> None:
        self.first = min(max(0.0, first), self.seconds * (1 - 1 / self.zoom))
        self.update()

    def mousePressEvent(self, event: QMouseEvent) -> None:
        self._grip = event.position().x()

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        if self._grip is not None and event.buttons() & Qt.MouseButton.LeftButton:
            self._move_to(self.first - (event.position().x() - self._grip) / self.each())
            self._grip = event.position().x()

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        self._grip = None

    def event(self, event: QEvent) -> bool:
        if isinstance(event, QHelpEvent):
            found = self.act_at(QPointF(event.pos()))
            words = ""
            if found is not None:
                layer, act = found
                words = tr(
                    "{state}\n{start:.2f} to {end:.2f} s, {length:.2f} s long",
                    state=describe_state(get_act_state(act, True), layer),
                    start=act.start,
                    end=act.end,
                    length=act.length,
                )
            QToolTip.showText(event.globalPos(), words, self)
            return True
        return super().event(event)
