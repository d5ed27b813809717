"""Evaluate keys of glTF channels at the frames of a clip."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.motion import rotation

Array = NDArray[Any]


@dataclass(frozen=True, eq=False)
class FrameGrid:
    """The times of a clip's frames, `[F]` seconds in the file, and their number a second."""

    times: Array
    fps: float

    @property
    def near(self) -> float:
        """Return how many seconds a key may be away from a frame and still be on it."""
        return 1e-3 / self.fps

    def holds(self, times: Array) -> bool:
        """Return whether key times are those of the frames."""
        return len(times) == len(self.times) and bool(np.abs(times - self.times).max() < self.near)


def sample_channels(times: Array, values: Array, grid: FrameGrid, mode: str, turning: bool) -> Array:
    """Evaluate channels with common key times at the grid: `[C, K, n]` (3 K for splines) -> `[C, F, n]`."""
    at, count = grid.times, len(times)
    spline = mode == "CUBICSPLINE"
    keys = values[:, 1::3] if spline else values
    if count == 1 or (not spline and (keys == keys[:, :1]).all()):
        return np.broadcast_to(keys[:, :1], (len(keys), len(at), keys.shape[-1]))
    if not spline and grid.holds(times):
        return keys
    low = np.clip(np.searchsorted(times, at + grid.near, "right") - 1, 0, count - 1)
    if mode == "STEP":
        return keys[:, low]
    low = np.minimum(low, count - 2)
    gap = times[low + 1] - times[low]
    part = np.clip((at - times[low]) / np.where(gap > 1e-9, gap, 1), 0, 1)
    a, b = keys[:, low], keys[:, low + 1]
    u = part[None, :, None]
    if spline:
        gap, u2, u3 = gap[None, :, None], u * u, u * u * u
        leave, arrive = values[:, 2::3][:, low], values[:, 0::3][:, low + 1]
        out = (
            (2 * u3 - 3 * u2 + 1) * a
            + gap * (u3 - 2 * u2 + u) * leave
            + (3 * u2 - 2 * u3) * b
            + gap * (u3 - u2) * arrive
        )
        return np.asarray(rotation.normalize(out) if turning else out)
    if not turning:
        return np.asarray(a + (b - a) * u)
    return slerp_exact(a, b, u)


def slerp_exact(a: Array, b: Array, u: Array) -> Array:
    """Return the rotations `u [..., 1]` of the way from a to b `[..., 4]`. Keys may be far apart after a tool
    has thinned them.
    """
    dot = np.einsum("...i,...i->...", a, b, dtype=np.float64)[..., None]
    b = np.where(dot < 0, -b, b)
    angle = np.arccos(np.clip(np.abs(dot), 0, 1))
    sine = np.sin(angle)
    close = sine < 1e-3
    sine = np.where(close, 1, sine)
    return np.asarray(
        a * np.where(close, 1 - u, np.sin((1 - u) * angle) / sine)
        + b * np.where(close, u, np.sin(u * angle) / sine)
    )


@dataclass(frozen=True, eq=False)
class KeyTable:
    """Keys of many channels: a rig has dozens of groups that share key times, a file dozens of takes.

    `numbers` is the buffer with the keys, `width` numbers each. `times` and `takes` `[G]` are those of each
    group. `groups`, `joints`, `starts` `[C]` are each channel's group (ascending), its joint, and where its
    keys begin.
    """

    numbers: Array
    width: int
    times: Sequence[Array]
    takes: Array
    groups: Array
    joints: Array
    starts: Array

    @cached_property
    def counts(self) -> Array:
        """Return the number of keys of each channel, `[C]`."""
        return np.array([len(times) for times in self.times])[self.groups]

    @cached_property
    def values(self) -> Array:
        """Return the keys, one channel after another, `[N, width]`."""
        shape = (len(self.numbers) - self.width + 1, self.width)
        steps = self.numbers.strides * 2
        rows = np.lib.stride_tricks.as_strided(self.numbers, shape, steps, writeable=False)
        return np.asarray(rows[self.along(self.starts - self.width * self.begins) + self._places])

    @cached_property
    def _places(self) -> Array:
        return self.width * np.arange(int(self.counts.sum()))

    def only(self, which: Array) -> KeyTable | None:
        """Return some of the channels `[C]`; None if there are none."""
        if which.all():
            return self
        if not which.any():
            return None
        kept, groups = np.unique(self.groups[which], return_inverse=True)
        times = [self.times[group] for group in kept]
        some = self.takes[kept], groups, self.joints[which], self.starts[which]
        return KeyTable(self.numbers, self.width, times, *some)

    @cached_property
    def begins(self) -> Array:
        """Return where each channel's keys begin, `[C]`."""
        return np.asarray(np.cumsum(self.counts) - self.counts)

    def along(self, of_channels: Array) -> Array:
        """Return for each key `[N, ...]` the value of its channel `[C, ...]`."""
        return np.repeat(of_channels, self.counts, axis=0)

    def most(self, of_keys: Array) -> Array:
        """Return `[C]` the maximum over each channel's keys `[N, n]`."""
        return np.asarray(np.maximum.reduceat(of_keys.max(-1), self.begins))

    def where(self, which: Any) -> tuple[list[int], list[int]]:
        """Return the takes and joints of some channels."""
        return self.takes[self.groups[which]].tolist(), self.joints[which].tolist()

    def some(self, group: int) -> tuple[slice, slice]:
        """Return which channels, and which keys, belong to a group."""
        first, after = np.searchsorted(self.groups, (group, group + 1)).tolist()
        begin = int(self.begins[first])
        return slice(first, after), slice(begin, begin + len(self.times[group]) * (after - first))


def sample_turns(keys: KeyTable, grids: Sequence[FrameGrid], begins: Array, out: Array) -> None:
    """Write rotations to `out` `[F, J, 4]`, evaluating linear keys as `sample_channels` does, for several
    takes at once. `grids` are those of the takes, and `begins` their first frames in `out`.
    """
    frames = np.array([len(grid.times) for grid in grids])
    take = keys.takes[keys.groups]
    first = keys.values[keys.begins]
    same = np.logical_and.reduceat((keys.values == keys.along(first)).all(1), keys.begins)
    at = np.searchsorted(keys.groups, np.arange(len(keys.times)))
    still = np.logical_and.reduceat(same, at)[keys.groups]
    holds = [grids[t].holds(times) for t, times in zip(keys.takes, keys.times, strict=True)]
    held = np.array(holds)[keys.groups] & ~still
    if still.any():
        long = frames[take[still]]
        rows = _counted(begins[take[still]], long)
        out[rows, np.repeat(keys.joints[still], long)] = np.repeat(first[still], long, axis=0)
    if held.any():
        rows = _counted(begins[take[held]], keys.counts[held])
        out[rows, np.repeat(keys.joints[held], keys.counts[held])] = keys.values[keys.along(held)]
    between = ~(still | held)
    for number in np.unique(take[between]).tolist():
        some = between & (take == number)
        used, group = np.unique(keys.groups[some], return_inverse=True)
        low, part = _places([keys.times[g] for g in used], grids[number])
        place = keys.begins[some][:, None] + low[group]
        turns = slerp_exact(keys.values[place], keys.values[place + 1], part[group][..., None])
        own = out[begins[number] : begins[number] + frames[number]]
        own[:, keys.joints[some]] = turns.transpose(1, 0, 2)


def _counted(begins: Array, counts: Array) -> Array:
    """Return begin, begin + 1 ... for each, `counts` numbers, one after another."""
    ends = np.cumsum(counts)
    return np.asarray(np.repeat(begins - (ends - counts), counts) + np.arange(ends[-1]))


def _places(keys: Sequence[Array], grid: FrameGrid) -> tuple[Array, Array]:
    """Return `[G, F]`, for several arrays of two or more key times, the key before each frame (never the last
    key), and the share of the way to the next.
    """
    counts = np.array([len(times) for times in keys])
    times = np.concatenate(keys)
    begins = (np.cumsum(counts) - counts)[:, None]
    every, which = np.unique(times, return_inverse=True)
    come = np.bincount(
        np.repeat(np.arange(len(keys)), counts) * len(every) + which.reshape(-1),
        minlength=len(keys) * len(every),
    )
    come = np.pad(np.cumsum(come.reshape(len(keys), -1), 1), ((0, 0), (1, 0)))
    low = come[:, np.searchsorted(every, grid.times + grid.near, "right")] - 1
    low = np.minimum(np.maximum(low, 0), counts[:, None] - 2)
    gap = times[begins + low + 1] - times[begins + low]
    part = np.clip((grid.times - times[begins + low]) / np.where(gap > 1e-9, gap, 1), 0, 1)
    return low, part
