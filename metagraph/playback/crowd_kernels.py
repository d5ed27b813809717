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
        return numba.njit(cache=True, nogil=True, fastmath=_FAST)(function)
    except RuntimeError:  # no folder to cache in
        return numba.njit(nogil=True, fastmath=_FAST)(function)


@_compiled
def _ease(x: float) -> float:
    x = min(max(x, 0.0), 1.0)
    return x * x * (3 - 2 * x)


@_compiled
def _sample(clip: Any, rotations: Array, translations: Array, moved: Array, n: int, seconds: float, out_r: Array, out_t: Array) -> None:
    """Write a clip's offsets at clip seconds into `out_r [>=n, 4]`, `out_t [>=n, 3]`."""
    frames = clip.frames
    at = min(max(seconds * clip.fps, 0.0), frames - 1.0)
    low = min(int(at), max(0, frames - 2))
    high = min(low + 1, frames - 1)
    w = np.float32(at - low)
    v = np.float32(1) - w
    a, b = clip.rotations + low * n * 4, clip.rotations + high * n * 4
    for i in range(n):
        k = i * 4
        x = rotations[a + k] * v + rotations[b + k] * w
        y = rotations[a + k + 1] * v + rotations[b + k + 1] * w
        z = rotations[a + k + 2] * v + rotations[b + k + 2] * w
        s = rotations[a + k + 3] * v + rotations[b + k + 3] * w
        scale = np.float32(1) / np.sqrt(x * x + y * y + z * z + s * s)
        out_r[i, 0], out_r[i, 1], out_r[i, 2], out_r[i, 3] = x * scale, y * scale, z * scale, s * scale
        out_t[i, 0], out_t[i, 1], out_t[i, 2] = np.float32(0), np.float32(0), np.float32(0)
    m = clip.moves
    a, b = clip.translations + low * m * 3, clip.translations + high * m * 3
    for i in range(m):
        j, k = moved[clip.moved + i], i * 3
        for axis in range(3):
            out_t[j, axis] = translations[a + k + axis] * v + translations[b + k + axis] * w


@_compiled
def _mix(n: int, r: Array, t: Array, other_r: Array, other_t: Array, weight: float) -> None:
    """Crossfade `r`, `t` in place towards the other sample."""
    w = np.float32(weight)
    v = np.float32(1) - w
    for i in range(n):
        dot = r[i, 0] * other_r[i, 0] + r[i, 1] * other_r[i, 1] + r[i, 2] * other_r[i, 2] + r[i, 3] * other_r[i, 3]
        u = -w if dot < 0 else w
        length = np.float32(0)
        for k in range(4):
            r[i, k] = r[i, k] * v + other_r[i, k] * u
            length += r[i, k] * r[i, k]
        scale = np.float32(1) / np.sqrt(max(length, np.float32(1e-20)))
        for k in range(4):
            r[i, k] *= scale
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
    w = np.float32(weight)
    for i in range(n):
        ax, ay, az, aw = -edge_r[i, 0], -edge_r[i, 1], -edge_r[i, 2], edge_r[i, 3]
        bx, by, bz, bw = stance_r[i, 0], stance_r[i, 1], stance_r[i, 2], stance_r[i, 3]
        u = -w if aw * bw - ax * bx - ay * by - az * bz < 0 else w
        x = (aw * bx + ax * bw + ay * bz - az * by) * u
        y = (aw * by - ax * bz + ay * bw + az * bx) * u
        z = (aw * bz + ax * by - ay * bx + az * bw) * u
        s = (aw * bw - ax * bx - ay * by - az * bz) * u + (np.float32(1) - w)
        scale = np.float32(1) / np.sqrt(max(x * x + y * y + z * z + s * s, np.float32(1e-20)))
        _append(r, i, x * scale, y * scale, z * scale, s * scale)
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
        out_r[c], out_t[c] = base_r, base_t
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
                current = max(_before(rest_starts, rest_at[row], rest_at[row + 1], time), rest_at[row])
                rest = rests[current]
                if current > rest_at[row] and time < rest.fade_start + rest.fade:
                    _rest(rests[current - 1], clips, rotations, translations, moved, n, time, s_r, s_t, o_r, o_t)
                    _rest(rest, clips, rotations, translations, moved, n, time, p_r, p_t, o_r, o_t)
                    _mix(n, s_r, s_t, p_r, p_t, _ease((time - rest.fade_start) / rest.fade))
                else:
                    _rest(rest, clips, rotations, translations, moved, n, time, s_r, s_t, o_r, o_t)
                if not playing:
                    r[:n], t[:n] = s_r[:n], s_t[:n]
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
                            r[i], t[i] = s_r[i], s_t[i]
            if weighed[layer]:
                _weigh(n, r, t, weights[a : a + n])
            for i in range(n):
                j = reach[a + i]
                _append(out_r[c], j, r[i, 0], r[i, 1], r[i, 2], r[i, 3])
                for k in range(3):
                    out_t[c, j, k] += t[i, k]
        for j in range(joints):
            length = np.float32(0)
            for k in range(4):
                length += out_r[c, j, k] * out_r[c, j, k]
            scale = np.float32(1) / np.sqrt(length)
            for k in range(4):
                out_r[c, j, k] *= scale


@_compiled
def to_globals(first: int, last: int, parents: Array, local_r: Array, local_t: Array, out_r: Array, out_p: Array) -> None:
    """Write model-space rotations `[C, J, 4]` and positions `[C, J, 3]` of characters `first`..`last`."""
    for c in range(first, last):
        for j in range(len(parents)):
            p = parents[j]
            for k in range(4):
                out_r[c, j, k] = local_r[c, j, k] if p < 0 else out_r[c, p, k]
            vx, vy, vz = local_t[c, j, 0], local_t[c, j, 1], local_t[c, j, 2]
            if p < 0:
                out_p[c, j, 0], out_p[c, j, 1], out_p[c, j, 2] = vx, vy, vz
                continue
            x, y, z, w = out_r[c, p, 0], out_r[c, p, 1], out_r[c, p, 2], out_r[c, p, 3]
            tx, ty, tz = 2 * (y * vz - z * vy), 2 * (z * vx - x * vz), 2 * (x * vy - y * vx)
            out_p[c, j, 0] = out_p[c, p, 0] + vx + w * tx + y * tz - z * ty
            out_p[c, j, 1] = out_p[c, p, 1] + vy + w * ty + z * tx - x * tz
            out_p[c, j, 2] = out_p[c, p, 2] + vz + w * tz + x * ty - y * tx
            _append(out_r[c], j, local_r[c, j, 0], local_r[c, j, 1], local_r[c, j, 2], local_r[c, j, 3])
