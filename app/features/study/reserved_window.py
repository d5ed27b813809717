"""The window while it is kept for a sitting: what may be done, which panels are shown, what lies in reach."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtWidgets import QDialog, QToolBar, QWidget

from app.project.files import Files
from app.project.learned import Learned
from app.shell.actions import Command
from app.shell.context import Shell
from app.shell.header import Header
from app.shell.places import PanelPlaces
from app.shell.workspace_keeper import Workspaces
from app.stage.compatibility_state import Compatibility
from app.translation import tr, tr_noop

CLOSED = tr_noop("This is not available during a study. Everyone works with the same clips.")


class ReservedWindow:
    """Reserves the window from `enter` to `leave`. bar: above the window's own. labels: proposals may be
    made.
    """

    def __init__(self, shell: Shell, bar: QToolBar, labels: bool) -> None:
        self.shell, self.bar, self.labels = shell, bar, labels

    def enter(self) -> None:
        """Close the project's files to new clips, rest all commands, and show the panels that tasks need."""
        shell, services = self.shell, self.shell.services
        services[Files].closed = tr(CLOSED)
        services[Learned].paused = True
        if not self.labels:  # jumps found, and times proposed, for one condition alone would not be fair
            services[Compatibility].forget()
        self.allow(lambda command: False)
        header = services[Header]
        services[Workspaces].everything()
        self._show_others(False)
        shell.widget.insertToolBar(header, self.bar)
        shell.widget.insertToolBarBreak(header)

    def leave(self) -> None:
        """Give the window back as it was."""
        shell, services = self.shell, self.shell.services
        services[Files].closed = ""
        services[Learned].paused = False
        services[Compatibility].start()
        self.reach(True)
        self._show_others(True)
        shell.widget.removeToolBarBreak(services[Header])
        shell.widget.removeToolBar(self.bar)
        shell.stage.session.set_mode("meta")
        services[Workspaces].choose(services[Workspaces].current)
        self.allow(None)

    def _show_others(self, on: bool) -> None:
        """Show or hide what no task needs."""
        places = self.shell.services[PanelPlaces]
        for panel in places.panels.values():
            if not panel.study:
                places.show_dock(panel.id, on)

    def allow(self, allowed: Callable[[Command], bool] | None) -> None:
        """Say which commands may be used; None for all."""
        self.shell.actions.allowed = allowed
        self.shell.actions.refresh()

    def allow_task(self) -> None:
        """Offer what a task may be done with, the same in both conditions except for what only one of the
        editors has.
        """
        self.allow(lambda command: command.study is True or (command.study == "labels" and self.labels))

    def allow_page(self) -> None:
        """Offer what may be done while a page lies over the window."""
        self.allow(lambda command: command.id in ("quit", "theme"))

    def reach(self, on: bool) -> None:
        """Let what lies below a page be reached by the keyboard, or not; nothing lies above it."""
        widget, places = self.shell.widget, self.shell.services[PanelPlaces]
        below: tuple[QWidget, ...] = (
            widget.menuBar(),
            self.shell.services[Header],
            self.bar,
            *places.docks.values(),
        )
        for part in below:
            part.setEnabled(on)
        if on:
            return
        for dock in places.docks.values():
            dock.setFloating(False)
        for dialog in widget.findChildren(QDialog):
            if dialog.isVisible():
                dialog.reject()
