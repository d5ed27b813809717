"""A hand that draws a machine by the real edits and counts what that takes a person, without a window: so
that every way of going about it can be tried.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from typing import Any

from metagraph.formats.manual_table import fill_machine, parse_manual_table
from metagraph.graph.edit_error import EditError
from metagraph.graph.edits import guess_limb, remove_actions
from metagraph.graph.manual import edits as manual_edits
from metagraph.graph.manual import groups as manual_groups
from metagraph.graph.model import Layer, Project
from metagraph.research.study.machines.by_hand import MachineDrawing, Way, Work, list_ways, list_works
from metagraph.research.study.machines.finding import Words
from metagraph.research.study.machines.klm import predict_seconds
from metagraph.research.study.machines.normal_machine import normalize_machines
from metagraph.research.study.scores.machines import Score, score

FILE_NAME = 10  # letters typed for a table's file


class OperatorCounts:
    """Counts operators; a hand goes to the other device if that is needed."""

    def __init__(self) -> None:
        self.counts: Counter[str] = Counter()
        self._hand = ""

    def _home(self, device: str) -> None:
        if self._hand not in ("", device):
            self.counts["H"] += 1
        self._hand = device

    def think(self, times: int = 1) -> None:
        self.counts["M"] += times

    def keys(self, count: int) -> None:
        self._home("keyboard")
        self.counts["K"] += count

    def click(self, moved: bool = True) -> None:
        self._home("mouse")
        self.counts["P"] += moved
        self.counts["B"] += 2

    def drag(self) -> None:
        self._home("mouse")
        self.counts["P"] += 2
        self.counts["B"] += 2

    def choose(self, steps: int = 1) -> None:
        """Open a list and take an entry by keys."""
        self.think()
        self.click()
        self.keys(steps + 1)


class CountedHand:
    """project: what was drawn so far; at first the clips alone."""

    def __init__(self, project: Project) -> None:
        self.project, self.made = project, OperatorCounts()
        self.on: Layer = "arms"
        self.nodes: tuple[str, ...] = ()
        self.links: tuple[str, ...] = ()
        self.state: dict[str, str] = {}  # clip -> its state
        self._typed: str | None = None
        self.looked = 0.0

    def begin(self) -> None:
        """Show only the clips that are not dropped yet."""
        self.made.think()
        self.made.click()

    def layer(self, work: Work) -> None:
        if work.layer != self.on:
            self.made.think()
            self.made.keys(2)
        self.made.think()
        self.made.counts["S"] += 1  # to see where all will stand
        self.on = work.layer

    def look(self, clip: str) -> None:
        """Go to the next clip in the library and play it, by keys."""
        self.made.keys(2)
        self.looked += self.project.clips[clip].duration

    def drop(self, work: Work, clips: Sequence[str], words: str | None) -> None:
        made = self.made
        made.think()
        if words is not None and words != self._typed and (words or self._typed):
            made.think(1 + words.count(" ") + words.count("|"))
            made.keys(
                4 + max(1, len(words)) + (len(clips) > 1)
            )  # to the search field, all of it, and out again
        elif len(clips) > 1:
            made.click()
        self._typed = words if words is not None else self._typed
        if len(clips) > 1:
            made.keys(2)
        made.drag()
        self._do(manual_edits.add_states(self.project, clips, self.on))
        found = list(self.project.manual[self.on].states.values())[-len(clips) :]
        self.state |= {s.clip: s.id for s in found}
        self.nodes, self.links = tuple(s.id for s in found), ()

    def select(self, work: Work, want: int, words: Words | None, bands: bool) -> None:
        """Select in the cheapest manner there is."""
        states = tuple(self.state[c] for n, c in enumerate(work.clips) if want >> n & 1)
        if set(states) == set(self.nodes):
            return
        clicks = (1 + (len(states) > 1)) * 0.28 + 1.35 + 1.3 * len(states)
        typed = 1.35 * words.terms + 0.28 * (len(words.text) + 2) + 0.8 if words is not None else 1e9
        runs = work.runs(want) if bands else []
        banded = 1.35 + 2.4 * len(runs) + 0.28 * (len(runs) > 1) if runs else 1e9
        if words is not None and typed <= min(clicks, banded):
            self.made.think(words.terms)
            self.made.keys(len(words.text) + 2)
        else:
            self.made.think()
            if len(runs or states) > 1:
                self.made.keys(1)  # held down
            for _ in runs if banded < clicks else states:
                self.made.drag() if banded < clicks else self.made.click()
        self.nodes, self.links = states, ()

    def alias(self) -> str:
        before = set(self.project.manual[self.on].aliases) if self.on in self.project.manual else set()
        self.made.think()
        self.made.keys(2)
        self._do(manual_groups.add_alias(self.project, self.on, self.nodes))
        ident = next(i for i in self.project.manual[self.on].aliases if i not in before)
        self.nodes, self.links = (ident,), ()
        return ident

    def link(self, source: str, target: str, many: bool) -> None:
        if not many and self.nodes:
            self.made.click()  # if nothing is: what is selected would get links as well
            self.nodes = ()
        before = set(self.project.manual[self.on].links)
        a, b = self.state.get(source, source), self.state[target]
        sources = self.nodes if a in self.nodes else (a,)
        targets = self.nodes if b in self.nodes and a not in self.nodes else (b,)
        self.made.think()
        self.made.drag()
        self._do(manual_edits.add_links(self.project, self.on, sources, targets))
        self.nodes = ()
        self.links = tuple(i for i in self.project.manual[self.on].links if i not in before)

    def into(self) -> None:
        self.made.think()
        self.made.keys(1)
        self.links = manual_groups.find_links(self.project.manual[self.on], self.nodes, into=True)
        self.nodes = ()

    def ask(self) -> None:
        self.made.choose()
        self._do(manual_edits.update_links(self.project, self.links, condition={"when": "request"}))

    def finish(self) -> None:
        self.made.choose()
        self._do(manual_edits.update_links(self.project, self.links, condition={"when": "finished"}))

    def at_end(self) -> None:
        self.made.choose()
        self._do(manual_edits.update_links(self.project, self.links, exit_part=1.0, exit_time=None))

    def loop(self) -> None:
        self.made.think()
        self.made.click()
        self._do(manual_edits.update_states(self.project, self.nodes, loop=True))

    def limb(self, limb: str) -> None:
        self.made.think()
        self.made.click()
        self._do(manual_edits.update_states(self.project, self.nodes, limb=limb))

    def table(self, text: str) -> None:
        """Type a table in another program, save it, and import it."""
        self.made.think(2 * text.count("\n") + 1)
        self.made.keys(len(text) + FILE_NAME + 2)
        self.made.click()
        self.made.keys(FILE_NAME + 1)
        out = fill_machine(self.project, self.on, parse_manual_table(text))
        if out.problems:
            raise EditError("; ".join(out.problems))
        self._do(out.project)

    def _do(self, project: Project) -> None:
        self.project = project


@dataclass(frozen=True)
class Tried:
    """A way and what it took. seconds: predicted, without looking. looked: seconds of motion that were
    looked at. edges: links that were drawn. score: beside the reference.
    """

    way: Way
    operators: Counter[str]
    seconds: float
    looked: float
    edges: int
    score: Score
    project: Project


def strip_project(reference: Project) -> Project:
    """Return a reference's clips without what was made of them."""
    out = remove_actions(reference, [a.id for a in reference.actions()])
    return replace(out, manual={})


def try_way(way: Way, reference: Project, look: bool = False) -> Tried:
    """Draw a reference by hand in one way."""
    hand: Any = CountedHand(strip_project(reference))
    some = list_works(reference)
    wanted = [c for w in some for c in w.clips]
    library = [(c, reference.clips[c].name) for c in wanted]
    guessed = {
        c: guess_limb(n) if w.layer == "arms" else "both"
        for w in some
        for c, n in zip(w.clips, w.names, strict=True)
    }
    MachineDrawing(way, hand, library).draw(some, guessed, look)
    edges = sum(len(m.links) for m in hand.project.manual.values())
    found = score(normalize_machines(hand.project, True), normalize_machines(reference, False))
    counts = hand.made.counts
    return Tried(way, counts, predict_seconds(counts), hand.looked, edges, found, hand.project)


def search_ways(reference: Project, named: bool = True, look: bool = False) -> list[Tried]:
    """Try every way, the cheapest first; those whose machine is not the reference come last, and those that
    cannot be gone, as names do not tell states apart, are left out.
    """
    out = []
    for way in list_ways(named):
        with suppress(ValueError):  # EditError among them
            out.append(try_way(way, reference, look))
    return sorted(out, key=lambda t: (bool(t.score.mistakes), t.seconds + t.looked))
