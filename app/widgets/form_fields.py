"""Controls of the panels: numbers and texts that can show "mixed", give keys back when they are done, and
drop what was typed on Esc.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from PySide6.QtCore import QEvent, Qt
from PySide6.QtGui import QKeyEvent, QKeySequence
from PySide6.QtWidgets import QComboBox, QLineEdit, QWidget

from app.translation import tr, tr_noop
from app.widgets.quiet_fields import ComboBox, DoubleSpinBox

MIXED = tr_noop("mixed")


class _MixedType:
    def __repr__(self) -> str:
        return tr(MIXED)


Mixed = _MixedType()


def find_common_value(values: Sequence[Any]) -> Any:
    """Return what all values are, or the marker `Mixed` when they differ."""
    first = values[0]
    return first if all(v == first for v in values) else Mixed


def _yields(event: QEvent, edit: QLineEdit) -> bool | None:
    """Say for a ShortcutOverride whether a field lets the window have the key; None when the field may decide
    as usual.

    Once what was typed is taken over, undo and redo are the window's again; Esc is the field's while
    something was typed.
    """
    if event.type() != QEvent.Type.ShortcutOverride or not isinstance(event, QKeyEvent):
        return None
    if event.matches(QKeySequence.StandardKey.Undo) or event.matches(QKeySequence.StandardKey.Redo):
        return None if edit.isModified() else True
    if event.key() == Qt.Key.Key_Escape:
        return not edit.isModified()
    return None


class Field(QLineEdit):
    """A line of text. `show_text` shows what the project says, unless the same thing is just being edited."""

    def __init__(self, parent: QWidget | None, tip: str, name: str) -> None:
        super().__init__(parent)
        self.setToolTip(tip)
        self.setAccessibleName(name)
        self._of: object = None
        self._shown = ""
        self.editingFinished.connect(lambda: self.setModified(False))

    def show_text(self, text: str, of: object) -> None:
        """Show the text of `of`; what is being typed stays only while it is about the same."""
        self._shown = text
        if of != self._of or not (self.hasFocus() and self.isModified()):
            self._of = of
            if text != self.text():
                self.setText(text)

    def event(self, event: QEvent) -> bool:
        yields = _yields(event, self)
        if yields is None:
            return super().event(event)
        event.setAccepted(not yields)
        return True

    def keyPressEvent(self, event: QKeyEvent) -> None:
        if event.key() == Qt.Key.Key_Escape:
            self.setText(self._shown)
        else:
            super().keyPressEvent(event)


class Seconds(DoubleSpinBox):
    """A number that can also show that many values differ; typing or stepping then sets all."""

    def __init__(
        self,
        parent: QWidget,
        tip: str,
        most: float = 1e4,
        suffix: str = " s",
        step: float = 0.05,
        decimals: int = 2,
    ) -> None:
        super().__init__(parent, toolTip=tip)
        self.setRange(-step, most)
        self.setSpecialValueText(tr(MIXED))
        self.setDecimals(decimals)
        self.setSingleStep(step)
        self.setSuffix(suffix)
        self.setKeyboardTracking(False)
        self.setAccessibleName(tip)
        self.editingFinished.connect(lambda: self.lineEdit().setModified(False))

    def show_value(self, value: Any) -> None:
        """Show what the project says, `Mixed` for many values, in the place of whatever is being typed."""
        shown = self.minimum() if value is Mixed else float(value)
        same = self.value() == round(shown, self.decimals())
        if same and not self.lineEdit().isModified():
            return  # even the same would be painted again
        self.blockSignals(True)
        self.setValue(shown)
        self.blockSignals(False)

    def stepBy(self, steps: int) -> None:
        if steps < 0 and self.value() + steps * self.singleStep() < 0:
            self.step_to(0.0)  # what is below stands for "mixed"
        else:
            super().stepBy(steps)

    def event(self, event: QEvent) -> bool:
        yields = _yields(event, self.lineEdit())
        if yields is None:
            return super().event(event)
        event.setAccepted(not yields)
        return True

    def keyPressEvent(self, event: QKeyEvent) -> None:
        if event.key() == Qt.Key.Key_Escape:
            mixed = self.value() <= self.minimum()
            self.lineEdit().setText(tr(MIXED) if mixed else self.textFromValue(self.value()) + self.suffix())
        else:
            super().keyPressEvent(event)


class QuietChooser(ComboBox):
    """A combo box that long entries do not widen and scrolling does not change."""

    def __init__(self, parent: QWidget, toolTip: str) -> None:
        super().__init__(parent, toolTip=toolTip)
        self.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
        self.setMinimumContentsLength(8)
        self.setAccessibleName(toolTip)
        self._entries: list[tuple[str, object]] = []

    def show_entries(
        self, entries: Sequence[tuple[str, object]], chosen: object, otherwise: str = ""
    ) -> None:
        """Show (text, data) entries with the one of data `chosen`, or the words `otherwise` when it is none
        of them.
        """
        entries = list(entries)
        self.blockSignals(True)
        if entries != self._entries:  # thousands of entries are filled in when they change, not at each edit
            self._entries = entries
            self.clear()
            self.addItems([text for text, _ in entries])
            for row, (_, data) in enumerate(entries):
                self.setItemData(row, data)
        self.setPlaceholderText(otherwise)
        self.setCurrentIndex(next((row for row, (_, data) in enumerate(entries) if data == chosen), -1))
        self.blockSignals(False)
