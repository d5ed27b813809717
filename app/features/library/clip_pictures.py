"""Pictures of clips as large as they are drawn, so that scrolling scales none."""

from __future__ import annotations

from collections import OrderedDict

from PySide6.QtCore import QRect, Qt
from PySide6.QtGui import QColor, QImage, QPainter, QPixmap

from app.stage.picture_process import SCALE, SIZE
from app.stage.thumbnails import Thumbnails

MOST = 40 * 1024 * 1024  # bytes of pictures that are kept as large as they are drawn


class ClipPictures:
    """scrubbed: the clip that the pointer goes through, and how far, 0..1."""

    def __init__(self, thumbnails: Thumbnails) -> None:
        self.thumbnails = thumbnails
        self.scrubbed: tuple[str, float] | None = None
        self._scaled: OrderedDict[tuple[str, int], tuple[QImage, QPixmap]] = OrderedDict()

    def draw(self, painter: QPainter, clip: str, box: QRect, line: QColor) -> bool:
        """Draw a clip's picture, or the one that the pointer is at with a line that tells how far; return
        whether there is one.
        """
        if self.scrubbed is not None and self.scrubbed[0] == clip:
            strip = self.thumbnails.scrub(clip)
            if strip:
                part = min(max(self.scrubbed[1], 0.0), 1.0)
                painter.drawImage(box, strip[min(int(part * len(strip)), len(strip) - 1)])
                painter.fillRect(box.left(), box.bottom() - 1, max(2, round(part * box.width())), 2, line)
                return True
        device = painter.device()
        pixels = round(box.width() * (device.devicePixelRatioF() if device is not None else 1.0))
        image = self.thumbnails.picture(clip, bare=True, large=pixels > SIZE * SCALE)
        if image is None:
            return False
        key = clip, pixels
        found = self._scaled.get(key)
        if found is None or found[0] is not image:
            mode = Qt.TransformationMode.SmoothTransformation
            scaled = image.scaled(pixels, pixels, Qt.AspectRatioMode.KeepAspectRatio, mode)
            found = image, QPixmap.fromImage(scaled)
            self._scaled[key] = found
            while len(self._scaled) > max(40, MOST // (4 * pixels * pixels)):
                self._scaled.popitem(last=False)
        self._scaled.move_to_end(key)
        painter.drawPixmap(box, found[1])
        return True
