"""Which joints of a clip move when: a sheet to read, since clips have a pose for every frame and no keys."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.motion import rotation
from metagraph.motion.clip import Clip

Array = NDArray[Any]

STILL = 4.0  # degrees a second: a joint that never turns as fast does not move
FASTEST = 40.0  # degrees a second that count as much at least, so that trembling does not look like motion


@dataclass(frozen=True, eq=False)
class DopeSheet:
    """names: of the joints that move, as the skeleton has them, or of the groups. degrees `[F, J]`: how fast
    each turns, degrees a second. parts: the same, of the fastest it ever turns, 0..1.
    """

    names: tuple[str, ...]
    degrees: Array
    parts: Array


def make_dope_sheet(clip: Clip, groups: Mapping[str, str] | None = None) -> DopeSheet:
    """Return what moves in a clip. groups: joint -> the line that reports it, as fast as the fastest
    of them; joints that are not named there are left out. Without it every joint has a line.
    """
    turned = np.zeros((clip.frames, len(clip.skeleton)))
    if clip.frames > 1:
        r = np.asarray(clip.rotations, np.float64)
        between = rotation.multiply(rotation.conjugate(r[:-1]), r[1:])
        half = np.arctan2(np.linalg.norm(between[..., :3], axis=-1), np.abs(between[..., 3]))
        speed = np.degrees(2 * half) * clip.fps
        turned[:-1] += speed / 2
        turned[1:] += speed / 2
        turned[0] *= 2
        turned[-1] *= 2
    names = clip.skeleton.names
    if groups is not None:
        lines = tuple(dict.fromkeys(groups[n] for n in names if n in groups))
        members = [[j for j, n in enumerate(names) if groups.get(n) == line] for line in lines]
        turned = np.stack([turned[:, m].max(1) for m in members], 1) if members else turned[:, :0]
        names = lines
    most = turned.max(0) if len(turned) else np.zeros(len(names))
    moving = np.flatnonzero(most >= STILL)
    degrees = turned[:, moving]
    return DopeSheet(tuple(names[j] for j in moving), degrees, degrees / np.maximum(most[moving], FASTEST))
