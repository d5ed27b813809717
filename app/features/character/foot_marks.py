"""Draw marks of the feet over the character. A shape shows whether a foot is planted, steps or is lifted; a
planted foot that slides has its speed beside it. A line below shows the seconds around now, and the time of
the worst slide.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from PySide6.QtCore import QPointF, QRectF, Qt, QTimer
from PySide6.QtGui import QColor, QFont, QPainter, QPaintEvent, QPen, QPolygonF
from PySide6.QtWidgets import QWidget

from app.features.character.overlay_host import OverlayHost
from app.features.character.plates import draw_plate
from app.look.theme import WindowTheme, get_theme
from app.stage.over_view import lie_over
from app.translation import make_lazy_texts, tr, tr_noop
from metagraph.playback.posing.foot_slides import (
    RATE,
    SLIDES,
    FeetSeen,
    FeetWatch,
    FootState,
    find_worst_slide,
)

SPAN = 1.5  # seconds before and after now that the line reports
AT_ONCE = 12  # poses that are composed in one event: the window stays free
HIGH = 42  # pixels of the line
SIDES = make_lazy_texts(lambda: (tr("Left foot"), tr("Right foot")))
BELOW = 12.0  # pixels from a foot to its mark
SIZE = 7.0  # pixels of half a mark
LEGEND = tr_noop(
    "Thick: the foot is planted. Thin: it steps. Dots: it is in the air. Thicker and "
    "yellow: it is planted but slides, at {speed:g} mm/s or more."
)


class FootMarks(QWidget):
    """A pane over the view of a preview panel. It passes all mouse events on."""

    def __init__(self, panel: OverlayHost) -> None:
        super().__init__(panel.view)
        self.panel = panel
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self._of: Any = None  # whose feet are watched
        self.watch: FeetWatch | None = None
        self.line = FootLine(panel)
        panel.put_below_view(self.line)
        self._more = QTimer(self, singleShot=True, interval=0)
        self._more.timeout.connect(self.update)
        self.hide()
        panel.view.painted.connect(self._follow)
        panel.performance.changed.connect(self._forget)
        panel.performance.document.changed.connect(self._forget)
        panel.session.watch.changed.connect(self.show_or_hide)
        self.show_or_hide()

    def _forget(self, *_: object) -> None:
        self._of = self.watch = None

    def show_or_hide(self) -> None:
        on = self.panel.session.watch.now.feet
        self.setVisible(on)
        self.line.setVisible(on and not self.panel.bare)
        self._follow()

    def _follow(self, *_: object) -> None:
        if not self.isHidden():
            lie_over(self, self.panel.view)

    def watching(self) -> FeetWatch | None:
        """Return the watcher of the feet on screen, or None if the character has no feet."""
        shown = self.panel.performance.shown
        if shown is not self._of:
            self._of, self.watch = shown, watch_of(shown)
        return self.watch

    def seen(self, most: int | None = AT_ONCE) -> FeetSeen | None:
        """Return what is known about the feet around now, or None while nothing is known. most: poses
        composed for it.
        """
        watch = self.watching()
        if watch is None:
            return None
        shown, now = self.panel.performance.shown, round(self.panel.session.transport.seconds * RATE)
        last = int(shown.length * RATE)
        around = range(max(0, now - int(SPAN * RATE)), max(1, min(last, now + int(SPAN * RATE)) + 1))
        near = range(min(max(now, around.start), around.stop - 1), min(now + 1, around.stop))
        near = near if len(near) else range(around.stop - 1, around.stop)
        if not watch.look(near, most):
            self._more.start()
            return None
        if not watch.look(around, most):
            self._more.start()
            return watch.at(near)
        return watch.at(around)

    def paintEvent(self, event: QPaintEvent) -> None:
        seen = self.seen()
        self.line.show_feet(seen)
        if seen is None or not len(seen.times):
            return
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        n = int(np.abs(seen.times - self.panel.session.transport.seconds).argmin())
        self._feet(painter, get_theme(self.panel.session.look.name), seen, n)
        painter.end()

    def _feet(self, painter: QPainter, look: WindowTheme, seen: FeetSeen, n: int) -> None:
        view = self.panel.view
        watch, drawn = self.watch, self.panel.drawn
        if watch is None or drawn is None:
            return
        for side, joints in enumerate(watch.feet):
            if max(joints) >= len(drawn[2]):
                return
            at = drawn[2][joints].mean(0)
            at = np.array([at[0], 0.0, at[2]])  # on the ground
            x, y = view.camera.project(at, view.width() / max(1, view.height())) * [
                self.width(),
                self.height(),
            ]
            if not np.isfinite((x, y)).all():
                continue
            place, slides = QPointF(x, y + BELOW), bool(seen.sliding()[n, side])
            draw_mark(painter, look, place, FootState(int(seen.states[n, side])), slides)
            if slides:
                words = f"{seen.slides[n, side] * 1000:.0f} mm/s"
                beside = QPointF(x + (-1 if x < self.width() / 2 else 1) * 46, y + BELOW)
                draw_plate(painter, look, beside, words)


class FootLine(QWidget):
    """A line below the view with a row for each foot (now is in the middle), and a text about the worst
    slide.
    """

    def __init__(self, panel: OverlayHost) -> None:
        super().__init__(panel.view)
        self.panel = panel
        self._known: FeetSeen | None = None
        self.setFixedHeight(HIGH)
        self.setAccessibleName(tr("Feet"))
        self.setToolTip(tr(LEGEND, speed=SLIDES * 1000))
        self.hide()

    def show_feet(self, seen: FeetSeen | None) -> None:
        """Show what is known about the feet around now. None: nothing is known."""
        if seen is not None and len(seen.times) > 1:  # until it is known again, what was stands
            self._known = seen
            self.setAccessibleDescription(describe_slide(seen))
        self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        look, seen = get_theme(self.panel.session.look.name), self._known
        painter = QPainter(self)
        painter.fillRect(self.rect(), QColor(look.panel))
        room = QRectF(self.rect()).adjusted(12, 2, -12, -2)
        lane = room.adjusted(18, 0, 0, -16)
        now = self.panel.session.transport.seconds
        wide = lane.width() / (2 * SPAN)
        painter.setClipRect(room)
        usual = painter.font()
        small = QFont(usual)
        small.setPixelSize(9)
        painter.setFont(small)
        for side in range(2):
            y = lane.top() + 6 + 10 * side
            painter.setPen(QColor(look.text))
            painter.drawText(QRectF(room.left(), y - 7, 14, 14), Qt.AlignmentFlag.AlignCenter, "LR"[side])
            for first, end, state, slides in find_foot_states(seen, side) if seen is not None else ():
                a = max(lane.left(), lane.center().x() + (first - now) * wide)
                b = lane.center().x() + (end - now) * wide
                high = 8.0 if slides else 4.0 if state == FootState.HELD else 1.0
                color = QColor(look.warning if slides else look.text)
                if state == FootState.LIFTED:  # nothing but dots
                    painter.setPen(QPen(QColor(look.dim), 1.0, Qt.PenStyle.DotLine))
                    painter.drawLine(QPointF(a, y), QPointF(b, y))
                elif b > a:
                    painter.fillRect(QRectF(a, y - high / 2, b - a, high), color)
        painter.setFont(usual)
        painter.setPen(QPen(QColor(look.text), 1.0))
        painter.drawLine(QPointF(lane.center().x(), lane.top()), QPointF(lane.center().x(), lane.bottom()))
        row = QRectF(room.left(), room.bottom() - 16, room.width(), 16)
        words = describe_slide(seen) if seen is not None else ""
        painter.drawText(row, Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignLeft, words)
        painter.end()


def find_foot_states(seen: FeetSeen, side: int) -> list[tuple[float, float, int, bool]]:
    """Return, for one foot, the start and end of each state, the state, and whether the foot slides."""
    key = seen.states[:, side] * 2 + seen.sliding()[:, side]
    edges = np.flatnonzero(np.diff(key)) + 1
    starts, ends = [0, *edges.tolist()], [*edges.tolist(), len(key)]
    half = 0.5 / RATE
    return [
        (seen.times[a] - half, seen.times[b - 1] + half, int(seen.states[a, side]), bool(key[a] % 2))
        for a, b in zip(starts, ends, strict=True)
    ]


def describe_slide(seen: FeetSeen) -> str:
    """Return which foot slides fastest around now and when, or that none slides."""
    worst = find_worst_slide(seen)
    if worst is None:
        return tr("No planted foot slides") if len(seen.times) > 1 else ""
    time, side, speed = worst
    return tr(
        "⚠ {foot} slides {speed:.0f} mm/s at {minutes}:{seconds:05.2f}",
        foot=SIDES[side],
        speed=speed * 1000,
        minutes=int(time // 60),
        seconds=time % 60,
    )


def watch_of(shown: Any) -> FeetWatch | None:
    """Return the watcher of the feet on screen, or None if the character does not have two feet."""
    skeleton = shown.skeleton
    if skeleton is None or skeleton != shown.project.skeleton:
        return None

    def places(times: np.ndarray) -> np.ndarray:
        return np.asarray(skeleton.globals(shown.pose(times))[1])

    motion = shown.project.clips[shown.clip].motion if shown.clip is not None else None
    by_plan = shown.clip is None and shown.manual is None and shown.motion is None
    watch = FeetWatch(shown.project, places, shown.length, shown.moving if by_plan else None, motion)
    return watch if watch.feet else None


def draw_mark(painter: QPainter, look: WindowTheme, at: QPointF, state: FootState, slides: bool) -> None:
    """Draw a foot's mark: a filled square that is held, an empty diamond that steps, an empty circle that is
    lifted, a filled triangle that slides.
    """
    ink, rim, s = QColor(look.warning if slides else look.text), QColor(look.card), SIZE
    shapes = {
        FootState.HELD: [(-s, -s * 0.6), (s, -s * 0.6), (s, s * 0.6), (-s, s * 0.6)],
        FootState.STEPPING: [(0, -s), (s, 0), (0, s), (-s, 0)],
    }
    points = [(0, -s * 1.3), (s * 1.2, s * 0.8), (-s * 1.2, s * 0.8)] if slides else shapes.get(state)
    filled = slides or state == FootState.HELD
    for pen in (QPen(rim, 4.0), QPen(ink, 1.8)):
        painter.setPen(pen)
        painter.setBrush(ink if filled else Qt.BrushStyle.NoBrush)
        if points is None:
            painter.drawEllipse(at, s, s * 0.8)
        else:
            painter.drawPolygon(QPolygonF([at + QPointF(x, y) for x, y in points]))
