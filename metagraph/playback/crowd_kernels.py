"""Compiled loops of the crowd: the player's rules (player.py), one character after another. Importing this
imports numba.

Rotations lie in blocks of 16 joints, `[x 16, y 16, z 16, w 16]`, so that each step below is a loop of fixed
length over neighbours in memory, which compiles to vector instructions. Lengths of quaternions are mended
only before a blend, where they count, and at the end; products do not mind.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from metagraph.compiling import compiler
from metagraph.motion import four_kernels
from metagraph.motion.four_kernels import FOUR, ROW
from metagraph.playback import laying
from metagraph.playback.laying import CLIP, CUE, LANES, REST

KEPT, SOURCES = ("pose",), (four_kernels, laying)

Array = Any
Number = Any  # float32 throughout, except for times
# A sample's two rows of a table, and how far it is from the first to the second; a loop, the other side of
# its seam, and how much of that shows: -1 without a clip.
Spot = tuple[int, int, Number]
Loop = tuple[Spot, Spot, Number]

AT_ONCE = 128  # characters: their blocks stay in a processor's cache
# Rows of a layer's `lanes [3 + K, b, 16]` and `mover_lanes [3 + K, m]`: which joints turn farther, and which
# less far, where a cue is larger or smaller than made; the layer's weights on them; and K masks, how far
# an action moves a joint from its stance, 0..1.
WIDER, NARROWER, WEIGHT, WEIGHED, MASKS = range(5)

_OPTIONS: dict[str, Any] = {
    "nogil": True, "fastmath": {"contract", "arcp", "nsz"}, "error_model": "numpy"
}  # fmt: skip
_compiled = compiler(**_OPTIONS)


# --- blocks `[64]` float32


@_compiled
def _lerp(a: Array, b: Array, w: Number, out: Array) -> None:
    v = np.float32(1) - w
    for i in range(4 * LANES):
        out[i] = a[i] * v + b[i] * w


@_compiled
def _unit(q: Array) -> None:
    for i in range(LANES):
        x, y, z, w = q[i], q[LANES + i], q[2 * LANES + i], q[3 * LANES + i]
        scale = np.float32(1) / np.sqrt(x * x + y * y + z * z + w * w + np.float32(1e-30))
        q[i], q[LANES + i], q[2 * LANES + i], q[3 * LANES + i] = x * scale, y * scale, z * scale, w * scale


@_compiled
def _mix(a: Array, b: Array, weight: Number) -> None:
    """Crossfade `a` in place to `b` along the shorter arc."""
    _unit(a)
    _unit(b)
    v = np.float32(1) - weight
    for i in range(LANES):
        dot = (
            a[i] * b[i]
            + a[LANES + i] * b[LANES + i]
            + a[2 * LANES + i] * b[2 * LANES + i]
            + a[3 * LANES + i] * b[3 * LANES + i]
        )
        u = -weight if dot < 0 else weight
        a[i] = a[i] * v + b[i] * u
        a[LANES + i] = a[LANES + i] * v + b[LANES + i] * u
        a[2 * LANES + i] = a[2 * LANES + i] * v + b[2 * LANES + i] * u
        a[3 * LANES + i] = a[3 * LANES + i] * v + b[3 * LANES + i] * u


@_compiled
def _keep_to(shown: Array, stance: Array, moved: Array) -> None:
    """Let joints of `shown`, in place, go only as far, `moved [16]` 0..1, from their stance."""
    for i in range(LANES):
        w = moved[i]
        if w == 1:
            continue
        dot, shown_sq, stance_sq = np.float32(0), np.float32(0), np.float32(0)
        for k in range(i, 4 * LANES, LANES):
            dot += shown[k] * stance[k]
            shown_sq += shown[k] * shown[k]
            stance_sq += stance[k] * stance[k]
        u = w / np.sqrt(max(shown_sq, np.float32(1e-20)))
        v = (np.float32(1) - w) / np.sqrt(max(stance_sq, np.float32(1e-20)))
        u = -u if dot < 0 else u
        for k in range(i, 4 * LANES, LANES):
            shown[k] = stance[k] * v + shown[k] * u


@_compiled
def _append(a: Array, b: Array) -> None:
    """Multiply `a` in place by `b` from the right."""
    for i in range(LANES):
        ax, ay, az, aw = a[i], a[LANES + i], a[2 * LANES + i], a[3 * LANES + i]
        bx, by, bz, bw = b[i], b[LANES + i], b[2 * LANES + i], b[3 * LANES + i]
        a[i] = aw * bx + ax * bw + ay * bz - az * by
        a[LANES + i] = aw * by - ax * bz + ay * bw + az * bx
        a[2 * LANES + i] = aw * bz + ax * by - ay * bx + az * bw
        a[3 * LANES + i] = aw * bw - ax * bx - ay * by - az * bz


@_compiled
def _lead(shown: Array, stance: Array, edge: Array, weight: Number) -> None:
    """Add to `shown` in place part of what the stance differs from the clip's edge."""
    _unit(stance)
    for i in range(3 * LANES):
        edge[i] = -edge[i]
    _unit(edge)
    _append(edge, stance)
    v = np.float32(1) - weight
    for i in range(LANES):
        u = -weight if edge[3 * LANES + i] < 0 else weight
        edge[i], edge[LANES + i] = edge[i] * u, edge[LANES + i] * u
        edge[2 * LANES + i] = edge[2 * LANES + i] * u
        edge[3 * LANES + i] = edge[3 * LANES + i] * u + v
    _append(shown, edge)


@_compiled
def _power(q: Array, weights: Array) -> None:
    """Take each turn `weights [16]` times, the short way, in place."""
    _unit(q)
    for i in range(LANES):
        sign = np.float32(-1) if q[3 * LANES + i] < 0 else np.float32(1)
        x, y, z, w = q[i] * sign, q[LANES + i] * sign, q[2 * LANES + i] * sign, q[3 * LANES + i] * sign
        sine = np.sqrt(x * x + y * y + z * z)
        half = np.arctan2(sine, w) * weights[i]
        factor = np.sin(half) / sine if sine > 1e-8 else weights[i]
        q[i], q[LANES + i], q[2 * LANES + i] = x * factor, y * factor, z * factor
        q[3 * LANES + i] = np.cos(half)


@_compiled
def _extend(shown: Array, stance: Array, extent: Number, scales: Array, scratch: Array) -> None:
    """Play `shown` larger or smaller round the stance, in place; the same as the player's. scales `[16]`: 0
    for joints that stay as they are.
    """
    _unit(stance)
    for i in range(3 * LANES):
        scratch[i] = -stance[i]
    for i in range(3 * LANES, 4 * LANES):
        scratch[i] = stance[i]
    _append(scratch, shown)
    _unit(scratch)
    for i in range(LANES):
        part = _ease((abs(scratch[3 * LANES + i]) - 0.1) / 0.4)
        scales[i] = np.float32(1 + (extent - 1) * scales[i] * part)
    _power(scratch, scales)
    for i in range(4 * LANES):  # a slice that is set takes seconds to compile
        shown[i] = stance[i]
    _append(shown, scratch)


# --- where samples lie


@_compiled
def _ease(x: Number) -> Number:
    x = min(max(x, 0.0), 1.0)
    return x * x * (3 - 2 * x)


@_compiled
def _clip_seconds(cue: Any, time: Number) -> Number:
    """Return the clip seconds a cue shows, its hold stretched."""
    elapsed = time - cue.start
    if cue.hold <= 0:
        return cue.entry + elapsed * cue.tempo
    held = min(max(elapsed - cue.held / cue.tempo, 0.0), cue.hold)
    return cue.entry + (elapsed - held) * cue.tempo + held * cue.rate


@_compiled
def _last_from(starts: Array, low: int, high: int, time: Number) -> int:
    """Return the last place in low..high whose start is not after `time`; low - 1 when there is none."""
    while low < high:
        middle = (low + high) // 2
        if starts[middle] <= time:
            low = middle + 1
        else:
            high = middle
    return low - 1


@_compiled
def _spot(clip: Any, seconds: Number) -> Spot:
    at = min(max(seconds * clip.fps, 0.0), clip.frames - 1.0)
    low = min(int(at), max(0, clip.frames - 2))
    return clip.first + low, clip.first + min(low + 1, clip.frames - 1), np.float32(at - low)


@_compiled
def _loop(rest: Any, clips: Array, time: Number) -> Loop:
    nowhere = (0, 0, np.float32(0))
    if rest.clip < 0:
        return nowhere, nowhere, np.float32(-1)
    clip = clips[rest.clip]
    elapsed = time - rest.start
    if rest.period <= 0:
        return _spot(clip, rest.first), nowhere, np.float32(0)
    if rest.seam > 0 and elapsed < 0:
        elapsed = 0.0
    phase = elapsed % rest.period
    here = _spot(clip, rest.first + phase)
    if rest.seam > 0 and elapsed >= rest.period and phase < rest.seam:
        other = _spot(clip, rest.first + min(rest.period + phase, rest.length))
        return here, other, np.float32(1 - _ease(phase / rest.seam))
    return here, nowhere, np.float32(0)


@_compiled
def _loop_turns(table: Array, loop: Loop, block: int, out: Array, scratch: Array) -> None:
    here, other, seam = loop
    if seam < 0:
        out[: 3 * LANES] = 0
        out[3 * LANES :] = 1
        return
    _lerp(table[here[0], block], table[here[1], block], here[2], out)
    if seam > 0:
        _lerp(table[other[0], block], table[other[1], block], other[2], scratch)
        _mix(out, scratch, seam)


@_compiled
def _way(table: Array, spot: Spot, i: int, axis: int) -> Number:
    return table[spot[0], i, axis] * (np.float32(1) - spot[2]) + table[spot[1], i, axis] * spot[2]


@_compiled
def _loop_way(table: Array, loop: Loop, i: int, axis: int) -> Number:
    here, other, seam = loop
    if seam < 0:
        return np.float32(0)
    return (
        _way(table, here, i, axis) * (np.float32(1) - max(seam, np.float32(0)))
        + _way(table, other, i, axis) * seam
    )


# --- characters


@_compiled
def _add_layer(
    first: int, last: int, seconds: Array, plan_of: Array, layer: Any, out: Array, out_t: Array
) -> None:
    """Add one layer's offsets for characters `first`..`last`: rotations to `out [last - first, B, 64]`,
    translations to `out_t [last - first, J, 3 or more]`. layer: as `laying.LaidLayer` has it.
    """
    rests, rest_starts, cues, cue_starts, at, clips, turns, ways, blocks, movers, lanes, mover_lanes = layer
    shown, stance = np.empty(4 * LANES, np.float32), np.empty(4 * LANES, np.float32)
    other, spare = np.empty(4 * LANES, np.float32), np.empty(4 * LANES, np.float32)
    turned = np.empty(LANES, np.float32)
    for c in range(first, last):
        time, plan = seconds[c], plan_of[c]
        first_rest, last_rest, first_cue, last_cue = (
            at[plan, 0],
            at[plan + 1, 0],
            at[plan, 1],
            at[plan + 1, 1],
        )
        if first_rest == last_rest:
            continue
        place = _last_from(cue_starts, first_cue, last_cue, time)
        playing = place >= first_cue and time < cues[place].end and cues[place].clip >= 0
        mask, lead, blending = -1, np.float32(0), False
        extent, way = 1.0, WIDER
        spot = edge = (0, 0, np.float32(0))
        if playing:
            cue = cues[place]
            clip, mask = clips[cue.clip], cue.mask
            extent, way = cue.extent, WIDER if cue.extent > 1 else NARROWER
            spot = _spot(clip, _clip_seconds(cue, time))
            rising = time < cue.start + cue.blend_in
            blending = rising or time >= cue.end - cue.blend_out
            if blending:
                edge = _spot(clip, cue.entry if rising else _clip_seconds(cue, cue.end))
                up = _ease((time - cue.start) / cue.blend_in) if cue.blend_in > 0 else 1.0
                down = _ease((cue.end - time) / cue.blend_out) if cue.blend_out > 0 else 1.0
                lead = np.float32(1 - up * down)
        resting = not playing or blending or mask >= 0 or extent != 1
        loop = before = (spot, spot, np.float32(-1))
        fade = np.float32(1)
        if resting:
            current = max(_last_from(rest_starts, first_rest, last_rest, time), first_rest)
            rest = rests[current]
            loop = _loop(rest, clips, time)
            if current > first_rest and time < rest.fade_start + rest.fade:
                fade = np.float32(_ease((time - rest.fade_start) / rest.fade))
                before = _loop(rests[current - 1], clips, time)

        for b in range(len(blocks)):
            if resting:
                _loop_turns(turns, loop, b, stance, spare)
                if fade < 1:
                    _loop_turns(turns, before, b, other, spare)
                    _mix(stance, other, np.float32(1) - fade)
            result = stance
            if playing:
                result = shown
                _lerp(turns[spot[0], b], turns[spot[1], b], spot[2], shown)
                if blending:
                    _lerp(turns[edge[0], b], turns[edge[1], b], edge[2], other)
                    _lead(shown, stance, other, lead)
                if extent != 1:
                    for i in range(LANES):
                        turned[i] = lanes[way, b, i]
                    _extend(shown, stance, extent, turned, spare)
                if mask >= 0:
                    _keep_to(shown, stance, lanes[MASKS + mask, b])
            if lanes[WEIGHED, b, 0] > 0:
                _power(result, lanes[WEIGHT, b])
            _append(out[c - first, blocks[b]], result)

        for m in range(len(movers)):
            moves_m = np.float32(1 if playing else 0)
            if mask >= 0:
                moves_m = mover_lanes[MASKS + mask, m]
            for axis in range(3):
                t = np.float32(0)
                if resting:
                    t = _loop_way(ways, loop, m, axis)
                    if fade < 1:
                        t = t * fade + _loop_way(ways, before, m, axis) * (np.float32(1) - fade)
                under = t
                if moves_m > 0:
                    away = _way(ways, spot, m, axis)
                    t = away + (t - _way(ways, edge, m, axis)) * lead if blending else away
                    if extent != 1:
                        t = under + (t - under) * np.float32(1 + (extent - 1) * mover_lanes[way, m])
                    t = under + (t - under) * moves_m if moves_m < 1 else t
                out_t[c - first, movers[m], axis] += t * mover_lanes[WEIGHT, m]


@_compiled
def pose(
    first: int, last: int, seconds: Array, plan_of: Array, layers: Any, base: Array, travels: Array,
    places: Array, out_r: Array, out_t: Array, parents: Array, model_r: Array, model_p: Array,
) -> None:  # fmt: skip
    """Write poses of characters `first`..`last` to `out_r [C, J, 4]`, `out_t [C, J, 3]`; or, where they are
    not empty, to `model_r` and `model_p` in the characters' spaces. layers: what `_add_layer` takes. base
    `[B, 64]`, travels `[J, 3]`: the base pose. places `[J]`: of the joints in the blocks.
    """
    joints, count = len(travels), min(AT_ONCE, last - first)
    blocked = np.empty((count, *base.shape), np.float32)
    model = len(model_r) > 0
    ways = np.zeros((count if model else 0, joints, FOUR), np.float32)
    rest = np.zeros((joints, FOUR if model else 3), np.float32)
    rest[:, :3] = travels
    still = rest.reshape(-1)
    turns = np.empty((len(base) * LANES, ROW), np.float32)
    rows = places // (4 * LANES) * LANES + places % LANES
    for start in range(first, last, AT_ONCE):
        end = min(start + AT_ONCE, last)
        moved = ways if model else out_t[start:end]
        for c in range(end - start):
            for b in range(len(base)):
                for i in range(4 * LANES):
                    blocked[c, b, i] = base[b, i]
            flat = moved[c].reshape(-1)
            for i in range(len(still)):
                flat[i] = still[i]
        for layer in layers:
            _add_layer(start, end, seconds, plan_of, layer, blocked, moved)
        for c in range(end - start):
            for b in range(len(base)):
                _unit(blocked[c, b])
        if model:
            out = model_r[start:end], model_p[start:end]
            four_kernels.to_models(parents, rows, blocked[: end - start], ways, turns, *out)
            continue
        for c in range(start, end):
            four_kernels.spread(blocked[c - start], turns, 0)
            for j in range(joints):
                for k in range(4):
                    out_r[c, j, k] = turns[rows[j], k]


def warm() -> None:
    """Have ready what poses are worked out with."""
    numbers = np.zeros(0, np.int64)
    layer = (
        *(np.zeros(0, REST), np.zeros(0), np.zeros(0, CUE), np.zeros(0)),
        *(np.zeros((1, 2), np.int64), np.zeros(0, CLIP)),
        *(np.zeros((0, 0, 4 * LANES), np.float32), np.zeros((0, 0, 3), np.float32), numbers, numbers),
        *(np.zeros((0, 0, LANES), np.float32), np.zeros((0, 0), np.float32)),
    )
    turns, places = np.zeros((0, 0, 4), np.float32), np.zeros((0, 0, 3), np.float32)
    base = np.zeros((0, 4 * LANES), np.float32), np.zeros((0, 3), np.float32), numbers
    pose(0, 0, np.zeros(0), numbers, (layer, layer, layer), *base, turns, places, numbers, turns, places)
