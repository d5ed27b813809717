"""Buttons side by side, of which one is pressed."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QButtonGroup, QGridLayout, QToolButton, QWidget

from app.translation import tr
from app.widgets.form_fields import Mixed
from app.widgets.making import make_widget
from app.widgets.vocabulary import get_vocabulary_title, get_vocabulary_word
from metagraph.graph.model import LIMBS


class ChoiceRow(QWidget):
    """The choices are (label, tooltip), `columns` of them in a line, 0 for all. chosen: the place of the one
    that was clicked.
    """

    chosen = Signal(int)

    def __init__(
        self, parent: QWidget, choices: Iterable[tuple[str, str]], least_width: int = 0, columns: int = 0
    ) -> None:
        super().__init__(parent)
        self.group = QButtonGroup(self)
        self._buttons: list[QToolButton] = []
        rows = QGridLayout(self)
        rows.setContentsMargins(0, 0, 0, 0)
        rows.setSpacing(2)
        for n, (text, tip) in enumerate(choices):
            button = make_widget(QToolButton, self, text=text, checkable=True, toolTip=tip)
            button.setMinimumWidth(least_width)
            self.group.addButton(button, n)
            self._buttons.append(button)
            rows.addWidget(button, *(divmod(n, columns) if columns else (0, n)))
        rows.setColumnStretch(rows.columnCount(), 1)
        self.group.idClicked.connect(self.chosen)

    def button(self, place: int) -> QToolButton:
        """Return the button at a place."""
        return self._buttons[place]

    def show_choice(self, place: int | None) -> None:
        """Press one, or none: what it is about has several values."""
        self.group.setExclusive(False)
        for n, button in enumerate(self._buttons):
            button.setChecked(n == place)
        self.group.setExclusive(place is not None)


class LimbRow(ChoiceRow):
    """The arms that something moves; the other keeps to what `keeps` names."""

    def __init__(self, parent: QWidget, keeps: str) -> None:
        tips = {
            "left": tr(
                "Moves the left arm; the other arm follows the {keeps}", keeps=get_vocabulary_word(keeps)
            ),
            "right": tr(
                "Moves the right arm; the other arm follows the {keeps}", keeps=get_vocabulary_word(keeps)
            ),
            "both": tr(
                "Moves both arms; the rest of the body follows the {keeps}", keeps=get_vocabulary_word(keeps)
            ),
        }
        super().__init__(parent, ((get_vocabulary_title(x), tips[x]) for x in LIMBS))

    def show_limb(self, limb: Any) -> None:
        """Show a limb, or the marker `Mixed`."""
        self.show_choice(None if limb is Mixed else LIMBS.index(limb))
