"""Beneath the timing: when a clip can be entered and left without a visible jump, and how far off it is
elsewhere.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pyqtgraph as pg
from PySide6.QtCore import QEvent, QPointF, Qt
from PySide6.QtGui import QColor, QHelpEvent
from PySide6.QtWidgets import QToolTip, QWidget

from app.look.theme import WindowTheme
from app.translation import tr, tr_phrase
from metagraph.graph.model import Action, Project

if TYPE_CHECKING:
    from metagraph.suggest.jumps.seen_jumps import SeenJumps

HEIGHT = 58
TOP = 2.4  # of what shows as a jump; more is cut off
BAR = 0.22  # height of the allowed spans


class JumpStrip(pg.PlotWidget):
    """A thin plot under the timing's, in step with it."""

    def __init__(self, parent: QWidget, above: pg.PlotWidget) -> None:
        super().__init__(parent, enableMenu=False)
        self.seen: SeenJumps | None = None
        self.subject: tuple[Project, Action] | None = None
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.setMouseEnabled(False, False)
        self.hideButtons()
        self.setFixedHeight(HEIGHT)
        self.setXLink(above)
        self.setYRange(0, TOP, padding=0)
        left = self.getAxis("left")
        left.setWidth(above.getAxis("left").width())
        left.setTicks([])
        self.hideAxis("bottom")
        self.setAccessibleName(tr("Where it can start and end without a visible jump"))
        self.bars = pg.BarGraphItem(x0=[], x1=[], y0=0, height=BAR)
        self.bad = pg.PlotDataItem(connect="finite", antialias=True)
        self.good = pg.PlotDataItem(connect="finite", antialias=True)
        self.limit = pg.InfiniteLine(pos=1.0, angle=0, movable=False)
        self.words = pg.TextItem(tr("visible jump"), anchor=(0.5, 1.0))
        self.marks = pg.ScatterPlotItem(size=12)
        self.edges = [pg.InfiniteLine(movable=False) for _ in range(2)]
        for item in (self.bars, self.limit, *self.edges, self.bad, self.good, self.marks):
            self.addItem(item)
        self.addItem(self.words, ignoreBounds=True)
        self.plotItem.vb.sigResized.connect(lambda _: self._put_words())
        self.plotItem.vb.sigXRangeChanged.connect(lambda *_: self._put_words())

    def restyle(self, t: WindowTheme, color: QColor) -> None:
        if self._look == (t.name, color):
            return
        self._look = t.name, QColor(color)
        self.setBackground(t.panel)
        axis = self.getAxis("left")
        axis.setPen(pg.mkPen(None))
        fill = QColor(color)
        fill.setAlpha(120)
        self.bars.setOpts(brush=fill, pen=pg.mkPen(None))
        self.good.setPen(pg.mkPen(t.text, width=1.6))
        self.bad.setPen(pg.mkPen(t.warning, width=1.6, style=Qt.PenStyle.DotLine))
        self.limit.setPen(pg.mkPen(t.dim, width=1, style=Qt.PenStyle.DashLine))
        self.words.setColor(t.dim)
        self.marks.setPen(pg.mkPen(t.panel, width=1))
        self.marks.setBrush(pg.mkBrush(t.text))
        for edge in self.edges:
            edge.setPen(pg.mkPen(t.text, width=1.4))

    def show_seen(self, project: Project, action: Action, seen: SeenJumps | None) -> None:
        """Show an action's curves, or nothing."""
        self.seen, self.subject = seen, (project, action)
        if seen is None:
            if self._drawn is None:
                return
            self._drawn = None
            for item in (self.bad, self.good):
                item.setData([], [])
            self.marks.setData([], [])
            self.bars.setOpts(x0=[], x1=[])
            for edge in self.edges:
                edge.hide()
            return
        curve, p, span = np.minimum(seen.curve(), TOP), seen.proposed, project.span(action)
        drawn = (seen.loops, p.start, p.end, *span, curve.tobytes(), seen.times.tobytes())
        if drawn == self._drawn:
            return  # as after most edits; it would all be painted again
        self._drawn = drawn
        above = curve > 1
        self.good.setData(seen.times, np.where(above, np.nan, curve))
        wide = above.copy()  # the dotted part touches the plain one
        wide[:-1] |= above[1:]
        wide[1:] |= above[:-1]
        self.bad.setData(seen.times, np.where(wide, curve, np.nan))
        spans = seen.spans()
        self.bars.setOpts(x0=[a for a, _ in spans], x1=[b for _, b in spans])
        spots: list[dict[str, Any]] = [{"pos": (p.end, BAR * 2), "symbol": "t3"}]
        if not seen.loops:
            spots.append({"pos": (p.start, BAR * 2), "symbol": "t2"})
        self.marks.setData(spots)
        for edge, value in zip(self.edges, span, strict=True):
            edge.setVisible(True)
            edge.setValue(value)
        shows = seen.times[above]  # its words stand beneath what it is about, clear of the ends
        self.words.setVisible(len(shows) > 0)
        self._shows = (float(shows[0] + shows[-1]) / 2) if len(shows) else 0.0
        self._put_words()

    _look: tuple[str, QColor] | None = None
    _drawn: tuple[object, ...] | None = None  # all that the curves and marks are of
    _shows = 0.0  # seconds, the middle of what its words are about

    def _put_words(self) -> None:
        low, high = self.viewRange()[0]
        half = (self.words.boundingRect().width() / 2 + 2) * self.plotItem.vb.viewPixelSize()[0]
        self.words.setPos(max(low + half, min(self._shows, high - half)), 1.0)

    def tip(self, at: QPointF) -> str:
        """Say what a point of the strip means."""
        if self.seen is None or self.subject is None:
            return ""
        from metagraph.suggest.jumps.seen_jumps import find_words_at

        seconds = float(self.plotItem.vb.mapSceneToView(at).x())
        seconds = min(max(0.0, seconds), float(self.seen.times[-1]))
        more = tr("\nThe marks show the proposed times. Hold Alt while dragging to avoid snapping to them.")
        return tr_phrase(find_words_at(*self.subject, self.seen, seconds)) + more

    def viewportEvent(self, event: QEvent) -> bool:
        if event.type() == QEvent.Type.ToolTip and isinstance(event, QHelpEvent):
            QToolTip.showText(event.globalPos(), self.tip(self.mapToScene(event.pos())), self)
            return True
        return bool(super().viewportEvent(event))
