"""Hold what plays: a plan on the project it was made for, or a single clip. Views ask it for the pose at a
time.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from contextlib import suppress
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from metagraph.graph.edit_error import EditError
from metagraph.graph.edits import find_added_actions, place_clips
from metagraph.graph.model import Action, Layer, Project
from metagraph.graph.repeating import seconds_played
from metagraph.graph.requests import AnyRequest
from metagraph.motion.skeleton import Pose, Skeleton
from metagraph.playback.evaluator import Evaluator, Poses
from metagraph.playback.manual_playback import (
    Fire,
    ManualEvaluator,
    ManualPlan,
    make_manual_plan,
    plan_link_alone,
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
    from metagraph.motion.prop_tops import PropTop
    from metagraph.playback.posing.overlay import Overlay
    from metagraph.speech.delivered import Delivered
    from metagraph.speech.duet import Stand
    from metagraph.speech.gaze_shares import GazeShare

ASIDE = (
    -0.35
)  # radians by which the camera goes around the speakers, to see them from the side and none from behind
LEAD = 0.8  # seconds of stance before and after a clip shown in context


@dataclass(frozen=True)
class ShownPlayback:
    """What plays.

    `project` is the one the plan was made for. `length` is in seconds. `clip` is the clip that plays alone,
    without a plan. `manual` is what the manual state machines play, if they do; `plan` then only shows it.

    For a conversation: `others` are the other speakers' playbacks, and `side` is the number of this one, from
    0. `stand` is where it stands. `asks` are its requests. `notes` say what could not be read. `folder` is
    what paths in its project are relative to. `motion` is the clip that moves it instead of its plan, which
    still says where it looks and what it says; a generated clip moves what is above the hips. `told` says how
    well its rates are met, if a plan moves it. `looks` says where it looks, if there are three or more
    speakers. `over` returns the generated motion over the plan at a time, when live. `muted` has layers that
    rest in their stances while the user looks at the others.

    `tops` are of the props that stand there, in this one's space: hands rest on them, and feet. `carried` has
    the corners of the boxes round what its joints carry.
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
    beside: ShownPlayback | None = None
    tops: tuple[PropTop, ...] = ()
    carried: Mapping[str, tuple[tuple[float, float, float], ...]] = field(default_factory=dict)

    @cached_property
    def moving(self) -> Plan:
        """Return the plan without what muted layers play."""
        if not self.muted:
            return self.plan
        layers = {
            layer: replace(of, cues=()) if layer in self.muted else of
            for layer, of in self.plan.layers.items()
        }
        return replace(self.plan, layers=layers)

    @property
    def everyone(self) -> tuple[ShownPlayback, ...]:
        """Return the visible characters: this one, or all of a conversation, the first side first."""
        return tuple(sorted((self, *self.others), key=lambda one: one.side))

    @property
    def skeleton(self) -> Skeleton | None:
        """Return the skeleton; a clip shown alone may have its own."""
        if self.clip is not None:
            motion = self.project.clips[self.clip].motion
            return motion.skeleton if motion is not None else None
        return self.project.skeleton

    def clip_seconds(self, action: Action, seconds: float) -> float | None:
        """Return the moment of an action's clip that plays at a time; None while it does not play."""
        if self.clip is not None:
            return seconds if self.clip == action.clip else None
        cue = self.plan.layers[action.layer].cue_at(seconds)
        if cue is None or cue.action.id != action.id:
            return None
        return float(cue.clip_seconds(seconds))

    def seconds_of(self, action: Action, moment: float) -> float | None:
        """Return a time in seconds at which a moment of an action's clip plays; None if it never does."""
        if self.clip is not None:
            return moment if self.clip == action.clip else None
        for cue in self.plan.layers[action.layer].cues:
            once = cue.once
            if cue.action.id == action.id and cue.entry - 1e-6 <= moment <= once.last + 1e-6:
                times = np.linspace(cue.start, once.end, 64)
                return float(np.interp(moment, once.clip_seconds(times), times))
        return None

    @cached_property
    def evaluator(self) -> Poses | None:
        """Return the evaluator of what plays, with hands and feet on props; None if there is nothing to
        show.
        """
        found = self.without_props
        if found is None or not self.tops or self.clip is not None:
            return found
        from metagraph.playback.posing.prop_contacts import RestingEvaluator

        return RestingEvaluator(found, self.project, self.tops, self.carried)

    def keep_evaluator(self, other: ShownPlayback) -> ShownPlayback:
        """Return another playback of the same plan, which need not be prepared again."""
        if "without_props" in self.__dict__:
            other.__dict__["without_props"] = self.without_props
        return other

    @cached_property
    def without_props(self) -> Poses | None:
        """Return the evaluator of what plays, as if no props stood there; None for nothing to show."""
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
        """Return the pose at one time or many; None if there is nothing to show."""
        return self.evaluator.at(seconds) if self.evaluator is not None else None

    def morphs(self, seconds: float) -> dict[str, float]:
        """Return morph targets and their weights, 0..1, at a time."""
        return self.evaluator.morphs_at(seconds) if self.evaluator is not None else {}

    def faces(self, times: np.ndarray) -> list[dict[str, float]]:
        """Return morph targets and their weights at each of many times, as in `morphs`."""
        return self.evaluator.faces_at(times) if self.evaluator is not None else [{} for _ in times]


def play_clip_alone(project: Project, clip: str) -> ShownPlayback:
    """Return the playback of a single clip."""
    return ShownPlayback(project, Plan(1, 0.0), max(1e-3, project.clips[clip].duration), clip)


def play_manual(
    project: Project, length: float, fires: Iterable[Fire] = (), only: str | None = None
) -> ShownPlayback:
    """Return the playback of the manual state machines. `only` is a state or link to show alone."""
    if only is not None:
        with suppress(KeyError):  # a link to a group without an entry leads nowhere
            plan = (
                plan_link_alone(project, only)
                if project.state(only) is None
                else play_state_alone(project, only)
            )
            return ShownPlayback(project, plan.plan, plan.end, manual=plan)
    plan = make_manual_plan(project, length, fires)
    return ShownPlayback(project, plan.plan, length, manual=plan)


def play_in_context(
    project: Project, ident: str, layer: Layer, stances: dict[Layer, str], anew: bool = False
) -> ShownPlayback:
    """Return the playback of stance, action, and back to the stance, with the other layers resting in theirs.

    `ident` is an action, or a clip; a clip that is not placed yet is tried as a gesture of the current
    stance. `again` also tries one that is placed, unless it is on that stance.
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
    length = LEAD + max(0.0, seconds_played(action.kind, action.timing, start, end)) + LEAD
    return ShownPlayback(scratch, make_plan(scratch, length, (request,), stances=begin, idle=False), length)
