"""Set style sheets of widgets only when they change: even the same sheet makes Qt polish the widget, lay out
its surroundings and paint them again.
"""

from __future__ import annotations

from PySide6.QtWidgets import QWidget


def set_sheet(widget: QWidget, sheet: str) -> None:
    """Set the style sheet of a widget; "" removes it."""
    if widget.styleSheet() != sheet:
        widget.setStyleSheet(sheet)
