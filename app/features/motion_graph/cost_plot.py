"""Plot the costs of jumps: the histogram of costs between frames that are a few apart, the fitted
distribution, and the threshold.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pyqtgraph as pg
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QVBoxLayout, QWidget

from app.look.theme import get_theme
from app.stage.session import StageSession
from app.translation import tr
from app.widgets.still_plot import clear_plot, make_still_plot

BINS = 80
BEYOND = 0.995  # share of all costs that the plot shows


class CostPlot(QWidget):
    """Shows a `synthesis.graph.Threshold`."""

    def __init__(self, session: StageSession, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.session = session
        self.shown: Any = None
        self.plot = make_still_plot(self)
        self.plot.getAxis("left").setStyle(showValues=False)
        self.plot.getAxis("left").setWidth(12)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(self.plot)
        self.setMinimumHeight(170)
        session.look.changed.connect(self._draw)
        self._draw()

    def show_threshold(self, found: Any) -> None:
        self.shown = found
        self._draw()

    def _draw(self) -> None:
        look = get_theme(self.session.look.name)
        clear_plot(self.plot, look)
        self.plot.setLabel("bottom", tr("cost, m"), color=look.dim)
        found = self.shown
        if found is None:
            return
        end = max(float(np.quantile(found.costs, BEYOND)), 1.15 * found.limit, 1.15 * found.observed, 1e-6)
        counts, edges = np.histogram(found.costs, BINS, (0.0, end))
        density = counts / max(1, len(found.costs)) / (edges[1] - edges[0])
        bars = pg.PlotDataItem(
            edges, density, stepMode="center", fillLevel=0, brush=look.hover, pen=pg.mkPen(look.dim, width=1)
        )
        self.plot.addItem(bars)
        if found.distribution is not None:
            x = np.linspace(0, end, 400)
            fitted = np.diff(found.distribution.cdf(x)) / np.diff(x)
            self.plot.addItem(
                pg.PlotDataItem(x[:-1] + (x[1] - x[0]) / 2, fitted, pen=pg.mkPen(look.text, width=2))
            )
        top = 1.08 * max(float(density.max()), 1e-9)
        for at, style in ((found.limit, Qt.PenStyle.SolidLine), (found.observed, Qt.PenStyle.DotLine)):
            self.plot.addItem(
                pg.PlotDataItem([at, at], [0, top], pen=pg.mkPen(look.warning, width=2, style=style))
            )
        self.plot.setXRange(0, end, padding=0)
        self.plot.setYRange(0, top, padding=0)
