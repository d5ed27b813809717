"""Made label sets: recipes, drawn by seed or named, and the sets they give."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import permutations
from pathlib import Path

import numpy as np

from metagraph.formats.bvh.file import write_bvh
from metagraph.formats.gltf.writer import write_glb
from metagraph.graph import edits
from metagraph.graph.model import Project
from metagraph.motion.clip import Clip
from tests.label_zoo import bodies, motions, rigs
from tests.label_zoo.bodies import Whole
from tests.label_zoo.grammar import Grammar, Namer
from tests.label_zoo.motions import Recording
from tests.label_zoo.rigs import Figure
from tests.label_zoo.source import Motion, clip_of, takes

Row = dict[str, str | None]
SWAPS: Mapping[str, str] = {"left": "right", "right": "left", "weight_left": "weight_right"}
SWAPS = {**SWAPS, "weight_right": "weight_left", "tilt_left": "tilt_right", "tilt_right": "tilt_left"}


@dataclass(frozen=True)
class Recipe:
    """How a set is made. layers: for layered sets, the stances each layer has. wholes: for recordings of the
    whole body, the stances. steps: how many clips are none of the four kinds. clips: at most, of each stance,
    beside its loop and its transitions. unseen: share of the stances whose loop is missing. unlinked: share
    of transitions that are missing. wrong: share of the clips that have the name of another.
    """

    layers: tuple[str, ...] = ()
    wholes: tuple[Whole, ...] = ()
    grammar: Grammar = field(default_factory=Grammar)
    figure: Figure = field(default_factory=Figure)
    recording: Recording = field(default_factory=Recording)
    steps: int = 0
    clips: int = 9
    unseen: float = 0.0
    unlinked: float = 0.3
    wrong: float = 0.0

    @property
    def what(self) -> tuple[str, ...]:
        """Words for the troubles it has; a benchmark groups by them."""
        g, f, r = self.grammar, self.figure, self.recording
        bodies_ = {w.body for w in self.wholes}
        found = {
            "layered": not self.wholes,
            "whole body": bool(self.wholes),
            "seated": bool(bodies_ & set(bodies.SEATED)),
            "close stances": any(w.near for w in self.wholes),
            "unseen stances": self.unseen > 0,
            "steps": self.steps > 0,
            "wrong names": self.wrong > 0,
            "opaque names": bool(g.opaque),
            "numbered stances": bool(g.numbered) and not g.opaque,
            "names without stances": (g.silent or g.order == "action only") and not g.opaque,
            f"language {g.language}": g.language not in ("en", "synonym") and not g.opaque,
            "other languages": g.language not in ("en", "synonym") and not g.opaque,
            "synonyms": g.language == "synonym" and not g.opaque,
            "proportions": bool(f.limbs),
            "other joints": f.names != "sample" or f.axes != "world" or f.rest != "A",
            "joints missing": bool(f.missing),
            "joints extra": bool(f.extra),
            "units": r.size != 1.0,
            "rate": r.fps != 30.0,
            "noise": r.noise > 0,
            "drift": r.drift > 0,
            "warped": r.warp > 0 or r.sizes != (1.0, 1.0),
            "trimmed": r.trim > 0,
            "strewn": r.strewn,
            "bind keys": bool(r.bind),
            "mirrored": r.mirrored,
        }
        return tuple(word for word, is_ in found.items() if is_)


@dataclass(frozen=True, eq=False)
class MadeSet:
    """A set with its truth. truth: clip name -> row as in the files of truth, kind None for none of the
    four. what: words for the troubles it has. misnamed: clips whose name is another's. made_from: sets that
    must not be learned from where this one measures, itself left out.
    """

    name: str
    seed: int
    project: Project
    truth: Mapping[str, Row]
    what: tuple[str, ...]
    misnamed: frozenset[str] = frozenset()
    made_from: tuple[str, ...] = ("sample_clips",)
    stance_words: Mapping[str, str] = field(default_factory=dict)

    @property
    def kinds(self) -> Counter[str]:
        """How many clips of each kind there are."""
        return Counter(row["kind"] or "none" for row in self.truth.values())

    def write(self, folder: Path, bvh: bool = False) -> list[Path]:
        """Write each clip into a GLB of its name, or a BVH in centimetres; with `_` where a file's name
        cannot be.
        """
        folder.mkdir(parents=True, exist_ok=True)
        out = []
        for entry in self.project.clips.values():
            assert entry.motion is not None
            name = re.sub(r'[/\\:*?"<>|]', "_", entry.name)
            out.append(folder / f"{name}{'.bvh' if bvh else '.glb'}")
            if bvh:
                write_bvh(entry.motion, out[-1])
            else:
                write_glb(out[-1], [entry.motion])
        return out


@dataclass(frozen=True, eq=False)
class _Cut:
    """A clip to be: what it shows, and what it is. key: of its action's words."""

    motion: Motion
    kind: str | None
    layer: str | None
    stance: str
    end: str
    limb: str | None
    key: str


def make(name: str, recipe: Recipe, seed: int) -> MadeSet:
    """Make a set; the same name, recipe and seed always give the same."""
    draw = np.random.default_rng([seed, *name.encode()])
    if recipe.wholes:
        words = {str(n): _words(whole, recipe.wholes) for n, whole in enumerate(recipe.wholes)}
        cuts = _whole_cuts(recipe, draw)
    else:
        cuts = _layered_cuts(recipe, draw)
        words = {s: s for s in dict.fromkeys(c.stance for c in cuts if c.stance)}
    if recipe.recording.mirrored:
        cuts = [_mirrored(cut) for cut in cuts]
        words = {SWAPS.get(k, k): " ".join(SWAPS.get(w, w) for w in v.split()) for k, v in words.items()}
    cuts = _thinned(cuts, recipe, draw)
    namer = Namer(recipe.grammar, words, draw)
    order = sorted(cuts, key=lambda c: c.kind != "stance")  # loops get the plain names
    named = [(namer.name(c.kind, c.key, c.stance, c.end, c.limb), c) for c in order]
    clips = [(name_, _finished(name_, cut, recipe, draw), cut) for name_, cut in named]
    clips, lying = _misnamed(clips, recipe.wrong, draw)
    clips.sort(key=lambda x: x[0])
    project = edits.add_clips(Project(name), ((f"{n}.glb", 0, "", clip.renamed(n)) for n, clip, _ in clips))
    truth = {n: _row(cut, namer) for n, _, cut in clips}
    return MadeSet(name, seed, project, truth, recipe.what, lying, stance_words=words)


def _row(cut: _Cut, namer: Namer) -> Row:
    if cut.kind is None:
        return dict.fromkeys(("kind", "layer", "stance", "end_stance", "limb"))
    return {
        "kind": cut.kind,
        "layer": cut.layer,
        "stance": namer.stance(cut.stance),
        "end_stance": namer.stance(cut.end) if cut.end else None,
        "limb": cut.limb,
    }


def _words(whole: Whole, among: Sequence[Whole]) -> str:
    """Return keys of the words that tell a stance from the others; of the body at least."""
    arms = len({w.arms for w in among}) > 1 and whole.arms != "hands_at_sides"
    heads = len({w.head for w in among}) > 1 and whole.head != "straight"
    keys = [whole.body] if not arms or len({w.body for w in among}) > 1 else []
    keys += [whole.arms] * arms + [whole.head] * heads
    return " ".join([*keys, "ABCDEF"[whole.near - 1]] if whole.near else keys)


def _layered_cuts(recipe: Recipe, draw: np.random.Generator) -> list[_Cut]:
    """Return the clips of stances as the sample has them, and steps."""
    mine = [t for t in takes() if t.stance in recipe.layers and (not t.end or t.end in recipe.layers)]
    cuts = [_Cut(t.motion, t.kind, t.layer, t.stance, t.end, t.limb, t.action) for t in mine]
    return cuts + _steps(recipe, Whole(), draw)


def _steps(recipe: Recipe, whole: Whole, draw: np.random.Generator) -> list[_Cut]:
    names = draw.permutation(bodies.STEPS)
    out = []
    for n in range(recipe.steps):
        key = str(names[n % len(names)])
        out.append(_Cut(bodies.steps(key, whole, draw), None, None, "", "", None, key))
    return out


def _whole_cuts(recipe: Recipe, draw: np.random.Generator) -> list[_Cut]:
    """Return recordings of the whole body in the recipe's stances."""
    wholes = recipe.wholes
    telling = {"body": {w.body for w in wholes}, "arms": {(w.arms, w.near) for w in wholes}}
    telling["head"] = {w.head for w in wholes}
    carrier = next((layer for layer, some in telling.items() if len(some) > 1), "body")
    out = []
    for n, whole in enumerate(wholes):
        key = str(n)
        motion = bodies.resting(whole, int(draw.integers(120, 330)), draw)
        # Where only arms or heads tell stances apart, a loop of the whole body may rest on any layer.
        out.append(_Cut(motion, "stance", "body" if carrier == "body" else None, key, "", None, ""))
        for take in takes():
            at = {"arms": whole.arms, "head": whole.head, "body": whole.body}[take.layer or "arms"]
            seated = take.layer == "body" and whole.body in bodies.MADE and take.action in UPPER
            if take.action and (take.stance == at or seated):
                own = bodies.upper_only(take.motion) if seated else take.motion
                layer = take.layer or "arms"
                moved = bodies.over(whole, own, "seat" if seated else layer, draw)
                # Who sits and only bends the trunk does so with body, arms or head, as one likes.
                of = None if seated else layer
                out.append(_Cut(moved, take.kind, of, key, "", take.limb, take.action))
    for a, b in permutations(range(len(wholes)), 2):
        one, two = wholes[a], wholes[b]
        arms = [t for t in takes() if t.layer == "arms" and (t.stance, t.end) == (one.arms, two.arms)]
        frames = int(draw.integers(36, 80))
        motion = bodies.between(one, two, frames, draw, arms[0].motion if arms else None)
        out.append(_Cut(motion, "transition", carrier, str(a), str(b), None, ""))
    return out + _steps(recipe, next((w for w in wholes if w.body not in bodies.SEATED), Whole()), draw)


UPPER = ("lean_in", "straighten", "roll_shoulders", "settle", "sway", "recoil")


def _mirrored(cut: _Cut) -> _Cut:
    swap = {k: SWAPS.get(k, k) for k in (cut.stance, cut.end)}
    limb = SWAPS.get(cut.limb, cut.limb) if cut.limb else None
    return _Cut(cut.motion, cut.kind, cut.layer, swap[cut.stance], swap[cut.end], limb, cut.key)


def _thinned(cuts: Iterable[_Cut], recipe: Recipe, draw: np.random.Generator) -> list[_Cut]:
    """Return the clips a studio came to make: not every loop, not every change, some actions."""
    cuts = list(cuts)
    stances = list(dict.fromkeys(c.stance for c in cuts if c.kind == "stance"))
    gone = set(draw.permutation(stances)[: round(recipe.unseen * len(stances))].tolist())
    out: list[_Cut] = []
    for stance in stances:
        mine = [c for c in cuts if c.stance == stance]
        out += [c for c in mine if c.kind == "stance" and stance not in gone]
        changes = [c for c in mine if c.kind == "transition"]
        kept = draw.permutation(len(changes))[: max(1, round((1 - recipe.unlinked) * len(changes)))]
        out += [changes[i] for i in sorted(kept)]
        actions = [c for c in mine if c.kind in ("gesture", "fidget")]
        out += [actions[i] for i in sorted(draw.permutation(len(actions))[: recipe.clips])]
    return out + [c for c in cuts if c.kind is None]


def _finished(name: str, cut: _Cut, recipe: Recipe, draw: np.random.Generator) -> Clip:
    """Return a clip as it was recorded, on the set's figure."""
    how = recipe.recording
    clip = motions.recorded(clip_of(name, cut.motion), how, draw, cut.kind == "stance")
    return motions.scaled(motions.with_bind(rigs.on(clip, recipe.figure), how), how.size)


def _misnamed(
    clips: list[tuple[str, Clip, _Cut]], share: float, draw: np.random.Generator
) -> tuple[list[tuple[str, Clip, _Cut]], frozenset[str]]:
    """Return clips some of which swapped names with one of another kind or stance; and which names lie."""
    order = [int(i) for i in draw.permutation(len(clips)) if clips[int(i)][2].kind is not None]
    names = [name for name, _, _ in clips]
    lying: set[str] = set()
    wanted = max(2, round(share * len(clips))) if share else 0
    for i in order:
        if len(lying) >= wanted or names[i] in lying:
            continue
        mine = clips[i][2]
        for j in order:
            other = clips[j][2]
            unlike = (mine.kind, mine.stance, mine.end) != (other.kind, other.stance, other.end)
            if i != j and unlike and names[j] not in lying:
                names[i], names[j] = names[j], names[i]
                lying |= {names[i], names[j]}
                break
    return [(n, clip, cut) for n, (_, clip, cut) in zip(names, clips, strict=True)], frozenset(lying)
