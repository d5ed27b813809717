"""Style sheets of single widgets, set only where they are others: even the same one makes Qt polish a widget
again, lay out what is round it, and paint all of that.
"""

from __future__ import annotations

from PySide6.QtWidgets import QWidget


def set_sheet(widget: QWidget, sheet: str) -> None:
    """Give a widget a style sheet of its own; "" takes that away."""
    if widget.styleSheet() != sheet:
        widget.setStyleSheet(sheet)
