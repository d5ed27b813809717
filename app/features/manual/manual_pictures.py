"""Clips' pictures at the size nodes show them, kept so that nothing is scaled twice."""

from __future__ import annotations

from PySide6.QtCore import QSizeF, Qt
from PySide6.QtGui import QPixmap

from app.features.manual.manual_painter import SMALL
from app.features.manual.manual_scene import NODE, ManualScene, ManualView
from app.stage.session import StageSession
from app.stage.thumbnails import Thumbnails


class ManualPictures:
    """count: how many were forgotten or come so far, so that whoever keeps a painting knows when it is
    old.
    """

    def __init__(self, thumbnails: Thumbnails, session: StageSession) -> None:
        self.thumbnails, self.session = thumbnails, session
        self.count = 0
        self._kept: dict[tuple[str, str, int], QPixmap] = {}

    def forget(self, clip: str) -> None:
        """Take a clip's picture again, all of them where none is named."""
        self.count += 1
        self._kept = {key: p for key, p in self._kept.items() if clip and key[0] != clip}

    def of(self, scene: ManualScene, view: ManualView, ratio: float) -> dict[str, QPixmap]:
        """Return the pictures of the states in sight by clip; those not drawn yet are asked for and left
        out.
        """
        if view.scale < SMALL:
            return {}
        out: dict[str, QPixmap] = {}
        pixels = max(8, round((NODE.height() - 12) * view.scale * ratio))
        shown = view.rect(QSizeF(4000, 3000))
        for state in scene.manual.states.values():
            if state.clip in out or not scene.nodes[state.id].intersects(shown):
                continue
            key = (state.clip, self.session.look.name, pixels)
            found = self._kept.get(key)
            if found is None:
                picture = self.thumbnails.picture(state.clip)
                if picture is None:
                    continue
                scaled = picture.scaled(
                    pixels,
                    pixels,
                    Qt.AspectRatioMode.KeepAspectRatioByExpanding,
                    Qt.TransformationMode.SmoothTransformation,
                )
                found = self._kept[key] = QPixmap.fromImage(scaled)
                if len(self._kept) > 2000:
                    self._kept = {key: found}
            out[state.clip] = found
        return out
