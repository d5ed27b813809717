"""Somebody who moves as the model would by now, beside somebody who moved in a take, or as a piece does: by
the points that are measured, painted.
"""

from __future__ import annotations

import time
from collections.abc import Sequence

import numpy as np
from PySide6.QtCore import QPointF, QRectF, QSize, Qt, QTimer
from PySide6.QtGui import QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QWidget

from app.translation import tr
from metagraph.generation.landmarks import LANDMARKS, place_landmarks
from metagraph.generation.poses import PoseRig
from metagraph.generation.takes import Take

RATE = 5.0  # frames a second of what a training shows
SECONDS = 12.0  # of a take that are shown
YAW = np.radians(28)  # seen a little from the side
_LINES = (
    *(("sternum", "left_shoulder"), ("sternum", "right_shoulder"), ("sternum", "head"), ("head", "nose")),
    *(("left_shoulder", "left_elbow"), ("left_elbow", "left_wrist")),
    *(("right_shoulder", "right_elbow"), ("right_elbow", "right_wrist")),
)
LINES = tuple((LANDMARKS.index(a), LANDMARKS.index(b)) for a, b in _LINES)


class FigurePreview(QWidget):
    """Figures beside each other that move again and again, each over its words. empty: words if nobody moves.
    rate: of landmarks, a second.
    """

    def __init__(
        self, words: Sequence[str], empty: str, rate: float = RATE, parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self.words, self.empty, self.rate = tuple(words), empty, rate
        self.moves: list[np.ndarray | None] = [None] * len(self.words)  # landmarks [n, 9, 3], metres
        self._timer = QTimer(self, interval=40)
        self._timer.timeout.connect(self.update)
        self.setMinimumSize(120 * len(self.words), 130)

    def sizeHint(self) -> QSize:
        return QSize(210 * len(self.words), 190)

    def show_moves(self, n: int, landmarks: np.ndarray | None) -> None:
        """Show figure n move; None: it is gone. landmarks: `[n, 9, 3]`, metres."""
        self.moves[n] = landmarks
        self._timer.start() if any(m is not None for m in self.moves) else self._timer.stop()
        self.update()

    def still(self) -> None:
        self._timer.stop()

    def paintEvent(self, event: QPaintEvent) -> None:
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        dim, part = self.palette().placeholderText().color(), self.width() / len(self.words)
        if all(m is None for m in self.moves):
            painter.setPen(dim)
            middle = Qt.AlignmentFlag.AlignCenter | Qt.TextFlag.TextWordWrap
            painter.drawText(QRectF(self.rect()), middle, self.empty)
        for n, (words, points) in enumerate(zip(self.words, self.moves, strict=True)):
            box = QRectF(n * part, 0, part, self.height())
            if points is not None and len(points):
                painter.setPen(dim)
                painter.drawText(box, Qt.AlignmentFlag.AlignHCenter | Qt.AlignmentFlag.AlignBottom, words)
                self._figure(painter, box.adjusted(6, 4, -6, -22), points)
        painter.end()

    def _figure(self, painter: QPainter, box: QRectF, points: np.ndarray) -> None:
        place = (time.monotonic() * self.rate) % max(1, len(points) - 1)
        low = min(int(place), len(points) - 1)
        high = min(low + 1, len(points) - 1)
        now = points[low] + (points[high] - points[low]) * (place - low)
        across = np.cos(YAW) * now[:, 0] + np.sin(YAW) * now[:, 2]
        # Both are drawn as large as an upper body is.
        reach = float(np.ptp(points[..., 1])) or 1.0
        middle = float(np.mean(np.cos(YAW) * points[..., 0] + np.sin(YAW) * points[..., 2]))
        scale = min(box.height() / reach, box.width() / max(1e-6, 1.6 * reach))
        floor = float(points[..., 1].min())
        places = [
            QPointF(box.center().x() + scale * (x - middle), box.bottom() - scale * (y - floor))
            for x, y in zip(across, now[:, 1], strict=True)
        ]
        pen = QPen(self.palette().text().color(), 3, Qt.PenStyle.SolidLine, Qt.PenCapStyle.RoundCap)
        painter.setPen(pen)
        for a, b in LINES:
            painter.drawLine(places[a], places[b])
        head, nose = places[LANDMARKS.index("head")], places[LANDMARKS.index("nose")]
        painter.drawEllipse(head + (nose - head) / 3, 0.09 * scale, 0.11 * scale)


class SamplePreview(FigurePreview):
    """The take on the left, the model on the right; words alone before there is anything."""

    def __init__(self, parent: QWidget | None = None) -> None:
        empty = tr("During training, a take plays here beside the model's motion for the same speech.")
        super().__init__((tr("as recorded"), tr("model so far")), empty, RATE, parent)
        self.setAccessibleName(tr("A take beside the motion of the model so far"))

    def begin(self, rig: PoseRig, takes: Sequence[Take]) -> None:
        """Show a take: where in one most is said oneself."""
        if not takes:
            return
        take = max(takes, key=lambda t: float(t.activity[:, 0].sum()))
        own = np.cumsum(take.activity[:, 0])
        size = min(len(own) - 1, round(SECONDS * 25))
        first = int(np.argmax(own[size:] - own[: len(own) - size])) if size > 0 else 0
        self.moves[1] = None
        self.show_moves(0, place_landmarks(rig, take.poses[first : first + size + 1 : 5]))

    def show_sample(self, landmarks: Sequence[Sequence[Sequence[float]]]) -> None:
        """Show what the model does by now. landmarks: `[n, 9, 3]`, metres, RATE a second."""
        points = np.asarray(landmarks, float)
        if points.ndim == 3 and points.shape[1:] == (len(LANDMARKS), 3) and np.isfinite(points).all():
            self.show_moves(1, points)
