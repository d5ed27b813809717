"""How large clips are shown: as lines up to a size, as cards from there on, or in columns."""

from __future__ import annotations

from typing import Literal

from PySide6.QtCore import QRect

Style = Literal["cards", "columns"]
SIZES = (20, 28, 40, 54, 84, 108, 144, 184, 224)  # pixels of a picture's side
USUAL: dict[Style, int] = {"cards": 108, "columns": 28}
LINES = 54  # up to so many pixels there are lines instead of cards
LARGEST_LINE = 84  # in columns
LINE_WIDTH = 250  # of a line, at least, where there is room for more than one beside another
TEXT = 68  # pixels of a card besides its picture
EDGE = 8


def is_in_lines(style: Style, side: int) -> bool:
    """Return whether clips are lines: a picture, and words beside it."""
    return style == "columns" or side <= LINES


def measure_cell(style: Style, side: int, width: int) -> tuple[int, int]:
    """Return the least width and the height of a clip in a room of a width; 0 for all of it."""
    if style == "columns":
        return 0, side + EDGE
    if side <= LINES:
        return (LINE_WIDTH if width >= 2 * LINE_WIDTH else 0), side + EDGE
    return side + 2 * EDGE, side + TEXT


def place_picture(style: Style, side: int, rect: QRect) -> QRect:
    """Return where the picture is within a clip's place."""
    if is_in_lines(style, side):
        return QRect(rect.left() + 12, rect.top() + (rect.height() - side) // 2, side, side)
    return QRect(rect.left() + (rect.width() - side) // 2, rect.top() + 6, side, side)


def list_sizes(style: Style) -> tuple[int, ...]:
    """Return the sizes there are."""
    return SIZES if style == "cards" else tuple(s for s in SIZES if s <= LARGEST_LINE)
