"""The eye that looks for words that are cut, untold, alike or on top of each other sees each of them."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QPoint, QRect, Qt
from PySide6.QtGui import QPainter
from PySide6.QtWidgets import QLabel, QTreeWidget, QTreeWidgetItem, QWidget

from tests.app.painted_text import faults

pytestmark = pytest.mark.window


class Words(QWidget):
    """Paints words itself."""

    def __init__(self, *words: tuple[str, QPoint]) -> None:
        super().__init__()
        self.words = words
        self.resize(300, 120)

    def paintEvent(self, event: object) -> None:
        painter = QPainter(self)
        for text, at in self.words:
            painter.drawText(at, text)
        painter.end()


def told(qtbot, widget: QWidget) -> str:
    qtbot.addWidget(widget)
    widget.show()
    qtbot.waitExposed(widget)
    qtbot.wait(10)
    return "; ".join(faults(widget))


def test_whole_words_side_by_side_are_fine(qtbot):
    assert told(qtbot, Words(("one", QPoint(10, 30)), ("two", QPoint(80, 30)), ("", QPoint(0, 0)))) == ""


def test_words_over_an_edge_are_cut(qtbot):
    assert "is cut" in told(qtbot, Words(("one and two and three", QPoint(280, 30))))
    assert "is cut" in told(qtbot, Words(("one", QPoint(10, 122))))


def test_words_on_words_are_seen(qtbot):
    assert "lies on" in told(qtbot, Words(("one", QPoint(10, 30)), ("two", QPoint(14, 34))))


def test_a_label_too_small_for_its_words_is_seen(qtbot):
    page = QWidget()
    page.resize(300, 100)
    label = QLabel("many words that take room", page)
    label.setGeometry(QRect(10, 10, 60, 20))
    assert "is cut" in told(qtbot, page)


def test_what_was_left_out_has_to_be_told_and_told_apart(qtbot):
    one = Words(("long na…here", QPoint(10, 30)))
    assert "not told whole" in told(qtbot, one)
    one.setToolTip("long name of somewhere else, here")
    assert told(qtbot, one) == ""
    tree = QTreeWidget()
    tree.setHeaderLabels(["name"])
    tree.resize(140, 200)
    for n in (1, 2):
        item = QTreeWidgetItem(["a name that is far too long for its column"])
        item.setToolTip(0, f"a name that is far too long for its column {n}")
        tree.addTopLevelItem(item)
    tree.header().setStretchLastSection(True)
    tree.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
    assert "looks like" in told(qtbot, tree)
