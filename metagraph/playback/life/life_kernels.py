"""Bodies brought to life in compiled loops. Importing this imports numba.

What is compiled are the functions of `solve`; what is here hands them arrays.
"""

from __future__ import annotations

from collections import namedtuple
from collections.abc import Callable
from typing import Any

import numpy as np

from metagraph.compiling import compiled_from, compiler, stamp
from metagraph.playback.life import solve
from metagraph.playback.life.solve import FaceLids, LifeDials, LifeNow

Array = Any
KEPT, SOURCES = ("bring_to_life",), (solve,)

_OPTIONS: dict[str, Any] = {"nogil": True, "error_model": "numpy"}
_inside = compiler(keep=False, **_OPTIONS)  # kept as part of what calls them

# What dataclasses are to numba.
_Looker = namedtuple("_Looker", "place share")
_Eye = namedtuple("_Eye", "at left up ahead joint turn_left turn_up down")
_Body = namedtuple(
    "_Body",
    "left up ahead breath bowed thrust shoulders tense lookers trunk trunk_ahead head_ahead eyes",
)
_Aim = namedtuple("_Aim", "at amount asked")
_Moves = namedtuple("_Moves", "parts eyes head")

_enlivened = compiled_from((solve,), {}, _inside)[solve.__name__]["enlivened"]


@_inside
def _vector(row: Array, first: int) -> Any:
    return (row[first], row[first + 1], row[first + 2])


@_inside
def _quaternion(row: Array, first: int) -> Any:
    return (row[first], row[first + 1], row[first + 2], row[first + 3])


@_inside
def _eye(row: Array) -> Any:
    return _Eye(
        _vector(row, 0), _vector(row, 3), _vector(row, 6), _vector(row, 9),
        row[12] > 0, _vector(row, 13), _vector(row, 16), _quaternion(row, 19),
    )  # fmt: skip


@_inside
def _turned(rotations: Array, joint: int, q: Any, turn: Any) -> None:
    """Turn a rotation by a rotation vector from the right."""
    ax, ay, az, aw = q
    x, y, z = turn
    size = np.sqrt(x * x + y * y + z * z + 1e-30)
    k = np.sin(0.5 * size) / size
    bx, by, bz, bw = x * k, y * k, z * k, np.cos(0.5 * size)
    rotations[joint, 0] = aw * bx + ax * bw + ay * bz - az * by
    rotations[joint, 1] = aw * by - ax * bz + ay * bw + az * bx
    rotations[joint, 2] = aw * bz + ax * by - ay * bx + az * bw
    rotations[joint, 3] = aw * bw - ax * bx - ay * by - az * bz


def _driver(said: int) -> Callable[..., Any]:
    """Return what is called from without. said: `stamp` of the source, part of what numba keeps it under."""
    compiled = compiler(**_OPTIONS)

    @compiled
    def bring_to_life(
        chain: Array,
        joints: Array,
        read: Array,
        directions: Array,
        bends: Array,
        risers: Array,
        lookers: Array,
        trunk: int,
        eyes: Array,
        lids: Array,
        face_turns: Array,
        face_shifts: Array,
        shifted: Array,
        dials: Array,
        now: Array,
        gaze_at: Array,
        aims: Array,
        asides: Array,
        looks: bool,
        channels: Array,
        rotations: Array,
        translations: Array,
    ) -> int:
        """Add breath, gaze, lids and channels to poses, in place.

        chain `[c]`, joints `[L]`, read `[r]`: as `Body`. directions `[5, 3]`: left, up, ahead, the trunk's
        ahead, the head's. bends `[c, 6]`: breath's axis and angle, bowed, thrust. risers `[s, 6]`: shoulders,
        tense. lookers `[k, 2]`. eyes `[2, 23]`. lids `[4, 6]`: whether a joint, follows, shut_by. face_turns
        `[C, F, 3]`, face_shifts `[C, h, 3]` of joints shifted `[h]`. dials `[4]`, now `[N, 6]`: as in
        `solve`. gaze_at `[N + 1]`: each pose's aims `[A, 7]`: at, amount, asked, the eyes' and the head's
        share. asides `[N, 4]`: what is added to eyes and head. channels `[N, C]`, those of lids and blink to
        be filled.
        """
        long = len(chain)
        body = _Body(
            _vector(directions[0], 0),
            _vector(directions[1], 0),
            _vector(directions[2], 0),
            [(_vector(bends[n], 0), bends[n, 3]) for n in range(long)],
            bends[:, 4],
            bends[:, 5],
            [_vector(risers[n], 0) for n in range(len(risers))],
            [_vector(risers[n], 3) for n in range(len(risers))],
            [_Looker(int(lookers[n, 0]), lookers[n, 1]) for n in range(len(lookers))],
            trunk,
            _vector(directions[3], 0),
            _vector(directions[4], 0),
            (_eye(eyes[0]), _eye(eyes[1])),
        )
        own_lids = FaceLids(
            [lids[n, 0] > 0 for n in range(4)],
            [lids[n, 1] for n in range(4)],
            [_quaternion(lids[n], 2) for n in range(4)],
        )
        amounts = LifeDials(dials[0], dials[1], dials[2], dials[3])
        face = len(joints) - face_turns.shape[1]
        count = 0 * said
        for n in range(len(rotations)):
            own, ways = rotations[n].astype(np.float64), translations[n].astype(np.float64)
            here = [_quaternion(own[j], 0) for j in read]
            places = [_vector(ways[j], 0) for j in chain]
            aimed = [
                (_Aim(_vector(aims[k], 0), aims[k, 3], aims[k, 4] > 0), aims[k, 5], aims[k, 6])
                for k in range(gaze_at[n], gaze_at[n + 1])
            ]
            moves = _Moves(aimed, (asides[n, 0], asides[n, 1]), (asides[n, 2], asides[n, 3]))
            happens = LifeNow(now[n, 0], now[n, 1], now[n, 2], now[n, 3], now[n, 4], now[n, 5])
            line, turns, _, _, shut = _enlivened(body, own_lids, amounts, happens, here, places, moves, looks)
            for k in range(4):
                channels[n, k] = shut[k]
            channels[n, 4] = now[n, 5]
            for k in range(len(joints)):
                j = joints[k]
                q = line[k] if k < long else _quaternion(own[j], 0)
                if k < face:
                    turn = turns[k]
                else:
                    x, y, z = 0.0, 0.0, 0.0
                    for m in range(len(face_turns)):
                        value = channels[n, m]
                        if value != 0.0:
                            x += value * face_turns[m, k - face, 0]
                            y += value * face_turns[m, k - face, 1]
                            z += value * face_turns[m, k - face, 2]
                    turn = (x, y, z)
                _turned(rotations[n], j, q, turn)
            for k in range(len(shifted)):
                for axis in range(3):
                    gone = 0.0
                    for m in range(len(face_shifts)):
                        gone += channels[n, m] * face_shifts[m, k, axis]
                    translations[n, shifted[k], axis] += gone
            count += 1
        return count

    found: Callable[..., Any] = bring_to_life
    return found


bring_to_life = _driver(stamp(SOURCES))


def warm() -> None:
    """Have ready what is called with float32 poses."""
    turns, places = np.zeros((0, 1, 4), np.float32), np.zeros((0, 1, 3), np.float32)
    none, rows, deep = np.zeros(0, np.int64), np.zeros((0, 6)), np.zeros((0, 0, 3))
    body = none, none, none, np.zeros((5, 3)), rows, rows, rows, 0, np.zeros((2, 23)), np.zeros((4, 6))
    now = np.zeros(4), rows, np.zeros(1, np.int64), rows, rows, True, rows
    bring_to_life(*body, deep, deep, none, *now, turns, places)
