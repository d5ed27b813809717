"""The performance: the plan for the project as it is now, and the pose at the playhead. Derived, never saved.

The plan is a pure function of (project, requests, seed, stances, length); it is made anew on a thread after each edit,
and the old one plays until the new one is there.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from PySide6.QtCore import QObject, QTimer, Signal

from app.document import Document
from app.jobs import Jobs
from app.session import Session
from metagraph.graph.edits import EditError, place
from metagraph.graph.model import LAYERS, Layer, Project
from metagraph.motion.skeleton import Pose, Skeleton
from metagraph.playback.plan import Plan, Request
from metagraph.playback.planner import make_plan
from metagraph.playback.player import morphs_at, pose_at

LENGTH = 60.0  # seconds planned ahead, and how much more whenever the playhead comes near the end
AHEAD = 15.0  # seconds before the end at which more is planned
LEAD = 0.8  # seconds of stance before and after a clip shown in context


@dataclass(frozen=True)
class Shown:
    """What plays: a plan on the project it was made for, or a clip alone. length: seconds."""

    project: Project
    plan: Plan
    length: float
    clip: str | None = None


class Performance(QObject):
    """changed: something else plays, or the same was planned anew."""

    changed = Signal()

    def __init__(self, document: Document, session: Session, jobs: Jobs, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.document, self.session, self.jobs = document, session, jobs
        self.requests: tuple[Request, ...] = ()
        self.length = LENGTH
        self.shown = Shown(document.project, Plan(1, 0.0), LENGTH)
        self._number = 0
        self._busy = self._again = False
        self._soon = QTimer(self, singleShot=True, interval=0)
        self._soon.timeout.connect(self._replan)
        document.loaded.connect(self._loaded)
        document.changed.connect(self._edited)
        session.show_changed.connect(self.replan)

    # --- what plays

    def replan(self) -> None:
        """Plan anew, soon; many calls in a row make one plan."""
        self._soon.start()

    def _loaded(self) -> None:
        self.requests, self.length = (), LENGTH

    def _edited(self, before: Project, after: Project) -> None:
        if before.skeleton is not after.skeleton or after.skeleton is None:
            self.shown = Shown(after, Plan(1, 0.0), LENGTH)
            self.changed.emit()
        self.replan()

    def _replan(self) -> None:
        if self._busy:
            self._again = True
            return
        self._busy, self._again = True, False
        project, requests, length = self.document.project, self.requests, self.length
        show, shown = self.session.show, self.session.shown
        stances = {layer: s for layer in LAYERS if (s := self.session.stance(layer)) is not None}
        layer = self.session.layer

        def work(_: object) -> Shown:
            if show == "clip" and shown in project.clips:
                return alone(project, shown or "")
            if show == "context" and shown is not None:
                return in_context(project, shown, layer, stances)
            return Shown(project, make_plan(project, length, requests), length)

        self.jobs.start("plan", work, self._planned, self._failed, quick=True)

    def _planned(self, shown: Shown) -> None:
        self._busy = False
        self.shown = shown
        self.changed.emit()
        if self._again:
            self.replan()

    def _failed(self, error: Exception) -> None:
        self._busy = False
        if self._again:
            self.replan()
        self.document.failed.emit(f"The plan could not be made: {error}")

    # --- requests

    def request(self, layer: Layer, kind: str, seconds: float | None = None, **more: object) -> Request:
        """Ask for something at a time, or as soon as can be; return the request."""
        self._number += 1
        start = self.session.seconds + 0.15 if seconds is None else seconds
        request = Request(f"r{self._number}", layer, kind, round(start, 3), **more)  # type: ignore[arg-type]
        self.requests = (*self.requests, request)
        self.session.show_plan()
        self.replan()
        return request

    def withdraw(self, ident: str | None = None) -> None:
        """Forget one request, or all."""
        self.requests = tuple(r for r in self.requests if ident is not None and r.id != ident)
        self.replan()

    # --- the playhead

    def advance(self, elapsed: float) -> None:
        """Move the playhead by `elapsed` seconds of wall clock; called before each frame."""
        session = self.session
        if not session.playing or elapsed <= 0 or self.skeleton() is None:
            return
        seconds = session.seconds + elapsed * session.speed
        length = self.shown.length
        if session.show == "plan" and not session.loop and seconds > self.length - AHEAD:
            self.length += LENGTH
            self.replan()
        if seconds >= length > 0 and not (session.show == "plan" and not session.loop):
            if session.loop:
                seconds %= length
            else:
                seconds = length
                session.set_playing(False)
        session.seek(seconds)

    def skeleton(self) -> Skeleton | None:
        """Return the skeleton of what plays: a clip looked at alone may have its own."""
        if self.shown.clip is not None:
            motion = self.shown.project.clips[self.shown.clip].motion
            return motion.skeleton if motion is not None else None
        return self.shown.project.skeleton

    def pose(self, seconds: float | None = None) -> Pose | None:
        """Return the pose at the playhead (or at `seconds`), None when there is nothing to show."""
        at = self.session.seconds if seconds is None else seconds
        if self.shown.clip is not None:
            motion = self.shown.project.clips[self.shown.clip].motion
            return motion.pose_at(at) if motion is not None else None
        if self.shown.project.skeleton is None:
            return None
        return pose_at(self.shown.plan, self.shown.project, at)

    def morphs(self) -> dict[str, float]:
        if self.shown.clip is not None:
            motion = self.shown.project.clips[self.shown.clip].motion
            return motion.morphs_at(self.session.seconds) if motion is not None else {}
        return morphs_at(self.shown.plan, self.shown.project, self.session.seconds)


def alone(project: Project, clip: str) -> Shown:
    """Return a clip playing by itself."""
    return Shown(project, Plan(1, 0.0), max(1e-3, project.clips[clip].duration), clip)


def in_context(project: Project, ident: str, layer: Layer, stances: dict[Layer, str]) -> Shown:
    """Return stance, action, back to the stance, the other layers resting in theirs.

    ident: an action, or a clip; a clip that was not placed yet is tried as a gesture of the current stance.
    """
    action = project.action(ident)
    if action is None and ident in project.clips:
        uses = project.uses.get(ident, ())
        action = next((a for a in uses if a.stance == stances.get(layer)), uses[0] if uses else None)
    scratch = project
    if action is None:
        try:
            scratch = place(project, [ident], layer, "gesture", stances.get(layer))
        except EditError:
            return alone(project, ident)
        action = scratch.action(f"a{project.next_id}")
    if action is None:
        return alone(project, ident)
    begin = {**stances, action.layer: action.stance}
    if action.kind == "stance":
        start, end = scratch.span(action)
        graph = scratch.graphs[action.layer]
        only = {a.id: None for a in graph.of(action.stance, "stance") if a.id != action.id}
        scratch = scratch.with_graph(graph.with_actions(only))
        return Shown(scratch, make_plan(scratch, end - start, (), stances=begin, idle=False), max(1.0, end - start))
    request = Request("shown", action.layer, action.kind, LEAD, action=action.id)
    plan = make_plan(scratch, 1e9, (request,), stances=begin, idle=False)
    last = max((cue.end for cue in plan.layers[action.layer].cues), default=LEAD)
    return Shown(scratch, replace(plan, end=last + LEAD), last + LEAD)
