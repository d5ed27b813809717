"""Measure a whole clip, for discovering stances and for guessing: how much it moves, which layer, how much it
rests.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from math import inf, log, sqrt

from metagraph.common.wording import phrase
from metagraph.graph.words import Layer
from metagraph.suggest.estimate import Belief
from metagraph.suggest.traits import Traits

TYPICAL: Mapping[Layer, float] = {
    "arms": 0.12,
    "head": 0.04,
    "body": 0.03,
}  # heights that another stance is away, about
HELD = 1.0  # seconds without movement after which it is a pose to stand in
FLOWING = 0.2  # of its greatest speed: a clip that is so fast at its ends is a flowing loop
CYCLE = (0.2, 1.25)  # seconds that one cycle of a movement that is made to repeat lasts
FLOWS = 0.3  # of its greatest speed: what is so fast at its ends goes on across its seam
TURNS = 0.45  # of its mean speed: what is so fast near its ends only turns round at its seam
TURNS_NAMED = 0.1  # the same where its name is a gesture's: slower clips begin and end in a pose
STROKES: Mapping[Layer, float] = {"arms": 0.15, "head": 0.08}  # heights a second: no breathing goes so fast
HANGING = 0.1  # heights that hands go while nothing is done with them
SHIFTS = 0.05  # heights that the hips go to a side: farther is a weight that is shifted, no rest
SHRUGS = 0.0065  # heights that shoulders rise: no breath lifts them so far
LOOKS = 0.035  # heights that the head goes: farther is a look round, or a lean
STRIDE = 0.05  # heights by which each foot passes the other in a walk, at least
IDLE_HANDS = 0.2  # heights a second: the hands of no idle go faster at their fastest
OUT, BRIEF = (
    0.03,
    5.0,
)  # heights that a hand goes out, in a clip of so many seconds, from which on it gestures
STEADY = 0.6  # of `LayerTraits.steady`, above which a movement goes on all the time
BREATHES = 0.008  # heights a second that arms on a breathing chest move while the head moves
SEVERAL = 8  # clips from which on the movement of the calmest belongs to the recording
CALMEST = 0.05  # share of the clips of a set that move only as it trembles
MORE = 1.5  # times the movement of those, up to which a short clip may tremble
TREMBLE = 0.025  # heights a second; if the calmest clips move more, none of them rests
# how often a guess from motion is right at most: motion cannot tell a small gesture from a large fidget
SUREST = 0.95


def compute_energy(traits: Traits) -> float:
    """Return the mean speeds of all parts of a clip added up, heights a second."""
    return sum(traits.energy.values())


def with_tremble(traits: Mapping[str, Traits]) -> dict[str, Traits]:
    """Return traits with the movement that all clips of their set have: the tremble of a recording, and
    breathing, say nothing about one clip.
    """
    moving = [t for t in traits.values() if t.face == 0 and not has_no_measures(t)]
    if len(moving) < SEVERAL:
        return dict(traits)
    least = {}
    for part in moving[0].energy:
        calm = sorted(t.energy[part] for t in moving)[int(CALMEST * len(moving))]
        least[part] = MORE * calm if calm < TREMBLE else 0.0
    return {clip: replace(t, tremble=least) for clip, t in traits.items()}


def _beyond_tremble(traits: Traits) -> Mapping[str, float]:
    """Return the energies without the set's tremble, or all of them if nothing is left. Squares of speeds are
    subtracted, because those of independent movements add up.
    """
    beyond = {
        part: sqrt(max(0.0, e**2 - traits.tremble.get(part, 0.0) ** 2)) for part, e in traits.energy.items()
    }
    return beyond if any(beyond.values()) else traits.energy


def has_no_measures(traits: Traits) -> bool:
    """Return whether nothing of a clip moves, so that its motion says nothing."""
    return all(x.peak < 1e-3 for x in traits.layers.values()) and traits.energy["fingers"] < 1e-3


def compute_resting_logit(traits: Traits) -> float:
    """Return the logit of a stance: little movement, for a long time, steady, with ends that meet."""
    if traits.frames < 2 or traits.duration <= 0:
        return 3.0
    if is_cycle(traits):
        return -3.0
    if has_no_measures(traits):  # held, or a clip of the face
        return 3.0 if traits.duration >= HELD else 0.0
    x = max(traits.layers.values(), key=lambda y: y.peak)
    fastest = max(x.peak, 3 * traits.energy["fingers"], 1e-3)
    apart = max(y.loop_error / TYPICAL[layer] for layer, y in traits.layers.items())
    long = 3.0 * log(min(traits.duration / 3.5, 2.0))
    # The length of a short loop whose end continues its beginning does not matter, because it is repeated.
    flows = min(1.0, x.steady / FLOWING) if apart < 0.1 else 0.0
    small = 1.5 * max(0.0, 1 - x.extent / 0.08)
    return (
        long
        - 1.5 * log(fastest / 0.05)
        + 3.0 * x.steady
        - 6.0 * max(0.0, apart - 0.3)
        - _busy_hands(traits)
        - _held_out(traits)
        - (_busy_idle(traits) if traits.layers["arms"].extent < HANGING else 0.0)
        + flows * (max(0.0, -long) + small)
    )


def _busy_hands(traits: Traits) -> float:
    """Return what speaks against a rest in hands that go fast all the time, as in clapping."""
    arms = traits.layers["arms"]
    always = min(1.0, max(0.0, (arms.steady - STEADY) / (1 - STEADY)))
    return 3.0 * always * max(0.0, log(max(arms.peak, 1e-3) / IDLE_HANDS))


def _held_out(traits: Traits) -> float:
    """Return what speaks against a rest in a short clip in which a hand goes out, stays there and comes back:
    a small gesture.
    """
    arms = traits.layers["arms"]
    short = min(1.0, max(0.0, (BRIEF - traits.duration) / 1.5))
    far = min(1.0, max(0.0, (arms.extent - OUT) / OUT))
    return 3.0 * short * far * min(1.0, max(0.0, (traits.held - 0.3) / 0.2))


def _busy_idle(traits: Traits) -> float:
    """Return what speaks against a rest in a clip whose arms hang: weight that is shifted, shoulders that
    rise, a look round.
    """
    return (
        min(4.0, 40.0 * max(0.0, traits.sway - SHIFTS))
        + min(3.0, 300.0 * max(0.0, traits.shrug - SHRUGS))
        + min(6.0, 120.0 * max(0.0, traits.layers["head"].extent - LOOKS))
    )


def is_cycle(traits: Traits, named: bool = False, away: bool = False) -> bool:
    """Return whether a clip is one cycle of a gesture: short, with ends that meet amid the movement, and
    with hands or a head that go faster than an idle's. `named`: its name says that it is a gesture, so it
    may be small, or of the whole body. `away`: it begins in no stance, so it may turn round at its ends; with
    the name of a gesture it may also be slow there, as where it was cut at the turn of a wave.
    """
    moves = find_layer_moving_most(traits).value
    x = traits.layers[moves]
    apart = max(y.loop_error / TYPICAL[layer] for layer, y in traits.layers.items())
    short = CYCLE[0] <= traits.duration <= CYCLE[1] and traits.face == 0
    flows = x.flow >= FLOWS or (away and x.turning >= (TURNS_NAMED if named else TURNS))
    if not short or apart >= 0.1 or not flows or is_walk(traits):
        return False
    return named or x.peak >= STROKES.get(moves, inf)


def is_walk(traits: Traits) -> bool:
    """Return whether a clip is a cycle of steps, in place or over the ground."""
    body = traits.layers["body"]
    return (
        traits.stride > STRIDE
        and body.loop_error < 0.5 * TYPICAL["body"]
        and body.steady > FLOWING / 2
        and traits.energy["legs"] > 0.2
    )


def guess_layer(traits: Traits) -> Belief[Layer]:
    """Return which layer a clip moves: the body if hips or legs move, else the arms, else the head."""
    e, layers = _beyond_tremble(traits), traits.layers
    lower, upper = e["hips"] + e["legs"], e["head"] + e["trunk"]
    breath = BREATHES if upper > 3 * BREATHES else 0.0
    arms = max(0.0, e["left_arm"] + e["right_arm"] - breath) + e["fingers"]
    have = [layer for layer in ("body", "arms", "head") if layers[layer].names]
    if have == ["body"]:
        return Belief("body", SUREST, phrase("the character has no known arms or head"))
    if traits.face > 1e-3 and "head" in have:
        return Belief("head", SUREST, phrase("only the face moves"))
    if arms + lower + upper < 1e-5:
        return Belief("body", 0.34, phrase("nothing moves"))
    body, hands = lower / (0.15 * upper + 0.25 * arms + 1e-6), arms / (0.1 * upper + 1e-6)
    share = phrase(
        "hips and legs {lower:.1f}, arms {arms:.1f}, head and trunk {upper:.1f} % of body height per second",
        lower=lower * 100,
        arms=arms * 100,
        upper=upper * 100,
    )
    if body >= 1:
        return Belief("body", _tempered(body), phrase("hips and legs move: {share}", share=share))
    if hands >= 1 and "arms" in have:
        return Belief(
            "arms",
            min(_tempered(hands), _tempered(1 / max(body, 1e-3))),
            phrase("the arms move, hips and legs do not: {share}", share=share),
        )
    if "head" in have:
        return Belief(
            "head",
            min(_tempered(1 / max(hands, 1e-3)), _tempered(1 / max(body, 1e-3))),
            phrase("only the head moves: {share}", share=share),
        )
    return Belief("body", 0.5, share)


def find_layer_moving_most(traits: Traits) -> Belief[Layer]:
    """Return which layer of a whole-body recording goes farthest, compared with a usual stance. Everything
    sways in one, so speeds say little.
    """
    far = sorted(
        ((x.extent / TYPICAL[layer], layer) for layer, x in traits.layers.items() if x.names), reverse=True
    )
    if not far or far[0][0] <= 0:
        return guess_layer(traits)
    first, second = far[0], far[1][0] if len(far) > 1 else 0.0
    x = traits.layers[first[1]]
    words = _goes_farthest(first[1], 100 * traits.height * x.extent)
    return Belief(first[1], _tempered(first[0] / max(second, 1e-6)), words)


def _goes_farthest(layer: Layer, length: float) -> str:
    if layer == "body":
        return phrase("the body moves {length:.0f} cm, furthest beyond what is usual", length=length)
    if layer == "arms":
        return phrase("the arms move {length:.0f} cm, furthest beyond what is usual", length=length)
    return phrase("the head moves {length:.0f} cm, furthest beyond what is usual", length=length)


def _tempered(ratio: float) -> float:
    """Return the confidence for a ratio above 1: 0.5 at 1, SUREST from 5 on."""
    return 0.5 + (SUREST - 0.5) * min(1.0, log(max(ratio, 1.0)) / log(5.0))
