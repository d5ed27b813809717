"""Forward kinematics: where joints are, from what each does beside its parent; over many poses at once.

Numbers lie with the poses last, so that each step runs along memory, and a depth of the tree is one slice:
half the time, to the same bit, of `rotation.multiply` and `rotation.rotate` depth after depth.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.compiling import Loops, plain

Array = NDArray[Any]

COMPILED = Loops("metagraph.motion.forward_kernels")
AT_ONCE = 256  # poses: what is worked on stays in a processor's cache
MANY = 2000  # poses for which it pays to load the loops, where they are kept: they give the same to the bit

_worked = [0]  # poses so far, without loops


class Forward:
    """What can be known of a tree of joints before there is a pose."""

    def __init__(self, parents: Array, levels: tuple[Array, ...]) -> None:
        """parents: `[J]`, -1 for a root. levels: joints by depth, roots first."""
        self._parents = np.array(parents, np.int64)
        self._order = np.concatenate(levels)  # joints in the order in which they are worked on
        self._place = np.empty_like(self._order)
        self._place[self._order] = np.arange(len(self._order))
        ends = np.cumsum([len(level) for level in levels])
        self._steps = [
            (slice(int(start), int(end)), self._place[parents[level]])
            for start, end, level in zip(ends, ends[1:], levels[1:], strict=False)
        ]

    def __call__(self, rotations: Array, translations: Array) -> tuple[Array, Array]:
        """Return model-space rotations `[F, J, 4]` and positions `[F, J, 3]`, typed as the local ones."""
        if COMPILED.now is None and _worked[0] < MANY:
            _worked[0] += len(translations)
            if _worked[0] >= MANY:
                COMPILED.load_kept()
        if COMPILED.now is not None and rotations.dtype == translations.dtype == np.float32:
            whole = plain(rotations), plain(translations)
            made = np.empty_like(whole[0]), np.empty_like(whole[1])
            COMPILED.now.globals_of(self._parents, *whole, *made)
            return made
        if len(translations) <= AT_ONCE:
            return self._some(rotations, translations)
        out = np.empty_like(rotations), np.empty_like(translations)
        for start in range(0, len(translations), AT_ONCE):
            some = slice(start, start + AT_ONCE)
            out[0][some], out[1][some] = self._some(rotations[some], translations[some])
        return out

    def _some(self, rotations: Array, translations: Array) -> tuple[Array, Array]:
        turns, at = rotations.transpose(2, 1, 0), translations.transpose(2, 1, 0)
        q = np.empty((6, *turns.shape[1:]), turns.dtype)  # w x y z x y
        q[0], q[1:4] = turns[3, self._order], turns[:3, self._order]
        q[4:] = q[1:3]
        p = np.empty((5, *at.shape[1:]), at.dtype)  # x y z x y
        p[:3] = at[:, self._order]
        p[3:] = p[:2]
        w, x, y, z = q[:4]
        # What of a joint's own turn its parent's x, y and z are multiplied by.
        by_x, by_y, by_z = np.stack((-x, w, -z, y)), np.stack((-y, z, w, -x)), np.stack((-z, -y, x, w))
        exact = np.result_type(q, p)
        for here, parents in self._steps:
            above = q.take(parents, 1)
            aw, yzx, zxy = above[0], above[2:5], above[3:]
            turned = aw * q[:4, here]
            turned += above[1] * by_x[:, here]
            turned += above[2] * by_y[:, here]
            turned += above[3] * by_z[:, here]
            cross = np.empty((5, *p[0, here].shape), exact)
            np.multiply(yzx, p[2:, here], out=cross[:3])
            cross[:3] -= zxy * p[1:4, here]
            cross[:3] *= 2
            cross[3:] = cross[:2]
            gone = aw * cross[:3]
            gone += p[:3, here]
            gone += yzx * cross[2:]
            gone -= zxy * cross[1:4]
            gone += p[:3].take(parents, 1)
            q[:4, here], q[4:, here] = turned, turned[1:3]
            p[:3, here] = gone
        out_r, out_p = np.empty(rotations.shape, q.dtype), np.empty(translations.shape, p.dtype)
        seen = out_r.transpose(2, 1, 0)
        seen[:3], seen[3] = q[1:4].take(self._place, 1), q[0].take(self._place, 0)
        out_p.transpose(2, 1, 0)[:] = p[:3].take(self._place, 1)
        return out_r, out_p
