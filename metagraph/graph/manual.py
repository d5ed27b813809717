"""The manual state machine: states and links drawn one by one, as in the engines' editors. What the
meta-graph is compared with.

A state plays a part of a clip. A link leads from one state, or from any, to another; it is taken when its
source has finished, or when its trigger is fired. One machine a layer; ids are never names and never change.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
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
    all). x, y: where its left upper corner stands in the editor.
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


@dataclass(frozen=True, slots=True)
class Link:
    """source: a state's id, or ANY; target: a state's id. blend: seconds in which the target takes over, both
    running on.

    exit_time: seconds of the source's clip at which it may be left, in a loop each time round. None: a
    finished link blends so that the source ends with the blend, a requested one is taken at once.
    """

    id: str
    source: str
    target: str
    condition: Condition = Condition()
    exit_time: float | None = None
    blend: float = 0.25


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

    def leaving(self, state: str) -> Iterator[Link]:
        """Yield the links by which a state can be left: its own, then those from any state to another one."""
        yield from self.out.get(state, ())
        for link in self.out.get(ANY, ()):
            if link.target != state:
                yield link

    def reachable(self) -> frozenset[str]:
        """Return the states that can come to play, the start among them."""
        if self.start is None or self.start not in self.states:
            return frozenset()
        seen = {self.start}
        queue = [self.start]
        for state in queue:
            for link in self.leaving(state):
                if link.target in self.states and link.target not in seen:
                    seen.add(link.target)
                    queue.append(link.target)
        return frozenset(seen)


def _by(links: Mapping[str, Link], field_name: str) -> Mapping[str, tuple[Link, ...]]:
    out: dict[str, list[Link]] = {}
    for link in links.values():
        out.setdefault(getattr(link, field_name), []).append(link)
    return MappingProxyType({key: tuple(group) for key, group in out.items()})


def links_expanded(manual: Manual) -> frozenset[tuple[str, str]]:
    """Return every connection as (source state, target state): a link from any state stands for one from
    every other.
    """
    states = manual.states
    out = {(x.source, x.target) for x in manual.links.values() if x.source in states and x.target in states}
    for link in manual.out.get(ANY, ()):
        if link.target in states:
            out.update((state, link.target) for state in states if state != link.target)
    return frozenset(out)


def without(manual: Manual, states: Collection[str] = (), links: Collection[str] = ()) -> Manual:
    """Return the machine without some states, the links that touch them, and some links."""
    gone = set(states)
    left = {i: s for i, s in manual.states.items() if i not in gone}
    kept = {
        i: x
        for i, x in manual.links.items()
        if i not in links and x.source not in gone and x.target not in gone
    }
    start = manual.start if manual.start not in gone else next(iter(left), None)
    return replace(manual, states=left, links=kept, start=start)


def without_clips(manuals: Mapping[Layer, Manual], clips: Collection[str]) -> Mapping[Layer, Manual]:
    """Return the machines without the states that use some clips; the same object where there are none."""
    gone = {layer: [s.id for s in m.states.values() if s.clip in clips] for layer, m in manuals.items()}
    if not any(gone.values()):
        return manuals
    return {layer: without(m, gone[layer]) for layer, m in manuals.items()}
