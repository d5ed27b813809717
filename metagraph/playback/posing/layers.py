"""Compute what the layers of a plan add to the base pose, at one or many times: clips are played, faded, and
led in from and out to their stances.
"""

from __future__ import annotations

from collections.abc import Callable
from math import inf
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.graph import anatomy
from metagraph.graph.model import LAYERS, Action, Layer, Project
from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.motion.skeleton import Pose
from metagraph.playback.plan import Cue, LayerPlan, Plan, Rest
from metagraph.playback.posing.composer import ComposerRig, Ground, Reach, find_playable_motion
from metagraph.playback.posing.cue_times import seam_left

Array = NDArray[Any]
# Offsets on the joints a layer reaches: rotations [N, n, 4], translations [N, n, 3].
Sample = tuple[Array, Array]

# A clip is led while no joint is farther from the stance than the first, and crossfaded where one is farther
# than the second: cosines of half that turn, about 30 and 60 degrees.
LEAD_WITHIN, FADE_BEYOND = 0.966, 0.866

_RESTING, _ENTERING, _FULL, _LEAVING = range(4)  # a cue's phases
Met = tuple[int, bool, int, int]  # index of the rest, whether it fades in, index of the cue, the cue's phase


class LayersStage:
    """Composes the layers of a plan."""

    def __init__(self, plan: Plan, project: Project, rig: ComposerRig) -> None:
        self._rig = rig
        self._layers = {
            layer: _LayerStage(of, project, rig.ground, rig.reach[layer])
            for layer in LAYERS
            if (of := plan.layers[layer]).rests
        }

    def offsets(self, times: Array) -> dict[Layer, Sample]:
        """Return what each layer adds at `times [N]`, on the joints it reaches."""
        return {layer: of.offsets(times) for layer, of in self._layers.items()} if len(times) else {}

    def run(self, times: Array) -> Pose:
        """Return what the layers compose at `times [N]`: rotations `[N, J, 4]`, translations `[N, J, 3]`."""
        return self._rig.compose(self.offsets(times), len(times))


class _LayerStage:
    """One layer of a plan."""

    def __init__(self, plan: LayerPlan, project: Project, ground: Ground, reach: Reach) -> None:
        self._plan, self._project, self._ground, self._reach = plan, project, ground, reach
        self._scales = anatomy.find_joint_scales(project)[:, reach.joints]
        self._lately: tuple[float, float, Met] = (
            inf,
            inf,
            (0, False, 0, 0),
        )  # start and end of a time span, and what plays in it

    def offsets(self, times: Array) -> Sample:
        """Return the layer's offsets at `times [N]`."""
        if len(times) == 1:
            return self._together(times, *self._meets(float(times[0])))
        alike: dict[Met, list[int]] = {}  # what plays -> indices of the times
        for n, time in enumerate(times.tolist()):
            alike.setdefault(self._meets(time), []).append(n)
        if len(alike) == 1:
            return self._together(times, *next(iter(alike)))
        count = len(self._reach.joints)
        out = np.empty((len(times), count, 4), np.float32), np.empty((len(times), count, 3), np.float32)
        for met, here in alike.items():
            out[0][here], out[1][here] = self._together(times[here], *met)
        return out

    def _meets(self, time: float) -> Met:
        """Return what plays at a time."""
        begin, until, met = self._lately
        if begin <= time < until:
            return met
        plan = self._plan
        current = max(int(plan.fade_starts.searchsorted(time, "right")) - 1, 0)
        playing = int(plan.starts.searchsorted(time, "right")) - 1
        edges = [plan.fade_ends[current], *plan.fade_starts[current + 1 : current + 2]]
        edges += plan.starts[playing + 1 : playing + 2].tolist()
        phase = _RESTING
        if playing >= 0:
            ends = plan.full_from[playing], plan.full_to[playing], plan.ends[playing]
            edges += ends
            if time < ends[2]:
                phase = _ENTERING if time < ends[0] else _LEAVING if time >= ends[1] else _FULL
        met = current, current > 0 and bool(plan.fade_ends[current] > time), playing, phase
        self._lately = time, min((edge for edge in edges if edge > time), default=inf), met
        return met

    def _together(self, times: Array, current: int, fading: bool, playing: int, phase: int) -> Sample:
        """Return offsets at `times [N]` that all have the same rest and the same phase of the same cue."""
        project, plan, reach = self._project, self._plan, self._reach
        cue = plan.cues[playing] if phase != _RESTING else None
        motion = find_playable_motion(project, cue.action) if cue is not None else None
        if cue is None or motion is None:
            return self._stance(times, current, fading)
        shown = sample_cue(cue, times, lambda seconds: self._sample(motion, seconds))
        mask = anatomy.make_action_mask(project, cue.action)
        moved = None if mask is None or (mask[reach.joints] == 1).all() else mask[reach.joints]
        if phase == _FULL and moved is None and cue.extent == 1:
            return shown
        stance = self._stance(times, current, fading)
        if phase != _FULL and cue.repeats:
            shown = crossfade(stance, shown, compute_cue_weight(cue, times))  # at its ends it moves
        elif phase != _FULL:
            edge = self._sample(motion, np.array([cue.entry if phase == _ENTERING else cue.last]))
            shown = _blend(shown, stance, edge, compute_cue_weight(cue, times))
        if cue.extent != 1:
            shown = _extended(shown, stance, cue.extent, self._scales)
        if moved is not None:
            keep_to(shown, stance, moved)
        return shown

    def _stance(self, times: Array, current: int, fading: bool) -> Sample:
        """Return the offsets of the stance under the cues."""
        rest = self._plan.rests[current]
        found = self._rest(rest, times)
        if not fading:
            return found
        before = self._rest(self._plan.rests[current - 1], times)
        return crossfade(before, found, ease_blend((times - rest.fade_start) / rest.fade))

    def _rest(self, rest: Rest, times: Array) -> Sample:
        motion = find_playable_motion(self._project, rest.action)
        if motion is None:
            return make_zero_offsets(len(times), len(self._reach.joints))
        seconds, other, old = compute_loop_seconds(self._project, rest.action, times - rest.start)
        found = self._sample(motion, seconds)
        return crossfade(found, self._sample(motion, other), old) if old.any() else found

    def _sample(self, motion: Clip, seconds: Array) -> Sample:
        return sample_offsets(self._ground, self._reach, motion, seconds)


def make_zero_offsets(count: int, joints: int) -> Sample:
    """Return offsets that leave the base pose unchanged."""
    return rotation.make_identity_rotations((count, joints), np.float32), np.zeros(
        (count, joints, 3), np.float32
    )


def ease_blend(x: Array) -> Array:
    """Return the blending curve: 3x^2 - 2x^3 of x clamped to 0..1."""
    x = np.clip(x, 0.0, 1.0)
    return np.asarray(x * x * (3 - 2 * x))


def sample_cue(cue: Cue, times: Array, sample: Callable[[Array], Sample]) -> Sample:
    """Return what a cue shows of its clip at `times [N]`, without its blends. Where it repeats, it goes on
    from where the cycle before it ended. `sample` returns the clip at seconds of it.
    """
    shown = sample(cue.clip_seconds(times))
    if not cue.repeats:
        return shown
    left = np.array([seam_left(cue, float(time)) for time in times])
    if not left.any():
        return shown
    return _lead(shown, sample(np.array([cue.cycle_to])), sample(np.array([cue.cycle_from])), left)


def compute_cue_weight(cue: Cue, times: Array) -> Array:
    """Return how much of the cue shows at `times [N]`: 0 outside it, rising over its blend in, falling over
    its blend out.
    """
    rise = (
        ease_blend((times - cue.start) / cue.blend_in)
        if cue.blend_in > 0
        else (times >= cue.start).astype(float)
    )
    fall = (
        ease_blend((cue.end - times) / cue.blend_out)
        if cue.blend_out > 0
        else (times < cue.end).astype(float)
    )
    return np.asarray(rise * fall)


def compute_loop_seconds(project: Project, action: Action, elapsed: Array) -> tuple[Array, Array, Array]:
    """Return for seconds since a loop began: clip seconds, clip seconds of the seam's other side, and how
    much of that shows.

    With a seam of x seconds, the loop's last x seconds fade into its first, and its period is x shorter.
    Before its beginning, a loop runs as if it had always been running; one with a seam waits in its first
    pose, so that it starts without a jump.
    """
    start, end = project.span(action)
    length = end - start
    seam = min(max(0.0, action.timing.blend_in), length / 2)
    period = length - seam
    if period <= 0:
        zero = np.zeros_like(elapsed)
        return zero + start, zero + start, zero
    phase = np.mod(np.maximum(elapsed, 0.0) if seam > 0 else elapsed, period)
    if seam <= 0 or not (phase < seam).any():
        return start + phase, start + phase, np.zeros_like(phase)
    old = np.where(elapsed >= period, 1 - ease_blend(phase / seam), 0.0)
    return start + phase, start + np.minimum(period + phase, length), old


def keep_to(shown: Sample, rest: Sample, moved: Array) -> None:
    """Change a sample in place for joints that move in part, or not at all. `moved [n]`, 0..1, is how far
    they go from the rest to the sample.
    """
    still, soft = np.flatnonzero(moved == 0), np.flatnonzero((moved > 0) & (moved < 1))
    for part, other in zip(shown, rest, strict=True):
        part[:, still] = other[:, still]
    if len(soft) == 0:
        return
    weight = np.broadcast_to(moved[soft], (len(shown[0]), len(soft)))
    shown[0][:, soft] = rotation.nlerp(rest[0][:, soft], shown[0][:, soft], weight)
    shown[1][:, soft] = rest[1][:, soft] + (shown[1][:, soft] - rest[1][:, soft]) * weight[..., None]


def _extended(shown: Sample, stance: Sample, extent: float, scales: Array) -> Sample:
    """Play a sample larger or smaller around its stance. `scales [2, n]` is as in
    `anatomy.find_joint_scales`.
    """
    share = (extent - 1) * scales[0 if extent > 1 else 1]
    apart = rotation.multiply(rotation.conjugate(stance[0]), shown[0])
    factor = 1 + share * ease_blend((np.abs(apart[..., 3]) - 0.1) / 0.4)  # mood.turn_extent
    moved = stance[1] + (shown[1] - stance[1]) * (1 + share[:, None])
    return rotation.multiply(stance[0], rotation.scale_rotation(apart, factor)).astype(np.float32), moved


def _blend(shown: Sample, stance: Sample, edge: Sample, weight: Array) -> Sample:
    """Blend a clip in from, or out to, its stance, with `weight [N]` of the clip: lead it where its pose at
    that edge is near the stance, crossfade where a joint has far to turn, and mix both between.

    Led from afar, a limb would do its whole movement around a pose that the clip never has: hands that wave
    overhead would swing through the body on their way up.
    """
    led = _lead(shown, stance, edge, 1 - weight)
    near = np.abs(np.einsum("...i,...i->...", edge[0], stance[0])).min(axis=-1, initial=1.0)
    far = ease_blend((LEAD_WITHIN - near) / (LEAD_WITHIN - FADE_BEYOND))
    return crossfade(led, crossfade(stance, shown, weight), far) if far.any() else led


def _lead(shown: Sample, stance: Sample, edge: Sample, weight: Array) -> Sample:
    """Lead a clip in from, or out to, its stance: add `weight [N]` of the difference between the stance and
    the clip's pose at that edge.

    A plain crossfade would hold the clip back and then hurry it, up to 1.7 times as fast as it was made. This
    way the clip keeps its own speed, and if it begins in its stance, there is almost nothing to add.
    """
    w = weight.astype(np.float32)[:, None, None]
    apart = rotation.multiply(rotation.conjugate(edge[0]), stance[0])
    return rotation.multiply(shown[0], _part(apart, w)), shown[1] + (stance[1] - edge[1]) * w


def _part(turn: Array, weight: Array) -> Array:
    """Return part of a turn: the normalised straight line from no rotation."""
    out = turn * np.where(turn[..., 3:] < 0, -weight, weight)
    out[..., 3:] += 1 - weight
    return _unit(out)


def _unit(q: Array) -> Array:
    q /= np.sqrt(np.maximum(np.einsum("...i,...i->...", q, q), 1e-20))[..., None]
    return q


def crossfade(a: Sample, b: Sample, weight: Array) -> Sample:
    """Crossfade two samples, with `weight [N]` of the second."""
    w = weight.astype(np.float32)[:, None]
    return rotation.nlerp(a[0], b[0], np.broadcast_to(w, b[0].shape[:-1])), a[1] + (b[1] - a[1]) * w[
        ..., None
    ]


def sample_offsets(ground: Ground, reach: Reach, clip: Clip, seconds: Array) -> Sample:
    """Return a clip's offsets at clip seconds `[N]`. The arrays belong to the caller."""
    offsets = ground.offsets(clip, reach)
    low, high, part = clip.dense.locate(seconds)
    w = part[:, None, None]
    a = offsets.rotations[low]
    mixed = _unit(a + (offsets.rotations[high] - a) * w)  # neighbours are on the same side
    away = np.zeros((len(low), len(reach.joints), 3), np.float32)
    if len(offsets.moved):
        a = offsets.translations[low]
        away[:, offsets.moved] = a + (offsets.translations[high] - a) * w
    return mixed, away
