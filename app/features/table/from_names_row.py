"""The row with which fields are filled from what clips are called."""

from __future__ import annotations

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QHBoxLayout, QLabel, QLineEdit, QPushButton, QSizePolicy, QWidget

from app.features.table.cell_words import TITLES
from app.translation import tr, tr_error, tr_plural
from metagraph.graph.edit_error import EditError
from metagraph.playback.action_table import Column
from metagraph.playback.name_fields import NamePattern, parse_name_pattern

EXAMPLE = "{stance}__to__{end}"


class FromNamesRow(QWidget):
    """wanted: a pattern, to fill the rows whose names fit it."""

    wanted = Signal(object)
    pattern_changed = Signal()

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self.pattern = QLineEdit(self)
        self.pattern.setPlaceholderText(EXAMPLE)
        self.pattern.setAccessibleName(tr("Pattern of names"))
        self.pattern.setToolTip(
            tr(
                "How the names are built. Fields: {fields}. * is anything.",
                fields="{stance} {end} {kind} {layer} {limb} {tags}",
            )
        )
        self.pattern.setMinimumWidth(240)
        self.go = QPushButton(tr("Fill"), self)
        self.said = QLabel(self)
        self.said.setProperty("dim", True)
        self.said.setSizePolicy(
            QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Preferred
        )  # a name may be long
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        for widget in (self.pattern, self.go):
            row.addWidget(widget)
        row.addWidget(self.said, 1)
        self.pattern.textChanged.connect(self.pattern_changed)
        self.pattern.returnPressed.connect(self._go)
        self.go.clicked.connect(self._go)
        self.go.setEnabled(False)

    def read(self) -> NamePattern | None:
        """Return the pattern that is typed; None, and say why, if it is none."""
        try:
            return parse_name_pattern(self.pattern.text()) if self.pattern.text().strip() else None
        except EditError as error:
            self._say(tr_error(error))
            return None

    def show_fitting(self, new: int, fitting: int, name: str, fields: dict[Column, str]) -> None:
        """Say how many rows would change, of those that fit, and what is read from the first, which has a
        name.
        """
        first = ", ".join(f"{TITLES[column]} {text}" for column, text in fields.items())
        if new:
            self._say(f"{tr_plural('{count:,} row', '{count:,} rows', new)}. {name}: {first}")
        elif fitting:
            self._say(tr_plural("{count:,} row is filled", "{count:,} rows are filled", fitting))
        else:
            self._say(tr("No name fits"))
        self.go.setEnabled(new > 0)

    def show_nothing(self) -> None:
        """Show that there is nothing to fill; what was said of a wrong pattern stays."""
        self.go.setEnabled(False)
        if not self.pattern.text().strip():
            self._say("")

    def _say(self, words: str) -> None:
        self.said.setText(words)
        self.said.setToolTip(words)

    def _go(self) -> None:
        pattern = self.read()
        if self.go.isEnabled() and pattern is not None:
            self.wanted.emit(pattern)
