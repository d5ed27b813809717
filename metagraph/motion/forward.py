"""Forward kinematics: where joints are, from what each does beside its parent; over many poses at once.

Numbers lie with the poses last, so that each step runs along memory, and a depth of the tree is one slice.
Only what needs a parent is done depth by depth: turns, a product of four by four, then places, a sum. It is,
to the same bit, `rotation.multiply` and `rotation.rotate` depth after depth, many times as fast.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]

AT_ONCE = 256  # poses: what is worked on stays in a processor's cache

# What of a joint's own turn, w x y z, its parent's w, x, y and z are multiplied by, a row each.
FACTORS = np.array(((0, 1, 2, 3), (1, 0, 3, 2), (2, 3, 0, 1), (3, 2, 1, 0)))
SIGNS = np.array(((1, 1, 1, 1), (-1, 1, -1, 1), (-1, 1, 1, -1), (-1, -1, 1, 1)), np.int8)[..., None, None]
YZX, ZXY = (1, 2, 0), (2, 0, 1)


class Forward:
    """What can be known of a tree of joints before there is a pose."""

    def __init__(self, parents: Array, levels: tuple[Array, ...]) -> None:
        """parents: `[J]`, -1 for a root. levels: joints by depth, roots first."""
        self._order = np.concatenate(levels)  # joints in the order in which they are worked on
        self._place = np.empty_like(self._order)
        self._place[self._order] = np.arange(len(self._order))
        ends = np.cumsum([len(level) for level in levels])
        self._steps = [
            (slice(int(start), int(end)), self._place[parents[level]])
            for start, end, level in zip(ends, ends[1:], levels[1:], strict=False)
        ]
        self._roots = len(levels[0])
        self._above = np.array([i for _, above in self._steps for i in above], np.int64)

    def __call__(self, rotations: Array, translations: Array) -> tuple[Array, Array]:
        """Return model-space rotations `[F, J, 4]` and positions `[F, J, 3]`, typed as the local ones."""
        if len(translations) <= AT_ONCE:
            return self._some(rotations, translations)
        out = np.empty_like(rotations), np.empty_like(translations)
        for start in range(0, len(translations), AT_ONCE):
            some = slice(start, start + AT_ONCE)
            out[0][some], out[1][some] = self._some(rotations[some], translations[some])
        return out

    def _some(self, rotations: Array, translations: Array) -> tuple[Array, Array]:
        turns, roots = rotations.transpose(2, 1, 0), self._roots
        q = np.empty((4, *turns.shape[1:]), turns.dtype)  # w x y z
        q[0], q[1:] = turns[3, self._order], turns[:3, self._order]
        by = q.take(FACTORS, 0)
        by *= SIGNS
        for here, parents in self._steps:
            q[:, here] = np.add.reduce(q.take(parents, 1)[:, None] * by[:, :, here], 0)
        at = translations.transpose(2, 1, 0)[:, self._order]
        p, above = at[:, roots:], q.take(self._above, 1)
        aw, yzx, zxy = above[0], above[1:].take(YZX, 0), above[1:].take(ZXY, 0)
        cross = yzx * p.take(ZXY, 0)
        cross -= zxy * p.take(YZX, 0)
        cross *= 2
        gone = aw * cross
        gone += p
        gone += yzx * cross.take(ZXY, 0)
        gone -= zxy * cross.take(YZX, 0)
        for here, parents in self._steps:
            at[:, here] = at.take(parents, 1) + gone[:, here.start - roots : here.stop - roots]
        out_r, out_p = np.empty(rotations.shape, q.dtype), np.empty(translations.shape, at.dtype)
        seen = out_r.transpose(2, 1, 0)
        seen[:3], seen[3] = q[1:].take(self._place, 1), q[0].take(self._place, 0)
        out_p.transpose(2, 1, 0)[:] = at.take(self._place, 1)
        return out_r, out_p
