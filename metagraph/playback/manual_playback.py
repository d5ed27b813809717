"""Playing manual state machines as engines do: which state when, and the pose at a time.

A link is taken when its source has finished, drawn by weight with the project's keyed randomness, or when its
trigger is fired; a fired trigger leads over the shortest way of links. While one blend runs no other begins.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from math import ceil, inf
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.graph import anatomy
from metagraph.graph.manual.machine import Link, Manual, State
from metagraph.graph.manual.timing import find_exit_moment
from metagraph.graph.model import LAYERS, Action, Kind, Layer, Project, Timing
from metagraph.motion import rotation
from metagraph.motion.skeleton import Pose
from metagraph.playback.evaluator import add_life
from metagraph.playback.life.evaluate import LifeStage
from metagraph.playback.life.schedule import Schedule, schedule
from metagraph.playback.life.track import Track
from metagraph.playback.plan import Cue, LayerPlan, Plan, Report
from metagraph.playback.planning.choice import pick
from metagraph.playback.posing.composer import Ground, Reach, find_playable_motion
from metagraph.playback.posing.layers import (
    Sample,
    crossfade,
    ease_blend,
    keep_to,
    make_zero_offsets,
    sample_offsets,
)
from metagraph.playback.posing.rigs import get_rigs

Array = NDArray[Any]
LEAST = 1 / 30  # seconds a state plays at least: links in a circle without length take their time
AROUND = 1.0  # seconds of the states shown before and after a link


@dataclass(frozen=True, slots=True)
class Fire:
    """A trigger fired on a layer at `at` seconds."""

    layer: Layer
    trigger: str
    at: float


@dataclass(frozen=True, slots=True)
class Played:
    """One state's turn: from `start` seconds on it takes over within `blend` seconds. action: what plays.
    entry: clip seconds at `start`.

    link: id of the link that led here, None at the beginning.
    """

    action: Action
    start: float
    blend: float
    entry: float
    link: str | None = None


@dataclass(frozen=True)
class ManualLayer:
    """One layer's turns, ascending; each fades in before the next begins."""

    layer: Layer
    played: tuple[Played, ...] = ()

    @cached_property
    def starts(self) -> Array:
        """When each turn begins, `[P]`."""
        return np.array([p.start for p in self.played])

    def at(self, seconds: float) -> Played | None:
        """Return whose turn it is."""
        place = max(0, int(self.starts.searchsorted(seconds, "right")) - 1) if self.played else 0
        return self.played[place] if self.played else None

    def shares(self, seconds: float) -> list[tuple[Played, float]]:
        """Return who shows, and how much, 0..1: whose turn it is, and who fades out."""
        turn = self.at(seconds)
        if turn is None:
            return []
        if turn.blend <= 0 or turn is self.played[0]:
            return [(turn, 1.0)]
        share = float(ease_blend(np.array((seconds - turn.start) / turn.blend)))
        return [(turn, share), (self.played[self.played.index(turn) - 1], 1 - share)][: 2 if share < 1 else 1]


@dataclass(frozen=True)
class ManualPlan:
    """What the machines play from 0 to `end` seconds. reports: triggers that led nowhere. life: of the life
    layers.
    """

    seed: int
    end: float
    layers: Mapping[Layer, ManualLayer] = field(default_factory=dict)
    reports: tuple[Report, ...] = ()
    life: Schedule = field(default_factory=Schedule)

    @cached_property
    def plan(self) -> Plan:
        """The same as cues, for what shows plans; `player` cannot pose them."""
        layers = {
            x: LayerPlan(x, cues=_cues(self.layers[x].played, self.end) if x in self.layers else ())
            for x in LAYERS
        }
        return Plan(self.seed, self.end, layers, self.reports, life=self.life)


def _cues(played: tuple[Played, ...], end: float) -> tuple[Cue, ...]:
    ends = [*(p.start for p in played[1:]), end]
    return tuple(
        Cue(p.action, p.start, e, p.entry, p.blend, 0.0, "", "", p.link or "")
        for p, e in zip(played, ends, strict=True)
    )


def make_state_action(state: State) -> Action:
    """Return a state as the action it plays, under its own id."""
    timing = Timing(state.start, state.end, 0.0, 0.0, state.loop)
    kind: Kind = "stance" if state.loop else "gesture"
    return Action(
        state.id,
        state.clip,
        kind,
        state.layer,
        "",
        state.name,
        timing=timing,
        limb=state.limb,
        joints=state.joints,
        joint_weights=state.joint_weights,
    )


# --- which state when


def make_manual_plan(
    project: Project, end: float, fires: Iterable[Fire] = (), seed: int | None = None
) -> ManualPlan:
    """Plan every layer's machine from 0 to `end` seconds. seed: 32-bit, the project's when None.

    A longer plan begins as a shorter one, and firing something leaves what came before as it was. A layer
    without a machine or without a start stays still.
    """
    seed = project.settings.seed if seed is None else seed
    asked = sorted(fires, key=lambda f: f.at)
    layers: dict[Layer, ManualLayer] = {}
    reports: list[Report] = []
    for layer, manual in project.manual.items():
        if manual.start in manual.states:
            played, told = _perform(project, manual, seed, end, [f for f in asked if f.layer == layer])
            layers[layer] = ManualLayer(layer, played)
            reports += told
    life = schedule(project.life, Track(), project.voices, seed, end, Schedule(), 0.0)
    return ManualPlan(seed, end, layers, tuple(reports), life)


def _perform(
    project: Project, manual: Manual, seed: int, end: float, fires: list[Fire]
) -> tuple[tuple[Played, ...], list[Report]]:
    state = manual.states[manual.start or ""]
    out = [_turn(project, state, 0.0, None)]
    reports: list[Report] = []
    way: list[Link] = []
    since = 0.0
    waiting = list(fires)
    visits: Counter[str] = Counter()
    while True:
        here = out[-1]
        visits[state.id] += 1
        ready = here.start + max(here.blend, LEAST)
        drawn = _drawn(manual, state, seed, visits[state.id])
        moment = _moment(project, here, drawn, ready) if drawn is not None else inf
        while not way and waiting and waiting[0].at <= min(moment, end):
            fire = waiting.pop(0)
            found = route(manual, state.id, fire.trigger)
            if found is None:
                why = f"no way leads from '{state.name}' to what waits for '{fire.trigger}'"
                reports.append(Report(fire.trigger, "no-way", why, manual.layer, fire.at))
            else:
                way, since = list(found), fire.at
        link = drawn
        if way:
            link = way.pop(0)
            moment = _moment(project, here, link, max(ready, since))
        if link is None or moment >= end:
            return tuple(out), reports
        state = manual.states[link.target]
        out.append(_turn(project, state, moment, link))


def _turn(project: Project, state: State, start: float, link: Link | None) -> Played:
    action = make_state_action(state)
    blend = max(0.0, link.blend) if link is not None else 0.0
    return Played(action, start, blend, project.span(action)[0], link.id if link is not None else None)


def _drawn(manual: Manual, state: State, seed: int, visit: int) -> Link | None:
    """Draw the finished link by which a state will be left at its `visit`-th turn, None if there is none."""
    finished = {x.id: x for x in manual.leaving(state.id) if x.condition.when == "finished"}
    weights = {i: x.condition.weight for i, x in finished.items() if x.condition.weight > 0}
    return finished[pick(seed, f"{state.id} {visit}", "link", weights)] if weights else None


def _moment(project: Project, here: Played, link: Link, ready: float) -> float:
    """Return when a link is taken, `ready` at the earliest; in a loop the next time round."""
    start, end = project.span(here.action)
    state = project.manual[here.action.layer].states[here.action.id]
    leave = find_exit_moment(project, state, link)
    if leave is None:
        return ready
    moment = here.start + leave - here.entry
    if here.action.timing.loop and end > start and moment < ready:
        moment += ceil((ready - moment) / (end - start) - 1e-9) * (end - start)
    return max(moment, ready)


def route(manual: Manual, state: str, trigger: str) -> tuple[Link, ...] | None:
    """Return the fewest links from a state whose last waits for a trigger, None if there is no way. Of equals
    the first drawn.
    """
    before: dict[str, tuple[str, Link] | None] = {state: None}
    queue = [state]
    for here in queue:
        for link in manual.leaving(here):
            if link.condition.when == "request" and link.condition.trigger == trigger:
                way = [link]
                step = before[here]
                while step is not None:
                    way.append(step[1])
                    step = before[step[0]]
                return tuple(reversed(way))
            if link.target not in before:
                before[link.target] = (here, link)
                queue.append(link.target)
    return None


# --- parts of a machine, looked at alone


def play_state_alone(project: Project, ident: str) -> ManualPlan:
    """Return a plan of one state as it plays in its layer, nothing else moving; it ends with the part that
    plays. Raises KeyError.
    """
    state = project.state(ident)
    if state is None:
        raise KeyError(ident)
    turn = _turn(project, state, 0.0, None)
    start, end = project.span(turn.action)
    return ManualPlan(1, max(LEAST, end - start), {state.layer: ManualLayer(state.layer, (turn,))})


def plan_link_alone(project: Project, ident: str) -> ManualPlan:
    """Return a plan of one link: its source's last second, the blend, its target's first. Raises KeyError.

    Of a link from several states the start is the source, or if that is not one of them, or the target,
    another of them.
    """
    link = project.link(ident)
    manual = next((m for m in project.manual.values() if ident in m.links), None)
    target = manual.states.get(manual.end(link) or "") if manual is not None and link is not None else None
    if link is None or manual is None or target is None:
        raise KeyError(ident)
    alias = manual.aliases.get(link.source)
    some = manual.members(alias) if alias is not None else tuple(manual.states)
    others = (manual.start, *some) if manual.start in some else some
    source = (
        project.state(link.source)
        or manual.states[next((s for s in others if s and s != target.id), target.id)]
    )
    first = _turn(project, source, 0.0, None)
    start, end = project.span(first.action)
    leave = find_exit_moment(project, source, link)
    leave = min(start + AROUND, end) if leave is None else leave
    lead = min(AROUND, leave - start)
    first = replace(first, entry=leave - lead)
    second = _turn(project, target, lead, link)
    low, high = project.span(second.action)
    length = lead + max(LEAST, min(second.blend + AROUND, max(second.blend, high - low)))
    return ManualPlan(1, length, {target.layer: ManualLayer(target.layer, (first, second))})


# --- the pose at a time


class ManualEvaluator:
    """What manual state machines play, as poses and weights of face shapes."""

    def __init__(self, plan: ManualPlan, project: Project) -> None:
        """Raises ValueError for a project without a skeleton."""
        rigs = get_rigs(project)
        self.plan, self.project, self._rig = plan, project, rigs.composer
        self._lives = project.life.on and plan.life.end > 0
        self._life = LifeStage(project, plan.life, Track(), rigs.body)

    def at(self, seconds: Any, alive: bool = True) -> Pose:
        """Return the composed pose at `seconds`, a number or an array `[...]`: rotations `[..., J, 4]`,
        translations `[..., J, 3]`. Layers add up as the meta-graph's do. alive: with life, as far as the
        project has it on.
        """
        at = np.asarray(seconds, np.float64)
        times, rig = at.reshape(-1), self._rig
        layers = {}
        for layer, of in self.plan.layers.items():
            if of.played and len(times):
                layers[layer] = _layer(of, self.project, rig.ground, rig.reach[layer], times)
        pose = rig.compose(layers, len(times))
        if alive and self._lives:
            pose = self._life.run(pose, times)
        shape = (*at.shape, len(rig.ground.skeleton))
        return Pose(pose.rotations.reshape(*shape, 4), pose.translations.reshape(*shape, 3))

    def morphs_at(self, seconds: float, alive: bool = True) -> dict[str, float]:
        """Return morph target weights, 0..1, at one time: the layers' sums, and with `alive` life's on
        top.
        """
        out: dict[str, float] = {}
        for of in self.plan.layers.values():
            for turn, weight in of.shares(seconds):
                motion = find_playable_motion(self.project, turn.action)
                if motion is not None:
                    at = float(compute_clip_seconds(self.project, turn, seconds))
                    for name, value in motion.morphs_at(at).items():
                        out[name] = out.get(name, 0.0) + weight * value
        if alive and self._lives:
            composed = self.at(seconds, alive=False) if self._life.body.face.morphs else None
            add_life(out, self._life.morphs(seconds, composed))
        return {name: min(1.0, max(0.0, value)) for name, value in out.items()}

    def faces_at(self, times: Array) -> list[dict[str, float]]:
        """Return morph target weights, 0..1, at each of `times [N]`."""
        return [self.morphs_at(float(time)) for time in times]


def _layer(plan: ManualLayer, project: Project, ground: Ground, reach: Reach, times: Array) -> Sample:
    """Return a layer's offsets at `times [N]`: rotations `[N, n, 4]`, translations `[N, n, 3]`."""
    current = np.maximum(plan.starts.searchsorted(times, "right") - 1, 0)
    rotations = np.empty((len(times), len(reach.joints), 4), np.float32)
    translations = np.empty((len(times), len(reach.joints), 3), np.float32)
    for number in np.unique(current):
        here = np.flatnonzero(current == number)
        turn = plan.played[number]
        shown = _offsets(turn, project, ground, reach, times[here])
        fading = times[here] < turn.start + turn.blend
        if number > 0 and fading.any():
            before = _offsets(plan.played[number - 1], project, ground, reach, times[here])
            shown = crossfade(
                before,
                shown,
                np.where(fading, ease_blend((times[here] - turn.start) / max(turn.blend, 1e-9)), 1.0),
            )
        rotations[here], translations[here] = shown
    return rotations, translations


def compute_clip_seconds(project: Project, turn: Played, times: Any) -> Any:
    """Return the clip seconds a turn shows at `times [...]`: round and round in a loop, else up to the end,
    where it holds.
    """
    start, end = project.span(turn.action)
    elapsed = turn.entry + np.maximum(times - turn.start, 0.0)
    if turn.action.timing.loop and end > start:
        return start + np.mod(elapsed - start, end - start)
    return np.minimum(elapsed, end)


def _offsets(turn: Played, project: Project, ground: Ground, reach: Reach, times: Array) -> Sample:
    """Return what a state adds to the base pose; joints it does not move, and all where its clip is missing,
    add nothing.
    """
    motion = find_playable_motion(project, turn.action)
    if motion is None:
        return make_zero_offsets(len(times), len(reach.joints))
    shown = sample_offsets(ground, reach, motion, compute_clip_seconds(project, turn, times))
    mask = anatomy.make_action_mask(project, turn.action)
    if mask is not None:
        none = rotation.make_identity_rotations(shown[0].shape[:-1], np.float32), np.zeros_like(shown[1])
        keep_to(shown, none, mask[reach.joints])
    return shown
