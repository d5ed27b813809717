"""Trainings that were begun before and can be gone on with: after a stop, a crash or a kill."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QHBoxLayout, QLabel, QPushButton, QWidget

from app.features.generation.training_run import describe_progress
from app.translation import tr
from app.widgets.quiet_fields import ComboBox
from metagraph.generation.standing import Standing


class BegunRow(QWidget):
    """Shown if there are any. resumed: one is to be gone on with; kept: the model of its last checkpoint is
    wanted; both a Standing.
    """

    resumed = Signal(object)
    kept = Signal(object)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        self.which = ComboBox(self)
        self.which.setAccessibleName(tr("Unfinished training"))
        self.which.setMinimumContentsLength(16)
        self.which.currentIndexChanged.connect(self._offer)
        self.go = QPushButton(tr("Continue"), self, autoDefault=False)
        self.go.clicked.connect(lambda: self.resumed.emit(self.which.currentData()))
        self.keep = QPushButton(tr("Keep as is"), self, autoDefault=False)
        self.keep.clicked.connect(lambda: self.kept.emit(self.which.currentData()))
        row.addWidget(QLabel(tr("Unfinished"), self))
        row.addWidget(self.which, 1)
        row.addWidget(self.go)
        row.addWidget(self.keep)
        self.hide()

    def show_begun(self, found: Sequence[Standing]) -> None:
        """List trainings, the one that was chosen still chosen."""
        before: Standing | None = self.which.currentData()
        self.which.blockSignals(True)
        self.which.clear()
        for n, one in enumerate(found):
            self.which.addItem(f"{one.out.stem} · {describe_progress(one)}", one)
            self.which.setItemData(n, str(one.out), Qt.ItemDataRole.ToolTipRole)
        at = [n for n, one in enumerate(found) if before is not None and one.out == before.out]
        self.which.setCurrentIndex(at[0] if at else 0 if found else -1)
        self.which.blockSignals(False)
        self.setVisible(bool(found))
        self._offer()

    def _offer(self) -> None:
        one: Standing | None = self.which.currentData()
        if one is None:
            return
        over = one.share >= 1
        self.go.setToolTip(
            tr("Train for the number of minutes set above")
            if over
            else tr("Continue from the last checkpoint, for the rest of the time that was set at the start")
        )
        self.keep.setToolTip(tr("Make a model from the last checkpoint"))
        self.keep.setVisible(not one.kept)
        self.keep.setEnabled(one.step > 0)

    def cut_short(self) -> str:
        """Return the name of a training that was ended before its time and left no model, "" for none."""
        found: list[Standing] = [self.which.itemData(n) for n in range(self.which.count())]
        return next((one.out.stem for one in found if not one.kept and one.share < 1), "")
