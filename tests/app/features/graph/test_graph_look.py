"""What of a picture is shown where there is little room."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QRectF, Qt
from PySide6.QtGui import QColor, QImage, QPainter

from app.features.graph.graph_look import crop_upper


def picture(figure: QRectF, size: int = 160) -> QImage:
    out = QImage(size, size, QImage.Format.Format_RGBA8888)
    out.fill(Qt.GlobalColor.transparent)
    painter = QPainter(out)
    painter.fillRect(figure, QColor("white"))
    painter.end()
    return out


def test_of_who_stands_the_upper_middle_is_shown() -> None:
    standing = picture(QRectF(60, 20, 40, 130))
    assert crop_upper(standing) == QRectF(160 * 0.24, 160 * 0.03, 160 * 0.52, 160 * 0.52)
    assert crop_upper(standing) == crop_upper(standing)
    assert crop_upper(picture(QRectF())) == crop_upper(standing), "nothing is drawn yet"


@pytest.mark.parametrize(
    "figure",
    [QRectF(20, 70, 110, 40), QRectF(0, 100, 160, 30), QRectF(70, 120, 20, 20), QRectF(110, 130, 50, 30)],
)
def test_of_who_lies_all_is_shown(figure: QRectF) -> None:
    shown = crop_upper(picture(figure))
    assert shown.width() == shown.height() <= 160
    assert QRectF(0, 0, 160, 160).contains(shown)
    assert shown.adjusted(-7, -7, 7, 7).contains(figure)
