"""A window beside what it is about."""

from __future__ import annotations

from hypothesis import example, given
from hypothesis import strategies as st
from PySide6.QtCore import QRect

from app.widgets.beside import find_free_place

ROOM = QRect(0, 0, 1280, 720)


def test_it_stands_where_most_of_it_has_room():
    about = QRect(862, 76, 418, 600)
    assert find_free_place((1000, 680), (300, 200), ROOM, about) == QRect(0, 20, 854, 680)
    assert not find_free_place((400, 300), (300, 200), ROOM, about).intersects(about)
    low = QRect(0, 0, 1280, 350)
    assert find_free_place((1000, 680), (300, 200), ROOM, low).top() >= 350


def test_a_window_that_is_too_large_is_at_least_whole_on_the_screen():
    assert ROOM.contains(find_free_place((1000, 680), (900, 600), ROOM, QRect(300, 100, 700, 500)))
    assert find_free_place((400, 300), (100, 100), ROOM, ROOM) == QRect(440, 210, 400, 300)


@example(0, 0, 957, 515)  # 197 pixels are left below, for one that needs 200
@given(*(st.integers(0, n) for n in (1280, 720, 1280, 720)))
def test_it_is_always_on_the_screen(x, y, width, height):
    about = QRect(x, y, width, height).intersected(ROOM)
    found = find_free_place((800, 500), (300, 200), ROOM, about)
    assert ROOM.contains(found) and found.width() >= 300 and found.height() >= 200
