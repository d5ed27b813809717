"""Edit the timeline of what is on stage: the loop range, markers, locked layers, cuts; and which marker is
selected.
"""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QObject, Signal

from app.project.document import Document
from app.stage.session import StageSession
from app.translation import tr, tr_plural
from metagraph.graph import timeline_edits as notes
from metagraph.graph.conversation.model import Conversation
from metagraph.graph.model import Project
from metagraph.graph.timeline import (
    IMPROVISED,
    SAME_CUT,
    SHORTEST_RANGE,
    Cut,
    Lane,
    Marker,
    Shot,
    Timeline,
    with_cut,
)

NEAR = 0.02  # seconds within which the playhead is on a marker


class TimelineEdits(QObject):
    """Edits a timeline. `changed` is emitted if it changed, or another marker is selected. `length` returns
    the seconds of what is on stage. `marker` is the id of the selected one.
    """

    changed = Signal()

    def __init__(
        self,
        document: Document,
        session: StageSession,
        length: Callable[[], float],
        parent: QObject | None = None,
    ) -> None:
        super().__init__(parent)
        self.document, self.session, self._length = document, session, length
        self.marker: str | None = None
        document.changed.connect(self._edited)
        document.loaded.connect(lambda: self.select(None))
        session.onstage.performance_changed.connect(self._restaged)
        session.onstage.conversation_changed.connect(self._restaged)

    @property
    def key(self) -> str:
        """Return the id of what is on stage, by which its timeline is kept."""
        onstage = self.session.onstage
        if onstage.mode == "manual":
            return IMPROVISED
        return onstage.conversation or onstage.performance or IMPROVISED

    @property
    def now(self) -> Timeline:
        return notes.get_timeline(self.document.project, self.key)

    def _edited(self, before: Project, after: Project) -> None:
        if before.timelines is not after.timelines:
            if self.marker is not None and self.selected is None:
                self.marker = None
            self.changed.emit()

    def _restaged(self) -> None:
        if self.session.onstage.requests or self.selected is None:
            self.select(None)

    def change(self, text: str, merge: str | None = None, **changes: object) -> None:
        """Set fields of the timeline; one step to undo."""
        key = self.key
        self.document.edit(text, lambda p: notes.change_timeline(p, key, **changes), merge)

    # --- the range

    @property
    def range(self) -> tuple[float, float] | None:
        """Return the first and last second of the loop range; None for everything."""
        return self.now.range

    def set_range(self, start: float, end: float) -> None:
        """Loop between `start` and `end`, in either order; a range too short to be meant is ignored."""
        start, end = sorted((round(max(0.0, start), 3), round(max(0.0, end), 3)))
        if end - start >= SHORTEST_RANGE:
            self.change(tr("Set loop range"), range=(start, end))

    def set_in(self, at: float | None = None) -> None:
        """Begin the range at a time, by default the playhead."""
        start = self.session.transport.seconds if at is None else at
        end = self.range[1] if self.range is not None else self._length()
        self.set_range(start, end if end - start >= SHORTEST_RANGE else max(self._length(), start + 1.0))

    def set_out(self, at: float | None = None) -> None:
        """End the range at a time, by default the playhead."""
        end = self.session.transport.seconds if at is None else at
        start = self.range[0] if self.range is not None else 0.0
        self.set_range(start if end - start >= SHORTEST_RANGE else 0.0, end)

    def clear_range(self) -> None:
        self.change(tr("Clear loop range"), range=None)

    # --- markers

    @property
    def selected(self) -> Marker | None:
        return next((m for m in self.now.markers if m.id == self.marker), None)

    def select(self, ident: str | None) -> None:
        """Select a marker, which deselects requests; None for none."""
        if ident is not None and self.session.onstage.requests:
            self.session.onstage.select_requests(())
        if ident != self.marker:
            self.marker = ident
            self.changed.emit()

    def add_marker(self, at: float | None = None, name: str = "") -> str:
        """Add a marker at a time, by default the playhead, and select it; return its id."""
        made, key = "", self.key
        seconds = self.session.transport.seconds if at is None else at

        def edit(project: Project) -> Project:
            nonlocal made
            project, made = notes.add_marker(project, key, seconds, name)
            return project

        self.document.edit(tr("Add marker"), edit)
        self.select(made)
        return made

    def move_marker(self, ident: str, at: float, merge: str | None = None) -> None:
        key = self.key
        self.document.edit(
            tr("Move marker"), lambda p: notes.change_marker(p, key, ident, at=round(max(0.0, at), 3)), merge
        )

    def rename_marker(self, ident: str, name: str) -> None:
        key, words = self.key, " ".join(name.split())[:200]
        self.document.edit(tr("Rename marker"), lambda p: notes.change_marker(p, key, ident, name=words))

    def remove_marker(self, *idents: str) -> None:
        """Remove markers; all of them if none is named."""
        key, gone = self.key, idents or tuple(m.id for m in self.now.markers)
        text = tr_plural("Remove {count:,} marker", "Remove {count:,} markers", len(gone))
        self.document.edit(text, lambda p: notes.remove_markers(p, key, gone))

    def jump(self, step: int) -> None:
        """Go to the next marker, or with -1 to the previous one, and select it."""
        at, markers = self.session.transport.seconds, self.now.markers
        found = (
            next((m for m in markers if m.at > at + NEAR), None)
            if step > 0
            else next((m for m in reversed(markers) if m.at < at - NEAR), None)
        )
        if found is not None:
            self.session.transport.show_plan()
            self.session.transport.seek(found.at)
            self.select(found.id)

    # --- layers and cameras

    def lock(self, lane: Lane, on: bool) -> None:
        """Lock a lane, so that its requests cannot be moved or removed, or unlock it."""
        locked = tuple(
            x for x in ("stage", "body", "arms", "head") if (on if x == lane else x in self.now.locked)
        )
        self.change(tr("Lock layer") if on else tr("Unlock layer"), locked=locked)

    def cut_to(self, shot: Shot, side: int, at: float) -> None:
        """Cut to a shot at a time; the first cut of a conversation also adds one at its beginning."""
        cuts = self.now.cuts
        if not cuts and at > SAME_CUT:
            cuts = (Cut(at=0.0, shot="two"),)
        self.set_cuts(tr("Cut"), with_cut(cuts, Cut(at=round(max(0.0, at), 3), shot=shot, side=side)))

    def move_cut(self, number: int, at: float) -> None:
        cuts = list(self.now.cuts)
        cuts[number] = Cut(at=round(at, 3), shot=cuts[number].shot, side=cuts[number].side)
        self.set_cuts(tr("Move cut"), tuple(cuts))

    def remove_cut(self, number: int) -> None:
        """Remove a cut: the shot before it continues."""
        self.set_cuts(tr("Remove cut"), tuple(c for n, c in enumerate(self.now.cuts) if n != number))

    def automatic(self, talk: Conversation) -> None:
        """Cut by who speaks."""
        from metagraph.speech.automatic_cuts import make_automatic_cuts

        self.set_cuts(tr("Automatic cuts"), make_automatic_cuts(talk))

    def set_cuts(self, text: str, cuts: tuple[Cut, ...]) -> None:
        self.change(text, cuts=cuts)

    def show_captions(self, on: bool) -> None:
        self.change(tr("Show captions") if on else tr("Hide captions"), captions=on)
