"""A widget is styled again only where its sheet is another."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QObject
from PySide6.QtWidgets import QLabel

from app.widgets.restyling import set_sheet


class Styled(QObject):
    def __init__(self) -> None:
        super().__init__()
        self.count = 0

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        self.count += event.type() == QEvent.Type.StyleChange
        return False


def test_the_same_sheet_styles_nothing_again(qtbot):
    label, told = QLabel("words"), Styled()
    qtbot.addWidget(label)
    label.show()
    label.installEventFilter(told)
    set_sheet(label, "color: #ff0000")
    first = told.count
    set_sheet(label, "color: #ff0000")
    assert (told.count, label.styleSheet()) == (first, "color: #ff0000")
    set_sheet(label, "")
    assert label.styleSheet() == "" and told.count > first
