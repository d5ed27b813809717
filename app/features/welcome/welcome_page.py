"""The page over an empty graph: a few ways to start, each with a picture and a description."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

from PySide6.QtCore import QEvent, QObject, QPoint, QRectF, QSize, Qt, QTimer
from PySide6.QtGui import QColor, QFont, QFontMetricsF, QPainter, QPaintEvent, QPen, QPixmap, QResizeEvent
from PySide6.QtWidgets import (
    QAbstractButton,
    QBoxLayout,
    QGridLayout,
    QHBoxLayout,
    QLabel,
    QMenu,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from app.features.welcome.welcome_pictures import PICTURES
from app.look.theme import get_theme
from app.project.document import Document
from app.project.files import Files
from app.stage.session import StageSession
from app.translation import tr
from app.widgets.making import make_widget
from app.widgets.memo import Once

LEAST = QSize(400, 270)  # pixels of a room in which all of it is whole
CARD = QSize(188, 92)  # at least
LARGEST = QSize(400, 250)
LEAST_PICTURE = 44  # pixels; with less room, a card has its words alone
RECENT = 3  # projects that a card names


@dataclass(frozen=True)
class WelcomeChoice:
    """A way to begin. id: of its picture too. what: what it is for."""

    id: str
    title: str
    what: str
    run: Callable[[], object]


class WelcomeCard(QAbstractButton):
    """A picture over a title and what it is for. beside: cards of the page; titles keep to a line."""

    def __init__(self, choice: WelcomeChoice, session: StageSession, parent: QWidget) -> None:
        super().__init__(parent)
        self.choice, self.session = choice, session
        self.beside: Sequence[WelcomeCard] = (self,)
        self._drawn: Once[QPixmap] = Once()
        self.setText(choice.title)
        self.setAccessibleName(choice.title)
        self.setAccessibleDescription(choice.what)
        self.setToolTip(choice.what)
        self.setCursor(Qt.CursorShape.PointingHandCursor)
        self.setMinimumSize(CARD)
        self.setMaximumSize(LARGEST)
        self.setAttribute(Qt.WidgetAttribute.WA_Hover)
        self.clicked.connect(choice.run)

    def tell(self, what: str, enabled: bool) -> None:
        """Say what it is for now."""
        self.setToolTip(what)
        self.setAccessibleDescription(what)
        self.setEnabled(enabled)
        self.update()

    def sizeHint(self) -> QSize:
        return QSize(290, 170)

    def measure_words(self) -> tuple[float, float]:
        """Return the heights of the title and of what it is for."""
        words, flags = QRectF(self.rect()).adjusted(14, 0, -14, 0), Qt.TextFlag.TextWordWrap
        measure = QFontMetricsF(self._bold()).boundingRect, QFontMetricsF(self.font()).boundingRect
        title, what = (
            m(words, flags, x) for m, x in zip(measure, (self.text(), self.toolTip()), strict=True)
        )
        return title.height(), what.height()

    def _bold(self) -> QFont:
        out = QFont(self.font())
        out.setWeight(QFont.Weight.DemiBold)
        return out

    def paintEvent(self, event: QPaintEvent) -> None:
        t, painter = get_theme(self.session.look.name), QPainter(self)
        words = QRectF(self.rect()).adjusted(14, 0, -14, 0)
        flags = Qt.AlignmentFlag.AlignTop | Qt.TextFlag.TextWordWrap
        title = self.measure_words()[0]
        tallest = max(sum(card.measure_words()) for card in self.beside)
        top = self.height() - 12 - tallest - 3
        painter.drawPixmap(0, 0, self._picture_above(top))
        if top < LEAST_PICTURE:
            top = (self.height() - tallest - 3) / 2
        painter.setPen(QColor(t.text if self.isEnabled() else t.dim))
        painter.setFont(self._bold())
        painter.drawText(words.adjusted(0, top, 0, 0), flags, self.text())
        painter.setFont(self.font())
        painter.setPen(QColor(t.dim))
        painter.drawText(words.adjusted(0, top + title + 3, 0, 0), flags, self.toolTip())
        painter.end()

    def _picture_above(self, top: float) -> QPixmap:
        """Return the card without its words, which begin at `top`. It takes as long to draw as a panel, so it
        is drawn when it changes.
        """
        lit = self.isEnabled() and (self.underMouse() or self.hasFocus())
        look, size, ratio = self.session.look.name, self.size(), self.devicePixelRatioF()
        state = (top, look, lit, self.hasFocus(), self.isEnabled(), size.toTuple(), ratio)

        def draw() -> QPixmap:
            t, out = get_theme(look), QPixmap(size * ratio)
            out.setDevicePixelRatio(ratio)
            out.fill(Qt.GlobalColor.transparent)
            painter = QPainter(out)
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            painter.setPen(QPen(QColor(t.text if self.hasFocus() else t.line), 1.2))
            painter.setBrush(QColor(t.hover if lit else t.card))
            painter.drawRoundedRect(QRectF(self.rect()).adjusted(1, 1, -1, -1), 8, 8)
            if top >= LEAST_PICTURE:
                painter.setOpacity(1.0 if self.isEnabled() else 0.45)
                PICTURES[self.choice.id](painter, t, QRectF(14, 10, self.width() - 28, top - 16))
            painter.end()
            return out

        return self._drawn.of(state, (), draw)


class WelcomePage(QWidget):
    """Lies over a room as long as nothing is in the project and nothing was done; closed by hand it stays so
    until another project is begun. `rooms` returns where it may lie, the best first. `guide` leads to a first
    character.
    """

    def __init__(
        self,
        choices: Sequence[WelcomeChoice],
        files: Files,
        session: StageSession,
        document: Document,
        rooms: Callable[[], Sequence[QWidget]],
        guide: Callable[[], object],
    ) -> None:
        super().__init__(rooms()[0])
        self.files, self.session, self.document, self.rooms = files, session, document, rooms
        self._watched: set[QWidget] = set()
        self._soon = QTimer(self, singleShot=True, interval=0)  # once the panels have their places
        self._soon.timeout.connect(self.follow)
        self.follow_soon = self._soon.start
        self.closed = False
        self.setAutoFillBackground(True)
        self.setAccessibleName(tr("Start"))
        title = QLabel(tr("How would you like to start?"), self)
        title.setProperty("heading", True)
        title.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self.recent = WelcomeCard(
            WelcomeChoice("recent", tr("Recent"), "", self._choose_recent), session, self
        )
        self.cards = [*(WelcomeCard(c, session, self) for c in choices), self.recent]
        for card in self.cards:
            card.beside = self.cards
        self.skip = make_widget(
            QToolButton, self, text=tr("Start with an empty graph"), toolTip=tr("Close this page")
        )
        self.skip.clicked.connect(self._close)
        self.guide = make_widget(
            QToolButton,
            self,
            text=tr("First character in two minutes"),
            toolTip=tr("A guide through importing, labelling, watching and exporting"),
        )
        self.guide.clicked.connect(guide)
        grid = QGridLayout()
        grid.setSpacing(12)
        for n, card in enumerate(self.cards):
            grid.addWidget(card, n // 2, n % 2)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(20, 12, 20, 10)
        layout.addStretch(1)
        layout.addWidget(title)
        layout.addSpacing(8)
        middle = QHBoxLayout()
        middle.addStretch(1)
        middle.addLayout(grid, 100)
        middle.addStretch(1)
        layout.addLayout(middle, 8)
        layout.addSpacing(4)
        self._below = QBoxLayout(QBoxLayout.Direction.LeftToRight)
        self._below.addStretch(1)
        for button in (self.guide, self.skip):
            self._below.addWidget(button, 0, Qt.AlignmentFlag.AlignHCenter)
        self._below.addStretch(1)
        layout.addLayout(self._below)
        layout.addStretch(1)
        document.loaded.connect(self._again)
        document.changed.connect(lambda *_: self.follow())
        document.state_changed.connect(self.follow)
        session.look.changed.connect(self.update)
        session.onstage.mode_changed.connect(self.follow)
        self._again()

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Put the buttons under each other where a line has no room for both."""
        super().resizeEvent(event)
        needed = self.guide.sizeHint().width() + self.skip.sizeHint().width() + 46
        directions = QBoxLayout.Direction
        self._below.setDirection(
            directions.LeftToRight if needed <= event.size().width() else directions.TopToBottom
        )

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if event.type() in (QEvent.Type.Resize, QEvent.Type.Show):
            self.follow()
        return False

    def _again(self) -> None:
        self.closed = False
        self._tell_recent()  # a page that is there already may speak of what is no more
        self.follow()

    def _close(self) -> None:
        self.closed = True
        self.follow()

    def follow(self) -> None:
        """Be there while there is nothing else, and room for it."""
        document = self.document
        empty = not document.project.clips and document.path is None and not document.undo_stack.count()
        fits = empty and not self.closed and self.session.onstage.mode == "meta"
        room = self._room() if fits else None
        shown = room is not None
        if room is not None:
            if self.parent() is not room:
                self.setParent(room)
            self.setGeometry(room.rect())
            if self.isHidden():
                self._tell_recent()
            self.raise_()
        focus = self.focusWidget() if not shown else None
        if focus is not None and focus.hasFocus():  # Qt would give it to the next field, which takes the keys
            self.window().setFocus()
        self.setVisible(shown)

    def _room(self) -> QWidget | None:
        """Return the first room that is seen and large enough."""
        rooms = self.rooms()
        for room in rooms:
            if room not in self._watched:
                self._watched.add(room)
                room.installEventFilter(self)
        large = (r for r in rooms if r.width() >= LEAST.width() and r.height() >= LEAST.height())
        return next((room for room in large if room.isVisible()), None)

    def _tell_recent(self) -> None:
        names = [path.name.split(".")[0] for path in self.files.recent()[:RECENT]]
        self.recent.tell(
            tr("Continue with {names}", names=", ".join(names))
            if names
            else tr("Your saved projects appear here"),
            bool(names),
        )

    def _choose_recent(self) -> None:
        recent = self.files.recent()
        if len(recent) == 1:
            self.files.open(recent[0])
            return
        menu = QMenu(self)
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        for path in recent:
            menu.addAction(f"{path.name.split('.')[0]}   {path.parent}", partial(self.files.open, path))
        menu.popup(self.recent.mapToGlobal(QPoint(0, self.recent.height())))
