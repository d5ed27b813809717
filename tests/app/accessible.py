"""What a screen reader is reported about controls: each that the keyboard reaches has a name, and a role or
words on what it is.
"""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtGui import QAccessible
from PySide6.QtWidgets import (
    QAbstractScrollArea,
    QAbstractSpinBox,
    QComboBox,
    QLabel,
    QTabBar,
    QTabWidget,
    QWidget,
)

ROLELESS = {QAccessible.Role.NoRole, QAccessible.Role.Client, QAccessible.Role.Window}


def nameless(top: QWidget) -> list[str]:
    """Return a line for each control in sight that can have the keyboard and says nothing of itself."""
    out = []
    for widget in (top, *top.findChildren(QWidget)):
        if not widget.isVisible() or widget.focusPolicy() == Qt.FocusPolicy.NoFocus or _inner(widget):
            continue
        told = QAccessible.queryAccessibleInterface(widget)
        if told is None:
            continue
        if isinstance(widget, (QLabel, QTabBar)):
            continue  # a label's words are its name, or there are none yet; each tab is given by its own
        if not told.text(QAccessible.Text.Name).strip():
            out.append(f"{_who(widget)} has no name")
        elif isinstance(widget, (QAbstractScrollArea, QTabWidget)):
            continue  # what they hold is reported
        elif told.role() in ROLELESS and not told.text(QAccessible.Text.Description).strip():
            out.append(f"{_who(widget)} ({told.text(QAccessible.Text.Name)}) is told to be nothing")
    return out


def _inner(widget: QWidget) -> bool:
    """Whether a widget is a part of one that speaks for it: a field's line, a list's ground."""
    above = widget.parentWidget()
    while above is not None:
        if isinstance(above, (QComboBox, QAbstractSpinBox)):
            return True
        if isinstance(above, QAbstractScrollArea) and widget is above.viewport():
            return True
        above = above.parentWidget()
    return isinstance(widget, QAbstractScrollArea) and type(widget).__name__ in ("QScrollArea", "ScrollArea")


def _who(widget: QWidget) -> str:
    chain = []
    above: QWidget | None = widget
    while above is not None and len(chain) < 4:
        chain.append(f"{type(above).__name__}{'#' + above.objectName() if above.objectName() else ''}")
        above = above.parentWidget()
    return " < ".join(chain)
