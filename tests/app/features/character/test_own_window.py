"""The character in a window of its own."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QSettings, Qt
from PySide6.QtTest import QTest

from app.features.character.own_window import OwnWindow

pytestmark = [pytest.mark.window, pytest.mark.gl]


@pytest.fixture
def own(toys):
    drive = toys
    drive.do("own_window")
    (found,) = drive.window.findChildren(OwnWindow)
    drive.wait(found.isVisible)
    drive.wait(lambda: found.view._drawn is not None)
    yield drive, found
    if drive.shell.actions["own_window"].isChecked():
        drive.do("own_window")


def picture(drive, window):
    window.view.repaint()
    drive.pause(5)
    return window.view._drawn[2].copy()


def test_it_shows_what_the_panel_shows_and_a_second_choice_closes_it(own):
    drive, window = own
    assert drive.shell.actions["own_window"].isChecked()
    scene = window._scene()
    assert {a.figure for a in scene.actors} <= {a.figure for a in window.panel.composed.actors}
    assert window.view.camera == window.panel.view.camera
    drive.do("own_window")
    drive.wait(lambda: not drive.window.findChildren(OwnWindow))
    drive.settle()
    assert not drive.shell.actions["own_window"].isChecked()


def test_a_transparent_background_has_no_alpha_where_nobody_stands_and_no_frame(own):
    drive, window = own
    window.show_background("transparent")
    drawn = picture(drive, window)
    assert drawn.pixelColor(2, 2).alpha() == 0
    places = ((x, y) for x in range(0, drawn.width(), 2) for y in range(0, drawn.height(), 2))
    assert any(drawn.pixelColor(x, y).alpha() == 255 for x, y in places)
    assert window.windowFlags() & Qt.WindowType.FramelessWindowHint
    window.show_background("green")
    corner = picture(drive, window).pixelColor(2, 2)
    assert (corner.red(), corner.alpha()) == (0, 255) and corner.green() > 150
    assert not window.windowFlags() & Qt.WindowType.FramelessWindowHint
    window.show_background("as shown")
    assert picture(drive, window).pixelColor(2, 2).green() < 100


def test_its_own_camera_is_kept_until_a_double_click(own):
    drive, window = own
    before = window.panel.view.camera
    QTest.mousePress(window.view, Qt.MouseButton.LeftButton, pos=window.view.rect().center())
    window.view._move("orbit", window.view.rect().center().toPointF() / 10)
    QTest.mouseRelease(window.view, Qt.MouseButton.LeftButton, pos=window.view.rect().center())
    picture(drive, window)
    assert window.view.camera != before and window.panel.view.camera == before
    QTest.mouseDClick(window.view, Qt.MouseButton.LeftButton, pos=window.view.rect().center())
    picture(drive, window)
    assert window.view.camera == window.panel.view.camera


def test_it_plays_on_while_the_panel_is_hidden(own):
    drive, _ = own
    drive.session.transport.set_playing(True)
    drive.docks["character"].hide()
    before = drive.session.transport.seconds
    drive.wait(lambda: drive.session.transport.seconds > before + 0.2)
    drive.docks["character"].show()


def test_its_menu_fills_a_screen_and_space_and_escape_work_in_it(own, monkeypatch):
    drive, window = own
    drive.pick(window.make_menu(), "Stay on top")
    assert window.stays_on_top() and window.isVisible()
    drive.pick(window.make_menu(), "Stay on top")
    window.fill_screen(0)
    drive.wait(window.isFullScreen)
    playing = drive.session.transport.playing
    QTest.keyClick(window, Qt.Key.Key_Space)
    assert drive.session.transport.playing is not playing
    left = []
    monkeypatch.setattr(window, "showNormal", lambda: left.append(1))  # it takes a window manager
    QTest.keyClick(window, Qt.Key.Key_Escape)
    assert left and window.isVisible()
    monkeypatch.setattr(window, "isFullScreen", lambda: False)
    QTest.keyClick(window, Qt.Key.Key_Escape)
    drive.wait(lambda: not drive.window.findChildren(OwnWindow))


def test_its_background_is_kept_for_the_next_time(own):
    drive, window = own
    window.show_background("green")
    drive.do("own_window")
    drive.wait(lambda: not drive.window.findChildren(OwnWindow))
    drive.do("own_window")
    (again,) = drive.window.findChildren(OwnWindow)
    assert again.background == "green"
    QSettings().remove("own window")
