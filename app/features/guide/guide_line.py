"""The line that leads to a first character, over the status bar, and the frame round what it speaks of."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from PySide6.QtCore import QRectF, Qt, QTimer, Signal
from PySide6.QtGui import QColor, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QHBoxLayout, QLabel, QPushButton, QToolBar, QToolButton, QWidget

from app.features.guide.guide_steps import STEPS, WORDS, Seen, find_step
from app.look.theme import get_theme, strengthen
from app.project.document import Document
from app.stage.session import StageSession
from app.translation import tr
from app.widgets.making import make_widget

LOOKED = 250  # milliseconds between looks at what is played and where the panels are
WIDTH = 3  # pixels of the frame
GAP = 4  # pixels between the frame's outside and what it surrounds


class Highlight(QWidget):
    """A frame round a part of the window, through which everything can be done as before."""

    def __init__(self, session: StageSession, window: QWidget) -> None:
        super().__init__(window)
        self.session = session
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self.setAttribute(Qt.WidgetAttribute.WA_NoSystemBackground)
        self.setAccessibleName(tr("Look here"))
        self.hide()

    def surround(self, part: QWidget | None) -> None:
        """Lie round a part of the window; with None, or while it is not seen, round nothing."""
        window = self.parentWidget()
        if part is None or window is None or not part.isVisible():
            self.hide()
            return
        place = part.rect().translated(part.mapTo(window, part.rect().topLeft()))
        place = place.adjusted(-GAP, -GAP, GAP, GAP).intersected(window.rect())
        if place != self.geometry():
            self.setGeometry(place)
        self.show()
        self.raise_()

    def paintEvent(self, event: QPaintEvent) -> None:
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(QPen(QColor(get_theme(self.session.look.name).strong), WIDTH))
        half = WIDTH / 2
        painter.drawRoundedRect(QRectF(self.rect()).adjusted(half, half, -half, -half), 6, 6)
        painter.end()


class GuideLine(QToolBar):
    """Shows the step to do next, and goes on by itself when it is done. `left` is emitted when it is over.

    find: returns the part of the window that a panel's id names, "" for the export. take_samples: brings the
    sample's clips. `turned` has the panel of each new step.
    """

    left = Signal()
    turned = Signal(str)

    def __init__(
        self,
        document: Document,
        session: StageSession,
        find: Callable[[str], QWidget | None],
        take_samples: Callable[[], object],
        window: QWidget,
    ) -> None:
        super().__init__(tr("First character"), window)
        self.document, self.session, self._find = document, session, find
        self.setObjectName("guide line")
        self.setMovable(False)
        self.toggleViewAction().setVisible(False)
        self.seen, self.step, self._skipped = Seen(document.project), 0, 0
        self.frame = Highlight(session, window)
        held = QWidget(self)
        row = QHBoxLayout(held)
        row.setContentsMargins(8, 4, 2, 4)
        row.setSpacing(8)
        self.number = QLabel(held)
        self.number.setProperty("dim", True)
        self.words = QLabel(held, wordWrap=True)
        self.take = QPushButton(tr("Use three sample clips"), held)
        strengthen(self.take)
        self.take.clicked.connect(take_samples)
        self.skip = QPushButton(tr("Skip"), held)
        self.skip.setToolTip(tr("Go to the next step"))
        self.skip.clicked.connect(self.skip_step)
        self.close_button = make_widget(QToolButton, held, text="✕", toolTip=tr("Leave the guide"))
        self.close_button.setAccessibleName(tr("Leave the guide"))
        self.close_button.clicked.connect(self.leave)
        row.addWidget(self.number)
        row.addWidget(self.words, 1)
        for button in (self.take, self.skip, self.close_button):
            row.addWidget(button)
        self.addWidget(held)
        self._timer = QTimer(self, interval=LOOKED)
        self._timer.timeout.connect(self._look)
        document.changed.connect(self._changed)
        self.hide()

    def begin(self) -> None:
        """Begin with the first step that is still to be done."""
        self.seen, self._skipped = Seen(self.document.project), 0
        self._timer.start()
        self.show()
        self._go_on()

    def leave(self) -> None:
        """Hide the line and the frame."""
        self._timer.stop()
        self.frame.hide()
        self.hide()
        self.left.emit()

    def skip_step(self) -> None:
        """Go to the step after this one; after the last, leave."""
        if self.step >= len(STEPS):
            self.leave()
            return
        self._skipped = self.step + 1
        self._go_on()

    def notice_export(self) -> None:
        """Files for an engine were written."""
        self.seen = replace(self.seen, exported=True)
        self._go_on()

    def _changed(self, *_: object) -> None:
        if self._timer.isActive():
            self.seen = replace(self.seen, project=self.document.project)
            self._go_on()

    def _look(self) -> None:
        """Count what is watched, and keep the frame where its panel is."""
        transport = self.session.transport
        watching = self.step < len(STEPS) and STEPS[self.step].ident == "watch"
        if watching and transport.playing and transport.show == "plan":
            self.seen = replace(self.seen, watched=self.seen.watched + LOOKED / 1000)
        self._go_on()

    def _go_on(self) -> None:
        """Show the first step that is not done; the last words after all of them."""
        self.step = find_step(self.seen, self._skipped)
        self._skipped = max(self._skipped, self.step)  # a step that was done is not asked for again
        over = self.step == len(STEPS)
        ident = "end" if over else STEPS[self.step].ident
        if self.words.text() != WORDS[ident]:
            self.words.setText(WORDS[ident])
            self.number.setText("" if over else f"{self.step + 1}/{len(STEPS)}")
            self.take.setVisible(ident == "clips")
            self.skip.setText(tr("Close") if over else tr("Skip"))
            if ident == "watch":
                self.session.transport.show_plan()
                self.session.transport.set_playing(True)
            if not over and STEPS[self.step].panel:
                self.turned.emit(STEPS[self.step].panel)
        if self.isVisible():
            self.frame.surround(None if over else self._find(STEPS[self.step].panel))
