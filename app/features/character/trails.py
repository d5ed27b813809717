"""Draw trails of hands and head over the character: where they were and will be within 1.5 s, live where they
were. They show arcs, spacing and pops at a glance. While two states of an action are compared, both have
trails.
"""

from __future__ import annotations

import numpy as np
from PySide6.QtCore import QPointF, Qt
from PySide6.QtGui import QColor, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QWidget

from app.features.character.overlay_host import OverlayHost
from app.look.theme import get_theme
from app.stage.over_view import lie_over
from app.stage.playback_source import ShownPlayback
from metagraph.graph import anatomy

RATE = 30  # samples a second: dots are as far apart as frames, so what is quick has gaps
SPAN = 1.5  # seconds before and after now
ROLES = (
    ("left_hand", "transition"),
    ("right_hand", "gesture"),
    ("head", "stance"),
)  # and whose colour each has
KEPT = 600  # samples


class TrailSamples:
    """Keeps where hands and head of one playback are, at `RATE` samples a second."""

    def __init__(self) -> None:
        self._of: ShownPlayback | None = None
        self._samples: dict[int, np.ndarray] = {}  # number of the sample -> places `[roles, 3]`

    def forget(self, *_: object) -> None:
        self._of = None
        self._samples.clear()

    def places(self, shown: ShownPlayback, seconds: float) -> tuple[np.ndarray, np.ndarray, list[str]]:
        """Return times `[N]` within `SPAN` of `seconds`, places `[N, R, 3]` and roles, of the roles that the
        character has.
        """
        nothing: tuple[np.ndarray, np.ndarray, list[str]] = (np.zeros(0), np.zeros((0, 0, 3)), [])
        skeleton = shown.skeleton
        if skeleton is None or skeleton != shown.project.skeleton:
            return nothing
        roles = anatomy.project_roles(shown.project)
        known = [role for role, _ in ROLES if role in roles]
        now, last, span = round(seconds * RATE), int(shown.length * RATE), int(SPAN * RATE)
        live = shown.over is not None
        was_live = self._of is not None and self._of.over is not None
        goes_on = live and was_live and now >= max(self._samples, default=0)
        if (shown is not self._of and not goes_on) or len(self._samples) > KEPT:
            self.forget()
        self._of = shown
        if live:  # only the past is known, and stays: one new pose a picture, not one for each point
            wanted = sorted(n for n in {*self._samples, now} if now - span <= n <= now)
        else:
            wanted = list(range(max(0, now - span), min(last, now + span) + 1))
        missing = [n for n in wanted if n not in self._samples]
        if missing and known:
            pose = shown.pose(np.array(missing) / RATE)
            if pose is None:
                return nothing
            rotations, places = skeleton.globals(pose)
            if shown.stand is not None:
                rotations, places = shown.stand.placed(rotations, places)
            joints = [roles[role] for role in known]
            self._samples.update(zip(missing, places[:, joints], strict=True))
        if not known or not len(wanted):
            return nothing
        return np.array(wanted) / RATE, np.array([self._samples[n] for n in wanted]), known


class Trails(QWidget):
    """A pane over the view of a preview panel. It passes all mouse events on. `on`: the user wants trails."""

    def __init__(self, panel: OverlayHost) -> None:
        super().__init__(panel.view)
        self.panel = panel
        self.on = False
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self._samples, self._beside = TrailSamples(), TrailSamples()
        self.hide()
        panel.view.painted.connect(self._follow)
        panel.performance.changed.connect(self._changed)
        panel.performance.document.changed.connect(self._forget)

    def _changed(self) -> None:
        if self.panel.performance.shown.over is None:
            self._forget()
        self.show_or_hide(self.on)

    def _forget(self, *_: object) -> None:
        self._samples.forget()
        self._beside.forget()

    def show_or_hide(self, on: bool) -> None:
        """Show trails if they are wanted, or if two states are compared."""
        self.on = on
        self.setVisible(on or self.panel.performance.shown.beside is not None)
        self._follow()

    def _follow(self, *_: object) -> None:
        if self.isVisible():
            lie_over(self, self.panel.view)

    def places(self) -> tuple[np.ndarray, np.ndarray, list[str]]:
        """Return times `[N]`, places `[N, R, 3]` and roles of what plays."""
        return self._samples.places(self.panel.performance.shown, self.panel.session.transport.seconds)

    def paintEvent(self, event: QPaintEvent) -> None:
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        self._paint(painter, *self.places(), Qt.PenStyle.SolidLine)
        beside = self.panel.performance.shown.beside
        if beside is not None:
            seconds = self.panel.session.transport.seconds
            self._paint(painter, *self._beside.places(beside, seconds), Qt.PenStyle.DotLine)
        painter.end()

    def _paint(
        self, painter: QPainter, times: np.ndarray, places: np.ndarray, known: list[str], style: Qt.PenStyle
    ) -> None:
        """Paint a trail for each role: dots as far apart as frames, on a line."""
        if len(times) < 2:
            return
        look, view = get_theme(self.panel.session.look.name), self.panel.view
        seen = view.camera.project(places, view.width() / max(1, view.height()))
        seen = seen * [self.width(), self.height()]
        now = self.panel.session.transport.seconds
        kinds = dict(ROLES)
        for n, role in enumerate(known):
            color = QColor(look.fill(kinds[role]))
            for k in range(len(times) - 1):
                a, b = seen[k, n], seen[k + 1, n]
                if not (np.isfinite(a).all() and np.isfinite(b).all()):
                    continue
                away = abs(times[k] - now) / SPAN
                color.setAlphaF(max(0.08, (1 - away) * (0.9 if times[k] < now else 0.5)))
                painter.setPen(QPen(color, 2.0, style, Qt.PenCapStyle.RoundCap))
                painter.drawLine(QPointF(*a), QPointF(*b))
                if style == Qt.PenStyle.SolidLine:
                    painter.setPen(QPen(color, 5.0, c=Qt.PenCapStyle.RoundCap))
                    painter.drawPoint(QPointF(*a))
