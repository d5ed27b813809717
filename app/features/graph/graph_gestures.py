"""Drags on the canvas: of a likelihood's bar, of actions, of the head of a transition's arrow."""

from __future__ import annotations

from PySide6.QtCore import QPoint, QPointF, Qt
from PySide6.QtGui import QDrag

from app.features.graph.graph_host import GraphHost
from app.features.graph.graph_layout import likelihood_at
from app.features.graph.repoint import NOWHERE, repoint_at
from app.look.plural import many
from app.translation import tr
from app.widgets.gesture import PressDrag, Reason
from app.widgets.mime import drag_picture, mime
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
            value = likelihood_at(self.row, at.x())
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


class RowDrag(PressDrag):
    """Drags actions onto another node or stance, as a real drag so that everything that takes drops can take
    them.
    """

    def __init__(self, host: GraphHost, action: str) -> None:
        super().__init__()
        self.host, self.action = host, action

    def update(self, at: QPointF, free: bool = False) -> None:
        if self.begun or not self.caught(at):
            return
        chosen = self.host.session.selection.actions
        actions = chosen if self.action in chosen else (self.action,)
        widget = self.host.widget
        drag = QDrag(widget)
        drag.setMimeData(mime(actions=actions))
        action = self.host.document.project.action(self.action)
        picture = self.host.thumbnails.picture(action.clip, bare=True) if action is not None else None
        words = many(len(actions), "action") if len(actions) > 1 else self._name()
        drag.setPixmap(drag_picture(words, widget, picture))
        drag.setHotSpot(QPoint(-14, -10))
        self.host.hand.drop("taken over")
        drag.exec(Qt.DropAction.MoveAction)

    def _name(self) -> str:
        found = self.host.document.project.action(self.action)
        return found.name if found is not None else ""

    def finish(self, at: QPointF) -> None:
        """It was a click."""


class HeadDrag(PressDrag):
    """Drags the head of a transition's arrow; all selected transitions follow when it is one of them."""

    def __init__(self, host: GraphHost, action: str) -> None:
        super().__init__()
        self.host, self.action = host, action
        chosen = [a.id for a in host.session.selection.selected_actions() if a.kind == "transition"]
        self.actions = tuple(chosen) if action in chosen else (action,)

    def update(self, at: QPointF, free: bool = False) -> None:
        if not self.caught(at):
            return
        layout = self.host.layout_now()
        hit = layout.hit(at, dragging=True)
        drop = repoint_at(self.host.document.project, self.actions, hit)
        chip = next((c.rect for c in layout.chips if hit.area == "chip" and c.stance == hit.ident), None)
        row = layout.row(self.action)
        start = QPointF(row.head.center()) if row is not None else self.origin
        end = QPointF(chip.center().x(), chip.bottom() + 2) if chip is not None else at
        self.host.point(drop, hit if chip is not None else NOWHERE, (start, end))

    def finish(self, at: QPointF) -> None:
        if not self.begun:
            return
        hit = self.host.layout_now().hit(at, dragging=True)
        drop = repoint_at(self.host.document.project, self.actions, hit)
        self.host.point(None, NOWHERE, None)
        if drop.possible:
            self.host.end_in(self.actions, str(drop.end))
        elif hit.area == "chip":
            self.host.refuse(drop.words.replace("*", ""))

    def cancel(self, reason: Reason) -> None:
        self.host.point(None, NOWHERE, None)
