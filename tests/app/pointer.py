"""A real pointer in the real window, moved through the X server: presses, and entries of menus that open
under it.
"""

from __future__ import annotations

import subprocess
from collections.abc import Callable
from typing import Any

import pytest
from PySide6.QtCore import QPoint, QTimer
from PySide6.QtWidgets import QApplication, QMenu, QWidget

from tests.app.conftest import real_pointer

LEFT, RIGHT, UP, DOWN = "1", "3", "4", "5"  # the pointer's buttons, and notches of its wheel
Place = tuple[QWidget, QPoint]


def press(drive: Any, place: Place, button: str = LEFT, until: Callable[[], bool] = lambda: True) -> None:
    """Move the pointer to a place and press a button there; wait until something has come of it."""
    process = subprocess.Popen(_pressing(place, button))
    try:
        drive.wait(lambda: process.poll() is not None and until(), 15)
    finally:
        process.wait(5)


def choose(drive: Any, place: Place, *texts: str, until: Callable[[], bool], button: str = RIGHT) -> None:
    """Press the right button, or another, and then the entries of the menu that opens, by their words, one
    after the other through submenus; wait until something has come of it.
    """
    left, started = list(texts), [subprocess.Popen(_pressing(place, button))]
    look = QTimer(interval=60)

    def seek() -> None:
        menu = QApplication.activePopupWidget()
        if not left or not isinstance(menu, QMenu) or started[-1].poll() is None:
            return
        found = [a for a in menu.actions() if a.text().replace("&", "").split("\t")[0].startswith(left[0])]
        if found:
            left.pop(0)
            started.append(subprocess.Popen(_pressing((menu, menu.actionGeometry(found[0]).center()), LEFT)))

    look.timeout.connect(seek)
    look.start()
    try:
        drive.wait(lambda: not left and until(), 20)
    finally:
        look.stop()
        menu = QApplication.activePopupWidget()
        if menu is not None:
            menu.close()
        for process in started:
            process.wait(5)
    assert not left, f"no {left} in the menu"


def from_menu(drive: Any, title: str, *texts: str, until: Callable[[], bool]) -> None:
    """Choose an entry of the window's menus by the pointer."""
    bar = drive.window.menuBar()
    found = next(a for a in bar.actions() if a.text().replace("&", "") == title)
    choose(drive, (bar, bar.actionGeometry(found).center()), *texts, until=until, button=LEFT)


def middle_of(widget: QWidget) -> Place:
    """The middle of a widget."""
    return widget, widget.rect().center()


def _pressing(place: Place, button: str) -> list[str]:
    if not real_pointer():
        pytest.skip("a real pointer needs X11 and xdotool")
    at = place[0].mapToGlobal(place[1])
    return ["xdotool", "mousemove", str(at.x()), str(at.y()), "sleep", ".12", "click", button]
