"""Onion skin: other moments of an action, seen through beside the one that plays."""

from __future__ import annotations

from dataclasses import dataclass

from PySide6.QtCore import QObject, Signal

from metagraph.graph.model import Action

MOST = 5  # ghosts; each is drawn in every frame


@dataclass(frozen=True)
class OnionSkin:
    """action: whose. moments: seconds of its clip, each seen so much: 0..1."""

    action: Action
    moments: tuple[tuple[float, float], ...]


class Onion(QObject):
    """changed: other moments are to be seen, or none."""

    changed = Signal()

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.skin: OnionSkin | None = None

    def show(self, skin: OnionSkin | None) -> None:
        """Let these moments be seen, of which the first `MOST` are; None for no skin."""
        if skin is not None:
            skin = OnionSkin(skin.action, skin.moments[:MOST])
        if skin != self.skin:
            self.skin = skin
            self.changed.emit()
