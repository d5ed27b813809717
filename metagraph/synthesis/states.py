"""The frames of takes as states of a motion graph, and which of them transitions may leave and enter (Yang et
al., sections 4.1 and 6).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.motion.clip import Clip
from metagraph.suggest.tracks import RATE, make_joint_track, measure_velocity, track_rig

Array = NDArray[Any]

KEYS = 0.2225  # of all states are key states in the paper
STEP = 3  # k of c_(i, i+k)
LEVEL = 0.95
AT_ONCE = 1 << 15  # frames that are worked on at once, so that long takes are not in memory several times


class SynthesisError(ValueError):
    """A graph or a path that cannot be made; the message says why, and what would help."""


@dataclass(frozen=True, eq=False)
class States:
    """Frames of takes, one after another, at RATE frames a second.

    places `[F, J, 3]` metres, velocities `[F, J, 3]` metres a second: joints seen from the root as the
    character faces, float32. weights `[J]`: w_b. starts `[T + 1]`: the first state of each take, and F.
    velocity: w_v, seconds.
    """

    places: Array
    velocities: Array
    weights: Array
    starts: Array
    velocity: float

    def __len__(self) -> int:
        return len(self.places)

    @property
    def last(self) -> Array:
        """`[F]` whether a state is the last of its take: nothing follows it there."""
        out = np.zeros(len(self), bool)
        out[self.starts[1:] - 1] = True
        return out

    def take(self, state: int) -> int:
        """Return which take a state is of."""
        return int(np.searchsorted(self.starts, state, "right")) - 1


def compute_cost_terms(states: States, which: Array) -> Array:
    """Return `[n, 2 J', 3]` float32: what costs of states are sums of lengths of differences of; joints
    without weight are left out.
    """
    used = np.flatnonzero(states.weights)
    w = states.weights[used, None].astype(np.float32)
    half = len(used)
    whole = slice(None) if half == len(states.weights) else used
    out = np.empty((len(which), 2 * half, 3), np.float32)
    for n in range(0, len(which), AT_ONCE):
        some = which[n : n + AT_ONCE]
        place, speed = states.places.take(some, 0)[:, whole], states.velocities.take(some, 0)[:, whole]
        np.multiply(place, w, out[n : n + AT_ONCE, :half])
        np.multiply(speed, w * np.float32(states.velocity), out[n : n + AT_ONCE, half:])
    return out


def read_states(
    clips: Sequence[Clip], roles: Mapping[str, int] | None = None, velocity: float | None = None
) -> States:
    """Return the states of takes of one skeleton. velocity: w_v, else what brings velocities to the range of
    places, as the paper asks: the mean of d(p) over c_(i, i+k) over that of d(v). Raises SynthesisError for
    takes of other skeletons, or without two frames.
    """
    if not clips:
        raise SynthesisError("a motion graph needs takes; there is none")
    odd = next((c for c in clips if c.skeleton != clips[0].skeleton), None)
    if odd is not None:
        raise SynthesisError(
            f"take '{odd.name}' has another skeleton than '{clips[0].name}': retarget it, or leave it out"
        )
    short = [c.name for c in clips if c.frames < 2]
    if len(short) == len(clips):
        raise SynthesisError("every take has only one frame; a motion graph needs motion")
    rig = track_rig(clips[0], roles)
    tracks = [make_joint_track(rig, c) for c in clips if c.frames >= 2]
    places = np.concatenate(tracks).astype(np.float32)
    velocities = np.concatenate([measure_velocity(t) for t in tracks]).astype(np.float32)
    starts = np.concatenate([[0], np.cumsum([len(t) for t in tracks])])
    weights = np.ones(places.shape[1], np.float32)
    return with_velocity(States(places, velocities, weights, starts, 0.0), velocity)


def with_velocity(states: States, velocity: float | None) -> States:
    """Return states with another w_v; None: that which brings velocities to the range of places."""
    if velocity is None:
        near, later = list_pairs_apart(states, STEP - 1)
        p = _distance(states.places, near, later, states.weights)
        v = _distance(states.velocities, near, later, states.weights)
        velocity = float(p.mean() / v.mean()) if len(v) and v.mean() > 1e-9 else 1 / RATE
    return replace(states, velocity=velocity)


def list_pairs_apart(states: States, frames: int) -> tuple[Array, Array]:
    """Return `[n]` states and `[n]` those so many frames later in the same take."""
    keep = np.ones(len(states), bool)
    for start in states.starts[1:]:
        keep[max(0, int(start) - frames) : int(start)] = False
    near = np.flatnonzero(keep)
    return near, near + frames


def _distance(values: Array, a: Array, b: Array, weights: Array) -> Array:
    out = np.empty(len(a), np.float64)
    for n in range(0, len(a), AT_ONCE):
        out[n : n + AT_ONCE] = (
            np.linalg.norm(values[a[n : n + AT_ONCE]] - values[b[n : n + AT_ONCE]], axis=-1) @ weights
        )
    return out


def compute_costs_apart(states: States, k: int = STEP) -> Array:
    """Return c_(i, i+k) `[n]` of all frames that have one so much later (equations 3 and 4): frame i beside
    frame i + k - 1.
    """
    near, later = list_pairs_apart(states, k - 1)
    costs = _distance(states.places, near, later, states.weights)
    return costs + states.velocity * _distance(states.velocities, near, later, states.weights)


def key_states(states: States, share: float = KEYS, changes: Sequence[int] = ()) -> Array:
    """Return `[K]` the states that transitions may leave and enter, ascending: keyframes, closer where joints
    move more, and states at which what is heard changes. share: of all states, about, 0..1. The first and the
    last of a take are always among them.
    """
    moved = np.zeros(len(states))
    for n in range(1, len(states), AT_ONCE):
        some = states.places[n - 1 : n + AT_ONCE]
        moved[n : n + AT_ONCE] = np.linalg.norm(np.diff(some, axis=0), axis=-1).max(-1)
    moved[states.starts[:-1]] = 0.0
    way = np.cumsum(moved)
    low, high = 0.0, max(float(way[-1]), 1e-9)
    fixed = np.zeros(len(states), bool)
    fixed[states.starts[:-1]] = True
    fixed[states.starts[1:] - 1] = True
    fixed[np.asarray(changes, int)] = True
    if share >= 1:
        return np.arange(len(states))
    for _ in range(40):  # how far a joint moves from one keyframe to the next
        step = (low + high) / 2
        keys = fixed | _keyframes(way, step)
        low, high = (step, high) if keys.mean() > share else (low, step)
    return np.flatnonzero(fixed | _keyframes(way, high))


def _keyframes(way: Array, step: float) -> Array:
    number = np.floor(way / step)
    return np.concatenate([[False], number[1:] > number[:-1]])
