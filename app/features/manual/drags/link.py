"""The drag that draws links."""

from __future__ import annotations

from PySide6.QtCore import QPointF, Qt

from app.features.manual.drags.host import ManualHost
from app.features.manual.drags.node import NodeDrag
from app.features.manual.manual_scene import ManualHit
from app.translation import tr, tr_phrase, tr_plural
from app.widgets.gesture import Reason
from metagraph.graph.manual import edits as manual_edits


class DrawLink(NodeDrag):
    """Draws a link from a node to where the mouse is let go. From a selected node it draws one from each that
    is selected; from another one onto a selected node, one to each. sticky: begun from a menu, it follows the
    mouse until it is pressed.
    """

    def __init__(self, host: ManualHost, source: str, sticky: bool = False) -> None:
        super().__init__(host, source)
        self.begun = self.sticky = sticky
        self.chosen = host.session.selection.states
        self.target = ""
        self.words = ""

    def update(self, at: QPointF, free: bool = False) -> None:
        if not self.caught(at):
            return
        hit: ManualHit = self.host.scene().hit(self.host.view.back(at), self.host.view.scale)
        self.target, self.words = "", ""
        if hit.area in ("node", "edge"):
            why = manual_edits.explain_link_refusal(
                self.host.document.project, self.host.session.place.layer, self.node, hit.ident
            )
            self.target, self.words = (hit.ident, "") if why is None else ("", tr_phrase(why))
        self.host.show_cursor(Qt.CursorShape.ForbiddenCursor if self.words else Qt.CursorShape.CrossCursor)
        self.host.show_link(self.node, at, self.target, self.nodes, self._tell())

    @property
    def targets(self) -> tuple[str, ...]:
        """What the link leads to where it is let go now: all that is selected, if that is one of it and the
        link is drawn from elsewhere.
        """
        many = self.target in self.chosen and self.node not in self.chosen
        return self.chosen if many else (self.target,)

    def _tell(self) -> str:
        count = len(self.nodes) * len(self.targets)
        return tr_plural("{count:,} link", "{count:,} links", count) if self.target and count > 1 else ""

    def finish(self, at: QPointF) -> None:
        self.update(at)
        self.host.show_link("", at, "")
        if not self.begun or (
            self.target == self.node and (at - self.origin).manhattanLength() < 24 and not self.sticky
        ):
            return
        if self.words:
            self.host.refuse(self.words)
        elif self.target:
            self.host.add_links(self.nodes, self.targets)
        else:
            self.host.refuse(tr("drop the link on a state"))

    def cancel(self, reason: Reason) -> None:
        self.host.show_link("", QPointF(), "")
