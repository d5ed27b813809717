"""The clip under review on the character, out of its stance and back, with what it is taken for written over
it.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from PySide6.QtCore import QElapsedTimer, QRectF, QSize, Qt, QTimer, Signal
from PySide6.QtGui import (
    QColor,
    QHideEvent,
    QMouseEvent,
    QPainter,
    QPaintEvent,
    QPen,
    QResizeEvent,
    QTextDocument,
)
from PySide6.QtWidgets import QLabel, QSizePolicy, QVBoxLayout, QWidget

from app.features.labelling.proposal_preview import Span
from app.look.theme import get_theme
from app.stage.figures import Figures
from app.stage.gl_view import make_view
from app.stage.playback_source import ShownPlayback
from app.stage.session import StageSession
from app.translation import tr
from preview.camera import make_whole_figure_camera
from preview.figure import MeshFigure
from preview.scene import THEMES, Actor, Scene

FRAME = 16  # milliseconds between frames
STRAYS = 0.2  # of its height that a figure goes before the camera goes along
ABOVE = 0.16  # of the figure's height that is left free above it


class ReviewStrip(QWidget):
    """What plays, from left to right, and where it is now; press to go there. sought: seconds."""

    sought = Signal(float)

    def __init__(self, session: StageSession, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.session = session
        self.length, self.seconds = 1.0, 0.0
        self.span: Span | None = None
        self.setAccessibleName(tr("Playhead"))
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)

    def sizeHint(self) -> QSize:
        return QSize(300, 30)

    def paintEvent(self, event: QPaintEvent) -> None:
        look = get_theme(self.session.look.name)
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        box = QRectF(self.rect()).adjusted(0, 2, 0, -2)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(QColor(look.field))
        painter.drawRoundedRect(box, 4, 4)

        def at(seconds: float) -> float:
            return float(box.left() + box.width() * min(1.0, max(0.0, seconds / max(1e-6, self.length))))

        if self.span is not None:
            ground = look.fill(self.span.kind)
            ground.setAlpha(80)
            middle = QRectF(
                at(self.span.start), box.top(), at(self.span.end) - at(self.span.start), box.height()
            )
            painter.setBrush(ground)
            painter.drawRoundedRect(middle, 4, 4)
            left, right = QRectF(box), QRectF(box)
            left.setRight(middle.left())
            right.setLeft(middle.right())
            for part, words, color in zip(
                (left, middle, right), self.span.words, (look.dim, look.text, look.dim), strict=True
            ):
                painter.setPen(QColor(color))
                inner = part.adjusted(8, 0, -6, 0)
                shown = painter.fontMetrics().elidedText(
                    words, Qt.TextElideMode.ElideRight, max(0, round(inner.width()))
                )
                if inner.width() > 18:
                    painter.drawText(inner, Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignLeft, shown)
            if self.span.stroke is not None:
                painter.setPen(QPen(QColor(look.text), 1, Qt.PenStyle.DotLine))
                painter.drawLine(
                    round(at(self.span.stroke)),
                    round(box.top()),
                    round(at(self.span.stroke)),
                    round(box.bottom()),
                )
        painter.setPen(QPen(QColor(look.text), 2))
        x = at(self.seconds)
        painter.drawLine(round(x), 0, round(x), self.height())
        painter.end()

    def mousePressEvent(self, event: QMouseEvent) -> None:
        self.sought.emit(min(1.0, max(0.0, event.position().x() / max(1, self.width()))) * self.length)

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        self.mousePressEvent(event)


class ReviewStage(QWidget):
    """Plays what it is given, round and round, until it is given something else. played: it came round."""

    played = Signal()

    def __init__(self, session: StageSession, figures: Figures, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.session, self.figures = session, figures
        self.shown: ShownPlayback | None = None
        self.seconds, self.playing = 0.0, True
        self._framed: object = None
        self._stood, self._tall = np.zeros(2), 1.0  # where the framed figure stands, and how high it is
        self.view = make_view(self._scene, self)
        self.view.setMinimumSize(320, 240)
        self.view.setFocusPolicy(Qt.FocusPolicy.NoFocus)  # the keys are the review's
        self.view.frame_wanted.connect(self._frame_again)
        self.strip = ReviewStrip(session, self)
        self.strip.sought.connect(self._sought)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(self.view, 1)
        layout.addWidget(self.strip)
        self.words = QLabel(self.view)
        self.words.setTextFormat(Qt.TextFormat.RichText)
        self.words.setWordWrap(True)
        self.words.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self.words.move(12, 12)
        self._clock = QElapsedTimer()
        self._clock.start()
        self._timer = QTimer(self, interval=FRAME)
        self._timer.setTimerType(Qt.TimerType.PreciseTimer)
        self._timer.timeout.connect(self._tick)
        self._timer.start()
        figures.changed.connect(self.view.update)
        session.look.changed.connect(self._restyle)
        self._restyle()

    def _restyle(self) -> None:
        look = get_theme(self.session.look.name)
        ground = QColor(look.panel)
        self.words.setStyleSheet(
            f"background: rgba({ground.red()}, {ground.green()}, {ground.blue()}, 215); border-radius: 6px; "
            "padding: 8px 12px;"
        )
        self.view.theme = THEMES[look.name]
        self.view.update()

    def tell(self, words: str) -> None:
        """Write rich text over the picture."""
        self.words.setText(words)
        before = self._share_above()
        self._place_words()
        if self._share_above() > before + 0.02 and not self.view.moved_by_hand:
            self._framed = None  # the words reach further down

    def _place_words(self) -> None:
        ideal = QTextDocument()
        ideal.setDefaultFont(self.words.font())
        ideal.setHtml(self.words.text())
        wide = round(min(ideal.idealWidth() + 28, max(160, min(460, self.view.width() - 24))))
        ideal.setTextWidth(wide - 24)
        self.words.setFixedSize(wide, round(ideal.size().height()) + 10)

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self._place_words()

    def hideEvent(self, event: QHideEvent) -> None:
        self._timer.stop()

    # --- playing

    def play(self, shown: ShownPlayback | None, span: Span | None, keep: bool = False) -> None:
        """Play something else, from its beginning, or where it is (keep) when the same was planned
        otherwise.
        """
        self.shown = shown
        self.strip.span = span
        self.strip.length = shown.length if shown is not None else 1.0
        if not keep:
            self.seconds, self.playing = 0.0, True
        self._seek(self.seconds)

    def toggle(self) -> None:
        self.playing = not self.playing

    def replay(self) -> None:
        self.playing = True
        self._seek(0.0)

    def step(self, seconds: float) -> None:
        """Pause, and go on or back by a moment."""
        self._sought(self.seconds + seconds)

    def _sought(self, seconds: float) -> None:
        self.playing = False
        self._seek(seconds)

    def _seek(self, seconds: float) -> None:
        self.seconds = min(max(0.0, seconds), self.strip.length)
        self.strip.seconds = self.seconds
        self.strip.update()
        self.view.update()

    def _tick(self) -> None:
        elapsed = min(0.25, self._clock.restart() / 1000)
        if self.playing and self.shown is not None and self.isVisible():
            length = max(1e-3, self.shown.length)
            now = self.seconds + elapsed * self.session.transport.speed
            self._seek(now % length)
            if now >= length:
                self.played.emit()

    # --- drawing

    def _scene(self) -> Scene:
        pose = self.shown.pose(self.seconds) if self.shown is not None else None
        skeleton = self.shown.skeleton if self.shown is not None else None
        figure = self.figures.figure(skeleton) if skeleton is not None else None
        if pose is None or skeleton is None or figure is None or self.shown is None:
            return Scene()
        rotations, positions = skeleton.globals(pose)
        if self._framed is not figure and not self.view.moved_by_hand:
            self._framed = figure
            self._frame(figure, rotations, positions)
        elif not self.view.moved_by_hand:
            self._follow(positions[0, [0, 2]])
        morphs = figure.morph_weights(self.shown.morphs(self.seconds)) if figure.morphs else None
        return Scene((Actor(figure, rotations, positions, morphs, {}, False),))

    def _frame(self, figure: MeshFigure, rotations: np.ndarray, positions: np.ndarray) -> None:
        aspect = self.view.width() / max(1, self.view.height())
        low, high = figure.posed_bounds(rotations, positions)
        # What is written over the picture hides no face.
        room = np.array([0.0, self._share_above() * (high[1] - low[1]), 0.0])
        self.view.camera = make_whole_figure_camera((low, high + room), aspect)

        self._stood, self._tall = positions[0, [0, 2]], float(high[1] - low[1])

    def _share_above(self) -> float:
        """Return how much of a figure's height has to stay free above it, for the words."""
        covered = min(0.45, (self.words.height() + 12) / max(1, self.view.height()))
        return max(ABOVE, covered / (1 - covered))

    def _follow(self, stands: np.ndarray) -> None:
        """Let a figure that walks off stay in the picture. stands `[2]`: x and z of its root."""
        away = stands - self._stood
        far = float(np.linalg.norm(away))
        if np.isfinite(far) and far > STRAYS * self._tall:
            shift = away * (1 - STRAYS * self._tall / far)
            self._stood = self._stood + shift
            x, y, z = self.view.camera.target
            self.view.camera = replace(self.view.camera, target=(x + float(shift[0]), y, z + float(shift[1])))

    def _frame_again(self) -> None:
        self.view.moved_by_hand = False
        self._framed = None
        self.view.update()
