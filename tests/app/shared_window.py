"""One window for many tests: between two it is taken back to what it was when it was made, and thrown away if
that does not succeed.
"""

from __future__ import annotations

import time
from collections import Counter
from typing import Any, NamedTuple

from PySide6.QtCore import QByteArray, QCoreApplication, QEvent, QSettings, QSize, QTimer
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QDialog, QMenu, QScrollBar, QWidget
from shiboken6 import isValid

from app.features.character.character_panel import SPEEDS
from app.project.files import Files
from app.project.learned import Learned
from app.project.watching import EVERY, Watcher
from app.shell.workspace_keeper import Tab
from app.shell.workspaces import ALL, FIRST
from app.widgets.painting import PaintingHold
from metagraph.graph.model import Project
from tests.app.window_state import differences, is_ours, state_of

SETTLED = 60.0  # seconds; a slow machine takes its time over jobs
SOON = 10_000  # milliseconds; what waits longer waits for somebody who does nothing


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
        self._stands: Stand | None = None

    def take(self) -> Any:
        """Return the window, shown and as if nothing had been done in it."""
        if self.window is not None and not self._again():
            self.throw_away()
        if self.window is None:
            self.window = complete_window()
            self.made += 1
            reset(self.window)
            self._first, self._stands = state_of(self.window), stands(self.window)
        return self.window

    def _again(self) -> bool:
        try:
            self.window.show()
            reset(self.window, self._stands)
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

    def words(self) -> str:
        """Say how often, and what spoilt a window most."""
        out = f"{self.made} made and {self.taken_back} times taken back, {self.own} of their tests alone"
        worst = "; ".join(f"{what[:150]} ({n})" for what, n in self.spoilt.most_common(2))
        return f"{out}; spoilt by {worst}" if worst else out

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
    window.places.make_all()
    assert window.shell.panel("properties").action is not None
    return window


def close(window: Any) -> None:
    """Close a window, whatever was done in it."""
    window.shell.document.undo_stack.setClean()
    window.close()
    window.deleteLater()
    QTest.qWait(20)


def empty(window: Any) -> None:
    """Close what lies over a window, end what goes on in it, and let go of its project. It is not painted
    until it is reset.
    """
    hold_of(window).begin()
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
    begin_again(window)
    window._emptied_to = shell.document.project
    settle(window)
    QCoreApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)


def hold_of(window: Any) -> PaintingHold:
    """Return what keeps a window from painting between two tests, the same each time."""
    found: PaintingHold | None = getattr(window, "_hold_between_tests", None)
    if found is None:
        found = window._hold_between_tests = PaintingHold(window)
    return found


def settle(window: Any) -> None:
    """Wait until nothing goes on; what would be done soon is done now."""
    jobs, deadline = window.shell.jobs, time.monotonic() + SETTLED
    soon = {t: t.interval() for t in window.findChildren(QTimer) if t.isSingleShot() and t.interval() < SOON}

    def waiting() -> list[QTimer]:
        return [t for t in soon if isValid(t) and t.isActive()]

    QTest.qWait(1)
    while (due := waiting()) or jobs.at_work:
        for timer in due:
            timer.start(0)
        QTest.qWait(1 if due else 5)  # to ask jobs often only keeps them from work
        assert time.monotonic() < deadline, f"at work: {[j.title for j in jobs.at_work]}"
    for timer, pause in soon.items():
        if isValid(timer):
            timer.setInterval(pause)


class Stand(NamedTuple):
    """How a window's docks stand, to the bit and the pixel."""

    state: QByteArray
    told: str  # the shares as a text, which is rounded
    workspace: str
    current: str
    tabs: tuple[Tab, ...]
    alone: bool
    size: QSize
    full: bool
    maximal: bool
    shares: dict[str, tuple[float, float]]


def stands(window: Any) -> Stand:
    places, spaces = window.places, window.workspaces
    chosen = (places.workspace.id, spaces.current, tuple(spaces.tabs), places.alone)
    room = (window.size(), window.isFullScreen(), window.isMaximized())
    return Stand(*places.state(), *chosen, *room, dict(places.proportions.shares))


def put_back(window: Any, stood: Stand | None) -> bool:
    """Put the docks back to how they stood; return whether that succeeded. It takes half as long as to
    arrange them as at first.
    """
    if stood is None or window.size() != stood.size:
        return False
    spaces = window.workspaces
    spaces.tabs = [tab for tab in spaces.tabs if not tab.own]
    spaces.current = FIRST.id
    window.places.arrange(ALL, (stood.state, stood.told))
    window.places.proportions.shares = dict(stood.shares)
    spaces.changed.emit()
    return stands(window) == stood


def reset(window: Any, stood: Stand | None = None) -> None:
    """Take a window back to how it begins, on a new project. stood: how its docks stood then; where they still
    do, they are not put there once more, which takes as long as all the rest.
    """
    hold = hold_of(window)
    hold.begin()
    shell = window.shell
    document, services = shell.document, shell.services
    services[Files].closed = ""
    services[Learned].paused = False
    services[Watcher]._timer.setInterval(EVERY)
    services[Watcher].set_on(True)
    shell.actions.allowed = None
    shell.stage.sound.set_muted(False)
    shell.stage.sound._silent = False
    if document.project is getattr(window, "_emptied_to", None) and not document.undo_stack.count():
        document.autosave.begin(document.project)  # in the folders of this test
        document.loaded.emit()
    else:
        begin_again(window)
    shell.files.opened.emit()
    for panel in window.places.panels.values():
        if panel.place == "beside":
            window.places.show(panel.id, False)
    reset_panels(window)
    settle(window)
    if stands(window) != stood and not put_back(window, stood):
        window.workspaces.restore()  # there are no settings: as at first
        window.workspaces.everything()
    shell.notice.clear()
    window.statusBar().clearMessage()
    QSettings().clear()
    window.setFocus()
    window.refresh()
    hold.end()
    QCoreApplication.sendPostedEvents(window, QEvent.Type.UpdateRequest)


def begin_again(window: Any) -> None:
    """Take back what a window's parts share, and begin a new project."""
    shell = window.shell
    session = shell.stage.session
    session.set_mode("meta")
    session.onstage.set_performance(None)
    session.onstage.set_conversation(None)
    session.onstage.set_side(0)
    session.place.set_layer("arms")
    session.place.forget()
    session.selection.clear()
    session.selection.copied = None
    session.look.choose("dark")
    session.watch.forget()
    session.transport.set_playing(True)
    shell.document.load(Project(), None)


def reset_panels(window: Any) -> None:
    """Take back what the panels hold themselves."""
    panel = window.shell.panel
    library, canvas, preview, lanes = (
        panel("library"),
        panel("graph"),
        panel("character"),
        panel("timeline").lanes,
    )
    QSettings().remove("library")
    library.restore()
    library.search.clear()
    library.chips["all"].click()
    library.narrow()
    canvas.focus = None
    if not preview.session.transport.loop:
        preview.toggle_loop()
    preview.looking._stepped_back = False  # else the camera is put back when the next clip plays
    if preview.bones:
        preview.toggle_bones()
    preview.frame_all()
    normal = SPEEDS.index(1.0)
    preview.speed_box.setCurrentIndex(normal)
    preview.speed_box.activated.emit(normal)
    lanes.each, lanes.first, lanes.follow = 44.0, 0.0, True
    for widget in window.findChildren(QWidget):
        if is_ours(type(widget)):
            if widget.hasMouseTracking():
                QCoreApplication.sendEvent(widget, QEvent(QEvent.Type.Leave))
        elif isinstance(widget, QScrollBar):
            widget.setValue(widget.minimum())
