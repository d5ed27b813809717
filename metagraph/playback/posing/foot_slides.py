"""Measure whether feet stay where they stand: which foot is held, steps or is in the air at a time, and how
fast a standing foot slides. The window's marks and the counts of `tests/benchmarks` come from here.

A foot is two joints if the skeleton has toes, ankle and toes: a foot that rolls over its toes still stands.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import IntEnum
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.graph import anatomy
from metagraph.graph.model import Action, Project
from metagraph.motion.clip import Clip
from metagraph.playback.plan import Plan
from metagraph.playback.posing.composer import find_playable_motion
from metagraph.playback.posing.feet import STANDS as HELD_BELOW
from metagraph.playback.posing.feet import FeetOfPlan
from metagraph.playback.posing.layers import compute_cue_weight, compute_loop_seconds
from metagraph.playback.posing.rigs import get_rigs
from metagraph.playback.posing.weight import find_foot_rows, has_planted_feet

Array = NDArray[Any]

SIDES = ("left", "right")
# Slides are measured over a quarter of a second: from frame to frame, clips stored in 16 bits tremble by a
# tenth of a millimetre, which is 3 mm/s that nobody sees.
WINDOW = 0.25
RATE = 24.0  # samples a second of `FeetSeen`; six of them make a window
HALF = round(WINDOW * RATE) // 2  # samples of half a window
SLIDES = 0.010  # metres a second from which a standing foot counts as sliding; our choice
STEPS = 0.0005  # metres by which a step lifts a foot higher than it would be
CLEAR = 0.02  # of the height: a foot with all joints that much above where it stands is in the air
KEPT = 20_000  # samples that are kept
STILL = 64  # frames of a clip; the lowest of them show where its feet stand


class FootState(IntEnum):
    """HELD: the foot stands. STEPPING: it moves near the ground. LIFTED: it is in the air."""

    HELD = 0
    STEPPING = 1
    LIFTED = 2


@dataclass(frozen=True, eq=False)
class FeetSeen:
    """Both feet over times.

    `states` `[N, 2]` has a `FootState` for left and right. `slides` `[N, 2]` has metres a second over a
    window around the time for standing feet, else 0. `places` `[N, 2, 3]` says where a foot is, in metres.
    """

    times: Array
    states: Array
    slides: Array
    places: Array

    def sliding(self, least: float = SLIDES) -> Array:
        """Return which feet slide faster than `least` metres a second, `[N, 2]`."""
        return np.asarray(self.slides > least)


def find_feet_joints(project: Project) -> list[list[int]]:
    """Return the joints of the left and the right foot; an empty list if a foot is missing."""
    roles = anatomy.project_roles(project)
    out = [[roles[f"{s}_{p}"] for p in ("foot", "toes") if f"{s}_{p}" in roles] for s in SIDES]
    return out if all(out) else []


def measure_slide_speeds(places: Array, rate: float) -> Array:
    """Return how fast places `[N, ..., 3]`, `rate` a second, move `[N - w, ...]` in the window that begins at
    each, in metres a second, from its beginning to its end.
    """
    window = max(1, round(WINDOW * rate))
    return np.asarray(np.linalg.norm(places[window:] - places[:-window], axis=-1) / (window / rate))


def measure_clip_speeds(plan: Plan, project: Project, times: Array) -> tuple[Array, Array]:
    """Return what the layer that moves the legs plays at each time `[N]`, as words, and how fast its clips
    themselves move the joints of the feet `[N, F]` in the window that begins there, in metres a second. Of
    two that blend, the faster one counts. `times` ascend.
    """
    skeleton = project.skeleton
    assert skeleton is not None
    layer = plan.layers[get_rigs(project).weight.feet_layer or "body"]
    feet = [joint for side in find_feet_joints(project) for joint in side]
    own, kind = np.zeros((len(times), len(feet))), np.full(len(times), "loops", object)

    def speed(action: Action, seconds: Array) -> Array:
        clip = find_playable_motion(project, action)
        if clip is None or not len(seconds):
            return np.zeros((len(seconds), len(feet)))
        ends = [
            skeleton.globals(clip.pose_at(np.clip(s, 0, clip.duration)))[1][:, feet]
            for s in (seconds, seconds + WINDOW / 2, seconds + WINDOW)
        ]
        return np.asarray(np.maximum(*(np.linalg.norm(end - ends[0], axis=-1) for end in ends[1:])) / WINDOW)

    current = np.maximum(layer.fade_starts.searchsorted(times, "right") - 1, 0)
    for n in np.unique(current) if layer.rests else ():
        here, rest = np.flatnonzero(current == n), layer.rests[n]
        seconds, _, old = compute_loop_seconds(project, rest.action, times[here] - rest.start)
        own[here] = speed(rest.action, seconds)
        kind[here[old > 0]] = "loops' seams"
        fading = here[times[here] < rest.fade_start + rest.fade] if n else here[:0]
        if len(fading):
            before = layer.rests[n - 1]
            seconds, _, _ = compute_loop_seconds(project, before.action, times[fading] - before.start)
            own[fading] = np.maximum(own[fading], speed(before.action, seconds))
            kind[fading] = "loop to loop"
    first = max(0, int(layer.starts.searchsorted(times[0], "right")) - 1) if len(times) else 0
    for cue in layer.cues[first:]:
        if cue.start > times[-1]:
            break
        here = np.flatnonzero((times >= cue.start) & (times < cue.end))
        weight = compute_cue_weight(cue, times[here])
        shown = speed(cue.action, np.asarray(cue.clip_seconds(times[here])))
        own[here] = np.where((weight >= 1)[:, None], shown, np.maximum(own[here], shown))
        kind[here] = np.where(weight >= 1, f"{cue.action.kind}s", f"{cue.action.kind}s' blends")
    return kind, own


class FeetWatch:
    """Watches the feet of what plays, and remembers them.

    `places_at` returns the joints' places `[N, J, 3]` at times `[N]`. `plan` has the clips that say when a
    foot stands; None if the motion itself says it, as for a single clip, which is `clip`.
    """

    def __init__(
        self,
        project: Project,
        places_at: Callable[[Array], Array],
        length: float,
        plan: Plan | None = None,
        clip: Clip | None = None,
    ) -> None:
        self.project, self.plan, self.length = project, plan, length
        self.feet = find_feet_joints(project) if project.skeleton is not None else []
        self._joints = [joint for side in self.feet for joint in side]
        self._places_at, self._clip = places_at, clip
        weight = get_rigs(project).weight if self.feet else None
        rig = weight.rig if weight is not None else None
        self._height = rig.height if rig is not None else project.skeleton.height if project.skeleton else 1.0
        layer = weight.feet_layer if weight is not None else None
        steps = plan is not None and has_planted_feet(project) and rig is not None
        self.layer = layer or "body"
        rows = partial(find_foot_rows, weight) if steps and weight is not None else None
        self._goals = FeetOfPlan(rows, self._height, layer) if rows and layer else None
        self._floor: Array | None = None
        self._known: dict[int, tuple[Array, Array, Array]] = {}  # by sample: places, clips' speeds, steps

    def look(self, numbers: range, most: int | None = None) -> bool:
        """Look at the times `number / RATE` that are not known yet, at most `most` poses from the first on.
        Return whether all are known.
        """
        missing = [n for n in _widened(numbers) if n not in self._known] if self._joints else []
        if len(self._known) + len(missing) > KEPT:
            self._known.clear()
            missing = list(_widened(numbers))
        some = missing[:most]
        if some:
            times = np.array(some) / RATE
            at = np.asarray(self._places_at(np.clip(times, 0.0, self.length)), float)[:, self._joints]
            own = np.zeros(at.shape[:2])
            if self.plan is not None:
                own = measure_clip_speeds(self.plan, self.project, np.maximum(times, 0.0))[1]
            self._known.update(zip(some, zip(at, own, self._stepping(times), strict=True), strict=True))
        return len(some) == len(missing)

    def at(self, numbers: range) -> FeetSeen:
        """Return both feet at the times `number / RATE`, looking at all that are not known yet."""
        self.look(numbers)
        times = np.array(numbers) / RATE
        if not self._joints or not len(times):
            none = np.zeros((0, 2))
            return FeetSeen(times[:0], none.astype(int), none, np.zeros((0, 2, 3)))
        rows = [self._known[n] for n in _widened(numbers)]
        at, own, steps = (np.array(part) for part in zip(*rows, strict=True))
        speed = measure_slide_speeds(at, RATE)  # of the windows that begin at each sample
        if self.plan is None:
            own = speed
        count = len(times)
        # A foot stands if it stands in the windows before, around and after the time, and steps in none.
        own = np.max([own[k : k + count] for k in (0, HALF, 2 * HALF)], axis=0)
        still = own < HELD_BELOW * self._height
        near = np.any([steps[k : k + count] for k in range(HALF, 3 * HALF + 1)], axis=0)
        steps, here = steps[2 * HALF : 2 * HALF + count], at[2 * HALF : 2 * HALF + count]
        clear = here[..., 1] - self.floor() > CLEAR * self._height
        round_it = speed[HALF : HALF + count]
        states, slides = np.full((count, 2), int(FootState.STEPPING)), np.zeros((count, 2))
        places = np.zeros((count, 2, 3))
        first = len(self.feet[0])
        for n, side in enumerate((slice(0, first), slice(first, None))):
            air = clear[:, side].all(1)
            held = still[:, side].any(1) & ~air & ~steps[:, n]
            states[air, n] = int(FootState.LIFTED)
            states[held, n] = int(FootState.HELD)
            # A foot that turns about its heel or its toes does not slide: its slower end counts.
            slides[:, n] = np.where(held & ~near[:, n], round_it[:, side].min(1), 0.0)
            places[:, n] = here[:, side].mean(1)
        return FeetSeen(times, states, slides, places)

    def floor(self) -> Array:
        """Return how high each joint of the feet is while standing `[F]`, in metres: the lowest in the clip,
        or in the loop that the performance begins with.
        """
        if self._floor is None:
            assert self.project.skeleton is not None
            motion = self._clip
            rests = self.plan.layers[self.layer].rests if self.plan is not None else ()
            if motion is None and rests:
                motion = find_playable_motion(self.project, rests[0].action)
            if motion is not None:
                poses = motion.pose_at(np.linspace(0.0, motion.duration, STILL))
            else:
                poses = anatomy.get_base_pose(self.project)
            heights = self.project.skeleton.globals(poses)[1][..., self._joints, 1]
            self._floor = np.asarray(np.percentile(heights.reshape(-1, len(self._joints)), 5, axis=0))
        return self._floor

    def _stepping(self, times: Array) -> Array:
        """Return which feet are moved by a step where poses blend, `[N, 2]`."""
        out = np.zeros((len(times), 2), bool)
        if self._goals is None or self.plan is None:
            return out
        for n, time in enumerate(times.tolist()):
            for side, goal in enumerate(self._goals.goals(self.plan, self.project, time)):
                out[n, side] = goal.lift * goal.planted > STEPS
        return out


def _widened(numbers: range) -> range:
    """Return the samples that are needed for others: also a window before and after."""
    return range(numbers.start - 2 * HALF, numbers.stop + 2 * HALF)


def find_worst_slide(seen: FeetSeen) -> tuple[float, int, float] | None:
    """Return time, side and speed, in metres a second, of the fastest slide; None if there is none."""
    if not len(seen.times) or not seen.sliding().any():
        return None
    n, side = np.unravel_index(int(np.argmax(seen.slides)), seen.slides.shape)
    return float(seen.times[n]), int(side), float(seen.slides[n, side])
