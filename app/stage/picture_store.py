"""Pictures of clips kept on disk, so that a project that is opened again shows them without drawing. They are
found by what they show: the clip's content, the figure, the look and the size. Nothing is lost with them.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
from pathlib import Path

from PySide6.QtCore import QByteArray, QStandardPaths, Qt
from PySide6.QtGui import QImage, QImageWriter, QPainter

from app.stage.picture_process import LARGE, SCALE, SCRUB, SIZE, PictureOrder

DRAWN = 1  # to be raised when pictures are drawn otherwise
MOST = 192 * 1024 * 1024  # bytes on disk; those not looked at for longest go
LEFT = 0.8  # of them, after a clearing
KEPT = ("card", "bare", "large", "scrub")


def cache_folder() -> Path:
    """Return where this person's pictures are kept."""
    base = QStandardPaths.writableLocation(QStandardPaths.StandardLocation.CacheLocation)
    return Path(base) / "pictures"


def key_of(order: PictureOrder) -> str:
    """Return what a picture is found by, 40 hex digits: another wherever it would look otherwise."""
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
    out.update(repr(words).encode())
    out.update(repr((clip.skeleton.fingerprint, clip.fps, clip.translated, clip.morphs)).encode())
    for values in (clip.rotations, clip.translations, clip.weights):
        if values is not None:
            out.update(values.data)
    return out.hexdigest()


class PictureStore:
    """folder: made when there is something to keep. Used by one thread at a time. Whatever the disk refuses,
    no picture comes from it, and none is kept.
    """

    def __init__(self, folder: Path, most: int = MOST) -> None:
        self.folder, self.most = folder, most
        self._bytes: int | None = None  # of all pictures there, once it was looked

    def load(self, key: str) -> list[QImage] | None:
        """Return what was kept; None where nothing is, or nothing that could be read."""
        path = self._path(key)
        try:
            data = path.read_bytes()
        except OSError:
            return None
        sheet = QImage()
        side = sheet.height() if sheet.loadFromData(data, "PNG") else 0
        if side == 0 or sheet.width() % side:
            with contextlib.suppress(OSError):
                path.unlink()
            return None
        with contextlib.suppress(OSError):
            os.utime(path)
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
        path = self._path(key)
        beside = path.with_suffix(f".{os.getpid()}")
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            writer = QImageWriter(str(beside), QByteArray(b"png"))
            writer.setQuality(80)  # packed lightly: it is read often, and soon written
            if not writer.write(sheet):
                raise OSError
            size = beside.stat().st_size
            beside.replace(path)
        except OSError:
            with contextlib.suppress(OSError):
                beside.unlink()
            return
        self._count()
        self._bytes = (self._bytes or 0) + size
        if self._bytes > self.most:
            self.clear_old()

    def clear_old(self) -> None:
        """Let the oldest go until there is room again."""
        files = sorted(self._files(), key=lambda f: f[1])
        total = sum(size for _, _, size in files)
        for path, _, size in files:
            if total <= self.most * LEFT:
                break
            with contextlib.suppress(OSError):
                Path(path).unlink()
            total -= size
        self._bytes = total

    def _count(self) -> None:
        if self._bytes is None:
            self._bytes = sum(size for _, _, size in self._files())

    def _files(self) -> list[tuple[str, int, int]]:
        """Return every file with when it was looked at last and its bytes."""
        out: list[tuple[str, int, int]] = []
        try:
            with os.scandir(self.folder) as found:
                folders = [f.path for f in found if f.is_dir()]
        except OSError:
            return out
        for folder in folders:
            with contextlib.suppress(OSError), os.scandir(folder) as found:
                for each in found:
                    with contextlib.suppress(OSError):
                        told = each.stat()
                        out.append((each.path, told.st_mtime_ns, told.st_size))
        return out

    def _path(self, key: str) -> Path:
        return self.folder / key[:2] / f"{key[2:]}.png"
