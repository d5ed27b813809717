"""Drag a pinned hand."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from PySide6.QtCore import QPointF

from app.features.timing_editor.drags.host import Host
from app.features.timing_editor.drags.rows import SNAP, RowsDrag
from app.features.timing_editor.kept_rows import KeptPart, change
from app.features.timing_editor.track import Facts
from app.translation import tr
from app.widgets.vocabulary import get_vocabulary_word
from metagraph.playback.timing.handles import WORDS
from metagraph.suggest.jumps.snapping import Snap, find_nearest_snap


class KeptDrag(RowsDrag):
    """Changes the start, end or time of a pinned hand. The clip is made again when the mouse is released;
    until then the character shows the moment.
    """

    def __init__(self, host: Host, facts: Facts, name: str, playhead: float | None) -> None:
        super().__init__(host, facts)
        part = KeptPart.of(name)
        assert part is not None
        self.part = part
        self.kept = self.now = next(k for k in facts.kept if k.place == part.place)
        self.snaps = tuple(_snaps(facts, playhead)) if part.end else ()

    def update(self, at: QPointF, free: bool = False) -> None:
        if not self.caught(at):
            return
        host, last = self.host, self.facts.entry.duration
        by = (at.x() - self.origin.x()) / host.axis.each
        if self.part.end:
            was = float(getattr(self.kept, self.part.end))
            snap = None if free else find_nearest_snap(self.snaps, was + by, SNAP / host.axis.each)
            moment = min(max(0.0, snap.at if snap is not None else was + by), last)
            self.now = self.kept.with_end(self.part.end, moment)
        else:
            snap = None
            by = min(max(by, -self.kept.first), last - self.kept.last)
            self.now = replace(self.kept, first=self.kept.first + by, last=self.kept.last + by)
            moment = self.now.first
        kept = tr("held {first:.2f} to {last:.2f} s", first=self.now.first, last=self.now.last)
        host.held = f"{self.kept.hand} {kept if self.now.last > self.now.first else tr('released')}"
        host.snapped, host.snaps, host.stretched = snap, self.snaps, (self.facts.action.id, self.now)
        host.transport.scrub(self.facts.action.clip, moment)
        host.update()

    def finish(self, at: QPointF) -> None:
        if self.begun and self.now != self.kept:
            change(self.host, self.facts, self.now)
        self.over()


def _snaps(facts: Facts, playhead: float | None) -> Iterator[Snap]:
    for handle in facts.handles:
        if handle.name not in ("in", "out"):
            yield Snap(handle.at, tr("the action's {handle}", handle=get_vocabulary_word(WORDS[handle.name])))
    for stay in facts.stays:
        yield Snap(stay.first, tr("start of the inserted hold"))
        yield Snap(stay.last, tr("end of the inserted hold"))
    if playhead is not None:
        yield Snap(playhead, tr("the playhead"))
