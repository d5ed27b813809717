"""Make plots that only show data: the mouse moves nothing in them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import pyqtgraph as pg
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QWidget

from app.look.theme import WindowTheme
from app.translation import localize_number

AXES = ("left", "bottom")


class NumberAxis(pg.AxisItem):
    """An axis whose numbers are written as the chosen language writes them."""

    def tickStrings(self, values: Sequence[float], scale: float, spacing: float) -> list[str]:
        return [localize_number(text) for text in super().tickStrings(values, scale, spacing)]


def make_number_axes() -> dict[str, NumberAxis]:
    """Return the axes of a plot by their places, for `pyqtgraph.PlotWidget`."""
    return {place: NumberAxis(place) for place in AXES}


def make_still_plot(parent: QWidget) -> Any:
    """Return an empty plot without menu, zoom or focus, with axes that keep their unit."""
    plot = pg.PlotWidget(parent, axisItems=make_number_axes(), enableMenu=False)
    plot.setMouseEnabled(False, False)
    plot.hideButtons()
    plot.setFocusPolicy(Qt.FocusPolicy.NoFocus)
    for axis in AXES:
        plot.getAxis(axis).enableAutoSIPrefix(False)
    return plot


def clear_plot(plot: Any, look: WindowTheme) -> None:
    """Remove everything from a plot, and give it the theme's colours."""
    plot.clear()
    plot.setBackground(look.panel)
    for axis in AXES:
        plot.getAxis(axis).setPen(look.line)
        plot.getAxis(axis).setTextPen(look.dim)
