"""Paint two stick figures side by side, without OpenGL: a clip on its own skeleton, and retargeted."""

from __future__ import annotations

import time

import numpy as np
from PySide6.QtCore import QPointF, QRectF, QSize, Qt, QTimer
from PySide6.QtGui import QColor, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QWidget

from app.look.comfort import get_comfort
from app.translation import tr
from metagraph.motion.clip import Clip
from metagraph.motion.joint_names import HELPERS, split_joint_name

YAW = np.radians(28)  # seen a little from the side


class StickFigures(QWidget):
    """left: the clip as it is, None if there is none. right: what becomes of it, None while that is not
    known. marked: a joint of either, by name. words: what stands under each.
    """

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.left: Clip | None = None
        self.right: Clip | None = None
        self.marked: tuple[str, str] = ("", "")
        self.words = ("", "")
        self._seen: dict[int, _Seen] = {}
        self._timer = QTimer(self, interval=33)
        self._timer.timeout.connect(self.update)
        self.setMinimumSize(320, 260)
        self.setAccessibleName(tr("The clip on both skeletons"))

    def sizeHint(self) -> QSize:
        return QSize(380, 420)

    def show_clips(self, left: Clip | None, right: Clip | None) -> None:
        self.left, self.right = left, right
        self._seen = {n: _Seen(clip) for n, clip in enumerate((left, right)) if clip is not None}
        if not get_comfort().still:
            self._timer.start()
        self.update()

    def mark(self, left: str, right: str) -> None:
        self.marked = (left, right)
        self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        half = self.width() / 2
        for n in (0, 1):
            box = QRectF(n * half, 0, half, self.height()).adjusted(14, 12, -14, -34)
            painter.setPen(self.palette().placeholderText().color())
            caption = QRectF(n * half, self.height() - 28, half, 24)
            painter.drawText(
                caption, Qt.AlignmentFlag.AlignCenter | Qt.AlignmentFlag.AlignVCenter, self.words[n]
            )
            if n in self._seen:
                self._figure(painter, box, self._seen[n], self.marked[n])

    def _scale(self, box: QRectF) -> float:
        """Pixels per height of a figure: both are drawn equally tall, whatever their size and what they
        do.
        """
        return min(
            min(box.width() / wide, box.height() / tall)
            for wide, tall in (seen.size for seen in self._seen.values())
        )

    def _figure(self, painter: QPainter, box: QRectF, seen: _Seen, marked: str) -> None:
        clip, low = seen.clip, seen.low
        length = max(clip.frames / clip.fps, 0.1)
        seconds = length / 2 if get_comfort().still else time.monotonic() % length  # the middle tells most
        now = seen.places[min(clip.frames - 1, int(seconds * clip.fps))]
        scale = self._scale(box) / seen.height
        middle = (low[0] + seen.high[0]) / 2
        points = [
            QPointF(box.center().x() + scale * (x - middle), box.bottom() - scale * (y - low[1]))
            for x, y in now
        ]
        text = self.palette().text().color()
        painter.setPen(QPen(QColor(self.palette().mid().color()), 1))
        painter.drawLine(QPointF(box.left(), box.bottom()), QPointF(box.right(), box.bottom()))
        painter.setPen(QPen(text, 2.2, Qt.PenStyle.SolidLine, Qt.PenCapStyle.RoundCap))
        for joint, parent in seen.bones:
            painter.drawLine(points[parent], points[joint])
        if marked in clip.skeleton:
            painter.setPen(Qt.PenStyle.NoPen)
            painter.setBrush(self.palette().brightText().color())
            painter.drawEllipse(points[clip.skeleton.index(marked)], 5, 5)
            painter.setBrush(Qt.BrushStyle.NoBrush)


class _Seen:
    """A clip as it is painted. places: joints across and up `[F, J, 2]`, metres, the figure kept over one
    spot. low, high: its corners.
    """

    def __init__(self, clip: Clip) -> None:
        self.clip, skeleton = clip, clip.skeleton
        _, places = skeleton.globals(clip.poses())
        _, rest = skeleton.globals(skeleton.rest)
        grounded = (
            len(skeleton) > 1 and rest[0, 1] - rest[:, 1].min() < 0.05 * skeleton.height
        )  # a root between the feet is no bone
        self.bones = [
            (j, int(p))
            for j, p in enumerate(skeleton.parents)
            if p >= 0
            and not (p == 0 and grounded)
            and not HELPERS & set(split_joint_name(skeleton.names[j]).words)
        ]
        across = np.cos(YAW) * places[..., 0] + np.sin(YAW) * places[..., 2]
        drawn = sorted({j for bone in self.bones for j in bone}) or [0]
        across = across - across[:, drawn].mean(1, keepdims=True)
        self.places = np.stack([across, places[..., 1]], -1)
        self.low, self.high = self.places[:, drawn].min((0, 1)), self.places[:, drawn].max((0, 1))
        self.height = max(float(self.high[1] - self.low[1]), 1e-6)
        self.size = tuple(np.maximum((self.high - self.low) / self.height, 1e-6).tolist())
