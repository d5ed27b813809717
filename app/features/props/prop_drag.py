"""What every drag of a prop shares: each is one step, and Escape takes it back."""

from __future__ import annotations

from PySide6.QtCore import QPointF

from app.features.props.placing import Placing
from app.widgets.gesture import PressDrag, Reason
from metagraph.graph.prop import Prop


class PropDrag(PressDrag):
    """Drags one prop. before: as it was when it was taken."""

    def __init__(self, placing: Placing, ident: str, before: Prop) -> None:
        super().__init__()
        self.placing, self.ident, self.before = placing, ident, before

    def words(self) -> str:
        """Name the step."""
        raise NotImplementedError

    def place(self, at: QPointF, free: bool) -> Prop:
        """Return the prop as it is where the mouse is. free: without snapping."""
        raise NotImplementedError

    def update(self, at: QPointF, free: bool = False) -> None:
        if self.caught(at):
            self.placing.drag(self.words(), self.ident, self.place(at, free))

    def finish(self, at: QPointF) -> None:
        if self.begun:
            self.placing.end()

    def cancel(self, reason: Reason) -> None:
        if self.begun:
            self.placing.take_back(self.ident)
