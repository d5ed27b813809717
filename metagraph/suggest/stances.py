"""What stances look like, known or discovered; and what a clip seems to be beside them.

Discovering: the poses in which clips rest, begin and end are joined nearest first (average linkage) until the next step is the widest;
a group that several clips share, or that a resting clip holds, is a stance.
Guessing: a transition ends elsewhere than it begins, a stance rests for long, a gesture goes out, holds and comes back with the head
and trunk along, a fidget is small, busy, or touches the character itself.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import exp, log
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.graph.model import Project
from metagraph.graph.words import KINDS, LAYERS, Kind, Layer, Limb
from metagraph.suggest.belief import Belief
from metagraph.suggest.traits import LayerTraits, Traits

Array = NDArray[Any]

TYPICAL: Mapping[Layer, float] = {"arms": 0.12, "head": 0.04, "body": 0.03}  # heights that another stance is away, about
SAME: Mapping[Layer, tuple[float, float]] = {"arms": (0.02, 0.08), "head": (0.008, 0.025), "body": (0.008, 0.025)}
FINGERTIP = 0.5  # how much a fingertip's place counts beside the hand's
MOST = 400  # poses joined at once; more are thinned out first
FEW = 3  # clips that begin and end in a pose, from which on the quietest of them is taken for its loop
QUIET = 0.6  # of their median energy
HELD = 1.0  # seconds in which nothing moves, from which on that is a pose to stand in
ALONE = 0.5  # of the arms' energy on one side more than on the other, from which it is one-armed
# How often such a guess is right at most: motion alone cannot tell a small gesture from a large fidget.
SUREST = 0.95


@dataclass(frozen=True, eq=False)
class Shape:
    """What a stance looks like. id, name: of the project's stance; of one discovered, "" and its representative clip.

    names: points, n. poses `[k, n, 3]`, heights. members: clips that rest, begin or end in it. clip, at: a clip and the second in
    which it can be seen. confidence: 0..1, that it is one. calm: energy of the clip that is
    taken for its loop as the quietest; 0 where one rests, or none is.
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


Stances = Mapping[Layer, Sequence[Shape]]


@dataclass(frozen=True)
class MotionGuess:
    """What a clip seems to be; None where the motion says nothing. stance, end_stance: of a `Shape`; the end stance of transitions only.
    runner_up: the next nearest stance. stroke: seconds. chances: of each kind, adding up to 1."""

    kind: Belief[Kind]
    layer: Belief[Layer]
    limb: Belief[Limb]
    loop: Belief[bool]
    stance: Belief[Shape] | None = None
    end_stance: Belief[Shape] | None = None
    runner_up: Shape | None = None
    stroke: Belief[float] | None = None
    chances: Mapping[Kind, float] | None = None


def known(project: Project, traits: Mapping[str, Traits]) -> dict[Layer, tuple[Shape, ...]]:
    """Return the stances that a project has, the most used first, as their loops show them; those without as transitions end in them."""
    out: dict[Layer, tuple[Shape, ...]] = {}
    for layer in LAYERS:
        graph, shapes = project.graphs[layer], []
        for stance in graph.stances.values():
            loops = [(a.clip, traits[a.clip].layers[layer]) for a in graph.of(stance.id, "stance") if a.clip in traits]
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


def _shape(ident: str, name: str, layer: Layer, found: Sequence[tuple[str, float, Array]], traits: Mapping[str, Traits]) -> Shape | None:
    if not found:
        return None
    clip, at, first = found[0]
    names = traits[clip].layers[layer].names
    poses = np.array([p for c, _, p in found if traits[c].layers[layer].names == names])
    if not names or not len(first):
        return None
    return Shape(ident, name, layer, names, poses, tuple(dict.fromkeys(c for c, _, _ in found)), clip, at, 1.0)


def distance(shape: Shape, names: tuple[str, ...], pose: Array) -> float:
    """Return how far a pose `[n, 3]` is from a stance: of the farthest point, heights; infinite where they share none."""
    if names == shape.names:
        mine, theirs = pose, shape.poses
    else:
        shared = [n for n in names if n in shape.names]
        if not shared:
            return float("inf")
        mine, theirs = pose[[names.index(n) for n in shared]], shape.poses[:, [shape.names.index(n) for n in shared]]
        names = tuple(shared)
    return float((np.linalg.norm(theirs - mine, axis=-1) * _weights(names)).max(-1).min())


def nearest(shapes: Sequence[Shape], names: tuple[str, ...], pose: Array) -> list[tuple[float, Shape]]:
    """Return the stances with how far a pose is from them, heights, the nearest first."""
    found = [(distance(shape, names, pose), shape) for shape in shapes]
    return sorted((x for x in found if x[0] < float("inf")), key=lambda x: x[0])


def _weights(names: Sequence[str]) -> Array:
    return np.array([FINGERTIP if n.endswith("_tip") else 1.0 for n in names])


# -- discovering ----------------------------------------------------------------------------------------------------------------------


def discover(traits: Mapping[str, Traits], layer: Layer) -> tuple[Shape, ...]:
    """Return the stances that clips of a layer rest, begin and end in, the one with the most members first."""
    moving = {clip: t for clip, t in sorted(traits.items()) if not (0 < t.duration < HELD and _nothing(t))}
    mine = {clip: t for clip, t in moving.items() if t.layers[layer].names and layer_of(t).value == layer}
    if not mine:
        return ()
    several = [t.layers[layer].names for t in mine.values()]
    names = max(set(several), key=lambda n: (several.count(n), n))
    found: list[tuple[str, float, Array, bool]] = []
    for clip, t in mine.items():
        x = t.layers[layer]
        if x.names != names:
            continue
        rests = _resting(t) > 0
        found.append((clip, 0.0, x.typical if rests else x.first, rests))
        if not rests:
            found.append((clip, t.duration, x.last, False))
    poses = np.array([pose for _, _, pose, _ in found])
    groups = _groups(poses, _weights(names), *SAME[layer])
    shapes = []
    for rows in groups:
        members = list(dict.fromkeys(found[i][0] for i in rows))
        loops = [i for i in rows if found[i][3]]
        if len(members) < 2 and not loops:
            continue
        middle = np.median(poses[rows], axis=0)
        best = min(loops or rows, key=lambda i: (float(np.linalg.norm(poses[i] - middle)), i))
        calm = 0.0
        closed = [i for i, j in pairwise(rows) if found[i][0] == found[j][0]]
        if not loops and len(closed) >= FEW:  # the quietest of what begins and ends there is its loop, if much quieter than the others
            quiet = {i: _energy(mine[found[i][0]]) for i in closed}
            first = min(closed, key=lambda i: (quiet[i], i))
            if quiet[first] < QUIET * float(np.median([*quiet.values()])):
                best, calm = first, quiet[first]
        confidence = min(SUREST, 1 - 0.6 * 0.8 ** len(members) - (0 if loops else 0.15))
        poses_of = np.array([middle, *(poses[i] for i in loops)])
        clip, at = found[best][0], found[best][1]
        shapes.append(Shape("", clip, layer, names, poses_of, tuple(members), clip, at, confidence, calm))
    return tuple(sorted(shapes, key=lambda s: (-len(s.members), s.clip)))


def discovered(traits: Mapping[str, Traits]) -> dict[Layer, tuple[Shape, ...]]:
    """Return what `discover` finds on each layer."""
    return {layer: discover(traits, layer) for layer in LAYERS}


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
    """Return rows of which every other is within reach, at most MOST, and for each row its nearest of them."""
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


# -- guessing -------------------------------------------------------------------------------------------------------------------------


def guess(traits: Traits, stances: Stances) -> MotionGuess:
    """Return what a clip seems to be from its motion alone, beside known or discovered stances (none will do)."""
    layer = _layer_beside(traits, stances)
    x = traits.layers[layer.value]
    shapes = stances.get(layer.value, ())
    starts, ends = nearest(shapes, x.names, x.first), nearest(shapes, x.names, x.last)
    moved = _sigmoid(_moving(traits, layer.value, starts, ends))
    calm = starts[0][1].calm if starts and starts[0][0] < 0.5 * TYPICAL[layer.value] else 0.0
    resting = _resting(traits) + (3.0 if _energy(traits) <= 1.05 * calm else 0.0)
    rest, gesture = _sigmoid(resting), _sigmoid(_telling(traits, layer.value))
    chances: dict[Kind, float] = {
        "transition": moved,
        "stance": (1 - moved) * rest,
        "gesture": (1 - moved) * (1 - rest) * gesture,
        "fidget": (1 - moved) * (1 - rest) * (1 - gesture),
    }
    kind = max(chances, key=lambda k: chances[k])
    cm = 100 * traits.height
    reason = {
        "transition": f"ends {x.loop_error * cm:.1f} cm from where it begins and goes only {x.extent * cm:.0f} cm beside that way",
        "stance": f"moves at most {max(y.peak for y in traits.layers.values()) * cm:.0f} cm/s in {traits.duration:.1f} s",
        "gesture": f"goes {x.extent * cm:.0f} cm away and comes back, in {_times(x.bouts)}, up to {x.peak * cm:.0f} cm/s",
        "fidget": f"goes {x.extent * cm:.0f} cm away in {_times(x.bouts)}, up to {x.peak * cm:.0f} cm/s" + _touching(traits, cm),
    }[kind]
    if kind == "stance":
        starts = nearest(shapes, x.names, x.typical)
    return MotionGuess(
        Belief(kind, min(SUREST, chances[kind], (1 + layer.confidence) / 2), reason),
        layer,
        limb_of(traits, layer.value, kind),
        Belief(kind == "stance", min(SUREST, chances[kind]), f"its ends are {x.loop_error * cm:.1f} cm apart"),
        _beside(starts, "begins" if kind != "stance" else "rests", layer, cm),
        _beside(ends, "ends", layer, cm) if kind == "transition" else None,
        starts[1][1] if len(starts) > 1 else None,
        _stroke(x, cm) if kind in ("gesture", "fidget") and x.peak > 0 else None,
        chances,
    )


def _times(bouts: int) -> str:
    return "1 movement" if bouts == 1 else f"{bouts} movements"


def _touching(traits: Traits, cm: float) -> str:
    return f", and a hand comes {traits.touch * cm:.0f} cm nearer to touch the other arm or the head" if traits.touch > 0.03 else ""


def _stroke(x: LayerTraits, cm: float) -> Belief[float]:
    again = x.peak_at == x.stroke_at
    return Belief(x.stroke_at, 0.8 if again else 0.6, f"fastest on the way out at {x.stroke_at:.2f} s of {x.peak * cm:.0f} cm/s")


def _sigmoid(z: float) -> float:
    return 1 / (1 + exp(-min(max(z, -30.0), 30.0)))


def _beside(found: Sequence[tuple[float, Shape]], verb: str, layer: Belief[Layer], cm: float) -> Belief[Shape] | None:
    if not found:
        return None
    (near, shape), typical = found[0], TYPICAL[layer.value]
    second = found[1][0] if len(found) > 1 else None
    margin = 1.0 if second is None else (second - near) / max(second, 1e-9)
    confidence = SUREST * exp(-((near / typical) ** 2)) * (0.4 + 0.6 * min(1.0, 1.5 * margin))
    more = "" if second is None else f"; next nearest {_cm(second * cm)}"
    return Belief(shape, min(confidence, shape.confidence, layer.confidence), f'{verb} {_cm(near * cm)} from "{shape.name}"{more}')


def _cm(length: float) -> str:
    return f"{length:.1f} cm" if length < 10 else f"{length:.0f} cm"


def layer_of(traits: Traits) -> Belief[Layer]:
    """Return which layer a clip moves: the body where hips or legs do, else the arms, else the head."""
    e, layers = traits.energy, traits.layers
    arms = e["left_arm"] + e["right_arm"] + e["fingers"]
    lower, upper = e["hips"] + e["legs"], e["head"] + e["trunk"]
    have = [layer for layer in ("body", "arms", "head") if layers[layer].names]
    if have == ["body"]:
        return Belief("body", SUREST, "the character has neither arms nor a head that are known")
    if arms + lower + upper < 1e-5:
        return Belief("body", 0.34, "nothing moves")
    body, hands = lower / (0.15 * upper + 0.25 * arms + 1e-6), arms / (0.1 * upper + 1e-6)
    share = f"hips and legs {lower * 100:.1f}, arms {arms * 100:.1f}, head and trunk {upper * 100:.1f} % of the height a second"
    if body >= 1:
        return Belief("body", _tempered(body), f"hips and legs move: {share}")
    if hands >= 1 and "arms" in have:
        return Belief("arms", min(_tempered(hands), _tempered(1 / max(body, 1e-3))), f"the arms move, hips and legs do not: {share}")
    if "head" in have:
        return Belief("head", min(_tempered(1 / max(hands, 1e-3)), _tempered(1 / max(body, 1e-3))), f"only the head moves: {share}")
    return Belief("body", 0.5, share)


def _layer_beside(traits: Traits, stances: Stances) -> Belief[Layer]:
    """Return which layer a clip moves; of one that rests, the only layer whose pose is not the usual one, if there is."""
    found = layer_of(traits)
    if _resting(traits) < 0:
        return found
    unusual = []
    for layer in LAYERS:
        x, shapes = traits.layers[layer], stances.get(layer, ())
        if shapes and len(x.typical):
            away = distance(shapes[0], x.names, x.typical)
            if 0.5 * TYPICAL[layer] < away < float("inf"):
                unusual.append((layer, away))
    if len(unusual) == 1 and unusual[0][0] != found.value:
        layer, away = unusual[0]
        return Belief(layer, 0.7, f"rests {100 * traits.height * away:.0f} cm from the usual pose of the {layer}")
    return found


def _energy(traits: Traits) -> float:
    return sum(traits.energy.values())


def _nothing(traits: Traits) -> bool:
    return all(x.peak < 1e-3 for x in traits.layers.values()) and traits.energy["fingers"] < 1e-3


def _tempered(ratio: float) -> float:
    """Return how sure one is of a ratio above 1: half at 1, SUREST from 5 on."""
    return 0.5 + (SUREST - 0.5) * min(1.0, log(max(ratio, 1.0)) / log(5.0))


def limb_of(traits: Traits, layer: Layer, kind: Kind) -> Belief[Limb]:
    """Return the arm that a clip needs; of a head that goes to one side, the side."""
    if kind in ("stance", "transition"):
        return Belief("both", 0.9, f"a {kind} takes both arms")
    if layer == "arms":
        share = traits.symmetry
        limb: Limb = "both" if abs(share) < ALONE else "left" if share > 0 else "right"
        confidence = 0.5 + 0.45 * min(1.0, abs(abs(share) - ALONE) / 0.3)
        return Belief(
            limb, confidence, f"the left arm makes {50 * (1 + share):.0f} % of the arms' movement, the right {50 * (1 - share):.0f} %"
        )
    x = traits.layers["head"]
    if layer == "head" and "nose" in x.names:
        n = x.names.index("nose")
        left, right = float(x.high[n, 0] - x.first[n, 0]), float(x.first[n, 0] - x.low[n, 0])
        if max(left, right) > 0.02 and max(left, right) > 3 * min(left, right):
            side: Limb = "left" if left > right else "right"
            return Belief(side, 0.7, f"the nose goes {100 * traits.height * max(left, right):.0f} cm to the {side}")
    return Belief("both", 0.9, f"the {layer} moves, not one arm")


def _moving(traits: Traits, layer: Layer, starts: Sequence[tuple[float, Shape]], ends: Sequence[tuple[float, Shape]]) -> float:
    """Return how much speaks for a transition, a logit."""
    x = traits.layers[layer]
    if x.loop_error < 1e-6:
        return -10.0
    z = 3.0 * log(x.loop_error / (0.4 * TYPICAL[layer])) + 12.0 * (min(x.loop_error / (x.loop_error + x.extent), 0.5) - 0.3)
    if starts and ends:
        (_, here), (near, there) = starts[0], ends[0]
        back = next(d for d, shape in ends if shape is here)
        if there is not here and near < 0.5 * back:
            z += 2.0
        elif there is here and back < 0.5 * x.loop_error + 0.1 * TYPICAL[layer]:
            z -= 3.0
    return z


def _resting(traits: Traits) -> float:
    """Return how much speaks for a stance, a logit: little movement, for long, steady; ends that meet."""
    if traits.frames < 2 or traits.duration <= 0:
        return 3.0
    if _nothing(traits):  # held, or a clip of the face
        return 3.0 if traits.duration >= HELD else 0.0
    x = max(traits.layers.values(), key=lambda y: y.peak)
    fastest = max(x.peak, 3 * traits.energy["fingers"], 1e-3)
    apart = max(y.loop_error / TYPICAL[layer] for layer, y in traits.layers.items())
    return 3.0 * log(min(traits.duration / 3.5, 2.0)) - 1.5 * log(fastest / 0.05) + 3.0 * x.steady - 6.0 * max(0.0, apart - 0.3)


def _telling(traits: Traits, layer: Layer) -> float:
    """Return how much speaks for a gesture rather than a fidget, a logit.

    Weights: a logistic regression on the sample clips, rounded; lengths and speeds are in typical ones.
    """
    arms, head, body = (traits.layers[layer] for layer in ("arms", "head", "body"))
    bouts = max((arms, head, body), key=lambda y: y.peak).bouts
    nods, leans = _log(head.peak, 0.12), _log(body.peak, 0.1)
    busy = 1.0 if bouts > 2 else 0.0
    if layer == "arms":
        away = 1.9 * 5 * min(traits.out, 0.2) - 1.3 * 5 * min(traits.near, 0.2) - 1.55 * 10 * min(traits.touch, 0.1)
        return 3.5 + 1.1 * _log(arms.extent, 0.2) + 0.9 * leans + 1.15 * nods + away - 1.95 * busy
    if layer == "head":
        return 1.6 * nods + (2.7 if bouts == 1 else 0.0) + 2.7 * log(traits.duration + 0.1) - 0.3 * _log(head.extent, 0.03) - 2.0
    return 1.2 + 0.9 * nods + leans - 1.4 * _log(traits.energy["legs"] + traits.energy["hips"], 0.02) - 2.9 * busy


def _log(x: float, typical: float) -> float:
    return log(x / typical + 0.02)
