"""Icons are drawn, in their colour, sharp, and faded when disabled."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QSize
from PySide6.QtGui import QIcon

from app.look.icons import PATHS, make_icon


@pytest.mark.parametrize("name", PATHS)
def test_every_icon_draws_something_in_its_colour(qapp, name):
    picture = make_icon(name, "#ff0000").pixmap(QSize(54, 54)).toImage()
    pixels = [picture.pixelColor(x, y) for x in range(picture.width()) for y in range(picture.height())]
    inked = [p for p in pixels if p.alpha() > 100]
    assert len(inked) > len(pixels) / 80
    assert all(p.red() > 200 and p.green() < 40 for p in inked)
    edge = [
        p
        for x in range(picture.width())
        for p in (picture.pixelColor(x, 0), picture.pixelColor(x, picture.height() - 1))
    ]
    assert all(p.alpha() == 0 for p in edge), "nothing is cut off"


def test_a_disabled_icon_is_fainter(qapp):
    made = make_icon("play", "#ffffff")
    strength = [
        max(made.pixmap(QSize(18, 18), mode).toImage().pixelColor(9, 9).alpha() for _ in "x")
        for mode in (QIcon.Mode.Normal, QIcon.Mode.Disabled)
    ]
    assert strength[1] < strength[0] / 2


def test_an_icon_is_drawn_once(qapp):
    assert make_icon("undo", "#123456") is make_icon("undo", "#123456")
