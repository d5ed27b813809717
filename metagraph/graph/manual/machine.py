"""The manual state machine: states and links drawn one by one, as in the engines' editors. What the
meta-graph is compared with.

A state plays a part of a clip. A link leads from one state, from the states an alias stands for, or from any,
to another; it is taken when its source has finished, or when its trigger is fired. An alias with an entry is
a group, a machine inside the machine: a link to it leads to its entry. One machine a layer; ids are never
names and never change.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from types import MappingProxyType
from typing import Literal, get_args

from metagraph.graph.words import Layer, Limb

When = Literal["finished", "request"]
WHENS: tuple[When, ...] = get_args(When)
ANY = "any"  # the source of links that lead away from every state


@dataclass(frozen=True, slots=True)
class Condition:
    """When a link is taken. "finished": once its source has, unasked; "request": when `trigger` is fired.

    weight: relative, > 0; how likely this one is among several finished links of a state.
    """

    when: When = "finished"
    trigger: str = ""
    weight: float = 1.0


@dataclass(frozen=True, slots=True)
class State:
    """One use of a clip. start, end: the part that plays, seconds of the clip; `end` None is the clip's end.

    loop: it repeats; else it holds its last frame. limb, joints: the only ones it moves (`joints` empty:
    all); joint_weights: how far those that move in part, as an action's. x, y: where its left upper corner
    stands in the editor.
    """

    id: str
    clip: str
    name: str
    layer: Layer
    loop: bool = False
    start: float = 0.0
    end: float | None = None
    limb: Limb = "both"
    joints: tuple[str, ...] = ()
    x: float = 0.0
    y: float = 0.0
    joint_weights: tuple[tuple[str, float], ...] = ()


@dataclass(frozen=True, slots=True)
class Alias:
    """Stands for several states: a link from it can be taken from each of them.

    states: which, by id; every: all of the layer instead, those to come, too. again: its links may lead a
    state back to itself. entry: the state that a link to it leads to, which makes it a group; None: no link
    leads to it. x, y: where its left upper corner stands in the editor.
    """

    id: str
    name: str
    layer: Layer
    states: tuple[str, ...] = ()
    every: bool = False
    again: bool = False
    entry: str | None = None
    x: float = 0.0
    y: float = 0.0


@dataclass(frozen=True, slots=True)
class Link:
    """source: the id of a state or alias, or ANY; target: that of a state, or of an alias that has an entry.
    blend: seconds in which the target takes over, both running on.

    exit_time: seconds of the source's clip at which it may be left, in a loop each time round. exit_part,
    0..1, in its place: the share of what its source plays by which the blend is over; 1 is the end of the
    source, and a loop, which has none, is left at once. Both None: a finished link blends so that the source
    ends with the blend, a requested one is taken at once.
    """

    id: str
    source: str
    target: str
    condition: Condition = Condition()
    exit_time: float | None = None
    blend: float = 0.25
    exit_part: float | None = None


@dataclass(frozen=True)
class Manual:
    """One layer's machine. start: the state it begins in. any_x, any_y: where the node for any state stands
    in the editor.
    """

    layer: Layer
    states: Mapping[str, State] = field(default_factory=dict)
    links: Mapping[str, Link] = field(default_factory=dict)
    start: str | None = None
    any_x: float = -280.0
    any_y: float = 0.0
    aliases: Mapping[str, Alias] = field(default_factory=dict)

    @cached_property
    def out(self) -> Mapping[str, tuple[Link, ...]]:
        """Links by their source, ANY among them, in the order they were drawn."""
        return _by(self.links, "source")

    @cached_property
    def into(self) -> Mapping[str, tuple[Link, ...]]:
        """Links by their target, in the order they were drawn."""
        return _by(self.links, "target")

    @cached_property
    def triggers(self) -> tuple[str, ...]:
        """Every trigger a link waits for, sorted."""
        return tuple(
            sorted({x.condition.trigger for x in self.links.values() if x.condition.when == "request"})
        )

    @cached_property
    def _member(self) -> Mapping[str, tuple[Alias, ...]]:
        """The aliases each state is one of: those it was chosen for before those of every state."""
        out: dict[str, list[Alias]] = {i: [] for i in self.states}
        for alias in sorted(self.aliases.values(), key=lambda a: a.every):
            for state in self.members(alias):
                out[state].append(alias)
        return MappingProxyType({i: tuple(found) for i, found in out.items()})

    def members(self, alias: Alias) -> tuple[str, ...]:
        """Return the states an alias stands for, in the order of the machine."""
        chosen = frozenset(alias.states)
        return tuple(i for i in self.states if alias.every or i in chosen)

    def end(self, link: Link) -> str | None:
        """Return the state a link leads to, None if its target is a group without an entry."""
        group = self.aliases.get(link.target)
        end = link.target if group is None else group.entry
        return end if end in self.states else None

    def leaving(self, state: str) -> Iterator[Link]:
        """Yield the links by which a state can be left, each with the state it leads to as its target.

        Its own come first, then those of its aliases, then those from any state, which lead to another one.
        Of links that are taken alike to the same state only the first kind is there.
        """
        taken: set[tuple[str, str, str]] = set()
        wider: list[tuple[Iterable[Link], bool]] = [(self.out.get(state, ()), True)]
        wider += [(self.out.get(a.id, ()), a.again) for a in self._member.get(state, ())]
        wider.append((self.out.get(ANY, ()), False))
        for links, again in wider:
            mine = set()
            for link in links:
                end = self.end(link)
                if end is None or (end == state and not again):
                    continue
                how = (end, link.condition.when, link.condition.trigger * (link.condition.when == "request"))
                if how not in taken:
                    mine.add(how)
                    yield link if end == link.target else replace(link, target=end)
            taken |= mine

    @cached_property
    def ways(self) -> Mapping[tuple[str, str], tuple[Link, ...]]:
        """Every connection, (source state, target state), with the links that make it, as `leaving` has
        them.
        """
        out: dict[tuple[str, str], tuple[Link, ...]] = {}
        for state in self.states:
            for link in self.leaving(state):
                out[state, link.target] = (*out.get((state, link.target), ()), link)
        return MappingProxyType(out)

    @cached_property
    def _entering(self) -> Mapping[str, tuple[Link, ...]]:
        out: dict[str, list[Link]] = {}
        for link in self.links.values():
            if (end := self.end(link)) is not None:
                out.setdefault(end, []).append(link)
        return MappingProxyType({end: tuple(group) for end, group in out.items()})

    def entering(self, state: str) -> tuple[Link, ...]:
        """Return the links that lead to a state, those to a group it is the entry of, too, in the order they
        were drawn.
        """
        return self._entering.get(state, ())

    def reachable(self) -> frozenset[str]:
        """Return the states that can come to play, the start among them."""
        if self.start is None or self.start not in self.states:
            return frozenset()
        seen = {self.start}
        queue = [self.start]
        for state in queue:
            for link in self.leaving(state):
                if link.target not in seen:
                    seen.add(link.target)
                    queue.append(link.target)
        return frozenset(seen)


def _by(links: Mapping[str, Link], field_name: str) -> Mapping[str, tuple[Link, ...]]:
    out: dict[str, list[Link]] = {}
    for link in links.values():
        out.setdefault(getattr(link, field_name), []).append(link)
    return MappingProxyType({key: tuple(group) for key, group in out.items()})


def expand_links(manual: Manual) -> frozenset[tuple[str, str]]:
    """Return every connection as (source state, target state): a link from an alias or from any state stands
    for one from each of its states, or from every other.
    """
    return frozenset(manual.ways)


def remove_from_machine(manual: Manual, states: Collection[str] = (), links: Collection[str] = ()) -> Manual:
    """Return the machine without some states and aliases, the links that touch them, and some links."""
    gone = set(states)
    left = {i: s for i, s in manual.states.items() if i not in gone}
    kept = {
        i: x
        for i, x in manual.links.items()
        if i not in links and x.source not in gone and x.target not in gone
    }
    start = manual.start if manual.start not in gone else next(iter(left), None)
    aliases = {i: _alias_without(a, gone) for i, a in manual.aliases.items() if i not in gone}
    return replace(manual, states=left, links=kept, start=start, aliases=aliases)


def _alias_without(alias: Alias, gone: Collection[str]) -> Alias:
    if alias.entry not in gone and not any(s in gone for s in alias.states):
        return alias
    entry = None if alias.entry in gone else alias.entry
    return replace(alias, states=tuple(s for s in alias.states if s not in gone), entry=entry)


def remove_clips_from_machines(
    manuals: Mapping[Layer, Manual], clips: Collection[str]
) -> Mapping[Layer, Manual]:
    """Return the machines without the states that use some clips; the same object if there are none."""
    gone = {layer: [s.id for s in m.states.values() if s.clip in clips] for layer, m in manuals.items()}
    if not any(gone.values()):
        return manuals
    return {layer: remove_from_machine(m, gone[layer]) for layer, m in manuals.items()}
