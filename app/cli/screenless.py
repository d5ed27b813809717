"""Qt's application for commands that draw or write text without a window, and need no screen for it."""

from __future__ import annotations

from PySide6.QtCore import QCoreApplication
from PySide6.QtGui import QGuiApplication


def make_screenless_application() -> QCoreApplication:
    """Return the application there is, else one that needs no screen, to be kept as long as it is used. What
    this process starts is not touched: the choice is not put into the environment.
    """
    return QGuiApplication.instance() or QGuiApplication(["metagraph", "-platform", "offscreen"])
