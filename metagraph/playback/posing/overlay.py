"""Lay motion over a plan, for example that of a learned model: it moves arms, head and spine; legs and root
stay with the body's layer.

It replaces the layers of the arms and the head, so it is added to the body's layer as they are: a character
that shifts its weight while gesturing also does so here.
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
from metagraph.playback.posing.layers import Sample, ease_blend, make_zero_offsets, sample_offsets

Array = NDArray[Any]

BLEND = 0.3  # seconds from and to the plan at both ends of a clip
MOVED: tuple[Part, ...] = ("spine", "arms", "head")


@dataclass(frozen=True, eq=False)
class Overlay:
    """Motion over a plan at times `[N]`.

    `joints` `[n]` are moved by `turns` `[N, n, 4]`, offsets from the base pose. `weight` `[N]` is how much of
    it shows, 0..1. `arms` and `head` `[N]` say how much of those layers shows instead, 0..1; a gesture takes
    the head along, a nod only the head.
    """

    joints: Array
    turns: Array
    weight: Array
    arms: Array
    head: Array


def lay_over(project: Project, rig: ComposerRig, layers: Mapping[Layer, Sample], over: Overlay) -> Pose:
    """Return the pose `[N, J]` of the body's layer with the overlay in place of the other two layers, as far
    as it shows. `layers` has what each layer adds.
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
    turns = rotation.make_identity_rotations((count, size), np.float32)
    turns[:, over.joints] = over.turns
    rotations = rotation.multiply(rotations, rotation.nlerp(turned, turns, share))
    translations = translations + away * (1 - share[..., None])
    # The overlay has nothing for the head's layer itself, so where the overlay shows, that layer is hidden.
    share = np.zeros((count, size), np.float32)
    share[:, over.joints] = (over.weight * (1 - both))[:, None]
    turned, away = _whole(rig, layers, "head", count)
    still = rotation.make_identity_rotations((count, size), np.float32)
    rotations = rotation.multiply(rotations, rotation.nlerp(turned, still, share))
    return Pose(rotation.normalize(rotations), translations + away * (1 - share[..., None]))


def _whole(rig: ComposerRig, layers: Mapping[Layer, Sample], layer: Layer, count: int) -> Sample:
    """Return what a layer adds on every joint `[count, J]`."""
    rotations, translations = make_zero_offsets(count, len(rig.ground.skeleton))
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
    """Return the joints `[n]` that overlays move: spine, arms, neck and head, not the face."""
    return _reach(anatomy.project_parts(project)).joints


def make_clip_overlay(project: Project, clip: Clip, times: Array) -> Overlay:
    """Return a clip as an overlay from its beginning on, at `times [N]`. It fades in and out within BLEND
    seconds, or half the length of a short clip. Raises ValueError for a clip of another skeleton.
    """
    reach = _reach(anatomy.project_parts(project))
    turns, _ = sample_offsets(find_composer(project).ground, reach, clip, np.clip(times, 0.0, clip.duration))
    blend = max(1e-6, min(BLEND, clip.duration / 2))
    weight = ease_blend(times / blend) * ease_blend((clip.duration - times) / blend)
    none = np.zeros(len(times))
    return Overlay(reach.joints, turns, weight, none, none)
