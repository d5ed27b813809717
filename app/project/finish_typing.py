"""Take over what is still being typed, before something reads the whole project."""

from __future__ import annotations

from PySide6.QtWidgets import QAbstractSpinBox, QApplication, QLineEdit, QPlainTextEdit


def finish_typing() -> None:
    """Take over the text of the field that has the keyboard, as when another field is clicked. A field that
    stays open keeps the keyboard.
    """
    field = QApplication.focusWidget()
    if isinstance(field, QLineEdit | QPlainTextEdit | QAbstractSpinBox):
        field.clearFocus()
        if field.isVisible():
            field.setFocus()
