"""The stances there may be: which words and which poses mean the same one.

Names and motion are one inference. A pose is called by the words most of the clips have that begin or end in
it, a word means the pose most of its clips are in; how well both agree says how far a name can be believed
where a clip's own pose disagrees. Two words may call one pose if nothing tells the poses of their clips
apart, and one pose is parted where words and poses part alike.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.common.wording import change_quoted
from metagraph.graph.model import LAYERS, Layer, Project
from metagraph.suggest.estimate import Belief
from metagraph.suggest.motion_guess import Likely, MotionGuess
from metagraph.suggest.proposal import StancePlace, simplify_stance_name
from metagraph.suggest.stances.known import SAME, Shape, measure_distance_from_stance
from metagraph.suggest.stances.pose_words import describe_pose
from metagraph.suggest.traits import LayerTraits, Traits
from metagraph.suggest.vote_fusion import Agreed, combine
from metagraph.suggest.whole_body import CARRIER, SCALE
from metagraph.suggest.words.names import NameGuess

Array = NDArray[Any]

LOOP_VOTE = (
    1.5  # how much the name of a clip that rests in a stance counts to name it, beside one that begins there
)
ALIKE, ALIKE_VOTES = 0.8, 2.0  # share of a pose's clips that call it alike, and how many at least
ONE_STANCE = 0.1  # heights within which poses that are called alike are one stance
# The same for poses between which no word tells: each word calls both about as often
ONE_POSE, BOTH = 0.06, 0.95
LEAST_VOTES = 0.5  # clips, below which a word says nothing about a pose
MEANS = 0.6  # of a word's clips that lie in another's pose, from which on it means the same stance
NEVER = 0.3  # of how sure a source is at least, so that its vote counts
ASTRAY = 0.15  # heights from every stance, beyond which a first pose says nothing about where a clip belongs


@dataclass
class ClipEvidence:
    """What the sources say of a clip. motion: what it seems to be; beside: the same when it is of the layer
    that all agree on. posture: its poses as stances are reported. cycle: whether it is one cycle of a
    gesture. away: how far it begins from the nearest stance of its layer, heights; 0 if that is not known.
    """

    clip: str
    name: str
    said: NameGuess
    traits: Traits | None
    posture: LayerTraits | None = None
    motion: MotionGuess | None = None
    beside: MotionGuess | None = None
    layer: Layer = "arms"
    learned: dict[str, Belief[str]] = field(default_factory=dict)
    cycle: bool = False
    away: float = 0.0

    def votes(self, what: str) -> list[Belief[Any]]:
        """Return what is believed of a field, source by source."""
        motion = self.motion if what == "layer" else self.beside
        found = [getattr(self.said, what, None), getattr(motion, what, None), self.learned.get(what)]
        return [b for b in found if b is not None and b.confidence >= NEVER]

    @property
    def is_astray(self) -> bool:
        """Return whether it begins so far from every stance that its pose does not say to which it belongs: a
        wave that was cut while the hand is up.
        """
        return self.away > ASTRAY

    @property
    def begins(self) -> Likely:
        return self.beside.begins if self.beside is not None and not self.is_astray else ()

    @property
    def ends(self) -> Likely:
        return self.beside.ends if self.beside is not None else ()

    def called(self) -> list[tuple[str, Likely, float]]:
        """Return the stances its name speaks of: (words, what its pose there may be, how much it counts)."""
        out: list[tuple[str, Likely, float]] = []
        kind = self.said.kind.value if self.said.kind is not None else None
        if self.said.stance is not None:
            out.append((self.said.stance.value, self.begins, LOOP_VOTE if kind == "stance" else 1.0))
            if kind in ("gesture", "fidget"):
                out.append((self.said.stance.value, self.ends, 0.5))
        if self.said.end_stance is not None:
            out.append((self.said.end_stance.value, self.ends, 1.0))
        return out

    def agreed(self, what: str, count: int) -> Agreed[Any] | None:
        return combine(self.votes(what), count)


class StancePlaces:
    """by_key: the stances; which word and which shape is which, and how far words can be believed."""

    def __init__(
        self, project: Project, heard: Sequence[ClipEvidence], shapes: Mapping[Layer, Sequence[Shape]]
    ) -> None:
        self.by_key: dict[str, StancePlace] = {}
        self._of_shape: dict[int, str] = {}
        self._of_word: dict[tuple[Layer, str], str] = {}
        self._trusted: dict[tuple[Layer, str], float] = {}
        for layer in LAYERS:
            for stance in project.graphs[layer].stances.values():
                self.by_key[stance.id] = StancePlace(stance.id, layer, stance.name, True)
                self._of_word[(layer, simplify_stance_name(stance.name))] = stance.id
        for layer in LAYERS:
            self._joined(layer, shapes.get(layer, ()), [each for each in heard if each.layer == layer])
        rests: list[
            tuple[str, LayerTraits]
        ] = []  # stances that only names tell, with a clip that rests there
        for each in heard:
            for word, *_ in each.called():
                told = (each.layer, simplify_stance_name(word))
                if told in self._of_word:
                    continue
                key = self._same_rest(each, rests) or f"new {each.layer} {told[1]}"
                self.by_key.setdefault(key, StancePlace(key, each.layer, word))
                self._of_word[told] = key
                if each.traits is not None:
                    rests.append((key, each.posture or each.traits.layers[each.layer]))

    def _same_rest(self, each: ClipEvidence, rests: Sequence[tuple[str, LayerTraits]]) -> str | None:
        """Return the stance in which another clip has the same pose, of a clip that is named as one that
        rests: "idle 1" and "idle 2" of a layer that stays the same in both.
        """
        kind = each.said.kind.value if each.said.kind is not None else None
        if kind != "stance" or each.traits is None:
            return None
        mine = each.posture or each.traits.layers[each.layer]
        for key, other in rests:
            if self.by_key[key].layer != each.layer or not mine.names or mine.names != other.names:
                continue
            if np.linalg.norm(mine.first - other.first, axis=-1).max() <= SAME[each.layer][0]:
                return key
        return None

    def _joined(self, layer: Layer, shapes: Sequence[Shape], heard: Sequence[ClipEvidence]) -> None:
        """Join the words and the shapes of a layer."""
        votes, spoken = _votes(heard)
        free = dict(enumerate(shapes))
        for n, shape in enumerate(shapes):  # the project's own are called as they are
            if shape.id:
                old = self.by_key[shape.id]
                self.by_key[shape.id] = replace(old, shape=shape)
                self._of_shape[id(shape)] = shape.id
                del free[n]
        twins = _find_twins(shapes, votes)
        for n, other in twins.items():
            free.pop(n)
            for mine in votes.values():
                both = mine.pop(id(shapes[n]), 0.0) + mine.get(id(shapes[other]), 0.0)
                mine[id(shapes[other])] = both
        pairs = sorted(
            (
                (-count * count / spoken[word], word, n)
                for word, mine in votes.items()
                for n, shape in enumerate(shapes)
                if (count := mine.get(id(shape), 0.0)) >= LEAST_VOTES
            ),
        )
        taken: dict[str, str] = {}
        for _, word, n in pairs:
            told = (layer, simplify_stance_name(word))
            if n in free and word not in taken and not self._placed(told):
                key = self._of_word.get(told, f"new {layer} {n + 1}")
                name, there = (self.by_key[key].name, True) if key in self.by_key else (word, False)
                self.by_key[key] = StancePlace(key, layer, name, there, free[n])
                self._of_shape[id(free.pop(n))] = key
                self._of_word.setdefault(told, key)
                taken[word] = key
        for n, key in self._called_alike(layer, shapes, free, votes).items():
            self._of_shape[id(free.pop(n))] = key
        for n, shape in free.items():
            key = f"new {layer} {n + 1}"
            self.by_key[key] = StancePlace(key, layer, self._named(layer, shape, shapes), False, shape)
            self._of_shape[id(shape)] = key
        for n, other in twins.items():
            self._of_shape.setdefault(id(shapes[n]), self._of_shape[id(shapes[other])])
        for word, mine in votes.items():
            told, best = (layer, simplify_stance_name(word)), max(mine, key=lambda s: mine[s], default=None)
            if told not in self._of_word and best is not None and mine[best] >= MEANS * spoken[word]:
                self._of_word[told] = self._of_shape[best]
            if told in self._of_word:
                own = sum(c for s, c in mine.items() if self._of_shape.get(s) == self._of_word[told])
                self._trusted[told] = (own + 1) / (spoken[word] + 1.1)

    def _called_alike(
        self,
        layer: Layer,
        shapes: Sequence[Shape],
        free: Mapping[int, Shape],
        votes: Mapping[str, Mapping[int, float]],
    ) -> dict[int, str]:
        """Return, of the shapes that have no name, those whose clips nearly all name a stance that another
        shape has already and that is near: "idle 1" with the head up, and with it down, is one stance.
        """
        out = {}
        for n, shape in free.items():
            mine = {word: some[id(shape)] for word, some in votes.items() if id(shape) in some}
            word = max(mine, key=lambda w: mine[w], default="")
            told = (layer, simplify_stance_name(word))
            if (
                not word
                or mine[word] < max(ALIKE_VOTES, ALIKE * sum(mine.values()))
                or not self._placed(told)
            ):
                continue
            key = self._of_word[told]
            other = self.by_key[key].shape
            assert other is not None
            if measure_distance_from_stance(other, shape.names, shape.poses[0]) <= ONE_STANCE:
                out[n] = key
        return out

    def _named(self, layer: Layer, shape: Shape, shapes: Sequence[Shape]) -> str:
        """Return what a stance is called that no name speaks of: as its pose looks."""
        whole = SCALE if layer == CARRIER and "hips" in shape.names else None
        words = describe_pose(shape, shapes[0] if shapes and shapes[0] is not shape else None, whole)
        there = {place.name for place in self.by_key.values() if place.layer == layer}
        n, name = 1, words
        while name in there:
            n += 1
            name = f"{words} {n}"
        return name

    def vote(self, each: ClipEvidence, what: str, layer: Layer) -> list[Belief[str]]:
        """Return beliefs about a stance as keys."""
        out: list[Belief[str]] = []
        said: Belief[str] | None = getattr(each.said, what)
        told = (layer, simplify_stance_name(said.value)) if said is not None else None
        if said is not None and told is not None and (key := self._of_word.get(told)) is not None:
            out.append(Belief(key, said.confidence * self._trusted.get(told, 1.0), said.reason))
        seen: Belief[Shape] | None = getattr(each.beside, what, None)
        astray = what == "stance" and each.is_astray
        if (
            seen is not None
            and not astray
            and seen.value.layer == layer
            and (key := self._of_shape.get(id(seen.value))) is not None
        ):
            own, known = seen.value.name, self.by_key[key].name
            words = change_quoted(seen.reason, lambda name: known if name == own else name, '"')
            out.append(Belief(key, seen.confidence, words))
        return out

    def _placed(self, told: tuple[Layer, str]) -> bool:
        """Whether a word's stance has a pose already."""
        return told in self._of_word and self.by_key[self._of_word[told]].shape is not None

    def count(self, layer: Layer) -> int:
        return max(2, sum(1 for p in self.by_key.values() if p.layer == layer))


def _find_twins(shapes: Sequence[Shape], votes: Mapping[str, Mapping[int, float]]) -> dict[int, int]:
    """Return, of the poses that are near another and called by the same words, each as often, which other it
    is: idles and blinks of two characters whose faces rest a little differently.
    """
    if len(votes) < 2:
        return {}
    called = np.array([[mine.get(id(shape), 0.0) for mine in votes.values()] for shape in shapes])
    sizes = np.linalg.norm(called, axis=-1)
    out: dict[int, int] = {}
    for n, shape in enumerate(shapes):
        if shape.id or (called[n] >= LEAST_VOTES).sum() < 2:
            continue
        for other in range(n):
            alike = called[n] @ called[other] >= BOTH * sizes[n] * sizes[other] > 0
            if other in out or not alike:
                continue
            if measure_distance_from_stance(shapes[other], shape.names, shape.poses[0]) <= ONE_POSE:
                out[n] = other
                break
    return out


def _votes(heard: Sequence[ClipEvidence]) -> tuple[dict[str, dict[int, float]], dict[str, float]]:
    """Return word -> shape -> how many ends that the word names are of it; and word -> how many it names,
    those that are of no shape among them.
    """
    out: dict[str, dict[int, float]] = defaultdict(lambda: defaultdict(float))
    spoken: dict[str, float] = defaultdict(float)
    for each in heard:
        for word, likely, weight in each.called():
            if likely:
                spoken[word] += weight
            for chance, shape in likely:
                out[word][id(shape)] += weight * chance
    return {word: dict(mine) for word, mine in out.items()}, dict(spoken)
