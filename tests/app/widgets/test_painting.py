"""A window is painted once after it was held back."""

from __future__ import annotations

import pytest
from PySide6.QtWidgets import QApplication, QHBoxLayout, QWidget

from app.widgets.painting import PaintingHold

pytestmark = [pytest.mark.window]


class Counted(QWidget):
    painted = 0

    def paintEvent(self, event):
        self.painted += 1


@pytest.fixture
def window(qtbot):
    window = QWidget()
    layout = QHBoxLayout(window)
    window.parts = [Counted(), Counted()]
    for part in window.parts:
        layout.addWidget(part)
    window.resize(200, 100)
    qtbot.addWidget(window)
    with qtbot.waitExposed(window):
        window.show()
    QApplication.processEvents()
    return window


def test_only_what_changed_is_painted_and_once(window):
    changed, other = window.parts
    before, others = changed.painted, other.painted
    hold = PaintingHold(window)
    hold.begin()
    for _ in range(3):
        changed.update()
        QApplication.processEvents()
    assert changed.painted == before
    hold.end()
    QApplication.processEvents()
    assert (changed.painted, other.painted) == (before + 1, others)


def test_afterwards_it_is_painted_as_ever(window):
    hold = PaintingHold(window)
    for _ in range(2):
        hold.begin()
        hold.end()
    QApplication.processEvents()
    before = window.parts[0].painted
    window.parts[0].update()
    QApplication.processEvents()
    assert window.parts[0].painted == before + 1


def test_held_twice_it_is_painted_after_the_last_end(window):
    first, second = PaintingHold(window), PaintingHold(window)
    first.begin()
    second.begin()
    window.parts[0].update()
    before = window.parts[0].painted
    second.end()
    QApplication.processEvents()
    assert window.parts[0].painted == before
    first.end()
    QApplication.processEvents()
    assert window.parts[0].painted == before + 1
