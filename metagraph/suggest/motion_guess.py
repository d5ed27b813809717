"""Guess what a clip is from its motion, beside known or discovered stances.

A transition ends elsewhere than it begins; a stance rests for long; a gesture goes out, holds and comes back,
with the head and trunk moving along; a fidget is small, busy, or touches the character itself.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from math import exp, log

from metagraph.common.wording import phrase, plural_phrase
from metagraph.graph.words import LAYERS, Kind, Layer, Limb
from metagraph.suggest.clip_measures import (
    HANGING,
    SUREST,
    TYPICAL,
    compute_energy,
    compute_resting_logit,
    find_layer_moving_most,
    guess_layer,
    is_walk,
)
from metagraph.suggest.estimate import Belief
from metagraph.suggest.stances.known import (
    Shape,
    Stances,
    measure_distance_from_stance,
    rank_likely_stances,
    rank_stances,
)
from metagraph.suggest.traits import LayerTraits, Traits

# of the way of a clip that ends in no other stance: the share from end to end from which on it is a
# transition
STRAIGHT = 0.65
ELSEWHERE = 0.1  # heights from the body's usual pose; resting clips beyond it are of the body: sitting, lying
LIFE = 0.11  # share of hips and legs in the movement of a resting clip; above it the whole body breathes
SMALL = 0.12  # heights the hands go, below which they say little
RETURNS = 4.0  # logit that the way of a clip counts for where its ends do not tell stances apart
ONLY = 0.85  # the least confidence of the stance if there is only one
CLEAREST = 0.99  # the confidence of the stance for a pose that is in it
NODS = 2.5  # seconds up to which a longer movement of the head is likelier a gesture
LOOKS_ROUND = 3.5  # seconds from which on it is the likelier a look round, the longer it lasts
ALONE = 0.5  # of the arms' energy, more on one side than on the other, from which on it is one-armed


Likely = Sequence[tuple[float, Shape]]


@dataclass(frozen=True)
class MotionGuess:
    """What a clip seems to be; None if the motion says nothing.

    `stance` and `end_stance` are `Shape`s; only transitions have an end stance. `runner_up` is the next
    nearest stance. `stroke` is in seconds. `chances` has the probability of each kind, adding up to 1.
    `begins` and `ends` say how likely the first and last pose are of each stance, the likeliest first; the
    remainder to 1 is for none of them.
    """

    kind: Belief[Kind]
    layer: Belief[Layer]
    limb: Belief[Limb]
    loop: Belief[bool]
    stance: Belief[Shape] | None = None
    end_stance: Belief[Shape] | None = None
    runner_up: Shape | None = None
    stroke: Belief[float] | None = None
    chances: Mapping[Kind, float] | None = None
    begins: Likely = ()
    ends: Likely = ()


def guess(
    traits: Traits,
    stances: Stances,
    on: Layer | None = None,
    posture: LayerTraits | None = None,
    cycle: bool = False,
) -> MotionGuess:
    """Return what a clip seems to be from its motion alone, beside known or discovered stances; there may be
    none. `on` is its layer, if that is known from elsewhere. `posture` has its poses in the form of the
    stances, if that is not the layer's (see `whole_body`). `cycle` says whether it is one cycle of a gesture.
    """
    layer = _layer_beside(traits, stances) if on is None else Belief(on, SUREST, "")
    x = traits.layers[layer.value]
    posed = x if posture is None else posture
    shapes = stances.get(layer.value, ())
    starts, ends = (
        rank_stances(shapes, posed.names, posed.first),
        rank_stances(shapes, posed.names, posed.last),
    )
    begins, leaves = (
        rank_likely_stances(shapes, posed.names, posed.first),
        rank_likely_stances(shapes, posed.names, posed.last),
    )
    moved = _passing(begins, leaves, _moving(posed, layer.value, starts, ends))
    calm = starts[0][1].calm if starts and starts[0][0] < 0.5 * TYPICAL[layer.value] else 0.0
    walking = is_walk(traits)
    rests = (
        1.0
        if walking
        else compute_resting_logit(traits) + (3.0 if compute_energy(traits) <= 1.05 * calm else 0.0)
    )
    moves = layer if posture is None else find_layer_moving_most(traits)
    x = traits.layers[moves.value]
    rest, gesture = _sigmoid(rests), _gesturing(traits, moves)
    if cycle:
        rest, gesture = 0.0, max(gesture, SUREST)
    chances: dict[Kind, float] = {
        "transition": moved,
        "stance": (1 - moved) * rest,
        "gesture": (1 - moved) * (1 - rest) * gesture,
        "fidget": (1 - moved) * (1 - rest) * (1 - gesture),
    }
    kind = max(chances, key=lambda k: chances[k])
    cm = 100 * traits.height
    reason: dict[Kind, str] = {
        "transition": phrase(
            "ends {apart:.1f} cm from its start, and strays only {aside:.0f} cm from the way between",
            apart=posed.loop_error * cm,
            aside=posed.extent * cm,
        ),
        "stance": phrase(
            "moves at no more than {speed:.0f} cm/s for {seconds:.1f} s",
            speed=max(y.peak for y in traits.layers.values()) * cm,
            seconds=traits.duration,
        )
        if not walking
        else phrase(
            "keeps walking or running: its feet pass each other by {stride:.0f} cm, "
            "and its end flows into its start",
            stride=traits.stride * cm,
        ),
        "gesture": phrase(
            "is one cycle: it ends as it begins, in a movement of {length:.0f} cm at up to {speed:.0f} cm/s",
            length=x.extent * cm,
            speed=x.peak * cm,
        )
        if cycle
        else phrase(
            "moves {length:.0f} cm away and back in {times}, at up to {speed:.0f} cm/s",
            length=x.extent * cm,
            times=_times(x.bouts),
            speed=x.peak * cm,
        ),
        "fidget": _touching(
            traits,
            cm,
            phrase(
                "moves {length:.0f} cm away in {times}, at up to {speed:.0f} cm/s",
                length=x.extent * cm,
                times=_times(x.bouts),
                speed=x.peak * cm,
            ),
        ),
    }
    return MotionGuess(
        Belief(kind, min(SUREST, chances[kind], (1 + layer.confidence) / 2), reason[kind]),
        layer,
        guess_limb_from_motion(traits, layer.value, kind),
        Belief(
            kind == "stance",
            min(SUREST, chances[kind]),
            phrase("its start and end are {apart:.1f} cm apart", apart=x.loop_error * cm),
        ),
        _beside(starts, begins, _begins if kind != "stance" else _rests, layer, cm),
        _beside(ends, leaves, _ends, layer, cm) if kind == "transition" else None,
        starts[1][1] if len(starts) > 1 else None,
        _stroke(x, cm) if kind in ("gesture", "fidget") and x.peak > 0 else None,
        chances,
        begins,
        leaves,
    )


def _times(bouts: int) -> str:
    return plural_phrase("{count:,} movement", "{count:,} movements", bouts)


def _touching(traits: Traits, cm: float, goes: str) -> str:
    if traits.touch <= 0.03:
        return goes
    return phrase(
        "{goes}, and a hand comes {length:.0f} cm nearer to touch the other arm or the head",
        goes=goes,
        length=traits.touch * cm,
    )


def _begins(length: str, stance: str) -> str:
    return phrase('begins {length} from "{stance}"', length=length, stance=stance)


def _rests(length: str, stance: str) -> str:
    return phrase('rests {length} from "{stance}"', length=length, stance=stance)


def _ends(length: str, stance: str) -> str:
    return phrase('ends {length} from "{stance}"', length=length, stance=stance)


def _stroke(x: LayerTraits, cm: float) -> Belief[float]:
    again = x.peak_at == x.stroke_at
    return Belief(
        x.stroke_at,
        0.8 if again else 0.6,
        phrase(
            "fastest on the way out, at {seconds:.2f} s with {speed:.0f} cm/s",
            seconds=x.stroke_at,
            speed=x.peak * cm,
        ),
    )


def _sigmoid(z: float) -> float:
    return 1 / (1 + exp(-min(max(z, -30.0), 30.0)))


def _beside(
    found: Sequence[tuple[float, Shape]],
    likely: Likely,
    said: Callable[[str, str], str],
    layer: Belief[Layer],
    cm: float,
) -> Belief[Shape] | None:
    if not found:
        return None
    (chance, shape) = likely[0]
    near = next(away for away, other in found if other is shape)
    second = min((away for away, other in found if other is not shape), default=None)
    words = said(_cm(near * cm), shape.name)
    if second is not None:
        words = phrase("{words}; the next nearest is {length} away", words=words, length=_cm(second * cm))
    sure = max(chance, ONLY) if second is None else chance  # if there is only one, all clips are in it
    return Belief(shape, min(CLEAREST * sure, layer.confidence), words)


def _passing(begins: Likely, ends: Likely, otherwise: float) -> float:
    """Return the probability that a clip passes from one stance to another. `otherwise` is the logit if it is
    unknown whether its ends are of stances. It also counts, by up to RETURNS, where stances are so close that
    the ends hardly say which they are of: a clip that goes far and comes back is none that passes.
    """
    same = sum(p * q for p, shape in begins for q, other in ends if shape is other)
    known = sum(p for p, _ in begins) * sum(p for p, _ in ends)
    unlike = min(1.0, max(0.0, (known - same) / known)) if known > 0 else 0.0
    doubt = 4 * unlike * (1 - unlike)
    if 0 < unlike < 1:
        unlike = _sigmoid(log(unlike / (1 - unlike)) + doubt * min(0.0, max(-RETURNS, otherwise)))
    return known * unlike + (1 - known) * _sigmoid(otherwise)


def _cm(length: float) -> str:
    return (
        phrase("{length:.1f} cm", length=length) if length < 10 else phrase("{length:.0f} cm", length=length)
    )


def _layer_beside(traits: Traits, stances: Stances) -> Belief[Layer]:
    """Return which layer a clip moves; for a resting clip, the only layer whose pose is unusual, if there is
    one.
    """
    found = guess_layer(traits)
    if is_walk(traits):
        return Belief(
            "body",
            SUREST,
            phrase("the feet pass each other by {stride:.0f} cm", stride=100 * traits.height * traits.stride),
        )
    if compute_resting_logit(traits) < 0 or traits.face > 1e-3:
        return found
    unusual: dict[Layer, float] = {}
    for layer in LAYERS:
        x, shapes = traits.layers[layer], stances.get(layer, ())
        if shapes and len(x.typical):
            away = measure_distance_from_stance(shapes[0], x.names, x.typical)
            if 0.5 * TYPICAL[layer] < away < float("inf"):
                unusual[layer] = away
    lower, all_of = traits.energy["hips"] + traits.energy["legs"], compute_energy(traits)
    if found.value != "body" and (
        ("body" in unusual and unusual["body"] > ELSEWHERE) or lower > LIFE * all_of
    ):
        return Belief(
            "body",
            0.75,
            _unusual("body", 100 * traits.height * unusual["body"])
            if "body" in unusual
            else phrase(
                "rests, and hips and legs do {share:.0f} % of the movement", share=100 * lower / all_of
            ),
        )
    if len(unusual) == 1 and found.value not in unusual:
        ((layer, away),) = unusual.items()
        return Belief(layer, 0.7, _unusual(layer, 100 * traits.height * away))
    return found


def _unusual(layer: Layer, length: float) -> str:
    if layer == "body":
        return phrase("rests {length:.0f} cm from the usual pose of the body", length=length)
    if layer == "arms":
        return phrase("rests {length:.0f} cm from the usual pose of the arms", length=length)
    return phrase("rests {length:.0f} cm from the usual pose of the head", length=length)


def guess_limb_from_motion(traits: Traits, layer: Layer, kind: Kind) -> Belief[Limb]:
    """Return the arm that a clip needs, or the side to which a head goes."""
    if kind in ("stance", "transition"):
        both = (
            phrase("a stance uses both arms") if kind == "stance" else phrase("a transition uses both arms")
        )
        return Belief("both", 0.9, both)
    if layer == "arms":
        share = traits.symmetry
        limb: Limb = "both" if abs(share) < ALONE else "left" if share > 0 else "right"
        confidence = 0.5 + 0.45 * min(1.0, abs(abs(share) - ALONE) / 0.3)
        return Belief(
            limb,
            confidence,
            phrase(
                "the left arm does {left:.0f} % of the arms' movement, the right {right:.0f} %",
                left=50 * (1 + share),
                right=50 * (1 - share),
            ),
        )
    x = traits.layers["head"]
    if layer == "head" and "nose" in x.names:
        n = x.names.index("nose")
        left, right = float(x.high[n, 0] - x.first[n, 0]), float(x.first[n, 0] - x.low[n, 0])
        if max(left, right) > 0.02 and max(left, right) > 3 * min(left, right):
            length = 100 * traits.height * max(left, right)
            if left > right:
                return Belief(
                    "left", 0.7, phrase("the nose moves {length:.0f} cm to the left", length=length)
                )
            return Belief("right", 0.7, phrase("the nose moves {length:.0f} cm to the right", length=length))
    moves = (
        phrase("the head moves, not one arm") if layer == "head" else phrase("the body moves, not one arm")
    )
    return Belief("both", 0.9, moves)


def _moving(
    x: LayerTraits, layer: Layer, starts: Sequence[tuple[float, Shape]], ends: Sequence[tuple[float, Shape]]
) -> float:
    """Return the logit of a transition."""
    if x.loop_error < 1e-6:
        return -10.0
    z = 3.0 * log(x.loop_error / (0.4 * TYPICAL[layer])) + 12.0 * (
        min(x.loop_error / (x.loop_error + x.extent), 0.5) - 0.3
    )
    if starts and ends:
        (_, here), (near, there) = starts[0], ends[0]
        back = next(d for d, shape in ends if shape is here)
        if there is not here and near < 0.5 * back:
            z += 2.0
        elif there is here and back < 0.5 * x.loop_error + 0.1 * TYPICAL[layer]:
            z -= 3.0
        if (
            there is here or near > 0.5 * TYPICAL[layer]
        ):  # ends in no other stance: recorded clips seldom end exactly as they begin
            z = min(z, 3.0) + 20.0 * (x.loop_error / (x.loop_error + x.extent) - STRAIGHT)
    return z


def _gesturing(traits: Traits, layer: Belief[Layer]) -> float:
    """Return the probability that it is a gesture rather than a fidget, on any layer."""
    others = [x for x in LAYERS if x != layer.value and traits.layers[x].names]
    share = layer.confidence if others else 1.0
    chances = [_sigmoid(_telling(traits, x)) for x in others]
    return share * _sigmoid(_telling(traits, layer.value)) + (1 - share) * sum(chances) / max(len(chances), 1)


def _telling(traits: Traits, layer: Layer) -> float:
    """Return the logit of a gesture rather than a fidget.

    Hands that go far into the space before the body mean a gesture (McNeill, Hand and Mind, 1992, on gesture
    space). The less they move, the more head and body count.
    """
    small = 1 / (1 + (traits.layers["arms"].extent / SMALL) ** 3)
    return (1 - small) * _hands_telling(traits) + small * _rest_telling(traits, layer)


def _hands_telling(traits: Traits) -> float:
    """Return the logit of a gesture from the hands. A stroke in free space and raised shoulders speak for
    one. Hands on one's own head, hair, arm or hand are self-adaptors (Ekman and Friesen, 1969), a weight that
    goes from leg to leg is a postural shift, and a repeated movement is no stroke either.

    The signs are the literature's. The sizes were set by hand on the sets of
    docs/contributing/labelling-figures.md.
    """
    arms, head, body = (traits.layers[layer] for layer in ("arms", "head", "body"))
    touch = traits.contact
    still = 1 / (1 + (arms.extent / 0.1) ** 3)
    bouts = max((arms, head, body), key=lambda y: y.peak).bouts
    scratching = _clipped((touch.trunk * traits.duration - 1.1) / 0.6, 0, 1) * _clipped(
        (touch.rub - 0.09) / 0.05, 0, 1
    )
    hands = traits.energy["left_arm"] + traits.energy["right_arm"]
    busy = traits.energy["fingers"] / max(hands, 1e-6) - 0.3  # fingers that play while the hand hangs
    before = _clipped((traits.front - 0.05) / 0.05, 0, 1)
    leaves = _clipped((traits.out - 0.03) / 0.03, 0, 1) * before  # crossed or clasped arms that open
    # A hand that goes out before the body, stays there for its beats and comes back, makes a gesture however
    # small: preparation, stroke and retraction (Kendon, Gesture, 2004).
    shaped = (
        _clipped((traits.held - 0.25) / 0.2, 0, 1)
        * _clipped((arms.extent - 0.015) / 0.015, 0, 1)
        * before
        * _clipped(traits.lifted / 0.05, 0, 1)
        * (1 - _clipped((touch.kept - 0.3) / 0.3, 0, 1))
    )
    return (
        1.7
        + _clipped(_log(arms.extent, 0.12), -1.6 + 1.3 * shaped, 1)
        + 0.5 * _clipped(_log(head.peak, 0.06), -1.5, 1)
        + 1.5 * still * _clipped(_log(head.peak, 0.12), 0, 1)
        + 1.6 * _clipped(traits.shrug / 0.01, 0, 1.2)
        + 6.0 * min(traits.out, 0.15) * _clipped((traits.lifted + 0.04) / 0.04, 0, 1)
        - 2.5 * _clipped((0.05 - traits.front) / 0.03, 0, 1) * _clipped(-traits.lifted / 0.04, 0, 1)
        - 2.0 * still * _clipped(busy, 0, 1)
        - 12.0 * min(touch.head, 0.4)
        - 10.0 * _clipped(touch.arm - 0.08, 0, 0.35) * (1 - leaves)
        - 3.0 * scratching
        - 2.4 * _clipped((touch.kept - 0.45) / 0.3, 0, 1) / (1 + (arms.extent / 0.25) ** 4) * (1 - leaves)
        - 4.0 * still * _clipped((traits.sway - 0.04) / 0.05, 0, 1)
        - 1.2 * still * _clipped(_log(traits.energy["legs"], 0.04), 0, 1.5)
        - 0.8 * min(max(bouts - 2, 0), 2) * (1 - shaped)
    )


def _rest_telling(traits: Traits, layer: Layer) -> float:
    """Return the logit of a gesture for a clip in which the hands hardly move.

    The weights for head and body are those of a logistic regression on the sample clips, rounded; lengths and
    speeds are relative to typical ones.
    """
    arms, head, body = (traits.layers[layer] for layer in ("arms", "head", "body"))
    bouts = max((arms, head, body), key=lambda y: y.peak).bouts
    nods, leans = _log(head.peak, 0.12), _log(body.peak, 0.1)
    if layer == "head":
        hang = 1 / (1 + (arms.extent / HANGING) ** 8)
        rolls = _spread(head, "crown", 0) if bouts > 2 else 0.0  # a neck that is stretched from side to side
        return (
            1.6 * nods
            - 3.0 * _clipped((rolls - 0.03) / 0.02, 0, 1)
            + (2.7 if bouts == 1 else 0.0)
            + 2.7 * log(traits.duration - hang * max(0.0, traits.duration - NODS) + 0.1)
            - hang * min(3.0, 1.5 * max(0.0, traits.duration - LOOKS_ROUND))
            - 0.3 * _log(head.extent, 0.03)
            - 2.0
        )
    if layer == "body":
        lower = _log(traits.energy["legs"] + traits.energy["hips"], 0.02)
        return 1.55 + 0.9 * nods + leans - 1.4 * lower - (2.9 if bouts > 2 else 0.0)
    return _hands_telling(traits)


def _spread(x: LayerTraits, point: str, axis: int) -> float:
    """Return how far a point goes along an axis, in heights; 0 for a figure without it."""
    if point not in x.names:
        return 0.0
    n = x.names.index(point)
    return float(x.high[n, axis] - x.low[n, axis])


def _clipped(x: float, least: float, most: float) -> float:
    return min(most, max(least, x))


def _log(x: float, typical: float) -> float:
    return log(x / typical + 0.02)
