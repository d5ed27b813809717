"""What other seeds would play, as rows under the lanes: planned on a thread, taken over by a click."""

from __future__ import annotations

from bisect import bisect_left
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, QRectF, Qt, Signal
from PySide6.QtGui import QPainter

from app.look.names import plain
from app.look.theme import Theme
from app.project.document import Document
from app.project.jobs import Jobs
from app.stage.performance import Performance
from app.widgets.lane_geometry import LEFT, Scale
from metagraph.graph import edits, performance_edits
from metagraph.graph.model import LAYERS, Layer, Project
from metagraph.graph.requests import Performance as KeptPerformance

if TYPE_CHECKING:
    from metagraph.playback.plan import Cue, Plan

SEEDS = 3  # rows at once
FADED = 0.6  # how much of its colour a ghost has
PREFIX = "ghost "  # of a lane's name; its seed follows
ORDER: tuple[Layer, ...] = ("head", "arms", "body")  # strips of a row, from the top


class WhatIf(QObject):
    """changed: other rows are to be shown. on: whether there are any. plans: by seed, as far as planned."""

    changed = Signal()

    def __init__(
        self, document: Document, jobs: Jobs, performance: Performance, parent: QObject | None = None
    ) -> None:
        super().__init__(parent)
        self.document, self.jobs, self.performance = document, jobs, performance
        self.on = False
        self.plans: dict[int, Plan] = {}
        self._offset = 1
        self._made_of: tuple[object, ...] = ()
        performance.changed.connect(self._follow)
        document.loaded.connect(self.forget)

    @property
    def possible(self) -> bool:
        """Whether what is on stage can be planned with another seed here: a performance, or what is
        improvised.
        """
        p = self.performance
        return (
            p.live.stage is None
            and p.conversation is None
            and p.session.onstage.mode == "meta"
            and p.session.transport.show == "plan"
            and p.document.project.skeleton is not None
        )

    @property
    def seed(self) -> int:
        """The seed that plays now."""
        kept = self.performance.requests.kept
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

    def _follow(self) -> None:
        """Plan what is wanted and not there; what plays now has changed."""
        if not self.on or not self.possible:
            return
        project, kept = self.document.project, self.performance.requests.kept
        length, seeds = self.performance.length, self._seeds()
        made_of = (project, kept, length, seeds)
        if len(made_of) == len(self._made_of) and all(
            a is b or (n > 1 and a == b) for n, (a, b) in enumerate(zip(made_of, self._made_of, strict=True))
        ):
            return
        self._made_of = made_of

        def work(_: object) -> tuple[tuple[object, ...], dict[int, Plan]]:
            return made_of, {seed: plan_with(project, kept, length, seed) for seed in seeds}

        self.jobs.start("what if", work, self._came, lambda error: None, quick=True)

    def _came(self, found: tuple[tuple[object, ...], dict[int, Plan]]) -> None:
        if found[0] is self._made_of:  # else others are wanted by now
            self.plans = found[1]
            self.changed.emit()

    def take(self, seed: int) -> None:
        """Play with a seed from now on."""
        stage, kept = self.performance.session.onstage.performance, self.performance.requests.kept
        if stage is not None and kept is not None and kept.seed is not None:
            self.document.edit(
                "Change seed", lambda p: performance_edits.change_performance(p, stage, seed=seed)
            )
        else:
            self.document.edit("Change seed", lambda p: edits.set_settings(p, seed=seed))

    def cue_at(self, seed: int, seconds: float, part: float) -> Cue | None:
        """Return what a row shows at a time. part: how far down in the row, 0..1."""
        plan, layer = self.plans.get(seed), ORDER[min(len(ORDER) - 1, int(part * len(ORDER)))]
        return (
            next((of.cue_at(seconds) for n, of in plan.layers.items() if n == layer), None) if plan else None
        )

    def tip(self, seed: int, seconds: float, part: float) -> str:
        cue = self.cue_at(seed, seconds, part)
        here = f"{plain(cue.action.name)}, {cue.start:.2f} to {cue.end:.2f} s\n" if cue is not None else ""
        return f"{here}What seed {seed} would play: head, arms, body\nClick plays it instead"


def plan_with(project: Project, kept: KeptPerformance | None, length: float, seed: int) -> Plan:
    """Return what another seed plays of a performance, or improvises."""
    from metagraph.playback.planner import make_plan
    from metagraph.playback.running_plan import asks_of, perform

    if kept is None:
        return make_plan(project, length, seed=seed)
    return perform(project, asks_of(kept), length, seed, dict(kept.stances), kept.idle)


def seed_of(lane: str | None) -> int | None:
    """Return the seed of a lane of ghosts, None for another lane."""
    return int(lane.removeprefix(PREFIX)) if lane is not None and lane.startswith(PREFIX) else None


def paint_ghost(
    painter: QPainter, t: Theme, lane: QRectF, scale: Scale, width: float, plan: Plan | None
) -> None:
    """Paint what a seed would play into its row: a strip for each layer, faint."""
    painter.save()
    painter.setClipRect(QRectF(LEFT, lane.top(), width - LEFT, lane.height()))
    painter.setOpacity(FADED)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing, False)
    painter.setPen(Qt.PenStyle.NoPen)
    each, bars = (lane.height() - 5) / len(LAYERS), dict[str, list[QRectF]]()
    for n, layer in enumerate(ORDER):
        cues = plan.layers[layer].cues if plan is not None else ()
        begin, end = scale.seconds(LEFT), scale.seconds(width)
        for cue in cues[bisect_left(cues, begin, key=lambda c: c.end) :]:
            if cue.start > end:
                break
            left, right = scale.x(cue.start), scale.x(cue.end)
            rect = QRectF(left, lane.top() + 3 + n * each, max(2.0, right - left - 1), max(2.0, each - 1))
            bars.setdefault(cue.action.kind, []).append(rect)
    for kind, rects in bars.items():
        painter.setBrush(t.fill(kind))
        painter.drawRects(rects)
    painter.restore()
