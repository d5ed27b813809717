"""Drag a likelihood bar."""

from __future__ import annotations

from PySide6.QtCore import QPointF

from app.features.graph.drags.host import GraphHost
from app.features.graph.graph_layout import read_likelihood_at
from app.translation import tr
from app.widgets.gesture import PressDrag, Reason
from metagraph.graph import edits


class LikelihoodDrag(PressDrag):
    """Drags a likelihood bar; all selected actions follow when the bar is of one of them."""

    def __init__(self, host: GraphHost, action: str) -> None:
        super().__init__()
        self.host = host
        chosen = host.session.selection.actions
        self.actions = chosen if action in chosen else (action,)
        self.row = host.layout_now().row(action)

    def update(self, at: QPointF, free: bool = False) -> None:
        if self.row is not None:
            value = read_likelihood_at(self.row, at.x())
            self.host.document.edit(
                tr("Change likelihood"),
                lambda p: edits.update_actions(p, self.actions, likelihood=value),
                merge="likelihood",
            )

    def finish(self, at: QPointF) -> None:
        self.update(at)
        self.host.document.finish_merging()

    def cancel(self, reason: Reason) -> None:
        self.host.document.cancel_merging("likelihood")
