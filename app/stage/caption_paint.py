"""Paint captions into a picture: at the bottom, inside the safe area, light on a dark ground that covers what
is behind.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from PySide6.QtCore import QRectF, Qt
from PySide6.QtGui import QColor, QFont, QFontMetricsF, QImage, QPainter

from metagraph.speech.captions import Caption

SAFE = 0.05  # of width and height, free at each edge (EBU R 95: graphics safe area of 16:9)
TALL = 0.046  # of the picture's height: the size of letters; about 20 lines a picture, as broadcasters do
LEAST = 11  # pixels
GROUND, INK = QColor(0, 0, 0, 175), QColor(255, 255, 255)


def paint_captions(painter: QPainter, width: float, height: float, shown: Sequence[Caption]) -> None:
    """Paint the captions that are shown now."""
    lines = [line for caption in shown for line in caption.text.split("\n")]
    if not lines:
        return
    painter.save()
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    font = QFont(painter.font())
    font.setPixelSize(max(LEAST, round(min(height, width * 9 / 16) * TALL)))
    widest = max(QFontMetricsF(font).horizontalAdvance(line) for line in lines)
    room = width * (1 - 2 * SAFE)
    if widest > room:  # a narrow picture, in which a line would leave the safe area
        font.setPixelSize(max(4, int(font.pixelSize() * room / widest)))
    painter.setFont(font)
    metrics = QFontMetricsF(font)
    each, pad = metrics.height() * 1.12, metrics.height() * 0.28
    top = height * (1 - SAFE) - each * len(lines)
    for n, line in enumerate(lines):
        wide = metrics.horizontalAdvance(line) + 2 * pad
        rect = QRectF((width - wide) / 2, top + n * each, wide, each)
        painter.fillRect(rect, GROUND)
        painter.setPen(INK)
        painter.drawText(rect, Qt.AlignmentFlag.AlignCenter, line)
    painter.restore()


def add_captions(picture: np.ndarray, shown: Sequence[Caption]) -> np.ndarray:
    """Paint captions into a picture `[H, W, 4]` uint8, premultiplied; return it."""
    if not shown:
        return picture
    height, width = picture.shape[:2]
    whole = np.ascontiguousarray(picture)
    image = QImage(whole.data, width, height, width * 4, QImage.Format.Format_RGBA8888_Premultiplied)
    painter = QPainter(image)
    paint_captions(painter, width, height, shown)
    painter.end()
    return whole
