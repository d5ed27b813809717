"""Drag a segment in time."""

from __future__ import annotations

from PySide6.QtCore import QPointF, Qt

from app.features.conversation.drags.segment import SegmentDrag
from app.project.document import Edit
from app.translation import format_number, tr_noop
from metagraph.graph.conversation import edits as conversation_edits


class BodyDrag(SegmentDrag):
    """Drags a segment in time. The nearer of its ends snaps to a word."""

    text = tr_noop("Move segment")
    cursor = Qt.CursorShape.ClosedHandCursor

    def edit(self, at: QPointF, free: bool) -> Edit | None:
        view, hit, ident = self.view, self.hit, self.view.session.onstage.conversation
        segment = view.editing.segment((hit.side, hit.at))
        if segment is None or ident is None:
            return None
        by = (at.x() - self.origin.x()) / view.each
        caught = [
            to - edge
            for edge in (segment.start, segment.end)
            if (to := self.snapped(edge + by, free)) != edge + by
        ]
        by = min(caught, key=lambda c: abs(c - by), default=by)
        self.words, self.seconds = (
            f"{format_number(max(0.0, segment.start + by), '.2f')} s  ({format_number(by, '+.2f')})",
            segment.start + by,
        )
        return lambda p: conversation_edits.move_segment(p, ident, hit.side, hit.at, by)
