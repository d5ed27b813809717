"""Edit requests: in the performance on stage, in a new one, or live."""

from __future__ import annotations

from collections.abc import Callable, Collection
from typing import cast

import msgspec
from PySide6.QtGui import QGuiApplication

from app.look.plural import list_in_words
from app.project.document import Document
from app.stage.live_control import LiveControl
from app.stage.session import StageSession
from app.translation import tr, tr_error, tr_plural
from metagraph.graph.edit_error import EditError
from metagraph.graph.editing import performances as performance_edits
from metagraph.graph.model import Project
from metagraph.graph.request_text import Pasted, holds_requests, paste_requests, write_request_text
from metagraph.graph.requests import AnyRequest
from metagraph.graph.requests import Performance as KeptPerformance
from metagraph.graph.timeline_edits import find_lane
from metagraph.playback.plan import Plan

SOON = 0.15  # seconds from the playhead to the time of a request for "now", because the plan takes a moment


class RequestEdits:
    """Edits the requests of what is on stage; each edit is one step to undo. `length` returns the planned
    seconds, which a new performance gets. `locked` returns the lanes whose requests cannot be changed. With
    `ripple`, everything that follows moves along with what is moved or removed.
    """

    def __init__(
        self,
        document: Document,
        session: StageSession,
        live: LiveControl,
        length: Callable[[], float],
        locked: Callable[[], Collection[str]] = tuple,
    ) -> None:
        self.document, self.session, self.live, self._length = document, session, live, length
        self._locked = locked
        self.ripple = False

    @property
    def kept(self) -> KeptPerformance | None:
        """Return the kept performance on stage, up to date; None while the models improvise."""
        stage = self.session.onstage.performance if self.session.onstage.mode == "meta" else None
        return self.document.project.performances.get(stage or "")

    @property
    def editable(self) -> bool:
        """Return whether the shown requests can be moved and changed."""
        return self.live.stage is None and self.kept is not None and self.session.transport.show == "plan"

    def still(self) -> frozenset[str]:
        """Return the ids of requests on locked lanes."""
        locked, project = self._locked(), self.document.project
        asks = self.kept.asks if self.kept is not None and locked else ()
        return frozenset(x.id for x in asks if find_lane(x, project) in locked)

    def free(self, idents: tuple[str, ...]) -> tuple[str, ...]:
        """Return those of some requests that are not on locked lanes; report if there are others."""
        still = self.still()
        out = tuple(i for i in idents if i not in still)
        if len(out) < len(idents):
            self.document.failed.emit(
                tr("The layer of these requests is locked. To unlock it, click the padlock beside its name.")
            )
        return out

    def with_following(self, idents: tuple[str, ...]) -> tuple[str, ...]:
        """Return what moves with some requests: with `ripple`, also everything that follows."""
        if not self.ripple or self.kept is None:
            return idents
        return performance_edits.find_following_asks(self.kept, idents, self.still())

    def _begun(self) -> KeptPerformance:
        """Return a performance without requests that does what was improvised."""
        mode = self.session.onstage.improvised
        return KeptPerformance(name=str(tr("Performance")), length=self._length(), mode=mode)

    def ask(self, ask: AnyRequest, text: str = "") -> None:
        """Add a request to the performance on stage or a new one; without a time, as soon as possible."""
        if self.live.stage is not None:
            if ask.at is not None and ask.at <= self.live.stage.now:
                ask = msgspec.structs.replace(ask, at=None)
            self.live.stage.ask(ask)
            return
        if ask.at is None and getattr(ask, "stroke", None) is None:
            ask = msgspec.structs.replace(ask, at=round(self.session.transport.seconds + SOON, 3))
        on_stage = self.session.onstage.performance
        made = on_stage

        def edit(project: Project) -> Project:
            nonlocal made
            if made is None or made not in project.performances:
                kept = self._begun()
                project, made = performance_edits.add_performance(project, kept)
            return performance_edits.add_request(project, made, ask)

        self.document.edit(text or tr("Add request"), edit)
        self.session.onstage.set_performance(made)
        if made is not None:
            self.session.onstage.select_requests((self.document.project.performances[made].asks[-1].id,))
        self.session.transport.show_plan()

    def change(self, ident: str, merge: str | None = None, **changes: object) -> None:
        """Set fields of a request in the performance on stage. Raises EditError."""
        stage = self.session.onstage.performance
        if stage is not None and self.free((ident,)):
            self.document.edit(
                tr("Change request"),
                lambda p: performance_edits.change_request(p, stage, ident, **changes),
                merge,
            )

    def move(self, idents: tuple[str, ...], by: float, merge: str | None = None) -> None:
        """Move requests in time, with `ripple` together with everything that follows."""
        stage, idents = self.session.onstage.performance, self.with_following(self.free(idents))
        if stage is not None and idents:
            self.document.edit(
                tr("Move request"), lambda p: performance_edits.move_requests(p, stage, idents, by), merge
            )

    def copy(self, idents: tuple[str, ...], by: float) -> None:
        """Copy requests to a later or earlier time, by a number of seconds, and select the copies."""
        stage, kept = self.session.onstage.performance, self.kept
        if stage is None or kept is None:
            return
        number = len(kept.asks)
        copies = tuple(msgspec.structs.replace(x, id="", told=None) for x in kept.asks if x.id in idents)

        def edit(project: Project) -> Project:
            project = performance_edits.change_performance(
                project, stage, asks=(*project.performances[stage].asks, *copies)
            )
            return performance_edits.move_requests(
                project, stage, {x.id for x in project.performances[stage].asks[number:]}, by
            )

        self.document.edit(tr_plural("Copy {count:,} request", "Copy {count:,} requests", len(copies)), edit)
        self.session.onstage.select_requests(tuple(x.id for x in (self.kept or kept).asks[number:]))

    def withdraw(self, *idents: str) -> None:
        """Remove requests from the performance on stage; all of them if none is named."""
        stage, kept = self.session.onstage.performance, self.kept
        if stage is None or kept is None:
            return
        gone = self.free(idents or tuple(x.id for x in kept.asks))
        if gone:
            self.document.edit(
                tr("Remove request"), lambda p: performance_edits.remove_requests(p, stage, gone)
            )

    def to_clipboard(self, idents: tuple[str, ...], cut: bool = False) -> None:
        """Put requests on the clipboard, as a text that any window can paste. With `cut`, remove
        them here.
        """
        stage = self.session.onstage.performance
        chosen = self.free(idents) if cut else idents
        if stage is None or self.kept is None or not chosen:
            return
        QGuiApplication.clipboard().setText(write_request_text(self.document.project, stage, chosen))
        if cut:
            self.document.edit(
                tr("Cut requests"), lambda p: performance_edits.remove_requests(p, stage, chosen)
            )

    def paste(self) -> None:
        """Add the requests on the clipboard, the first of them at the playhead, to the performance on stage
        or a new one; report what this project does not have.
        """
        text = QGuiApplication.clipboard().text()
        at, done = round(self.session.transport.seconds, 3), cast("Pasted | None", None)
        if self.live.stage is not None or not holds_requests(text):
            self.document.failed.emit(tr("The clipboard contains no requests."))
            return
        stage = self.session.onstage.performance

        def edit(project: Project) -> Project:
            nonlocal done, stage
            if stage is None or stage not in project.performances:
                kept = self._begun()
                project, stage = performance_edits.add_performance(project, kept)
            done = paste_requests(project, stage, text, at)
            return done.project

        try:
            self.document.edit(tr("Paste requests"), edit)
        except EditError as error:
            self.document.failed.emit(f"{tr_error(error)[:1].upper()}{tr_error(error)[1:]}.")
            return
        self.session.onstage.set_performance(stage)
        self.session.transport.show_plan()
        if done is not None:
            self.session.onstage.select_requests(done.idents)
            if done.left_out:
                self.document.failed.emit(
                    tr("This project does not have {what}.", what=list_in_words(done.left_out))
                )

    def close_up(self, idents: tuple[str, ...], plan: Plan) -> None:
        """Remove requests and move everything that follows up by the time they took in a plan, in
        one step.
        """
        stage, kept = self.session.onstage.performance, self.kept
        gone = self.free(idents)
        if stage is None or kept is None or not gone:
            return
        times = {x.id: performance_edits.ask_time(x) for x in kept.asks if x.id in gone}
        played = [(c.meta.partition("+")[0], c.start, c.end) for of in plan.layers.values() for c in of.cues]
        played += [(s.id, s.start, s.end) for s in plan.track.speeches]
        # Requests with a stroke are timed by it; everything they play is removed, too.
        spans = [
            (min(times[i], start), min(end, kept.length))
            for i, start, end in played
            if i in times and min(times[i], start) < min(end, kept.length)
        ]
        still = self.still()
        self.document.edit(
            tr("Remove request and close the gap"),
            lambda p: performance_edits.close_up_after(p, stage, gone, spans, still),
        )
