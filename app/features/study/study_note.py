"""Something to remember about a sitting, in words."""

from __future__ import annotations

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QDialog, QHBoxLayout, QLabel, QPlainTextEdit, QPushButton, QVBoxLayout, QWidget

from app.look.theme import strengthen
from app.translation import tr


class NoteDialog(QDialog):
    """noted: (words, by)."""

    noted = Signal(str, str)

    def __init__(self, experimenter: bool, parent: QWidget) -> None:
        super().__init__(parent)
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setWindowTitle(tr("Note"))
        self.by = "experimenter" if experimenter else "participant"
        self.words = QPlainTextEdit(self)
        self.words.setTabChangesFocus(True)
        self.words.setMinimumSize(420, 120)
        self.words.setAccessibleName(tr("Note"))
        self.keep, cancel = QPushButton(tr("Save"), self), QPushButton(tr("Cancel"), self)
        strengthen(self.keep)
        self.keep.clicked.connect(self._keep)
        cancel.clicked.connect(self.reject)
        self.words.textChanged.connect(lambda: self.keep.setEnabled(bool(self.words.toPlainText().strip())))
        self.keep.setEnabled(False)
        buttons = QHBoxLayout()
        buttons.addStretch(1)
        buttons.addWidget(self.keep)
        buttons.addWidget(cancel)
        column = QVBoxLayout(self)
        column.setContentsMargins(16, 14, 16, 14)
        column.setSpacing(10)
        column.addWidget(QLabel(tr("Write a note on the study. The clock keeps running."), self))
        column.addWidget(self.words)
        column.addLayout(buttons)

    def _keep(self) -> None:
        self.noted.emit(self.words.toPlainText().strip(), self.by)
        self.accept()
