"""From steps to motion: each step is one move from posture to posture, and moves add up.

A joint's rotation is `q0 * exp(w1 d1) * exp(w2 d2) ...`, where d is the turn one step asks for and w its
progress from 0 to 1. Because every step has its own progress, steps may overlap (flow), dip back before they
go (anticipation), run over and come back (overshoot) and sag while they hold; and because every joint reads
the progress at its own time, the hips lead, the arm follows the shoulder, and the fingers arrive last.
"""

from __future__ import annotations

import zlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cache
from typing import Any

import numpy as np

from metagraph.motion import rotation
from sample_clips.make import key_poses
from sample_clips.make.mannequin_rig import FPS, JOINTS, SIDES, Array, arm_joints, at
from sample_clips.make.mannequin_skeleton import FINGERS

LEAD_IN = 0.05  # seconds every clip rests in its first posture, so that a blend has something to hold on to
REST_OUT = 0.02  # and in its last


@dataclass(frozen=True)
class Step:
    """One move. seconds: how long it takes. change: the posture's fields that change (`left`, `spine` ...).

    hold: seconds it stays. peak: where in the move the speed is highest, 0.3 (fast start, long landing) to
    0.65 (gathers speed, lands hard). overshoot, anticipation: parts of the move beyond its end and back
    before its start. flow: part of the move that the next one overlaps, so that a passing posture is passed
    and not stopped at. sag: part of the move given back slowly while holding.
    """

    seconds: float
    change: Mapping[str, Any] = field(default_factory=dict)
    hold: float = 0.0
    peak: float = 0.42
    overshoot: float = 0.035
    anticipation: float = 0.0
    flow: float = 0.0
    sag: float = 0.04


@dataclass(frozen=True)
class Move:
    """A step with its times (seconds), and the time at which what follows it has begun."""

    step: Step
    start: float
    end: float
    left_at: float


@cache
def _ease_table(peak: float) -> Array:
    a, b = (2.0, 2.0 * (1 - peak) / peak) if peak < 0.5 else (2.0 * peak / (1 - peak), 2.0)
    u = np.linspace(0, 1, 1025)
    speed = u**a * (1 - u) ** b
    total = np.concatenate([[0], np.cumsum((speed[1:] + speed[:-1]) / 2)])
    return total / total[-1]


def ease(u: Any, peak: float) -> Array:
    """Return progress 0..1 at `u [...]`: a bell of speed highest at `peak`, still at both ends."""
    return np.interp(np.clip(u, 0, 1), np.linspace(0, 1, 1025), _ease_table(round(peak, 3)))


def bump(t: Array, first: float, last: float) -> Array:
    """Return a soft hill `[...]` of height 1 between two times, without a kink at either end."""
    u = np.clip((t - first) / max(last - first, 1e-6), 0, 1)
    return 64 * u**3 * (1 - u) ** 3


def progress(move: Move, t: Array) -> Array:
    """Return how much of a move is done at times `[...]`: 0 before it, 1 after it."""
    step, long = move.step, move.end - move.start
    w = ease((t - move.start) / long, step.peak)
    if step.anticipation:
        w = w - step.anticipation * bump(t, move.start - 0.45 * long, move.start + 0.5 * long)
    if step.overshoot:
        w = w + step.overshoot * bump(t, move.start + 0.55 * long, move.end + settling(step))
    if step.hold > 0.15 and step.sag:
        w = w - step.sag * bump(t, move.end, move.left_at)
    return w


def settling(step: Step) -> float:
    """Return the seconds an overshoot takes to come back after the step's end."""
    return min(0.36 * step.seconds, 0.2)


def schedule(steps: Sequence[Step], lead: float) -> tuple[list[Move], float]:
    """Return the moves and the clip's duration, a whole number of frames. lead: seconds the leading joints
    run ahead.
    """
    first = steps[0]
    cursor = LEAD_IN + lead + (0.45 * first.seconds if first.anticipation else 0.0)
    moves, over = [], 0.0
    for i, step in enumerate(steps):
        end = cursor + step.seconds
        follows = end + step.hold
        after = steps[i + 1].seconds if i + 1 < len(steps) else 0.0
        moves.append(Move(step, cursor, end, follows + 0.6 * after))
        settled = end + settling(step) if step.overshoot else end
        over = max(over, settled if i == len(steps) - 1 else end)
        cursor = follows - step.flow * step.seconds
    return moves, np.ceil((over + max(LAG.values()) + REST_OUT) * FPS) / FPS


def _lags() -> dict[str, float]:
    lags = {"Hips": -0.05, "Spine": -0.06, "Chest": -0.045, "UpperChest": -0.03, "Neck": 0.02, "Head": 0.035}
    for side in SIDES:
        lags |= {
            side + "Shoulder": -0.035,
            side + "UpperArm": 0.0,
            side + "LowerArm": 0.02,
            side + "Hand": 0.05,
        }
        for i, finger in enumerate(FINGERS):
            for bone in (1, 2, 3):
                lags[f"{side}{finger}{bone}"] = 0.06 + 0.007 * i + 0.014 * bone
    return lags


LAG = _lags()  # arms: the torso begins, the finger tips arrive last; seconds
HEAD_LAG = {
    "Head": 0.0,
    "Neck": 0.02,
    "UpperChest": 0.05,
    "Chest": 0.065,
    "Spine": 0.075,
}  # a look begins with the head
BODY_LAG = {"Hips": 0.0, "Spine": 0.03, "Chest": 0.05, "UpperChest": 0.07, "Neck": 0.09, "Head": 0.105}
LAGS: dict[str, dict[str, float]] = {"arms": LAG, "head": HEAD_LAG, "body": BODY_LAG}


def lead_of(layer: str) -> float:
    """Return the seconds by which the layer's earliest joint runs ahead."""
    return -min(0.0, *LAGS[layer].values())


def lag_array(layer: str, later_side: str = "", later: float = 0.0) -> Array:
    """Return every joint's lag `[J]` in seconds; one arm may be a little later than the other."""
    out = np.zeros(JOINTS)
    for name, lag in LAGS[layer].items():
        out[at(name)] = lag
    if later_side and layer == "arms":
        for name in arm_joints(later_side):
            out[at(name)] += later
    return out


def unlike(moves: Sequence[Move], seed: int) -> list[Move]:
    """Return the moves of the arm that follows: each begins and ends a little later than the other arm's, and
    is fastest at another moment. The last ends no later.
    """
    generator = np.random.default_rng(seed)
    out = []
    for n, move in enumerate(moves):
        begins, ends, peak = generator.uniform((0.01, 0.03, -0.13), (0.08, 0.12, 0.13))
        quick = min(1.0, move.step.seconds / 0.35)
        begins, ends = begins * quick, ends * quick
        if n == len(moves) - 1:
            ends = -0.5 * ends
        long = max(move.end + ends - move.start - begins, 0.6 * move.step.seconds)
        step = replace(move.step, peak=float(np.clip(move.step.peak + peak, 0.32, 0.62)))
        start = move.end + ends - long
        out.append(Move(step, start, start + long, move.left_at + max(ends, 0.0)))
    return out


def blend(
    postures: Sequence[key_poses.Posture],
    moves: Sequence[Move],
    times: Array,
    lags: Array,
    others: Mapping[int, Sequence[Move]],
) -> tuple[Array, Array]:
    """Return rotations `[F, J, 4]` and channels `[F, 13]` of moves through postures (one more than there are
    moves). others: the moves of joints that have their own.
    """
    keyed = np.stack([key_poses.solve(p) for p in postures])
    numbers = np.stack([key_poses.channels(p) for p in postures])
    turns = rotation.log(rotation.multiply(rotation.conjugate(keyed[:-1]), keyed[1:]))
    out = np.broadcast_to(keyed[0], (len(times), JOINTS, 4))
    plain = np.broadcast_to(numbers[0], (len(times), len(numbers[0]))).copy()
    for n, (move, turn, change) in enumerate(zip(moves, turns, np.diff(numbers, axis=0), strict=True)):
        moving = np.flatnonzero(np.abs(turn).max(-1) > 1e-9)
        if len(moving):
            w = np.stack([progress(others.get(j, moves)[n], times - lags[j]) for j in moving], -1)
            out = out.copy()
            out[:, moving] = rotation.multiply(out[:, moving], rotation.exp(w[..., None] * turn[moving]))
        plain += progress(move, times)[:, None] * change
    return out, plain


def seed_of(name: str) -> int:
    """Return the clip's own seed, the same on every machine."""
    return zlib.crc32(name.encode())


def wander(generator: np.random.Generator, frames: int, every: float, count: int, loop: bool) -> Array:
    """Return slow drifts `[F, count]` of about unit size that are still and zero on the first and last frame.

    A cubic B-spline through random values `every` seconds; the values around both ends are zero.
    """
    spans = max(3 if not loop else 4, round((frames - 1) / FPS / every))
    knots = np.zeros((spans + 3, count))
    inner = max(0, spans - 3)
    knots[3 : 3 + inner] = generator.normal(size=(inner, count))
    u = np.linspace(0, spans, frames)
    i = np.minimum(u.astype(int), spans - 1)
    f = (u - i)[:, None]
    weights = ((1 - f) ** 3, 3 * f**3 - 6 * f**2 + 4, -3 * f**3 + 3 * f**2 + 3 * f + 1, f**3)
    return sum(w * knots[i + k] for k, w in enumerate(weights)) / 6 * 1.4
