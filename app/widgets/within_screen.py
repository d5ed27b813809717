"""Windows that are no larger than the screen they open on."""

from __future__ import annotations

from PySide6.QtCore import QSize
from PySide6.QtWidgets import QWidget

FRAME = QSize(4, 40)  # what a desktop puts around a window, at most


def resize_within_screen(window: QWidget, width: int, height: int) -> None:
    """Give a window a size, or what its parent's screen has room for, so that its buttons are seen."""
    room = (window.parentWidget() or window).screen().availableSize()
    window.resize(QSize(width, height).boundedTo(room - FRAME))
