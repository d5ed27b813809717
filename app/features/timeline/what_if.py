"""What other seeds would play, as rows under the lanes: planned on a thread, taken over by a click."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QElapsedTimer, QObject, QRectF, Qt, QTimer, Signal
from PySide6.QtGui import QPainter

from app.look.names import make_readable_name
from app.look.theme import WindowTheme
from app.project.document import Document
from app.project.jobs import Jobs
from app.stage.performance import StagePerformance
from app.translation import tr
from app.widgets.lane_geometry import LEFT, LaneScale
from metagraph.graph import edits
from metagraph.graph.conversation.edits import change_conversation
from metagraph.graph.editing import performances as performance_edits
from metagraph.graph.model import LAYERS, Layer, Mode, Project
from metagraph.graph.requests import Performance as KeptPerformance

if TYPE_CHECKING:
    from app.stage.live_stage import LiveStage
    from metagraph.playback.plan import Cue, Plan

SEEDS = 3  # rows at once
STEP = 4.0  # seconds after which a live session has other rows, whatever it is asked
REST, IDLE = 1500, 10  # milliseconds between two plannings live, and how many times as long as one takes
FADED = 0.6  # how much of its colour a ghost has
PREFIX = "ghost "  # of a lane's name; its seed follows
ORDER: tuple[Layer, ...] = ("head", "arms", "body")  # strips of a row, from the top


class WhatIf(QObject):
    """changed: other rows are to be shown. on: whether there are any. plans: by seed, as far as planned; of a
    conversation those of the side on stage, of a live session what it was asked so far.
    """

    changed = Signal()

    def __init__(
        self, document: Document, jobs: Jobs, performance: StagePerformance, parent: QObject | None = None
    ) -> None:
        super().__init__(parent)
        self.document, self.jobs, self.performance = document, jobs, performance
        self.on = False
        self.plans: dict[int, Plan] = {}
        self._offset = 1
        self._made_of: tuple[object, ...] = ()
        self._again = QTimer(self, singleShot=True)
        self._again.timeout.connect(self._follow)
        self._took = QElapsedTimer()
        performance.changed.connect(self._follow)
        document.loaded.connect(self.forget)

    @property
    def possible(self) -> bool:
        """Whether what is on stage can be planned with another seed: all but a clip looked at alone and state
        machines drawn by hand.
        """
        p = self.performance
        return (
            p.session.onstage.mode == "meta"
            and p.session.transport.show == "plan"
            and p.document.project.skeleton is not None
        )

    @property
    def seed(self) -> int:
        """The seed that plays now."""
        live, talk, kept = self._live, self.performance.conversation, self.performance.requests.kept
        if live is not None:
            return live.session.plan.seed
        if talk is not None:
            return self.document.project.conversations[talk].seed
        own = kept.seed if kept is not None else None
        return int(own if own is not None else self.document.project.settings.seed)

    @property
    def lanes(self) -> tuple[str, ...]:
        """Names of the rows' lanes."""
        shown = self.on and self.possible
        return tuple(f"{PREFIX}{seed}" for seed in self._seeds()) if shown else ()

    def _seeds(self) -> tuple[int, ...]:
        return tuple((self.seed + self._offset + n) & 0xFFFFFFFF for n in range(SEEDS))

    def forget(self) -> None:
        self.plans, self._made_of, self._offset, self.on = {}, (), 1, False
        self.changed.emit()

    def set_on(self, on: bool) -> None:
        self.on, self._made_of = on, ()
        self._follow()
        self.changed.emit()

    def others(self) -> None:
        """Show the next seeds."""
        self._offset += SEEDS
        self._follow()
        self.changed.emit()

    @property
    def _live(self) -> LiveStage | None:
        return self.performance.live.stage

    def _follow(self) -> None:
        """Plan what is wanted and not there; what plays now has changed."""
        if not self.on or not self.possible or (self._live is not None and self._again.isActive()):
            return
        made_of, planner = self._wanted()
        if len(made_of) == len(self._made_of) and all(
            a is b or (n > 1 and a == b) for n, (a, b) in enumerate(zip(made_of, self._made_of, strict=True))
        ):
            return
        self._made_of = made_of
        seeds, plan = self._seeds(), planner()
        if self._live is not None:  # it goes on and on: a while after these come the next, if they are others
            self._took.start()

        def work(_: object) -> tuple[tuple[object, ...], dict[int, Plan]]:
            return made_of, {seed: plan(seed) for seed in seeds}

        self.jobs.start(tr("what if"), work, self._came, lambda error: None, quick=True)

    def _came(self, found: tuple[tuple[object, ...], dict[int, Plan]]) -> None:
        if found[0] is self._made_of:  # else others are wanted by now
            self.plans = found[1]
            self.changed.emit()
            if self._live is not None:
                self._again.start(max(REST, IDLE * self._took.elapsed()))

    def _wanted(self) -> tuple[tuple[object, ...], Callable[[], Callable[[int], Plan]]]:
        """Return what the rows are made of, the first two by who they are, and what makes who plans a seed on
        another thread.
        """
        project, seeds, live = self.document.project, self._seeds(), self._live
        length, talk = self.performance.length, self.performance.conversation
        kept, mode = self.performance.requests.kept, self.performance.session.onstage.improvised
        if live is not None:
            end = live.session.plan.end

            def relive() -> Callable[[int], Plan]:
                asked = live.performance()
                return lambda seed: plan_with(project, asked, end, seed, mode)

            return (project, live, live.tape.count, int(end / STEP), seeds), relive
        if talk is not None:
            side, folder = self.performance.session.onstage.side, self.document.folder or Path()

            def converse(seed: int) -> Plan:
                other = change_conversation(project, talk, seed=seed)
                return self.performance.conversations.show(other, talk, folder, side).plan

            return (project, None, talk, side, folder, seeds), lambda: converse
        return (
            project,
            kept,
            length,
            mode,
            seeds,
        ), lambda: lambda seed: plan_with(project, kept, length, seed, mode)

    def take(self, seed: int) -> None:
        """Play with a seed from now on; of a live session the next one, since this one's record is of one
        seed.
        """
        stage, kept = self.performance.session.onstage.performance, self.performance.requests.kept
        talk = self.performance.conversation
        if talk is not None:
            self.document.edit(tr("Change seed"), lambda p: change_conversation(p, talk, seed=seed))
        elif stage is not None and kept is not None and kept.seed is not None:
            self.document.edit(
                tr("Change seed"), lambda p: performance_edits.change_performance(p, stage, seed=seed)
            )
        else:
            self.document.edit(tr("Change seed"), lambda p: edits.set_settings(p, seed=seed))

    def cue_at(self, seed: int, seconds: float, part: float) -> Cue | None:
        """Return what a row shows at a time. part: how far down in the row, 0..1."""
        plan, layer = self.plans.get(seed), ORDER[min(len(ORDER) - 1, int(part * len(ORDER)))]
        return (
            next((of.cue_at(seconds) for n, of in plan.layers.items() if n == layer), None) if plan else None
        )

    def tip(self, seed: int, seconds: float, part: float) -> str:
        cue = self.cue_at(seed, seconds, part)
        here = (
            tr(
                "{name}, {start:.2f} to {end:.2f} s\n",
                name=make_readable_name(cue.action.name),
                start=cue.start,
                end=cue.end,
            )
            if cue is not None
            else ""
        )
        if self._live is not None:
            return tr(
                "{here}Seed {seed} would have played this: head, arms, body\nClick to use it in the "
                "next live session",
                here=here,
                seed=seed,
            )
        return tr(
            "{here}Seed {seed} would play this: head, arms, body\nClick to use this seed",
            here=here,
            seed=seed,
        )


def plan_with(project: Project, kept: KeptPerformance | None, length: float, seed: int, mode: Mode) -> Plan:
    """Return what another seed plays of a performance, or improvises."""
    from metagraph.playback.planning.running_plan import improvise, list_kept_asks, plan_performance

    if kept is None:
        return improvise(project, length, seed, mode)
    return plan_performance(project, list_kept_asks(kept), length, seed, dict(kept.stances), kept.idle)


def get_ghost_seed(lane: str | None) -> int | None:
    """Return the seed of a lane of ghosts, None for another lane."""
    return int(lane.removeprefix(PREFIX)) if lane is not None and lane.startswith(PREFIX) else None


def paint_ghost(
    painter: QPainter, t: WindowTheme, lane: QRectF, scale: LaneScale, width: float, plan: Plan | None
) -> None:
    """Paint what a seed would play into its row: a strip for each layer, faint."""
    painter.save()
    painter.setClipRect(QRectF(LEFT, lane.top(), width - LEFT, lane.height()))
    painter.setOpacity(FADED)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing, False)
    painter.setPen(Qt.PenStyle.NoPen)
    each, bars = (lane.height() - 2) / len(LAYERS), dict[str, list[QRectF]]()
    for n, layer in enumerate(ORDER):
        cues = plan.layers[layer].cues if plan is not None else ()
        begin, end = scale.seconds(LEFT), scale.seconds(width)
        for cue in cues[bisect_left(cues, begin, key=lambda c: c.end) :]:
            if cue.start > end:
                break
            left, right = scale.x(cue.start), scale.x(cue.end)
            rect = QRectF(left, lane.top() + 1 + n * each, max(2.0, right - left - 1), max(2.0, each - 1))
            bars.setdefault(cue.action.kind, []).append(rect)
    for kind, rects in bars.items():
        painter.setBrush(t.fill(kind))
        painter.drawRects(rects)
    painter.restore()
