"""What drags in the editor need of its view."""

from __future__ import annotations

from typing import Protocol

from app.features.timing_editor.axis import Axis
from app.features.timing_editor.track import KeptHand
from app.project.document import Document
from app.stage.transport import Transport
from metagraph.suggest.jumps.snapping import Snap


class Host(Protocol):
    """The view, as drags know it. snapped: where what is dragged has come to rest. held: what is dragged, in
    words. snaps: all places to rest there are. stretched: a kept hand as it would be, of which action.
    """

    document: Document
    axis: Axis
    snapped: Snap | None
    held: str
    snaps: tuple[Snap, ...]
    stretched: tuple[str, KeptHand] | None

    @property
    def transport(self) -> Transport: ...
    def idents(self) -> tuple[str, ...]: ...
    def update(self) -> None: ...
