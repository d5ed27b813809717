"""Counts the operators of the keystroke-level model as they happen. Which key it was and what was typed is
never kept.

K a key pressed, B a mouse button pressed or released, P a movement of more than 8 px that ends in a press or
in a rest of more than 0.3 s, D a drag (its two B are counted as well), H a hand that goes from keyboard to
mouse or back.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from time import monotonic

from PySide6.QtCore import QEvent, QObject
from PySide6.QtGui import QCursor, QKeyEvent, QMouseEvent
from PySide6.QtWidgets import QApplication, QDialog

NEAR = 8.0  # pixels
REST = 0.3  # seconds
Point = tuple[float, float]


@dataclass(frozen=True)
class Counts:
    """Operators since the last time they were asked for. drag_s: seconds of the drags; seconds: since the
    last time.
    """

    operators: Counter[str]
    drag_s: float
    seconds: float


class OperatorEvents:
    """Told what the hands do, with times in seconds and points in pixels of the screen; the same event may be
    told again and again.
    """

    def __init__(self, now: float = 0.0) -> None:
        self._counts: Counter[str] = Counter()
        self._drag_s = 0.0
        self._since = now
        self._keys: dict[
            int, tuple[int, bool]
        ] = {}  # held down -> the event's own time, whether it was reported as a press
        self._buttons: set[int] = set()
        self._anchor: Point | None = None  # where the last pointing ended
        self._at: Point = (-1e9, -1e9)  # nowhere yet
        self._moved = 0.0  # when the pointer moved last since then; 0 when it has not gone far
        self._pressed: tuple[Point, float] = (self._at, 0.0)
        self._dragging = False
        self._last = now  # of a drag
        self._hand = ""

    def key(self, key: int, down: bool, stamp: int, asked: bool = False) -> bool:
        """Report a key; return whether it was new. stamp: the event's own time. asked: it is only asked
        whether the key is a shortcut; if it is none it is reported as a press next.
        """
        if not down:
            self._keys.pop(key, None)
            return False
        before = self._keys.get(key)
        known = before is not None and (before[0] == stamp or not (before[1] or asked))
        self._keys[key] = stamp, not asked or (known and before is not None and before[1])
        if known:
            return False
        self._home("keyboard")
        self._counts["K"] += 1
        return True

    def press(self, button: int, at: Point, now: float) -> bool:
        """Report that a button went down; return whether it was new."""
        if button in self._buttons:
            return False
        self.rest(now)
        self._home("mouse")
        if self._anchor is not None and (self._moved or _far(at, self._anchor)):
            self._counts["P"] += 1
        self._point_ended(at)
        self._counts["B"] += 1
        if not self._buttons:
            self._pressed, self._dragging, self._last = (at, now), False, now
        self._buttons.add(button)
        return True

    def release(self, button: int, at: Point, now: float) -> bool:
        """Report that a button went up; return whether it was new."""
        if button not in self._buttons:
            return False
        self._buttons.discard(button)
        self._counts["B"] += 1
        self._drag_to(at, now)
        if self._dragging and not self._buttons:
            self._counts["D"] += 1
            self._drag_s += now - self._pressed[1]
            self._dragging = False
        self._point_ended(at)
        return True

    def move(self, at: Point, held: bool, now: float) -> bool:
        """Report where the pointer is; return whether it moved. held: a button is down."""
        if self._buttons and not held:  # released if nobody told, at the end of a drag
            for button in tuple(self._buttons):
                self.release(button, self._at, self._last)
        if at == self._at:
            return False
        if self._buttons:
            self._drag_to(at, now)
        else:
            self.rest(now)
            self._at = at
            if self._anchor is None:
                self._anchor = at
            elif self._moved or _far(at, self._anchor):
                self._moved = now
        return True

    def drop(self, now: float) -> None:
        """Report that what was dragged was let go."""
        for button in tuple(self._buttons):
            self.release(button, self._at, now)

    def rest(self, now: float) -> None:
        """See whether the pointer has come to rest."""
        if self._moved and now - self._moved > REST:
            self._home("mouse")
            self._counts["P"] += 1
            self._point_ended(self._at)

    def take(self, now: float) -> Counts:
        """Return what there was since the last time, and begin again."""
        self.rest(now)
        out = Counts(self._counts, self._drag_s, now - self._since)
        self._counts, self._drag_s, self._since = Counter(), 0.0, now
        return out

    def _drag_to(self, at: Point, now: float) -> None:
        self._dragging = self._dragging or _far(at, self._pressed[0])
        self._at, self._last = at, now

    def _point_ended(self, at: Point) -> None:
        self._at = self._anchor = at
        self._moved = 0.0

    def _home(self, hand: str) -> None:
        if self._hand not in ("", hand):
            self._counts["H"] += 1
        self._hand = hand


def _far(a: Point, b: Point) -> bool:
    return (a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2 > NEAR * NEAR


_TYPE = QEvent.Type
_KEYS = {_TYPE.KeyPress: True, _TYPE.ShortcutOverride: True, _TYPE.KeyRelease: False}
_MOUSE = frozenset(
    {_TYPE.MouseMove, _TYPE.MouseButtonPress, _TYPE.MouseButtonDblClick, _TYPE.MouseButtonRelease}
)


class Hands(QObject):
    """Watches all events of the application. input: called with the time at each new one of a hand. dialog:
    called with a dialog and whether it is shown.
    """

    def __init__(
        self,
        input: Callable[[float], None],
        dialog: Callable[[QDialog, bool], None],
        scrolled: Callable[[], None],
        parent: QObject,
    ) -> None:
        super().__init__(parent)
        self.operators = OperatorEvents(monotonic())
        self._input, self._dialog, self._scrolled = input, dialog, scrolled
        app = QApplication.instance()
        assert app is not None
        app.installEventFilter(self)

    def stop(self) -> None:
        app = QApplication.instance()
        if app is not None:
            app.removeEventFilter(self)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        kind = event.type()
        if kind in _MOUSE:
            if event.spontaneous() and isinstance(event, QMouseEvent):
                self._mouse(kind, event)
        elif kind in _KEYS and isinstance(event, QKeyEvent):
            asked = kind == _TYPE.ShortcutOverride  # which Qt sends itself; of a shortcut there is no press
            if (asked or event.spontaneous()) and not event.isAutoRepeat():
                self._key(_KEYS[kind], event, asked)
        elif kind == _TYPE.DragMove:
            self._drag()
        elif kind == _TYPE.Drop:
            self.operators.drop(monotonic())
        elif kind == _TYPE.Wheel:
            if event.spontaneous():
                self._input(monotonic())
                self._scrolled()
        elif (kind == _TYPE.Show or kind == _TYPE.Hide) and isinstance(watched, QDialog):
            self._dialog(watched, kind == _TYPE.Show)
        return False

    def _key(self, down: bool, event: QKeyEvent, asked: bool) -> None:
        if self.operators.key(event.key(), down, event.timestamp(), asked):
            self._input(monotonic())

    def _mouse(self, kind: QEvent.Type, event: QMouseEvent) -> None:
        point, now = event.globalPosition(), monotonic()
        at = point.x(), point.y()
        if kind == _TYPE.MouseMove:
            new = self.operators.move(at, bool(event.buttons().value), now)
        elif kind == _TYPE.MouseButtonRelease:
            new = self.operators.release(event.button().value, at, now)
        else:
            new = self.operators.press(event.button().value, at, now)
        if new:
            self._input(now)

    def _drag(self) -> None:
        now, point = monotonic(), QCursor.pos()
        self.operators.move((point.x(), point.y()), True, now)
        self._input(now)
