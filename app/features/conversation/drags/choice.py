"""Which drag a press on the lanes of a conversation begins."""

from __future__ import annotations

from app.features.conversation.drags.body import BodyDrag
from app.features.conversation.drags.edge import EdgeDrag
from app.features.conversation.drags.host import SegmentHost
from app.features.conversation.drags.new import NewDrag
from app.features.conversation.drags.peak import PeakDrag
from app.features.conversation.drags.scrub import SegmentScrub
from app.features.conversation.segment_hits import SegmentHit
from app.widgets.gesture import PointerDrag


def begin_segment_gesture(view: SegmentHost, hit: SegmentHit) -> PointerDrag:
    """Return what a press on something begins."""
    if hit.part in ("start", "end"):
        return EdgeDrag(view, hit)
    if hit.part == "body":
        return BodyDrag(view, hit)
    if hit.part == "peak":
        return PeakDrag(view, hit)
    return NewDrag(view, hit) if hit.part == "gap" else SegmentScrub(view)
