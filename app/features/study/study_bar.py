"""The bar above the work: what the task is, how much time is left, and the way to pause, to note something,
to finish.
"""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import (
    QHBoxLayout,
    QLabel,
    QPushButton,
    QSizePolicy,
    QToolBar,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from app.features.study.study_screen import format_markdown, format_minutes
from app.look.theme import get_theme, strengthen
from app.stage.session import StageSession
from app.translation import tr
from app.widgets.making import make_widget

WARNINGS = (120.0, 30.0)  # seconds before the end at which it is said


class StudyBar(QToolBar):
    """Above the window's own bar. Instructions unfold below the title."""

    def __init__(self, session: StageSession, parent: QWidget) -> None:
        super().__init__(tr("Study"), parent)
        self.session = session
        self.setObjectName("study")
        self.setMovable(False)
        inner = QWidget(self)
        column = QVBoxLayout(inner)
        column.setContentsMargins(6, 2, 6, 2)
        column.setSpacing(4)
        row = QHBoxLayout()
        row.setSpacing(8)
        column.addLayout(row)
        self.title = QLabel(inner)
        self.title.setProperty("heading", True)
        self.more = make_widget(QToolButton, inner, text=tr("Instructions"), checkable=True)
        self.more.toggled.connect(self._unfold)
        self.told = QLabel(inner)
        self.time = QLabel(inner)
        self.time.setMinimumWidth(110)
        self.time.setAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
        self.note, self.pause, self.done = (
            QPushButton(text, inner) for text in (tr("Note…"), tr("Pause"), tr("Done"))
        )
        strengthen(self.done)
        self.done.setMinimumWidth(84)
        row.addWidget(self.title)
        row.addWidget(self.more)
        row.addStretch(1)
        for widget in (self.told, self.time, self.note, self.pause, self.done):
            row.addWidget(widget)
        self.text = QLabel(inner)
        self.text.setTextFormat(Qt.TextFormat.RichText)
        self.text.setWordWrap(True)
        self.text.setProperty("dim", True)
        self.text.setMaximumWidth(1100)
        self.text.hide()
        column.addWidget(self.text)
        inner.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Preferred)
        self.addWidget(inner)
        self._left: float | None = None

    def begin(self, title: str, text: str) -> None:
        """Show a task."""
        self.title.setText(title)
        self.text.setText(format_markdown(text, 13))
        self.more.setVisible(bool(text))
        self.more.setChecked(bool(text))
        self._unfold(bool(text))
        self.told.clear()

    def _unfold(self, on: bool) -> None:
        self.text.setVisible(on)

    def show_time(self, elapsed: float, minutes: float | None) -> None:
        """Show seconds so far, or left of the minutes there are; near the end it is said plainly."""
        look = get_theme(self.session.look.name)
        if minutes is None:
            self.time.setText(format_minutes(elapsed))
            self.time.setStyleSheet("")
            return
        left = 60 * minutes - elapsed
        near = left <= WARNINGS[0]
        self.time.setText(tr("{clock} left", clock=format_minutes(left)))
        self.time.setStyleSheet(f"color: {look.warning}; font-weight: 600" if near else "")
        self.told.setStyleSheet(f"color: {look.warning}")
        self.told.setText(
            tr("Half a minute left") if left <= WARNINGS[1] else tr("Two minutes left") if near else ""
        )
