"""Find poses that do not belong to a take: a bind pose left at an end, a frame unlike both its neighbours.

Poses are compared as a whole, by where their joints are. Joints count as much as their bones are long, so
fingers and helpers decide nothing. A stray pose both looks like one (the rest pose, or arms held straight out
as in a T- or A-pose) and is left by a step unlike the take's own motion. Its looks alone are not enough; the
step alone is, if it is many times as large as any other of the take.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.motion.roles import find_roles
from metagraph.motion.skeleton import Pose, Skeleton

Array = NDArray[Any]

# Lengths are relative to the body's spread: the mean distance of its joints from their centre, about 0.5 m.
AFTER = 0.2  # seconds of motion that a step is compared with
RAMP = 0.15  # seconds over which a tool's resampling, or a late first key, may spread the step
HOLD = 0.5  # seconds that a stray pose may be held
VISIBLE = 0.007  # of the spread: smaller steps cannot be seen
# How near a pose is to the rest pose, and how many times larger than any step after it the step from it must
# then be. Real clips, which begin or end anywhere, stay below 2.
LIKENESS = ((0.05, 3.0), (0.15, 4.0))
ARMS_OUT = 4.0  # the same for a pose that is a T- or an A-pose only by its shape
UNLIKE = 12.0  # the same for any pose: an A-pose with bent elbows in a file whose rest pose is the idle
ALONE = 5.0  # times the take's largest step after it that the step from such a pose must be
MIRRORED = (5.0, 2.5)  # UNLIKE and ALONE where that pose is the same on both sides
CERTAIN = 12.0  # the same if the clip moves as quickly elsewhere
OWN = 1.5  # the step must be so many times the clip's 95 % step, because a clip may jump all along
LONE, LONE_BOUND = 6.0, 4.0  # how many times any step around it the steps to and from a lone frame are
LONE_STEP = 0.05  # of the spread
SLOWEST = 18.0  # frames a second: with fewer, a whole movement may fall on one frame
FEWEST = 5  # frames: a shorter take is a pose and its comparison, or too short to judge
BROKEN = 0.75  # how much a step that breaks off counts, compared with one that is only quick
SOON = 0.3  # the same for one that is larger only than the next three steps
STILL = 5e-4  # of the spread: less is noise
AT_ONCE = 1 << 20  # numbers in the rotations of clips that are computed together


@dataclass(frozen=True)
class StrayPoses:
    """The stray poses of a clip.

    `first` and `last` are the numbers of frames at the ends that are bind poses or lead from and to them.
    `lone` has the frames in between that are unlike both their neighbours.
    """

    first: int = 0
    last: int = 0
    lone: tuple[int, ...] = ()


class _Take:
    """A clip's poses as positions `[F, J, 3]`, with any origin."""

    def __init__(
        self, clip: Clip, bound: Sequence[Pose], weights: Array, places: Array, sizes: Array
    ) -> None:
        """Store a clip's poses. `weights [J]` say how much joints count; `places` are relative to their
        centre; `sizes [F]` are those of the poses.
        """
        self.clip, self.weights, self.places, self._bound = clip, weights, places, bound
        middle = np.sort(sizes)[(len(sizes) - 1) // 2 : len(sizes) // 2 + 1]
        self.spread = max(1e-6, float(middle.sum()) / len(middle))
        self.roles: dict[str, int] | None = None
        self.steps = (np.zeros(0), np.zeros(0))

    @classmethod
    def alike(
        cls, clips: Sequence[Clip], bound: Sequence[Pose], bones: tuple[Array, Array, Array] | None = None
    ) -> list[_Take]:
        """Return takes of one skeleton with the same translated joints, computed together."""
        skeleton, moved = clips[0].skeleton, list(clips[0].translated)
        weights = _weights(skeleton, moved, bones)
        ends = np.cumsum([clip.frames for clip in clips]).tolist()
        places, sizes, turned, gone = _measured(skeleton, clips, moved, weights)
        out, begin = [], 0
        for clip, end in zip(clips, ends, strict=True):
            take = cls(clip, bound, weights, places[begin:end], sizes[begin:end])
            step = turned[begin : end - 1] / take.spread
            take.steps = (step, np.hypot(step, gone[begin : end - 1] / take.spread))
            out.append(take)
            begin = end
        return out

    @cached_property
    def bound(self) -> list[Array]:
        """Return the positions of the poses that a tool may leave. For most takes they are never needed."""
        skeleton = self.clip.skeleton
        return [self.centred(skeleton.globals(pose)[1]) for pose in (skeleton.rest, *self._bound)]

    def size(self, ways: Array) -> Array:
        """Return the weighted root mean square `[...]` of vectors `[..., J, 3]`."""
        return _size(ways, self.weights)

    def centred(self, places: Array) -> Array:
        return np.asarray(places - np.einsum("ji,j->i", places, self.weights))

    def factor(self, frame: int) -> float:
        """Return how many times the motion's own steps the step from this pose must be."""
        away = min(self.apart(self.places[frame], pose) for pose in self.bound)
        for near, factor in LIKENESS:
            if away <= near:
                return factor
        return ARMS_OUT if self.arms_out(frame) else UNLIKE

    def apart(self, one: Array, other: Array) -> float:
        """Return the distance of two poses, whichever way they face or lie."""
        u, _, v = np.linalg.svd(np.einsum("ja,jb,j->ab", one, other, self.weights))
        u[:, -1] *= np.sign(np.linalg.det(u @ v))
        return float(self.size(one @ (u @ v) - other)) / self.spread

    def arms_out(self, frame: int) -> bool:
        """Return whether the figure stands upright, with both arms straight and symmetric, out to
        its sides.
        """
        ways = self._limbs(frame)
        if ways is None:
            return False
        # Straight within 25 degrees, up to 65 below the horizontal, 25 ahead; a leg within 40 of straight
        # down.
        arms = []
        for side in ("left", "right"):
            upper, lower, arm, leg = (ways[f"{side}_{part}"] for part in ("upper", "lower", "arm", "leg"))
            if upper @ lower < 0.906 or arm[0] < 0.42 or abs(arm[2]) > 0.42 or -leg[1] < 0.766:
                return False
            arms.append(arm)
        return bool(arms[0] @ arms[1] > 0.966)

    def mirrored(self, frame: int) -> bool:
        """Return whether both arms and both legs are mirror images of each other within 8 degrees, as in
        bind poses and hardly ever in a movement.
        """
        ways = self._limbs(frame)
        parts = ("upper", "lower", "leg")
        return ways is not None and all(ways[f"left_{x}"] @ ways[f"right_{x}"] > 0.990 for x in parts)

    def _limbs(self, frame: int) -> dict[str, Array] | None:
        """Return where upper arms, forearms, whole arms and legs point: out to their own side, up and ahead
        of the figure; None if a joint is not known.
        """
        if self.roles is None:
            self.roles = find_roles(self.clip.skeleton)
        needed = [
            f"{s}_{r}"
            for s in ("left", "right")
            for r in ("upper_arm", "lower_arm", "hand", "upper_leg", "lower_leg", "foot")
        ]
        if any(r not in self.roles for r in (*needed, "hips", "head")):
            return None
        at = {r: self.places[frame, j].astype(float) for r, j in self.roles.items()}

        def way(a: str, b: str) -> Array:
            line = at[b] - at[a]
            return np.asarray(line / max(1e-9, float(np.linalg.norm(line))))

        up = way("hips", "head")
        across = at["left_upper_arm"] - at["right_upper_arm"]
        across -= up * (up @ across)
        across /= max(1e-9, float(np.linalg.norm(across)))
        ahead = np.cross(across, up)
        ends = {
            "upper": ("upper_arm", "lower_arm"),
            "lower": ("lower_arm", "hand"),
            "arm": ("upper_arm", "hand"),
            "leg": ("upper_leg", "foot"),
        }
        return {
            f"{side}_{name}": np.array([sign * (line @ across), line @ up, line @ ahead])
            for side, sign in (("left", 1), ("right", -1))
            for name, (a, b) in ends.items()
            for line in (way(f"{side}_{a}", f"{side}_{b}"),)
        }


def _size(ways: Array, weights: Array) -> Array:
    return np.asarray(np.sqrt(np.einsum("...ji,...ji,j->...", ways, ways, weights)))


def _measured(
    skeleton: Skeleton, clips: Sequence[Clip], moved: list[int], weights: Array
) -> tuple[Array, Array, Array, Array]:
    """Return for clips, one after another: the joints' positions relative to their centre `[F, J, 3]`, the
    sizes of these `[F]`, the sizes of the steps to the next frame, and the steps of the centres. Steps from
    clip to clip mean nothing. `moved` has the joints that are translated.
    """
    frames, rest = sum(clip.frames for clip in clips), skeleton.rest_translations.astype(np.float32)
    locals_ = np.empty((frames, len(skeleton), 3), np.float32)
    locals_[:] = rest
    locals_[:, moved] = np.concatenate([clip.translations for clip in clips])
    _, places = skeleton.globals(Pose(np.concatenate([clip.rotations for clip in clips]), locals_))
    middles = np.einsum("fji,j->fi", places, weights, dtype=np.float64)
    places -= middles[:, None].astype(places.dtype)
    turned = _size(np.diff(places, axis=0), weights)
    return places, _size(places, weights), turned, np.linalg.norm(np.diff(middles, axis=0), axis=-1)


def _weights(
    skeleton: Skeleton, moved: Sequence[int], bones: tuple[Array, Array, Array] | None = None
) -> Array:
    """Return how much joints count `[J]` in clips in which some are translated. `bones` are the skeleton's,
    if known.
    """
    own, inner, above = bones or _bones(skeleton)
    lengths = own.copy()
    # the bone from a root on the ground to the hips is no part of the body
    lengths[moved] *= skeleton.below[moved] <= len(skeleton) / 2
    np.add.at(lengths, above, lengths[inner])
    total = float(lengths.sum())
    return lengths / total if total > 0 else np.full(len(lengths), 1 / len(lengths))


def _bones(skeleton: Skeleton) -> tuple[Array, Array, Array]:
    """Return the joints' distances from their parents `[J]`, the joints that have a parent, and these
    parents.
    """
    lengths = np.linalg.norm(skeleton.rest_translations, axis=-1)
    inner = np.flatnonzero(skeleton.parents >= 0)
    lengths[skeleton.parents < 0] = 0
    return lengths, inner, skeleton.parents[inner]


def find_stray_poses(clips: Sequence[Clip], bound: Sequence[Pose] = ()) -> list[StrayPoses]:
    """Return the frames of each clip that do not belong to it. `bound` are other poses besides the rest pose
    that a tool may have left there.
    """
    out = [StrayPoses()] * len(clips)
    bones: dict[int, tuple[Array, Array, Array]] = {}
    for numbers in _alike(clips):
        some = [clips[n] for n in numbers]
        skeleton = some[0].skeleton
        if id(skeleton) not in bones:
            bones[id(skeleton)] = _bones(skeleton)
        for number, take in zip(numbers, _Take.alike(some, bound, bones[id(skeleton)]), strict=True):
            out[number] = _stray(take)
    return out


def _alike(clips: Sequence[Clip]) -> Iterator[list[int]]:
    """Yield the numbers of clips that can be computed together. Clips too short for stray poses are
    left out.
    """
    groups: dict[tuple[int, tuple[int, ...]], list[int]] = {}
    for number, clip in enumerate(clips):
        if clip.frames >= FEWEST:
            groups.setdefault((id(clip.skeleton), clip.translated), []).append(number)
    for numbers in groups.values():
        some, size = [numbers[0]], clips[numbers[0]].rotations.size
        for number in numbers[1:]:
            size += clips[number].rotations.size
            if size > AT_ONCE:
                yield some
                some, size = [], clips[number].rotations.size
            some.append(number)
        yield some


def _stray(take: _Take) -> StrayPoses:
    frames = take.clip.frames
    last = _leading(take, True)
    first = _leading(take, False)
    if first + last > frames - 2:
        return StrayPoses()
    lone = _lone(take, first, frames - last) if take.clip.fps >= SLOWEST else ()
    return StrayPoses(first, last, lone)


def is_bind_pose(clip: Clip) -> bool:
    """Return whether a clip's first frame is the rest pose, a T- or an A-pose."""
    return _Take.alike([clip], ())[0].factor(0) < UNLIKE


def _leading(take: _Take, backwards: bool) -> int:
    """Return how many frames at a take's beginning, or its end, belong to a stray pose."""
    way = slice(None, None, -1 if backwards else 1)
    fps, frames = take.clip.fps, take.clip.frames
    return max(_run(take, steps[way], way, fps, frames) for steps in take.steps)


def _run(take: _Take, steps: Array, way: slice, fps: float, frames: int) -> int:
    count, numbers = len(steps), steps.tolist()  # for a few numbers, Python finds the largest faster
    held = 0  # steps of a pose that is held
    most = min(round(HOLD * fps), frames // 4)
    while (
        held < most
        and held + 1 < count
        and numbers[held] < max(STILL, 0.02 * max(numbers[held + 1 : held + 3]))
    ):
        held += 1
    window = max(3, round(AFTER * fps))
    longest = max(3, round(RAMP * fps))
    for start in dict.fromkeys((held, 0)):
        for length in range(min(longest, count - 1 - start), 0, -1):
            end = start + length
            peak = max(numbers[start:end])
            if peak < VISIBLE:
                continue
            following = numbers[end : end + window]
            after = max(STILL, *following)
            if peak < OWN * after:
                continue
            # Either much quicker than what follows, or it breaks off like nothing after it.
            smooth = max((STILL, *(abs(b - a) for a, b in pairwise(following))))
            next_ones = max(STILL, *following[:3])
            odds = max(peak / after, BROKEN * (peak - numbers[end]) / smooth, SOON * peak / next_ones)
            if odds < LIKENESS[0][1]:
                continue
            own = _usual(numbers[end:]) if odds < CERTAIN and count - end > 8 else 0.0
            if odds < CERTAIN and peak <= OWN * own:
                continue
            # A ramp has one speed from its first frame on and stops abruptly; its last step may be shorter.
            if (
                numbers[end - 1] < max(min(2.5 * after, 0.7 * peak), 0.03 * peak)
                or numbers[start] < 0.7 * peak
            ):
                continue
            if length > 2 and min(numbers[start : end - 1]) < 0.7 * peak:
                continue
            inner = steps[end : count - longest]
            beside = np.maximum(inner[2:], inner[:-2]) if len(inner) > 2 else np.zeros(0)
            if (inner[1:-1] > np.maximum(0.5 * peak, LIKENESS[-1][1] * beside)).any():
                continue  # a take that also jumps elsewhere is made of poses
            first = range(frames)[way][start]
            factor = take.factor(first)
            alone = ALONE
            if factor == UNLIKE and odds >= MIRRORED[0] and take.mirrored(first):
                factor, alone = MIRRORED
            if odds < factor or (factor >= MIRRORED[0] and peak < alone * max(numbers[end:])):
                continue
            if length == 1 or _straight(take.clip, np.arange(frames)[way][start : end + 1]):
                return end
    return 0


def _usual(steps: list[float]) -> float:
    """Return the step that one in twenty exceeds, as `numpy.quantile` does."""
    place = 0.95 * (len(steps) - 1)
    low = int(place)
    part, some = place - low, sorted(steps)
    a, b = some[low], some[min(low + 1, len(some) - 1)]
    return a + (b - a) * part if part < 0.5 else b - (b - a) * (1 - part)


def _straight(clip: Clip, frames: Array) -> bool:
    """Return whether the poses between the first and the last frame lie on the straight line
    between those.
    """
    turns = clip.rotations[frames].astype(float)
    far = rotation.measure_angle_between(turns[-1], turns[0])
    moving = far > np.radians(5)
    if not moving.any():
        return True
    far = np.where(moving, far, 1.0)
    parts = rotation.measure_angle_between(turns[1:-1], turns[0]) / far
    for pose, part in zip(turns[1:-1], parts, strict=True):
        share = float(np.median(part[moving]))
        between = rotation.slerp(turns[0], turns[-1], np.full(len(far), share))
        off = rotation.measure_angle_between(pose, between)[moving] / far[moving]
        if share > 1.05 or float(np.median(off)) > 0.03:
            return False
    return True


def _lone(take: _Take, first: int, stop: int) -> tuple[int, ...]:
    """Return frames in `first + 1 .. stop - 2` whose neighbours follow each other as if the frames were not
    there.
    """
    steps = take.steps[0]
    if stop - first < 5:
        return ()
    both = np.minimum(steps[first : stop - 2], steps[first + 1 : stop - 1])
    far = np.flatnonzero(both >= LONE_STEP) + first + 1
    if not len(far):
        return ()
    over = take.size(take.places[far + 1] - take.places[far - 1]) / take.spread
    out: list[int] = []
    for frame, step, across in zip(far.tolist(), both[far - first - 1].tolist(), over.tolist(), strict=True):
        if step < LONE_BOUND * across:
            continue
        around = np.concatenate(
            [steps[max(first, frame - 4) : frame - 1], steps[frame + 1 : min(frame + 4, stop - 1)]]
        )
        usual = max(across, float(around.max(initial=STILL)))
        if step < LONE_BOUND * usual:
            continue
        # A blow of one arm may be as quick; in a stray pose most of the body moves.
        away = np.linalg.norm(take.places[frame] - take.places[[frame - 1, frame + 1]].mean(0), axis=-1)
        share = float(take.weights[away > 0.05 * take.spread].sum())
        if share > 0.5 and (step >= LONE * usual or step >= take.factor(frame) * usual):
            out.append(frame)
    return tuple(out)
