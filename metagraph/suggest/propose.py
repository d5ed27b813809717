"""Proposals for clips: what each is, from its name, its motion and what is labelled already, together; and the edit that takes them over.

Stances come first: those the project has, those found in the motion, those that names speak of. A name's word belongs to the stance in
which the clips it names begin; then every clip is asked where it belongs.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, Literal

import numpy as np

from metagraph.graph import anatomy, edits
from metagraph.graph.edits import EditError
from metagraph.graph.model import KINDS, LAYERS, LIMBS, Kind, Layer, Limb, Project
from metagraph.motion.clip import Clip
from metagraph.playback.phases import phases
from metagraph.suggest import compatibility
from metagraph.suggest.alike import Alike, Example
from metagraph.suggest.belief import Belief
from metagraph.suggest.combine import Agreed, combine
from metagraph.suggest.motion_guess import MotionGuess, guess
from metagraph.suggest.stances import Shape, discovered, known
from metagraph.suggest.traits import Traits, traits_of
from metagraph.suggest.words import NameGuess, Patterns, read_names
from metagraph.suggest.words_tokens import take_apart

Source = Literal["name", "motion", "learned"]
SOURCES: tuple[Source, ...] = ("name", "motion", "learned")
_USUAL = Patterns()
LOOP_VOTE = 1.5  # how much the name of a clip that rests in a stance counts to name it, beside one that begins or ends there
NEVER = 0.3  # of how sure a source is at least, so that its vote counts


@dataclass(frozen=True)
class Place:
    """A stance clips may belong to. key: the project's id, or one of its own for a stance that is not there yet. shape: what it looks
    like, where that is known."""

    key: str
    layer: Layer
    name: str
    there: bool = False
    shape: Shape | None = None


@dataclass(frozen=True)
class Proposal:
    """What a clip is taken for. stance, end_stance: of a `Place`, by key. conflicts: where sources disagree firmly, in words. timing: as
    `Timing` has it, where the motion says; good: whether neither its beginning nor its end would jump, None where nobody knows."""

    clip: str
    kind: Belief[Kind]
    layer: Belief[Layer]
    stance: Belief[str] | None
    end_stance: Belief[str] | None
    limb: Belief[Limb]
    tags: Belief[tuple[str, ...]] | None = None
    conflicts: tuple[str, ...] = ()
    timing: Mapping[str, Any] = field(default_factory=dict)
    timing_reason: str = ""
    good: bool | None = None

    @property
    def confidence(self) -> float:
        """How sure it is as a whole: as its least sure part that decides where it goes."""
        parts = [self.kind.confidence, self.layer.confidence, self.stance.confidence if self.stance is not None else 0.0]
        if self.kind.value == "transition":
            parts.append(self.end_stance.confidence if self.end_stance is not None else 0.0)
        return min(parts)


@dataclass(frozen=True)
class Proposals:
    """Proposals by clip, and the stances they speak of, by key."""

    proposals: Mapping[str, Proposal]
    places: Mapping[str, Place]

    @property
    def doubtful(self) -> list[Proposal]:
        """The proposals, the least certain first."""
        return sorted(self.proposals.values(), key=lambda p: (p.confidence, p.clip))


def examples_of(project: Project, traits: Mapping[str, Traits]) -> list[Example]:
    """Return what a project's labelled clips teach."""
    out = []
    for action in project.actions():
        entry = project.clips.get(action.clip)
        if entry is None:
            continue
        labels: dict[str, str] = {"kind": action.kind, "layer": action.layer, "limb": action.limb}
        out.append(Example(_words(entry.name), measures_of(traits.get(action.clip)), labels))
    return out


def measures_of(traits: Traits | None) -> Any:
    """Return a clip's motion as numbers that clips of any character share."""
    if traits is None:
        return np.zeros(0)
    rows: list[float] = [np.log1p(traits.duration), traits.travel, traits.symmetry, traits.mirrored, traits.out, traits.near, traits.touch]
    for layer in LAYERS:
        x = traits.layers[layer]
        rows += [np.log1p(x.energy), np.log1p(x.peak), x.extent, x.loop_error, x.rest, float(x.bouts)]
    return np.array(rows, float)


def _words(name: str) -> tuple[str, ...]:
    return tuple(dict.fromkeys(take_apart(name, _USUAL).words))


def propose(
    project: Project,
    clips: Sequence[str] | None = None,
    patterns: Patterns | None = None,
    examples: Iterable[Example] = (),
    sources: Collection[Source] = SOURCES,
    cancelled: Callable[[], bool] | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> Proposals:
    """Return proposals for clips, those that are not placed yet when None. examples: of earlier projects. sources: which may speak.

    Never raises for what clips are; one of which nothing is known is left out.
    """
    chosen = [c for c in (project.clips if clips is None else clips) if c in project.clips and (clips is not None or c not in project.uses)]
    traits = traits_of(project, cancelled, progress) if {"motion", "learned"} & set(sources) else {}
    names = read_names([project.clips[c].name for c in chosen], patterns) if "name" in sources else {}
    shapes: Mapping[Layer, Sequence[Shape]] = {}
    if "motion" in sources:
        mine = {c: traits[c] for c in chosen if c in traits}
        there, found = known(project, traits), discovered(mine)
        shapes = {layer: there.get(layer) or found.get(layer, ()) for layer in LAYERS}
    alike = Alike([*examples_of(project, traits), *examples]) if "learned" in sources else Alike([])
    heard = [_Heard(c, project.clips[c].name, names.get(project.clips[c].name, NameGuess()), traits.get(c)) for c in chosen]
    for each in heard:
        if each.traits is not None and "motion" in sources:
            each.motion = guess(each.traits, shapes)
        if alike.examples:
            each.learned = alike.guess(_words(each.name), measures_of(each.traits))
        layer = each.agreed("layer", len(LAYERS))
        each.layer = layer.belief.value if layer is not None else "arms"
        each.beside = each.motion
        if each.traits is not None and each.motion is not None and each.motion.layer.value != each.layer:
            each.beside = guess(each.traits, shapes, each.layer)
    places = _Places(project, heard, shapes)
    out = {each.clip: p for each in heard if (p := _proposal(each, places)) is not None}
    if "motion" in sources:
        out = _timed(project, out, places)
    return Proposals(out, places.by_key)


@dataclass
class _Heard:
    """What the sources say of a clip. motion: what it seems to be; beside: the same when it is of the layer that all agree on."""

    clip: str
    name: str
    said: NameGuess
    traits: Traits | None
    motion: MotionGuess | None = None
    beside: MotionGuess | None = None
    layer: Layer = "arms"
    learned: dict[str, Belief[str]] = field(default_factory=dict)

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

    def agreed(self, what: str, count: int) -> Agreed[Any] | None:
        return combine(self.votes(what), count)


class _Places:
    """The stances there may be, and which word and which shape belongs to which."""

    def __init__(self, project: Project, heard: Sequence[_Heard], shapes: Mapping[Layer, Sequence[Shape]]) -> None:
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

    def _add_shape(self, layer: Layer, number: int, shape: Shape, heard: Sequence[_Heard]) -> None:
        """Take a shape in; words that mostly name clips which begin in it are its names."""
        key = shape.id or f"new {layer} {number + 1}"
        words: dict[str, float] = defaultdict(float)
        for each in heard:
            for said, seen in ((each.said.stance, each.begins), (each.said.end_stance, each.ends)):
                if said is not None and seen is not None and seen.value is shape:
                    rests = said is each.said.stance and each.said.kind is not None and each.said.kind.value == "stance"
                    words[said.value] += LOOP_VOTE if rests else 1
        free = [(word, count) for word, count in sorted(words.items(), key=lambda x: -x[1]) if (layer, plain(word)) not in self.of_word]
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
        out: list[Belief[str]] = []
        said: Belief[str] | None = getattr(each.said, what)
        if said is not None and (key := self.of_word.get((layer, plain(said.value)))) is not None:
            out.append(Belief(key, said.confidence, said.reason))
        seen: Belief[Shape] | None = getattr(each.beside, what, None)
        if seen is not None and seen.value.layer == layer and (key := self.of_shape.get(id(seen.value))) is not None:
            out.append(Belief(key, seen.confidence, seen.reason.replace(f'"{seen.value.name}"', f'"{self.by_key[key].name}"')))
        return out

    def count(self, layer: Layer) -> int:
        return max(2, sum(1 for p in self.by_key.values() if p.layer == layer))


def plain(name: str) -> str:
    """Return a stance's name without case, order of words or separators."""
    return " ".join(sorted(take_apart(name, _USUAL).words))


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
    both: Belief[Limb] = Belief("both", 0.9, "only arms have sides" if where != "arms" else "nothing says a side")
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


def _timed(project: Project, proposals: Mapping[str, Proposal], places: _Places) -> dict[str, Proposal]:
    """Return proposals with timing from the statistics of the user's own clips, where stances have loops to measure against."""
    roles = anatomy.roles(project)
    out = dict(proposals)
    for layer in LAYERS:
        mine = [p for p in proposals.values() if p.layer.value == layer]
        motions = [m for p in mine if (m := project.clips[p.clip].motion) is not None]
        if not motions:
            continue
        stats = compatibility.statistics(motions, layer, roles)
        loops: dict[str, list[tuple[Clip, float, float]]] = {k: list(v) for k, v in compatibility.loops_of(project, layer).items()}
        for p in mine:
            motion = project.clips[p.clip].motion
            if p.kind.value == "stance" and p.stance is not None and motion is not None:
                loops.setdefault(p.stance.value, []).append((motion, 0.0, motion.duration))
        frames = {key: compatibility.stance_frames(stats, rows, roles) for key, rows in loops.items()}
        for p in mine:
            motion = project.clips[p.clip].motion
            if motion is None or motion.frames < 2:
                continue
            if p.kind.value == "stance":
                times = compatibility.loop_times(stats, motion, roles)
            else:
                start = frames.get(p.stance.value if p.stance is not None else "")
                if start is None:
                    continue
                into = compatibility.costs(stats, motion, start, roles)
                last = frames.get(p.end_stance.value) if p.end_stance is not None else None
                times = compatibility.times(
                    stats, motion, into, None if last is None else compatibility.costs(stats, motion, last, roles), None, roles
                )
            timing = {
                "start": round(times.start, 3),
                "end": None if times.end >= motion.duration - 1e-3 else round(times.end, 3),
                "blend_in": round(times.blend_in, 3),
                "blend_out": round(times.blend_out, 3),
                "earliest_exit": None if times.earliest_exit is None else round(times.earliest_exit, 3),
                "loop": p.kind.value == "stance",
            }
            out[p.clip] = replace(p, timing=timing, timing_reason=times.reason, good=times.good)
    return out


# --- taking them over


@dataclass(frozen=True)
class Taken:
    """The project with proposals taken over. placed: clips by id. left: clip -> why it was not placed."""

    project: Project
    placed: tuple[str, ...]
    left: Mapping[str, str]


def accept(project: Project, found: Proposals, above: float = 0.0, clips: Collection[str] | None = None) -> Taken:
    """Return the project with all proposals as sure as `above` placed, of some clips or all. Stances are made where a resting clip
    shows them; what belongs to a stance that none shows is left, with the reason."""
    wanted = [p for p in found.proposals.values() if (clips is None or p.clip in clips) and p.clip in project.clips]
    left = {p.clip: f"only {p.confidence:.0%} sure" for p in wanted if p.confidence < above}
    wanted = [p for p in wanted if p.clip not in left]
    keys = {key: key for key, place in found.places.items() if place.there and project.stance(key) is not None}
    loops = {plain(found.places[p.stance.value].name): p.clip for p in wanted if p.kind.value == "stance" and p.stance is not None}
    before, placed = project, list[str]()
    for p in sorted(wanted, key=lambda p: (p.kind.value != "stance", -p.confidence)):
        try:
            project = _place(project, p, found.places, keys, loops)
            placed.append(p.clip)
        except EditError as error:
            left[p.clip] = str(error)
    return Taken(_begun(before, project), tuple(placed), left)


def _begun(before: Project, project: Project) -> Project:
    """Return the project with layers that had no stance beginning in their most used one, and a base pose, where none was chosen, of the
    arms' or else the body's: offsets are smallest against where a character mostly is."""
    for layer in LAYERS:
        graph = project.graphs[layer]
        if graph.stances and not before.graphs[layer].stances:
            used = Counter(a.stance for a in graph.actions.values())
            project = edits.set_start(project, max(graph.stances, key=lambda s: used[s]))
    if before.base.clip is None:
        starts = [(g, g.start) for layer in ("arms", "body", "head") if (g := project.graphs[layer]).start is not None]
        loops = [loop for graph, start in starts for loop in graph.of(str(start), "stance")]
        if loops:
            project = edits.set_base(project, loops[0].clip)
    return project


def _place(project: Project, p: Proposal, places: Mapping[str, Place], keys: dict[str, str], loops: Mapping[str, str]) -> Project:
    """Place one clip. keys: place -> stance id, of those there are by now. loops: a stance's name -> a clip that rests in it, on whatever
    layer: clips of the whole body rest on all. Raises EditError."""
    if p.stance is None:
        raise EditError("nothing says which stance it belongs to")
    layer: Layer = p.layer.value
    kind: Kind = p.kind.value
    if kind == "transition" and p.end_stance is None:
        raise EditError("nothing says where it ends")
    for belief in (p.stance, p.end_stance if kind == "transition" else None):
        if belief is None or belief.value in keys or (belief is p.stance and kind == "stance"):
            continue
        place = places[belief.value]
        loop = loops.get(plain(place.name))
        if loop is None:
            raise EditError(f"no resting clip shows {'its stance' if belief is p.stance else 'the stance it ends in'}, '{place.name}'")
        project = edits.add_stance(project, layer, place.name, [loop])
        keys[place.key] = list(project.graphs[layer].stances)[-1]
    if p.stance.value not in keys:
        project = edits.add_stance(project, layer, places[p.stance.value].name, [p.clip])
        keys[p.stance.value] = list(project.graphs[layer].stances)[-1]
    else:
        end = keys[p.end_stance.value] if kind == "transition" and p.end_stance is not None else None
        project = edits.place(project, [p.clip], layer, kind, keys[p.stance.value], end)
    action = list(project.graphs[layer].actions.values())[-1]
    changes: dict[str, Any] = {"limb": p.limb.value, "tags": p.tags.value if p.tags is not None else action.tags}
    if p.timing:
        changes["timing"] = dict(p.timing)
    project = edits.update_actions(project, [action.id], **changes)
    if kind == "gesture" and (after := project.action(action.id)) is not None:
        stroke = phases(project, after).stroke
        project = edits.update_actions(project, [action.id], timing={"stroke": round(stroke, 3)})
    return project
