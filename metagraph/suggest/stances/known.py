"""What stances look like, known or discovered.

Discovering: the poses in which clips rest, begin and end are joined nearest first (average linkage) until the
next step is the widest; a group that several clips share, or that a resting clip holds, is a stance.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.graph.model import Project
from metagraph.graph.words import KINDS, LAYERS, Layer
from metagraph.suggest.clip_measures import (
    HELD,
    SUREST,
    compute_energy,
    compute_resting_logit,
    guess_layer,
    has_no_measures,
    is_walk,
)
from metagraph.suggest.traits import LayerTraits, Traits

Array = NDArray[Any]

SAME: Mapping[Layer, tuple[float, float]] = {
    "arms": (0.02, 0.08),
    "head": (0.008, 0.025),
    "body": (0.008, 0.025),
}
NEAR: Mapping[Layer, float] = {"arms": 0.008, "head": 0.003, "body": 0.003}  # heights within which ends meet
# Heights within which one of too many stances is another's, as far as it takes: up to 17 cm of one 1.7 m tall
ALIKE = (0.03, 0.057, 0.075, 0.1)
USABLE = 9  # stances of a layer, up to which all are kept
STRAY = 0.002  # of the weight an end has that lies in a stance, of one that lies in none
FINGERTIP = 0.5  # how much a fingertip's place counts beside the hand's
MOST = 400  # poses joined at once; more are thinned out first
EXACT = 0.5  # of the limits within which ends are of one stance, where they meet exactly
STANDS = 0.3  # of the usual way from stance to stance, within which an end is of one
SETTLED = 0.4  # of all ends that are of a stance, below which there are no stances to speak of
FEW = 3  # clips that begin and end in a pose, from which on the quietest of them is taken for its loop
SCARCE = 0.05  # of all clips, below which a pose that some begin and end in is no stance but theirs alone
QUIET = 0.6  # of their median energy
# heights a second, of all parts together, that the only clip which stays in a pose moves at most to be its
# loop
CALM = 0.3


@dataclass(frozen=True, eq=False)
class Shape:
    """What a stance looks like. id, name: of the project's stance; of one discovered, "" and its
    representative clip.

    names: points, n. poses `[k, n, 3]`, heights. members: clips that rest, begin or end in it. clip, at: a
    clip and the second in which it can be seen. confidence: 0..1, that it is one. calm: energy of the clip
    that is taken for its loop as the quietest; 0 where one rests, or none is. spread `[n]`: how far half of
    its clips' ends are from it, heights; empty if that is not known.
    """

    id: str
    name: str
    layer: Layer
    names: tuple[str, ...]
    poses: Array
    members: tuple[str, ...]
    clip: str
    at: float
    confidence: float
    calm: float = 0.0
    spread: Array = field(default_factory=lambda: np.zeros(0))

    @cached_property
    def scale(self) -> float:
        """Return how far an end that belongs to it usually is, heights: see `rank_likely_stances`."""
        widest = float(self.spread.max(initial=0.0))
        return min(max(NEAR[self.layer], 2.0 * widest), 3.0 * NEAR[self.layer])


Stances = Mapping[Layer, Sequence[Shape]]


def list_known_stances(project: Project, traits: Mapping[str, Traits]) -> dict[Layer, tuple[Shape, ...]]:
    """Return the stances that a project has, the most used first, as their loops show them; those without as
    transitions end in them.
    """
    out: dict[Layer, tuple[Shape, ...]] = {}
    for layer in LAYERS:
        graph, shapes = project.graphs[layer], []
        for stance in graph.stances.values():
            loops = [
                (a.clip, traits[a.clip].layers[layer])
                for a in graph.of(stance.id, "stance")
                if a.clip in traits
            ]
            found = [(clip, 0.0, pose) for clip, x in loops for pose in (x.first, x.typical)]
            if not loops:
                found = [
                    (a.clip, traits[a.clip].duration, traits[a.clip].layers[layer].last)
                    for a in graph.into.get(stance.id, ())
                    if a.clip in traits
                ]
            shape = _shape(stance.id, stance.name, layer, found, traits)
            if shape is not None:
                used = sum(len(graph.of(stance.id, kind)) for kind in KINDS)
                shapes.append((used, shape))
        out[layer] = tuple(shape for _, shape in sorted(shapes, key=lambda x: -x[0]))
    return out


def _shape(
    ident: str,
    name: str,
    layer: Layer,
    found: Sequence[tuple[str, float, Array]],
    traits: Mapping[str, Traits],
) -> Shape | None:
    if not found:
        return None
    clip, at, first = found[0]
    names = traits[clip].layers[layer].names
    poses = np.array([p for c, _, p in found if traits[c].layers[layer].names == names])
    if not names or not len(first):
        return None
    return Shape(
        ident, name, layer, names, poses, tuple(dict.fromkeys(c for c, _, _ in found)), clip, at, 1.0
    )


def measure_distance_from_stance(shape: Shape, names: tuple[str, ...], pose: Array) -> float:
    """Return how far a pose `[n, 3]` is from a stance: of the farthest point, heights; infinite where they
    share none.
    """
    if names == shape.names:
        return _measure_nearest([shape.poses], names, pose)[0]
    shared = tuple(n for n in names if n in shape.names)
    if not shared:
        return float("inf")
    theirs = shape.poses[:, [shape.names.index(n) for n in shared]]
    return _measure_nearest([theirs], shared, pose[[names.index(n) for n in shared]])[0]


def rank_stances(shapes: Sequence[Shape], names: tuple[str, ...], pose: Array) -> list[tuple[float, Shape]]:
    """Return the stances with how far a pose is from them, heights, the nearest first."""
    alike = [shape.poses for shape in shapes if shape.names == names]
    each = iter(_measure_nearest(alike, names, pose))
    found = [
        (next(each) if shape.names == names else measure_distance_from_stance(shape, names, pose), shape)
        for shape in shapes
    ]
    return sorted((x for x in found if x[0] < float("inf")), key=lambda x: x[0])


def _measure_nearest(groups: Sequence[Array], names: tuple[str, ...], pose: Array) -> list[float]:
    """Return how far a pose `[n, 3]` is from the nearest of each group of poses `[k, n, 3]`, of its farthest
    point.
    """
    if not groups:
        return []
    starts = np.cumsum([0, *(len(poses) for poses in groups[:-1])])
    away = (np.linalg.norm(np.concatenate(groups) - pose, axis=-1) * _weights(names)).max(-1)
    return [float(least) for least in np.minimum.reduceat(away, starts)]


def rank_likely_stances(
    shapes: Sequence[Shape], names: tuple[str, ...], pose: Array
) -> list[tuple[float, Shape]]:
    """Return the stances a pose `[n, 3]` may be of with how likely each is, the likeliest first; what is left
    to 1 is that it is of none.

    Student's t with three degrees of freedom over distances in the stance's own scale: ends of takes mostly
    meet, and some lie far off.
    """
    weights = [
        ((1 + (away / shape.scale) ** 2 / 3) ** -2, shape)
        for away, shape in rank_stances(shapes, names, pose)
    ]
    whole = sum(w for w, _ in weights) + STRAY
    return sorted(((w / whole, shape) for w, shape in weights), key=lambda x: -x[0])


def _weights(names: Sequence[str]) -> Array:
    return np.array([FINGERTIP if n.endswith("_tip") else 1.0 for n in names])


# -- discovering
# --------------------------------------------------------------------------------------------------


def discover(traits: Mapping[str, Traits], layer: Layer, together: bool = False) -> tuple[Shape, ...]:
    """Return the stances that clips of a layer rest, begin and end in, the one with the most members
    first. together: all clips are of the layer (see `whole_body`).
    """
    moving = {
        clip: t
        for clip, t in sorted(traits.items())
        if not (0 < t.duration < HELD and has_no_measures(t)) and not is_walk(t)
    }
    mine = {
        clip: t
        for clip, t in moving.items()
        if t.layers[layer].names and (t.face == 0 if together else guess_layer(t).value == layer)
    }
    if not mine:
        return ()
    others = {clip: t for clip, t in moving.items() if clip not in mine and t.face == 0}
    still = {clip: t for clip, t in others.items() if compute_resting_logit(t) > 0}
    several = [t.layers[layer].names for t in mine.values()]
    names = max(set(several), key=lambda n: (several.count(n), n))
    found: list[tuple[str, float, Array, bool]] = []
    for clip, t in mine.items():
        x = t.layers[layer]
        if x.names != names:
            continue
        rests = compute_resting_logit(t) > 0
        # Where a loop begins is where transitions end; its middle is away by as much as it breathes.
        found.append((clip, 0.0, x.first, rests))
        if not rests:
            found.append((clip, t.duration, x.last, False))
    poses = np.array([pose for _, _, pose, _ in found])
    groups = _groups(poses, _weights(names), *_limits(poses, [c for c, *_ in found], _weights(names), layer))
    shapes = []
    for rows in groups:
        members = list(dict.fromkeys(found[i][0] for i in rows))
        loops = [i for i in rows if found[i][3]]
        if not loops and len(members) < (2 if _passed(rows, groups, found) else max(2, SCARCE * len(mine))):
            continue
        middle = np.median(poses[rows], axis=0)
        best = min(loops or rows, key=lambda i: (float(np.linalg.norm(poses[i] - middle)), i))
        calm = 0.0
        closed = [i for i, j in pairwise(rows) if found[i][0] == found[j][0]]
        if not loops and any(
            _far(t.layers[layer], "first", middle, names) <= SAME[layer][0] for t in still.values()
        ):
            closed = []  # one of another layer rests here, so none of this one is its loop
        elif (
            not loops and len(closed) >= FEW
        ):  # the quietest of what begins and ends there is its loop, if much quieter than the others
            quiet = {i: compute_energy(mine[found[i][0]]) for i in closed}
            first = min(closed, key=lambda i: (quiet[i], i))
            if quiet[first] < QUIET * float(np.median([*quiet.values()])):
                best, calm = first, quiet[first]
        elif (
            not loops
            and len(closed) == 1
            and len(members) > 1
            and compute_energy(mine[found[closed[0]][0]]) < CALM
        ):
            best, calm = (
                closed[0],
                compute_energy(mine[found[closed[0]][0]]),
            )  # others only come there or leave: what stays is its loop
        poses_of = np.array([middle, *(mine[found[i][0]].layers[layer].typical for i in loops)])
        clip, at = found[best][0], found[best][1]
        if (
            not loops and not closed
        ):  # others only come or leave; a clip of another layer may rest here: of the arms of one who sits
            away = {
                c: max(_far(t.layers[layer], pose, middle, names) for pose in ("first", "last"))
                for c, t in others.items()
            }
            staying = {
                c: compute_energy(t)
                for c, t in others.items()
                if away[c] <= SAME[layer][1] and compute_energy(t) < CALM
            }
            if staying:
                clip, at = min(staying, key=lambda c: (staying[c], c)), 0.0
                calm = staying[clip]
                members.append(clip)
        confidence = min(SUREST, 1 - 0.6 * 0.8 ** len(members) + (0.0 if loops else 0.1 if calm else -0.15))
        spread = np.median(np.linalg.norm(poses[rows] - middle, axis=-1), axis=0)
        shapes.append(
            Shape("", clip, layer, names, poses_of, tuple(members), clip, at, confidence, calm, spread)
        )
    return tuple(sorted(shapes, key=lambda s: (-len(s.members), s.clip)))


def join_surplus_stances(shapes: Sequence[Shape], clips: int) -> tuple[Shape, ...]:
    """Return discovered stances; of more than a person can use, those that few of so many clips are in become
    one with a stance that they look like: takes of a day stand a little differently each time.
    """
    kept, scarce = tuple(shapes), SCARCE * clips
    for reach in ALIKE:
        if len(kept) <= USABLE:
            break
        kept = _joined_within(reach, kept, scarce)
    return kept


def _joined_within(reach: float, shapes: Sequence[Shape], scarce: float) -> tuple[Shape, ...]:
    kept: list[Shape] = []
    for shape in shapes:
        away = [(measure_distance_from_stance(s, shape.names, shape.poses[0]), n) for n, s in enumerate(kept)]
        least, nearest = min(away, default=(float("inf"), -1))
        if least > reach or len(shape.members) > max(1.0, scarce):
            kept.append(shape)
            continue
        one = kept[nearest]
        members = tuple(dict.fromkeys((*one.members, *shape.members)))
        kept[nearest] = replace(one, members=members, poses=np.concatenate([one.poses, shape.poses]))
    return tuple(sorted(kept, key=lambda s: (-len(s.members), s.clip)))


Ends = Sequence[tuple[str, float, Array, str]]  # clip, second, pose there, and what its name says of it


def settle_stances(
    shapes: Sequence[Shape], ends: Sequence[tuple[tuple[str, ...], Array]]
) -> tuple[Shape, ...]:
    """Return the discovered stances; only the first where clips begin and end anywhere, as those do that are
    cut from longer takes: then there is nothing to tell stances by. ends: names and poses.
    """
    if len(shapes) < 2:
        return tuple(shapes)
    weights = _weights(shapes[0].names)
    apart = _apart(np.array([shape.poses[0] for shape in shapes]), weights)
    usual = float(np.median(apart[np.triu_indices(len(shapes), 1)]))
    near = [
        found[0][0] < STANDS * usual for names, pose in ends if (found := rank_stances(shapes, names, pose))
    ]
    return tuple(shapes) if sum(near) >= SETTLED * len(near) else tuple(shapes[:1])


def split_stances(shapes: Sequence[Shape], ends: Ends) -> tuple[Shape, ...]:
    """Return discovered stances, those parted in which clips of different words have different poses: "idle
    1" and "idle 2" that stand close by. ends: first and last poses that names speak of.
    """
    out: list[Shape] = []
    mine: dict[int, dict[str, list[tuple[str, float, Array]]]] = {id(shape): {} for shape in shapes}
    for clip, at, pose, word in ends:
        found = (
            rank_likely_stances(shapes, shapes[0].names, pose) if len(pose) == len(shapes[0].names) else []
        )
        if found and found[0][0] > 0.5:
            mine[id(found[0][1])].setdefault(word, []).append((clip, at, pose))
    for shape in shapes:
        weights = _weights(shape.names)
        parts: list[tuple[Array, float, list[tuple[str, float, Array]]]] = []
        for some in mine[id(shape)].values():
            poses = np.array([pose for *_, pose in some])
            middle = np.median(poses, axis=0)
            spread = float(np.median((np.linalg.norm(poses - middle, axis=-1) * weights).max(-1)))
            spread /= len(some) ** 0.5  # how far off the middle itself may be
            if len(some) >= 2:
                parts.append((middle, spread, some))
        apart = len(parts) > 1 and all(
            (np.linalg.norm(one[0] - other[0], axis=-1) * weights).max()
            > max(NEAR[shape.layer], 3 * max(one[1], other[1]))
            for n, one in enumerate(parts)
            for other in parts[:n]
        )
        if not apart:
            out.append(shape)
            continue
        for middle, _, some in parts:
            poses = np.array([pose for *_, pose in some])
            best = min(some, key=lambda x: (float(np.linalg.norm(x[2] - middle)), x[0]))
            members = tuple(dict.fromkeys(clip for clip, *_ in some))
            out.append(
                replace(
                    shape,
                    name=best[0],
                    poses=middle[None],
                    members=members,
                    clip=best[0],
                    at=best[1],
                    spread=np.median(np.linalg.norm(poses - middle, axis=-1), axis=0),
                )
            )
    return tuple(out)


def _passed(
    rows: Sequence[int], groups: Sequence[Sequence[int]], found: Sequence[tuple[str, float, Array, bool]]
) -> bool:
    """Whether a clip comes to a group of ends from another one, or leaves for it: then somebody stands there
    for a while, though few clips show it.
    """
    here = {found[i][0] for i in rows}
    return any(
        len(other) > 1 and here & {found[i][0] for i in other} for other in groups if other is not rows
    )


def _far(x: LayerTraits, pose: str, middle: Array, names: tuple[str, ...]) -> float:
    """Return how far a clip's first or last pose is from a stance's, heights; infinite of another figure."""
    if x.names != names:
        return float("inf")
    return float((np.linalg.norm(getattr(x, pose) - middle, axis=-1) * _weights(names)).max())


def discover_stances(traits: Mapping[str, Traits]) -> dict[Layer, tuple[Shape, ...]]:
    """Return what `discover` finds on each layer."""
    return {layer: discover(traits, layer) for layer in LAYERS}


def _limits(poses: Array, clips: Sequence[str], weights: Array, layer: Layer) -> tuple[float, float]:
    """Return between which distances stances are distinguished, heights: those of SAME, less where the ends
    of most clips meet as exactly as only one pose does.

    How exactly: of four ends, the nearest end of another clip is no farther for three.
    """
    least, most = SAME[layer]
    if len(set(clips)) < FEW:
        return least, most
    some = np.unique(np.linspace(0, len(poses) - 1, min(len(poses), MOST)).astype(int))
    apart = _apart(poses[some], weights)
    owner = np.array(clips)[some]
    apart[owner[:, None] == owner[None, :]] = np.inf
    near = apart.min(1)
    tight = float(np.quantile(near[np.isfinite(near)], 0.75)) if np.isfinite(near).any() else least
    share = min(1.0, max(EXACT, 4 * tight / least))
    return least * share, max(most * share, least * share * 2)


def _apart(poses: Array, weights: Array) -> Array:
    """Return `[N, N]` how far poses `[N, n, 3]` are apart."""
    out = np.zeros((len(poses), len(poses)))
    for n, weight in enumerate(weights):
        np.maximum(out, weight * np.linalg.norm(poses[:, None, n] - poses[None, :, n], axis=-1), out=out)
    return out


def _groups(poses: Array, weights: Array, least: float, most: float) -> list[list[int]]:
    """Return groups of rows: joined by average linkage up to the widest step between `least` and `most`."""
    leaders, of = _thinned(poses, weights, least / 4)
    apart = _apart(poses[leaders], weights)
    np.fill_diagonal(apart, np.inf)
    size = np.bincount(of, minlength=len(leaders)).astype(float)
    joined: list[tuple[float, int, int]] = []
    for _ in range(len(leaders) - 1):
        a, b = sorted(divmod(int(np.argmin(apart)), len(leaders)))
        joined.append((float(apart[a, b]), a, b))
        row = (size[a] * apart[a] + size[b] * apart[b]) / (size[a] + size[b])
        apart[a], apart[:, a] = row, row
        apart[a, a] = np.inf
        apart[b], apart[:, b] = np.inf, np.inf
        size[a] += size[b]
    steps = np.array([least, *(h for h, _, _ in joined if least < h < most), most])
    cut = int(np.argmax(np.diff(np.log(np.sort(steps)))))
    limit = float(np.sort(steps)[cut])
    group = np.arange(len(leaders))
    for height, a, b in joined:
        if height <= limit:
            group[group == group[b]] = group[a]
    rows = group[of]
    return [np.flatnonzero(rows == g).tolist() for g in dict.fromkeys(rows.tolist())]


def _thinned(poses: Array, weights: Array, reach: float) -> tuple[list[int], Array]:
    """Return rows of which every other is within reach, at most MOST, and for each row its nearest of
    them.
    """
    while True:
        leaders: list[int] = []
        of = np.zeros(len(poses), int)
        for i, pose in enumerate(poses):
            if leaders:
                away = (np.linalg.norm(poses[leaders] - pose, axis=-1) * weights).max(-1)
                of[i] = int(np.argmin(away))
                if away[of[i]] <= reach:
                    continue
            if len(leaders) == MOST:
                break
            of[i] = len(leaders)
            leaders.append(i)
        else:
            return leaders, of
        reach *= 1.5
