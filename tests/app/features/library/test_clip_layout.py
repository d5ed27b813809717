"""Where clips are in the list: by rows, groups, sizes; what the keys go to."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st
from PySide6.QtCore import QPoint, QRect

from app.features.library.clip_layout import HEAD, ClipLayout, Section
from app.features.library.clip_sizes import SIZES, list_sizes, measure_cell, place_picture

ONE = (Section("", 0, 7),)
GROUPS = (Section("a", 0, 4), Section("b", 4, 2, closed=True), Section("c", 6, 5))


def layouts(groups=GROUPS, width=300, cell=(100, 50)):
    return ClipLayout(groups, width, cell)


def test_nothing_has_no_height_and_nothing_is_anywhere():
    layout = layouts((Section("", 0, 0),))
    assert layout.height == 0 and layout.at(QPoint(5, 5)) is None and layout.open_rows() == []
    assert ClipLayout((), 10, (100, 50)).rect(0).isEmpty()


def test_columns_fill_the_width_and_lines_have_all_of_it():
    assert layouts(ONE, 320).columns == 3 and layouts(ONE, 320).cell_width == 106
    assert layouts(ONE, 90).columns == 1, "one that is too narrow has a column, too"
    assert layouts(ONE, 320, (0, 30)).rect(2) == QRect(0, 60, 320, 30)


def test_a_closed_group_shows_its_title_alone():
    layout = layouts()
    assert layout.head(1) == QRect(0, HEAD + 100, 300, HEAD)
    assert layout.rect(4).isEmpty() and layout.rect(6).top() == HEAD + 100 + HEAD + HEAD
    assert layout.height == 3 * HEAD + 4 * 50
    assert layout.open_rows() == [0, 1, 2, 3, 6, 7, 8, 9, 10]


@given(
    st.lists(st.tuples(st.integers(0, 9), st.booleans()), min_size=1, max_size=5),
    st.integers(40, 500),
    st.integers(0, 1),
)
def test_every_row_is_found_where_it_is_and_nowhere_else(sizes, width, titled):
    sections, first = [], 0
    for n, (count, closed) in enumerate(sizes):
        sections.append(Section(f"{n}" * titled, first, count, closed and bool(titled)))
        first += count
    layout = ClipLayout(sections, width, (80, 40))
    seen = set(layout.rows_in(QRect(0, 0, width, layout.height)))
    assert seen == set(layout.open_rows())
    for row in range(first):
        rect = layout.rect(row)
        if row in seen:
            assert layout.at(rect.center()) == row and layout.at(rect.topLeft()) == row
            assert list(layout.rows_in(rect.adjusted(1, 1, -1, -1))) == [row]
            assert layout.head_at(rect.center()) is None
            assert rect.bottom() < layout.height
            for pixels in (40, -40, 400, -400):
                assert layout.below(row, pixels) in seen
        else:
            assert rect.isEmpty()
    for n in range(len(sections)):
        if titled:
            assert layout.head_at(layout.head(n).center()) == n and layout.at(layout.head(n).center()) is None


@pytest.mark.parametrize(
    ("row", "pixels", "found"),
    [(0, 50, 3), (3, -50, 0), (1, 50, 3), (3, 50, 6), (6, -50, 3), (7, -50, 3), (8, 50, 10), (10, 50, 10),
     (0, -50, 0), (0, 1000, 9), (9, -1000, 0)],
)  # fmt: skip
def test_up_and_down_go_to_the_nearest_line_over_closed_groups(row, pixels, found):
    assert layouts().below(row, pixels) == found


def test_left_and_right_leave_closed_groups_out():
    layout = layouts()
    assert [layout.beside(3, 1), layout.beside(6, -1), layout.beside(0, -1), layout.beside(10, 1)] == [
        6,
        3,
        0,
        10,
    ]
    assert [layout.beside(4, 1), layout.beside(5, -1)] == [6, 3], "from one that is hidden"


@pytest.mark.parametrize("style", ["cards", "columns"])
def test_a_picture_is_within_its_place_at_every_size(style):
    for side in list_sizes(style):
        width, height = measure_cell(style, side, 640)
        rect = QRect(0, 0, width or 640, height)
        assert rect.contains(place_picture(style, side, rect))
    assert set(list_sizes(style)) <= set(SIZES)
