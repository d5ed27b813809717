"""The strip under the ruler's numbers: the range that is played again and again, and markers. What is under a
point, what a press and a menu do there, and how it is painted.
"""

from __future__ import annotations

from typing import Any, Literal

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QFont, QPainter, QPen, QPolygonF
from PySide6.QtWidgets import QInputDialog, QMenu

from app.features.timeline.drags.marker import MarkerDrag
from app.features.timeline.drags.range import Grip, RangeDrag
from app.look.theme import WindowTheme
from app.translation import tr
from app.widgets.lane_geometry import LEFT, NUMBERS, RULER, elide_text, measure_text_width
from metagraph.graph.timeline import Marker

EDGE = 5.0  # pixels on either side of an end of the range that take hold of it
FLAG = 6.0  # pixels of a marker to either side
What = Literal["marker", "range", "strip", "numbers"]


class Ruler:
    """view: the widget of the lanes."""

    def __init__(self, view: Any) -> None:
        self.view = view

    # --- what is where

    @property
    def range(self) -> tuple[float, float] | None:
        """The range as it is shown: as it is dragged, else as it is."""
        held = self.view.hand.gesture
        if isinstance(held, RangeDrag) and held.begun:
            return held.range
        return self.view.performance.timeline.range if self._whole else None

    @property
    def markers(self) -> list[tuple[Marker, float]]:
        """Markers and when they are shown: as they are dragged, else as they are."""
        held = self.view.hand.gesture
        if not self._whole:
            return []
        return [
            (m, held.at if isinstance(held, MarkerDrag) and held.marker.id == m.id else m.at)
            for m in self.view.performance.timeline.now.markers
        ]

    @property
    def _whole(self) -> bool:
        """Whether the whole performance is shown, which the notes are about."""
        return bool(self.view.session.transport.show == "plan")

    def marker_at(self, at: QPointF) -> Marker | None:
        if not NUMBERS <= at.y() <= RULER or at.x() < LEFT - FLAG:
            return None
        scale = self.view.scale()
        near = [
            (abs(scale.x(s) - at.x()), m) for m, s in self.markers if abs(scale.x(s) - at.x()) <= FLAG + 1
        ]
        return min(near, key=lambda n: n[0])[1] if near else None

    def grip_at(self, at: QPointF) -> Grip | None:
        """Return what of the range a press on the strip takes hold of; None elsewhere."""
        if not NUMBERS <= at.y() <= RULER or at.x() < LEFT or not self._whole:
            return None
        if self.range is not None:
            start, end = (self.view.scale().x(s) for s in self.range)
            if abs(at.x() - end) <= EDGE:
                return "out"
            if abs(at.x() - start) <= EDGE:
                return "in"
            if start < at.x() < end:
                return "whole"
        return "new"

    # --- the mouse

    def press(self, at: QPointF) -> bool:
        """Take hold of what is there; False if there is nothing to hold."""
        marker, grip = self.marker_at(at), self.grip_at(at)
        timeline = self.view.performance.timeline
        if marker is not None:
            timeline.select(marker.id)
            self.view.magnet.begin(self.view.snap_lines((marker.id,)))
            self.view.hand.take(MarkerDrag(self.view, marker), at)
        elif grip is not None:
            timeline.select(None)
            self.view.magnet.begin(
                self.view.snap_lines({"whole": ("in", "out"), "new": ("in", "out")}.get(grip, (grip,)))
            )
            self.view.hand.take(RangeDrag(self.view, grip), at)
        return marker is not None or grip is not None

    def cursor(self, at: QPointF) -> Qt.CursorShape | None:
        """Return the mouse's shape over the strip."""
        if self.marker_at(at) is not None or self.grip_at(at) == "whole":
            return Qt.CursorShape.OpenHandCursor
        grip = self.grip_at(at)
        return (
            Qt.CursorShape.SizeHorCursor
            if grip in ("in", "out")
            else Qt.CursorShape.ArrowCursor
            if grip
            else None
        )

    def rename(self, ident: str) -> None:
        timeline = self.view.performance.timeline
        marker = next((m for m in timeline.now.markers if m.id == ident), None)
        if marker is not None:
            name, ok = QInputDialog.getText(self.view, tr("Rename marker"), tr("Name"), text=marker.name)
            if ok:
                timeline.rename_marker(ident, name)

    def menu(self, at: QPointF) -> QMenu:
        """Return what can be done at a place of the ruler."""
        timeline, seconds = self.view.performance.timeline, max(0.0, self.view.scale().seconds(at.x()))
        menu, marker = QMenu(self.view), self.marker_at(at)
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        if marker is not None:
            timeline.select(marker.id)
            menu.addAction(tr("Rename marker…\tdouble-click"), lambda: self.rename(marker.id))
            menu.addAction(tr("Remove marker\tDel"), lambda: timeline.remove_marker(marker.id))
            menu.addSeparator()
        else:
            menu.addAction(tr("Add marker here\tM at the playhead"), lambda: timeline.add_marker(seconds))
        many = menu.addAction(tr("Remove all markers"), lambda: timeline.remove_marker())
        many.setEnabled(bool(timeline.now.markers))
        menu.addSeparator()
        menu.addAction(tr("Set loop start here\tI at the playhead"), lambda: timeline.set_in(seconds))
        menu.addAction(tr("Set loop end here\tO at the playhead"), lambda: timeline.set_out(seconds))
        clear = menu.addAction(tr("Clear loop range\tCtrl+Shift+X"), timeline.clear_range)
        clear.setEnabled(timeline.range is not None)
        menu.addSeparator()
        menu.addAction(tr("Zoom to all\tShift+Z"), self.view.zoom_all)
        menu.addAction(tr("Zoom to selection\tZ"), self.view.zoom_selection)
        return menu

    def tip(self, at: QPointF) -> str:
        marker = self.marker_at(at)
        if marker is not None:
            how = tr("Drag to move it, double-click to rename it, press Delete to remove it")
            return tr("{name}, at {at:.2f} s\n{how}", name=marker.name or tr("Marker"), at=marker.at, how=how)
        found = self.range
        if self.grip_at(at) is None:
            return ""
        if found is not None:
            words = tr(
                "Loop range: {start:.2f} to {end:.2f} s ({length:.2f} s)",
                start=found[0],
                end=found[1],
                length=found[1] - found[0],
            )
            return tr("{words}\nDrag it or its ends to change it. Ctrl+Shift+X clears it.", words=words)
        return tr("Drag here to set the loop range (I and O set its ends)")

    # --- painting

    def paint(self, painter: QPainter, t: WindowTheme, width: float, height: float) -> None:
        """Paint range, markers and the line that is snapped to, over the lanes."""
        scale, found = self.view.scale(), self.range
        painter.save()
        painter.setClipRect(QRectF(LEFT - FLAG, 0, width, height))
        if found is not None:
            self._paint_range(painter, t, scale.x(found[0]), scale.x(found[1]), width, height)
        painter.setClipRect(QRectF(LEFT - FLAG, 0, width, height))
        shown = self.markers
        for n, (marker, at) in enumerate(shown):
            following = scale.x(shown[n + 1][1]) if n + 1 < len(shown) else width
            self._paint_marker(painter, t, marker, scale.x(at), following - FLAG - 2, height)
        line = self.view.magnet.line
        if line is not None:
            x = scale.x(line.at)
            painter.setPen(QPen(QColor(t.text), 1, Qt.PenStyle.DashLine))
            painter.drawLine(QPointF(x, NUMBERS), QPointF(x, height))
        painter.restore()

    def _paint_range(
        self, painter: QPainter, t: WindowTheme, left: float, right: float, width: float, height: float
    ) -> None:
        if right < LEFT or left > width:
            return
        veil = QColor(t.ground)
        veil.setAlpha(60)
        for a, b in ((float(LEFT), left), (right, width)):
            if b > a:
                painter.fillRect(QRectF(a, RULER, b - a, height - RULER), veil)
        strip = QColor(t.strong)
        strip.setAlpha(90)
        painter.fillRect(QRectF(left, NUMBERS + 2, right - left, RULER - NUMBERS - 3), strip)
        painter.setPen(QPen(QColor(t.text), 2))
        for x, inward in ((left + 1, 4), (right - 1, -4)):
            painter.drawPolyline(
                [QPointF(x + inward, NUMBERS + 2), QPointF(x, NUMBERS + 2), QPointF(x, RULER - 2),
                 QPointF(x + inward, RULER - 2)]
            )  # fmt: skip
        edge = QColor(t.text)
        edge.setAlpha(110)
        painter.setPen(QPen(edge, 1, Qt.PenStyle.DotLine))
        for x in (left, right):
            painter.drawLine(QPointF(x, RULER), QPointF(x, height))

    def _paint_marker(
        self, painter: QPainter, t: WindowTheme, marker: Marker, x: float, until: float, height: float
    ) -> None:
        if x < LEFT - FLAG or x > self.view.width() + FLAG:
            return
        chosen = marker.id == self.view.performance.timeline.marker
        color = QColor(t.text if chosen else t.dim)
        faint = QColor(color)
        faint.setAlpha(160 if chosen else 90)
        painter.setPen(QPen(faint, 1))
        painter.drawLine(QPointF(x, RULER - 3), QPointF(x, height))
        top, flag = NUMBERS + 1.0, FLAG - 1
        corners = ((-flag, top), (flag, top), (flag, top + 6), (0, RULER - 1), (-flag, top + 6))
        shape = [QPointF(x + dx, y) for dx, y in corners]
        painter.setPen(QPen(QColor(t.text), 2 if chosen else 1))
        painter.setBrush(QColor(t.strong) if chosen else QColor(t.card))
        painter.drawPolygon(QPolygonF(shape))
        room = until - x - FLAG - 3
        if marker.name and room > 14:
            font = QFont(painter.font())
            font.setPixelSize(max(9, round(painter.fontInfo().pixelSize() * 0.85)))
            words = elide_text(marker.name, font.toString(), int(room))
            ground = QColor(t.panel)
            ground.setAlpha(200)
            painter.fillRect(
                QRectF(
                    x + FLAG, NUMBERS + 1, measure_text_width(words, font.toString()) + 4, RULER - NUMBERS - 2
                ),
                ground,
            )
            painter.save()
            painter.setFont(font)
            painter.setPen(QColor(t.text))
            painter.drawText(
                QRectF(x + FLAG + 2, NUMBERS, room, RULER - NUMBERS), Qt.AlignmentFlag.AlignVCenter, words
            )
            painter.restore()
