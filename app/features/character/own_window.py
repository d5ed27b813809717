"""The character in a window of its own: for a second screen, and for programs that record windows."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Literal, get_args

from PySide6.QtCore import QByteArray, QEvent, QSettings, Qt, Signal
from PySide6.QtGui import QCloseEvent, QContextMenuEvent, QGuiApplication, QKeyEvent
from PySide6.QtWidgets import QMenu, QVBoxLayout, QWidget

from app.features.character.overlay_host import OverlayHost
from app.stage.gl_view import make_beside
from app.translation import make_lazy_texts, tr
from app.widgets.within_screen import resize_within_screen
from preview.scene import Scene

Background = Literal["as shown", "transparent", "green"]
BACKGROUNDS: tuple[Background, ...] = get_args(Background)
TITLES = make_lazy_texts(
    lambda: {
        "as shown": tr("As in the panel"),
        "transparent": tr("Transparent"),
        "green": tr("Green, for chroma key"),
    }
)
FILLS: dict[Background, tuple[float, float, float, float] | None] = {
    "as shown": None,
    "transparent": (0.0, 0.0, 0.0, 0.0),
    "green": (0.0, 0.69, 0.25, 1.0),  # the usual green of screens, sRGB
}
_PLACE, _FILL, _TOP = "own window/place", "own window/background", "own window/on top"


class OwnWindow(QWidget):
    """Shows what the panel shows, from its camera, until the mouse moves this window's own camera; a double
    click goes back to the panel's. Ghosts and marks for editing are not shown.

    `closed` is emitted when it closes. compose: makes the scene when the panel is not drawn itself.
    """

    closed = Signal()

    def __init__(self, panel: OverlayHost, compose: Callable[[], Scene], parent: QWidget) -> None:
        super().__init__(parent, Qt.WindowType.Window)
        self.panel, self._compose = panel, compose
        self.setWindowTitle(tr("Character - Metagraph"))
        self.setAccessibleName(tr("Character in its own window"))
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setAttribute(Qt.WidgetAttribute.WA_TranslucentBackground)
        self.setAttribute(Qt.WidgetAttribute.WA_NoSystemBackground)
        self.background: Background = "as shown"
        self.view = make_beside(panel.view, self._scene, self)
        self.view.setAccessibleName(tr("Character"))
        self.view.frame_wanted.connect(self.follow_panel)
        room = QVBoxLayout(self)
        room.setContentsMargins(0, 0, 0, 0)
        room.addWidget(self.view)
        panel.view.painted.connect(self._follow)
        panel.session.transport.moved.connect(self._follow)
        panel.session.look.changed.connect(self._follow)
        panel.session.watch.changed.connect(self._follow)
        resize_within_screen(self, 720, 900)
        self._restore()

    def _restore(self) -> None:
        """Be as the last time."""
        kept = QSettings()
        place = kept.value(_PLACE)
        if isinstance(place, QByteArray):
            self.restoreGeometry(place)
        fill = str(kept.value(_FILL, "as shown"))
        self.show_background(next((b for b in BACKGROUNDS if b == fill), "as shown"))
        if str(kept.value(_TOP, "")) == "true":
            self.setWindowFlag(Qt.WindowType.WindowStaysOnTopHint)

    # --- what is drawn

    def _scene(self) -> Scene:
        """Return what the panel has drawn, or would draw, without what is there for editing."""
        panel, view = self.panel, self.view
        scene = panel.composed if panel.view.isVisible() else self._compose()
        if not view.moved_by_hand:
            view.camera = panel.view.camera
        view.theme = panel.view.theme
        actors = tuple(
            replace(actor, marks={}, bones=False) if actor.marks or actor.bones else actor
            for actor in scene.actors
            if actor.opacity >= 1
        )
        fill = FILLS[self.background]
        picture = scene.picture if fill is None else None
        return replace(scene, actors=actors, background=fill or scene.background, picture=picture)

    def _follow(self, *_: object) -> None:
        if self.isVisible():
            self.view.update()

    def follow_panel(self) -> None:
        """Look from the panel's camera again."""
        self.view.moved_by_hand = False
        self.view.update()

    # --- what the user chooses

    def contextMenuEvent(self, event: QContextMenuEvent) -> None:
        menu = self.make_menu()
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        menu.popup(event.globalPos())

    def make_menu(self) -> QMenu:
        """Return the menu of the right mouse button."""
        menu = QMenu(self)
        fills = menu.addMenu(tr("Background"))
        for background in BACKGROUNDS:
            action = fills.addAction(TITLES[background], partial(self.show_background, background))
            action.setCheckable(True)
            action.setChecked(background == self.background)
        screens = menu.addMenu(tr("Full screen on"))
        for number, screen in enumerate(QGuiApplication.screens(), 1):
            size = screen.size()
            words = tr(
                "{number}: {width} × {height}", number=number, width=size.width(), height=size.height()
            )
            screens.addAction(words, partial(self.fill_screen, number - 1))
        menu.addAction(tr("Leave full screen"), self.showNormal).setEnabled(self.isFullScreen())
        menu.addSeparator()
        action = menu.addAction(tr("Frame as in the panel"), self.follow_panel)
        action.setEnabled(self.view.moved_by_hand)
        action = menu.addAction(tr("Stay on top"), lambda: self.stay_on_top(not self.stays_on_top()))
        action.setCheckable(True)
        action.setChecked(self.stays_on_top())
        menu.addSeparator()
        menu.addAction(tr("Close"), self.close)
        return menu

    def show_background(self, background: Background) -> None:
        """Draw another background, now and the next time. A transparent window has no frame."""
        self.background = background
        QSettings().setValue(_FILL, background)
        bare = background == "transparent"
        if bare != bool(self.windowFlags() & Qt.WindowType.FramelessWindowHint):
            self._change_flag(Qt.WindowType.FramelessWindowHint, bare)
        self.view.update()

    def fill_screen(self, number: int) -> None:
        """Fill a screen, by its place among all."""
        self.setGeometry(QGuiApplication.screens()[number].geometry())
        self.showFullScreen()

    def stays_on_top(self) -> bool:
        """Return whether other windows do not cover it."""
        return bool(self.windowFlags() & Qt.WindowType.WindowStaysOnTopHint)

    def stay_on_top(self, on: bool) -> None:
        """Stay above other windows, now and the next time."""
        QSettings().setValue(_TOP, "true" if on else "false")
        self._change_flag(Qt.WindowType.WindowStaysOnTopHint, on)

    def _change_flag(self, flag: Qt.WindowType, on: bool) -> None:
        shown, place = self.isVisible(), self.geometry()
        self.setWindowFlag(flag, on)  # this hides a window
        if shown:
            self.setGeometry(place)
            self.show()

    def event(self, event: QEvent) -> bool:
        """Keep its keys from the commands of the main window."""
        own = (Qt.Key.Key_Escape, Qt.Key.Key_Space)
        if (
            event.type() == QEvent.Type.ShortcutOverride
            and isinstance(event, QKeyEvent)
            and event.key() in own
        ):
            event.accept()
            return True
        return super().event(event)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        if event.key() == Qt.Key.Key_Escape and self.isFullScreen():
            self.showNormal()
        elif event.key() == Qt.Key.Key_Escape:
            self.close()
        elif event.key() == Qt.Key.Key_Space:
            transport = self.panel.session.transport
            transport.set_playing(not transport.playing)
        else:
            super().keyPressEvent(event)

    def closeEvent(self, event: QCloseEvent) -> None:
        QSettings().setValue(_PLACE, self.saveGeometry())
        self.closed.emit()
        super().closeEvent(event)
