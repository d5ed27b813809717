"""What would take dragged files shows it, and stops showing it when they leave or are dropped."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QMimeData, QPoint, QPointF, Qt, QUrl
from PySide6.QtGui import QDragEnterEvent, QDragLeaveEvent, QDropEvent
from PySide6.QtWidgets import QApplication, QWidget

from app.look.theme_choice import ThemeChoice
from app.widgets.drop_frame import DropFrame


class Taker(QWidget):
    """Takes what ends in .bvh."""

    def __init__(self) -> None:
        super().__init__()
        self.setAcceptDrops(True)
        self.frame = DropFrame(self, ThemeChoice(), "Drop to import")

    def dragEnterEvent(self, event):
        event.setAccepted(event.mimeData().urls()[0].path().endswith(".bvh"))
        self.frame.follow(event)

    def dropEvent(self, event):
        event.accept()


@pytest.fixture
def taker(qtbot):
    widget = Taker()
    qtbot.addWidget(widget)
    widget.resize(300, 200)
    widget.show()
    return widget


def drag(name):
    data = QMimeData()
    data.setUrls([QUrl.fromLocalFile(f"/{name}")])
    return (Qt.DropAction.CopyAction, data, Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier)


def test_it_shows_while_files_that_are_taken_are_dragged_over_and_goes_when_they_leave(taker):
    more = drag("walk.bvh")
    QApplication.sendEvent(taker, QDragEnterEvent(QPoint(5, 5), *more))
    assert taker.frame.isVisible() and taker.frame.geometry() == taker.rect()
    assert taker.childAt(150, 100) is None, "the mouse and the drop go through it"
    QApplication.sendEvent(taker, QDragLeaveEvent())
    assert not taker.frame.isVisible()


def test_it_goes_with_the_drop(taker):
    more = drag("walk.bvh")
    QApplication.sendEvent(taker, QDragEnterEvent(QPoint(5, 5), *more))
    QApplication.sendEvent(taker, QDropEvent(QPointF(5, 5), *more))
    assert not taker.frame.isVisible()


def test_files_that_are_not_taken_show_nothing(taker):
    more = drag("notes.txt")
    QApplication.sendEvent(taker, QDragEnterEvent(QPoint(5, 5), *more))
    assert not taker.frame.isVisible()


def test_its_words_stand_on_a_plate(taker):
    more = drag("walk.bvh")
    QApplication.sendEvent(taker, QDragEnterEvent(QPoint(5, 5), *more))
    picture = taker.frame.grab().toImage()
    assert picture.pixelColor(150, 100) != picture.pixelColor(150, 20)
