"""What is painted on a canvas, as screen readers report it."""

from __future__ import annotations

import gc

import pytest
from PySide6.QtCore import QCoreApplication, QEvent, QPoint, QRectF
from PySide6.QtGui import QAccessible
from PySide6.QtWidgets import QWidget

from app.widgets.spoken_items import FRESH, SpokenItem, install_spoken_items

pytestmark = pytest.mark.window
Text = QAccessible.Text


class Painted(QWidget):
    """A canvas with things on it."""

    def __init__(self) -> None:
        super().__init__()
        self.setAccessibleName("A canvas")
        self.things = [
            SpokenItem("one", QRectF(10, 10, 20, 20), description="the first"),
            SpokenItem("two", QRectF(40, 10, 20, 20), QAccessible.Role.Button, selected=True, focused=True),
            SpokenItem("far away", QRectF(900, 10, 20, 20)),
        ]

    def list_spoken_items(self) -> list[SpokenItem]:
        return self.things


@pytest.fixture
def canvas(qapp, qtbot) -> Painted:
    install_spoken_items()
    canvas = Painted()
    qtbot.addWidget(canvas)
    canvas.resize(200, 100)
    canvas.show()
    qtbot.waitExposed(canvas)
    return canvas


def told(canvas: QWidget):
    return QAccessible.queryAccessibleInterface(canvas)


def test_a_canvas_is_a_list_of_what_is_on_it(canvas: Painted) -> None:
    found = told(canvas)
    assert found.role() == QAccessible.Role.List and found.text(Text.Name) == "A canvas"
    items = [found.child(n) for n in range(found.childCount())]
    assert [i.text(Text.Name) for i in items] == ["one", "two", "far away"]
    assert [i.role() for i in items] == [
        QAccessible.Role.ListItem,
        QAccessible.Role.Button,
        QAccessible.Role.ListItem,
    ]
    assert items[0].text(Text.Description) == "the first"
    assert [bool(i.state().selected) for i in items] == [False, True, False]
    assert found.focusChild() is items[1]
    assert [found.indexOfChild(i) for i in items] == [0, 1, 2]


def test_an_item_is_where_it_is_on_the_screen(canvas: Painted) -> None:
    found = told(canvas)
    at = canvas.mapToGlobal(QPoint(45, 15))
    assert found.childAt(at.x(), at.y()).text(Text.Name) == "two"
    assert found.child(0).rect().topLeft() == canvas.mapToGlobal(QPoint(10, 10))
    assert found.child(2).state().offscreen and not found.child(0).state().offscreen


def test_items_that_are_gone_are_no_longer_valid(canvas: Painted, qtbot) -> None:
    found = told(canvas)
    last = found.child(2)
    canvas.things = canvas.things[:1]
    qtbot.wait(int(FRESH * 1000) + 50)
    assert found.childCount() == 1 and not last.isValid() and found.child(2) is None
    assert last.text(Text.Name) == "" and last.state().invalid


def test_a_canvas_that_is_deleted_leaves_nothing_to_be_read(qapp) -> None:
    install_spoken_items()
    for _ in range(50):
        canvas = Painted()
        found = told(canvas)
        item = found.child(1)
        canvas.deleteLater()
        QCoreApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)
        del canvas, found
        gc.collect(0)  # they are young
        assert not item.isValid() and item.rect().isEmpty()
