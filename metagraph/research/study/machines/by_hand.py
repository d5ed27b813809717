"""How a machine can be drawn by hand, as choices to be tried all: how clips are dropped, how links stand
for connections, how states are selected, and when conditions are set.

A way is carried out by a hand. `CountedHand` makes the real edits and counts operators of the keystroke-level
model; another may do the same with a window's own events.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise, product
from typing import Literal, Protocol

from metagraph.graph.expand import list_connections
from metagraph.graph.manual.machine import ANY
from metagraph.graph.model import LAYERS, Layer, Project
from metagraph.research.study.machines.covering import (
    Cover,
    Rectangle,
    as_set,
    cover_by_rectangles,
    find_target_sets,
    list_bits,
)
from metagraph.research.study.machines.finding import Finder, Words

Drop = Literal["one by one", "many at once"]
Links = Literal["one by one", "from any state", "from many selected", "from aliases", "from a table"]
Pick = Literal["clicks", "words", "rubber bands"]
Settle = Literal["each", "many at once"]


@dataclass(frozen=True, slots=True)
class Way:
    """One combination of choices. named: whether the clips' names tell what they are."""

    drop: Drop
    links: Links
    pick: Pick
    settle: Settle
    named: bool = True

    def __str__(self) -> str:
        return f"clips {self.drop}, links {self.links}, selected by {self.pick}, conditions {self.settle}"


class Work:
    """What is to be drawn in one layer, told by clips.

    clips: in the order of the reference. rows: for each the set of those it leads to. unasked: the set
    entered when something has finished. loops: the set that plays over and over.
    """

    def __init__(self, reference: Project, layer: Layer) -> None:
        graph = reference.graphs[layer]
        actions = list(graph.actions.values())
        self.layer: Layer = layer
        self.clips = tuple(a.clip for a in actions)
        self.names = tuple(reference.clips[c].name for c in self.clips)
        self.seconds = tuple(reference.clips[c].duration for c in self.clips)
        at = {a.id: str(n) for n, a in enumerate(actions)}
        pairs = {(at[c.source], at[c.target]) for c in list_connections(reference, graph)}
        self.rows = find_target_sets([str(n) for n in range(len(actions))], pairs)
        self.unasked = as_set(n for n, a in enumerate(actions) if a.kind in ("stance", "fidget"))
        self.loops = as_set(n for n, a in enumerate(actions) if a.kind == "stance")
        self.limbs = {a.clip: a.limb for a in actions}

    @cached_property
    def cover(self) -> Cover:
        return cover_by_rectangles(self.rows)

    @property
    def every(self) -> int:
        return (1 << len(self.clips)) - 1

    @cached_property
    def order(self) -> tuple[tuple[int, ...], ...]:
        """Blocks of states in which they are laid out for rubber bands: such as are always selected together
        stand together, and blocks that often are stand near each other.
        """
        sets = [s for r in self.cover.rectangles for s in (r.sources, r.targets)] + [self.unasked, self.loops]
        sets += [as_set(n for n, c in enumerate(self.clips) if self.limbs[c] == x) for x in ("left", "right")]
        blocks: dict[tuple[bool, ...], list[int]] = {}
        for n in range(len(self.clips)):
            blocks.setdefault(tuple(bool(s >> n & 1) for s in sets), []).append(n)
        signs = list(blocks)

        def bands(order: Sequence[tuple[bool, ...]]) -> int:
            off = tuple(False for _ in sets)
            around = [off, *order]
            return sum(b and not a for x, y in pairwise(around) for a, b in zip(x, y, strict=True))

        order: list[tuple[bool, ...]] = []
        for sign in signs:  # each block where it makes fewest bands, then moved while that helps
            order = min((order[:i] + [sign] + order[i:] for i in range(len(order) + 1)), key=bands)
        better = True
        while better:
            better = False
            for sign in signs:
                rest = [s for s in order if s != sign]
                best = min((rest[:i] + [sign] + rest[i:] for i in range(len(rest) + 1)), key=bands)
                if bands(best) < bands(order):
                    order, better = best, True
        return tuple(tuple(blocks[s]) for s in order)

    def runs(self, want: int) -> list[tuple[int, int]]:
        """Return a set as the fewest runs of blocks, (first, last)."""
        out: list[tuple[int, int]] = []
        for n, block in enumerate(self.order):
            if any(want >> n & 1 for n in block):
                if out and out[-1][1] == n - 1:
                    out[-1] = (out[-1][0], n)
                else:
                    out.append((n, n))
        return out


class DrawingHand(Protocol):
    """What draws a machine. Clips stand for their states; what is selected stays so from one call to the
    next.
    """

    def begin(self) -> None: ...
    def layer(self, work: Work) -> None: ...
    def look(self, clip: str) -> None: ...
    def drop(self, work: Work, clips: Sequence[str], words: str | None) -> None: ...
    def select(self, work: Work, want: int, words: Words | None, bands: bool) -> None: ...
    def alias(self) -> str: ...
    def link(self, source: str, target: str, many: bool) -> None: ...
    def into(self) -> None: ...
    def ask(self) -> None: ...
    def at_end(self) -> None: ...
    def finish(self) -> None: ...
    def loop(self) -> None: ...
    def limb(self, limb: str) -> None: ...
    def table(self, text: str) -> None: ...


def list_works(reference: Project) -> list[Work]:
    """Return what is to be drawn of a reference, by layer."""
    return [Work(reference, x) for x in LAYERS if reference.graphs[x].actions]


def list_ways(named: bool = True) -> list[Way]:
    """Return every combination of choices. named: the clips' names tell what they are."""
    drops: tuple[Drop, ...] = ("many at once", "one by one") if named else ("one by one",)
    links: tuple[Links, ...] = (
        "from aliases", "from a table", "from any state", "from many selected", "one by one",
    )  # fmt: skip
    picks: tuple[Pick, ...] = ("words", "clicks") if named else ("rubber bands", "clicks")
    settles: tuple[Settle, ...] = ("many at once", "each")
    out = [Way(d, x, p, s, named) for d, x, p, s in product(drops, links, picks, settles)]
    # A table names states by words and tells conditions itself.
    return [w for w in out if w.links != "from a table" or (w.pick == "words" and w.settle == "many at once")]


def make_batches(library: dict[str, str], wanted: Sequence[str]) -> list[tuple[list[str], str]]:
    """Return batches of clips with the words that show just them of a library, which they leave; no words if
    nothing else is left. library: clip -> name.
    """
    out: list[tuple[list[str], str]] = []
    left = dict.fromkeys(wanted)
    while left:
        clips = list(library)
        finder = Finder([library[c] for c in clips])
        want = as_set(n for n, c in enumerate(clips) if c in left)
        if want == (1 << len(clips)) - 1:
            batch, words = list(left), ""
        else:
            found = finder.best(want)
            one = list_bits(want)[0]
            words = found.text if found is not None else library[clips[one]]
            batch = list(left) if found is not None else [clips[one]]
        out.append((batch, words))
        for clip in batch:
            left.pop(clip)
            library.pop(clip)
    return out


class MachineDrawing:
    """Carries a way out. limbs: clip -> the limb its state has once it was dropped."""

    def __init__(self, way: Way, hand: DrawingHand, library: Sequence[tuple[str, str]]) -> None:
        self.way, self.hand = way, hand
        self.library = dict(library)  # what is not dropped yet: clip -> name
        self.finders: dict[Layer, Finder] = {}
        self.waiting = self.plain = (
            0  # what links lead to that wait for a request as they are drawn, or do not
        )

    def draw(self, some: Sequence[Work], guessed: Mapping[str, str], look: bool) -> None:
        """Draw every layer's machine. look: each clip is looked at once."""
        if self.way.drop == "many at once":
            self.hand.begin()
        for work in some:
            self.finders[work.layer] = Finder(work.names)
            self.hand.layer(work)
            self._drop(work, look)
            self._limbs(work, guessed)
            self.select(work, work.loops)
            self.hand.loop()
            if self.way.links == "from a table":
                self.hand.table(self._table(work))
            else:
                self.waiting = self.plain = 0
                for rectangle in work.cover.rectangles:
                    self._link(work, rectangle)
                if self.way.settle == "many at once":
                    self._settle(work)

    # --- clips

    def _drop(self, work: Work, look: bool) -> None:
        if self.way.drop == "one by one":
            blocks = work.order if self.way.pick == "rubber bands" else [range(len(work.clips))]
            for clip in (work.clips[n] for block in blocks for n in block):
                if look:
                    self.hand.look(clip)
                self.hand.drop(work, [clip], _prefix(self.library[clip]) if self.way.named else None)
            return
        for clip in work.clips if look else ():
            self.hand.look(clip)
        for clips, words in make_batches(self.library, work.clips):
            self.hand.drop(work, clips, words)

    def _limbs(self, work: Work, guessed: Mapping[str, str]) -> None:
        for limb in ("left", "right", "both"):
            wrong = as_set(
                n for n, c in enumerate(work.clips) if work.limbs[c] == limb and guessed[c] != limb
            )
            if wrong:
                self.select(work, wrong)
                self.hand.limb(limb)

    # --- links

    def select(self, work: Work, want: int) -> None:
        """Select a set in the way's manner."""
        words = self.finders[work.layer].best(want) if self.way.pick == "words" else None
        self.hand.select(work, want, words, self.way.pick == "rubber bands")

    def _link(self, work: Work, r: Rectangle) -> None:
        hand, way = self.hand, self.way
        several = way.links == "from any state" and r.sources == work.every
        if several or way.links == "from aliases":
            self.waiting |= r.targets
        else:
            self.plain |= r.targets
        if way.links == "from aliases":
            self.select(work, r.sources)
            alias = hand.alias()
            self.select(work, r.targets)
            hand.link(alias, work.clips[list_bits(r.targets)[0]], True)
            if way.settle == "each":
                self._unask(work, r.targets)
            return
        if several:
            self.select(work, r.targets)
            hand.link(ANY, work.clips[list_bits(r.targets)[0]], True)
            hand.at_end()
            if way.settle == "each":
                self._unask(work, r.targets)
            return
        for target in list_bits(r.targets):
            sources = r.sources & ~(1 << target)
            if not sources:
                continue
            if way.links == "one by one":
                for source in list_bits(sources):
                    hand.link(work.clips[source], work.clips[target], False)
                    if way.settle == "each":
                        self._ask(work, target, 1 << source)
                continue
            self.select(work, sources)
            hand.link(work.clips[list_bits(sources)[0]], work.clips[target], True)
            if way.settle == "each":
                self._ask(work, target, sources)

    def _ask(self, work: Work, target: int, sources: int) -> None:
        """Let the links that were just drawn wait for a request, and those of what does not loop for its
        end.
        """
        if not work.unasked >> target & 1:
            self.hand.ask()
            if sources & ~work.loops:
                self.hand.at_end()

    def _unask(self, work: Work, targets: int) -> None:
        if targets & work.unasked:
            self.select(work, targets & work.unasked)
            self.hand.into()
            self.hand.finish()

    def _settle(self, work: Work) -> None:
        """Set the conditions of all links of the layer."""
        if self.waiting:
            self._unask(work, self.waiting | self.plain)
        asked = self.plain & ~work.unasked
        if asked:
            self.select(work, asked)
            self.hand.into()
            self.hand.ask()
            self.hand.at_end()

    def _table(self, work: Work) -> str:
        """Return the table that names every rectangle by patterns."""
        finder = self.finders[work.layer]
        lines = ["from,to,when,exit"]
        for r in work.cover.rectangles:
            sources, alone = _pattern(finder, r.sources), r.sources.bit_count() == 1
            asked = "request,end" if alone else ""  # as links from an alias are drawn
            for targets, when in ((r.targets & ~work.unasked, asked), (r.targets & work.unasked, "finished")):
                if targets:
                    lines.append(f"{sources},{_pattern(finder, targets)},{when}".rstrip(","))
        return "\n".join(lines)


def _prefix(name: str) -> str:
    """Return what is searched for once for all clips of a stance, where names begin with it."""
    return name.split("__")[0] + "__" if "__" in name else name


def _pattern(finder: Finder, want: int) -> str:
    """Return parts of names as a table's patterns that fit just a set: several with | between them."""
    inside = {m: p for m, p in finder.parts.items() if m & ~want == 0}
    out: list[str] = []
    left = want
    while left:
        best = max(inside, key=lambda m: (m & left).bit_count() / (len(inside[m]) + 3), default=0)
        if not best & left:
            raise ValueError("no part of their names tells these states from the others")
        out.append(f"*{inside[best]}*")
        left &= ~best
    return "|".join(out)
