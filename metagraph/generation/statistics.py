"""How generated motion compares with what was recorded: space, speed, who moves when, and how differently
(figures 6 to 8 of the paper, as numbers).

No number says more than what stands beside it: the *floor*, what other motion as true reaches; *mismatched*,
true motion to other speech; and the *mean pose*.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.generation.features import PARTNER, SELF
from metagraph.generation.landmarks import HEAD, NOSE, WRISTS, place_landmarks
from metagraph.generation.networks import FPS
from metagraph.generation.poses import PoseRig, Standardisation, scale_of
from metagraph.generation.takes import NO_MARKS, Take, TakeMarks
from metagraph.generation.vae import find_principal_components

Array = NDArray[Any]

BLOCK = 15.0  # seconds that are drawn together
DRAWS = 200
LEVEL = 0.95
NEAR, ABOUT, NOD = 0.25, 1.0, 1.0  # seconds: of a stroke; of a profile; after what is answered
STILL, RESTING = 4.0, 0.5  # cm/s, and seconds over which a hand that rests is slower on average
WINDOW = 25  # frames of the Frechet distance's windows
SCORES = 12  # principal components
QUANTILES = 512
MEASURES = (
    *("distance", "speed", "speed_w1", "acceleration", "wrist_range", "still", "trembling"),
    *("role", "role_w1"),
    *("stroke", "nods_responses", "nods_hesitations", "profile", "frechet"),
)


@dataclass(frozen=True, eq=False)
class MotionSample:
    """Motion, with what is heard beside it. landmarks: `[T, 9, 3]` metres; poses: `[T, X]`, not standardised;
    activity: `[T, 4]`; marks: when something is said.
    """

    landmarks: Array
    poses: Array
    activity: Array
    marks: TakeMarks = NO_MARKS

    def __len__(self) -> int:
        return len(self.poses)

    def part(self, first: int, last: int) -> MotionSample:
        """Return frames first to last, excluded."""
        marks = self.marks.shifted(first / FPS, last / FPS)
        cut = slice(first, last)
        return MotionSample(self.landmarks[cut], self.poses[cut], self.activity[cut], marks)


def make_motion_sample(rig: PoseRig, poses: Array, take: Take) -> MotionSample:
    """Return motion as though it were a take's: poses `[T, X]`, not standardised, with what that take
    hears.
    """
    count = min(len(poses), len(take.features))
    poses = np.asarray(poses[:count], np.float64)
    return MotionSample(place_landmarks(rig, poses), poses, take.activity[:count], take.marks)


def cut_blocks(motion: Sequence[MotionSample], seconds: float = BLOCK) -> list[MotionSample]:
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


def mean_landmarks(motion: Sequence[MotionSample]) -> Array:
    """Return the mean place of each landmark `[9, 3]`."""
    return np.asarray(np.concatenate([m.landmarks for m in motion]).mean(0))


def measure_wasserstein(a: Array, b: Array) -> float:
    """Return the distance W1 between two sets of numbers: the mean difference of their quantiles; nan where
    one is empty.
    """
    return _apart(np.reshape(a, (-1, 1)), np.reshape(b, (-1, 1)))


def _apart(a: Array, b: Array) -> float:
    """Return the mean W1 over columns."""
    return float(np.abs(_quantiles(a) - _quantiles(b)).mean()) if len(a) and len(b) else float("nan")


def _quantiles(rows: Array) -> Array:
    """Return QUANTILES of each column `[columns, QUANTILES]`."""
    ordered = np.sort(np.ascontiguousarray(rows.T), axis=1)
    at = (np.arange(QUANTILES) + 0.5) / QUANTILES * (len(rows) - 1)
    low = at.astype(int)
    high = np.minimum(low + 1, len(rows) - 1)
    return np.asarray(ordered[:, low] + (ordered[:, high] - ordered[:, low]) * (at - low))


@dataclass(frozen=True, eq=False)
class _Truth:
    """What is known of recorded motion, once for all comparisons."""

    mean: Array  # of landmarks
    scale: Standardisation  # of poses
    centre: Array
    basis: Array


@lru_cache(maxsize=2)  # every row of a table is beside the same
def _truth(motion: tuple[MotionSample, ...]) -> _Truth:
    poses = np.concatenate([m.poses for m in motion])
    scale = scale_of(poses)
    parts = find_principal_components(scale.apply(poses), min(SCORES, poses.shape[1]), "scores")
    return _Truth(mean_landmarks(motion), scale, parts["scores.mean"], parts["scores.basis"])


@dataclass(frozen=True, eq=False)
class _Parts:
    """What measures are made of, of one stretch of motion; cm and seconds. Of `near`, `profile` and
    `windows` all stretches' rows are put together.
    """

    far: Array  # landmarks from their mean `[T, 9]`
    speeds: Array  # of landmarks `[T - 1, 9]`
    jerks: Array  # their mean acceleration `[T - 2]`
    still: Array  # whether each hand rests `[T - 1, 2]`
    trembling: Array  # acceleration of hands that rest `[n]`
    speaking: Array  # how fast the distances grow `[n, 9]`
    listening: Array
    hands: Array  # speed of the faster one `[T - 1]`
    nodding: Array  # how fast the nose goes up or down beside the head `[T - 1]`
    strokes: Array  # which steps are near own peaks, after responses, after hesitations `[T - 1]`
    responses: Array
    hesitations: Array
    profile: Array  # hands about peaks `[n, 2 ABOUT FPS + 1]`
    windows: Array  # mean, deviation and mean step of the scores of each second `[n, 3 SCORES]`


def _parts(m: MotionSample, truth: _Truth) -> _Parts:
    steps = np.diff(m.landmarks, axis=0) * (FPS * 100)
    far = np.linalg.norm(m.landmarks - truth.mean, axis=-1) * 100
    growing = np.diff(far, axis=0) * FPS
    speeds = np.linalg.norm(steps, axis=-1)
    wrists = list(WRISTS)
    hands = speeds[:, wrists].max(1)
    still = np.stack([_averaged(speeds[:, w], round(RESTING * FPS)) < STILL for w in wrists], 1)
    sharp = np.linalg.norm(np.diff(steps[:, wrists], axis=0), axis=-1) * FPS
    reach, count = round(ABOUT * FPS), len(steps)
    peaks = [at for at in (round(p * FPS) for p in m.marks.peaks) if reach <= at < count - reach]
    scores = (truth.scale.apply(m.poses) - truth.centre) @ truth.basis.T
    whole = len(scores) // WINDOW
    pieces = scores[: whole * WINDOW].reshape(whole, WINDOW, -1).astype(np.float64)
    told = [pieces.mean(1), pieces.std(1), np.abs(np.diff(pieces, axis=1)).mean(1)]
    return _Parts(
        far,
        speeds,
        np.linalg.norm(np.diff(steps, axis=0), axis=-1).mean(1) * FPS,
        still,
        sharp[still[1:] & still[:-1]],
        growing[m.activity[1:, SELF] > 0.5],
        growing[m.activity[1:, PARTNER] > 0.5],
        hands,
        np.abs(steps[:, NOSE, 1] - steps[:, HEAD, 1]),
        _moments(count, m.marks.peaks, NEAR, NEAR),
        _moments(count, m.marks.responses, 0.0, NOD),
        _moments(count, m.marks.hesitations, 0.0, NOD),
        np.array([hands[at - reach : at + reach + 1] for at in peaks]).reshape(len(peaks), 2 * reach + 1),
        np.concatenate(told, 1),
    )


def _together(parts: Sequence[_Parts]) -> _Parts:
    return _Parts(*(np.concatenate([getattr(p, f.name) for p in parts]) for f in fields(_Parts)))


def compute_measures(generated: Sequence[MotionSample], true: Sequence[MotionSample]) -> dict[str, float]:
    """Return all MEASURES of generated motion beside what was recorded; nan where what it is made of does not
    occur. distance, frechet: the smaller the better, down to the floor. speed, acceleration, wrist_range,
    still (how often hands rest), trembling (their acceleration while they do), profile: 1 is perfect;
    speed_w1, role_w1: 0. role, stroke, nods: as the recorded motion's own. Raises ValueError if there is
    nothing to compare.
    """
    if not generated or not true or min(len(m) for m in (*generated, *true)) < 3:
        raise ValueError("there is no motion to compare: give takes of some seconds")
    truth = _truth(tuple(true))
    return _compared(*(_together([_parts(m, truth) for m in motion]) for motion in (generated, true)))


def _compared(made: _Parts, true: _Parts) -> dict[str, float]:
    hands = list(WRISTS)
    role = role_w1 = float("nan")
    if min(map(len, (made.speaking, made.listening, true.speaking, true.listening))) > 1:
        role = float(np.abs(made.speaking).mean() / _least(np.abs(made.listening).mean()))
        pairs = ((made.speaking, true.speaking), (made.listening, true.listening))
        role_w1 = float(np.mean([_apart(a, b) / _least(np.abs(b).mean()) for a, b in pairs]))
    out = {
        "distance": _apart(made.far, true.far) / _least(true.far.mean()),
        "speed": float(made.speeds.mean() / _least(true.speeds.mean())),
        "speed_w1": _apart(made.speeds, true.speeds) / _least(true.speeds.mean()),
        "acceleration": float(made.jerks.mean() / _least(true.jerks.mean())),
        "wrist_range": _range(made.far[:, hands]) / _least(_range(true.far[:, hands])),
        "still": float(made.still.mean() / _least(true.still.mean())),
        "trembling": float("nan"),
        "role": role,
        "role_w1": role_w1,
        "stroke": _beside(made.hands, made.strokes),
        "nods_responses": _beside(made.nodding, made.responses),
        "nods_hesitations": _beside(made.nodding, made.hesitations),
        "profile": _profile(made.profile, true.profile),
        "frechet": _frechet(made.windows, true.windows),
    }
    if len(made.trembling) and len(true.trembling):
        out["trembling"] = float(made.trembling.mean() / _least(true.trembling.mean()))
    return {name: out[name] for name in MEASURES}


def _averaged(values: Array, count: int) -> Array:
    """Return the mean of so many values about each, fewer at the ends."""
    count = min(count, len(values))
    whole = np.convolve(np.ones(len(values)), np.ones(count), "same")
    return np.asarray(np.convolve(values, np.ones(count), "same") / whole)


def _least(value: Any) -> float:
    return max(float(value), 1e-9)


def _range(values: Array) -> float:
    """Return how far the quarters are apart, the mean over columns."""
    low, high = np.percentile(values, (25, 75), axis=0)
    return float((high - low).mean())


def _moments(count: int, moments: Sequence[float], before: float, after: float) -> Array:
    """Return which of `count` steps are near moments (seconds): from `before` before to `after` after
    them.
    """
    out = np.zeros(count, bool)
    for at in moments:
        out[max(0, round((at - before) * FPS)) : max(0, round((at + after) * FPS))] = True
    return out


def _beside(values: Array, some: Array) -> float:
    """Return the mean of some values over the mean of all; nan without any."""
    return float(values[some].mean() / _least(values.mean())) if some.any() else float("nan")


def _profile(made: Array, true: Array) -> float:
    """Return the correlation of the mean speeds about peaks."""
    if not len(made) or not len(true):
        return float("nan")
    a, b = made.mean(0), true.mean(0)
    return float("nan") if min(a.std(), b.std()) < 1e-9 else float(np.corrcoef(a, b)[0, 1])


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


def measure_diversity(performances: Sequence[Sequence[MotionSample]]) -> float:
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


def mean_pose(true: Sequence[MotionSample]) -> list[MotionSample]:
    """Return somebody who holds the mean pose."""
    landmarks, poses = mean_landmarks(true), np.concatenate([m.poses for m in true]).mean(0)
    return [
        replace(m, landmarks=np.repeat(landmarks[None], len(m), 0), poses=np.repeat(poses[None], len(m), 0))
        for m in true
    ]


def mismatch_speech(true: Sequence[MotionSample]) -> list[MotionSample]:
    """Return recorded motion to other speech: the next take's, half of its length later, since the next may
    be the other side of the same conversation.
    """
    out = []
    for n, m in enumerate(true):
        other = true[(n + 1) % len(true)]
        take = (np.arange(len(m)) + len(m) // 2) % len(other)
        out.append(replace(m, landmarks=other.landmarks[take], poses=other.poses[take]))
    return out


@dataclass(frozen=True)
class MeasureRow:
    """A system's measures. spread: of each the interval that LEVEL of the draws of blocks fall into."""

    name: str
    values: Mapping[str, float]
    spread: Mapping[str, tuple[float, float]]


def measure_system(
    name: str,
    generated: Sequence[Sequence[MotionSample]],
    true: Sequence[MotionSample],
    seed: int = 1,
    draws: int = DRAWS,
) -> MeasureRow:
    """Return a system's row. generated: of each seed, motion to all that `true` holds, in its order. Values
    are means over seeds; the spread is by drawing blocks of BLOCK seconds, and seeds, with replacement.
    """
    whole = [compute_measures(each, true) for each in generated]
    values = {m: float(np.mean([w[m] for w in whole])) for m in MEASURES}
    values["diversity"] = measure_diversity(generated)
    truth = _truth(tuple(true))
    pieces = [[_parts(b, truth) for b in cut_blocks(each)] for each in generated]
    recorded = [_parts(b, truth) for b in cut_blocks(true)]
    chance = np.random.default_rng(seed)
    drawn: list[dict[str, float]] = []
    for _ in range(draws):
        which = chance.integers(0, len(recorded), len(recorded))
        some = pieces[int(chance.integers(0, len(pieces)))]
        taken = [n for n in which.tolist() if n < len(some)]
        drawn.append(_compared(_together([some[n] for n in taken]), _together([recorded[n] for n in taken])))
    tail = (1 - LEVEL) / 2
    spread = {}
    for m in MEASURES if drawn else ():
        found = np.array([d[m] for d in drawn])
        found = found[np.isfinite(found)]
        if len(found):
            low, high = np.quantile(found, (tail, 1 - tail)).tolist()
            spread[m] = (low, high)
    return MeasureRow(name, values, spread)


def tabulate_measures(
    systems: Mapping[str, Sequence[Sequence[MotionSample]]],
    true: Sequence[MotionSample],
    floor: Sequence[MotionSample] | None = None,
    draws: int = DRAWS,
) -> list[MeasureRow]:
    """Return a row of each system, below what stands beside them. systems: as `measure_system`'s
    `generated`. floor: other true motion to the same speech; None: the first half of the recorded blocks is
    measured against the other.
    """
    if floor is not None:
        rows = [measure_system("floor", [floor], true, draws=draws)]
    else:
        halves = cut_blocks(true)
        rows = []
        if len(halves) > 1:
            rows = [MeasureRow("floor", compute_measures(halves[::2], halves[1::2]), {})]
    rows.append(measure_system("mismatched", [mismatch_speech(true)], true, draws=draws))
    rows.append(measure_system("mean pose", [mean_pose(true)], true, draws=draws))
    return rows + [measure_system(name, made, true, draws=draws) for name, made in systems.items()]
