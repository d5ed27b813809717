"""Drags of the mouse on a conversation's lanes as objects, from press to release. Only `finish` changes the
project, in one step.
"""

from __future__ import annotations

from PySide6.QtCore import QPointF

from app.features.conversation.segment_hits import SegmentHit, snapped, word_edges
from app.features.conversation.segment_host import SegmentHost
from app.project.document import Edit
from app.translation import tr
from app.widgets.gesture import Gesture, PressDrag, Reason
from metagraph.graph.conversation import edits as conversation_edits
from metagraph.graph.edit_error import EditError

CATCH = 3.0  # pixels the mouse must move for a press to become a drag


class SegmentDrag(PressDrag):
    """What drags of segments share: what it would make is shown while it lasts, and made at its end. words:
    beside the pointer.
    """

    text = ""

    catch = CATCH

    def __init__(self, view: SegmentHost, hit: SegmentHit) -> None:
        super().__init__()
        self.view, self.hit = view, hit
        self.words = ""
        self.seconds = 0.0  # where the words stand
        self.made: Edit | None = None

    def update(self, at: QPointF, free: bool = False) -> None:
        if not self.caught(QPointF(at.x(), self.origin.y())):
            return
        self.made = self.edit(at, free)
        self.view.hold(self.made)

    def finish(self, at: QPointF) -> None:
        self.view.hold(None)
        if self.begun and self.made is not None:
            self.view.editing.edit(self.text, self.made)

    def cancel(self, reason: Reason) -> None:
        self.view.hold(None)

    def edit(self, at: QPointF, free: bool) -> Edit | None:
        """Return what releasing the button now would do."""
        raise NotImplementedError

    def snapped(self, seconds: float, free: bool) -> float:
        """Return a time, caught by where a word begins or ends."""
        of = self.view.editing.conversation
        words = of.sides[self.hit.side].words if of is not None else ()
        return snapped(seconds, word_edges(words, seconds), self.view.scale(), not free)


class EdgeDrag(SegmentDrag):
    """Drags where a segment begins or ends."""

    text = tr("Change segment")

    def edit(self, at: QPointF, free: bool) -> Edit | None:
        view, hit, ident = self.view, self.hit, self.view.session.onstage.conversation
        segment = view.editing.segment((hit.side, hit.at))
        if segment is None or ident is None:
            return None
        before = segment.start if hit.part == "start" else segment.end
        to = self.snapped(before + (at.x() - self.origin.x()) / view.each, free)
        self.words, self.seconds = f"{max(0.0, to):.2f} s  ({to - before:+.2f})", to
        return lambda p: conversation_edits.resize_segment(p, ident, hit.side, hit.at, **{hit.part: to})


class BodyDrag(SegmentDrag):
    """Drags a segment in time; whichever of its ends is nearer to a word's catches it. Let go without moving
    it, it alone is selected.
    """

    text = tr("Move segment")

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
        self.words, self.seconds = f"{max(0.0, segment.start + by):.2f} s  ({by:+.2f})", segment.start + by
        return lambda p: conversation_edits.move_segment(p, ident, hit.side, hit.at, by)


class PeakDrag(SegmentDrag):
    """Drags the stress of a clause; where the pitch is highest catches it."""

    text = tr("Move stress")

    def edit(self, at: QPointF, free: bool) -> Edit | None:
        view, hit, of = self.view, self.hit, self.view.editing.conversation
        segment, ident = view.editing.segment((hit.side, hit.at)), self.view.session.onstage.conversation
        if segment is None or segment.peak is None or of is None or ident is None:
            return None
        heard = view.sounds.of(of, hit.side)
        to = segment.peak + (at.x() - self.origin.x()) / view.each
        tops = [m for m in (heard.maxima if heard is not None else ()) if segment.start <= m <= segment.end]
        to = min(max(segment.start, snapped(to, tops, view.scale(), not free)), segment.end)
        self.words, self.seconds = tr("Stress at {to:.2f} s", to=to), to
        return lambda p: conversation_edits.set_peak(p, ident, hit.side, hit.at, to)


class NewDrag(SegmentDrag):
    """Draws a new segment where none is."""

    text = tr("Add segment")

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


class Scrub(PressDrag):
    """Moves the playhead with the mouse."""

    def __init__(self, view: SegmentHost) -> None:
        super().__init__()
        self.view, self.before = view, view.session.transport.seconds

    def begin(self, at: QPointF) -> None:
        super().begin(at)
        self.view.session.transport.set_playing(False)
        self.update(at)

    def update(self, at: QPointF, free: bool = False) -> None:
        self.view.session.transport.seek(
            self.view.scale().seconds(max(at.x(), self.view.scale().x(self.view.first)))
        )

    def finish(self, at: QPointF) -> None:
        """The playhead is where it is."""

    def cancel(self, reason: Reason) -> None:
        self.view.session.transport.seek(self.before)


class SegmentPan(PressDrag):
    """Moves along in time with the mouse."""

    def __init__(self, view: SegmentHost) -> None:
        super().__init__()
        self.view, self.before = view, view.first

    def update(self, at: QPointF, free: bool = False) -> None:
        self.view.look_at(self.before - (at.x() - self.origin.x()) / self.view.each)

    def finish(self, at: QPointF) -> None:
        """What is in sight is."""

    def cancel(self, reason: Reason) -> None:
        self.view.look_at(self.before)


def _can(view: SegmentHost, edit: Edit) -> bool:
    try:
        edit(view.document.project)
    except EditError:
        return False
    return True


def gesture_for(view: SegmentHost, hit: SegmentHit) -> Gesture:
    """Return what a press on something begins."""
    if hit.part in ("start", "end"):
        return EdgeDrag(view, hit)
    if hit.part == "body":
        return BodyDrag(view, hit)
    if hit.part == "peak":
        return PeakDrag(view, hit)
    return NewDrag(view, hit) if hit.part == "gap" else Scrub(view)
