"""Hold the performance: the plan for the current project, and the pose at the playhead. It is derived, never
saved.

The plan is a pure function of (project, requests, seed, stances, length). It is made again on a thread after
each edit, and the old one plays until the new one is ready.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

import msgspec
from PySide6.QtCore import QObject, QTimer, Signal

from app.project.document import Document
from app.project.jobs import Jobs
from app.stage.conversation_plans import ConversationPlans, keep_conversation
from app.stage.live_control import LiveControl
from app.stage.playback_source import ShownPlayback, play_clip_alone, play_in_context, play_manual
from app.stage.prop_contacts import put_on_props
from app.stage.props import PropFigures
from app.stage.request_edits import SOON, RequestEdits
from app.stage.session import StageSession
from app.stage.timeline_edits import TimelineEdits
from app.translation import tr, tr_phrase
from metagraph.graph.model import LAYERS, Layer, Project
from metagraph.graph.requests import AnyRequest
from metagraph.graph.timeline_edits import differs_only_in_timeline
from metagraph.motion.skeleton import Pose, Skeleton
from metagraph.playback.manual_playback import Fire
from metagraph.playback.plan import Plan
from metagraph.playback.planning.extend_performance import AskAnswer, answer_asks
from metagraph.playback.planning.running_plan import improvise, list_kept_asks, plan_performance

LENGTH = 60.0  # seconds planned ahead, and added whenever the playhead comes near the end
BEFORE = 1.0  # seconds before a shown moment at which playback stops
AHEAD = 15.0  # seconds before the end at which more is planned


class StagePerformance(QObject):
    """The performance on stage.

    `changed` is emitted if something else plays, or the same was planned again. `requests` edits the
    requests, `timeline` the notes beside them. `live` begins and ends live play. `muted` has layers that rest
    for the time being. `directed` are requests of the moment, such as those of a parameter that is tried;
    they are never saved. `before` is the state of the project from which clips and actions are shown instead.
    `staged` is the whole performance as it was last shown, None before; a clip or an action may be shown now.
    """

    changed = Signal()

    def __init__(
        self,
        document: Document,
        session: StageSession,
        jobs: Jobs,
        parent: QObject | None = None,
        props: PropFigures | None = None,
    ) -> None:
        super().__init__(parent)
        self.document, self.session, self.jobs, self._props = document, session, jobs, props
        self.length = LENGTH
        self.shown = ShownPlayback(document.project, Plan(1, 0.0), LENGTH)
        self.staged: ShownPlayback | None = None
        self.muted: frozenset[Layer] = frozenset()
        self._busy = self._again = False
        self._soon = QTimer(self, singleShot=True, interval=0)
        self._soon.timeout.connect(self._replan)
        document.loaded.connect(self._loaded)
        document.changed.connect(self._edited)
        session.transport.show_changed.connect(self.replan)
        session.onstage.performance_changed.connect(self._staged)
        session.onstage.mode_changed.connect(self._switched)
        session.onstage.conversation_changed.connect(self._conversed)
        self.conversations = ConversationPlans()
        self._noted: tuple[str, ...] = ()  # about a conversation, reported once
        self._fires: tuple[Fire, ...] = ()  # triggers of the manual state machine, fired since it began
        self.directed: tuple[AnyRequest, ...] = ()
        self._directions = 0
        self._on_stage = session.onstage.performance, session.onstage.improvised
        self.live = LiveControl(document, session, self)
        self.live.changed.connect(self.replan)
        self.live.ticked.connect(self._ticked)
        self.requests = RequestEdits(
            document, session, self.live, lambda: self.length, lambda: self.timeline.now.locked
        )
        self.timeline = TimelineEdits(document, session, lambda: self.shown.length, self)
        self.before: Project | None = None
        self._answered: ShownPlayback | None = None
        if props is not None:
            props.changed.connect(self._rest)
        self._answers: dict[str, AskAnswer] = {}

    # --- what plays

    def replan(self) -> None:
        """Plan again soon; many calls in a row make one plan."""
        self._soon.start()

    def mute(self, layers: Iterable[Layer]) -> None:
        """Make these layers, and no others, rest in their stances for the time being; plans and exports do
        not change.
        """
        muted = frozenset(layers)
        if muted != self.muted:
            self.muted = muted
            self.shown = self._rested(replace(self.shown, muted=muted))
            self.changed.emit()

    def compare(self, before: Project | None) -> None:
        """Show single clips and actions as they were in another state of the project, with what they are now
        as a ghost; for None, only as they are.
        """
        if before is not self.before:
            self.before = before
            self.replan()

    def _loaded(self) -> None:
        self.before = self.staged = None
        self.muted = frozenset()
        self.directed = ()
        self._directions = 0
        self.live.end()
        self.live.last = None
        self.length = LENGTH
        self._fires = ()
        self.session.onstage.improvised = "talking"
        self.session.onstage.set_performance(None)

    def _staged(self) -> None:
        onstage = self.session.onstage
        if (onstage.performance, onstage.improvised) != self._on_stage:
            self._on_stage = onstage.performance, onstage.improvised
            self.length = self.requests.kept.length if self.requests.kept is not None else LENGTH
            self.directed = ()
            self.replan()

    def _conversed(self) -> None:
        self._noted = ()
        self.length = self._own_length or LENGTH
        self.session.transport.show_plan()
        self.replan()

    @property
    def conversation(self) -> str | None:
        """Return the conversation on stage."""
        found = (
            self.session.onstage.conversation
            if self.session.onstage.mode == "meta" and self.live.stage is None
            else None
        )
        return found if found in self.document.project.conversations else None

    @property
    def ends(self) -> bool:
        """Return whether what is on stage has an end; the models improvise without end."""
        return self._own_length is not None

    @property
    def _own_length(self) -> float | None:
        """Return the seconds of what is kept and on stage; None while the models improvise, without end."""
        if self.conversation is not None:
            return self.document.project.conversations[self.conversation].length
        return self.requests.kept.length if self.requests.kept is not None else None

    def is_documents(self, shown: ShownPlayback) -> bool:
        """Return whether what is shown, one of a conversation perhaps, plays the document's own graph."""
        talk = self.document.project.conversations.get(self.conversation or "")
        if talk is None or shown.folder is None:
            return shown.folder is None
        return shown.side < len(talk.sides) and talk.sides[shown.side].project is None

    def keep_conversation(self) -> None:
        """Keep what all speakers do as performances, which can be edited request by request and exported."""
        ident, shown = self.conversation, self.shown
        made: tuple[str, ...] = ()

        def edit(project: Project) -> Project:
            nonlocal made
            project, made = keep_conversation(project, ident or "", shown)
            return project

        if ident is not None and shown.others:
            self.document.edit(tr("Keep as performances"), edit)
            if made:
                self.session.onstage.set_performance(made[0])

    def _switched(self) -> None:
        self.live.end()
        self._fires = ()
        self.directed = ()
        self.length = LENGTH
        self.replan()

    def fire(self, trigger: str) -> None:
        """Fire a trigger of the layer's manual state machine, now."""
        self.session.transport.show_plan()
        at = round(self.session.transport.seconds + SOON, 3)
        # Triggers fired later, before the playhead was set back, are removed.
        self._fires = (*(f for f in self._fires if f.at < at), Fire(self.session.place.layer, trigger, at))
        self.session.transport.set_playing(True)
        self.replan()

    def direct(self, ask: AnyRequest, instead_of: str = "") -> str:
        """Request something of what is on stage, now, without keeping it; return the request's id. A
        conversation or a manual state machine leaves the stage to the models. instead_of: an earlier request,
        which is forgotten if it has not begun.
        """
        self._directions += 1
        ident = f"directed{self._directions}"
        if self.live.stage is not None:
            self.live.stage.ask(msgspec.structs.replace(ask, id=ident))
            return ident
        onstage, transport = self.session.onstage, self.session.transport
        onstage.set_mode("meta")
        onstage.set_conversation(None)
        transport.show_plan()
        now = transport.seconds
        at = round(now + SOON, 3)
        # What was directed later, before the playhead was set back, is removed.
        kept = [x for x in self.directed if (x.at or 0.0) <= at]
        kept = [x for x in kept if x.id != instead_of or (x.at or 0.0) <= now]
        self.directed = (*kept, msgspec.structs.replace(ask, id=ident, at=at))
        transport.set_playing(True)
        self.replan()
        return ident

    def _edited(self, before: Project, after: Project) -> None:
        if differs_only_in_timeline(before, after):
            return
        if self._own_length is not None:
            self.length = self._own_length
        if before.skeleton is not after.skeleton or after.skeleton is None:
            self.live.end()
            self.shown = ShownPlayback(after, Plan(1, 0.0), LENGTH)
            self.changed.emit()
        if self.live.stage is not None:
            self.live.stage.change(after)
        self.replan()

    def _replan(self) -> None:
        if self.live.stage is not None and self.session.transport.show == "plan":
            self._ticked()
            return
        if self._busy:
            self._again = True
            return
        self._busy, self._again = True, False
        project, kept, length = self.document.project, self.requests.kept, self.length
        before = self.before if self.session.transport.show != "plan" else None
        manual, fires = self.session.onstage.mode == "manual", self._fires
        directed = self.directed
        show, shown, anew = (
            self.session.transport.show,
            self.session.transport.shown,
            self.session.transport.tried is not None,
        )
        stances = {layer: s for layer in LAYERS if (s := self.session.place.stance(layer)) is not None}
        layer, mode = self.session.place.layer, self.session.onstage.improvised
        talk, side, folder = self.conversation, self.session.onstage.side, self.document.folder or Path()

        def work(_: object) -> ShownPlayback:
            now = play(project)
            return now if before is None else replace(play(before), beside=now)

        def play(project: Project) -> ShownPlayback:
            if show == "clip" and shown in project.clips:
                return play_clip_alone(project, shown or "")
            if manual:
                known = project.state(shown) is not None or project.link(shown) is not None
                return play_manual(project, length, fires, shown if show == "context" and known else None)
            if show == "context" and shown is not None:
                return play_in_context(project, shown, layer, stances, anew)
            if talk is not None and project.skeleton is not None:
                return self.conversations.show(project, talk, folder, side)
            if kept is None:
                return ShownPlayback(project, improvise(project, length, mode=mode, asks=directed), length)
            asks = (*list_kept_asks(kept), *directed)
            plan = plan_performance(project, asks, length, kept.seed, dict(kept.stances), kept.idle)
            return ShownPlayback(project, plan, length)

        self.jobs.start("plan", work, self._planned, self._failed, quick=True)

    def _planned(self, shown: ShownPlayback) -> None:
        self._busy = False
        if self.live.stage is not None and self.session.transport.show == "plan":
            return
        self.shown = self._rested(replace(shown, muted=self.muted) if self.muted else shown)
        if self.session.transport.show == "plan":
            self.staged = shown
        if shown.notes and shown.notes != self._noted:
            self.document.failed.emit(" ".join(tr_phrase(note) for note in shown.notes))
        self._noted = shown.notes
        self.changed.emit()
        if self._again:
            self.replan()

    def _rested(self, shown: ShownPlayback) -> ShownPlayback:
        """Return what is shown with hands and feet on the props that stand there now."""
        if self._props is None:
            return shown
        own = self.is_documents(shown.everyone[0])
        return put_on_props(shown, self._props.meshes, self.document.project.props if own else None)

    def _rest(self) -> None:
        """Follow props that were moved, added or read."""
        rested = self._rested(self.shown)
        if rested is not self.shown:
            self.shown = rested
            self.changed.emit()

    def _failed(self, error: Exception) -> None:
        self._busy = False
        if self._again:
            self.replan()
        self.document.failed.emit(tr("The plan could not be made: {error}", error=error))

    def _ticked(self) -> None:
        live = self.live.stage
        if live is None or self.session.transport.show != "plan":
            return
        # The part that the running plan no longer has is kept in pieces.
        plan = (
            live.session.plan if self.live.following else live.session.plan_at(self.session.transport.seconds)
        )
        over = live.session.overlay if self.live.following else None
        if plan is not self.shown.plan or (over is None) != (self.shown.over is None):
            self.shown = self.staged = self._rested(
                ShownPlayback(live.session.project, plan, plan.end, over=over, muted=self.muted)
            )
            self.changed.emit()

    def show_moment(self, seconds: float) -> None:
        """Stop a little before a second of the performance that plays by itself; nothing if another
        performance, a conversation or a live session is on stage.
        """
        if self.live.stage is not None or self.conversation is not None or self.requests.kept is not None:
            return
        transport = self.session.transport
        self.session.onstage.improvise("talking")
        transport.show_plan()
        transport.set_playing(False)
        if seconds + AHEAD > self.length:
            self.length = LENGTH * (int((seconds + AHEAD) // LENGTH) + 1)
            self.replan()
        transport.seek(max(0.0, seconds - BEFORE))

    def plan_beyond(self, seconds: float) -> None:
        """Plan further if the playhead comes near the end of an endless performance."""
        if seconds > self.length - AHEAD:
            self.length += LENGTH
            self.replan()

    # --- what was asked for

    @property
    def asks(self) -> tuple[AnyRequest, ...]:
        """Return the requests: of the performance on stage, or the latest of the live one."""
        if self.live.stage is not None:
            return self.live.stage.asks
        if self.conversation is not None:
            return self.shown.asks
        return self.requests.kept.asks if self.requests.kept is not None else ()

    def answers(self) -> dict[str, AskAnswer]:
        """Return what the shown plan does about each request."""
        if self.live.stage is not None:
            return self.live.stage.answers()
        if self._answered is not self.shown:
            self._answered, self._answers = (
                self.shown,
                answer_asks(self.shown.plan, (ask.id for ask in self.asks)),
            )
        return self._answers

    # --- the pose

    def skeleton(self) -> Skeleton | None:
        """Return the skeleton of what plays; a clip shown alone may have its own."""
        return self.shown.skeleton

    def pose(self, seconds: float | None = None) -> Pose | None:
        """Return the pose at the playhead (or at `seconds`), None if there is nothing to show."""
        return self.shown.pose(self.session.transport.seconds if seconds is None else seconds)

    def morphs(self) -> dict[str, float]:
        return self.shown.morphs(self.session.transport.seconds)
