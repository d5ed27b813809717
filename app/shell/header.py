"""Show the bar on top: the project's name, and what features add at the left, in the middle and at
the right.
"""

from __future__ import annotations

from collections.abc import Iterable
from html import escape

from PySide6.QtCore import QEvent, QSize, Qt
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QLabel, QSizePolicy, QToolBar, QToolButton, QWidget

from app.look.theme import get_theme
from app.project.document import Document
from app.shell.actions import Actions
from app.shell.context import HeaderItem
from app.stage.session import StageSession
from app.translation import tr

NARROW, WIDE = 100, 1600  # pixels of the project's name, and of a window with room for three times that
UNSAVED = "•"  # for the words that say so, where they have no room
LEVELS = 4  # of giving way: a dot for "unsaved"; closer buttons; closer ones and fewer words; no name


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
        self._name_action = self.addWidget(self.name)
        self._level, self._wider, self._fitting = 0, 0, False
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
        self.name.setToolTip(f"{d.project.name}, {saved}")
        if self._level:
            saved = "" if d.path is not None and not d.dirty else UNSAVED
        words = f"<b>{escape(name)}</b>&nbsp;&nbsp;<span style='color:{dim}'>{saved}</span>"
        if words != self.name.text():  # rich text is laid out again each time
            self.name.setText(words)

    # --- room

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        if (event.size().width() < WIDE) != (event.oldSize().width() < WIDE):
            self.refresh()
        self._fit()

    def event(self, event: QEvent) -> bool:
        if event.type() == QEvent.Type.LayoutRequest:
            self._fit()
        return super().event(event)

    def _fit(self) -> None:
        """Let parts give way until all have room: words for "unsaved" first, the project's name
        last, which the window's title has too. Without this, the last buttons would be hidden.
        """
        if self._fitting:
            return
        if self._measure() <= self.width() and (self._level == 0 or self.width() < self._wider):
            return
        self._fitting, self._wider = True, 0
        for level in range(LEVELS + 1):
            self._give_way(level)
            needed = self._measure()
            if needed <= self.width() or level == LEVELS:
                break
            self._wider = needed
        self._fitting = False

    def _measure(self) -> int:
        """Return the width that all parts need."""
        bar, margins = self.layout(), self.contentsMargins()
        assert bar is not None
        frame = bar.contentsMargins()
        out = margins.left() + margins.right() + frame.left() + frame.right()
        for action in self.actions():
            part = self.widgetForAction(action)
            if part is not None and action.isVisible():
                inner = part.layout()
                if inner is not None:
                    inner.activate()
                out += max(0, part.sizeHint().width()) + bar.spacing()
        return out

    def _give_way(self, level: int) -> None:
        if level == self._level:
            return
        self._level = level
        self.setProperty("slim", str(min(level - 1, 2)) if level > 1 else "")
        style = Qt.ToolButtonStyle
        for button in self.findChildren(QToolButton):
            if button.property("gives_way"):
                button.setToolButtonStyle(
                    style.ToolButtonIconOnly if level > 2 else style.ToolButtonTextBesideIcon
                )
            button.style().polish(button)
            button.updateGeometry()
        self._name_action.setVisible(level < LEVELS)
        self.refresh()


def _stretch(parent: QWidget) -> QWidget:
    out = QWidget(parent)
    out.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Preferred)
    return out
