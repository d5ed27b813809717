"""Drags of the mouse in the editor as objects, from press to release. Only `finish` changes the project."""

from __future__ import annotations

from PySide6.QtCore import QPointF, QRectF, Qt

from app.features.manual.manual_host import ManualHost
from app.features.manual.manual_scene import ManualHit
from app.translation import tr, tr_told
from app.widgets.gesture import PressDrag, Reason
from metagraph.graph.manual import edits as manual_edits

SNAP = 8.0  # units to which nodes come to rest


class ManualPan(PressDrag):
    """Moves what is seen."""

    def __init__(self, host: ManualHost) -> None:
        super().__init__()
        self.host, self.last = host, QPointF()

    def begin(self, at: QPointF) -> None:
        super().begin(at)
        self.last = at

    def update(self, at: QPointF, free: bool = False) -> None:
        if not self.caught(at):
            return
        self.host.look_at(self.host.view.panned(at - self.last))
        self.last = at

    def finish(self, at: QPointF) -> None:
        self.host.settle()

    def cancel(self, reason: Reason) -> None:
        self.host.settle()


class Move(PressDrag):
    """Moves the selected nodes, or the one that was pressed; they come to rest on the grid. One undo step."""

    def __init__(self, host: ManualHost, node: str) -> None:
        super().__init__()
        self.host, self.node = host, node
        chosen = host.session.selection.states
        self.nodes = chosen if node in chosen else (node,)

    def update(self, at: QPointF, free: bool = False) -> None:
        if not self.caught(at):
            return
        self.host.drag_nodes(self._places(at))

    def _places(self, at: QPointF) -> dict[str, tuple[float, float]]:
        by = (at - self.origin) / self.host.view.scale
        first = self.host.scene().nodes[self.node].topLeft()
        x, y = (
            round((first.x() + by.x()) / SNAP) * SNAP - first.x(),
            round((first.y() + by.y()) / SNAP) * SNAP - first.y(),
        )
        nodes = self.host.scene().nodes
        return {i: (nodes[i].left() + x, nodes[i].top() + y) for i in self.nodes if i in nodes}

    def finish(self, at: QPointF) -> None:
        places = self._places(at) if self.begun else {}
        self.host.drag_nodes({})
        if places:
            layer = self.host.session.place.layer
            text = tr("Move node") if len(places) == 1 else tr("Move {places} nodes", places=len(places))
            self.host.document.edit(text, lambda p: manual_edits.move_nodes(p, layer, places))

    def cancel(self, reason: Reason) -> None:
        self.host.drag_nodes({})


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


class DrawLink(PressDrag):
    """Draws a link from a node to where the mouse is let go. From a selected node it draws one from each that
    is selected; from another one onto a selected node, one to each. sticky: begun from a menu, it follows the
    mouse until it is pressed.
    """

    def __init__(self, host: ManualHost, source: str, sticky: bool = False) -> None:
        super().__init__()
        self.host, self.source, self.sticky = host, source, sticky
        self.chosen = host.session.selection.states
        self.sources = self.chosen if source in self.chosen else (source,)
        self.begun = sticky
        self.target = ""
        self.words = ""

    def update(self, at: QPointF, free: bool = False) -> None:
        if not self.caught(at):
            return
        hit: ManualHit = self.host.scene().hit(self.host.view.back(at), self.host.view.scale)
        self.target, self.words = "", ""
        if hit.area in ("node", "edge"):
            why = manual_edits.link_refusal(
                self.host.document.project, self.host.session.place.layer, self.source, hit.ident
            )
            self.target, self.words = (hit.ident, "") if why is None else ("", tr_told(why))
        self.host.show_cursor(Qt.CursorShape.ForbiddenCursor if self.words else Qt.CursorShape.CrossCursor)
        self.host.show_link(self.source, at, self.target, self.sources, self._tell())

    @property
    def targets(self) -> tuple[str, ...]:
        """What the link leads to where it is let go now: all that is selected, if that is one of it and the
        link is drawn from elsewhere.
        """
        many = self.target in self.chosen and self.source not in self.chosen
        return self.chosen if many else (self.target,)

    def _tell(self) -> str:
        count = len(self.sources) * len(self.targets)
        return tr("{count} links at once", count=count) if self.target and count > 1 else ""

    def finish(self, at: QPointF) -> None:
        self.update(at)
        self.host.show_link("", at, "")
        if not self.begun or (
            self.target == self.source and (at - self.origin).manhattanLength() < 24 and not self.sticky
        ):
            return
        if self.words:
            self.host.refuse(self.words)
        elif self.target:
            self.host.add_links(self.sources, self.targets)
        else:
            self.host.refuse(tr("let a link go on a state"))

    def cancel(self, reason: Reason) -> None:
        self.host.show_link("", QPointF(), "")
