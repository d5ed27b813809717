"""How often people move when something is said: hands with clauses, the head with responses and hesitations
(Yang et al., section 5).

Around every segment of speech a window is searched for a movement of the hand or the head. Whether anything
moves there at all is given by a threshold of the whole take (equation 1), where the movement begins and ends
by one of the window (equation 2).
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import sqrt
from statistics import NormalDist
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from metagraph.graph.conversation.model import Segment, Sound
from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.motion.roles import find_roles

Array = NDArray[Any]
Part = Literal["left_hand", "right_hand", "head"]

ACTIVE = 0.1  # alpha_S and alpha_W
WIDE = 2.0  # a window is so many times its segment
AHEAD = 0.12  # metres in front of the head's joint, which itself hardly moves in a nod
CHANCES = 200  # turns of the speech beside the motion, to tell what chance gives
HYPOTHESES: tuple[tuple[str, Sound, tuple[Part, ...]], ...] = (
    ("clause with the left hand", "clause", ("left_hand",)),
    ("clause with the right hand", "clause", ("right_hand",)),
    ("clause with either hand", "clause", ("left_hand", "right_hand")),
    ("response with a nod", "response", ("head",)),
    ("partner's hesitation with a nod", "hesitation", ("head",)),
)


@dataclass(frozen=True)
class CooccurrenceRow:
    """matched of total segments went with a movement. rate: their share, 0..1; low, high: its 95 % interval
    (Wilson). chance: the mean rate when the same speech is laid elsewhere over the same motion.
    """

    hypothesis: str
    matched: int
    total: int
    rate: float
    low: float
    high: float
    chance: float


def measure_part_speeds(clip: Clip, roles: Mapping[str, int] | None = None) -> dict[Part, Array]:
    """Return speeds `[F]`, metres a second, of those parts the skeleton has: hands as seen from the shoulder,
    the head up and down as seen from the neck; so a walk or a turn of the trunk is no gesture, and a step no
    nod.
    """
    named = find_roles(clip.skeleton) if roles is None else roles
    turns, at = clip.skeleton.globals(clip.poses())
    out: dict[Part, Array] = {}

    def seen(point: Array, joint: int) -> Array:
        """The point as seen from what the joint hangs on, with its origin in the joint."""
        above = max(int(clip.skeleton.parents[joint]), 0)
        return rotation.rotate_vectors(rotation.conjugate(turns[:, above]), point - at[:, joint])

    parts: tuple[tuple[Part, str], ...] = (("left_hand", "left_upper_arm"), ("right_hand", "right_upper_arm"))
    for part, shoulder in parts:
        if part in named and shoulder in named:
            out[part] = _speed(seen(at[:, named[part]], named[shoulder]), clip.fps)
    if "head" in named:
        head = named["head"]
        neck = named.get("neck", head)
        ahead = rotation.rotate_vectors(rotation.conjugate(turns[0, head]), np.array([0.0, 0.0, AHEAD]))
        nose = at[:, head] + rotation.rotate_vectors(
            turns[:, head], np.broadcast_to(ahead, at[:, head].shape)
        )
        out["head"] = _speed(seen(nose, neck)[:, 1:2], clip.fps)
    return out


def _speed(track: Array, fps: float) -> Array:
    if len(track) < 2:
        return np.zeros(len(track))
    return np.asarray(np.linalg.norm(np.gradient(track.astype(np.float64), 1 / fps, axis=0), axis=-1))


def find_activation_speed(speed: Array, share: float = ACTIVE) -> float:
    """Return the speed under which nothing moves: min + share (max - min) (equations 1 and 2)."""
    low, high = float(speed.min()), float(speed.max())
    return low + share * (high - low)


def find_movement_windows(
    segments: Sequence[Segment], length: float, every: Sequence[Segment] | None = None
) -> list[tuple[float, float]]:
    """Return where to look for the movement of each segment, seconds: about its middle, WIDE times as long,
    trimmed at the middle of the gaps to its neighbours and at the take's ends (figure 3). every: all that is
    heard, of which neighbours are; the segments themselves where None.
    """
    ends = sorted({s.end for s in (segments if every is None else every)})
    starts = sorted({s.start for s in (segments if every is None else every)})
    out = []
    for s in segments:
        middle, half = (s.start + s.end) / 2, WIDE * (s.end - s.start) / 2
        before, after = bisect_right(ends, s.start) - 1, bisect_left(starts, s.end)
        low, high = max(0.0, middle - half), min(length, middle + half)
        if before >= 0:
            low = max(low, (ends[before] + s.start) / 2)
        if after < len(starts):
            high = min(high, (s.end + starts[after]) / 2)
        out.append((low, high))
    return out


def find_movement(
    speed: Array, fps: float, window: tuple[float, float], idle: float
) -> tuple[float, float] | None:
    """Return when a movement begins and ends within a window, seconds; None if nothing is faster than `idle`
    there (equation 1).

    It begins with the first frame faster than the window's own threshold, and ends with the last (equation
    2).
    """
    first, after = max(0, round(window[0] * fps)), min(len(speed), round(window[1] * fps) + 1)
    part = speed[first:after]
    if not len(part) or float(part.max()) < idle:
        return None
    fast = np.flatnonzero(part > find_activation_speed(part))
    if not len(fast):
        return None
    return (first + int(fast[0])) / fps, (first + int(fast[-1])) / fps


def count_cooccurrence(
    takes: Sequence[Clip], speech: Sequence[Sequence[Segment]], chances: int = CHANCES, seed: int = 1
) -> list[CooccurrenceRow]:
    """Return how often each kind of segment went with which movement, over all takes, as the paper's table 1.

    speech: the segments of each take. chances: how often speech is laid elsewhere, turned round within its
    take, to tell what chance gives. Raises ValueError when there are not as many takes as speeches.
    """
    if len(takes) != len(speech):
        raise ValueError(f"{len(takes)} takes, but speech for {len(speech)}")
    found = [
        (clip, measure_part_speeds(clip), list(segments))
        for clip, segments in zip(takes, speech, strict=True)
    ]
    shifts = np.random.default_rng(seed).random((chances, max(1, len(takes))))
    rows = []
    for words, kind, parts in HYPOTHESES:
        matched, total = _matches(found, kind, parts, None)
        by_chance = [_matches(found, kind, parts, s) for s in shifts] if total else []
        chance = float(np.mean([m / max(1, n) for m, n in by_chance])) if by_chance else 0.0
        low, high = compute_wilson_interval(matched, total)
        rows.append(
            CooccurrenceRow(words, matched, total, matched / total if total else 0.0, low, high, chance)
        )
    return rows


def _matches(
    found: Sequence[tuple[Clip, Mapping[Part, Array], Sequence[Segment]]],
    kind: Sound,
    parts: Sequence[Part],
    shift: Array | None,
) -> tuple[int, int]:
    """Count the segments of a kind that have a movement near, and all. shift: how far each take's speech is
    turned round, 0..1.
    """
    matched = total = 0
    for number, (clip, speed, segments) in enumerate(found):
        if not any(part in speed for part in parts):
            continue
        every = list(segments)
        if shift is not None:
            by = float(shift[number]) * clip.duration
            every = [_turned(s, by, clip.duration) for s in every]
        mine = sorted((s for s in every if s.kind == kind), key=lambda s: s.start)
        idle = {part: find_activation_speed(speed[part]) for part in parts if part in speed}
        seen = dict.fromkeys(idle, 0.0)  # a movement counts once: the next window begins after it
        for low, high in find_movement_windows(mine, clip.duration, every):
            total += 1
            there = False
            for part, least in idle.items():
                moved = find_movement(speed[part], clip.fps, (max(low, seen[part]), high), least)
                if moved is not None:
                    there, seen[part] = True, _over(speed[part], clip.fps, moved[1], least)
            matched += there
    return matched, total


def _over(speed: Array, fps: float, at: float, idle: float) -> float:
    """Return when a movement that is going on at a moment is over, seconds: at rest, or slowest before it is
    faster again.
    """
    frame, last = round(at * fps), len(speed) - 1
    while frame < last and speed[frame + 1] >= speed[frame]:
        frame += 1
    while frame < last and idle <= speed[frame + 1] <= speed[frame]:
        frame += 1
    return (frame + 1) / fps


def _turned(s: Segment, by: float, length: float) -> Segment:
    start = (s.start + by) % max(length, 1e-9)
    return Segment(s.kind, start, start + s.end - s.start)


def compute_wilson_interval(matched: int, total: int, level: float = 0.95) -> tuple[float, float]:
    """Return the interval of a share (Wilson, 1927); 0..1 if there is nothing to tell."""
    if not total:
        return 0.0, 1.0
    z = NormalDist().inv_cdf((1 + level) / 2)
    share, part = matched / total, z * z / total
    middle = (share + part / 2) / (1 + part)
    half = z / (1 + part) * sqrt(share * (1 - share) / total + part / (4 * total))
    return max(0.0, middle - half), min(1.0, middle + half)
