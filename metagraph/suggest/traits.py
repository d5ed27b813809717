"""Describe a clip's motion in measures that are comparable between characters: poses relative to their own
ground, and how much moves when.

Lengths are in character heights, so size does not matter. Directions are the character's own (see
`body_points`), so neither does where it stands or what its rest pose is.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from metagraph.graph import anatomy
from metagraph.graph.model import Project
from metagraph.graph.words import LAYERS, Layer
from metagraph.motion.clip import Clip
from metagraph.motion.roles import find_roles
from metagraph.motion.skeleton import Skeleton
from metagraph.suggest.body_points import (
    NAMES,
    PosedFigure,
    make_posed_figure,
    measure_body_points,
    turn_to_viewer,
)
from metagraph.suggest.self_contact import NOTHING, SelfContact, measure_self_contact

Array = NDArray[Any]

RATE = 30.0  # frames a second that are used, about
BATCH = 6000  # frames posed at once
SMOOTH = 0.06  # seconds: standard deviation of the filter on speeds
RESTING = 0.05  # heights a second: slower is rest
_BACK = np.array([-1.0, 1.0])  # turns a facing direction into its inverse
NEAR_SEAM = 0.1  # seconds on either side of a loop's seam
JERKY = 1.2  # times the greatest change of velocity within the loop, the same
JERKS = 0.5  # of the greatest speed: a change of velocity at a loop's seam that is seen as a jerk
TOUCH = 0.12  # heights from a wrist to what its hand touches, at most
PARTS = ("left_arm", "right_arm", "fingers", "head", "trunk", "hips", "legs")


@dataclass(frozen=True, eq=False)
class LayerTraits:
    """One layer of a clip. All lengths are in heights.

    `names` has the n points (see NAMES; fewer on characters that lack some). `first`, `last` and `typical`
    `[n, 3]` are the poses at the ends and the median. `loop_error` is the distance of the last pose from the
    first, of the farthest point. `steady` is the speed at the ends relative to the greatest, 0..1. `extent`
    and `extent_at` say how far any point goes from the line between both ends, and when, in seconds. `energy`
    is the mean speed; `peak` and `peak_at` are the greatest speed and its time in seconds. `rest` is the
    share of the time below RESTING. `bouts` is how often it speeds up. `farthest` `[n, 3]` is the pose at
    `extent_at`; `low` and `high` `[n, 3]` are the least and the greatest of each coordinate. `stroke_at` is
    when it is fastest on its way there, in seconds. `flow` is how fast it goes at its seam, if it repeats,
    relative to its greatest speed, and `turning` within a tenth of a second of it, relative to its mean; both
    are 0 where it would jerk.
    """

    names: tuple[str, ...]
    first: Array
    last: Array
    typical: Array
    farthest: Array
    low: Array
    high: Array
    loop_error: float
    steady: float
    extent: float
    extent_at: float
    energy: float
    peak: float
    peak_at: float
    stroke_at: float
    rest: float
    bouts: int
    flow: float = 0.0
    turning: float = 0.0


@dataclass(frozen=True, eq=False)
class Traits:
    """What a clip's motion looks like.

    `height` is in metres, `duration` in seconds; all other lengths are in heights. `energy` has the speed of
    each of PARTS, in heights a second: the root of its mean square, so slow drifts count little beside
    movements. `travel` is how far the character goes over the ground. `symmetry` is -1 if only the right arm
    moves, 0 for both equally, 1 for only the left. `mirrored`, 0..1, is how far the arms move as mirror
    images. `out` and `near` are how much farther from, and nearer to, the trunk and head the hands come than
    where they begin. `touch` is how much nearer a moving hand comes to the other forearm or the head than at
    first. `stride` is how far each foot passes the other, the lesser of both, which shows a walk. `turned` is
    by how many degrees the character turns from its first to its last pose. `rise` is how far the hips go up
    and down. `face` is, for a clip in which nothing else moves, how much joints of the face do, 0..2; 0 for
    other clips. `contact` is that with its own body. `shrug` is how far the shoulders rise more than the
    trunk. `sway` is how far the hips go to a side. `front` and `lifted` say how far before the chest, and
    above the hips, the hand that goes farthest is when it is farthest. `held` is how far away it stays, from
    when it is half as far for the first time until it is for the last, relative to that: 1 for a hand that is
    held out, 0 for one that comes back in between. `tremble` has the energies that all
    clips of its set have (see `with_tremble`).
    """

    height: float
    duration: float
    frames: int
    layers: Mapping[Layer, LayerTraits]
    energy: Mapping[str, float]
    travel: float
    symmetry: float
    mirrored: float
    out: float
    near: float
    touch: float
    stride: float = 0.0
    face: float = 0.0
    turned: float = 0.0
    rise: float = 0.0
    contact: SelfContact = NOTHING
    shrug: float = 0.0
    sway: float = 0.0
    front: float = 0.0
    lifted: float = 0.0
    held: float = 0.0
    tremble: Mapping[str, float] = field(default_factory=dict)


# Clips never change, so the traits of one hold as long as it exists.
_KNOWN: WeakKeyDictionary[Clip, tuple[tuple[tuple[str, int], ...], Traits]] = WeakKeyDictionary()


def measure_traits(skeleton: Skeleton, roles: Mapping[str, int] | None, clip: Clip) -> Traits:
    """Return what a clip's motion looks like. `roles` maps roles to joints of the skeleton; None finds them.
    Never raises.
    """
    named = _named(
        skeleton if clip.skeleton == skeleton else clip.skeleton, roles if clip.skeleton == skeleton else None
    )
    return _all([clip], lambda _: named)[0]


def measure_all_traits(
    source: Project | Iterable[Clip],
    cancelled: Callable[[], bool] | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> dict[str, Traits]:
    """Return clip id -> traits for a project, or name -> traits for clips; those found until `cancelled`
    returns True. `progress` is called with the numbers of clips done and of all clips.
    """
    if isinstance(source, Project):
        clips = [(ident, entry.motion) for ident, entry in source.clips.items() if entry.motion is not None]
        own = dict(anatomy.project_roles(source))
        mine = source.skeleton
    else:
        clips, own, mine = [(clip.name, clip) for clip in source], {}, None
    named: dict[int, tuple[tuple[str, int], ...]] = {}

    def roles(clip: Clip) -> tuple[tuple[str, int], ...]:
        key = id(clip.skeleton)
        if key not in named:
            named[key] = _named(clip.skeleton, own if clip.skeleton == mine else None)
        return named[key]

    out: dict[str, Traits] = {}
    ahead = 0
    while ahead < len(clips) and not (cancelled is not None and cancelled()):
        last, frames = ahead, 0
        while last < len(clips) and (last == ahead or frames + len(_frames(clips[last][1])) <= BATCH):
            frames += len(_frames(clips[last][1]))
            last += 1
        part = clips[ahead:last]
        out.update(zip((ident for ident, _ in part), _all([clip for _, clip in part], roles), strict=True))
        ahead = last
        if progress is not None:
            progress(ahead, len(clips))
    return out


def list_known_traits(project: Project) -> dict[str, Traits]:
    """Return clip id -> traits of the clips that were measured before, without computing anything."""
    found = {
        ident: _KNOWN.get(entry.motion) for ident, entry in project.clips.items() if entry.motion is not None
    }
    return {ident: known[1] for ident, known in found.items() if known is not None}


def _named(skeleton: Skeleton, roles: Mapping[str, int] | None) -> tuple[tuple[str, int], ...]:
    return tuple(sorted((find_roles(skeleton) if roles is None else roles).items()))


def _frames(clip: Clip) -> Array:
    """Return which frames are used, ascending, including the first and the last."""
    step = max(1, int(clip.fps / RATE + 0.5))
    return np.unique(np.append(np.arange(0, clip.frames, step), clip.frames - 1))


def _all(clips: Sequence[Clip], roles: Callable[[Clip], tuple[tuple[str, int], ...]]) -> list[Traits]:
    groups: dict[Any, list[Clip]] = {}
    for clip in clips:
        named = roles(clip)
        known = _KNOWN.get(clip)
        if known is None or known[0] != named:
            groups.setdefault((clip.skeleton, named), []).append(clip)
    for (skeleton, named), some in groups.items():
        figure = make_posed_figure(skeleton, named)
        frames = [_frames(clip) for clip in some]
        points, world = measure_body_points(figure, some, frames)
        ends = np.cumsum([0, *(len(f) for f in frames)])
        for clip, index, a, b in zip(some, frames, ends, ends[1:], strict=False):
            times = index / clip.fps
            found = _of(
                figure, {k: v[a:b] for k, v in points.items()}, {k: v[a:b] for k, v in world.items()}, times
            )
            if max(found.energy.values()) < 1e-3:
                found = replace(found, face=_face(clip, dict(named)))
            _KNOWN[clip] = named, found
    return [_KNOWN[clip][1] for clip in clips]


def _smoothed(x: Array, seconds: float) -> Array:
    """Return `[F, ...]` filtered along time. `seconds` is the time from frame to frame."""
    reach = int(3 * SMOOTH / seconds + 0.5) if seconds > 0 else 0
    if reach < 1 or len(x) < 3:
        return x
    kernel = np.exp(-0.5 * (np.arange(-reach, reach + 1) * seconds / SMOOTH) ** 2)
    kernel /= kernel.sum()
    padded = np.concatenate([np.repeat(x[:1], reach, 0), x, np.repeat(x[-1:], reach, 0)])
    flat = padded.reshape(len(padded), -1)
    out = np.zeros((len(x), flat.shape[1]))
    for k, share in enumerate(kernel):
        out += share * flat[k : k + len(x)]
    return out.reshape(x.shape)


def _speeds(tracks: Array, times: Array) -> Array:
    """Return the smoothed speeds `[F, n]` of `[F, n, 3]`; zeros for a single frame."""
    if len(tracks) < 2 or tracks.shape[1] == 0:
        return np.zeros(tracks.shape[:2])
    velocity = np.gradient(tracks.astype(np.float64), times, axis=0)
    return _smoothed(np.linalg.norm(velocity, axis=-1), float(times[1] - times[0]))


def _layer(names: tuple[str, ...], poses: Array, tracks: Array, speeds: Array, times: Array) -> LayerTraits:
    """Return one layer's traits. `poses` `[F, n, 3]` are relative to where the character faces then, `tracks`
    to where it faces at first.
    """
    if not names:
        none = np.zeros((0, 3))
        return LayerTraits(
            (), none, none, none, none, none, none, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0
        )
    fast = speeds.max(-1)
    peak = _greatest(fast)
    first, last = tracks[0].astype(float), tracks[-1].astype(float)
    way = (times / times[-1] if times[-1] > 0 else times)[:, None, None]
    # Relative to a smooth way from one end to the other, so that a transition does not count as going out and
    # back.
    away = np.linalg.norm(tracks - (first + (last - first) * (way * way * (3 - 2 * way))), axis=-1).max(-1)
    far = _greatest(away)
    return LayerTraits(
        names,
        poses[0].astype(float),
        poses[-1].astype(float),
        np.median(poses, axis=0).astype(float),
        poses[far].astype(float),
        poses.min(0).astype(float),
        poses.max(0).astype(float),
        float(np.linalg.norm(poses[-1] - poses[0], axis=-1).max()),
        float((fast[0] + fast[-1]) / 2 / fast[peak]) if fast[peak] > 1e-4 else 1.0,
        float(away[far]),
        float(times[far]),
        float(_mean(speeds.mean(-1), times)),
        float(fast[peak]),
        float(times[peak]),
        float(times[_greatest(fast[: far + 1])]),
        float(_mean((fast < RESTING).astype(float), times)),
        _bouts(fast),
        *_flow(tracks, times),
    )


def _flow(tracks: Array, times: Array) -> tuple[float, float]:
    """Return how fast points `[F, n, 3]` go at the seam of a loop, relative to their greatest speed, and
    within `NEAR_SEAM` of it, relative to their mean; 0 where their velocity jumps there.
    """
    if len(times) < 4:
        return 0.0, 0.0
    velocity = np.diff(tracks.astype(np.float64), axis=0) / np.diff(times)[:, None, None]
    speed = np.linalg.norm(velocity, axis=-1)
    point = int(np.argmax(speed.max(0)))
    fastest, jump = speed[:, point].max(), np.linalg.norm(velocity[0, point] - velocity[-1, point])
    usual = np.linalg.norm(np.diff(velocity[:, point], axis=0), axis=-1).max()  # in one frame, where few are
    if fastest < 1e-4 or jump > max(JERKS * fastest, JERKY * usual):
        return 0.0, 0.0
    count = max(1, int(NEAR_SEAM / float(times[1] - times[0]) + 0.5))
    sides = speed[:count, point].mean(), speed[-count:, point].mean()
    ends = min(speed[0, point], speed[-1, point])
    return float(ends / fastest), float(min(sides) / speed[:, point].mean())


def _greatest(x: Array) -> int:
    """Return the index of the greatest value, the first of those that are almost equal: rounding must not
    choose.
    """
    return int(np.argmax(x >= x.max() - 1e-4))


def _mean(x: Array, times: Array) -> float:
    return float(np.trapezoid(x, times) / times[-1]) if times[-1] > 0 else float(x.mean())


def _bouts(speed: Array) -> int:
    """Return the number of peaks of at least a quarter of the greatest, with a slowing to less than half
    between them.
    """
    least, count, low, top = speed.max() / 4, 0, 0.0, 0.0
    if least <= RESTING / 4:
        return 0
    rising = True
    for v in speed:
        if rising:
            top = max(top, v)
            if top >= least and v < top / 2:
                count, rising, low = count + 1, False, v
        else:
            low = min(low, v)
            if v >= least and v > 2 * low:
                rising, top = True, v
    return count + (1 if rising and top >= least else 0)


def _of(figure: PosedFigure, points: Mapping[str, Array], world: Mapping[str, Array], times: Array) -> Traits:
    facing = world["facing"]
    layers: dict[Layer, LayerTraits] = {}
    energy = dict.fromkeys(PARTS, 0.0)
    speeds: dict[str, Array] = {}
    for layer in LAYERS:
        names = tuple(n for n in NAMES[layer] if n in points)
        if layer == "body":
            names += tuple(n for n in points if n.startswith("joint "))
        tracks = np.stack([points[n] for n in names], axis=1) if names else np.zeros((len(times), 0, 3))
        turned = tracks
        if layer == "body" and names:  # a turn of the whole body is a movement
            turned = turn_to_viewer(facing[:1, None], turn_to_viewer(facing[:, None] * _BACK, tracks))
        fast = _speeds(turned, times)
        speeds |= dict(zip(names, fast.T, strict=True))
        layers[layer] = _layer(names, tracks, turned, fast, times)
    for side in ("left", "right"):
        if f"{side}_fingers" in points:
            speeds[f"{side}_fingers"] = _speeds(points[f"{side}_fingers"], times).max(-1)
    members = {
        "left_arm": ("left_hand", "left_lower_arm"),
        "right_arm": ("right_hand", "right_lower_arm"),
        "fingers": ("left_fingers", "right_fingers"),
        "head": ("nose", "crown"),
        "trunk": ("trunk", "trunk_ahead"),
        "hips": ("hips",),
        "legs": ("left_lower_leg", "left_foot", "right_lower_leg", "right_foot"),
    }
    for part, some in members.items():
        known = [speeds[n] for n in some if n in speeds]
        if known:
            energy[part] = float(np.sqrt(_mean(np.mean(known, axis=0) ** 2, times)))
    hands = []
    for side in ("left", "right"):
        own = speeds.get(f"{side}_fingers")
        hands.append(energy[f"{side}_arm"] + (0.0 if own is None else float(np.sqrt(_mean(own**2, times)))))
    left, right = hands
    out, near = _reach(world)
    touch = _touch(world)
    front, lifted, held = _gesture_space(points, world)
    ground = world["hips"][:, [0, 2]]
    return Traits(
        figure.height,
        float(times[-1]),
        len(times),
        layers,
        energy,
        float(np.linalg.norm(ground[-1] - ground[0])),
        (left - right) / (left + right) if left + right > 1e-4 else 0.0,
        _mirrored(points),
        out,
        near,
        touch,
        _stride(points),
        turned=_turned(facing),
        rise=float(np.ptp(world["hips"][:, 1])),
        contact=measure_self_contact(world, float(times[1] - times[0]) if len(times) > 1 else 0.0),
        shrug=_shrug(points),
        sway=float(np.ptp(points["hips"][:, 0])) if "hips" in points else 0.0,
        front=front,
        lifted=lifted,
        held=held,
    )


def _shrug(points: Mapping[str, Array]) -> float:
    rises = [
        float(np.max(points[name][:, 1]) - points[name][0, 1])
        for name in ("left_upper_arm", "right_upper_arm")
        if name in points
    ]
    return min(rises, default=0.0)


def _gesture_space(points: Mapping[str, Array], world: Mapping[str, Array]) -> tuple[float, float, float]:
    """Return where the hand that goes farthest is: before the chest and above the hips; and how far away it
    stays in between, relative to the farthest.
    """
    best, out = 0.0, (0.0, 0.0, 0.0)
    for name in ("left_hand", "right_hand"):
        if name not in points:
            continue
        away = np.linalg.norm(points[name] - points[name][0], axis=-1)
        far = _greatest(away)
        if away[far] > best:
            best = float(away[far])
            height = world[name][far, 1] - world["hips"][far, 1]
            half = np.flatnonzero(away >= best / 2)
            stays = float(away[half[0] : half[-1] + 1].min()) / best
            out = float(points[name][far, 2]), float(height), stays
    return out


def _turned(facing: Array) -> float:
    """Return by how many degrees a character turns. `facing` `[F, 2]` is sine and cosine."""
    angle = np.unwrap(np.arctan2(facing[:, 0], facing[:, 1]))
    return float(np.degrees(abs(angle[-1] - angle[0])))


def _face(clip: Clip, roles: Mapping[str, int]) -> float:
    """Return how much the joints below the head turn, and move in heights of the character, and how much of a
    blend shape comes and goes, at most.
    """
    shapes = float(np.ptp(clip.weights, axis=0).max(initial=0.0)) if clip.weights is not None else 0.0
    if "head" not in roles:
        return shapes
    face = [j for j in clip.skeleton.descendants(roles["head"]) if j != roles["head"]]
    turned = np.ptp(clip.rotations[:, face], axis=0) if face else np.zeros(0)
    moved = (
        np.ptp(clip.translations[:, [k for k, j in enumerate(clip.translated) if j in set(face)]], axis=0)
        / clip.skeleton.height
    )
    return float(max(turned.max(initial=0.0), moved.max(initial=0.0), shapes))


def _stride(points: Mapping[str, Array]) -> float:
    if "left_foot" not in points or "right_foot" not in points:
        return 0.0
    ahead = points["left_foot"][:, 2] - points["right_foot"][:, 2]
    return max(0.0, float(min(ahead.max(), -ahead.min())))


def _reach(world: Mapping[str, Array]) -> tuple[float, float]:
    """Return how much farther from the trunk and head the farther hand goes, and how much nearer the nearer
    one comes.
    """
    centres = [world[n] for n in ("carrier", "head") if n in world]
    hands = [world[n] for n in ("left_hand", "right_hand") if n in world]
    if not centres or not hands:
        return 0.0, 0.0
    out = near = 0.0
    for hand in hands:
        away = np.min([np.linalg.norm(hand - c, axis=-1) for c in centres], axis=0)
        out = max(out, float(away.max() - away[0]))
        near = max(near, float(away[0] - away.min()))
    return out, near


def _touch(world: Mapping[str, Array]) -> float:
    """Return how much nearer a hand comes to the other forearm or the head than where it begins, if it comes
    close enough to touch them.
    """
    nearest = 0.0
    for side, other in (("left", "right"), ("right", "left")):
        if (hand := world.get(f"{side}_hand")) is None:
            continue
        gaps = []
        if (a := world.get(f"{other}_lower_arm")) is not None and (
            b := world.get(f"{other}_hand")
        ) is not None:
            line = b - a
            share = np.clip(np.sum((hand - a) * line, -1) / np.maximum(np.sum(line * line, -1), 1e-9), 0, 1)
            gaps.append(np.linalg.norm(hand - a - share[:, None] * line, axis=-1))
        if (head := world.get("head")) is not None:
            gaps.append(np.linalg.norm(hand - head, axis=-1))
        for gap in gaps:
            if gap.min() < TOUCH:
                nearest = max(nearest, float(gap[0] - gap.min()))
    return nearest


def _mirrored(points: Mapping[str, Array]) -> float:
    if "left_hand" not in points or "right_hand" not in points or len(points["left_hand"]) < 2:
        return 0.0
    left = np.diff(points["left_hand"], axis=0).astype(np.float64)
    right = np.diff(points["right_hand"], axis=0) * np.array([-1, 1, 1])
    size = float(np.sum(left * left) + np.sum(right * right)) / 2
    return max(0.0, float(np.sum(left * right)) / size) if size > 1e-12 else 0.0
