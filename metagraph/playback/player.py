"""The one evaluator: what pose a plan gives at a time, or at many times at once.

Preview, video, export and tests all come here, so scrubbing, live play and a baked file agree.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.graph import anatomy
from metagraph.graph.model import LAYERS, Action, Project
from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.motion.skeleton import Pose
from metagraph.playback.composer import Ground, rig
from metagraph.playback.plan import Cue, LayerPlan, Plan

Array = NDArray[Any]


def ease(x: Array) -> Array:
    """The blending curve: 3x^2 - 2x^3 of x clamped to 0..1."""
    x = np.clip(x, 0.0, 1.0)
    return np.asarray(x * x * (3 - 2 * x))


def pose_at(plan: Plan, project: Project, seconds: Any) -> Pose:
    """Return the composed pose at `seconds`, a number or an array `[...]`: rotations `[..., J, 4]`, translations `[..., J, 3]`.

    Times before 0 and after the plan's end rest in the first and last stance. Actions whose clip is missing show their stance.
    Raises ValueError when the project has no skeleton.
    """
    at = np.asarray(seconds, np.float64)
    times = at.reshape(-1)
    frame = rig(project)
    layers = {}
    for layer in LAYERS:
        if plan.layers[layer].rests:
            layers[layer] = _layer(plan.layers[layer], project, frame.ground, times)
    pose = frame.compose(layers)
    if len(pose.rotations) != len(times):  # no layer performs: the base pose, for every time
        pose = Pose(np.repeat(pose.rotations, len(times), 0), np.repeat(pose.translations, len(times), 0))
    shape = at.shape
    return Pose(pose.rotations.reshape(*shape, -1, 4), pose.translations.reshape(*shape, -1, 3))


def clip_pose_at(project: Project, action: Action, seconds: Any) -> Pose:
    """Return a clip's own pose at clip seconds `[...]`, not composed: what a clip looks like alone."""
    entry = project.clips[action.clip]
    if entry.motion is None:
        raise ValueError(f"the file of clip '{entry.name}' is missing")
    return entry.motion.pose_at(seconds)


def cue_weight(cue: Cue, times: Array) -> Array:
    """Return how much of the cue shows at `times [N]`: 0 outside it, rising over its blend in, falling over its blend out."""
    rise = ease((times - cue.start) / cue.blend_in) if cue.blend_in > 0 else (times >= cue.start).astype(float)
    fall = ease((cue.end - times) / cue.blend_out) if cue.blend_out > 0 else (times < cue.end).astype(float)
    return np.asarray(rise * fall)


def loop_seconds(project: Project, action: Action, elapsed: Array) -> tuple[Array, Array, Array]:
    """Return for seconds since a loop began: clip seconds, clip seconds of the seam's other side, and how much of that shows.

    With a seam of x seconds the loop's last x seconds fade into its first, and its period is x shorter.
    """
    start, end = project.span(action)
    length = end - start
    seam = min(max(0.0, action.timing.blend_in), length / 2)
    period = length - seam
    if period <= 0:
        zero = np.zeros_like(elapsed)
        return zero + start, zero + start, zero
    phase = np.mod(elapsed, period)
    if seam <= 0:
        return start + phase, start + phase, np.zeros_like(phase)
    old = np.where(elapsed >= period, 1 - ease(phase / seam), 0.0)
    return start + phase, start + np.minimum(period + phase, length), old


def _motion(project: Project, action: Action) -> Clip | None:
    entry = project.clips.get(action.clip)
    motion = entry.motion if entry is not None else None
    return motion if motion is not None and motion.skeleton == project.skeleton else None


def _groups(numbers: Array) -> Iterator[tuple[int, Any]]:
    """Yield each number that occurs and where: a slice when it is everywhere, else places."""
    if not len(numbers):
        return
    first = numbers[0]
    if (numbers == first).all():
        yield int(first), slice(None)
        return
    for number in np.unique(numbers):
        yield int(number), np.flatnonzero(numbers == number)


Sample = tuple[Array, Array]  # rotations, translations
Weight = tuple[Array, Array | None]  # how much at each time, and of which joints


def _layer(plan: LayerPlan, project: Project, ground: Ground, times: Array) -> Sample:
    """Return a layer's offsets at `times [N]`: rotations `[N, J, 4]`, translations `[N, J, 3]`."""
    joints = len(ground.skeleton)
    rotations = rotation.identity((len(times), joints), np.float32)
    translations = np.zeros((len(times), joints, 3), np.float32)

    def each(
        places: Array, sample: Callable[[int, Array], Sample | None], weight: Callable[[int, Array], tuple[Array, Array | None]]
    ) -> None:
        """Blend samples over what is there, for the times whose place is not -1."""
        for place, where in _groups(places):
            found = sample(place, times[where]) if place >= 0 else None
            if found is None:
                continue
            amount, mask = weight(place, times[where])
            w = amount[:, None].astype(np.float32)
            if mask is not None:
                w = w * mask
            if mask is None and (amount == 1).all():
                rotations[where], translations[where] = found
            else:
                rotations[where] = rotation.nlerp(rotations[where], found[0], np.broadcast_to(w, found[0].shape[:-1]))
                translations[where] = translations[where] * (1 - w[..., None]) + found[1] * w[..., None]

    rests, cues = plan.rests, plan.cues
    current = np.maximum(np.searchsorted([r.fade_start for r in rests], times, "right") - 1, 0)
    fading = np.array([r.fade_start + r.fade for r in rests])[current] > times
    before = np.where(fading & (current > 0), current - 1, current)

    def rest_sample(place: int, at: Array) -> Sample | None:
        motion = _motion(project, rests[place].action)
        if motion is None:
            return None
        seconds, other, old = loop_seconds(project, rests[place].action, at - rests[place].start)
        found = _sample(ground, motion, seconds)
        if old.any():
            seam = _sample(ground, motion, other)
            w = old.astype(np.float32)
            return (
                rotation.nlerp(found[0], seam[0], np.broadcast_to(w[:, None], found[0].shape[:-1])),
                found[1] * (1 - w[:, None, None]) + seam[1] * w[:, None, None],
            )
        return found

    def rest_weight(place: int, at: Array) -> Weight:
        rest = rests[place]
        return ease((at - rest.fade_start) / rest.fade) if rest.fade > 0 and place > 0 else np.ones(len(at)), None

    def whole(place: int, at: Array) -> Weight:
        return np.ones(len(at)), None

    each(before, rest_sample, whole)
    if (before != current).any():
        each(np.where(before != current, current, -1), rest_sample, rest_weight)
    if cues:
        playing = np.searchsorted(plan.starts, times, "right") - 1
        ends = np.array([cue.end for cue in cues])
        playing = np.where((playing >= 0) & (times < ends[playing]), playing, -1)

        def cue_sample(place: int, at: Array) -> Sample | None:
            motion = _motion(project, cues[place].action)
            return _sample(ground, motion, cues[place].entry + at - cues[place].start) if motion is not None else None

        def weigh(place: int, at: Array) -> Weight:
            return cue_weight(cues[place], at), anatomy.mask(project, cues[place].action)

        each(playing, cue_sample, weigh)
    return rotations, translations


def _sample(ground: Ground, clip: Clip, seconds: Array) -> Sample:
    """Return a clip's offsets at clip seconds `[n]`, on all joints."""
    offsets = ground.offsets(clip)
    low, high, part = clip.locate(seconds)
    w = part[:, None, None]
    a, b = offsets.rotations[low], offsets.rotations[high]
    mixed = a * (1 - w) + b * w  # neighbours are on the same side
    mixed /= np.sqrt(np.einsum("...i,...i->...", mixed, mixed))[..., None]
    away = np.zeros((len(low), len(ground.skeleton), 3), np.float32)
    away[:, offsets.moved] = offsets.translations[low] * (1 - w) + offsets.translations[high] * w
    return mixed, away


def morphs_at(plan: Plan, project: Project, seconds: float) -> dict[str, float]:
    """Return morph target weights, 0..1, at one time: the layers' sums."""
    out: dict[str, float] = {}
    for layer in LAYERS:
        of = plan.layers[layer]
        cue = of.cue_at(seconds)
        rest = next((r for r in reversed(of.rests) if r.fade_start <= seconds), of.rests[0] if of.rests else None)
        shares: list[tuple[Action, float, float]] = []
        weight = float(cue_weight(cue, np.array([seconds]))[0]) if cue is not None else 0.0
        if cue is not None:
            shares.append((cue.action, cue.entry + seconds - cue.start, weight))
        if rest is not None:
            shares.append((rest.action, float(loop_seconds(project, rest.action, np.array([seconds - rest.start]))[0][0]), 1 - weight))
        for action, at, share in shares:
            motion = _motion(project, action)
            if motion is None or not motion.morphs or motion.weights is None or share <= 0:
                continue
            low, high, part = motion.locate(at)
            values = motion.weights[low] * (1 - part) + motion.weights[high] * part
            for name, value in zip(motion.morphs, values, strict=True):
                out[name] = out.get(name, 0.0) + share * float(value)
    return {name: min(1.0, max(0.0, value)) for name, value in out.items()}
