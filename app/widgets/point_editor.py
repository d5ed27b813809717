"""A small dialog for a named point to look at: another character, a screen, a door."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import Qt
from PySide6.QtWidgets import (
    QDialog,
    QDialogButtonBox,
    QDoubleSpinBox,
    QFormLayout,
    QLabel,
    QLineEdit,
    QVBoxLayout,
    QWidget,
)

from app.project.document import Document
from app.translation import make_lazy_texts, tr, tr_context
from app.widgets.quiet_fields import DoubleSpinBox
from metagraph.graph.editing import performances as performance_edits

AXES = make_lazy_texts(
    lambda: (
        (tr("Left"), tr("Metres to the character's left; negative values are to its right")),
        (tr("Up"), tr("Metres above the floor")),
        (tr_context("metres", "Ahead"), tr("Metres in front of the character")),
    )
)


class PointEditor(QDialog):
    """Puts a point under a name, or moves the one that bears it; then calls `then` with the name."""

    def __init__(
        self, document: Document, then: Callable[[str], object], parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self.document, self.then = document, then
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setWindowTitle(tr("Point to look at"))
        layout = QVBoxLayout(self)
        form = QFormLayout()
        layout.addLayout(form)
        self.name = QLineEdit(self, placeholderText=tr("door, screen, Anna …"))
        self.name.setAccessibleName(tr("Name"))
        self.name.textChanged.connect(self._named)
        form.addRow(tr("Name"), self.name)
        self.axes: list[QDoubleSpinBox] = []
        for (words, tip), value in zip(AXES, (0.6, 1.5, 1.2), strict=True):
            box = DoubleSpinBox(
                self, minimum=-1000.0, maximum=1000.0, decimals=2, singleStep=0.1, suffix=" m"
            )
            box.setValue(value)
            box.setToolTip(tip)
            box.setAccessibleName(words)
            self.axes.append(box)
            form.addRow(words, box)
        self.words = QLabel(
            tr("Agents use this name, and may move the point while they play."), self, wordWrap=True
        )
        self.words.setProperty("dim", True)
        layout.addWidget(self.words)
        self.buttons = QDialogButtonBox(
            QDialogButtonBox.StandardButton.Ok | QDialogButtonBox.StandardButton.Cancel, self
        )
        self.buttons.accepted.connect(self._put)
        self.buttons.rejected.connect(self.reject)
        layout.addWidget(self.buttons)
        self._named("")

    def _named(self, text: str) -> None:
        known = self.document.project.points.get(text.strip())
        if known is not None:
            for box, value in zip(self.axes, known, strict=True):
                box.setValue(value)
        self.buttons.button(QDialogButtonBox.StandardButton.Ok).setEnabled(bool(text.strip()))

    def _put(self) -> None:
        name, point = self.name.text().strip(), tuple(round(box.value(), 3) for box in self.axes)
        self.document.edit(tr("Set point"), lambda p: performance_edits.set_point(p, name, point))
        self.accept()
        self.then(name)
