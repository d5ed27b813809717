"""One window for many tests: between two it is taken back to what it was when it was made, and thrown away
where that does not succeed.
"""

from __future__ import annotations

import time
from collections import Counter
from typing import Any

from PySide6.QtCore import QCoreApplication, QEvent, QSettings, QTimer
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QAbstractScrollArea, QApplication, QDialog, QMenu

from app.project.files import Files
from app.project.learned import Learned
from app.project.watching import Watcher
from metagraph.graph.model import Project
from tests.app.window_state import differences, state_of

SETTLED = 10.0  # seconds within which everything that goes on in an empty window has ended


class SharedWindow:
    """`take` it before a test and `give_back` after; made when first asked for, and again after a test broke
    it.

    made, taken_back: how often; own: windows of tests that want their own. spoilt: what could not be taken back, each with how often.
    """

    def __init__(self) -> None:
        self.window: Any = None
        self.made = self.taken_back = self.own = 0
        self.spoilt: Counter[str] = Counter()
        self._first: dict[str, str] = {}

    def take(self) -> Any:
        """Return the window, shown and as if nothing had been done in it."""
        if self.window is not None and not self._again():
            self.throw_away()
        if self.window is None:
            self.window = complete_window()
            self.made += 1
            reset(self.window)
            self._first = state_of(self.window)
        return self.window

    def _again(self) -> bool:
        try:
            self.window.show()
            reset(self.window)
            found = differences(self._first, state_of(self.window))
        except Exception as error:  # whatever a test has left behind
            found = [f"{type(error).__name__}: {error}"]
        self.spoilt.update(found)
        self.taken_back += not found
        return not found

    def give_back(self, whole: bool) -> None:
        """Let go of what a test had in the window. whole: the test passed; after one that failed nothing is
        taken for granted.
        """
        if not whole or self.window.isHidden():
            self.throw_away()
            return
        try:
            empty(self.window)
        except Exception as error:
            self.spoilt[f"{type(error).__name__}: {error}"] += 1
            self.throw_away()

    def hide(self) -> None:
        """Nothing is drawn while other tests run."""
        if self.window is not None:
            self.window.hide()

    def throw_away(self) -> None:
        if self.window is not None:
            close(self.window)
        self.window = None


def complete_window() -> Any:
    """Return a new window with every panel made, shown."""
    from app.main import make_window

    window = make_window()
    window.resize(1680, 1020)
    window.show()
    window.make_late_panels()
    for ident in window.places.panels:
        window.places.panel(ident)
    return window


def close(window: Any) -> None:
    """Close a window, whatever was done in it."""
    window.shell.document.undo_stack.setClean()
    window.close()
    window.deleteLater()
    QTest.qWait(20)


def empty(window: Any) -> None:
    """Close what lies over a window, end what goes on in it, and let go of its project."""
    shell = window.shell
    while QApplication.activePopupWidget() is not None:
        QApplication.activePopupWidget().close()
    for child in (*window.findChildren(QDialog), *window.findChildren(QMenu)):
        if isinstance(child, QDialog):
            child.close()
            child.deleteLater()
        elif child.isVisible():
            child.close()
    for job in list(shell.jobs.running):
        job.cancel()
    shell.stage.performance.live.end()
    shell.document.load(Project(), None)
    settle(window)
    QCoreApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)


def settle(window: Any) -> None:
    """Wait until nothing goes on; what would be done soon is done now."""
    jobs, deadline = window.shell.jobs, time.monotonic() + SETTLED
    soon = [t for t in window.findChildren(QTimer) if t.isSingleShot()]
    pauses = [t.interval() for t in soon]
    try:
        QTest.qWait(1)
        while jobs.running or jobs._alive or any(t.isActive() for t in soon):
            for timer in soon:
                if timer.isActive():
                    timer.start(0)
            QTest.qWait(1)
            assert time.monotonic() < deadline, f"still at work: {[j.title for j in (*jobs.running, *jobs._alive)]}"
    finally:
        for timer, pause in zip(soon, pauses, strict=True):
            timer.setInterval(pause)


def reset(window: Any) -> None:
    """Take a window back to how it begins, on a new project."""
    shell = window.shell
    services, session = shell.services, shell.stage.session
    QSettings().clear()
    services[Files].closed = ""
    services[Learned].paused = False
    services[Watcher].set_on(True)
    shell.actions.allowed = None
    session.set_mode("meta")
    session.onstage.set_performance(None)
    session.onstage.set_conversation(None)
    session.onstage.set_side(0)
    session.place.set_layer("arms")
    session.place.forget()
    session.selection.clear()
    session.selection.copied = None
    session.transport.speed, session.transport.loop = 1.0, True
    session.transport.set_playing(True)
    session.look.choose("dark")
    shell.stage.sound.set_muted(False)
    shell.document.load(Project(), None)
    shell.files.opened.emit()
    for panel in window.places.panels.values():
        if panel.place == "beside":
            window.places.show(panel.id, False)
    window.arrange()
    _panels(window)
    shell.notice.clear()
    window.statusBar().clearMessage()
    window.setFocus()
    settle(window)
    window.refresh()


def _panels(window: Any) -> None:
    """Take back what the panels hold themselves."""
    panel = window.shell.panel
    library, canvas = panel("library"), panel("graph")
    library.search.clear()
    library.chips["all"].click()
    library._narrow(None, None)
    canvas.focus = None
    for area in window.findChildren(QAbstractScrollArea):
        for bar in (area.horizontalScrollBar(), area.verticalScrollBar()):
            bar.setValue(bar.minimum())
