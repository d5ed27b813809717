"""Plots that are looked at: nothing in them moves when a mouse does."""

from __future__ import annotations

from typing import Any

import pyqtgraph as pg
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QWidget

from app.look.theme import WindowTheme

AXES = ("left", "bottom")


def still_plot(parent: QWidget) -> Any:
    """Return an empty plot without menu, zoom or focus, whose axes keep their unit."""
    plot = pg.PlotWidget(parent)
    plot.setMenuEnabled(False)
    plot.setMouseEnabled(False, False)
    plot.hideButtons()
    plot.setFocusPolicy(Qt.FocusPolicy.NoFocus)
    for axis in AXES:
        plot.getAxis(axis).enableAutoSIPrefix(False)
    return plot


def empty_plot(plot: Any, look: WindowTheme) -> None:
    """Take everything out of a plot, and give it the theme's colours."""
    plot.clear()
    plot.setBackground(look.panel)
    for axis in AXES:
        plot.getAxis(axis).setPen(look.line)
        plot.getAxis(axis).setTextPen(look.dim)
