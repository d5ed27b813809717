"""Where a window stands so that it does not cover what it is about."""

from __future__ import annotations

from PySide6.QtCore import QPoint, QRect
from PySide6.QtWidgets import QWidget

MARGIN = 8  # pixels between the two


def find_free_place(size: tuple[int, int], least: tuple[int, int], room: QRect, about: QRect) -> QRect:
    """Return where a window of a size stands in a room, at that side of what it is about that has most space
    for it, smaller if need be, but not below `least`. All in pixels of the screen.
    """
    sides = (
        QRect(room.left(), room.top(), about.left() - room.left() - MARGIN, room.height()),
        QRect(about.right() + MARGIN, room.top(), room.right() - about.right() - MARGIN, room.height()),
        QRect(room.left(), room.top(), room.width(), about.top() - room.top() - MARGIN),
        QRect(room.left(), about.bottom() + MARGIN, room.width(), room.bottom() - about.bottom() - MARGIN),
    )

    def fits(side: QRect) -> int:
        return min(size[0], side.width()) * min(size[1], side.height()) if side.isValid() else -1

    best = max(sides, key=fits)
    if not best.isValid():
        best = room
    width = max(least[0], min(size[0], best.width()))
    height = max(least[1], min(size[1], best.height()))
    out = QRect(0, 0, width, height)
    out.moveCenter(best.center())
    left, top = best.left() + max(0, best.width() - width), best.top() + max(0, best.height() - height)
    out.moveLeft(max(room.left(), min(out.left(), left, room.left() + room.width() - width)))
    out.moveTop(max(room.top(), min(out.top(), top, room.top() + room.height() - height)))
    return out


def stand_beside(dialog: QWidget, about: QWidget) -> None:
    """Put a window, before it is shown, beside a widget that is to stay in sight."""
    screen = about.screen()
    if not about.isVisible() or screen is None:
        return
    there = QRect(about.mapToGlobal(QPoint()), about.size())
    least = dialog.minimumSizeHint().expandedTo(dialog.minimumSize())
    size = dialog.size()
    dialog.setGeometry(
        find_free_place(
            (size.width(), size.height()),
            (least.width(), least.height()),
            screen.availableGeometry(),
            there,
        )
    )
