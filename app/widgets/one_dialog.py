"""Dialogs that stay open beside the window: each is there once, and comes forward when it is asked for."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

from PySide6.QtWidgets import QDialog, QWidget

T = TypeVar("T", bound=QDialog)


def show_one(parent: QWidget, kind: type[T], make: Callable[[], T]) -> T:
    """Show a parent's dialog of a kind, made if it is not there, and return it."""
    dialog = parent.findChild(kind) or make()
    dialog.show()
    dialog.raise_()
    dialog.activateWindow()
    return dialog
