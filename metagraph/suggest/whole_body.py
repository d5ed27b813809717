"""Clips recorded with the whole body: stances in which all layers stand together, and how that is noticed.

An additive layer holds what differs from the base pose. Where arms, trunk and legs always change their stance
together, as in takes of somebody who sits down, every layer would add the same lean once more. Then one
layer, the arms', carries the whole body: it holds all stances, transitions, gestures and fidgets, and plays
them as they were recorded.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.graph.model import Project
from metagraph.graph.words import LAYERS, Layer
from metagraph.suggest.body_points import NAMES
from metagraph.suggest.clip_measures import TYPICAL, nothing
from metagraph.suggest.stances import Shape, discover, likely
from metagraph.suggest.traits import LayerTraits, Traits

Array = NDArray[Any]

CARRIER: Layer = "arms"  # the layer that moves the whole body where all of it was recorded together
# How much farther than the carrier's points another layer's count: another stance of the trunk is smaller
SCALE: Mapping[Layer, float] = {layer: TYPICAL[CARRIER] / TYPICAL[layer] for layer in LAYERS}
TOGETHER = 0.5  # of the stances beside the most used one that differ in several layers, from which on all do
SETTLED = 0.4  # of all clips that begin and end in a stance, below which there are no stances to speak of
APART: Mapping[Layer, float] = {"arms": 0.012, "head": 0.006, "body": 0.006}  # heights; less is the same pose
WIDER = 4.0  # times the spread of its clips' ends that a stance of a layer is away at least


def carried(project: Project) -> bool:
    """Return whether the carrier's layer plays the whole body of a project."""
    return project.graphs[CARRIER].weight("legs") > 0


def whole_of(traits: Traits) -> Traits:
    """Return a clip's traits with the whole body's pose in the carrier's place, so that it is compared
    as one.

    The points of the other layers are scaled (see SCALE) so that a usual step from stance to stance is as
    long in each.
    """
    parts = [(traits.layers[layer], SCALE[layer]) for layer in LAYERS if traits.layers[layer].names]
    if not parts:
        return traits
    poses = {
        name: np.concatenate([getattr(x, name) * scale for x, scale in parts])
        for name in ("first", "last", "typical", "farthest", "low", "high")
    }
    far = max(parts, key=lambda p: p[0].extent * p[1])[0]
    fast = max(parts, key=lambda p: p[0].peak)[0]
    whole = LayerTraits(
        tuple(name for x, _ in parts for name in x.names),
        **poses,
        loop_error=max(x.loop_error * scale for x, scale in parts),
        steady=fast.steady,
        extent=max(x.extent * scale for x, scale in parts),
        extent_at=far.extent_at,
        energy=fast.energy,
        peak=fast.peak,
        peak_at=fast.peak_at,
        stroke_at=fast.stroke_at,
        rest=min(x.rest for x, _ in parts),
        bouts=fast.bouts,
    )
    return replace(traits, layers={**traits.layers, CARRIER: whole})


def recorded_whole(traits: Mapping[str, Traits]) -> bool:
    """Return whether stances of several layers change together in these clips: whole-body recordings.

    Clips of single layers keep the others where they are; of whole-body takes hardly one does.
    """
    moving = {
        clip: whole_of(t)
        for clip, t in traits.items()
        if t.face == 0 and not nothing(t) and all(t.layers[layer].names for layer in ("arms", "body"))
    }
    shapes = discover(moving, CARRIER, together=True)
    held = {id(shape): 0.0 for shape in shapes}
    for t in moving.values():
        x = t.layers[CARRIER]
        begins, ends = (likely(shapes, x.names, pose) for pose in (x.first, x.last))
        if begins and ends and min(begins[0][0], ends[0][0]) > 0.5:
            held[id(begins[0][1])] += 0.5
            held[id(ends[0][1])] += 0.5
    if len(shapes) < 2 or sum(held.values()) < SETTLED * len(moving):
        return False  # cut from longer takes, or poses to look at: nobody stands anywhere
    first = shapes[0]
    weight = several = 0.0
    for shape in shapes[1:]:
        apart = {layer for layer in LAYERS if _apart(first, shape, layer)}
        weight += held[id(shape)]
        several += held[id(shape)] * ({"arms", "body"} <= apart)
    return weight >= 1 and several >= TOGETHER * weight


def _apart(one: Shape, other: Shape, layer: Layer) -> bool:
    """Return whether two stances of the whole body differ in a layer, beyond what its clips' ends do."""
    rows = [n for n, name in enumerate(one.names) if name in NAMES[layer]]
    if not rows or one.names != other.names:
        return False
    away = np.linalg.norm(one.poses[0][rows] - other.poses[0][rows], axis=-1) / SCALE[layer]
    spread = np.maximum(one.spread[rows], other.spread[rows]) / SCALE[layer]
    return bool(np.any(away > np.maximum(APART[layer], WIDER * spread)))
