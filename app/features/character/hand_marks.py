"""Marks where contacts keep hands: on the body, or on the other hand. By shape: held, on the way there or
back, or away from where it should be; with a line to the joint it touches, and that joint's name.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QWidget

from app.features.character.foot_marks import draw_mark
from app.features.character.overlay_host import OverlayHost
from app.features.character.plates import draw_plate
from app.look.theme import WindowTheme, get_theme
from app.stage.over_view import lie_over
from app.translation import make_lazy_texts, tr
from metagraph.motion.skeleton import Skeleton
from metagraph.playback.posing.foot_slides import FootState
from metagraph.playback.posing.hand_touches import HandTouch, find_hand_touches, plan_of_clip

HANDS = make_lazy_texts(lambda: (tr("Left hand"), tr("Right hand")))
BESIDE = 20.0  # pixels from a mark to its words


class HandMarks(QWidget):
    """A pane over the view of a preview panel. It passes all mouse events on."""

    def __init__(self, panel: OverlayHost) -> None:
        super().__init__(panel.view)
        self.panel = panel
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self.setAccessibleName(tr("Hand contacts"))
        self.hide()
        panel.view.painted.connect(self._follow)
        panel.session.watch.changed.connect(self.show_or_hide)
        self.show_or_hide()

    def show_or_hide(self) -> None:
        self.setVisible(self.panel.session.watch.now.hands)
        self._follow()

    def _follow(self, *_: object) -> None:
        if not self.isHidden():
            lie_over(self, self.panel.view)

    def touches(self) -> list[HandTouch]:
        """Return what contacts keep the hands of the picture; nothing if none are known."""
        shown, drawn = self.panel.performance.shown, self.panel.drawn
        moved = shown.manual is not None or shown.motion is not None
        if drawn is None or moved or shown.skeleton is None or shown.skeleton != shown.project.skeleton:
            return []
        _, rotations, positions = drawn
        if len(positions) != len(shown.skeleton):
            return []
        plan = plan_of_clip(shown.project, shown.clip) if shown.clip is not None else shown.moving
        seconds = self.panel.session.transport.seconds
        return find_hand_touches(plan, shown.project, seconds, rotations, positions)

    def paintEvent(self, event: QPaintEvent) -> None:
        touches = self.touches()
        skeleton = self.panel.performance.shown.skeleton
        self.setAccessibleDescription(describe_touch(touches, skeleton))
        if not touches or skeleton is None or self.panel.drawn is None:
            return
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        look, taken = get_theme(self.panel.session.look.name), list[QRectF]()
        for touch in touches:
            self._mark(painter, look, touch, skeleton, taken)
        painter.end()

    def _mark(
        self, painter: QPainter, look: WindowTheme, touch: HandTouch, skeleton: Skeleton, taken: list[QRectF]
    ) -> None:
        assert self.panel.drawn is not None
        positions = self.panel.drawn[2]
        knuckles = np.flatnonzero(skeleton.parents == touch.hand)
        hand = self._seen(positions[knuckles].mean(0) if len(knuckles) else positions[touch.hand])
        other = self._seen(positions[touch.to])
        if hand is None or other is None:
            return
        for pen in (QPen(QColor(look.card), 3.0), QPen(QColor(look.text), 1.2, Qt.PenStyle.DotLine)):
            painter.setPen(pen)
            painter.drawLine(hand, other)
        draw_mark(painter, look, hand, FootState.HELD if touch.held else FootState.STEPPING, touch.missed)
        words = describe_plate(touch, skeleton)
        wide = painter.fontMetrics().horizontalAdvance(words) / 2 + BESIDE
        beside = hand + QPointF(wide if hand.x() < self.width() / 2 else -wide, 0.0)
        taken.append(draw_plate(painter, look, beside, words, taken))

    def _seen(self, place: np.ndarray) -> QPointF | None:
        """Return where a place is in the picture, None behind the camera."""
        view = self.panel.view
        x, y = view.camera.project(place, view.width() / max(1, view.height())) * [
            self.width(),
            self.height(),
        ]
        return QPointF(x, y) if np.isfinite((x, y)).all() else None


def describe_plate(touch: HandTouch, skeleton: Skeleton) -> str:
    """Say what a hand touches, and how far it is from there where it should be."""
    joint = skeleton.names[touch.to]
    return f"{joint}  ⚠ {touch.away * 1000:.0f} mm" if touch.missed else joint


def describe_touch(touches: Sequence[HandTouch], skeleton: Skeleton | None) -> str:
    """Say which hands touch what."""
    if skeleton is None or not touches:
        return tr("No hand is in contact")
    return "; ".join(
        tr("{hand} touches {joint}", hand=HANDS[touch.side], joint=describe_plate(touch, skeleton))
        for touch in touches
    )
