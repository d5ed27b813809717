"""What plays: a plan on the project it was made for, or a clip alone; whoever shows it asks for the pose at a
time.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from metagraph.graph.edit_error import EditError
from metagraph.graph.edits import find_added_actions, place_clips
from metagraph.graph.model import Action, Layer, Project
from metagraph.graph.requests import AnyRequest
from metagraph.motion.skeleton import Pose, Skeleton
from metagraph.playback.evaluator import Evaluator, Poses
from metagraph.playback.manual_playback import (
    Fire,
    ManualEvaluator,
    ManualPlan,
    link_alone,
    make_manual_plan,
    play_state_alone,
)
from metagraph.playback.plan import MetaRequest, Plan
from metagraph.playback.planner import make_plan
from metagraph.playback.posing.clip_evaluators import (
    ClipEvaluator,
    GeneratedEvaluator,
    MovedEvaluator,
    OverlaidEvaluator,
)

if TYPE_CHECKING:
    from metagraph.playback.posing.overlay import Overlay
    from metagraph.speech.delivered import Delivered
    from metagraph.speech.duet import Stand
    from metagraph.speech.gaze_shares import GazeShare

ASIDE = (
    -0.35
)  # radians the camera goes round those who talk, to see them from the side and not one of them from behind
LEAD = 0.8  # seconds of stance before and after a clip shown in context


@dataclass(frozen=True)
class ShownPlayback:
    """project: the one the plan was made for. length: seconds. clip: the one that plays alone, then without a
    plan. manual: what the manual state machines play, where they do; `plan` then only shows it.

    Of a conversation: others: those it talks with. side: which of them this is, from 0. stand: where it
    stands. asks: what it is asked. notes: what could not be read. folder: what paths in its project begin at.
    motion: the clip it moves with instead of its plan, which still says where it looks and what it says; of
    one that was generated, what is above the hips. told: what becomes of its rates, where a plan moves it.
    looks: of three or more, where it looks. over: what generated motion lays over the plan at a time, live.
    muted: layers that rest in their stances while one looks at the others.
    """

    project: Project
    plan: Plan
    length: float
    clip: str | None = None
    manual: ManualPlan | None = None
    others: tuple[ShownPlayback, ...] = ()
    side: int = 0
    stand: Stand | None = None
    asks: tuple[AnyRequest, ...] = ()
    notes: tuple[str, ...] = ()
    folder: Path | None = None
    motion: str | None = None
    told: tuple[Delivered, ...] = ()
    looks: tuple[GazeShare, ...] = ()
    over: Callable[[float], Overlay | None] | None = None
    muted: frozenset[Layer] = frozenset()

    @cached_property
    def moving(self) -> Plan:
        """The plan without what muted layers play."""
        if not self.muted:
            return self.plan
        layers = {
            layer: replace(of, cues=()) if layer in self.muted else of
            for layer, of in self.plan.layers.items()
        }
        return replace(self.plan, layers=layers)

    @property
    def everyone(self) -> tuple[ShownPlayback, ...]:
        """Who is to be seen: this one alone, or all of a conversation, its first side first."""
        return tuple(sorted((self, *self.others), key=lambda one: one.side))

    @property
    def skeleton(self) -> Skeleton | None:
        """A clip looked at alone may have its own."""
        if self.clip is not None:
            motion = self.project.clips[self.clip].motion
            return motion.skeleton if motion is not None else None
        return self.project.skeleton

    def clip_seconds(self, action: Action, seconds: float) -> float | None:
        """Return the moment of an action's clip that plays at a time; None while it does not."""
        if self.clip is not None:
            return seconds if self.clip == action.clip else None
        cue = self.plan.layers[action.layer].cue_at(seconds)
        if cue is None or cue.action.id != action.id:
            return None
        return float(cue.clip_seconds(seconds))

    def seconds_of(self, action: Action, moment: float) -> float | None:
        """Return a time at which a moment of an action's clip plays, seconds; None where it never does."""
        if self.clip is not None:
            return moment if self.clip == action.clip else None
        for cue in self.plan.layers[action.layer].cues:
            if cue.action.id == action.id and cue.entry - 1e-6 <= moment <= cue.last + 1e-6:
                times = np.linspace(cue.start, cue.end, 64)
                return float(np.interp(moment, cue.clip_seconds(times), times))
        return None

    @cached_property
    def evaluator(self) -> Poses | None:
        """What plays, as poses; None where there is nothing to show."""
        project = self.project
        entry = project.clips.get(self.clip or self.motion or "")
        motion = entry.motion if entry is not None else None
        if self.clip is not None:
            return ClipEvaluator(project, motion) if motion is not None else None
        if project.skeleton is None:
            return None
        if self.manual is not None:
            return ManualEvaluator(self.manual, project)
        if entry is not None:
            if motion is None:
                return None
            return (GeneratedEvaluator if entry.made_by else MovedEvaluator)(self.plan, project, motion)
        if self.over is not None:
            return OverlaidEvaluator(self.moving, project, self.over)
        return Evaluator(self.moving, project)

    def pose(self, seconds: Any) -> Pose | None:
        """Return the pose at a time, or at many, None when there is nothing to show."""
        return self.evaluator.at(seconds) if self.evaluator is not None else None

    def morphs(self, seconds: float) -> dict[str, float]:
        """Return face shapes and their weights, 0..1, at a time."""
        return self.evaluator.morphs_at(seconds) if self.evaluator is not None else {}

    def faces(self, times: np.ndarray) -> list[dict[str, float]]:
        """Return face shapes and their weights at each of many times, as `morphs` gives them."""
        return self.evaluator.faces_at(times) if self.evaluator is not None else [{} for _ in times]


def play_clip_alone(project: Project, clip: str) -> ShownPlayback:
    """Return a clip playing by itself."""
    return ShownPlayback(project, Plan(1, 0.0), max(1e-3, project.clips[clip].duration), clip)


def play_manual(
    project: Project, length: float, fires: Iterable[Fire] = (), only: str | None = None
) -> ShownPlayback:
    """Return the manual state machines playing. only: a state or link to look at alone."""
    if only is not None:
        with suppress(KeyError):  # a link to a group that has no entry leads nowhere
            plan = (
                link_alone(project, only) if project.state(only) is None else play_state_alone(project, only)
            )
            return ShownPlayback(project, plan.plan, plan.end, manual=plan)
    plan = make_manual_plan(project, length, fires)
    return ShownPlayback(project, plan.plan, length, manual=plan)


def play_in_context(
    project: Project, ident: str, layer: Layer, stances: dict[Layer, str], anew: bool = False
) -> ShownPlayback:
    """Return stance, action, back to the stance, the other layers resting in theirs.

    ident: an action, or a clip; a clip that was not placed yet is tried as a gesture of the current stance.
    anew: one that was, too, unless it is placed on that very stance.
    """
    action = project.action(ident)
    if action is None and ident in project.clips:
        uses = project.uses.get(ident, ())
        action = next(
            (a for a in uses if a.stance == stances.get(layer)), uses[0] if uses and not anew else None
        )
    scratch = project
    if action is None:
        try:
            scratch = place_clips(project, [ident], layer, "gesture", stances.get(layer))
        except EditError:
            return play_clip_alone(project, ident)
        action = scratch.action(*find_added_actions(project, scratch))
    if action is None:
        return play_clip_alone(project, ident)
    begin = {**stances, action.layer: action.stance}
    if action.kind == "stance":
        start, end = scratch.span(action)
        graph = scratch.graphs[action.layer]
        only = {a.id: None for a in graph.of(action.stance, "stance") if a.id != action.id}
        scratch = scratch.with_graph(graph.with_actions(only))
        return ShownPlayback(
            scratch, make_plan(scratch, end - start, (), stances=begin, idle=False), max(1.0, end - start)
        )
    request = MetaRequest("shown", action.layer, action.kind, LEAD, action=action.id)
    start, end = scratch.span(action)
    length = LEAD + max(0.0, end - start) + LEAD
    return ShownPlayback(scratch, make_plan(scratch, length, (request,), stances=begin, idle=False), length)
