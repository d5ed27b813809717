"""The drag of where a segment begins or ends."""

from __future__ import annotations

from PySide6.QtCore import QPointF

from app.features.conversation.drags.segment import SegmentDrag
from app.project.document import Edit
from app.translation import format_number, tr_noop
from metagraph.graph.conversation import edits as conversation_edits


class EdgeDrag(SegmentDrag):
    """Drags where a segment begins or ends."""

    text = tr_noop("Change segment")

    def edit(self, at: QPointF, free: bool) -> Edit | None:
        view, hit, ident = self.view, self.hit, self.view.session.onstage.conversation
        segment = view.editing.segment((hit.side, hit.at))
        if segment is None or ident is None:
            return None
        before = segment.start if hit.part == "start" else segment.end
        to = self.snapped(before + (at.x() - self.origin.x()) / view.each, free)
        self.words, self.seconds = (
            f"{format_number(max(0.0, to), '.2f')} s  ({format_number(to - before, '+.2f')})",
            to,
        )
        return lambda p: conversation_edits.resize_segment(p, ident, hit.side, hit.at, **{hit.part: to})
