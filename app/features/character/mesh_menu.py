"""The meshes of the character behind a button in the view: an eye for each, one click to hide or show it."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from PySide6.QtCore import Qt
from PySide6.QtGui import QKeyEvent, QMouseEvent
from PySide6.QtWidgets import QMenu

from app.translation import tr
from app.widgets.more_button import MoreButton
from metagraph.graph import edits

if TYPE_CHECKING:
    from app.features.character.character_panel import PreviewPanel

MOST = 24  # meshes in the menu; those of a character with more are in the dialog


class StayingMenu(QMenu):
    """Stays open while things in it are ticked, by mouse and keyboard: several are hidden in one go."""

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        action = self.actionAt(event.position().toPoint())
        if action is not None and action.isCheckable() and action.isEnabled():
            action.trigger()
            event.accept()
        else:
            super().mouseReleaseEvent(event)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        action = self.activeAction()
        ticks = event.key() in (Qt.Key.Key_Space, Qt.Key.Key_Return, Qt.Key.Key_Enter)
        if ticks and action is not None and action.isCheckable() and action.isEnabled():
            action.trigger()
        else:
            super().keyPressEvent(event)


class MeshButton(MoreButton):
    """In a view's upper right corner; hidden where the character has only one mesh. dialog: shows
    the list in a window of its own.
    """

    def __init__(self, panel: PreviewPanel, dialog: Callable[[], object]) -> None:
        super().__init__(
            panel.session.look, tr("Meshes"), tr("Hide and show meshes of the character"), panel.view, "mesh"
        )
        self.panel, self._dialog = panel, dialog
        self.setProperty("over", True)
        self.menu_of = StayingMenu(self)
        self.setMenu(self.menu_of)
        self.menu_of.aboutToShow.connect(self._fill)
        panel.view.painted.connect(self._follow)
        self.hide()

    def _meshes(self) -> tuple[str, ...]:
        drawn = self.panel.drawn
        return (
            drawn[0].meshes if drawn is not None and self.panel.performance.document.project.character else ()
        )

    def _follow(self, *_: object) -> None:
        shown = len(self._meshes()) > 1 and not self.panel.bare
        if shown == self.isHidden():
            self.setVisible(shown)
        place = self.panel.watch_button.geometry()
        self.move(place.left() - self.width() - 4, place.top())

    def _fill(self) -> None:
        document, menu = self.panel.performance.document, self.menu_of
        menu.clear()
        for mesh in self._meshes()[:MOST]:
            action = menu.addAction(mesh.replace("&", "&&"))
            action.setCheckable(True)
            action.setChecked(mesh not in document.project.hidden)
            action.toggled.connect(lambda on, m=mesh: self._show(m, on))
        menu.addSeparator()
        every = menu.addAction(tr("Show all"))
        every.setEnabled(bool(document.project.hidden))
        every.triggered.connect(
            lambda: document.edit(tr("Show all meshes"), lambda p: edits.hide_meshes(p, ()))
        )
        menu.addAction(tr("Open the list…")).triggered.connect(self._dialog)

    def _show(self, mesh: str, on: bool) -> None:
        document = self.panel.performance.document
        hidden = [other for other in document.project.hidden if other != mesh]
        words = tr("Show '{mesh}'", mesh=mesh) if on else tr("Hide '{mesh}'", mesh=mesh)
        document.edit(words, lambda p: edits.hide_meshes(p, hidden if on else [*hidden, mesh]))
