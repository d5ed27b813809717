"""Plot a training: the distance to its goal, and the statistics of its samples beside their targets."""

from __future__ import annotations

from collections.abc import Mapping
from math import isfinite

import pyqtgraph as pg
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QHBoxLayout, QWidget

from app.look.theme import get_theme
from app.stage.session import StageSession
from app.translation import make_lazy_texts, tr
from app.widgets.still_plot import clear_plot, make_still_plot

# Statistics of which 1 is right, as people read them; others are reported in words.
RATIOS = make_lazy_texts(
    lambda: {
        "speed": tr("speed"),
        "trembling": tr("jitter"),
        "wrist_range": tr("reach"),
        "profile": tr("stresses met"),
    }
)
STYLES = (
    Qt.PenStyle.SolidLine,
    Qt.PenStyle.DashLine,
    Qt.PenStyle.DotLine,
    Qt.PenStyle.DashDotLine,
    Qt.PenStyle.DashDotDotLine,
)
HIGHEST = 3.0  # of a ratio, as far as it is drawn
MOST = 2000  # points of a line, the rest is thinned out


class TrainingPlots(QWidget):
    """Two plots side by side, over minutes."""

    def __init__(self, session: StageSession, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.session = session
        self.goals: dict[str, list[tuple[float, float]]] = {}
        self.ratios: dict[str, list[tuple[float, float]]] = {}
        layout = QHBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(10)
        self.left, self.right = (make_still_plot(self) for _ in range(2))
        for plot, name in (
            (self.left, tr("Progress of the training")),
            (self.right, tr("Statistics of the samples")),
        ):
            plot.setAccessibleName(name)
            layout.addWidget(plot)
        self.setMinimumHeight(170)
        session.look.changed.connect(self._draw)
        self._draw()

    def clear(self) -> None:
        self.goals, self.ratios = {}, {}
        self._draw()

    def add(self, minutes: float, goals: Mapping[str, float], ratios: Mapping[str, float]) -> None:
        """Add a moment. goals: progress by goal. ratios: 1 is the target."""
        for lines, values in ((self.goals, goals), (self.ratios, ratios)):
            for name, value in values.items():
                if isfinite(value):
                    line = lines.setdefault(name, [])
                    line.append((minutes, value))
                    if len(line) > MOST:
                        del line[1 : MOST // 2 : 2]
        self._draw()

    def _draw(self) -> None:
        look = get_theme(self.session.look.name)
        colours = (look.text, look.warning, look.dim, look.error, look.text)
        for plot, words, lines in (
            (self.left, next(iter(self.goals), tr("training goal")), self.goals),
            (self.right, tr("samples compared with takes: 1 is a perfect match"), self.ratios),
        ):
            clear_plot(plot, look)
            plot.setLabel("bottom", tr("minutes"), color=look.dim)
            plot.setTitle(words, color=look.dim, size="9pt")
            if lines is self.ratios:
                legend = plot.addLegend(
                    offset=(-4, 2), colCount=2, labelTextColor=look.dim, labelTextSize="8pt"
                )
                legend.clear()
            for n, (name, points) in enumerate(lines.items()):
                high = HIGHEST if lines is self.ratios else float("inf")
                pen = pg.mkPen(colours[n % 5], width=2, style=STYLES[n % 5])
                xs, ys = [p[0] for p in points], [min(p[1], high) for p in points]
                item = pg.PlotDataItem(xs, ys, pen=pen, name=name)
                if len(points) == 1:
                    item.setSymbol("o")
                    item.setSymbolSize(5)
                    item.setSymbolPen(None)
                    item.setSymbolBrush(colours[n % 5])
                plot.addItem(item)
            last = max((points[-1][0] for points in lines.values()), default=0.0)
            plot.setXRange(0, max(1.0, last), padding=0.02)
            if lines is self.ratios:
                plot.setYRange(0, HIGHEST / 2 if not lines else HIGHEST, padding=0)
                plot.addItem(pg.InfiniteLine(1.0, 0, pg.mkPen(look.line, width=1)))
