"""Proposals for clips: what each is, from its name, its motion and what is labelled already, together; and
the edit that takes them over.

Stances come first: those the project has, those found in the motion, those that names speak of. A name's word
belongs to the stance in which the clips it names begin; then every clip is asked where it belongs.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, Literal

import numpy as np

from metagraph.graph.model import KINDS, LAYERS, LIMBS, Action, Layer, Limb, Project
from metagraph.suggest.accept import Taken, accept
from metagraph.suggest.alike import Alike, Example
from metagraph.suggest.clip_measures import walks
from metagraph.suggest.details import masked, rest_of, stroked, timed, weighted
from metagraph.suggest.estimate import Belief
from metagraph.suggest.motion_guess import MotionGuess, guess
from metagraph.suggest.name_words import NameGuess, Patterns, read_names
from metagraph.suggest.proposal import Place, Proposal, Proposals, Rest, plain, words_of
from metagraph.suggest.stances import Shape, discovered, known
from metagraph.suggest.traits import Traits, traits_of
from metagraph.suggest.vote_fusion import Agreed, combine

__all__ = [
    "SOURCES",
    "Place",
    "Proposal",
    "Proposals",
    "Rest",
    "Source",
    "Taken",
    "accept",
    "examples_of",
    "measures_of",
    "plain",
    "propose",
]

Source = Literal["name", "motion", "learned"]
SOURCES: tuple[Source, ...] = ("name", "motion", "learned")
# how much the name of a clip that rests in a stance counts to name it, beside one that begins or ends there
LOOP_VOTE = 1.5
LENT = 0.5  # of a clip that a stance plays, below which it only borrows a moment of it
NEVER = 0.3  # of how sure a source is at least, so that its vote counts


def examples_of(project: Project, traits: Mapping[str, Traits]) -> list[Example]:
    """Return what a project's labelled clips teach."""
    out = []
    for action in project.actions():
        entry = project.clips.get(action.clip)
        if entry is None:
            continue
        labels: dict[str, str] = {"kind": action.kind, "layer": action.layer, "limb": action.limb}
        out.append(Example(words_of(entry.name), measures_of(traits.get(action.clip)), labels))
    return out


def measures_of(traits: Traits | None) -> Any:
    """Return a clip's motion as numbers that clips of any character share."""
    if traits is None:
        return np.zeros(0)
    rows: list[float] = [
        np.log1p(traits.duration),
        traits.travel,
        traits.symmetry,
        traits.mirrored,
        traits.out,
        traits.near,
        traits.touch,
    ]
    for layer in LAYERS:
        x = traits.layers[layer]
        rows += [np.log1p(x.energy), np.log1p(x.peak), x.extent, x.loop_error, x.rest, float(x.bouts)]
    return np.array(rows, float)


def waiting(project: Project) -> list[str]:
    """Return the clips that are not placed yet; one that only lends a stance a still moment is not."""
    return [
        clip
        for clip in project.clips
        if all(_lends(project, action) for action in project.uses.get(clip, ()))
    ]


def _lends(project: Project, action: Action) -> bool:
    motion, end = project.clips[action.clip].motion, action.timing.end
    return (
        action.kind == "stance"
        and motion is not None
        and end is not None
        and end - action.timing.start < LENT * motion.duration
    )


def propose(
    project: Project,
    clips: Sequence[str] | None = None,
    patterns: Patterns | None = None,
    examples: Iterable[Example] = (),
    sources: Collection[Source] = SOURCES,
    cancelled: Callable[[], bool] | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> Proposals:
    """Return proposals for clips, those that are not placed yet when None. examples: of earlier projects.
    sources: which may speak.

    Never raises for what clips are; one of which nothing is known is left out.
    """
    chosen = waiting(project) if clips is None else [c for c in clips if c in project.clips]
    traits = traits_of(project, cancelled, progress) if {"motion", "learned"} & set(sources) else {}
    names = read_names([project.clips[c].name for c in chosen], patterns) if "name" in sources else {}
    shapes: Mapping[Layer, Sequence[Shape]] = {}
    if "motion" in sources:
        mine = {c: traits[c] for c in chosen if c in traits}
        there, found = known(project, traits), discovered(mine)
        shapes = {layer: there.get(layer) or found.get(layer, ()) for layer in LAYERS}
    alike = Alike([*examples_of(project, traits), *examples]) if "learned" in sources else Alike([])
    heard = [
        _Heard(
            c,
            project.clips[c].name,
            names.get(project.clips[c].name, NameGuess()),
            traits.get(c),
            named="name" in sources,
        )
        for c in chosen
    ]
    for each in heard:
        if each.traits is not None and "motion" in sources:
            each.motion = guess(each.traits, shapes)
        if alike.examples:
            each.learned = alike.guess(words_of(each.name), measures_of(each.traits))
        layer = each.agreed("layer", len(LAYERS))
        each.layer = layer.belief.value if layer is not None else "arms"
        each.beside = each.motion
        if each.traits is not None and each.motion is not None and each.motion.layer.value != each.layer:
            each.beside = guess(each.traits, shapes, each.layer)
    places = _Places(project, heard, shapes)
    out = {each.clip: p for each in heard if (p := _proposal(each, places)) is not None}
    out = _somewhere(out, places.by_key)
    if "motion" in sources:
        out = timed(project, out, cancelled)
        motions = {each.clip: each for each in heard}
        out = {
            c: stroked(project, masked(project, p, motions[c].traits), motions[c].beside)
            for c, p in out.items()
        }
    return Proposals(weighted(project, out), _with_rests(project, places.by_key, out))


@dataclass
class _Heard:
    """What the sources say of a clip. motion: what it seems to be; beside: the same when it is of the layer
    that all agree on. named: whether names may speak.
    """

    clip: str
    name: str
    said: NameGuess
    traits: Traits | None
    motion: MotionGuess | None = None
    beside: MotionGuess | None = None
    layer: Layer = "arms"
    learned: dict[str, Belief[str]] = field(default_factory=dict)
    named: bool = True

    def votes(self, what: str) -> list[Belief[Any]]:
        """Return what is believed of a field, source by source."""
        motion = self.motion if what == "layer" else self.beside
        found = [getattr(self.said, what, None), getattr(motion, what, None), self.learned.get(what)]
        return [b for b in found if b is not None and b.confidence >= NEVER]

    @property
    def begins(self) -> Belief[Shape] | None:
        return self.beside.stance if self.beside is not None else None

    @property
    def ends(self) -> Belief[Shape] | None:
        return self.beside.end_stance if self.beside is not None else None

    @property
    def walks(self) -> bool:
        """Whether it is a cycle of steps, as far as the motion is asked."""
        return self.motion is not None and self.traits is not None and walks(self.traits)

    @property
    def step(self) -> str:
        """What the stance of a cycle of steps is called: as the clip, without what tells variants apart."""
        words = list(words_of(self.name)) if self.named else []
        while len(words) > 1 and (words[-1].isdigit() or len(words[-1]) == 1):
            words.pop()
        return " ".join(words) or f"steps {self.clip}"

    def agreed(self, what: str, count: int) -> Agreed[Any] | None:
        return combine(self.votes(what), count)


class _Places:
    """The stances there may be, and which word and which shape belongs to which."""

    def __init__(
        self, project: Project, heard: Sequence[_Heard], shapes: Mapping[Layer, Sequence[Shape]]
    ) -> None:
        self.by_key: dict[str, Place] = {}
        self.of_shape: dict[int, str] = {}
        self.of_word: dict[tuple[Layer, str], str] = {}
        for layer in LAYERS:
            for stance in project.graphs[layer].stances.values():
                self.by_key[stance.id] = Place(stance.id, layer, stance.name, True)
                self.of_word[(layer, plain(stance.name))] = stance.id
        for layer in LAYERS:
            for n, shape in enumerate(shapes.get(layer, ())):
                self._add_shape(layer, n, shape, [each for each in heard if each.layer == layer])
        for each in heard:
            layer = each.layer
            for said in (each.said.stance, each.said.end_stance):
                if said is not None and (layer, plain(said.value)) not in self.of_word:
                    key = f"new {layer} {plain(said.value)}"
                    self.by_key.setdefault(key, Place(key, layer, said.value))
                    self.of_word[(layer, plain(said.value))] = key
        for each in heard:
            if each.walks:
                key = f"new body {each.step}"
                self.by_key.setdefault(key, Place(key, "body", each.step))

    def _add_shape(self, layer: Layer, number: int, shape: Shape, heard: Sequence[_Heard]) -> None:
        """Take a shape in; words that mostly name clips which begin in it are its names."""
        key = shape.id or f"new {layer} {number + 1}"
        words: dict[str, float] = defaultdict(float)
        for each in heard:
            for said, seen in ((each.said.stance, each.begins), (each.said.end_stance, each.ends)):
                if said is not None and seen is not None and seen.value is shape:
                    rests = (
                        said is each.said.stance
                        and each.said.kind is not None
                        and each.said.kind.value == "stance"
                    )
                    words[said.value] += LOOP_VOTE if rests else 1
        free = [
            (word, count)
            for word, count in sorted(words.items(), key=lambda x: -x[1])
            if (layer, plain(word)) not in self.of_word
        ]
        if not shape.id:
            name = free[0][0] if free else f"{layer} stance {number + 1}"
            self.by_key[key] = Place(key, layer, name, False, shape)
        else:
            old = self.by_key[key]
            self.by_key[key] = Place(key, layer, old.name, True, shape)
        self.of_shape[id(shape)] = key
        if free:
            self.of_word[(layer, plain(free[0][0]))] = key

    def vote(self, each: _Heard, what: str, layer: Layer) -> list[Belief[str]]:
        """Return beliefs about a stance as keys."""
        if each.walks and what == "stance" and layer == "body":
            return [
                Belief(
                    f"new body {each.step}",
                    0.7,
                    "a cycle of steps is a stance of its own, which goes on until it is left",
                )
            ]
        out: list[Belief[str]] = []
        said: Belief[str] | None = getattr(each.said, what)
        if said is not None and (key := self.of_word.get((layer, plain(said.value)))) is not None:
            out.append(Belief(key, said.confidence, said.reason))
        seen: Belief[Shape] | None = getattr(each.beside, what, None)
        if (
            seen is not None
            and seen.value.layer == layer
            and (key := self.of_shape.get(id(seen.value))) is not None
        ):
            out.append(
                Belief(
                    key,
                    seen.confidence,
                    seen.reason.replace(f'"{seen.value.name}"', f'"{self.by_key[key].name}"'),
                )
            )
        return out

    def count(self, layer: Layer) -> int:
        return max(2, sum(1 for p in self.by_key.values() if p.layer == layer))


def _somewhere(proposals: Mapping[str, Proposal], places: dict[str, Place]) -> dict[str, Proposal]:
    """Return proposals, those that nothing says the stance of in the stance most clips of their layer are in;
    one is made where there is none.
    """
    used = Counter(p.stance.value for p in proposals.values() if p.stance is not None)
    out = {}
    for clip, p in proposals.items():
        if p.stance is None:
            layer = p.layer.value
            mine = [key for key, place in places.items() if place.layer == layer]
            key = max(mine, key=lambda k: used[k]) if mine else f"new {layer} rest"
            places.setdefault(key, Place(key, layer, "rest"))
            p = replace(
                p,
                stance=Belief(
                    key,
                    0.3,
                    "nothing says a stance; " + ("most are in this one" if mine else "there is no other"),
                ),
            )
        out[clip] = p
    return out


def _with_rests(
    project: Project, places: Mapping[str, Place], proposals: Mapping[str, Proposal]
) -> dict[str, Place]:
    """Return the stances, those that no clip rests in with a moment of some clip that shows them."""
    shown = {p.stance.value for p in proposals.values() if p.kind.value == "stance" and p.stance is not None}
    names = {plain(places[key].name) for key in shown}
    return {
        key: place
        if place.there or key in shown or plain(place.name) in names
        else replace(place, rest=rest_of(project, place, proposals))
        for key, place in places.items()
    }


def _proposal(each: _Heard, places: _Places) -> Proposal | None:
    kind, layer = each.agreed("kind", len(KINDS)), each.agreed("layer", len(LAYERS))
    if kind is None and layer is None:
        return None
    unsure: Agreed[Any] = Agreed(Belief("gesture", 0.3, "nothing says what it is"))
    kind = kind or unsure
    layer = layer or Agreed(Belief(each.layer, 0.34, "nothing says which layer it is for"))
    where: Layer = layer.belief.value
    stance = combine(places.vote(each, "stance", where), places.count(where))
    end = None
    if kind.belief.value == "transition":
        start = stance.belief.value if stance is not None else ""
        ends = [b for b in places.vote(each, "end_stance", where) if b.value != start]
        end = combine(ends, places.count(where))
    limb = each.agreed("limb", len(LIMBS)) if where == "arms" and kind.belief.value != "stance" else None
    both: Belief[Limb] = Belief(
        "both", 0.9, "only arms have sides" if where != "arms" else "nothing says a side"
    )
    found = [x for x in (kind, layer, stance, end) if x is not None]
    return Proposal(
        each.clip,
        kind.belief,
        layer.belief,
        stance.belief if stance is not None else None,
        end.belief if end is not None else None,
        limb.belief if limb is not None else both,
        each.said.tags,
        tuple(x.conflict for x in found if x.conflict),
    )
