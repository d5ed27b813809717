"""Compiled loops that evaluate keys of glTF channels at the frames of clips, of many takes at once: what
`gltf_sampling` and `rotation` have, to 1e-7. Importing this imports numba (half a second).

numbers: a file's first buffer as float32. Of channels: starts, where each one's keys begin among them, and
joints. Of groups that share key times: channel_ends, takes, times, one group's after another's, and
time_ends. Of takes: at, the seconds of their frames, one's after another's, frame_ends, and near, seconds
that a key may be off a frame and still be at it.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from metagraph.compiling import compiler

Array = Any
KEPT, SOURCES = ("turn", "finish", "loose", "move"), ()

_exact = compiler(nogil=True, error_model="numpy")
_inside = compiler(keep=False, nogil=True, error_model="numpy")


@_inside
def _holds(times: Array, at: Array, near: float) -> bool:
    """Whether key times are those of the frames."""
    if len(times) != len(at):
        return False
    far = 0
    for k in range(len(times)):
        far += not abs(times[k] - at[k]) < near
    return far == 0


@_inside
def _locate(times: Array, at: Array, near: float, low: Array, part: Array) -> None:
    """Write the key before each frame, but for the last one, and how much of the way to the next has gone."""
    come = 0
    for f in range(len(at)):
        while come < len(times) and times[come] <= at[f] + near:
            come += 1
        k = min(max(come - 1, 0), len(times) - 2)
        gap = times[k + 1] - times[k]
        low[f] = k
        part[f] = min(max((at[f] - times[k]) / (gap if gap > 1e-9 else 1.0), 0.0), 1.0)


@_inside
def _same(numbers: Array, start: int, count: int) -> bool:
    """Whether a channel's keys, of four numbers each, are all the same."""
    others = 0
    for n in range(start + 4, start + 4 * count):
        others += numbers[n] != numbers[n - 4]
    return others == 0


@_exact
def turn(
    numbers: Array,
    starts: Array,
    joints: Array,
    channel_ends: Array,
    takes: Array,
    times: Array,
    time_ends: Array,
    at: Array,
    frame_ends: Array,
    near: Array,
    out: Array,
) -> None:
    """Write rotations to out `[F, J, 4]`, as they lie between keys; they are not normalised."""
    low, part = np.empty(len(at), np.int64), np.empty(len(at))
    first = 0
    for g in range(len(takes)):
        t = takes[g]
        begin = frame_ends[t - 1] if t else 0
        frames = frame_ends[t] - begin
        own = at[begin : frame_ends[t]]
        keys = times[(time_ends[g - 1] if g else 0) : time_ends[g]]
        after = channel_ends[g]
        still = True
        for c in range(first, after):
            still = still and _same(numbers, starts[c], len(keys))
        held = not still and _holds(keys, own, near[t])
        if not still and not held:
            _locate(keys, own, near[t], low, part)
        for c in range(first, after):
            start, j = starts[c], joints[c]
            for f in range(frames):
                if still or held:
                    n = start + (4 * f if held else 0)
                    for i in range(4):
                        out[begin + f, j, i] = numbers[n + i]
                    continue
                n, u = start + 4 * low[f], part[f]
                dot = 0.0
                for i in range(4):
                    dot += np.float64(numbers[n + i]) * np.float64(numbers[n + 4 + i])
                angle = math.acos(min(abs(dot), 1.0))
                sine = math.sin(angle)
                one, other = 1.0 - u, u
                if not sine < 1e-3:
                    one, other = math.sin(one * angle) / sine, math.sin(u * angle) / sine
                if dot < 0:
                    other = -other
                for i in range(4):
                    out[begin + f, j, i] = numbers[n + i] * one + numbers[n + 4 + i] * other
        first = after


@_exact
def finish(out: Array, frame_ends: Array, turned: Array, turns: Array) -> int:
    """Make rotations `[F, J, 4]` of several takes unit quaternions, neighbours on the same side. turned,
    turns `[N, 4]`: joints that are turned, and by what. Returns the place of the first that holds what is no
    number, as frame * J + joint, at which it stops; -1 for none.
    """
    joints = out.shape[1]
    odd = np.zeros(joints, np.bool_)
    raw = np.zeros((joints, 4), np.float32)
    begin, tiny, none = 0, np.float32(1e-12), np.float32(0)
    for t in range(len(frame_ends)):
        for f in range(begin, frame_ends[t]):
            for n in range(len(turned)):
                j = turned[n]
                ax, ay, az, aw = turns[n, 0], turns[n, 1], turns[n, 2], turns[n, 3]
                bx, by, bz, bw = out[f, j, 0], out[f, j, 1], out[f, j, 2], out[f, j, 3]
                out[f, j, 0] = aw * bx + ax * bw + ay * bz - az * by
                out[f, j, 1] = aw * by - ax * bz + ay * bw + az * bx
                out[f, j, 2] = aw * bz + ax * by - ay * bx + az * bw
                out[f, j, 3] = aw * bw - ax * bx - ay * by - az * bz
            for j in range(joints):
                x, y, z, w = out[f, j, 0], out[f, j, 1], out[f, j, 2], out[f, j, 3]
                if not (math.isfinite(x) and math.isfinite(y) and math.isfinite(z) and math.isfinite(w)):
                    return int(f * joints + j)
                length = np.float32(math.sqrt((x * x + y * y) + (z * z + w * w)))
                if length > tiny:
                    x, y, z, w = x / length, y / length, z / length, w / length
                else:
                    x, y, z, w = none, none, none, np.float32(1)
                if f == begin:
                    odd[j] = False
                else:
                    dot = (x * raw[j, 0] + y * raw[j, 1]) + (z * raw[j, 2] + w * raw[j, 3])
                    if dot < 0:
                        odd[j] = not odd[j]
                raw[j, 0], raw[j, 1], raw[j, 2], raw[j, 3] = x, y, z, w
                if odd[j]:
                    x, y, z, w = -x, -y, -z, -w
                out[f, j, 0], out[f, j, 1], out[f, j, 2], out[f, j, 3] = x, y, z, w
        begin = frame_ends[t]
    return -1


@_exact
def loose(
    numbers: Array, starts: Array, joints: Array, counts: Array, lift: Array, shift: Array, rest: Array,
    most: Array, out: Array,
) -> None:  # fmt: skip
    """Write of channels of three numbers whether any of their keys, lifted and shifted, is farther than
    `most [J]` from `rest [J, 3]`. counts: their keys. lift `[J, 3, 3]`, shift `[J, 3]`: of joints.
    """
    place = np.empty(3)
    for c in range(len(starts)):
        j, far = joints[c], 0.0
        for k in range(counts[c]):
            _lifted(numbers, starts[c] + 3 * k, lift[j], shift[j], place)
            for i in range(3):
                away = abs(place[i] - rest[j, i])
                if away > far or away != away:
                    far = away
            if far != far:
                break  # what is no number is never far
        out[c] = far > most[j]


@_inside
def _lifted(numbers: Array, n: int, lift: Array, shift: Array, out: Array) -> None:
    x, y, z = np.float64(numbers[n]), np.float64(numbers[n + 1]), np.float64(numbers[n + 2])
    for i in range(3):
        # Of axes that are not mixed nothing is added up: what is endless stays so, and is refused.
        total = 0.0
        if lift[i, 0] != 0:
            total += lift[i, 0] * x
        if lift[i, 1] != 0:
            total += lift[i, 1] * y
        if lift[i, 2] != 0:
            total += lift[i, 2] * z
        out[i] = total + shift[i]


@_exact
def move(
    numbers: Array,
    starts: Array,
    joints: Array,
    channel_ends: Array,
    takes: Array,
    times: Array,
    time_ends: Array,
    at: Array,
    frame_ends: Array,
    near: Array,
    lift: Array,
    shift: Array,
    out: Array,
) -> None:
    """Write places to out `[N, 3]`, the frames of one channel after those of another, as they lie between
    keys, lifted and shifted as `loose` has them.
    """
    low, part = np.empty(len(at), np.int64), np.empty(len(at))
    before, after = np.empty(3), np.empty(3)
    first = row = 0
    for g in range(len(takes)):
        t = takes[g]
        begin = frame_ends[t - 1] if t else 0
        frames = frame_ends[t] - begin
        own = at[begin : frame_ends[t]]
        keys = times[(time_ends[g - 1] if g else 0) : time_ends[g]]
        still, held = len(keys) == 1, _holds(keys, own, near[t])
        if not still and not held:
            _locate(keys, own, near[t], low, part)
        for c in range(first, channel_ends[g]):
            start, j = starts[c], joints[c]
            for f in range(frames):
                if still or held:
                    _lifted(numbers, start + (0 if still else 3 * f), lift[j], shift[j], out[row])
                else:
                    n, u = start + 3 * low[f], part[f]
                    _lifted(numbers, n, lift[j], shift[j], before)
                    _lifted(numbers, n + 3, lift[j], shift[j], after)
                    for i in range(3):
                        out[row, i] = before[i] + (after[i] - before[i]) * u
                row += 1
        first = channel_ends[g]


def warm() -> None:
    """Have ready what files are read with."""
    numbers, whole, few = np.frombuffer(b"", np.float32), np.zeros(0, np.int64), np.zeros(0)
    at = few, whole, few
    groups = whole, whole, whole, whole, few, whole
    turns = np.zeros((0, 1, 4), np.float32)
    turn(numbers, *groups, *at, turns)
    finish(turns, whole, whole, turns[:, 0].copy())
    lift, shift = np.zeros((0, 3, 3)), np.zeros((0, 3))
    loose(numbers, whole, whole, whole, lift, shift, shift, few, np.zeros(0, np.bool_))
    move(numbers, *groups, *at, lift, shift, np.zeros((0, 3)))
