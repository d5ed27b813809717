"""The composer: layers add their offsets from the base pose (Borer et al., section 5).

An offset of rotation is `base^-1 * q`, multiplied on the right; an offset of translation is a difference. A joint's pose
is `base * body^w * arms^w * head^w` over the layers whose weight on its body part is not zero.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Any
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from metagraph.graph import anatomy
from metagraph.graph.model import LAYERS, Layer, Part, Project
from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.motion.skeleton import Pose, Skeleton

Array = NDArray[Any]


@dataclass(frozen=True, eq=False)
class Offsets:
    """A clip relative to the base pose. rotations `[F, J, 4]`, translations `[F, T, 3]` for the joints in `moved` `[T]`, float32."""

    rotations: Array
    translations: Array
    moved: Array


class Ground:
    """A skeleton and a base pose, with the offsets of every clip asked for so far."""

    def __init__(self, skeleton: Skeleton, base: Pose) -> None:
        self.skeleton, self.base = skeleton, base
        self._inverse = rotation.conjugate(base.rotations)
        self._offsets: WeakKeyDictionary[Clip, Offsets] = WeakKeyDictionary()

    def offsets(self, clip: Clip) -> Offsets:
        """Return a clip's offsets. Raises ValueError when the clip has another skeleton."""
        found = self._offsets.get(clip)
        if found is None:
            if clip.skeleton != self.skeleton:
                raise ValueError(f"clip '{clip.name}' has another skeleton")
            away = clip.poses().translations - self.base.translations
            moved = np.flatnonzero(np.abs(away).max(axis=(0, 2)) > 1e-7)
            turned = rotation.continuous(rotation.multiply(self._inverse, clip.rotations))
            found = Offsets(turned, np.ascontiguousarray(away[:, moved]), moved)
            self._offsets[clip] = found
        return found


@dataclass(frozen=True, eq=False)
class Rig:
    """How layers reach joints: for each layer the joints it moves `[n]` and its weights on them `[n]`, None where all are 1."""

    ground: Ground
    reach: Mapping[Layer, tuple[Array, Array | None]]

    def compose(self, layers: Mapping[Layer, tuple[Array, Array]]) -> Pose:
        """Add layers' offsets, each rotations `[N, J, 4]` and translations `[N, J, 3]`, to the base pose."""
        base = self.ground.base
        count = next(len(r) for r, _ in layers.values()) if layers else 1
        rotations = np.broadcast_to(base.rotations, (count, *base.rotations.shape)).copy()
        translations = np.broadcast_to(base.translations, (count, *base.translations.shape)).copy()
        for layer in LAYERS:
            if layer not in layers:
                continue
            joints, weights = self.reach[layer]
            turned, away = (a[:, joints] for a in layers[layer])
            if weights is not None:
                turned, away = rotation.power(turned, weights), away * weights[:, None]
            rotations[:, joints] = rotation.multiply(rotations[:, joints], turned)
            translations[:, joints] += away
        return Pose(rotation.normalize(rotations), translations)


@lru_cache(maxsize=8)
def _ground(skeleton: Skeleton, clip: Clip | None, frame: int) -> Ground:
    if clip is None:
        rest = skeleton.rest
        return Ground(skeleton, Pose(rest.rotations.astype(np.float32), rest.translations.astype(np.float32)))
    return Ground(skeleton, clip.pose_at(frame / clip.fps))


@lru_cache(maxsize=16)
def _rig(ground: Ground, parts: tuple[Part, ...], weights: tuple[tuple[float, ...], ...], order: tuple[Part, ...]) -> Rig:
    reach: dict[Layer, tuple[Array, Array | None]] = {}
    for layer, row in zip(LAYERS, weights, strict=True):
        by_part = dict(zip(order, row, strict=True))
        each = np.array([by_part[part] for part in parts], np.float32)
        joints = np.flatnonzero(each > 0)
        chosen = each[joints]
        reach[layer] = (joints, None if np.all(chosen == 1) else chosen)
    return Rig(ground, reach)


def rig(project: Project) -> Rig:
    """Return the project's rig; the same object as long as skeleton, base pose, parts and weights stay as they are."""
    if project.skeleton is None:
        raise ValueError("a project without clips cannot be posed")
    entry = project.clips.get(project.base.clip) if project.base.clip else None
    motion = entry.motion if entry is not None else None
    if motion is not None and motion.skeleton != project.skeleton:
        motion = None
    frame = min(project.base.frame, motion.frames - 1) if motion is not None else 0
    order: tuple[Part, ...] = ("legs", "spine", "arms", "head", "face")
    weights = tuple(tuple(project.graphs[layer].weight(part) for part in order) for layer in LAYERS)
    return _rig(_ground(project.skeleton, motion, frame), anatomy.parts(project), weights, order)
