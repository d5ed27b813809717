"""The filmstrip: poses along the clip, each where it is in time; and the sheet of what moves when."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from PySide6.QtCore import QPointF, QRectF
from PySide6.QtGui import QColor, QImage, QPainter, QPen, QPixmap

from app.features.timing_editor.axis import Axis
from app.features.timing_editor.paint import MIDDLE, TimingLook
from app.features.timing_editor.rows import GUTTER, JOINT
from metagraph.motion.dope import DopeSheet

SEEN = 24  # of 255: what is less opaque is beside the figure
PAUSE = 0.12  # of the greatest speed of a joint, below which nothing is painted


def paint_poses(
    painter: QPainter, look: TimingLook, rect: QRectF, axis: Axis, pictures: Sequence[QImage]
) -> None:
    """Paint a clip's pictures, evenly apart from its first moment to its last; as many as find room."""
    left, right = max(axis.x(0), axis.left), min(axis.x(axis.length), axis.left + axis.width)
    if right <= left:
        return
    figure = find_figure_room(pictures)
    cell = max(16.0, rect.height() * figure.width() / max(1.0, figure.height()) + 2)
    count = max(1, int((right - left) / cell))
    wide = (right - left) / count
    painter.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform)
    for n in range(count):
        box = QRectF(left + n * wide, rect.top(), wide, rect.height())
        if pictures:
            at = round(axis.seconds(box.center().x()) / max(axis.length, 1e-6) * (len(pictures) - 1))
            target = QRectF(0, 0, rect.height() * figure.width() / figure.height(), rect.height())
            target.moveCenter(box.center())
            painter.drawImage(target, pictures[min(max(at, 0), len(pictures) - 1)], figure)
        if n:
            painter.setPen(QPen(QColor(look.t.line), 1))
            painter.drawLine(QPointF(box.left(), box.top() + 3), QPointF(box.left(), box.bottom() - 3))


def find_figure_room(pictures: Sequence[QImage]) -> QRectF:
    """Return the part of the pictures, of one size, that the figure takes in any of them, pixels; all of them
    if there is none.
    """
    if not pictures:
        return QRectF(0, 0, 3, 4)
    covered = np.zeros((pictures[0].height(), pictures[0].width()), bool)
    for picture in pictures:
        rgba = picture.convertToFormat(QImage.Format.Format_RGBA8888)
        rows = np.frombuffer(rgba.constBits(), np.uint8).reshape(rgba.height(), rgba.bytesPerLine() // 4, 4)
        covered |= rows[:, : rgba.width(), 3] > SEEN
    ys, xs = np.flatnonzero(covered.any(1)), np.flatnonzero(covered.any(0))
    if not len(ys):
        return QRectF(pictures[0].rect())
    return QRectF(xs[0], ys[0], xs[-1] + 1 - xs[0], ys[-1] + 1 - ys[0])


def paint_dope_sheet(
    painter: QPainter, look: TimingLook, rect: QRectF, axis: Axis, sheet: DopeSheet, color: QColor
) -> None:
    """Paint what moves when: a line for each joint, the stronger the faster it turns."""
    painter.setFont(look.small)
    left, right = max(axis.x(0), axis.left), min(axis.x(axis.length), axis.left + axis.width)
    for n, name in enumerate(sheet.names):
        line = QRectF(rect.left(), rect.top() + n * JOINT, rect.width(), JOINT)
        painter.setPen(QColor(look.t.dim))
        painter.drawText(
            QRectF(10, line.top(), GUTTER - 14, JOINT), MIDDLE, look.elided(name, GUTTER - 14, True)
        )
        painter.fillRect(QRectF(left, line.top() + 1, right - left, JOINT - 2), QColor(look.t.field))
    image = _image(sheet, color)
    if image is not None and right > left:
        source_left = (axis.seconds(left) / max(axis.length, 1e-6)) * image.width()
        source_right = (axis.seconds(right) / max(axis.length, 1e-6)) * image.width()
        painter.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform, False)
        for n in range(len(sheet.names)):
            painter.drawPixmap(
                QRectF(left, rect.top() + n * JOINT + 2, right - left, JOINT - 4),
                image,
                QRectF(source_left, n, source_right - source_left, 1),
            )


def _image(sheet: DopeSheet, color: QColor) -> QPixmap | None:
    """Return a picture with a pixel for each frame and joint."""
    part = np.clip((sheet.parts - PAUSE) / (1 - PAUSE), 0, 1) ** 0.7
    if not part.size:
        return None
    pixels = np.zeros((*part.T.shape, 4), np.uint8)
    pixels[..., 0], pixels[..., 1], pixels[..., 2] = color.blue(), color.green(), color.red()
    pixels[..., 3] = (part.T * 255).astype(np.uint8)
    pixels = np.ascontiguousarray(pixels)
    image = QImage(
        pixels.data, pixels.shape[1], pixels.shape[0], pixels.strides[0], QImage.Format.Format_ARGB32
    )
    return QPixmap.fromImage(image.copy())
