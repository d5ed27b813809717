"""Where panels are: docks round the centre, which can be moved, hidden, and put back."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import pairwise

from PySide6.QtCore import QByteArray, QSettings, Qt
from PySide6.QtWidgets import QDockWidget, QMainWindow, QScrollArea, QSplitter, QStackedWidget, QWidget

from app.shell.context import Panel, Place
from app.stage.session import Session

AREAS: dict[Place, Qt.DockWidgetArea] = {
    "left": Qt.DockWidgetArea.LeftDockWidgetArea,
    "right": Qt.DockWidgetArea.RightDockWidgetArea,
    "right below": Qt.DockWidgetArea.RightDockWidgetArea,
    "bottom": Qt.DockWidgetArea.BottomDockWidgetArea,
}
WIDTHS: dict[Place, int] = {"left": 300, "right": 420}  # pixels at first
HEIGHTS: dict[Place, int] = {"right": 470, "right below": 440, "bottom": 286}
ARRANGED = 5  # which docks there are; an arrangement of others, saved before, is not restored


class Places:
    """The panels' docks and the centre. A dock is empty until its panel is made, so that a window can be
    shown before all are.

    centre: what stands in the middle, and beside it. docks: by the panel's id. ready: the late panels are
    made, too.
    """

    def __init__(self, window: QMainWindow, panels: Iterable[Panel], session: Session) -> None:
        self.window, self.session = window, session
        self.panels = {panel.id: panel for panel in panels}
        self.ready = False
        self._made: dict[str, QWidget] = {}
        self._beside: set[str] = set()  # what is wanted beside the centre
        self._before = QByteArray()  # how it was before one panel had the whole window
        self.centre = QSplitter(Qt.Orientation.Horizontal, window)
        self.centre.setChildrenCollapsible(False)
        window.setCentralWidget(self.centre)
        options = QMainWindow.DockOption
        window.setDockOptions(options.AnimatedDocks | options.AllowNestedDocks | options.AllowTabbedDocks)
        self.docks: dict[str, QDockWidget] = {}
        for panel in self._docked():
            dock = self.docks[panel.id] = QDockWidget(panel.title, window)
            dock.setObjectName(panel.id)
            dock.setWidget(QWidget(window))
            window.addDockWidget(AREAS[panel.place], dock)
        session.onstage.mode_changed.connect(self.follow_mode)

    def _docked(self, place: Place | None = None) -> list[Panel]:
        return [
            p
            for p in self.panels.values()
            if p.place in AREAS and not p.instead_of and place in (None, p.place)
        ]

    # --- making

    def make_early(self) -> None:
        """Make the panels of the first picture."""
        for panel in self.panels.values():
            if not panel.late:
                self.panel(panel.id)

    def make_late(self) -> None:
        """Make what was left out for a fast start; panels of another mode wait until it is entered."""
        if self.ready:
            return
        self.ready = True
        for panel in self.panels.values():
            if panel.when in ("any", self.session.onstage.mode) or not panel.instead_of:
                self.panel(panel.id)
        self.follow_mode()
        if not self.restored:
            self.size()

    def panel(self, ident: str) -> QWidget:
        """Return a panel's widget, made now where it was not yet. Raises LookupError."""
        if ident in self._made:
            return self._made[ident]
        panel = self.panels.get(ident)
        if panel is None:
            raise LookupError(f"there is no panel {ident!r}")
        widget = self._made[ident] = panel.make()
        self._put(panel, widget)
        return widget

    def made(self, ident: str) -> QWidget | None:
        """Return a panel's widget where it was made."""
        return self._made.get(ident)

    def _put(self, panel: Panel, widget: QWidget) -> None:
        if panel.place == "centre":
            before = sum(1 for i in self._made if i != panel.id and self.panels[i].place == "centre")
            self.centre.insertWidget(
                before, widget
            )  # what stands beside them comes after all that take turns
            widget.setVisible(panel.when in ("any", self.session.onstage.mode))
        elif panel.place == "beside":
            self.centre.addWidget(widget)
            widget.setVisible(self.shows(panel.id))
        else:
            if panel.scrolls:
                area = QScrollArea(widgetResizable=True)
                area.setFrameShape(QScrollArea.Shape.NoFrame)
                area.setWidget(widget)
                widget = area
            self._into_dock(panel, widget)

    def _into_dock(self, panel: Panel, widget: QWidget) -> None:
        dock = self.docks[panel.instead_of or panel.id]
        if not panel.instead_of and not self._turns(panel.id):
            old = dock.widget()
            dock.setWidget(widget)
            old.deleteLater()
            return
        stack = dock.widget()
        if not isinstance(stack, QStackedWidget):
            stack = QStackedWidget(dock)
            dock.widget().deleteLater()
            dock.setWidget(stack)
        stack.addWidget(widget)
        if panel.when in ("any", self.session.onstage.mode):
            stack.setCurrentWidget(widget)

    def _turns(self, ident: str) -> list[Panel]:
        """Return the panels that take a panel's place in another mode."""
        return [p for p in self.panels.values() if p.instead_of == ident]

    def follow_mode(self) -> None:
        """Show the panels of the mode that is on now; those that were never wanted before are made."""
        mode = self.session.onstage.mode
        # First what goes: both side by side would want a wider window for a moment, and it would stay so.
        for ident, widget in self._made.items():
            panel = self.panels[ident]
            if panel.place in ("centre", "beside") and panel.when not in ("any", mode):
                widget.setVisible(False)
        for panel in self.panels.values():
            if panel.when == mode and mode != "meta":
                self.panel(panel.id)
        for ident, widget in self._made.items():
            panel = self.panels[ident]
            if panel.place == "centre":
                widget.setVisible(panel.when in ("any", mode))
            elif panel.place == "beside":
                widget.setVisible(self.shows(panel.id))
            elif (panel.instead_of or self._turns(panel.id)) and panel.when in ("any", mode):
                stack = self.docks[panel.instead_of or panel.id].widget()
                if isinstance(stack, QStackedWidget):
                    stack.setCurrentWidget(widget)

    # --- showing

    def show(self, ident: str, on: bool = True) -> None:
        """Show a panel in front, or hide it."""
        panel = self.panels[ident]
        if panel.place == "beside":
            (self._beside.add if on else self._beside.discard)(ident)
            if ident in self._made:
                self._made[ident].setVisible(self.shows(ident))
                width = self.centre.width()
                self.centre.setSizes(
                    [
                        width * 6 // 10 if i < self.centre.count() - 1 else width * 4 // 10
                        for i in range(self.centre.count())
                    ]
                )
            return
        dock = self.docks.get(panel.instead_of or ident)
        if dock is not None:
            dock.setVisible(on)
            if on:
                dock.raise_()

    def show_dock(self, ident: str, on: bool) -> None:
        """Show or hide a panel where it is, without bringing it to the front."""
        self.docks[ident].setVisible(on)

    def wanted(self, ident: str) -> bool:
        """Return whether a panel beside the centre was asked for, in its mode."""
        return ident in self._beside

    def shows(self, ident: str) -> bool:
        """Return whether a panel is shown, or would be if the window was."""
        panel = self.panels[ident]
        if panel.place == "beside":
            return ident in self._beside and panel.when in ("any", self.session.onstage.mode)
        return not self.docks[panel.instead_of or ident].isHidden()

    def only(self, ident: str) -> None:
        """Give one panel the whole window, or put everything back."""
        if self.centre.isVisible():
            self._before = self.window.saveState(ARRANGED)
            self.centre.hide()
            for name, dock in self.docks.items():
                dock.setVisible(name == ident)
        else:
            self.centre.show()
            self.window.restoreState(self._before, ARRANGED)

    # --- arranging

    def arrange(self) -> None:
        """Put every dock where it belongs; the window stays as large as it is, though they stand side by side
        for a moment.
        """
        size = self.window.size()
        for ident, dock in self.docks.items():
            dock.setFloating(False)
            self.window.addDockWidget(AREAS[self.panels[ident].place], dock)
            dock.show()
        for place in AREAS:
            shared = [self.docks[p.id] for p in self._docked(place)]
            for one, following in pairwise(shared):
                self.window.tabifyDockWidget(one, following)
            if shared:
                shared[0].raise_()
        self.window.setCorner(Qt.Corner.BottomLeftCorner, AREAS["bottom"])
        self.window.setCorner(Qt.Corner.BottomRightCorner, AREAS["right"])
        self.size()
        self.centre.show()
        layout = self.window.layout()
        if layout is not None and not self.window.isMaximized() and not self.window.isFullScreen():
            layout.activate()
            self.window.resize(size)

    def size(self) -> None:
        """Give each dock its usual share of the window."""
        first = {place: self.docks[found[0].id] for place in AREAS if (found := self._docked(place))}
        across = [p for p in ("left", "right") if p in first]
        self.window.resizeDocks(
            [first[p] for p in across], [WIDTHS[p] for p in across], Qt.Orientation.Horizontal
        )
        for column in (("right", "right below"), ("bottom",)):
            there = [p for p in column if p in first]
            self.window.resizeDocks(
                [first[p] for p in there], [HEIGHTS[p] for p in there], Qt.Orientation.Vertical
            )

    # --- from one time to the next

    def restore(self) -> None:
        """Put docks where they were when the window was last closed."""
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
        """Keep the arrangement for the next time."""
        if self.centre.isVisible():
            QSettings().setValue("geometry", self.window.saveGeometry())
            QSettings().setValue("state", self.window.saveState(ARRANGED))
