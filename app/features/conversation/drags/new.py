"""The drag that draws a new segment."""

from __future__ import annotations

from PySide6.QtCore import QPointF

from app.features.conversation.drags.host import SegmentHost
from app.features.conversation.drags.segment import SegmentDrag
from app.project.document import Edit
from app.translation import tr, tr_noop
from metagraph.graph.conversation import edits as conversation_edits
from metagraph.graph.edit_error import EditError


class NewDrag(SegmentDrag):
    """Draws a new segment where none is."""

    text = tr_noop("Add segment")

    def edit(self, at: QPointF, free: bool) -> Edit | None:
        view, side, ident = self.view, self.hit.side, self.view.session.onstage.conversation
        scale = view.scale()
        start, end = (self.snapped(scale.seconds(x), free) for x in (self.origin.x(), at.x()))
        self.words, self.seconds = tr("New: {seconds:.2f} s", seconds=abs(end - start)), end
        self._span = start, end
        if ident is None or not _can(
            view, lambda p: conversation_edits.add_segment(p, ident, side, "clause", start, end)[0]
        ):
            return None
        return lambda p: conversation_edits.add_segment(p, ident, side, "clause", start, end)[0]

    def finish(self, at: QPointF) -> None:
        self.view.hold(None)
        if self.begun and self.made is not None:
            self.view.editing.add(self.hit.side, "clause", *self._span)

    _span = (0.0, 0.0)


def _can(view: SegmentHost, edit: Edit) -> bool:
    try:
        edit(view.document.project)
    except EditError:
        return False
    return True
