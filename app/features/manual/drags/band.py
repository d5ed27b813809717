"""The drag of a rubber band."""

from __future__ import annotations

from PySide6.QtCore import QPointF, QRectF

from app.features.manual.drags.host import ManualHost
from app.widgets.gesture import PressDrag, Reason


class Band(PressDrag):
    """Selects with a rubber band. kept: what stays selected besides."""

    def __init__(self, host: ManualHost, kept: tuple[tuple[str, ...], tuple[str, ...]]) -> None:
        super().__init__()
        self.host, self.kept = host, kept
        self.corner = QPointF()

    def begin(self, at: QPointF) -> None:
        super().begin(at)
        self.corner = self.host.view.back(at)

    def update(self, at: QPointF, free: bool = False) -> None:
        band = QRectF(self.corner, self.host.view.back(at)).normalized()
        self.host.show_band(band)
        states, links = self.host.scene().inside(band)
        both = (dict.fromkeys((*self.kept[0], *states)), dict.fromkeys((*self.kept[1], *links)))
        self.host.session.selection.select_states(
            tuple(both[0]), tuple(both[1]) if not both[0] else self.kept[1]
        )

    def finish(self, at: QPointF) -> None:
        self.host.show_band(None)

    def cancel(self, reason: Reason) -> None:
        self.host.show_band(None)
        self.host.session.selection.select_states(*self.kept)
