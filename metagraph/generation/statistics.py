"""How generated motion compares with what was recorded: space, speed, who moves when, and how differently
(figures 6 to 8 of the paper, as numbers).

No number says more than what stands beside it: the *floor*, what other motion as true reaches; *mismatched*,
true motion to other speech; and the *mean pose*.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.generation.features import PARTNER, SELF
from metagraph.generation.landmarks import HEAD, NOSE, WRISTS, landmarks_of
from metagraph.generation.networks import FPS
from metagraph.generation.poses import PoseRig, Scale, scale_of
from metagraph.generation.takes import NO_MARKS, Marks, Take
from metagraph.generation.vae import principal

Array = NDArray[Any]

BLOCK = 15.0  # seconds that are drawn together
DRAWS = 200
LEVEL = 0.95
NEAR, ABOUT, NOD = 0.25, 1.0, 1.0  # seconds: of a stroke; of a profile; after what is answered
WINDOW = 25  # frames of the Frechet distance's windows
SCORES = 12  # principal components
QUANTILES = 512
MEASURES = (
    *("distance", "speed", "speed_w1", "acceleration", "wrist_range", "role", "role_w1"),
    *("stroke", "nods_responses", "nods_hesitations", "profile", "frechet"),
)


@dataclass(frozen=True, eq=False)
class Performance:
    """Motion, with what is heard beside it. landmarks: `[T, 9, 3]` metres; poses: `[T, X]`, not standardised;
    activity: `[T, 4]`; marks: when something is said.
    """

    landmarks: Array
    poses: Array
    activity: Array
    marks: Marks = NO_MARKS

    def __len__(self) -> int:
        return len(self.poses)

    @cached_property
    def speeds(self) -> Array:
        """Of landmarks, `[T - 1, 9]`, cm/s."""
        return np.asarray(np.linalg.norm(np.diff(self.landmarks, axis=0), axis=-1) * FPS * 100)

    @cached_property
    def accelerations(self) -> Array:
        """Of landmarks, `[T - 2, 9]`, cm/s^2."""
        return np.asarray(np.linalg.norm(np.diff(self.landmarks, 2, axis=0), axis=-1) * FPS**2 * 100)

    @cached_property
    def hands(self) -> Array:
        """The speed of the faster hand, `[T - 1]`, cm/s."""
        return np.asarray(self.speeds[:, list(WRISTS)].max(1))

    @cached_property
    def nodding(self) -> Array:
        """How fast the nose goes up or down beside the head, `[T - 1]`, cm/s."""
        up = self.landmarks[:, NOSE, 1] - self.landmarks[:, HEAD, 1]
        return np.asarray(np.abs(np.diff(up)) * FPS * 100)

    def distances(self, mean: Array) -> Array:
        """Return how far landmarks are from a mean pose `[9, 3]`: `[T, 9]`, cm."""
        return np.asarray(np.linalg.norm(self.landmarks - mean, axis=-1) * 100)

    def derivatives(self, mean: Array) -> tuple[Array, Array]:
        """Return how fast those distances grow `[n, 9]`, cm/s, while speaking, and while listening."""
        rate = np.diff(self.distances(mean), axis=0) * FPS
        return rate[self.activity[1:, SELF] > 0.5], rate[self.activity[1:, PARTNER] > 0.5]

    def part(self, first: int, last: int) -> Performance:
        """Return frames first to last, excluded."""
        marks = self.marks.shifted(first / FPS, last / FPS)
        cut = slice(first, last)
        return Performance(self.landmarks[cut], self.poses[cut], self.activity[cut], marks)


def performance(rig: PoseRig, poses: Array, take: Take) -> Performance:
    """Return motion as though it were a take's: poses `[T, X]`, not standardised, with what that take
    hears.
    """
    count = min(len(poses), len(take.features))
    poses = np.asarray(poses[:count], np.float64)
    return Performance(landmarks_of(rig, poses), poses, take.activity[:count], take.marks)


def blocks(motion: Sequence[Performance], seconds: float = BLOCK) -> list[Performance]:
    """Return motion cut into blocks; what is over at an end is a block of its own where it lasts half as
    long.
    """
    size = round(seconds * FPS)
    out = []
    for each in motion:
        edges = list(range(0, len(each), size))
        if len(edges) > 1 and len(each) - edges[-1] < size // 2:
            edges.pop()
        ends = [*edges[1:], len(each)]
        out += [each.part(a, b) for a, b in zip(edges, ends, strict=True)]
    return out


def mean_landmarks(motion: Sequence[Performance]) -> Array:
    """Return the mean place of each landmark `[9, 3]`."""
    return np.asarray(np.concatenate([m.landmarks for m in motion]).mean(0))


def wasserstein(a: Array, b: Array) -> float:
    """Return the distance W1 between two sets of numbers: the mean difference of their quantiles; nan where
    one is empty.
    """
    if not len(a) or not len(b):
        return float("nan")
    at = (np.arange(QUANTILES) + 0.5) / QUANTILES
    return float(np.abs(np.quantile(a, at) - np.quantile(b, at)).mean())


@dataclass(frozen=True, eq=False)
class _Truth:
    """What is known of recorded motion, once for all comparisons."""

    mean: Array  # of landmarks
    scale: Scale  # of poses
    centre: Array
    basis: Array


def _truth(motion: Sequence[Performance]) -> _Truth:
    poses = np.concatenate([m.poses for m in motion])
    scale = scale_of(poses)
    parts = principal(scale.apply(poses), min(SCORES, poses.shape[1]), "scores")
    return _Truth(mean_landmarks(motion), scale, parts["scores.mean"], parts["scores.basis"])


def measures(
    generated: Sequence[Performance], true: Sequence[Performance], truth: _Truth | None = None
) -> dict[str, float]:
    """Return all MEASURES of generated motion beside what was recorded; nan where what it is made of does not
    occur. distance, frechet: the smaller the better, down to the floor. speed, acceleration, wrist_range,
    profile: 1 is perfect; speed_w1, role_w1: 0. role, stroke, nods: as the recorded motion's own. Raises
    ValueError where there is nothing to compare.
    """
    if not generated or not true or min(len(m) for m in (*generated, *true)) < 3:
        raise ValueError("there is no motion to compare: give takes of some seconds")
    truth = _truth(true) if truth is None else truth
    far, far_true = (np.concatenate([m.distances(truth.mean) for m in ms]) for ms in (generated, true))
    speed, speed_true = (np.concatenate([m.speeds for m in ms]) for ms in (generated, true))
    jerky, jerky_true = (np.concatenate([m.accelerations for m in ms]).mean() for ms in (generated, true))
    hands = list(WRISTS)
    profile, profile_true = _profile(generated), _profile(true)
    out = {
        "distance": _columns(far, far_true) / _least(far_true.mean()),
        "speed": float(speed.mean() / _least(speed_true.mean())),
        "speed_w1": _columns(speed, speed_true) / _least(speed_true.mean()),
        "acceleration": float(jerky / _least(jerky_true)),
        "wrist_range": float(_range(far[:, hands]) / _least(_range(far_true[:, hands]))),
        **_roles(generated, true, truth.mean),
        "stroke": _stroke(generated),
        "nods_responses": _nods(generated, lambda m: m.responses),
        "nods_hesitations": _nods(generated, lambda m: m.hesitations),
        "profile": _correlation(profile, profile_true),
        "frechet": _frechet(_windows(generated, truth), _windows(true, truth)),
    }
    return {name: out[name] for name in MEASURES}


def _least(value: Any) -> float:
    return max(float(value), 1e-9)


def _columns(a: Array, b: Array) -> float:
    """Return the mean W1 over columns."""
    return float(np.mean([wasserstein(a[:, n], b[:, n]) for n in range(a.shape[1])]))


def _range(values: Array) -> float:
    low, high = np.percentile(values, (25, 75), axis=0)
    return float((high - low).mean())


def _roles(generated: Sequence[Performance], true: Sequence[Performance], mean: Array) -> dict[str, float]:
    def both(motion: Sequence[Performance]) -> list[Array]:
        pairs = [m.derivatives(mean) for m in motion]
        return [np.concatenate([p[n] for p in pairs]) for n in range(2)]

    made, recorded = both(generated), both(true)
    if min(map(len, (*made, *recorded))) < 2:
        return {"role": float("nan"), "role_w1": float("nan")}
    apart = [_columns(a, b) / _least(np.abs(b).mean()) for a, b in zip(made, recorded, strict=True)]
    return {
        "role": float(np.abs(made[0]).mean() / _least(np.abs(made[1]).mean())),
        "role_w1": float(np.mean(apart)),
    }


def _moments(count: int, moments: Sequence[float], before: float, after: float) -> Array:
    """Return which of `count` steps are near moments (seconds): from `before` seconds before to `after`
    after.
    """
    out = np.zeros(count, bool)
    for at in moments:
        first, last = round((at - before) * FPS), round((at + after) * FPS)
        out[max(0, first) : max(0, last)] = True
    return out


def _beside(
    motion: Sequence[Performance], values: Callable[[Performance], Array], near: Callable[[int, Marks], Array]
) -> float:
    """Return the mean of values at some moments over their mean at all; nan without such moments."""
    every = np.concatenate([values(m) for m in motion])
    some = np.concatenate([near(len(m) - 1, m.marks) for m in motion])
    return float(every[some].mean() / _least(every.mean())) if some.any() else float("nan")


def _stroke(motion: Sequence[Performance]) -> float:
    return _beside(motion, lambda m: m.hands, lambda n, marks: _moments(n, marks.peaks, NEAR, NEAR))


def _nods(motion: Sequence[Performance], which: Callable[[Marks], tuple[float, ...]]) -> float:
    return _beside(motion, lambda m: m.nodding, lambda n, marks: _moments(n, which(marks), 0.0, NOD))


def _profile(motion: Sequence[Performance]) -> Array:
    """Return the hands' mean speed about peaks, `[2 ABOUT FPS + 1]`; empty without any."""
    reach = round(ABOUT * FPS)
    rows = [
        m.hands[at - reach : at + reach + 1]
        for m in motion
        for at in (round(p * FPS) for p in m.marks.peaks)
        if at - reach >= 0 and at + reach + 1 <= len(m.hands)
    ]
    return np.mean(rows, axis=0) if rows else np.zeros(0)


def _correlation(a: Array, b: Array) -> float:
    if not len(a) or not len(b) or min(a.std(), b.std()) < 1e-9:
        return float("nan")
    return float(np.corrcoef(a, b)[0, 1])


def _windows(motion: Sequence[Performance], truth: _Truth) -> Array:
    """Return mean, deviation and mean step of the scores of each second, `[n, 3 SCORES]`."""
    rows = []
    for m in motion:
        scores = (truth.scale.apply(m.poses) - truth.centre) @ truth.basis.T
        for first in range(0, len(scores) - WINDOW + 1, WINDOW):
            some = scores[first : first + WINDOW]
            rows.append(np.concatenate([some.mean(0), some.std(0), np.abs(np.diff(some, axis=0)).mean(0)]))
    return np.array(rows, np.float64).reshape(len(rows), -1)


def _frechet(a: Array, b: Array) -> float:
    """Return the Frechet distance between Gaussians fitted to rows; nan for fewer than two rows."""
    if min(len(a), len(b)) < 2:
        return float("nan")
    first, second = (np.cov(x, rowvar=False) for x in (a, b))
    root = _root(first)
    cross = _root(root @ second @ root)
    apart = ((a.mean(0) - b.mean(0)) ** 2).sum()
    return float(max(0.0, apart + np.trace(first) + np.trace(second) - 2 * np.trace(cross)))


def _root(matrix: Array) -> Array:
    """Return the square root of a symmetric matrix without negative eigenvalues."""
    values, vectors = np.linalg.eigh((matrix + matrix.T) / 2)
    return np.asarray((vectors * np.sqrt(np.maximum(values, 0))) @ vectors.T)


def diversity(performances: Sequence[Sequence[Performance]]) -> float:
    """Return how far landmarks are apart between two of several takes to the same speech, cm: the mean over
    pairs and frames; nan for fewer than two.
    """
    rows = []
    for n, one in enumerate(performances):
        for other in performances[n + 1 :]:
            for a, b in zip(one, other, strict=True):
                count = min(len(a), len(b))
                apart = a.landmarks[:count] - b.landmarks[:count]
                rows.append(np.linalg.norm(apart, axis=-1).mean(1) * 100)
    return float(np.concatenate(rows).mean()) if rows else float("nan")


# --- what stands beside


def mean_pose(true: Sequence[Performance]) -> list[Performance]:
    """Return somebody who holds the mean pose."""
    landmarks, poses = mean_landmarks(true), np.concatenate([m.poses for m in true]).mean(0)
    return [
        replace(m, landmarks=np.repeat(landmarks[None], len(m), 0), poses=np.repeat(poses[None], len(m), 0))
        for m in true
    ]


def mismatched(true: Sequence[Performance]) -> list[Performance]:
    """Return recorded motion to other speech: the next take's, or of one alone that of half of its length
    later.
    """
    out = []
    for n, m in enumerate(true):
        other = true[(n + 1) % len(true)]
        shift = len(m) // 2 if len(true) == 1 else 0
        take = (np.arange(len(m)) + shift) % len(other)
        out.append(replace(m, landmarks=other.landmarks[take], poses=other.poses[take]))
    return out


@dataclass(frozen=True)
class Row:
    """A system's measures. spread: of each the interval that LEVEL of the draws of blocks fall into."""

    name: str
    values: Mapping[str, float]
    spread: Mapping[str, tuple[float, float]]


def row(
    name: str,
    generated: Sequence[Sequence[Performance]],
    true: Sequence[Performance],
    seed: int = 1,
    draws: int = DRAWS,
) -> Row:
    """Return a system's row. generated: of each seed, motion to all that `true` holds, in its order. Values
    are means over seeds; the spread is by drawing blocks of BLOCK seconds, and seeds, with replacement.
    """
    truth = _truth(true)
    whole = [measures(each, true, truth) for each in generated]
    values = {m: float(np.mean([w[m] for w in whole])) for m in MEASURES}
    values["diversity"] = diversity(generated)
    pieces, recorded = [blocks(each) for each in generated], blocks(true)
    chance = np.random.default_rng(seed)
    drawn: list[dict[str, float]] = []
    for _ in range(draws):
        which = chance.integers(0, len(recorded), len(recorded))
        some = pieces[int(chance.integers(0, len(pieces)))]
        taken = [n for n in which.tolist() if n < len(some)]
        drawn.append(measures([some[n] for n in taken], [recorded[n] for n in taken], truth))
    tail = (1 - LEVEL) / 2
    spread = {}
    for m in MEASURES if drawn else ():
        found = np.array([d[m] for d in drawn])
        found = found[np.isfinite(found)]
        if len(found):
            low, high = np.quantile(found, (tail, 1 - tail)).tolist()
            spread[m] = (low, high)
    return Row(name, values, spread)


def table(
    systems: Mapping[str, Sequence[Sequence[Performance]]],
    true: Sequence[Performance],
    floor: Sequence[Performance] | None = None,
    draws: int = DRAWS,
) -> list[Row]:
    """Return a row of each system, below what stands beside them. systems: as `row`'s `generated`. floor:
    other true motion to the same speech; None: the first half of the recorded blocks is measured against the
    other.
    """
    if floor is not None:
        rows = [row("floor", [floor], true, draws=draws)]
    else:
        halves = blocks(true)
        rows = []
        if len(halves) > 1:
            rows = [Row("floor", measures(halves[::2], halves[1::2]), {})]
    rows.append(row("mismatched", [mismatched(true)], true, draws=draws))
    rows.append(row("mean pose", [mean_pose(true)], true, draws=draws))
    return rows + [row(name, made, true, draws=draws) for name, made in systems.items()]
