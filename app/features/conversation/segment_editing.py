"""What is done with the segments of the conversation on stage, each one undo step: by key, by menu, by mouse
alike.
"""

from __future__ import annotations

from collections.abc import Callable, Collection
from typing import Any

import numpy as np
from PySide6.QtCore import QObject, Signal

from app.features.conversation.segment_lanes import KINDS
from app.features.conversation.sound_reading import SideSound, Sounds
from app.project.document import Document, Edit
from app.stage.session import StageSession
from app.translation import tr, tr_error, tr_plural
from metagraph.graph.conversation import edits as conversation_edits
from metagraph.graph.conversation.model import SPOKEN, Conversation, Segment, Sound
from metagraph.graph.edit_error import EditError
from metagraph.graph.model import Project

NEW = 0.6  # seconds of a segment that is added by key
Place = tuple[int, int]  # side, and the place among its segments


class Editing(QObject):
    """Holds which segments are selected. changed: others are selected."""

    changed = Signal()

    def __init__(
        self, document: Document, session: StageSession, sounds: Sounds, parent: QObject | None = None
    ) -> None:
        super().__init__(parent)
        self.document, self.session, self.sounds = document, session, sounds
        self.chosen: frozenset[Place] = frozenset()
        self.last: Place | None = None  # the one selected last: where keys go on from
        self._ident: str | None = None  # of the conversation on stage
        document.changed.connect(self._follow)
        session.onstage.conversation_changed.connect(self._staged)

    @property
    def conversation(self) -> Conversation | None:
        """The conversation on stage."""
        return self.document.project.conversations.get(self.session.onstage.conversation or "")

    def segment(self, place: Place | None) -> Segment | None:
        of = self.conversation
        if of is None or place is None or not 0 <= place[1] < len(of.sides[place[0]].segments):
            return None
        return of.sides[place[0]].segments[place[1]]

    # --- selecting

    def select(self, places: Collection[Place], last: Place | None = None) -> None:
        chosen = frozenset(places)
        last = last if last in chosen else min(chosen, default=None)
        if (chosen, last) != (self.chosen, self.last):
            self.chosen, self.last = chosen, last
            self.changed.emit()

    def select_all(self) -> None:
        of = self.conversation
        if of is not None:
            self.select(
                {(side, n) for side, one in enumerate(of.sides) for n in range(len(one.segments))}, self.last
            )

    def step(self, by: int) -> bool:
        """Select the segment before or after on the same side; the first from the playhead on where none is.
        False at the ends.
        """
        of = self.conversation
        if of is None:
            return False
        if self.last is None:
            side = next((n for n, one in enumerate(of.sides) if one.segments), 0)
            return self._select_near(side, self.session.transport.seconds)
        side, at = self.last
        if not 0 <= at + by < len(of.sides[side].segments):
            return False
        self.select({(side, at + by)})
        return True

    def cross(self, by: int) -> None:
        """Select what the one above or below says at that time."""
        found, of = self.segment(self.last), self.conversation
        side = (self.last[0] if self.last is not None else 0) + by
        side = min(max(0, side), len(of.sides) - 1 if of is not None else 0)
        self._select_near(side, found.start if found is not None else self.session.transport.seconds)

    def _staged(self) -> None:
        if (
            self.session.onstage.conversation != self._ident
        ):  # else it is another of those who talk that the timeline shows
            self._ident = self.session.onstage.conversation
            self.select(())

    def _select_near(self, side: int, seconds: float) -> bool:
        of = self.conversation
        segments = of.sides[side].segments if of is not None else ()
        if not segments:
            return False
        at = next((n for n, s in enumerate(segments) if s.end > seconds), len(segments) - 1)
        self.select({(side, at)})
        return True

    def _follow(self, before: Project, after: Project) -> None:
        """Keep what is selected while it is there: by its place, or where there are more or fewer now by when
        it begins.
        """
        ident = self.session.onstage.conversation or ""
        was, now = before.conversations.get(ident), after.conversations.get(ident)
        if was is now or not self.chosen:
            return
        kept: set[Place] = set()
        for side, at in self.chosen:
            if was is None or now is None:
                break
            old, new = was.sides[side].segments, now.sides[side].segments
            if len(old) == len(new):
                kept.add((side, at))
            elif at < len(old):
                kept |= {(side, n) for n, s in enumerate(new) if s.start == old[at].start}
        self.select(kept, self.last)

    # --- edits

    def edit(self, text: str, function: Edit) -> bool:
        """Change the project in one step; what cannot be done is reported in the status bar. Return whether
        it was done.
        """
        try:
            self.document.edit(text, function)
        except EditError as error:
            self.document.failed.emit(f"{tr_error(error)[:1].upper()}{tr_error(error)[1:]}.")
            return False
        return True

    def change(self, text: str, function: Callable[..., Project], *more: Any, **fields: Any) -> bool:
        """Do one of the edits of `conversing` to the conversation on stage."""
        ident = self.session.onstage.conversation
        return ident is not None and self.edit(text, lambda p: function(p, ident, *more, **fields))

    def relabel(self, kind: Sound) -> None:
        if self.chosen:
            self.change(
                tr(
                    "Label {segments} as {kind}",
                    segments=tr_plural("{count:,} segment", "{count:,} segments", len(self.chosen)),
                    kind=KINDS[kind],
                ),
                conversation_edits.relabel_segments,
                self.chosen,
                kind,
            )

    def relabel_next(self) -> None:
        """Label the selected segment as what comes next: clause, response, hesitation."""
        found = self.segment(self.last)
        if found is not None:
            self.relabel(SPOKEN[(SPOKEN.index(found.kind) + 1) % len(SPOKEN)])

    def remove(self) -> None:
        if not self.chosen:
            return
        side, at = min(self.chosen)
        if self.change(
            tr("Remove {what}", what=tr_plural("{count:,} segment", "{count:,} segments", len(self.chosen))),
            conversation_edits.remove_segments,
            self.chosen,
        ):
            of = self.conversation
            left = len(of.sides[side].segments) if of is not None else 0
            self.select({(side, min(at, left - 1))} if left else ())

    def split(self, seconds: float, place: Place | None = None) -> None:
        """Part a segment: the given one, else the selected one or any that lasts at that time."""
        place = place or self.under(seconds)
        found = self.segment(place)
        if place is None or found is None:
            self.document.failed.emit(
                tr(
                    "There is no segment here. Move the playhead or the pointer to where you want to split "
                    "one."
                )
            )
            return
        second = found.peak is None or found.peak < seconds
        peak = self.highest(place[0], *((seconds, found.end) if second else (found.start, seconds)))
        if self.change(tr("Split segment"), conversation_edits.split_segment, *place, seconds, peak):
            self.select({place, (place[0], place[1] + 1)}, place)

    def under(self, seconds: float) -> Place | None:
        """Return the segment that lasts at a time: a selected one first."""
        of = self.conversation
        if of is None:
            return None
        found = [
            (side, n)
            for side, one in enumerate(of.sides)
            for n, s in enumerate(one.segments)
            if s.start < seconds < s.end
        ]
        return next((p for p in found if p in self.chosen), found[0] if found else None)

    def address(self, to: int | None) -> None:
        """Say whom the selected segments are said to; None: it is inferred."""
        self.change(tr("Set addressee"), conversation_edits.address_segments, self.chosen, to)

    def merge(self) -> None:
        """Merge the selected segments of the side, with all between them; a single one with the next."""
        if self.last is None:
            return
        side = self.last[0]
        places = [at for s, at in self.chosen if s == side]
        first, last = min(places), max(places)
        if self.change(
            tr("Merge segments"), conversation_edits.merge_segments, side, first, max(last, first + 1)
        ):
            self.select({(side, first)})

    def add(self, side: int, kind: Sound, start: float, end: float) -> None:
        """Add a segment where none is; its stress is where the voice is highest."""
        made = -1

        def edit(project: Project) -> Project:
            nonlocal made
            assert self.session.onstage.conversation is not None
            peak = self.highest(side, start, end)
            project, made = conversation_edits.add_segment(
                project, self.session.onstage.conversation, side, kind, start, end, peak
            )
            return project

        if self.conversation is not None and self.edit(tr("Add segment"), edit):
            self.select({(side, made)})

    def add_here(self) -> None:
        """Add a segment at the playhead, on the side of the selected one, as long as there is room."""
        self.add(
            self.last[0] if self.last is not None else 0,
            "clause",
            self.session.transport.seconds,
            self.session.transport.seconds + NEW,
        )

    def nudge(self, by: float, what: str) -> None:
        """Move the selected segment ("body"), or one of its ends ("start", "end")."""
        found = self.segment(self.last)
        if found is None or self.last is None:
            return
        if what == "body":
            self.change(tr("Move segment"), conversation_edits.move_segment, *self.last, by)
        else:
            self.change(
                tr("Change segment"),
                conversation_edits.resize_segment,
                *self.last,
                **{what: getattr(found, what) + by},
            )

    def stress(self, seconds: float) -> None:
        """Put the stress of the selected segment at a time; out of it, where the voice is highest in it."""
        found = self.segment(self.last)
        if found is None or self.last is None:
            return
        inside = found.start <= seconds <= found.end
        peak = seconds if inside else self.highest(self.last[0], found.start, found.end)
        if peak is None:
            self.document.failed.emit(
                tr("No pitch was found in this segment. Move the playhead to the stressed place inside it.")
            )
        else:
            self.change(tr("Move stress"), conversation_edits.set_peak, *self.last, peak)

    def highest(self, side: int, start: float, end: float) -> float | None:
        """Return when in a stretch the voice is highest; None if none is heard."""
        of = self.conversation
        heard = self.sounds.of(of, side) if of is not None else None
        return find_highest_pitch(heard, min(start, end), max(start, end)) if heard is not None else None


def find_highest_pitch(heard: SideSound, start: float, end: float) -> float | None:
    """Return when in a stretch a pitch is highest; None if there is none."""
    if heard.pitch is None:
        return None
    rate = heard.pitch.rate
    first, last = max(0, int(np.ceil(start * rate))), int(end * rate) + 1
    some = heard.pitch.highs[0][first:last]
    if not len(some) or not np.isfinite(some).any():
        return None
    return (first + int(np.argmax(some))) / rate
