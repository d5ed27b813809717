"""Which clip can leave and enter which stance without a visible jump, and at which moments (Yang et al.,
section 6).

The cost of going from frame i to frame j is (their equations 3 and 4)
    c_ij = sum_b w_b |p_i[b] - p_(j-1)[b]| + w_v sum_b w_b |v_i[b] - v_(j-1)[b]|
with positions p and velocities v of joints b seen from the root, fingers weighing 0. A jump is what the
user's own motion does not show:
a Johnson S_B distribution is fitted to c_(i, i+3), at 30 frames a second, and 95 % of it are the threshold.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from math import pi
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.common.wording import phrase
from metagraph.graph import anatomy
from metagraph.graph.checks.end_gaps import SHARE_SEEN
from metagraph.graph.model import REACH, Project
from metagraph.graph.words import Layer
from metagraph.motion.clip import Clip
from metagraph.suggest.jumps.johnson import JohnsonSB, fit_johnson
from metagraph.suggest.tracks import (
    RATE,
    make_joint_track,
    measure_velocity,
    track_floor,
    track_rig,
    track_seconds,
)

Array = NDArray[Any]

STEP = 3  # k of c_(i, i+k)
LEVEL = 0.95
MOST_FRAMES = 24  # of a stance's loops, compared with
CHUNK = 2_000_000  # numbers held at once while comparing
ACTIVE = 0.1  # of the way from the least to the greatest speed: alpha_W of equation 2
SEAMLESS = 0.3  # of the threshold: a seam that needs no overlap
BLEND = (0.15, 0.5)  # seconds, shortest and longest
SLOWEST = 0.5  # seconds, the most that w_v can be: of motion whose speed never changes it would be endless
ALIKE = 0.05  # of the threshold: moments that are almost one another
STAYS = 0.015  # heights that hips may be off the spot at which a clip ends when it is left early
UNSEEN = 0.25  # of a clip that a blend takes which nobody would miss
STILL = 1e-3  # metres summed over joints: a threshold below says only that nothing moved
Span = tuple[float, float]


@dataclass(frozen=True, eq=False)
class Statistics:
    """What is usual between frames of a layer. weights `[J]`: of `tracks.Rig.joints`. velocity: w_v, seconds.
    threshold: metres, summed over joints. count: how many costs it rests on. share: how many of those are
    below the threshold, LEVEL where the distribution fits.
    """

    layer: Layer
    weights: Array
    velocity: float
    distribution: JohnsonSB | None
    threshold: float
    count: int
    share: float


@dataclass(frozen=True)
class StanceFit:
    """A clip beside a stance. enter, leave: seconds of the clip in which it can be entered from, and left to,
    the stance without a jump. enter_at, leave_at: the best moments, and their costs beside the threshold: up
    to 1 is no jump.
    """

    enter: tuple[Span, ...]
    leave: tuple[Span, ...]
    enter_at: float
    leave_at: float
    enter_cost: float
    leave_cost: float


@dataclass(frozen=True)
class ProposedTimes:
    """Proposed timing, seconds; see `model.Timing`. good: whether it neither begins nor ends with a jump.
    reason: in words.
    """

    start: float
    end: float
    blend_in: float
    blend_out: float
    earliest_exit: float | None
    good: bool
    reason: str


@dataclass(frozen=True, eq=False)
class Matrix:
    """Clips x stances of a layer. clips, stances: their ids, C and S. enter_cost, leave_cost `[C, S]`: at the
    best moment, beside the threshold, infinite if nothing is known; enter_at, leave_at `[C, S]`: that moment,
    seconds.
    """

    layer: Layer
    clips: tuple[str, ...]
    stances: tuple[str, ...]
    enter_cost: Array
    leave_cost: Array
    enter_at: Array
    leave_at: Array

    @property
    def can_enter(self) -> Array:
        """`[C, S]` whether the clip can be entered from the stance."""
        return np.asarray(self.enter_cost <= 1)

    @property
    def can_leave(self) -> Array:
        """`[C, S]` whether the clip can be left to the stance."""
        return np.asarray(self.leave_cost <= 1)


def compute_statistics(
    clips: Iterable[Clip],
    layer: Layer,
    roles: Mapping[str, int] | None = None,
    weights: Mapping[str, float] | None = None,
) -> Statistics:
    """Return what is usual in clips of a layer, all of one skeleton. weights: how strongly the layer moves
    parts, else REACH.
    """
    some = list(clips)
    reach: Mapping[str, float] = REACH[layer] if weights is None else weights  # type: ignore[assignment]
    w = np.zeros(0, np.float32)
    places: list[Array] = []
    speeds: list[Array] = []
    rig = None
    for clip in some:
        if rig is None:
            rig = track_rig(clip, roles)
            w = np.array([min(reach.get(part, 0.0), 1.0) for part in rig.parts], np.float32)
            if not w.any():
                w[:] = 1
            first = clip.skeleton
        if clip.skeleton is not first and clip.skeleton != first:
            continue
        track = make_joint_track(rig, clip)
        if len(track) < STEP:
            continue
        v = measure_velocity(track)
        places.append(np.linalg.norm(track[STEP - 1 :] - track[: 1 - STEP], axis=-1) @ w)
        speeds.append(np.linalg.norm(v[STEP - 1 :] - v[: 1 - STEP], axis=-1) @ w)
    p = np.concatenate(places).astype(float) if places else np.zeros(0)
    s = np.concatenate(speeds).astype(float) if speeds else np.zeros(0)
    if not len(p) or p.max() < STILL:
        return Statistics(layer, w, STEP / RATE, None, STILL, len(p), 1.0)
    velocity = min(float(p.mean() / max(s.mean(), 1e-9)), SLOWEST)  # brings both terms to one range
    cost = p + velocity * s
    found = fit_johnson(cost, 0.0, 1.05 * float(cost.max()))
    threshold = max(STILL, found.quantile(LEVEL))
    return Statistics(layer, w, velocity, found, threshold, len(cost), float((cost <= threshold).mean()))


def find_stance_frames(
    stats: Statistics, loops: Sequence[tuple[Clip, float, float]], roles: Mapping[str, int] | None = None
) -> tuple[Array, Array]:
    """Return positions and velocities `[G, J, 3]` of frames of a stance's loops, each a clip from .. to a
    second (the same: one pose).
    """
    most = max(2, MOST_FRAMES // max(1, len(loops)))
    places, speeds = [], []
    for clip, start, end in loops:
        track = make_joint_track(track_rig(clip, roles), clip)
        times = track_seconds(clip)
        inside = np.flatnonzero((times >= start - 0.5 / RATE) & (times <= end + 0.5 / RATE))
        if not len(inside):
            continue
        chosen = inside[np.unique(np.linspace(0, len(inside) - 1, min(most, len(inside))).astype(int))]
        places.append(track[chosen])
        speeds.append(measure_velocity(track)[chosen] if end > start else np.zeros_like(track[chosen]))
    joints = len(stats.weights)
    if not places:
        return np.zeros((0, joints, 3), np.float32), np.zeros((0, joints, 3), np.float32)
    return np.concatenate(places), np.concatenate(speeds)


def measure_transition_costs(
    stats: Statistics, clip: Clip, stance: tuple[Array, Array], roles: Mapping[str, int] | None = None
) -> Array:
    """Return `[F]` what it costs to change between each frame of a clip, RATE a second, and the stance's
    nearest frame, beside the threshold: up to 1 is no jump. Infinite where the stance has no frames, or
    another skeleton.
    """
    return _costs(stats, make_joint_track(track_rig(clip, roles), clip), [stance])[:, 0]


def _costs(stats: Statistics, track: Array, stances: Sequence[tuple[Array, Array]]) -> Array:
    """Return `[F, S]` what `costs` does for several stances at once."""
    out = np.full((len(track), len(stances)), np.inf)
    there = [k for k, (places, _) in enumerate(stances) if len(places) and places.shape[1] == track.shape[1]]
    if not there or track.shape[1] != len(stats.weights):
        return out
    places, speeds = (np.concatenate([stances[k][i] for k in there]) for i in (0, 1))
    first = np.cumsum([0, *(len(stances[k][0]) for k in there[:-1])])
    moving = measure_velocity(track)
    step = max(1, CHUNK // len(places))
    for a in range(0, len(track), step):
        rows = slice(a, a + step)
        far = np.zeros((len(track[rows]), len(places)), np.float32)
        for j in np.flatnonzero(stats.weights):  # joint by joint: what is held stays small
            for mine, theirs, share in ((track, places, 1.0), (moving, speeds, stats.velocity)):
                x, y, z = (mine[rows, None, j, k] - theirs[None, :, j, k] for k in range(3))
                far += np.float32(share) * stats.weights[j] * np.sqrt(x * x + y * y + z * z)
        out[rows, there] = np.minimum.reduceat(far, first, axis=1)
    return out / stats.threshold


def fit_clip(clip: Clip, cost: Array) -> StanceFit:
    """Return where a clip can be entered and left, given its `costs` beside a stance."""
    times = track_seconds(clip)
    into = compute_entry_costs(cost)
    a = int(
        np.argmax(into <= into.min() + ALIKE)
    )  # of moments that are as good, the first to enter at and the last to leave at
    b = int(len(cost) - 1 - np.argmax(cost[::-1] <= cost.min() + ALIKE))
    return StanceFit(
        _spans(into <= 1, times),
        _spans(cost <= 1, times),
        float(times[a]),
        float(times[b]),
        float(into[a]),
        float(cost[b]),
    )


def compute_entry_costs(cost: Array) -> Array:
    """Return `[F]` what entering at each frame costs, given a clip's `costs`: c_ij compares with frame j - 1,
    so a clip entered at j follows a stance that looks like its frame before.
    """
    return np.append(cost[:1], cost[:-1])


def mask_statistics(
    stats: Statistics, clip: Clip, moved: Array | None, roles: Mapping[str, int] | None = None
) -> Statistics:
    """Return the statistics for an action that moves only some joints, `[J]` how strongly (None: all): the
    others stay in the stance.
    """
    if moved is None:
        return stats
    rig = track_rig(clip, roles)
    if len(rig.joints) != len(stats.weights):
        return stats
    return replace(stats, weights=stats.weights * (moved[rig.keep[rig.joints]] > 0))


def measure_seam_cost(
    stats: Statistics,
    clip: Clip,
    start: float,
    end: float,
    overlap: float,
    roles: Mapping[str, int] | None = None,
) -> float:
    """Return what the seam of a loop from `start` to `end` costs, beside the threshold: the most of what lies
    opposite in its overlap.
    """
    track = make_joint_track(track_rig(clip, roles), clip)
    v, last = measure_velocity(track), len(track) - 1
    if track.shape[1] != len(stats.weights):
        return float("inf")
    n = np.arange(round(overlap * RATE) + 1)
    a, b = (np.clip(round(t * RATE) + n, 0, last) for t in (end - overlap, start))
    far = np.linalg.norm(track[a] - track[b], axis=-1) + stats.velocity * np.linalg.norm(v[a] - v[b], axis=-1)
    return float((far @ stats.weights).max()) / stats.threshold


def measure_visible_difference(cost: Any, seconds: float) -> Any:
    """Return what of a difference, beside the threshold, still shows when it is blended over some seconds: up
    to 1 is no jump.

    The threshold is what passes in STEP - 1 frames; what is played is blended by 3x^2 - 2x^3, at its fastest
    1.5 times its mean.
    """
    return cost * min(1.0, 1.5 * (STEP - 1) / RATE / seconds) if seconds > 0 else cost


def _spans(good: Array, times: Array) -> tuple[Span, ...]:
    edges = np.flatnonzero(np.diff(np.concatenate(([0], good.astype(int), [0]))))
    return tuple((float(times[a]), float(times[b - 1])) for a, b in edges.reshape(-1, 2))


def blend(cost: float) -> float:
    """Return in how many seconds a difference, beside the threshold, is blended over no faster than the
    user's own clips move.

    The threshold is what passes in STEP - 1 frames; a cosine blend is at its fastest pi / 2 times its mean.
    """
    return min(max(pi / 2 * cost * (STEP - 1) / RATE, BLEND[0]), BLEND[1])


def propose_times(
    stats: Statistics,
    clip: Clip,
    entered: Array,
    left: Array | None = None,
    stroke: float | None = None,
    roles: Mapping[str, int] | None = None,
) -> ProposedTimes:
    """Return a timing for a clip entered from a stance and left to one, given its `costs` beside them (left
    None: the same).

    It begins and ends with the movement (their equation 2) where that looks like the stances, else at the
    nearest moment that does, with room for the blends; once it looks like the stance it ends in, after its
    stroke and for good, it may be left.
    """
    share = SHARE_SEEN if left is None else 0.5
    left = entered if left is None else left
    into, out, at = fit_clip(clip, entered), fit_clip(clip, left), track_seconds(clip)
    speed = (
        np.linalg.norm(measure_velocity(make_joint_track(track_rig(clip, roles), clip)), axis=-1)
        @ stats.weights
    )
    moving = at[speed >= speed.min() + ACTIVE * (speed.max() - speed.min())]
    middle = float(at[int(np.argmax(speed))]) if stroke is None else stroke
    enter = [t for a, b in into.enter for t in at[(at >= a) & (at <= b)].tolist() if t <= middle]
    leave = [t for a, b in out.leave for t in at[(at >= a) & (at <= b)].tolist() if t >= middle]
    begin = max((t for t in enter if t <= moving[0]), default=min(enter, default=0.0))
    finish = min((t for t in leave if t >= moving[-1]), default=max(leave, default=clip.duration))
    blend_in, blend_out = blend(_at(entered, begin)), blend(_at(left, finish))
    start, end = max(0.0, begin - blend_in), min(clip.duration, finish + blend_out)
    if (
        measure_visible_difference(_at(entered, start), blend_in)
        > 1
        >= measure_visible_difference(_at(entered, begin), blend_in)
    ):
        start = begin  # before, it is on its way from elsewhere
    if (
        measure_visible_difference(_at(left, end), blend_out)
        > 1
        >= measure_visible_difference(_at(left, finish), blend_out)
    ):
        end = finish
    most = max(0.0, end - start)
    room_in, room_out = (
        most * (UNSEEN if _at(x, t) <= 1 else share) for x, t in ((entered, start), (left, end))
    )
    away = bool((left > 1).any())
    last = max(out.leave[-1][0] if out.leave else end, middle, _settled(clip, roles))
    earliest = last if away and leave and last < end - blend_out else None
    if not (np.isfinite(into.enter_cost) and np.isfinite(out.leave_cost)):
        reason = phrase("its stance has no resting clip yet, so its entry and exit cannot be judged")
    elif enter and leave:
        reason = phrase(
            "moves from {first:.2f} to {last:.2f} s, and looks like its stance before and after",
            first=moving[0],
            last=moving[-1],
        )
    elif enter:
        reason = phrase(
            "its exit jumps: no moment late enough fits "
            "its stance (best match {cost:.1f} times the visible threshold)",
            cost=out.leave_cost,
        )
    elif leave:
        reason = phrase(
            "its entry jumps: no moment early enough fits "
            "its stance (best match {cost:.1f} times the visible threshold)",
            cost=into.enter_cost,
        )
    else:
        reason = phrase(
            "its entry and exit jump: no moment early or late enough "
            "fits its stance (best matches {cost:.1f} and {more:.1f} times the visible threshold)",
            cost=into.enter_cost,
            more=out.leave_cost,
        )
    return ProposedTimes(
        start, end, min(blend_in, room_in), min(blend_out, room_out), earliest, bool(enter and leave), reason
    )


def _settled(clip: Clip, roles: Mapping[str, int] | None) -> float:
    """Return from which second on the hips stay over the spot on the floor at which the clip ends."""
    at = track_floor(track_rig(clip, roles), clip)
    away = np.linalg.norm(at - at[-1], axis=-1) > STAYS * clip.skeleton.height
    return float(track_seconds(clip)[min(int(np.flatnonzero(away).max(initial=-1)) + 1, len(at) - 1)])


def find_loop_times(stats: Statistics, clip: Clip, roles: Mapping[str, int] | None = None) -> ProposedTimes:
    """Return a timing for a clip that loops: all of it, with an overlap as long as its seam needs."""
    track = make_joint_track(track_rig(clip, roles), clip)
    v = measure_velocity(track)
    seam = float(np.linalg.norm(track[-1] - track[0], axis=-1) @ stats.weights)
    seam = (
        seam + stats.velocity * float(np.linalg.norm(v[-1] - v[0], axis=-1) @ stats.weights)
    ) / stats.threshold
    overlap = 0.0 if seam <= SEAMLESS else min(blend(seam), clip.duration / 3)
    good = seam <= 1 or blend(seam) < BLEND[1]
    return ProposedTimes(
        0.0,
        clip.duration,
        overlap,
        0.0,
        None,
        good,
        _seam_words(seam, good),
    )


def _seam_words(seam: float, good: bool) -> str:
    """Say how visible a loop's seam is. seam: its cost beside the threshold. good: a blend hides it."""
    if seam <= 1:
        return phrase("its loop seam is smooth, {seam:.2f} of the visible threshold", seam=seam)
    if good:
        return phrase(
            "a blend hides its loop seam, which is {seam:.1f} times the visible threshold", seam=seam
        )
    return phrase("its loop seam jumps: it is {seam:.1f} times the visible threshold", seam=seam)


def _at(cost: Array, seconds: float) -> float:
    value = float(cost[min(max(round(seconds * RATE), 0), len(cost) - 1)])
    return value if np.isfinite(value) else 1e9


def make_compatibility_matrix(
    project: Project,
    layer: Layer,
    stances: Mapping[str, Sequence[tuple[Clip, float, float]]] | None = None,
    clips: Sequence[str] | None = None,
    cancelled: Callable[[], bool] | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> Matrix:
    """Return all clips against all stances of a layer. stances: id -> its loops, the project's own unless
    given; clips: ids, all unless given. What is left when `cancelled` stays infinite. progress: called with
    how many of how many.
    """
    roles = anatomy.project_roles(project)
    own = {
        ident: e.motion
        for ident, e in project.clips.items()
        if e.motion is not None and e.motion.skeleton == project.skeleton
    }
    chosen = tuple(project.clips) if clips is None else tuple(clips)
    loops = list_stance_loops(project, layer) if stances is None else stances
    graph = project.graphs[layer]
    labelled = [own[c] for c in graph.uses if c in own]
    stats = compute_statistics(
        labelled or own.values(), layer, roles, {part: graph.weight(part) for part in REACH[layer]}
    )
    shape = (len(chosen), len(loops))
    out = Matrix(layer, chosen, tuple(loops), *(np.full(shape, v) for v in (np.inf, np.inf, 0.0, 0.0)))
    frames = [find_stance_frames(stats, some, roles) for some in loops.values()]
    for row, ident in enumerate(chosen):
        if cancelled is not None and cancelled():
            break
        if progress is not None:
            progress(row, len(chosen))
        if (clip := own.get(ident)) is None:
            continue
        cost = _costs(stats, make_joint_track(track_rig(clip, roles), clip), frames)
        for column in range(len(frames)):
            f = fit_clip(clip, cost[:, column])
            out.enter_cost[row, column], out.leave_cost[row, column] = f.enter_cost, f.leave_cost
            out.enter_at[row, column], out.leave_at[row, column] = f.enter_at, f.leave_at
    return out


def list_stance_loops(project: Project, layer: Layer) -> dict[str, list[tuple[Clip, float, float]]]:
    """Return stance id -> its loops, each a clip and the seconds that play, of a project's stances; those
    whose clips are there.
    """
    out: dict[str, list[tuple[Clip, float, float]]] = {}
    for stance in project.graphs[layer].stances:
        out[stance] = []
        for action in project.graphs[layer].of(stance, "stance"):
            entry = project.clips.get(action.clip)
            if entry is not None and entry.motion is not None and entry.motion.skeleton == project.skeleton:
                out[stance].append((entry.motion, *project.span(action)))
    return out
