"""The real window on a virtual screen, driven by real mouse and key events."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from PySide6.QtCore import QMimeData, QPoint, QPointF, QSettings, Qt, QUrl
from PySide6.QtGui import (
    QCursor,
    QDragEnterEvent,
    QDragLeaveEvent,
    QDragMoveEvent,
    QDropEvent,
    QGuiApplication,
)
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QMenu, QMessageBox, QWidget
from shiboken6 import isValid

from app.main import prepare_application
from tests.app.handles import Handles
from tests.app.shared_window import SharedWindow, close, settle
from tests.run_notes import NOTES

# Off Linux windows are driven unseen: what needs a real pointer or OpenGL is left out there, and nothing else.
if not sys.platform.startswith("linux"):
    os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")
UNSEEN = os.environ.get("QT_QPA_PLATFORM") == "offscreen"


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """A warning from Qt fails a test here, as an exception in a slot does."""
    here = f"{Path(__file__).parent}{os.sep}"
    for item in items:
        if str(item.path).startswith(here):
            item.add_marker(pytest.mark.qt_log_level_fail("WARNING"))
            # Xvfb has no transparent windows for dragged pictures, and unseen there is little of a screen.
            quiet = ("root_visual", "This plugin does not support") if UNSEEN else ("root_visual",)
            item.add_marker(pytest.mark.qt_log_ignore(*quiet))


PASSED = pytest.StashKey[bool]()


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item: pytest.Item, call: pytest.CallInfo[None]) -> Iterator[None]:
    report = yield
    if call.when == "call":
        item.stash[PASSED] = report.passed or report.skipped
    return report


def wants_own_window(item: pytest.Item) -> bool:
    """Journeys, and what is marked as looking at how a window begins or ends."""
    return "journey" in item.path.stem or item.get_closest_marker("fresh_window") is not None


@pytest.hookimpl(trylast=True)
def pytest_runtest_teardown(item: pytest.Item, nextitem: pytest.Item | None) -> None:
    """Hide the shared window from tests that have none, or their own."""
    if "drive" in getattr(item, "fixturenames", ()) and "drive" not in getattr(nextitem, "fixturenames", ()):
        SHARED.hide()


SHARED = SharedWindow()


@pytest.fixture(scope="session")
def shared(qapp: object, request: pytest.FixtureRequest) -> Iterator[SharedWindow]:
    yield SHARED
    SHARED.throw_away()
    request.config.stash[NOTES]["windows"] = SHARED.words()


@pytest.fixture(scope="session")
def qapp() -> object:
    """The application as the program makes it: OpenGL format and shared contexts set before."""
    from app.features.character import character_panel
    from app.features.labelling import review_stage
    from app.stage import gl_view

    # Characters are drawn in software here: at a screen's rate that leaves little time for anything else.
    character_panel.FRAME = character_panel.SOFT_FRAME = review_stage.FRAME = 80
    gl_view.ImageView.coarse = 3
    app = prepare_application()
    yield app


@pytest.fixture(scope="session", autouse=True)
def settings_place(tmp_path_factory: pytest.TempPathFactory) -> None:
    """A window that many tests take turns with keeps to one place of settings."""
    place = str(tmp_path_factory.mktemp("settings"))
    QSettings.setDefaultFormat(QSettings.Format.IniFormat)
    QSettings.setPath(QSettings.Format.IniFormat, QSettings.Scope.UserScope, place)


@pytest.fixture(autouse=True)
def own_settings(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Nothing of the user's settings is read or written, and nothing of another test's."""
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path / "data"))
    monkeypatch.setenv("METAGRAPH_DATA", str(tmp_path / "data" / "Metagraph" / "Metagraph"))
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path / "config"))
    # Not XDG_CACHE_HOME: there Mesa keeps its shaders.
    monkeypatch.setattr("app.stage.kept_pictures.find_pictures_folder", lambda: tmp_path / "cache")
    QSettings().clear()
    QSettings(QSettings.defaultFormat(), QSettings.Scope.UserScope, "Metagraph", "Metagraph").clear()


class Driver(Handles):
    """The window and a hand. Points are given as (widget, point in it)."""

    def __init__(self, window: object, qtbot: object) -> None:
        super().__init__(window)
        self.bot = qtbot
        self.told: list[str] = []
        self._words = (self.shell.stage.refused, self.shell.document.failed)
        for words in self._words:
            words.connect(self.told.append)

    def let_go(self) -> None:
        """The test is over."""
        if not isValid(self.window):  # another took its place
            return
        for words in self._words:
            words.disconnect(self.told.append)

    def wait(self, until: Callable[[], bool], seconds: float = 20) -> None:
        try:
            self.bot.waitUntil(until, timeout=int(seconds * 1000))  # type: ignore[attr-defined]
        except Exception as error:
            error.add_note(f"the window said: {self.told}")
            raise

    def pause(self, milliseconds: int) -> None:
        self.bot.wait(milliseconds)  # type: ignore[attr-defined]

    def settle(self) -> None:
        """Wait until all that a change brings with it is done."""
        settle(self.window)

    # --- where things are

    def card(self, clip: str) -> tuple[QWidget, QPoint]:
        """The library card of a clip, by name; scrolled into sight."""
        from app.features.library.clip_rows import ENTRY

        view, proxy = self.library.list, self.library.rows  # type: ignore[attr-defined]
        for row in range(proxy.rowCount()):
            index = proxy.index(row, 0)
            if index.data(ENTRY).name == clip:
                view.scrollTo(index)
                self.pause(30)
                seen = view.visualRect(index).intersected(view.viewport().rect())
                return view.viewport(), seen.center()
        raise AssertionError(f"no card of clip {clip!r} is in sight")

    def node(self, kind: str) -> tuple[QWidget, QPoint]:
        rect = self.canvas.layout_now().nodes[kind].rect  # type: ignore[attr-defined]
        return self.canvas, rect.center().toPoint()  # type: ignore[attr-defined]

    def middle(self) -> tuple[QWidget, QPoint]:
        """The upper part of the stance card: a new stance."""
        card = self.canvas.layout_now().card  # type: ignore[attr-defined]
        return self.canvas, QPoint(round(card.center().x()), round(card.top() + card.height() * 0.25))  # type: ignore[attr-defined]

    def row(self, action: str) -> tuple[QWidget, QPoint]:
        rect = self.canvas.layout_now().row(action).rect  # type: ignore[attr-defined]
        return self.canvas, QPoint(round(rect.left() + 30), round(rect.center().y()))  # type: ignore[attr-defined]

    # --- the hand

    def click(
        self, place: tuple[QWidget, QPoint], modifier: Qt.KeyboardModifier = Qt.KeyboardModifier.NoModifier
    ) -> None:
        widget, point = place
        QTest.mouseClick(widget, Qt.MouseButton.LeftButton, modifier, point)

    def drag(
        self, start: tuple[QWidget, QPoint], end: tuple[QWidget, QPoint], until: Callable[[], bool]
    ) -> None:
        """A true drag through the X server, from press to release, until something has come of it."""
        if not real_pointer():
            pytest.skip("a real drag needs X11 and xdotool")
        a, b = start[0].mapToGlobal(start[1]), end[0].mapToGlobal(end[1])
        words = [
            "xdotool",
            "mousemove",
            str(a.x()),
            str(a.y()),
            "sleep",
            ".08",
            "mousedown",
            "1",
            "sleep",
            ".08",
        ]
        for n in range(1, 9):
            x, y = a.x() + (b.x() - a.x()) * n / 8, a.y() + (b.y() - a.y()) * n / 8
            words += ["mousemove", str(round(x)), str(round(y)), "sleep", ".04"]
        process = subprocess.Popen([*words, "sleep", ".12", "mouseup", "1"])
        try:
            self.wait(until, 15)
        finally:
            deadline = time.monotonic() + 10
            while process.poll() is None and time.monotonic() < deadline:
                self.pause(20)
            process.wait(5)

    def key(
        self,
        key: Qt.Key,
        modifier: Qt.KeyboardModifier = Qt.KeyboardModifier.NoModifier,
        widget: QWidget | None = None,
    ) -> None:
        QTest.keyClick(widget or self.window, key, modifier)  # type: ignore[call-overload]

    def bar(self, action: str, part: float) -> tuple[QWidget, QPoint]:
        """A place on an action's likelihood bar, 0 at its left, 1 at its right."""
        rect = self.canvas.layout_now().row(action).bar  # type: ignore[attr-defined]
        return self.canvas, QPoint(round(rect.left() + part * rect.width()), round(rect.center().y()))  # type: ignore[attr-defined]

    def chip(self, stance: str) -> tuple[QWidget, QPoint]:
        rect = next(c.rect for c in self.canvas.layout_now().chips if c.stance == stance)  # type: ignore[attr-defined]
        return self.canvas, rect.center().toPoint()  # type: ignore[attr-defined]

    def drop_files(self, place: tuple[QWidget, QPoint], *paths: Path) -> bool:
        """Drop files as a file manager would; return whether the drop was taken."""
        widget, point = place
        while not widget.acceptDrops() and not widget.isWindow():  # as Qt looks for who takes it
            point, widget = widget.mapToParent(point), widget.parentWidget()
        data = QMimeData()
        data.setUrls([QUrl.fromLocalFile(str(p)) for p in paths])
        more = Qt.DropAction.CopyAction, data, Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier
        for event in (
            QDragEnterEvent(point, *more),
            QDragMoveEvent(point, *more),
            QDropEvent(QPointF(point), *more),
        ):
            QApplication.sendEvent(widget, event)
            if not event.isAccepted():
                QApplication.sendEvent(widget, QDragLeaveEvent())
                return False
        return True

    def pick(self, menu: QMenu, *texts: str) -> None:
        """Choose an entry of a menu by its words, through its submenus."""
        for text in texts:
            action = next(
                (a for a in menu.actions() if a.text().replace("&", "").split("\t")[0] == text), None
            )
            assert action is not None, f"no {text!r} among {[a.text() for a in menu.actions()]}"
            assert action.isEnabled(), text
            if action.menu() is None:
                action.trigger()
            else:
                menu = action.menu()

    def names(self, kind: str | None = None, layer: str | None = None) -> list[str]:
        """Names of the actions in the graph."""
        found = self.document.project.actions()  # type: ignore[attr-defined]
        return [a.name for a in found if kind in (None, a.kind) and layer in (None, a.layer)]


def real_pointer() -> bool:
    """Return whether a real pointer can be moved: on X11, by xdotool."""
    return QGuiApplication.platformName() == "xcb" and shutil.which("xdotool") is not None


def activate(window: QWidget) -> None:
    """Give a window the keyboard: on X11 without a window manager, a click does."""
    corner = window.statusBar().mapToGlobal(QPoint(300, 8))
    if window.isActiveWindow():
        QCursor.setPos(corner)  # nothing is hovered over
        return
    window.activateWindow()
    if real_pointer():
        subprocess.run(
            ["xdotool", "mousemove", str(corner.x()), str(corner.y()), "click", "1"], check=True, timeout=10
        )
    assert QTest.qWaitForWindowActive(window, 5000)


@pytest.fixture
def drive(
    qapp: object,
    qtbot: object,
    monkeypatch: pytest.MonkeyPatch,
    request: pytest.FixtureRequest,
    shared: SharedWindow,
) -> Iterator[Driver]:
    """A window with nothing in it. It is one that many tests take turns with, but in journeys and in tests
    marked `fresh_window`. Its clips have pictures in those only: the process that draws them costs more than
    most tests.
    """
    import app.shell.window
    from app.look.theme import WindowTheme, apply_theme, make_style_sheet
    from app.main import make_window
    from app.stage.thumbnails import Thumbnails

    def styled(app: QApplication, look: WindowTheme) -> None:
        """The application outlives each window here: the same style again would only polish every widget
        again.
        """
        if app.styleSheet() != make_style_sheet(look):
            apply_theme(app, look)

    def unexpected(*args: object, **kwargs: object) -> object:
        raise AssertionError(f"an unexpected question: {args[1:3]}")

    monkeypatch.setattr(app.shell.window, "apply_theme", styled)
    monkeypatch.setattr(QMessageBox, "question", unexpected)
    monkeypatch.setattr(QMessageBox, "warning", unexpected)
    own = wants_own_window(request.node)
    if own:
        shared.hide()
        shared.own += 1
        window = make_window()
        window.resize(1680, 1020)
        window.show()
        window.make_late_panels()
    else:
        monkeypatch.setattr(Thumbnails, "_order", lambda *order: None)
        window = shared.take()
    qtbot.waitExposed(window)  # type: ignore[attr-defined]
    activate(window)
    driver = Driver(window, qtbot)
    yield driver
    driver.let_go()
    if own:
        if isValid(window):
            close(window)
    else:
        shared.give_back(whole=request.node.stash.get(PASSED, False))


@pytest.fixture
def toys(drive, toy):
    """A window on the toy project."""
    drive.document.load(toy.project(), None)
    drive.files.opened.emit()
    drive.wait(lambda: drive.performance.skeleton() is not None)
    drive.id = lambda name: toy.id(drive.document.project, name)
    drive.action = lambda name: drive.document.project.action(drive.id(name))
    return drive
