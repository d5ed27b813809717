"""Keep pictures of clips on disk, so that a project that is opened again shows them without drawing. They are
found by what they show: the clip's content, the figure, the look and the size. They can be deleted without
loss.
"""

from __future__ import annotations

import hashlib
from pathlib import Path

from PySide6.QtCore import QBuffer, QByteArray, QIODevice, Qt
from PySide6.QtGui import QImage, QImageWriter, QPainter

from app.stage.picture_process import LARGE, SCALE, SCRUB, SIZE, PictureOrder
from metagraph.common.disk_cache import DiskCache, cache_folder

DRAWN = 5  # raise this when pictures are drawn differently
MOST = 192 * 1024 * 1024  # bytes on disk
KEPT = ("card", "bare", "large", "scrub")


def find_pictures_folder() -> Path | None:
    """Return the folder for this user's pictures."""
    return cache_folder("pictures")


def make_picture_key(order: PictureOrder) -> str:
    """Return the key of a picture, 40 hex digits; it differs if the picture would."""
    clip = order.clip
    out = hashlib.blake2b(digest_size=20)
    character = None
    if order.character is not None:
        try:
            found = order.character.stat()
            character = (str(order.character.resolve()), found.st_size, found.st_mtime_ns)
        except OSError:
            character = (str(order.character), 0, 0)
    words = (DRAWN, order.what, order.theme, order.paper, SIZE, SCALE, LARGE, SCRUB, character, order.hidden)
    out.update(repr((words, order.sticks)).encode())
    out.update(repr((clip.skeleton.fingerprint, clip.fps, clip.translated, clip.morphs)).encode())
    for values in (clip.rotations, clip.translations, clip.weights):
        if values is not None:
            out.update(values.data)
    return out.hexdigest()


class PictureStore:
    """Keeps square pictures by keys, in a `DiskCache`. One thread may use it at a time."""

    def __init__(self, folder: Path | None, most: int = MOST) -> None:
        self.files = DiskCache(folder, most, ".png")

    def load(self, key: str) -> list[QImage] | None:
        """Return kept pictures; None if there are none, or they cannot be read."""
        data = self.files.read(key)
        if data is None:
            return None
        sheet = QImage()
        side = sheet.height() if sheet.loadFromData(data, "PNG") else 0
        if side == 0 or sheet.width() % side:
            self.files.drop(key)
            return None
        if sheet.width() == side:
            return [sheet]
        return [sheet.copy(n * side, 0, side, side) for n in range(sheet.width() // side)]

    def keep(self, key: str, pictures: list[QImage]) -> None:
        """Keep square pictures of one size."""
        side = pictures[0].height() if pictures else 0
        if side == 0 or any((p.width(), p.height()) != (side, side) for p in pictures):
            return
        sheet = pictures[0]
        if len(pictures) > 1:
            sheet = QImage(side * len(pictures), side, pictures[0].format())
            sheet.fill(Qt.GlobalColor.transparent)
            painter = QPainter(sheet)
            painter.setCompositionMode(QPainter.CompositionMode.CompositionMode_Source)
            for n, picture in enumerate(pictures):
                painter.drawImage(n * side, 0, picture)
            painter.end()
        data = QBuffer()
        data.open(QIODevice.OpenModeFlag.WriteOnly)
        writer = QImageWriter(data, QByteArray(b"png"))
        writer.setQuality(80)  # compressed lightly, because it is read often and must be written quickly
        if writer.write(sheet):
            self.files.write(key, bytes(data.data().data()))
