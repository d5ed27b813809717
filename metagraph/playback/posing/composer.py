"""Compose layers: they add their offsets from the base pose (Borer et al., section 5).

An offset of rotation is `base^-1 * q`, multiplied on the right; an offset of translation is a difference. A
joint's pose is `base * body^w * arms^w * head^w` over the layers whose weight on its body part is not zero.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any
from weakref import WeakKeyDictionary, ref

import numpy as np
from numpy.typing import NDArray

from metagraph.graph import anatomy
from metagraph.graph.face.curves import fit_curves_to_face
from metagraph.graph.model import LAYERS, Action, Layer, Part, Project
from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.motion.skeleton import Pose, Skeleton

Array = NDArray[Any]


@dataclass(frozen=True, eq=False)
class Offsets:
    """A clip's dense keys relative to the base pose, for the joints that a layer reaches.

    Rotations `[F, n, 4]`, with neighbouring frames on the same side; translations `[F, m, 3]` of the joints
    that `moved` `[m]` lists, as indices into the n joints; float32.
    """

    rotations: Array
    translations: Array
    moved: Array


@dataclass(frozen=True, eq=False)
class Reach:
    """The joints `[n]` that a layer moves, and its weights on them `[n, 1]`, None if all are 1."""

    joints: Array
    weights: Array | None

    @cached_property
    def key(self) -> bytes:
        return self.joints.tobytes()


class Ground:
    """A skeleton and a base pose, with the offsets of all clips used so far."""

    def __init__(self, skeleton: Skeleton, base: Pose) -> None:
        self.skeleton, self.base = skeleton, base
        self._inverse = rotation.conjugate(base.rotations)
        self._offsets: WeakKeyDictionary[Clip, dict[bytes, Offsets]] = WeakKeyDictionary()

    def offsets(self, clip: Clip, reach: Reach, keep: bool = True) -> Offsets:
        """Return a clip's offsets on the joints of a layer.

        `keep` says whether to remember them; callers that need them once do not. Raises ValueError if the
        clip has another skeleton.
        """
        known = self._offsets.get(clip)
        if known is None:
            if clip.skeleton != self.skeleton:
                raise ValueError(f"clip '{clip.name}' has another skeleton")
            known = self._offsets.setdefault(clip, {}) if keep else {}
        found = known.get(reach.key)
        if found is None:
            joints = reach.joints
            dense = clip.dense
            away = dense.poses().translations[:, joints] - self.base.translations[joints]
            moved = np.flatnonzero(np.abs(away).max(axis=(0, 2), initial=0) > 1e-7)
            turned = rotation.make_continuous(
                rotation.multiply(self._inverse[joints], dense.rotations[:, joints])
            )
            found = Offsets(turned, np.ascontiguousarray(away[:, moved]), moved)
            if keep:
                known[reach.key] = found
        return found


@dataclass(frozen=True, eq=False)
class ComposerRig:
    """The joints that each layer reaches."""

    ground: Ground
    reach: Mapping[Layer, Reach]

    def compose(self, layers: Mapping[Layer, tuple[Array, Array]], count: int) -> Pose:
        """Add the layers' offsets, rotations `[count, n, 4]` and translations `[count, n, 3]` each, to the
        base pose.
        """
        base = self.ground.base
        rotations = np.repeat(base.rotations[None], count, 0)
        translations = np.repeat(base.translations[None], count, 0)
        for layer in LAYERS:
            if layer not in layers:
                continue
            joints, weights = self.reach[layer].joints, self.reach[layer].weights
            turned, away = layers[layer]
            if weights is not None:
                turned, away = rotation.scale_rotation(turned, weights[:, 0]), away * weights
            rotations[:, joints] = rotation.multiply(rotations[:, joints], turned)
            translations[:, joints] += away
        return Pose(rotation.normalize(rotations), translations)


@lru_cache(maxsize=8)
def _ground(skeleton: Skeleton, whose: ref[Clip] | None, frame: int) -> Ground:
    clip = whose() if whose is not None else None  # a weak reference, because its project may be closed
    if clip is None:
        rest = skeleton.rest
        return Ground(skeleton, Pose(rest.rotations.astype(np.float32), rest.translations.astype(np.float32)))
    return Ground(skeleton, clip.pose_at(frame / clip.fps))


@lru_cache(maxsize=16)
def _rig(
    ground: Ground, parts: tuple[Part, ...], weights: tuple[tuple[float, ...], ...], order: tuple[Part, ...]
) -> ComposerRig:
    reach: dict[Layer, Reach] = {}
    for layer, row in zip(LAYERS, weights, strict=True):
        by_part = dict(zip(order, row, strict=True))
        each = np.array([by_part[part] for part in parts], np.float32)
        joints = np.flatnonzero(each > 0)
        chosen = each[joints, None]
        reach[layer] = Reach(joints, None if np.all(chosen == 1) else chosen)
    return ComposerRig(ground, reach)


def find_composer(project: Project) -> ComposerRig:
    """Return the joints that a project's layers reach; the same object while skeleton, base pose, parts and
    weights stay the same. Raises ValueError without a skeleton.
    """
    if project.skeleton is None:
        raise ValueError("a project without clips cannot be posed")
    entry = project.clips.get(project.base.clip) if project.base.clip else None
    motion = entry.motion if entry is not None else None
    if motion is not None and motion.skeleton != project.skeleton:
        motion = None
    frame = min(project.base.frame, motion.frames - 1) if motion is not None else 0
    order: tuple[Part, ...] = ("legs", "spine", "arms", "head", "face")
    weights = tuple(tuple(project.graphs[layer].weight(part) for part in order) for layer in LAYERS)
    ground = _ground(project.skeleton, ref(motion) if motion is not None else None, frame)
    return _rig(ground, anatomy.project_parts(project), weights, order)


def find_playable_motion(project: Project, action: Action) -> Clip | None:
    """Return the motion of an action, its curves on the project's face; None if its clip is missing or has
    another skeleton.
    """
    entry = project.clips.get(action.clip)
    motion = entry.motion if entry is not None else None
    if motion is None or motion.skeleton != project.skeleton:
        return None
    return fit_curves_to_face(project, motion) if motion.morphs else motion
