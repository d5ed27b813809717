"""The performance: the plan for the project as it is now, and the pose at the playhead. Derived, never saved.

The plan is a pure function of (project, asks, seed, stances, length); it is made anew on a thread after each edit,
and the old one plays until the new one is there.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import msgspec
from PySide6.QtCore import QObject, QTimer, Signal

from app.project.document import Document
from app.project.jobs import Jobs
from app.stage.conversation_plans import Stage, keep
from app.stage.playback_source import Shown, alone, by_hand, in_context
from app.stage.session import Session
from metagraph.graph import staging
from metagraph.graph.asks import AnyAsk, AskError
from metagraph.graph.asks import Performance as KeptPerformance
from metagraph.graph.model import LAYERS, Project
from metagraph.motion.skeleton import Pose, Skeleton
from metagraph.playback.hear import Answer, answers, perform
from metagraph.playback.manual import Fire
from metagraph.playback.plan import Plan
from metagraph.playback.planner import make_plan

if TYPE_CHECKING:
    from app.stage.live_stage import LiveStage
    from metagraph.live.server import Options

LENGTH = 60.0  # seconds planned ahead, and how much more whenever the playhead comes near the end
AHEAD = 15.0  # seconds before the end at which more is planned
SOON = 0.15  # seconds from now at which "now" is: the plan needs a moment


class Performance(QObject):
    """changed: something else plays, or the same was planned anew. live_changed: live begins, ends, or is connected otherwise."""

    changed = Signal()
    live_changed = Signal()

    def __init__(self, document: Document, session: Session, jobs: Jobs, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.document, self.session, self.jobs = document, session, jobs
        self.length = LENGTH
        self.shown = Shown(document.project, Plan(1, 0.0), LENGTH)
        self._busy = self._again = False
        self._soon = QTimer(self, singleShot=True, interval=0)
        self._soon.timeout.connect(self._replan)
        document.loaded.connect(self._loaded)
        document.changed.connect(self._edited)
        session.transport.show_changed.connect(self.replan)
        session.onstage.performance_changed.connect(self._staged)
        session.onstage.mode_changed.connect(self._switched)
        session.onstage.conversation_changed.connect(self._conversed)
        self._stage = Stage()
        self._noted: tuple[str, ...] = ()  # about a conversation, said once
        self._fires: tuple[Fire, ...] = ()  # triggers of the manual state machine, fired since it began
        self._on_stage: str | None = None
        self.live: LiveStage | None = None
        self.following = True  # while live: the playhead is now, not somewhere in the past
        self.last_live: KeptPerformance | None = None  # what was played live last, if anything was asked
        self._answered: Shown | None = None
        self._answers: dict[str, Answer] = {}

    # --- what plays

    def replan(self) -> None:
        """Plan anew, soon; many calls in a row make one plan."""
        self._soon.start()

    def _loaded(self) -> None:
        self.stop_live()
        self.last_live = None
        self.length = LENGTH
        self._fires = ()
        self.session.onstage.set_performance(None)

    def _staged(self) -> None:
        if self.session.onstage.performance != self._on_stage:
            self._on_stage = self.session.onstage.performance
            self.length = self.kept.length if self.kept is not None else LENGTH
            self.replan()

    def _conversed(self) -> None:
        self._noted = ()
        self.length = self._own_length or LENGTH
        self.session.transport.show_plan()
        self.replan()

    @property
    def conversation(self) -> str | None:
        """The conversation on stage."""
        found = self.session.onstage.conversation if self.session.onstage.mode == "meta" and self.live is None else None
        return found if found in self.document.project.conversations else None

    @property
    def ends(self) -> bool:
        """Whether what is on stage has an end of its own; the models improvise for ever."""
        return self._own_length is not None

    @property
    def _own_length(self) -> float | None:
        """Seconds of what is kept and on stage; None while the models improvise, for ever."""
        if self.conversation is not None:
            return self.document.project.conversations[self.conversation].length
        return self.kept.length if self.kept is not None else None

    def keep_conversation(self) -> None:
        """Keep what both do as performances, which can be edited ask by ask and exported."""
        ident, shown = self.conversation, self.shown
        made: tuple[str, ...] = ()

        def edit(project: Project) -> Project:
            nonlocal made
            project, made = keep(project, ident or "", shown)
            return project

        if ident is not None and shown.partner is not None:
            self.document.edit("Keep as performances", edit)
            if made:
                self.session.onstage.set_performance(made[0])

    def _switched(self) -> None:
        self.stop_live()
        self._fires = ()
        self.length = LENGTH
        self.replan()

    def fire(self, trigger: str) -> None:
        """Fire a trigger of the layer's manual state machine, now."""
        self.session.transport.show_plan()
        at = round(self.session.transport.seconds + SOON, 3)
        # What was fired later, before the playhead was set back, never was.
        self._fires = (*(f for f in self._fires if f.at < at), Fire(self.session.place.layer, trigger, at))
        self.session.transport.set_playing(True)
        self.replan()

    def _edited(self, before: Project, after: Project) -> None:
        if self._own_length is not None:
            self.length = self._own_length
        if before.skeleton is not after.skeleton or after.skeleton is None:
            self.stop_live()
            self.shown = Shown(after, Plan(1, 0.0), LENGTH)
            self.changed.emit()
        if self.live is not None:
            self.live.change(after)
        self.replan()

    def _replan(self) -> None:
        if self.live is not None and self.session.transport.show == "plan":
            self._ticked()
            return
        if self._busy:
            self._again = True
            return
        self._busy, self._again = True, False
        project, kept, length = self.document.project, self.kept, self.length
        manual, fires = self.session.onstage.mode == "manual", self._fires
        show, shown, anew = self.session.transport.show, self.session.transport.shown, self.session.transport.tried is not None
        stances = {layer: s for layer in LAYERS if (s := self.session.place.stance(layer)) is not None}
        layer = self.session.place.layer
        talk, side, folder = self.conversation, self.session.onstage.side, self.document.folder or Path()

        def work(_: object) -> Shown:
            if show == "clip" and shown in project.clips:
                return alone(project, shown or "")
            if manual:
                known = project.state(shown) is not None or project.link(shown) is not None
                return by_hand(project, length, fires, shown if show == "context" and known else None)
            if show == "context" and shown is not None:
                return in_context(project, shown, layer, stances, anew)
            if talk is not None and project.skeleton is not None:
                return self._stage.show(project, talk, folder, side)
            if kept is None:
                return Shown(project, make_plan(project, length), length)
            return Shown(project, perform(project, kept.asks, length, kept.seed, dict(kept.stances), kept.idle), length)

        self.jobs.start("plan", work, self._planned, self._failed, quick=True)

    def _planned(self, shown: Shown) -> None:
        self._busy = False
        if self.live is not None and self.session.transport.show == "plan":
            return
        self.shown = shown
        if shown.notes and shown.notes != self._noted:
            self.document.failed.emit(" ".join(shown.notes))
        self._noted = shown.notes
        self.changed.emit()
        if self._again:
            self.replan()

    def _failed(self, error: Exception) -> None:
        self._busy = False
        if self._again:
            self.replan()
        self.document.failed.emit(f"The plan could not be made: {error}")

    # --- what is asked for

    @property
    def kept(self) -> KeptPerformance | None:
        """The kept performance on stage, as it is now; None while the models improvise."""
        stage = self.session.onstage.performance if self.session.onstage.mode == "meta" else None
        return self.document.project.performances.get(stage or "")

    @property
    def asks(self) -> tuple[AnyAsk, ...]:
        """What is asked for: of the performance on stage, or lately of the live one."""
        if self.live is not None:
            return self.live.asks
        if self.conversation is not None:
            return self.shown.asks
        return self.kept.asks if self.kept is not None else ()

    @property
    def editable(self) -> bool:
        """Whether the asks that are shown can be moved and changed."""
        return self.live is None and self.kept is not None and self.session.transport.show == "plan"

    def answers(self) -> dict[str, Answer]:
        """Return what the plan that is shown does about each ask."""
        if self.live is not None:
            return self.live.answers()
        if self._answered is not self.shown:
            self._answered, self._answers = self.shown, answers(self.shown.plan, (ask.id for ask in self.asks))
        return self._answers

    def ask(self, ask: AnyAsk, text: str = "Ask for something") -> None:
        """Ask for one thing more, in the performance on stage or a new one; without a time it is wanted as soon as can be."""
        if self.live is not None:
            if ask.at is not None and ask.at <= self.live.now:
                ask = msgspec.structs.replace(ask, at=None)
            self.live.ask(ask)
            return
        if ask.at is None and getattr(ask, "stroke", None) is None:
            ask = msgspec.structs.replace(ask, at=round(self.session.transport.seconds + SOON, 3))
        on_stage = self.session.onstage.performance
        made = on_stage

        def edit(project: Project) -> Project:
            nonlocal made
            if made is None or made not in project.performances:
                kept = KeptPerformance(name="Performance", length=self.length)
                project, made = staging.add_performance(project, kept)
            return staging.add_ask(project, made, ask)

        self.document.edit(text, edit)
        self.session.onstage.set_performance(made)
        if made is not None:
            self.session.onstage.select_requests((self.document.project.performances[made].asks[-1].id,))
        self.session.transport.show_plan()

    def change_ask(self, ident: str, merge: str | None = None, **changes: object) -> None:
        """Set fields of an ask of the performance on stage. Raises EditError."""
        stage = self.session.onstage.performance
        if stage is not None:
            self.document.edit("Change request", lambda p: staging.change_ask(p, stage, ident, **changes), merge)

    def move_asks(self, idents: tuple[str, ...], by: float, merge: str | None = None) -> None:
        """Move asks in time."""
        stage = self.session.onstage.performance
        if stage is not None:
            self.document.edit("Move request", lambda p: staging.move_asks(p, stage, idents, by), merge)

    def copy_asks(self, idents: tuple[str, ...], by: float) -> None:
        """Ask for the same once more, seconds later or earlier, and select the copies."""
        stage, kept = self.session.onstage.performance, self.kept
        if stage is None or kept is None:
            return
        number = len(kept.asks)
        copies = tuple(msgspec.structs.replace(x, id="", told=None) for x in kept.asks if x.id in idents)

        def edit(project: Project) -> Project:
            project = staging.change_performance(project, stage, asks=(*project.performances[stage].asks, *copies))
            return staging.move_asks(project, stage, {x.id for x in project.performances[stage].asks[number:]}, by)

        self.document.edit("Copy request" if len(copies) == 1 else f"Copy {len(copies)} requests", edit)
        self.session.onstage.select_requests(tuple(x.id for x in (self.kept or kept).asks[number:]))

    def withdraw(self, *idents: str) -> None:
        """Take asks of the performance on stage back; all when none is named."""
        stage = self.session.onstage.performance
        if stage is not None:
            self.document.edit("Withdraw request", lambda p: staging.remove_asks(p, stage, idents or None))

    # --- live

    def go_live(self, options: Options | None = None) -> None:
        """Let agents drive the character from now on."""
        from app.stage.live_stage import LiveStage

        if self.live is not None or self.document.project.skeleton is None:
            return
        self.session.onstage.set_performance(None)
        self.session.transport.show_plan()
        self.live, self.following = LiveStage(self.document.project, options, self), True
        self.live.ticked.connect(self._ticked)
        self.live.told.connect(lambda _: self.live_changed.emit())
        self.session.transport.set_playing(True)
        self.live.start()
        self.live_changed.emit()

    def stop_live(self) -> None:
        """Hang up, and keep at hand what was played."""
        if self.live is None:
            return
        live, self.live = self.live, None
        live.stop()
        try:
            self.last_live = live.performance() if live.tape.count else None
        except AskError as error:
            self.last_live = None
            self.document.failed.emit(str(error))
        live.deleteLater()
        self.replan()
        self.live_changed.emit()

    def _ticked(self) -> None:
        if self.live is None or self.session.transport.show != "plan":
            return
        # What lies farther back than the running plan reaches is kept in pieces.
        plan = self.live.session.plan if self.following else self.live.session.plan_at(self.session.transport.seconds)
        if plan is not self.shown.plan:
            self.shown = Shown(self.live.session.project, plan, plan.end)
            self.changed.emit()

    def follow(self) -> None:
        """Back to now, after scrubbing through the past of a live session."""
        self.following = True
        self.session.transport.show_plan()
        self.session.transport.set_playing(True)

    # --- the playhead

    def advance(self, elapsed: float) -> None:
        """Move the playhead by `elapsed` seconds of wall clock; called before each frame."""
        session = self.session
        if self.live is not None and session.transport.show == "plan":
            self._advance_live(elapsed)
            return
        if not session.transport.playing or elapsed <= 0 or self.skeleton() is None:
            return
        seconds = session.transport.seconds + elapsed * session.transport.speed
        length = self.shown.length
        endless = self._own_length is None and session.transport.show == "plan" and not session.transport.loop
        if endless and seconds > self.length - AHEAD:
            self.length += LENGTH
            self.replan()
        if seconds >= length > 0 and not endless:
            if session.transport.loop:
                seconds %= length
            else:
                seconds = length
                session.transport.set_playing(False)
        session.transport.seek(seconds)

    def _advance_live(self, elapsed: float) -> None:
        """The playhead is now; or, once it was moved back, plays on behind until it is followed again."""
        assert self.live is not None
        session, now = self.session, self.live.now
        self.following = self.following and session.transport.playing
        if self.following:
            session.transport.seek(now)
        elif session.transport.playing:
            session.transport.seek(min(now, session.transport.seconds + elapsed * session.transport.speed))

    def skeleton(self) -> Skeleton | None:
        """Return the skeleton of what plays: a clip looked at alone may have its own."""
        return self.shown.skeleton

    def pose(self, seconds: float | None = None) -> Pose | None:
        """Return the pose at the playhead (or at `seconds`), None when there is nothing to show."""
        return self.shown.pose(self.session.transport.seconds if seconds is None else seconds)

    def morphs(self) -> dict[str, float]:
        return self.shown.morphs(self.session.transport.seconds)
