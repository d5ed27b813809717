"""Show the bar on top: the project's name, and what features add at the left, in the middle and at
the right.
"""

from __future__ import annotations

from collections.abc import Iterable
from html import escape

from PySide6.QtCore import QSize, Qt
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QLabel, QSizePolicy, QToolBar, QToolButton, QWidget

from app.look.theme import get_theme
from app.project.document import Document
from app.shell.actions import Actions
from app.shell.context import HeaderItem
from app.stage.session import StageSession
from app.translation import tr

NARROW, WIDE = 100, 1600  # pixels of the project's name, and of a window with room for three times that
SLIM = 1400  # pixels of a window in which the bar's buttons stand closer, so that none of their words is cut


class Header(QToolBar):
    """Shows the document's name and whether it is saved. Its other parts update themselves."""

    def __init__(
        self,
        document: Document,
        session: StageSession,
        actions: Actions,
        items: Iterable[HeaderItem],
        parent: QWidget,
    ) -> None:
        super().__init__(tr("Main"), parent)
        self.document, self.session = document, session
        self.setObjectName("toolbar")
        self.setMovable(False)
        self.setIconSize(QSize(18, 18))
        self.name = QLabel(self)
        self.name.setContentsMargins(6, 0, 12, 0)
        self.name.setTextFormat(Qt.TextFormat.RichText)
        self.addWidget(self.name)
        items = tuple(items)
        for side in ("left", "middle", "right"):
            for item in items:
                if item.side != side:
                    continue
                if isinstance(item.make, str):
                    if item.make in actions:
                        self.addAction(actions[item.make])
                else:
                    self.addWidget(item.make(self))
            if side != "right":
                self.addWidget(_stretch(self))
            if side == "left":
                self.addSeparator()

    def refresh(self) -> None:
        """Show the current name and whether it is saved."""
        d = self.document
        saved = tr("unsaved") if d.path is None else tr("edited") if d.dirty else tr("saved")
        saved = tr("read-only, {saved}", saved=saved) if d.read_only else saved
        dim = get_theme(self.session.look.name).dim
        room = NARROW if self.width() < WIDE else 3 * NARROW
        name = self.name.fontMetrics().elidedText(d.project.name, Qt.TextElideMode.ElideMiddle, room)
        words = f"<b>{escape(name)}</b>&nbsp;&nbsp;<span style='color:{dim}'>{saved}</span>"
        self.name.setToolTip(f"{d.project.name}, {saved}")
        if words != self.name.text():  # rich text is laid out again each time
            self.name.setText(words)

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        if (event.size().width() < WIDE) != (event.oldSize().width() < WIDE):
            self.refresh()
        self._set_slim(event.size().width() < SLIM)

    def _set_slim(self, slim: bool) -> None:
        """Let the buttons stand closer, or as far apart as usual again."""
        if bool(self.property("slim")) != slim:
            self.setProperty("slim", slim)
            for button in self.findChildren(QToolButton):
                button.style().polish(button)
                button.updateGeometry()


def _stretch(parent: QWidget) -> QWidget:
    out = QWidget(parent)
    out.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Preferred)
    return out
