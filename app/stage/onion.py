"""Show an onion skin: other moments of an action, transparent, beside the one that plays."""

from __future__ import annotations

from dataclasses import dataclass

from PySide6.QtCore import QObject, Signal

from metagraph.graph.model import Action

MOST = 5  # ghosts; each is drawn in every frame


@dataclass(frozen=True)
class OnionSkin:
    """The moments of an `action` to show, as pairs of seconds of its clip and opacity, 0..1."""

    action: Action
    moments: tuple[tuple[float, float], ...]


class Onion(QObject):
    """Holds the onion skin. `changed` is emitted if other moments should be shown, or none."""

    changed = Signal()

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.skin: OnionSkin | None = None

    def show(self, skin: OnionSkin | None) -> None:
        """Show these moments, at most the first `MOST`; None for no skin."""
        if skin is not None:
            skin = OnionSkin(skin.action, skin.moments[:MOST])
        if skin != self.skin:
            self.skin = skin
            self.changed.emit()
