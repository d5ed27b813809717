"""What a view does if there is no OpenGL."""

from __future__ import annotations

from typing import Any

import moderngl
import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QLabel, QWidget

from app.stage.gl_view import GLView, ImageView
from preview import offscreen
from preview.scene import Scene

REMEDY = {"linux": "apt install libegl1 libgl1", "darwin": "graphical session"}


def without_opengl(*_: object, **__: object) -> Any:
    raise RuntimeError("libGL is not there")


@pytest.fixture
def refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(moderngl, "create_context", without_opengl)


def words_over(view: QWidget) -> str:
    (label,) = view.findChildren(QLabel)
    assert label.isVisible() and label.wordWrap() and label.height() > min(100, view.height() / 2)
    assert label.textInteractionFlags() & Qt.TextInteractionFlag.TextSelectableByMouse
    return label.text()


@pytest.mark.parametrize("size", [(500, 400), (90, 60)])
def test_an_image_says_why_it_stays_empty_and_what_to_do_and_keeps_its_size(
    qapp: Any, refused: None, size: tuple[int, int]
) -> None:
    view = ImageView(lambda: Scene(()))
    told: list[str] = []
    view.failed.connect(told.append)
    view.resize(*size)
    view.show()
    view.grab()  # painted, whatever is in front of it
    qapp.processEvents()
    view.grab()
    words = words_over(view)
    assert words.startswith("There is no OpenGL 3.3 (") and "libGL is not there" in words
    assert told == [words], "once, however often it is painted"
    assert (view.width(), view.height()) == size and view.minimumSizeHint().width() < 90
    view.close()


def test_an_opengl_widget_says_it_too(qapp: Any, refused: None, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(offscreen.sys, "platform", "linux")
    host = QWidget()
    view = GLView(lambda: Scene(()), host)
    told: list[str] = []
    view.failed.connect(told.append)
    view.initializeGL()
    (label,) = view.findChildren(QLabel)
    assert told == [label.text()] and label.text().endswith(f"{REMEDY['linux']}.")
    view.paintGL()  # draws nothing, and does not mind
    host.deleteLater()
