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
from metagraph.graph.edits import added_actions, place
from metagraph.graph.face_curves import worn
from metagraph.graph.model import Action, Layer, Project
from metagraph.graph.requests import AnyRequest
from metagraph.motion.clip import Clip
from metagraph.motion.skeleton import Pose, Skeleton
from metagraph.playback.faces import faces_at
from metagraph.playback.life.evaluate import enliven
from metagraph.playback.manual_playback import (
    Fire,
    ManualPlan,
    link_alone,
    make_manual_plan,
    manual_morphs_at,
    manual_pose_at,
    state_alone,
)
from metagraph.playback.plan import MetaRequest, Plan
from metagraph.playback.planner import make_plan
from metagraph.playback.player import morphs_at, pose_at

if TYPE_CHECKING:
    from metagraph.playback.overlay import Overlay
    from metagraph.speech.delivered import Delivered
    from metagraph.speech.duet import Stand
    from metagraph.speech.gaze_shares import GazeShare

ASIDE = (
    -0.35
)  # radians the camera goes round those who talk, to see them from the side and not one of them from behind
LEAD = 0.8  # seconds of stance before and after a clip shown in context


@dataclass(frozen=True)
class Shown:
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
    others: tuple[Shown, ...] = ()
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
    def everyone(self) -> tuple[Shown, ...]:
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

    def pose(self, seconds: Any) -> Pose | None:
        """Return the pose at a time, or at many, None when there is nothing to show."""
        if self.clip is not None:
            motion = self.project.clips[self.clip].motion
            return worn(self.project, motion).pose_at(seconds) if motion is not None else None
        if self.project.skeleton is None:
            return None
        if self.manual is not None:
            return manual_pose_at(self.manual, self.project, seconds)
        if self.motion is not None:
            return self._moved(seconds)
        if self.over is not None and (laid := self.over(seconds)) is not None:
            from metagraph.playback.overlay import overlaid

            return overlaid(self.moving, self.project, seconds, laid)
        return pose_at(self.moving, self.project, seconds)

    def _moved(self, seconds: Any) -> Pose | None:
        """Return the pose of the clip it moves with, alive: eyes, lids and lips are the plan's."""
        entry = self.project.clips[self.motion or ""]
        clip = entry.motion
        if clip is None:
            return None
        if entry.made_by:
            return self._overlaid(clip, seconds)
        times = np.asarray(seconds, np.float64).reshape(-1)
        pose = clip.pose_at(np.clip(times, 0.0, clip.duration))
        if self.project.life.on and self.plan.life.end > 0:
            pose = enliven(pose, self.project, self.plan.life, self.plan.track, times)
        shape = (*np.shape(seconds), len(clip.skeleton))
        return Pose(pose.rotations.reshape(*shape, 4), pose.translations.reshape(*shape, 3))

    def morphs(self, seconds: float) -> dict[str, float]:
        """Return face shapes and their weights, 0..1, at a time."""
        if self.clip is not None:
            motion = self.project.clips[self.clip].motion
            return worn(self.project, motion).morphs_at(seconds) if motion is not None else {}
        if self.manual is not None:
            return manual_morphs_at(self.manual, self.project, seconds)
        entry = self.project.clips.get(self.motion or "")
        if entry is not None and entry.made_by and entry.motion is not None:
            return morphs_at(
                self.plan, self.project, seconds, composed=self._overlaid(entry.motion, seconds, False)
            )
        return morphs_at(self.moving, self.project, seconds)

    def faces(self, times: np.ndarray) -> list[dict[str, float]]:
        """Return face shapes and their weights at each of many times, as `morphs` gives them."""
        if self.clip is None and self.manual is None and self.motion is None:
            return faces_at(self.moving, self.project, times)
        return [self.morphs(float(at)) for at in times]

    def _overlaid(self, clip: Clip, seconds: Any, alive: bool = True) -> Pose:
        """Return the pose of a generated clip: it moves what is above the hips, the plan moves the rest."""
        from metagraph.playback.overlay import clip_overlay, overlaid

        over = clip_overlay(self.project, clip, np.asarray(seconds, np.float64).reshape(-1))
        return overlaid(self.plan, self.project, seconds, over, alive)


def alone(project: Project, clip: str) -> Shown:
    """Return a clip playing by itself."""
    return Shown(project, Plan(1, 0.0), max(1e-3, project.clips[clip].duration), clip)


def by_hand(project: Project, length: float, fires: Iterable[Fire] = (), only: str | None = None) -> Shown:
    """Return the manual state machines playing. only: a state or link to look at alone."""
    if only is not None:
        with suppress(KeyError):  # a link to a group that has no entry leads nowhere
            plan = link_alone(project, only) if project.state(only) is None else state_alone(project, only)
            return Shown(project, plan.plan, plan.end, manual=plan)
    plan = make_manual_plan(project, length, fires)
    return Shown(project, plan.plan, length, manual=plan)


def in_context(
    project: Project, ident: str, layer: Layer, stances: dict[Layer, str], anew: bool = False
) -> Shown:
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
            scratch = place(project, [ident], layer, "gesture", stances.get(layer))
        except EditError:
            return alone(project, ident)
        action = scratch.action(*added_actions(project, scratch))
    if action is None:
        return alone(project, ident)
    begin = {**stances, action.layer: action.stance}
    if action.kind == "stance":
        start, end = scratch.span(action)
        graph = scratch.graphs[action.layer]
        only = {a.id: None for a in graph.of(action.stance, "stance") if a.id != action.id}
        scratch = scratch.with_graph(graph.with_actions(only))
        return Shown(
            scratch, make_plan(scratch, end - start, (), stances=begin, idle=False), max(1.0, end - start)
        )
    request = MetaRequest("shown", action.layer, action.kind, LEAD, action=action.id)
    start, end = scratch.span(action)
    length = LEAD + max(0.0, end - start) + LEAD
    return Shown(scratch, make_plan(scratch, length, (request,), stances=begin, idle=False), length)
