"""Compiled loops of the crowd: the player's rules (player.py), one character after another. Importing this imports numba.

Every function mirrors one of the player's; tests hold the two together.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numba
import numpy as np

Array = Any
_FAST = {"contract", "arcp", "nsz"}


def _compiled(function: Callable[..., Any]) -> Any:
    try:
        return numba.njit(cache=True, nogil=True, fastmath=_FAST, error_model="numpy")(function)
    except RuntimeError:  # no folder to cache in
        return numba.njit(nogil=True, fastmath=_FAST, error_model="numpy")(function)


@_compiled
def _ease(x: float) -> float:
    x = min(max(x, 0.0), 1.0)
    return x * x * (3 - 2 * x)


@_compiled
def _sample(clip: Any, rotations: Array, translations: Array, moved: Array, n: int, seconds: float, out_r: Array, out_t: Array) -> None:
    """Write a clip's offsets at clip seconds into `out_r [>=n, 4]`, `out_t [>=n, 3]`; rotations are not yet of unit length."""
    frames = clip.frames
    at = min(max(seconds * clip.fps, 0.0), frames - 1.0)
    low = min(int(at), max(0, frames - 2))
    high = min(low + 1, frames - 1)
    w = np.float32(at - low)
    v = np.float32(1) - w
    a = rotations[clip.rotations + low * n * 4 : clip.rotations + (low + 1) * n * 4]
    b = rotations[clip.rotations + high * n * 4 : clip.rotations + (high + 1) * n * 4]
    flat = out_r.reshape(-1)
    for i in range(len(a)):
        flat[i] = a[i] * v + b[i] * w
    out_t[:n] = 0
    m = clip.moves
    c, d = clip.translations + low * m * 3, clip.translations + high * m * 3
    for i in range(m):
        j, k = moved[clip.moved + i], i * 3
        for axis in range(3):
            out_t[j, axis] = translations[c + k + axis] * v + translations[d + k + axis] * w


@_compiled
def _normalize(n: int, r: Array) -> None:
    """Scale to unit length: before a blend, where lengths count, and at the end; products do not mind."""
    for i in range(n):
        x, y, z, s = r[i, 0], r[i, 1], r[i, 2], r[i, 3]
        scale = np.float32(1) / np.sqrt(max(x * x + y * y + z * z + s * s, np.float32(1e-20)))
        r[i, 0], r[i, 1], r[i, 2], r[i, 3] = x * scale, y * scale, z * scale, s * scale


@_compiled
def _mix(n: int, r: Array, t: Array, other_r: Array, other_t: Array, weight: float) -> None:
    """Crossfade `r`, `t` in place towards the other sample."""
    _normalize(n, r)
    _normalize(n, other_r)
    w = np.float32(weight)
    v = np.float32(1) - w
    for i in range(n):
        dot = r[i, 0] * other_r[i, 0] + r[i, 1] * other_r[i, 1] + r[i, 2] * other_r[i, 2] + r[i, 3] * other_r[i, 3]
        u = -w if dot < 0 else w
        for k in range(4):
            r[i, k] = r[i, k] * v + other_r[i, k] * u
        for k in range(3):
            t[i, k] = t[i, k] * v + other_t[i, k] * w


@_compiled
def _rest(
    rest: Any,
    clips: Array,
    rotations: Array,
    translations: Array,
    moved: Array,
    n: int,
    time: float,
    r: Array,
    t: Array,
    o_r: Array,
    o_t: Array,
) -> None:
    """Write a stance loop's offsets at a time into `r`, `t`; `o_r`, `o_t` are scratch."""
    if rest.clip < 0:
        for i in range(n):
            r[i, 0], r[i, 1], r[i, 2], r[i, 3] = np.float32(0), np.float32(0), np.float32(0), np.float32(1)
            t[i, 0], t[i, 1], t[i, 2] = np.float32(0), np.float32(0), np.float32(0)
        return
    clip = clips[rest.clip]
    elapsed = time - rest.start
    if rest.period <= 0:
        _sample(clip, rotations, translations, moved, n, rest.first, r, t)
        return
    if rest.seam > 0 and elapsed < 0:
        elapsed = 0.0
    phase = elapsed % rest.period
    _sample(clip, rotations, translations, moved, n, rest.first + phase, r, t)
    if rest.seam > 0 and elapsed >= rest.period and phase < rest.seam:
        _sample(clip, rotations, translations, moved, n, rest.first + min(rest.period + phase, rest.length), o_r, o_t)
        _mix(n, r, t, o_r, o_t, 1 - _ease(phase / rest.seam))


@_compiled
def _lead(n: int, r: Array, t: Array, stance_r: Array, stance_t: Array, edge_r: Array, edge_t: Array, weight: float) -> None:
    """Add to `r`, `t` in place `weight` of what the stance differs from the clip's edge."""
    _normalize(n, stance_r)
    _normalize(n, edge_r)
    w = np.float32(weight)
    for i in range(n):
        ax, ay, az, aw = -edge_r[i, 0], -edge_r[i, 1], -edge_r[i, 2], edge_r[i, 3]
        bx, by, bz, bw = stance_r[i, 0], stance_r[i, 1], stance_r[i, 2], stance_r[i, 3]
        u = -w if aw * bw - ax * bx - ay * by - az * bz < 0 else w
        x = (aw * bx + ax * bw + ay * bz - az * by) * u
        y = (aw * by - ax * bz + ay * bw + az * bx) * u
        z = (aw * bz + ax * by - ay * bx + az * bw) * u
        s = (aw * bw - ax * bx - ay * by - az * bz) * u + (np.float32(1) - w)
        _append(r, i, x, y, z, s)
        for k in range(3):
            t[i, k] += (stance_t[i, k] - edge_t[i, k]) * w


@_compiled
def _append(r: Array, i: int, x: float, y: float, z: float, s: float) -> None:
    """Multiply rotation `i` of `r [n, 4]` from the right."""
    a, b, c, d = r[i, 0], r[i, 1], r[i, 2], r[i, 3]
    r[i, 0] = d * x + a * s + b * z - c * y
    r[i, 1] = d * y - a * z + b * s + c * x
    r[i, 2] = d * z + a * y - b * x + c * s
    r[i, 3] = d * s - a * x - b * y - c * z


@_compiled
def _weigh(n: int, r: Array, t: Array, weights: Array) -> None:
    """Take each offset `weights [n]` times, in place."""
    for i in range(n):
        w, x, y, z, s = weights[i], r[i, 0], r[i, 1], r[i, 2], r[i, 3]
        if s < 0:
            x, y, z, s = -x, -y, -z, -s
        sine = np.sqrt(x * x + y * y + z * z)
        half = np.arctan2(sine, s) * w
        factor = np.sin(half) / sine if sine > 1e-8 else w
        r[i, 0], r[i, 1], r[i, 2], r[i, 3] = x * factor, y * factor, z * factor, np.cos(half)
        for k in range(3):
            t[i, k] *= w


@_compiled
def _before(starts: Array, low: int, high: int, time: float) -> int:
    """Return the last place in low..high whose start is not after `time`; low - 1 when there is none."""
    while low < high:
        middle = (low + high) // 2
        if starts[middle] <= time:
            low = middle + 1
        else:
            high = middle
    return low - 1


@_compiled
def evaluate(
    first: int,
    last: int,
    seconds: Array,
    plan_of: Array,
    rests: Array,
    rest_starts: Array,
    rest_at: Array,
    cues: Array,
    cue_starts: Array,
    cue_at: Array,
    clips: Array,
    rotations: Array,
    translations: Array,
    moved: Array,
    masks: Array,
    reach: Array,
    reach_at: Array,
    weights: Array,
    weighed: Array,
    base_r: Array,
    base_t: Array,
    out_r: Array,
    out_t: Array,
) -> None:
    """Write the poses of characters `first`..`last` into `out_r [C, J, 4]`, `out_t [C, J, 3]`."""
    joints = len(base_r)
    r, t = np.empty((joints, 4), np.float32), np.empty((joints, 3), np.float32)
    s_r, s_t = np.empty((joints, 4), np.float32), np.empty((joints, 3), np.float32)
    o_r, o_t = np.empty((joints, 4), np.float32), np.empty((joints, 3), np.float32)
    p_r, p_t = np.empty((joints, 4), np.float32), np.empty((joints, 3), np.float32)
    for c in range(first, last):
        time = seconds[c]
        pose_r, pose_t = out_r[c], out_t[c]
        pose_r[:], pose_t[:] = base_r, base_t
        for layer in range(3):
            row = plan_of[c] * 3 + layer
            if rest_at[row] == rest_at[row + 1]:
                continue
            a = reach_at[layer]
            n = reach_at[layer + 1] - a
            place = _before(cue_starts, cue_at[row], cue_at[row + 1], time)
            playing = place >= cue_at[row] and time < cues[place].end and cues[place].clip >= 0
            rising = falling = masked = False
            if playing:
                cue = cues[place]
                rising, falling = time < cue.start + cue.blend_in, time >= cue.end - cue.blend_out
                masked = cue.mask >= 0
                _sample(clips[cue.clip], rotations, translations, moved, n, cue.entry + time - cue.start, r, t)
            if not playing or rising or falling or masked:
                under_r, under_t = (s_r, s_t) if playing else (r, t)
                current = max(_before(rest_starts, rest_at[row], rest_at[row + 1], time), rest_at[row])
                rest = rests[current]
                if current > rest_at[row] and time < rest.fade_start + rest.fade:
                    _rest(rests[current - 1], clips, rotations, translations, moved, n, time, under_r, under_t, o_r, o_t)
                    _rest(rest, clips, rotations, translations, moved, n, time, p_r, p_t, o_r, o_t)
                    _mix(n, under_r, under_t, p_r, p_t, _ease((time - rest.fade_start) / rest.fade))
                else:
                    _rest(rest, clips, rotations, translations, moved, n, time, under_r, under_t, o_r, o_t)
            if playing:
                cue = cues[place]
                if rising or falling:
                    edge = cue.entry if rising else cue.entry + cue.end - cue.start
                    _sample(clips[cue.clip], rotations, translations, moved, n, edge, o_r, o_t)
                    up = _ease((time - cue.start) / cue.blend_in) if cue.blend_in > 0 else 1.0
                    down = _ease((cue.end - time) / cue.blend_out) if cue.blend_out > 0 else 1.0
                    _lead(n, r, t, s_r, s_t, o_r, o_t, 1 - up * down)
                if masked:
                    for i in range(n):
                        if masks[cue.mask, reach[a + i]] == 0:
                            for k in range(4):
                                r[i, k] = s_r[i, k]
                            for k in range(3):
                                t[i, k] = s_t[i, k]
            if weighed[layer]:
                _normalize(n, r)
                _weigh(n, r, t, weights[a : a + n])
            for i in range(n):
                j = reach[a + i]
                _append(pose_r, j, r[i, 0], r[i, 1], r[i, 2], r[i, 3])
                for k in range(3):
                    pose_t[j, k] += t[i, k]
        _normalize(joints, pose_r)


@_compiled
def to_globals(first: int, last: int, parents: Array, local_r: Array, local_t: Array, out_r: Array, out_p: Array) -> None:
    """Write model-space rotations `[C, J, 4]` and positions `[C, J, 3]` of characters `first`..`last`."""
    for c in range(first, last):
        q, v, r, o = local_r[c], local_t[c], out_r[c], out_p[c]
        for j in range(len(parents)):
            p = parents[j]
            vx, vy, vz = v[j, 0], v[j, 1], v[j, 2]
            if p < 0:
                r[j, 0], r[j, 1], r[j, 2], r[j, 3] = q[j, 0], q[j, 1], q[j, 2], q[j, 3]
                o[j, 0], o[j, 1], o[j, 2] = vx, vy, vz
                continue
            x, y, z, w = r[p, 0], r[p, 1], r[p, 2], r[p, 3]
            tx, ty, tz = 2 * (y * vz - z * vy), 2 * (z * vx - x * vz), 2 * (x * vy - y * vx)
            o[j, 0] = o[p, 0] + vx + w * tx + y * tz - z * ty
            o[j, 1] = o[p, 1] + vy + w * ty + z * tx - x * tz
            o[j, 2] = o[p, 2] + vz + w * tz + x * ty - y * tx
            r[j, 0], r[j, 1], r[j, 2], r[j, 3] = x, y, z, w
            _append(r, j, q[j, 0], q[j, 1], q[j, 2], q[j, 3])
