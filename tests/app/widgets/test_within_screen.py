"""Windows no larger than their screen."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QSize
from PySide6.QtGui import QScreen
from PySide6.QtWidgets import QWidget

from app.widgets.within_screen import resize_within_screen

pytestmark = pytest.mark.window


@pytest.mark.parametrize(
    ("room", "size"),
    [(QSize(1280, 680), QSize(1040, 640)), (QSize(800, 600), QSize(796, 560)), (QSize(1920, 1080), None)],
)
def test_a_window_leaves_room_for_its_frame(qtbot, qapp, monkeypatch, room, size):
    monkeypatch.setattr(QScreen, "availableSize", lambda self: room)
    parent = QWidget()
    qtbot.addWidget(parent)
    window = QWidget(parent)
    resize_within_screen(window, 1040, 780)
    assert window.size() == (size or QSize(1040, 780))
