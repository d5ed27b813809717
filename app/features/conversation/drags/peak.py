"""The drag of the stress of a clause."""

from __future__ import annotations

from PySide6.QtCore import QPointF

from app.features.conversation.drags.segment import SegmentDrag
from app.features.conversation.segment_hits import snap_time
from app.project.document import Edit
from app.translation import tr, tr_noop
from metagraph.graph.conversation import edits as conversation_edits


class PeakDrag(SegmentDrag):
    """Drags the stress of a clause; where the pitch is highest catches it."""

    text = tr_noop("Move stress")

    def edit(self, at: QPointF, free: bool) -> Edit | None:
        view, hit, of = self.view, self.hit, self.view.editing.conversation
        segment, ident = view.editing.segment((hit.side, hit.at)), self.view.session.onstage.conversation
        if segment is None or segment.peak is None or of is None or ident is None:
            return None
        heard = view.sounds.of(of, hit.side)
        to = segment.peak + (at.x() - self.origin.x()) / view.each
        tops = [m for m in (heard.maxima if heard is not None else ()) if segment.start <= m <= segment.end]
        to = min(max(segment.start, snap_time(to, tops, view.scale(), not free)), segment.end)
        self.words, self.seconds = tr("Stress at {to:.2f} s", to=to), to
        return lambda p: conversation_edits.set_peak(p, ident, hit.side, hit.at, to)
