"""Where the panels are: docks round the canvas, which can be moved, hidden, and put back."""

from __future__ import annotations

from itertools import pairwise

from PySide6.QtCore import QByteArray, QSettings, Qt
from PySide6.QtWidgets import QDockWidget, QMainWindow, QScrollArea, QWidget

_LEFT, _RIGHT, _BOTTOM = Qt.DockWidgetArea.LeftDockWidgetArea, Qt.DockWidgetArea.RightDockWidgetArea, Qt.DockWidgetArea.BottomDockWidgetArea
PLACES = {
    "library": ("Clips", _LEFT), "preview": ("Character", _RIGHT), "properties": ("Properties", _RIGHT), "life": ("Life", _RIGHT),
    "timeline": ("Performance", _BOTTOM), "conversation": ("Conversation", _BOTTOM),
    "models": ("Models", _BOTTOM), "lines": ("Lines", _BOTTOM), "problems": ("Problems", _BOTTOM),
}  # fmt: skip
TABS = (("properties", "life"), ("timeline", "conversation", "models", "lines", "problems"))  # which share a place; the first is in front
ARRANGED = 4  # which docks there are; an arrangement of others, saved before, is not restored


class Docks(dict[str, QDockWidget]):
    """The window's docks by name; empty until `fill` puts their panels in, so that a window can be shown before all are made."""

    def __init__(self, window: QMainWindow, centre: QWidget) -> None:
        super().__init__()
        self.window, self.centre = window, centre
        self._before = QByteArray()  # how it was before the character had the whole window
        for key, (title, area) in PLACES.items():
            dock = self[key] = QDockWidget(title, window)
            dock.setObjectName(key)
            dock.setWidget(QWidget(window))
            window.addDockWidget(area, dock)

    def fill(self, key: str, panel: QWidget, scrolls: bool = False) -> None:
        """Put a panel into its dock. scrolls: it may need more room than the dock has."""
        if scrolls:
            area = QScrollArea(widgetResizable=True)
            area.setFrameShape(QScrollArea.Shape.NoFrame)
            area.setWidget(panel)
            panel = area
        old = self[key].widget()
        self[key].setWidget(panel)
        old.deleteLater()

    def arrange(self) -> None:
        """Put every dock where it belongs; the window stays as large as it is, though they stand side by side for a moment."""
        size = self.window.size()
        for key, (_, area) in PLACES.items():
            self[key].setFloating(False)
            self.window.addDockWidget(area, self[key])
            self[key].show()
        for first, *others in TABS:
            for one, following in pairwise((first, *others)):
                self.window.tabifyDockWidget(self[one], self[following])
            self[first].raise_()
        self.window.setCorner(Qt.Corner.BottomLeftCorner, _BOTTOM)
        self.window.setCorner(Qt.Corner.BottomRightCorner, _RIGHT)
        self.size()
        self.centre.show()
        layout = self.window.layout()
        if layout is not None and not self.window.isMaximized() and not self.window.isFullScreen():
            layout.activate()
            self.window.resize(size)

    def size(self) -> None:
        """Give each dock its usual share of the window."""
        across, down = Qt.Orientation.Horizontal, Qt.Orientation.Vertical
        self.window.resizeDocks([self["library"], self["preview"]], [300, 420], across)
        self.window.resizeDocks([self["preview"], self["properties"]], [470, 440], down)
        self.window.resizeDocks([self["timeline"]], [286], down)

    def show(self, key: str) -> None:
        self[key].show()
        self[key].raise_()

    def only(self, key: str) -> None:
        """Give one dock the whole window, or put everything back."""
        if self.centre.isVisible():
            self._before = self.window.saveState(ARRANGED)
            self.centre.hide()
            for name, dock in self.items():
                dock.setVisible(name == key)
        else:
            self.centre.show()
            self.window.restoreState(self._before, ARRANGED)

    # --- from one time to the next

    def restore(self) -> None:
        """Put them where they were when the window was last closed."""
        geometry, state = QSettings().value("geometry"), QSettings().value("state")
        if isinstance(geometry, QByteArray):
            self.window.restoreGeometry(geometry)
        if isinstance(state, QByteArray):
            self.window.restoreState(state, ARRANGED)

    @property
    def restored(self) -> bool:
        """Whether there is an arrangement from before."""
        return isinstance(QSettings().value("state"), QByteArray)

    def save(self) -> None:
        if self.centre.isVisible():
            QSettings().setValue("geometry", self.window.saveGeometry())
            QSettings().setValue("state", self.window.saveState(ARRANGED))
