"""The one evaluator: what pose a plan gives at a time, or at many times at once.

Preview, video, export and tests all come here, so scrubbing, live play and a baked file agree.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any
from weakref import ref

import numpy as np
from numpy.typing import NDArray

from metagraph.graph import anatomy
from metagraph.graph.model import LAYERS, Action, Layer, Project
from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.motion.skeleton import Pose
from metagraph.playback.composer import Ground, Reach, playable, rig
from metagraph.playback.contacts import touched
from metagraph.playback.life.body import body_of
from metagraph.playback.life.evaluate import Playing, enliven, face_weights
from metagraph.playback.plan import Cue, LayerPlan, Plan, Rest
from metagraph.playback.weight import weighed

Array = NDArray[Any]


def ease(x: Array) -> Array:
    """The blending curve: 3x^2 - 2x^3 of x clamped to 0..1."""
    x = np.clip(x, 0.0, 1.0)
    return np.asarray(x * x * (3 - 2 * x))


def pose_at(plan: Plan, project: Project, seconds: Any, alive: bool = True) -> Pose:
    """Return the composed pose at `seconds`, a number or an array `[...]`: rotations `[..., J, 4]`,
    translations `[..., J, 3]`.

    alive: with the life layers, as far as the project has them on. Times before 0 and after the plan's end
    rest in the first and last stance. Actions whose clip is missing show their stance. Raises ValueError when
    the project has no skeleton.
    """
    at = np.asarray(seconds, np.float64)
    times = at.reshape(-1)
    frame = rig(project)
    pose = layered(plan, project, times)
    if alive and project.life.on and plan.life.end > 0 and len(times):
        pose = weighed(pose, plan, project, times)
        if len(times) == 1:  # whose face is mostly asked for next
            _latest[:] = [(ref(plan), ref(project), float(times[0]), _alone(pose))]
        pose = enliven(pose, project, plan.life, plan.track, times)
    pose = touched(pose, plan, project, times)
    shape = (*at.shape, len(frame.ground.skeleton))
    return Pose(pose.rotations.reshape(*shape, 4), pose.translations.reshape(*shape, 3))


# The latest pose at one time that life was added to: plan, project, time and pose.
_latest: list[tuple[ref[Plan], ref[Project], float, Pose]] = []


def _weighed_at(plan: Plan, project: Project, seconds: float) -> Pose:
    """Return the pose `[J]` at one time that the other life layers are added to."""
    for of, whose, when, pose in tuple(_latest):
        if of() is plan and whose() is project and when == seconds:
            return pose
    return _alone(before_life(plan, project, np.array([float(seconds)])))


def before_life(plan: Plan, project: Project, times: Array) -> Pose:
    """Return the poses `[T]` that the other life layers are added to."""
    return weighed(layered(plan, project, times), plan, project, times)


def _alone(pose: Pose) -> Pose:
    """Return the only pose of several, in memory of its own."""
    return Pose(pose.rotations[0].copy(), pose.translations[0].copy())


def layered(plan: Plan, project: Project, times: Array) -> Pose:
    """Return what the layers alone compose at `times [N]`: rotations `[N, J, 4]`, translations `[N, J,
    3]`.
    """
    return rig(project).compose(layers_at(plan, project, times), len(times))


def layers_at(plan: Plan, project: Project, times: Array) -> dict[Layer, Sample]:
    """Return what each layer adds at `times [N]`, on the joints it reaches."""
    frame, out = rig(project), {}
    for layer in LAYERS:
        if plan.layers[layer].rests and len(times):
            out[layer] = _layer(plan.layers[layer], project, frame.ground, frame.reach[layer], times)
    return out


def cue_weight(cue: Cue, times: Array) -> Array:
    """Return how much of the cue shows at `times [N]`: 0 outside it, rising over its blend in, falling over
    its blend out.
    """
    rise = (
        ease((times - cue.start) / cue.blend_in) if cue.blend_in > 0 else (times >= cue.start).astype(float)
    )
    fall = ease((cue.end - times) / cue.blend_out) if cue.blend_out > 0 else (times < cue.end).astype(float)
    return np.asarray(rise * fall)


def loop_seconds(project: Project, action: Action, elapsed: Array) -> tuple[Array, Array, Array]:
    """Return for seconds since a loop began: clip seconds, clip seconds of the seam's other side, and how
    much of that shows.

    With a seam of x seconds the loop's last x seconds fade into its first, and its period is x shorter.
    Before its beginning a loop runs as if it had gone on for ever; one with a seam waits in its first pose,
    so that it starts without a jump.
    """
    start, end = project.span(action)
    length = end - start
    seam = min(max(0.0, action.timing.blend_in), length / 2)
    period = length - seam
    if period <= 0:
        zero = np.zeros_like(elapsed)
        return zero + start, zero + start, zero
    phase = np.mod(np.maximum(elapsed, 0.0) if seam > 0 else elapsed, period)
    if seam <= 0:
        return start + phase, start + phase, np.zeros_like(phase)
    old = np.where(elapsed >= period, 1 - ease(phase / seam), 0.0)
    return start + phase, start + np.minimum(period + phase, length), old


Sample = tuple[
    Array, Array
]  # offsets on the joints a layer reaches: rotations [N, n, 4], translations [N, n, 3]

_RESTING, _ENTERING, _FULL, _LEAVING = range(4)  # a cue's phases


def _layer(plan: LayerPlan, project: Project, ground: Ground, reach: Reach, times: Array) -> Sample:
    """Return a layer's offsets at `times [N]`."""
    current = np.maximum(plan.fade_starts.searchsorted(times, "right") - 1, 0)
    fading = (plan.fade_ends[current] > times) & (current > 0)
    playing = plan.starts.searchsorted(times, "right") - 1
    phase = np.zeros(len(times), np.int64)
    if plan.cues:
        on = (playing >= 0) & (times < plan.ends[playing])
        entering, leaving = times < plan.full_from[playing], times >= plan.full_to[playing]
        phase = np.where(on, np.where(entering, _ENTERING, np.where(leaving, _LEAVING, _FULL)), _RESTING)
    # Times that meet the same rest, cue and phase are worked out together.
    group = ((current * 2 + fading) * (len(plan.cues) + 1) + playing + 1) * 4 + phase
    if (group == group[0]).all():
        return _together(
            plan,
            project,
            ground,
            reach,
            times,
            int(current[0]),
            bool(fading[0]),
            int(playing[0]),
            int(phase[0]),
        )
    rotations = np.empty((len(times), len(reach.joints), 4), np.float32)
    translations = np.empty((len(times), len(reach.joints), 3), np.float32)
    for number in np.unique(group):
        here = np.flatnonzero(group == number)
        k = here[0]
        found = _together(
            plan,
            project,
            ground,
            reach,
            times[here],
            int(current[k]),
            bool(fading[k]),
            int(playing[k]),
            int(phase[k]),
        )
        rotations[here], translations[here] = found
    return rotations, translations


def _together(
    plan: LayerPlan,
    project: Project,
    ground: Ground,
    reach: Reach,
    times: Array,
    current: int,
    fading: bool,
    playing: int,
    phase: int,
) -> Sample:
    """Return offsets at `times [N]` that all meet the same rest and the same phase of the same cue."""
    cue = plan.cues[playing] if phase != _RESTING else None
    motion = playable(project, cue.action) if cue is not None else None
    if cue is None or motion is None:
        return _stance(plan, project, ground, reach, times, current, fading)
    shown = sample(ground, reach, motion, cue.clip_seconds(times))
    mask = anatomy.mask(project, cue.action)
    moved = None if mask is None or (mask[reach.joints] == 1).all() else mask[reach.joints]
    if phase == _FULL and moved is None and cue.extent == 1:
        return shown
    stance = _stance(plan, project, ground, reach, times, current, fading)
    if phase != _FULL:
        edge = cue.entry if phase == _ENTERING else cue.last
        shown = _lead(
            shown, stance, sample(ground, reach, motion, np.array([edge])), 1 - cue_weight(cue, times)
        )
    if cue.extent != 1:
        shown = _extended(shown, stance, cue.extent, anatomy.scales(project)[:, reach.joints])
    if moved is not None:
        keep_to(shown, stance, moved)
    return shown


def keep_to(shown: Sample, rest: Sample, moved: Array) -> None:
    """Change a sample in place where joints move only in part, or not at all: how far, `moved [n]` 0..1, they
    go from where they rest to where they are shown.
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
    """Play a sample larger or smaller round its stance. scales `[2, n]`: as `anatomy.scales`."""
    share = (extent - 1) * scales[0 if extent > 1 else 1]
    apart = rotation.multiply(rotation.conjugate(stance[0]), shown[0])
    factor = 1 + share * ease((np.abs(apart[..., 3]) - 0.1) / 0.4)  # mood.turn_extent
    moved = stance[1] + (shown[1] - stance[1]) * (1 + share[:, None])
    return rotation.multiply(stance[0], rotation.power(apart, factor)).astype(np.float32), moved


def _lead(shown: Sample, stance: Sample, edge: Sample, weight: Array) -> Sample:
    """Lead a clip in from, or out to, its stance: add `weight [N]` of what the stance differs from the clip's
    pose at that edge.

    A plain crossfade would hold the clip back and then hurry it, up to 1.7 times as fast as it was made; this
    way the clip keeps its own speed, and where it begins in its stance there is next to nothing to add.
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


def mix(a: Sample, b: Sample, weight: Array) -> Sample:
    """Crossfade two samples, `weight [N]` of the second."""
    w = weight.astype(np.float32)[:, None]
    return rotation.nlerp(a[0], b[0], np.broadcast_to(w, b[0].shape[:-1])), a[1] + (b[1] - a[1]) * w[
        ..., None
    ]


def _stance(
    plan: LayerPlan, project: Project, ground: Ground, reach: Reach, times: Array, current: int, fading: bool
) -> Sample:
    """Return the offsets of the stance that lies under the cues."""
    rest = plan.rests[current]
    found = _rest(rest, project, ground, reach, times)
    if not fading:
        return found
    before = _rest(plan.rests[current - 1], project, ground, reach, times)
    return mix(before, found, ease((times - rest.fade_start) / rest.fade))


def _rest(rest: Rest, project: Project, ground: Ground, reach: Reach, times: Array) -> Sample:
    motion = playable(project, rest.action)
    if motion is None:
        count, joints = len(times), len(reach.joints)
        return rotation.identity((count, joints), np.float32), np.zeros((count, joints, 3), np.float32)
    seconds, other, old = loop_seconds(project, rest.action, times - rest.start)
    found = sample(ground, reach, motion, seconds)
    return mix(found, sample(ground, reach, motion, other), old) if old.any() else found


def sample(ground: Ground, reach: Reach, clip: Clip, seconds: Array) -> Sample:
    """Return a clip's offsets at clip seconds `[N]`; the arrays are the caller's."""
    offsets = ground.offsets(clip, reach)
    low, high, part = clip.locate(seconds)
    w = part[:, None, None]
    a = offsets.rotations[low]
    mixed = _unit(a + (offsets.rotations[high] - a) * w)  # neighbours are on the same side
    away = np.zeros((len(low), len(reach.joints), 3), np.float32)
    if len(offsets.moved):
        a = offsets.translations[low]
        away[:, offsets.moved] = a + (offsets.translations[high] - a) * w
    return mixed, away


def add_life(out: dict[str, float], found: Mapping[str, float]) -> None:
    """Add the life layers' morph target weights to what clips show: as far as that leaves them room, so that
    a face that was made for a moment stays as it was made.
    """
    for name, value in found.items():
        played = out.get(name, 0.0)
        out[name] = played + value * (1 - min(1.0, max(0.0, played)))


def morphs_at(
    plan: Plan, project: Project, seconds: float, alive: bool = True, composed: Pose | None = None
) -> dict[str, float]:
    """Return morph target weights, 0..1, at one time: the layers' sums, and with `alive` the life layers' on
    top (`add_life`). composed: the pose `[J]` before `enliven`, where it is not the plan's alone.
    """
    out: dict[str, float] = {}
    playing: list[Playing] = []
    for layer in LAYERS:
        of = plan.layers[layer]
        cue = of.cue_at(seconds)
        if cue is not None:
            playing.append((cue.action.tags, cue.start, cue.end))
        rest = next(
            (r for r in reversed(of.rests) if r.fade_start <= seconds), of.rests[0] if of.rests else None
        )
        shares: list[tuple[Action, float, float]] = []
        weight = float(cue_weight(cue, np.array([seconds]))[0]) if cue is not None else 0.0
        if cue is not None:
            shares.append((cue.action, float(cue.clip_seconds(seconds)), weight))
        if rest is not None:
            shares.append(
                (
                    rest.action,
                    float(loop_seconds(project, rest.action, np.array([seconds - rest.start]))[0][0]),
                    1 - weight,
                )
            )
        for action, at, share in shares:
            motion = playable(project, action)
            if motion is not None and share > 0:
                for name, value in motion.morphs_at(at).items():
                    out[name] = out.get(name, 0.0) + share * value
    if alive and project.life.on and plan.life.end > 0:
        by_morphs = project.skeleton is not None and bool(body_of(project).face.morphs)
        if by_morphs and composed is None:  # what the eyes hold against
            composed = _weighed_at(plan, project, seconds)
        found = face_weights(project, plan.life, plan.track, seconds, composed, playing)
        add_life(out, found)
    return {name: min(1.0, max(0.0, value)) for name, value in out.items()}
