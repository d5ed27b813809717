"""Keep each dock's share of the window when the window is resized; Qt would give all the additional room to
one of them.
"""

from __future__ import annotations

import json
from collections.abc import Mapping

from PySide6.QtCore import QEvent, QObject, Qt, QTimer
from PySide6.QtWidgets import QDockWidget, QMainWindow, QToolBar

DIRECT = Qt.FindChildOption.FindDirectChildrenOnly  # the whole window has about a thousand objects
Shares = dict[str, tuple[float, float]]  # of the width and the height, by the dock's name


class Proportions(QObject):
    """Follows how the user moves the docks, and keeps their shares. `docks` are by name."""

    def __init__(self, window: QMainWindow, docks: Mapping[str, QDockWidget]) -> None:
        super().__init__(window)
        self.window, self.docks = window, docks
        self.shares: Shares = {}
        self._of: frozenset[str] = frozenset()  # the docks that were open when the shares were taken
        self._soon = QTimer(self, singleShot=True, interval=0)
        self._soon.timeout.connect(self.note)
        for dock in docks.values():
            dock.visibilityChanged.connect(self._changed)
            dock.topLevelChanged.connect(lambda _: self._soon.start())

    def follow(self) -> None:
        """Follow the window's size and the mouse from now on. While the window is made there would be no such
        events, but some hundred others.
        """
        self.window.installEventFilter(self)

    def want(self, shares: Shares) -> None:
        """Keep these shares from now on."""
        self.shares, self._of = shares, self._open()
        self._soon.stop()
        self.hold()

    def note(self) -> None:
        """Keep the current shares from now on."""
        width, height = self._room()
        out: Shares = {}
        for name in self._open():
            dock = self.docks[name]
            front = next((d for d in (dock, *self.window.tabifiedDockWidgets(dock)) if _in_front(d)), None)
            if front is not None:
                out[name] = (front.width() / width, front.height() / height)
        self.shares, self._of = out, self._open()

    def _open(self) -> frozenset[str]:
        """Return which docks are in the window, in front or behind another."""
        return frozenset(n for n, d in self.docks.items() if not d.isHidden() and not d.isFloating())

    def _changed(self) -> None:
        """Note that a dock was opened or closed, so the others have other shares now."""
        if self._open() != self._of:
            self._soon.start()

    def hold(self) -> None:
        """Give each dock the share to keep."""
        width, height = self._room()
        seen = [(d, self.shares[n]) for n, d in self.docks.items() if n in self.shares and _in_front(d)]
        docks = [d for d, _ in seen]
        animated = self.window.isAnimated()
        self.window.setAnimated(False)
        for sizes, along in (
            ([round(width * x) for _, (x, _) in seen], Qt.Orientation.Horizontal),
            ([round(height * y) for _, (_, y) in seen], Qt.Orientation.Vertical),
        ):
            self.window.resizeDocks(docks, sizes, along)
        self.window.setAnimated(animated)

    def _room(self) -> tuple[int, int]:
        """Return width and height of the part of the window that docks share."""
        window = self.window
        bars = [window.menuBar(), window.statusBar(), *window.findChildren(QToolBar, options=DIRECT)]
        taken = sum(b.height() for b in bars if not b.isHidden())
        return max(1, window.width()), max(1, window.height() - taken)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if event.type() == QEvent.Type.Resize:
            self._soon.stop()
            self.hold()
        elif event.type() == QEvent.Type.MouseButtonRelease:  # a line between two docks was released
            self._soon.start()
        return False

    # --- from one time to the next

    def text(self) -> str:
        """Return the shares as a text that `read` understands."""
        return json.dumps({n: [round(x, 4), round(y, 4)] for n, (x, y) in self.shares.items()})

    def read(self, text: object) -> None:
        """Keep the shares in a text that `text` returned; the current ones if it cannot be read."""
        try:
            rows = json.loads(str(text))
            self.want({str(n): (float(x), float(y)) for n, (x, y) in rows.items()})
        except (ValueError, TypeError, AttributeError):
            self.note()


def _in_front(dock: QDockWidget) -> bool:
    """Return whether a dock is in the window and not behind another."""
    return not dock.isHidden() and not dock.isFloating() and dock.x() >= 0 and dock.width() > 0
