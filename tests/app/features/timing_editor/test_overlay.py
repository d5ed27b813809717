"""What moves over the ruler stands instead of its words, never over a part of one."""

from __future__ import annotations

import numpy as np
import pytest
from PySide6.QtCore import QRectF
from PySide6.QtGui import QColor, QFont, QImage, QPainter

from app.features.timing_editor.axis import Axis
from app.features.timing_editor.overlay import paint_chip
from app.features.timing_editor.paint import TimingLook, lay_out_ruler, paint_ruler
from app.features.timing_editor.rows import GUTTER, RIGHT, RULER
from app.look.theme import get_theme

WIDTH = 700
AXIS = Axis.whole(GUTTER, WIDTH - GUTTER - RIGHT, 3.17)


def drawn(look: TimingLook, words: str = "", middle: float = 0.0) -> tuple[np.ndarray, QRectF]:
    """The ruler's pixels, with a chip on it, and if that is."""
    image = QImage(WIDTH, int(RULER), QImage.Format.Format_RGB32)
    image.fill(QColor(look.t.panel))
    painter, box = QPainter(image), QRectF()
    paint_ruler(painter, look, AXIS)
    if words:
        box = paint_chip(painter, look, AXIS, words, middle)
    painter.end()
    return np.frombuffer(image.constBits(), np.uint32).reshape(int(RULER), WIDTH).copy(), box


@pytest.mark.parametrize("words", ["2.27 s  0.7 m/s", "0.1 s"])
def test_a_word_of_the_ruler_is_whole_or_gone_wherever_the_playhead_is(qapp, words):
    look = TimingLook(get_theme("dark"), QFont(qapp.font()))
    look.small.setPointSizeF(8)
    plain, _ = drawn(look)
    gone = 0
    for middle in np.arange(GUTTER, WIDTH - RIGHT, 3.0):
        over, box = drawn(look, words, float(middle))
        for _, text, place in lay_out_ruler(look, AXIS):
            left, right = int(place.left()), int(place.right())
            beside = [x for x in range(left, right) if not box.left() - 1 <= x <= box.right() + 1]
            if not beside:
                continue
            part, before = over[: int(RULER) - 4, beside], plain[: int(RULER) - 4, beside]
            empty = (part == plain[0, 0]).all()
            gone += bool(empty)
            assert empty or (len(beside) == right - left and (part == before).all()), (text, middle)
    assert gone
