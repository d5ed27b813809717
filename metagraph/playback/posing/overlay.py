"""Motion laid over a plan: arms, head and spine as something else says, a learned model for one; legs and
root stay with the body's layer.

It takes the place of the arms' and the head's layers, so it is added to what the body's layer does, as they
are: somebody who shifts the weight while gesturing shifts it here, too.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.graph import anatomy
from metagraph.graph.model import Layer, Part, Project
from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.motion.skeleton import Pose
from metagraph.playback.posing.composer import ComposerRig, Reach, find_composer
from metagraph.playback.posing.layers import Sample, ease_blend, sample_offsets, zero_offsets

Array = NDArray[Any]

BLEND = 0.3  # seconds from and to the plan at both ends of a clip
MOVED: tuple[Part, ...] = ("spine", "arms", "head")


@dataclass(frozen=True, eq=False)
class Overlay:
    """What is laid over a plan at times `[N]`. joints `[n]`, and their offsets from the base pose `turns [N,
    n, 4]`. weight `[N]`: how much of it shows, 0..1. arms, head `[N]`: how much of what those layers play
    shows instead, 0..1; a gesture takes the head along, a nod the head alone.
    """

    joints: Array
    turns: Array
    weight: Array
    arms: Array
    head: Array


def lay_over(project: Project, rig: ComposerRig, layers: Mapping[Layer, Sample], over: Overlay) -> Pose:
    """Return the pose `[N, J]` of the body's layer with the other two, and the overlay in their place.
    layers: what each adds.
    """
    count = len(over.weight)
    pose = rig.compose({"body": layers["body"]} if "body" in layers else {}, count)
    size = pose.rotations.shape[1]
    parts = anatomy.project_parts(project)
    heads = np.array([parts[j] == "head" for j in over.joints])
    both = np.maximum(over.arms, over.head)
    share = np.zeros((count, size), np.float32)
    share[:, over.joints] = over.weight[:, None] * (1 - np.where(heads, both[:, None], over.arms[:, None]))
    rotations, translations = pose.rotations, pose.translations
    turned, away = _whole(rig, layers, "arms", count)
    turns = rotation.identity_rotations((count, size), np.float32)
    turns[:, over.joints] = over.turns
    rotations = rotation.multiply(rotations, rotation.nlerp(turned, turns, share))
    translations = translations + away * (1 - share[..., None])
    # The head's layer has no part of its own in the overlay: what is not asked of it, is not to be seen.
    share = np.zeros((count, size), np.float32)
    share[:, over.joints] = (over.weight * (1 - both))[:, None]
    turned, away = _whole(rig, layers, "head", count)
    still = rotation.identity_rotations((count, size), np.float32)
    rotations = rotation.multiply(rotations, rotation.nlerp(turned, still, share))
    return Pose(rotation.normalize(rotations), translations + away * (1 - share[..., None]))


def _whole(rig: ComposerRig, layers: Mapping[Layer, Sample], layer: Layer, count: int) -> Sample:
    """Return what a layer adds on every joint `[count, J]`."""
    rotations, translations = zero_offsets(count, len(rig.ground.skeleton))
    if layer in layers:
        reach = rig.reach[layer]
        turned, away = layers[layer]
        if reach.weights is not None:
            turned, away = rotation.scale_rotation(turned, reach.weights[:, 0]), away * reach.weights
        rotations[:, reach.joints], translations[:, reach.joints] = turned, away
    return rotations, translations


@lru_cache(maxsize=16)
def _reach(parts: tuple[Part, ...]) -> Reach:
    return Reach(np.array([j for j, part in enumerate(parts) if part in MOVED], np.int64), None)


def find_overlaid_joints(project: Project) -> Array:
    """Return the joints `[n]` that are laid over: spine, arms, neck and head; not the face."""
    return _reach(anatomy.project_parts(project)).joints


def clip_overlay(project: Project, clip: Clip, times: Array) -> Overlay:
    """Return a clip laid over a plan from its beginning on, at `times [N]`: it comes and goes within BLEND
    seconds, half of it for a short one. Raises ValueError for a clip of another skeleton.
    """
    reach = _reach(anatomy.project_parts(project))
    turns, _ = sample_offsets(find_composer(project).ground, reach, clip, np.clip(times, 0.0, clip.duration))
    blend = max(1e-6, min(BLEND, clip.duration / 2))
    weight = ease_blend(times / blend) * ease_blend((clip.duration - times) / blend)
    none = np.zeros(len(times))
    return Overlay(reach.joints, turns, weight, none, none)
