"""The row with which words in the table are replaced."""

from __future__ import annotations

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QHBoxLayout, QLabel, QLineEdit, QPushButton, QWidget

from app.features.table.cell_words import TITLES
from app.translation import tr, tr_plural
from app.widgets.quiet_fields import ComboBox
from metagraph.playback.action_table import COLUMNS, Column

REPLACED: tuple[Column, ...] = ("name", "tags", "stance", "end_stance", "kind", "limb")


class ReplaceRow(QWidget):
    """wanted: the column, what is sought, and what to put there."""

    wanted = Signal(str, str, str)
    sought_changed = Signal()

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self.column = ComboBox(self)
        for column in REPLACED:
            self.column.addItem(TITLES[column], column)
        self.column.setAccessibleName(tr("Column"))
        self.column.setToolTip(tr("The column in which words are replaced"))
        self.sought, self.put = QLineEdit(self), QLineEdit(self)
        self.sought.setPlaceholderText(tr("Find"))
        self.sought.setAccessibleName(tr("Find"))
        self.sought.setToolTip(tr("Words to find, in capitals or not"))
        self.put.setPlaceholderText(tr("Replace with"))
        self.put.setAccessibleName(tr("Replace with"))
        self.put.setToolTip(tr("What to write in their place"))
        self.go = QPushButton(tr("Replace"), self)
        self.count = QLabel(self)
        self.count.setProperty("dim", True)
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        for widget in (self.column, self.sought, self.put, self.go, self.count):
            row.addWidget(widget)
        row.addStretch(1)
        self.sought.textChanged.connect(self.sought_changed)
        self.column.currentIndexChanged.connect(self.sought_changed)
        self.go.clicked.connect(self._go)
        self.put.returnPressed.connect(self._go)

    def chosen_column(self) -> int:
        """Return the place of the chosen column among all."""
        return COLUMNS.index(self.column.currentData())

    def show_count(self, cells: int) -> None:
        """Say in how many cells the words are."""
        self.count.setText(
            tr_plural("in {count:,} cell", "in {count:,} cells", cells) if self.sought.text() else ""
        )
        self.go.setEnabled(cells > 0)

    def _go(self) -> None:
        if self.go.isEnabled():
            self.wanted.emit(self.column.currentData(), self.sought.text(), self.put.text())
