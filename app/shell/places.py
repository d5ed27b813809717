"""Place panels: each is in a dock, and the docks are in the areas of a workspace; they can be moved, hidden,
and put back.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from functools import partial
from importlib import import_module

from PySide6.QtCore import QByteArray, QSize, Qt
from PySide6.QtWidgets import (
    QDockWidget,
    QMainWindow,
    QScrollArea,
    QSplitter,
    QStackedWidget,
    QToolBar,
    QWidget,
)

from app.shell.arranging import arrange_docks, share_window
from app.shell.context import Panel
from app.shell.proportions import Proportions
from app.shell.workspaces import ALL, Workspace
from app.stage.session import StageSession
from app.widgets.painting import PaintingHold
from app.widgets.soon import Soon

ARRANGED = (
    7  # how panels are put into docks; an arrangement that was saved when it was done otherwise is void
)

BEHIND = 6  # the rank of panels above which they are behind the others where all are shown


class Room(QScrollArea):
    """What a dock holds. It can always shrink to its minimum, whatever is in it and whenever that
    was made.
    """

    def __init__(self, least: tuple[int, int], parent: QWidget) -> None:
        super().__init__(parent)
        self.setWidgetResizable(True)
        self.setFrameShape(QScrollArea.Shape.NoFrame)
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self._least = QSize(*least)
        self.setMinimumSize(self._least)

    def minimumSizeHint(self) -> QSize:
        return self._least

    def sizeHint(self) -> QSize:
        return self._least


def fetch_now(names: Iterable[str], then: Callable[[], object]) -> None:
    """Import modules, then continue."""
    for name in names:
        import_module(name)
    then()


class PanelPlaces:
    """The panels' docks. A dock is empty until its panel is made: those of the first picture before it is
    painted, every other one once its dock is seen in front of those with the same place, or when it is
    needed. Many never are.

    `docks` are by the panel's id. `centre` has the panels that alternate in one dock, and those beside them.
    `workspace` is the one whose areas the docks are in. `ready` means that the first picture is painted, so
    that panels are made when they are seen. `fetch` imports what a panel needs, and then continues.
    """

    def __init__(self, window: QMainWindow, panels: Iterable[Panel], session: StageSession) -> None:
        self.window, self.session = window, session
        self.panels = {panel.id: panel for panel in panels}
        self.workspace = ALL
        self.ready = False
        self.fetch = fetch_now
        self._in_sight: dict[str, bool] = {}  # docks
        self._soon = Soon(self._fill, window)
        self._hold = PaintingHold(window)
        self._made: dict[str, QWidget] = {}
        self._beside: set[str] = set()  # what should be visible beside the centre
        self._before: QByteArray | None = None  # the arrangement before one panel had the whole window
        self._shares = ""
        self._hidden: list[QWidget] = []  # bars, while one panel has the whole window
        self._bare: QDockWidget | None = None
        options = QMainWindow.DockOption
        window.setDockOptions(options.AnimatedDocks | options.AllowNestedDocks | options.AllowTabbedDocks)
        self.centre = QSplitter(Qt.Orientation.Horizontal, window)
        self.centre.setChildrenCollapsible(False)
        self.docks: dict[str, QDockWidget] = {}
        for panel in self.panels.values():
            if panel.place == "beside" or panel.instead_of:
                continue
            dock = self.docks[panel.id] = QDockWidget(panel.title, window)
            dock.setObjectName(panel.id)
            room = Room(panel.least, dock)
            room.setWidget(self.centre if panel.place == "centre" else QWidget(room))
            dock.setWidget(room)
            self._in_sight[panel.id] = False
            dock.visibilityChanged.connect(partial(self._seen, panel.id))
            window.addDockWidget(Qt.DockWidgetArea.LeftDockWidgetArea, dock)
        self.proportions = Proportions(window, self.docks)
        session.onstage.mode_changed.connect(self.follow_mode)

    def dock(self, ident: str) -> QDockWidget:
        """Return the dock in which a panel is, alone, in turn with others or beside another. Raises
        LookupError.
        """
        panel = self.panels.get(ident)
        if panel is None:
            raise LookupError(f"there is no panel {ident!r}")
        if panel.instead_of:
            return self.docks[panel.instead_of]
        if panel.place == "beside":
            centre = next((p.id for p in self.panels.values() if p.place == "centre"), "")
            return self.docks[centre]
        return self.docks[ident]

    # --- making

    def make_early(self) -> None:
        """Make the panels of the first picture."""
        for panel in self.panels.values():
            if not panel.late:
                self.panel(panel.id)

    def make_late(self) -> None:
        """Make the visible panels that were left out for a fast start."""
        if self.ready:
            return
        self.ready = True
        for panel in self.lacking():
            self.panel(panel.id)
        self.follow_mode()

    def make_all(self) -> None:
        """Make every panel of every mode, visible or not."""
        self.ready = True
        for ident in self.panels:
            self.panel(ident)
        self.follow_mode()

    def lacking(self) -> list[Panel]:
        """Return the panels that should be visible now and are not made yet."""
        mode = self.session.onstage.mode
        return [
            panel
            for panel in self.panels.values()
            if panel.id not in self._made
            and panel.when in ("any", mode)
            and self._in_sight[self.dock(panel.id).objectName()]
            and (panel.place != "beside" or self.shows(panel.id))
        ]

    def to_import(self) -> list[str]:
        """Return the modules that these need and that are not imported yet."""
        return [name for panel in self.lacking() for name in panel.imports if name not in sys.modules]

    def _seen(self, ident: str, seen: bool) -> None:
        """Note that a dock came into sight or left it, perhaps only until others come before it."""
        self._in_sight[ident] = seen
        if seen:
            self._soon.ask()

    def _fill(self) -> None:
        """Make the panels that are visible now and were not before."""
        if not self.ready:
            return
        names = self.to_import()
        if names:
            self.fetch(names, self._fill)
            return
        for panel in self.lacking():
            self.panel(panel.id)

    def panel(self, ident: str) -> QWidget:
        """Return a panel's widget, made now if it was not yet. Raises LookupError."""
        if ident in self._made:
            return self._made[ident]
        panel = self.panels.get(ident)
        if panel is None:
            raise LookupError(f"there is no panel {ident!r}")
        widget = self._made[ident] = panel.make()
        self._put(panel, widget)
        return widget

    def made(self, ident: str) -> QWidget | None:
        """Return a panel's widget if it was made, else None."""
        return self._made.get(ident)

    def holding(self, inner: QWidget | None) -> str:
        """Return the panel in which a widget is; "" if it is in none."""
        if inner is None:
            return ""
        return next((i for i, made in self._made.items() if made is inner or made.isAncestorOf(inner)), "")

    def _put(self, panel: Panel, widget: QWidget) -> None:
        if panel.place == "centre":
            before = sum(1 for i in self._made if i != panel.id and self.panels[i].place == "centre")
            self.centre.insertWidget(
                before, widget
            )  # what stands beside them comes after all that take turns
            widget.setVisible(panel.when in ("any", self.session.onstage.mode))
        elif panel.place == "beside":
            widget.hide()  # otherwise the widget beside it would be narrow for a moment
            self.centre.addWidget(widget)
            widget.setVisible(self.shows(panel.id))
        else:
            self._into_dock(panel, widget)

    def _into_dock(self, panel: Panel, widget: QWidget) -> None:
        room = self.docks[panel.instead_of or panel.id].widget()
        assert isinstance(room, Room)
        if not panel.instead_of and not self._turns(panel.id):
            room.setWidget(widget)  # its previous content is deleted
            return
        stack = room.widget()
        if not isinstance(stack, QStackedWidget):
            stack = QStackedWidget(room)
            room.setWidget(stack)
        stack.addWidget(widget)
        if panel.when in ("any", self.session.onstage.mode):
            stack.setCurrentWidget(widget)

    def _turns(self, ident: str) -> list[Panel]:
        """Return the panels that take a panel's place in another mode."""
        return [p for p in self.panels.values() if p.instead_of == ident]

    def follow_mode(self) -> None:
        """Show the panels of the current mode; those that were not needed before are made."""
        mode = self.session.onstage.mode
        # Hide the old ones first: both side by side would need a wider window for a moment, and it would stay
        # wide.
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
                stack = widget.parentWidget()
                if isinstance(stack, QStackedWidget):
                    stack.setCurrentWidget(widget)
        self._soon.ask()

    # --- showing

    def show(self, ident: str, on: bool = True) -> None:
        """Show a panel in front, or hide it. Raises LookupError if there is none."""
        dock = self.dock(ident)
        if self.panels[ident].place == "beside":
            if on and self.ready:
                self.panel(ident)
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
            if not on:
                return
        dock.setVisible(on)
        if on:
            dock.raise_()

    def show_dock(self, ident: str, on: bool) -> None:
        """Show or hide a panel where it is, without bringing it to the front."""
        self.docks[ident].setVisible(on)

    def wanted(self, ident: str) -> bool:
        """Return whether a panel beside the centre should be visible in its mode."""
        return ident in self._beside

    def shows(self, ident: str) -> bool:
        """Return whether a panel is shown, or would be if the window were."""
        panel = self.panels[ident]
        if panel.place == "beside":
            return ident in self._beside and panel.when in ("any", self.session.onstage.mode)
        return not self.dock(ident).isHidden()

    @property
    def alone(self) -> bool:
        """Return whether one panel has the whole window."""
        return self._before is not None

    def only(self, ident: str) -> None:
        """Give one panel the whole window, without bars and titles, or restore everything."""
        if self._before is None:
            self._before, self._shares = self.window.saveState(ARRANGED), self.proportions.text()
            for name, dock in self.docks.items():
                dock.setVisible(name == ident)
            self._bare = self.docks[ident]
            self._bare.setTitleBarWidget(QWidget(self._bare))
            self._hidden = [b for b in self._bars() if not b.isHidden()]
            for bar in self._hidden:
                bar.hide()
        else:
            before, self._before = self._before, None
            self._show_bars()
            self.window.restoreState(before, ARRANGED)
            shares, self._shares = self._shares, ""
            self.proportions.read(shares)

    def _bars(self) -> list[QWidget]:
        window = self.window
        tools = [b for b in window.findChildren(QToolBar) if b.parent() is window]
        return [window.menuBar(), window.statusBar(), *tools]

    def _show_bars(self) -> None:
        """Show again what was hidden for one panel."""
        for bar in self._hidden:
            bar.show()
        self._hidden = []
        if self._bare is not None:
            empty = self._bare.titleBarWidget()
            self._bare.setTitleBarWidget(None)  # type: ignore[arg-type]
            if empty is not None:
                empty.deleteLater()
            self._bare = None

    # --- arranging

    def area(self, ident: str, workspace: Workspace) -> str:
        """Return the area in which the dock of a panel is in a workspace, or opens there."""
        panel = self.panels[ident]
        if workspace.id == ALL.id:
            return panel.place
        return panel.where.get(workspace.id) or panel.opens.get(workspace.id) or workspace.spare

    def belongs(self, ident: str, workspace: Workspace) -> bool:
        """Return whether a panel has a place of its own in a workspace, shown at first or not."""
        panel = self.panels[self.dock(ident).objectName()]
        return workspace.id == ALL.id or workspace.id in panel.where or workspace.id in panel.opens

    def large(self) -> str:
        """Return the panel that is large in the current workspace."""
        there = self._filled(self.workspace).get(self.workspace.large, ())
        return there[0].objectName() if there else ""

    def arrange(self, workspace: Workspace, kept: tuple[QByteArray, str] | None = None) -> None:
        """Put every dock where a workspace has it, or where it was when `state` returned `kept`."""
        self._before, self._shares = None, ""
        self._show_bars()
        with self._quietly():
            if kept is None or not self.window.restoreState(kept[0], ARRANGED):
                self._settle(workspace)
            else:
                self.proportions.read(kept[1])
            self.workspace = workspace

    def _settle(self, workspace: Workspace) -> None:
        shown = {
            ident
            for ident in self.docks
            if workspace.id == ALL.id or workspace.id in self.panels[ident].where
        }
        filled = self._filled(workspace)
        arrange_docks(self.window, list(self.docks.values()), workspace, filled, shown)
        self.proportions.want(share_window(workspace, filled))

    def _filled(self, workspace: Workspace) -> dict[str, list[QDockWidget]]:
        """Return the docks of each area; those that are shown at first come first."""
        out: dict[str, list[QDockWidget]] = {}
        rank = {n: (workspace.id not in self.panels[n].where, self.panels[n].rank) for n in self.docks}
        behind = {n: (self.panels[n].rank > BEHIND, 0) for n in self.docks}
        order = sorted(self.docks, key=lambda n: behind[n] if workspace.id == ALL.id else rank[n])
        for ident in order:
            area = self.area(ident, workspace)
            if area not in workspace.areas:
                raise ValueError(f"panel {ident!r}: the workspace {workspace.id} has no area {area!r}")
            out.setdefault(area, []).append(self.docks[ident])
        return out

    @contextmanager
    def _quietly(self) -> Iterator[None]:
        """Draw nothing before everything is in place, and keep the window's size."""
        window, size = self.window, self.window.size()
        self._hold.begin()
        window.setAnimated(False)
        try:
            yield
        finally:
            window.setAnimated(True)
            layout = window.layout()
            if layout is not None and not window.isMaximized() and not window.isFullScreen():
                layout.activate()
                window.resize(size)
            self._hold.end()

    def state(self) -> tuple[QByteArray, str]:
        """Return where the docks are now, and their shares of the window."""
        state = self._before if self._before is not None else self.window.saveState(ARRANGED)
        return state, self._shares if self._before is not None else self.proportions.text()
