"""Tell screen readers what a painted canvas holds: each thing on it is reported as an item of a list, with
its name, role, place and state, though it is no widget.
"""

from __future__ import annotations

import time
import weakref
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Protocol, cast

from PySide6.QtCore import QObject, QRect, QRectF
from PySide6.QtGui import QAccessible, QAccessibleEvent, QAccessibleInterface, QWindow
from PySide6.QtWidgets import QAccessibleWidget, QWidget

Role = QAccessible.Role


@dataclass(frozen=True)
class SpokenItem:
    """A thing on a canvas. rect: in the widget's pixels. value: of what can be set, such as a time."""

    name: str
    rect: QRectF
    role: Role = Role.ListItem
    description: str = ""
    value: str = ""
    selected: bool = False
    focused: bool = False


class SpokenCanvas(Protocol):
    """A widget that lists what it has painted, in the order in which a reader goes through it."""

    def list_spoken_items(self) -> Sequence[SpokenItem]: ...


FRESH = 0.1  # seconds for which a list is not made again: a reader asks for each item many times

# Qt keeps the address of each interface until its widget, or the program, is gone: none may be collected
# before. An item is one by its place on its canvas, so there are no more than the most that were ever on one.
_kept: list[QAccessibleInterface] = []


def install_spoken_items() -> None:
    """Let Qt ask for the items of canvases; once for an application."""
    QAccessible.installFactory(_make)


def tell_spoken_focus(widget: QWidget) -> None:
    """Tell a screen reader, if there is one, that another item of a canvas has the focus."""
    if QAccessible.isActive() and widget.hasFocus():
        items = _items(widget)
        place = next((n for n, item in enumerate(items) if item.focused), None)
        if place is not None:
            event = QAccessibleEvent(widget, QAccessible.Event.Focus)
            event.setChild(place)
            QAccessible.updateAccessibility(event)


def tell_spoken_change(widget: QWidget) -> None:
    """Tell a screen reader, if there is one, that a canvas has other items than before."""
    if QAccessible.isActive():
        QAccessible.updateAccessibility(QAccessibleEvent(widget, QAccessible.Event.ObjectReorder))


def _make(_: str, made: QObject) -> QAccessibleInterface | None:
    if not isinstance(made, QWidget) or not hasattr(made, "list_spoken_items"):
        return None
    found = SpokenList(made)
    _kept.append(found)
    return found


def _items(widget: QWidget) -> Sequence[SpokenItem]:
    return cast(SpokenCanvas, widget).list_spoken_items()


class SpokenList(QAccessibleWidget):
    """A canvas as a list of its items."""

    def __init__(self, widget: QWidget) -> None:
        super().__init__(widget, Role.List, "")
        self.of = weakref.ref(widget)  # it must not keep a closed window
        self.made: list[SpokenPlace] = []
        self._known: tuple[float, Sequence[SpokenItem]] = (-1.0, ())

    def items(self) -> Sequence[SpokenItem]:
        """Return what is on the canvas now; nothing once it is gone."""
        widget, now = self.of(), time.monotonic()
        if widget is None or not self.isValid():
            return ()
        if now - self._known[0] > FRESH:
            self._known = now, _items(widget)
        return self._known[1]

    def childCount(self) -> int:
        return len(self.items())

    def child(self, place: int) -> Any:
        if not 0 <= place < self.childCount():
            return None
        while len(self.made) <= place:
            item = SpokenPlace(self, len(self.made))
            self.made.append(item)
            _kept.append(item)
            QAccessible.registerAccessibleInterface(item)
        return self.made[place]

    def indexOfChild(self, child: QAccessibleInterface) -> int:
        return child.place if isinstance(child, SpokenPlace) and child.above is self else -1

    def childAt(self, x: int, y: int) -> Any:
        return next((self.child(n) for n in range(self.childCount()) if self.place(n).contains(x, y)), None)

    def focusChild(self) -> Any:
        place = next((n for n, item in enumerate(self.items()) if item.focused), None)
        return self.child(place) if place is not None else self

    def place(self, place: int) -> QRect:
        """Return where an item is on the screen."""
        widget, items = self.of(), self.items()
        if widget is None or not 0 <= place < len(items):
            return QRect()
        rect = items[place].rect.toAlignedRect().intersected(widget.rect())
        return QRect(widget.mapToGlobal(rect.topLeft()), rect.size())


class SpokenPlace(QAccessibleInterface):
    """What is at a place in the list of a canvas."""

    def __init__(self, above: SpokenList, place: int) -> None:
        super().__init__()
        self.above, self.place = above, place

    def _item(self) -> SpokenItem | None:
        items = self.above.items()
        return items[self.place] if self.place < len(items) else None

    def isValid(self) -> bool:
        return self._item() is not None

    def object(self) -> Any:
        return None

    def window(self) -> QWindow:
        widget = self.above.of()
        return widget.window().windowHandle() if widget is not None else cast(QWindow, None)

    def parent(self) -> QAccessibleInterface:
        return self.above

    def child(self, _: int) -> Any:
        return None

    def childAt(self, _x: int, _y: int) -> Any:
        return None

    def childCount(self) -> int:
        return 0

    def indexOfChild(self, _: QAccessibleInterface) -> int:
        return -1

    def role(self) -> Role:
        item = self._item()
        return item.role if item is not None else Role.NoRole

    def rect(self) -> QRect:
        return self.above.place(self.place)

    def text(self, kind: QAccessible.Text) -> str:
        item, texts = self._item(), QAccessible.Text
        if item is None:
            return ""
        return {texts.Name: item.name, texts.Description: item.description, texts.Value: item.value}.get(
            kind, ""
        )

    def setText(self, _kind: QAccessible.Text, _text: str) -> None:
        """A reader changes nothing here; keys do."""

    def state(self) -> QAccessible.State:
        out, item = QAccessible.State(), self._item()
        if item is None:
            out.invalid = 1
            return out
        out.selectable = out.focusable = 1
        out.selected, out.focused = int(item.selected), int(item.focused)
        out.invisible = out.offscreen = int(self.rect().isEmpty())
        return out
