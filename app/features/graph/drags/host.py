"""What drags on the canvas of the meta-graph need of it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

from PySide6.QtCore import QPointF, QRectF
from PySide6.QtWidgets import QWidget

from app.features.graph.graph_drops import Drop
from app.features.graph.graph_hover import Hover
from app.features.graph.graph_layout import GraphHit, Layout
from app.project.document import Document
from app.stage.session import StageSession
from app.stage.thumbnails import Thumbnails
from app.widgets.gesture import PointerHand


class GraphHost(Protocol):
    """The canvas as its gestures see it. hand: what holds them."""

    document: Document
    session: StageSession
    hand: PointerHand
    hover: Hover
    thumbnails: Thumbnails

    @property
    def widget(self) -> QWidget: ...
    def layout_now(self) -> Layout: ...
    def point(
        self,
        drop: Drop | None,
        hit: GraphHit,
        arrow: tuple[QPointF, QPointF] | None,
        mark: QRectF | None = None,
    ) -> None: ...
    def end_in(self, actions: Sequence[str], stance: str) -> None: ...
    def merge(self, merged: str, into: str) -> None: ...
    def list_stance(self, stance: str, before: str | None) -> None: ...
    def refuse(self, words: str) -> None: ...
