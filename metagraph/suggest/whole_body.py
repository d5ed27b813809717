"""Detect clips recorded with the whole body: their stances involve all layers together.

An additive layer holds what differs from the base pose. If arms, trunk and legs always change their stance
together, as in takes of somebody who sits down, every layer would add the same lean again. Then one layer,
the arms', carries the whole body: it holds all stances, transitions, gestures and fidgets, and plays them as
they were recorded.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import islice
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.graph.model import Project
from metagraph.graph.words import LAYERS, Layer
from metagraph.suggest.body_points import NAMES
from metagraph.suggest.clip_measures import TYPICAL, compute_resting_logit, guess_layer, has_no_measures
from metagraph.suggest.stances.known import SETTLED, Shape, discover, rank_likely_stances
from metagraph.suggest.traits import LayerTraits, Traits

Array = NDArray[Any]

CARRIER: Layer = "arms"  # the layer that moves the whole body if all of it was recorded together
# Factors for the distances of the layers' points, relative to the carrier's: stances of the trunk differ
# less.
SCALE: Mapping[Layer, float] = {layer: TYPICAL[CARRIER] / TYPICAL[layer] for layer in LAYERS}
# Of the clips that do not move a layer, the share that is in another than its usual pose: arms that gesture
# while the weight is on the other leg, a nod with crossed arms.
TOGETHER = 0.29
# The layers whose clips show that for a layer. A head moves along with arms, and with a trunk that leans.
BESIDE: Mapping[Layer, tuple[Layer, ...]] = {"body": ("arms", "head"), "arms": ("body", "head")}
CLEAR = 0.7  # confidence of the layer that a clip moves, from which on it counts
ENOUGH = 1000  # clips; of more, evenly chosen ones tell whether they were recorded so
FEW = 3  # clips of one stance from which on its name shows what is done in it
MIXED = 0.2  # share of those clips that move another layer than most of their stance
APART: Mapping[Layer, float] = {"arms": 0.02, "head": 0.012, "body": 0.01}  # heights; less is the same pose
WIDER = 4.0  # the least distance of a layer's stance, relative to the spread of its clips' ends


def is_whole_body_carried(project: Project) -> bool:
    """Return whether the carrier's layer plays the whole body of a project."""
    return project.graphs[CARRIER].weight("legs") > 0


def with_whole_body(traits: Traits) -> Traits:
    """Return a clip's traits with the whole body's pose in the carrier's place, so that it is compared as
    one.

    The points of the other layers are scaled (see SCALE) so that a usual step from stance to stance is
    equally long in each.
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
        flow=far.flow,
        turning=far.turning,
    )
    return replace(traits, layers={**traits.layers, CARRIER: whole})


def are_whole_body_recordings(traits: Mapping[str, Traits], named: Mapping[str, str] | None = None) -> bool:
    """Return whether these clips are recordings of the whole body, made in several stances. `named` maps
    clips to the stance that their names begin with.

    A clip of a single layer leaves the others in their usual pose. In takes of the whole body, arms gesture
    in every stance of the legs, and one stance's name precedes what arms, head and legs do.
    """
    return _named_whole(traits, named or {}) or _seen_whole(traits)


def _named_whole(traits: Mapping[str, Traits], named: Mapping[str, str]) -> bool:
    groups: dict[str, list[Layer]] = {}
    for clip, word in named.items():
        if clip in traits and traits[clip].face == 0 and not has_no_measures(traits[clip]):
            moved = guess_layer(traits[clip])
            if moved.confidence >= CLEAR:
                groups.setdefault(word, []).append(moved.value)
    several = [layers for layers in groups.values() if len(layers) >= FEW]
    mixed = sum(len(layers) - max(Counter(layers).values()) for layers in several)
    return len(several) > 1 and mixed > MIXED * sum(map(len, several))


def _seen_whole(traits: Mapping[str, Traits]) -> bool:
    moving = {
        clip: with_whole_body(t)
        for clip, t in traits.items()
        if t.face == 0 and not has_no_measures(t) and all(t.layers[layer].names for layer in ("arms", "body"))
    }
    moving = dict(islice(moving.items(), 0, None, 1 + len(moving) // ENOUGH))
    shapes = discover(moving, CARRIER, together=True)
    held: list[tuple[Shape, Layer]] = []  # stance and layer of clips that stay in a stance
    settled = 0
    for clip, t in moving.items():
        x = t.layers[CARRIER]
        begins, ends = (rank_likely_stances(shapes, x.names, pose) for pose in (x.first, x.last))
        if begins and ends and min(begins[0][0], ends[0][0]) > 0.5:
            settled += 1
            moved = guess_layer(traits[clip])
            if (
                begins[0][1] is ends[0][1]
                and moved.confidence >= CLEAR
                and compute_resting_logit(traits[clip]) < 0
            ):
                held.append((begins[0][1], moved.value))
    if len(shapes) < 2 or settled < SETTLED * len(moving):
        return False  # cut from longer takes, or poses to look at: nobody stands anywhere
    return any(_varies(layer, [shape for shape, moved in held if moved in BESIDE[layer]]) for layer in BESIDE)


def _varies(layer: Layer, held: Sequence[Shape]) -> bool:
    """Return whether clips that do not move a layer are recorded in several poses of it."""
    if len(held) < FEW:
        return False
    counts = Counter(map(id, held))
    usual = max(held, key=lambda shape: counts[id(shape)])
    return sum(1 for shape in held if _apart(usual, shape, layer)) > TOGETHER * len(held)


def _apart(one: Shape, other: Shape, layer: Layer) -> bool:
    """Return whether two stances of the whole body differ in a layer by more than the ends of its
    clips do.
    """
    rows = [n for n, name in enumerate(one.names) if name in NAMES[layer]]
    if not rows or one.names != other.names:
        return False
    away = np.linalg.norm(one.poses[0][rows] - other.poses[0][rows], axis=-1) / SCALE[layer]
    spread = np.maximum(one.spread[rows], other.spread[rows]) / SCALE[layer]
    return bool(np.any(away > np.maximum(APART[layer], WIDER * spread)))
