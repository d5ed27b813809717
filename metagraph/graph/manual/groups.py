"""Edits of a manual machine's aliases, and links copied from some states to others: pure functions
`Project -> Project`, beside `manual/edits`.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Collection, Sequence
from dataclasses import replace
from typing import Any

from metagraph.common.wording import phrase
from metagraph.graph import ids
from metagraph.graph.edit_error import EditError
from metagraph.graph.edits import find_free_name
from metagraph.graph.manual.edits import HIGH, WIDE, get_machine, get_manual_name
from metagraph.graph.manual.machine import Alias, Link, Manual
from metagraph.graph.model import Layer, Project


def add_alias(project: Project, layer: Layer, states: Sequence[str], every: bool = False) -> Project:
    """Make an alias that stands for some states, or for every one, left of them and called by what their
    names share. Raises EditError if there is no state.
    """
    found = get_machine(project, layer)
    chosen = tuple(i for i in found.states if i in states)
    if not chosen and not (every and found.states):
        raise EditError(phrase("select the states that the alias contains"))
    mine = [found.states[i] for i in chosen or found.states]
    taken = {a.name for a in found.aliases.values()}
    name = "every state" if every else find_shared_words([s.name for s in mine]) or "alias"
    name = find_free_name(name, taken)
    ident = ids.make_id(project, "g", layer, name, *chosen)
    alias = Alias(
        ident,
        name,
        layer,
        () if every else chosen,
        every,
        x=min(s.x for s in mine) - WIDE,
        y=min(s.y for s in mine),
    )
    while any((a.x, a.y) == (alias.x, alias.y) for a in found.aliases.values()):
        alias = replace(alias, y=alias.y + HIGH)
    after = replace(found, aliases={**found.aliases, ident: alias})
    return project.with_manual(after)


def find_shared_words(names: Sequence[str]) -> str:
    """Return the words that all names begin with, or if there are none, those that most begin with; "" for
    none.
    """
    starts: Counter[str] = Counter()
    for name in names:
        ends = [m.end() for m in re.finditer(r"[^\W_]+", name)]
        starts.update({name[:end] for end in ends})
    for least in (len(names), len(names) // 2 + 1):
        shared = [start for start, count in starts.items() if count >= least]
        if shared:
            return max(shared, key=len).strip(" _-.")
    return ""


def update_aliases(project: Project, aliases: Collection[str], **changes: Any) -> Project:
    """Set fields of aliases: `name`, `states`, `every`, `again`, `entry`. Raises EditError for a name without
    a letter.
    """
    if "name" in changes:
        changes["name"] = " ".join(str(changes["name"]).split())
        if not changes["name"]:
            raise EditError(phrase("a name needs at least one letter"))
    machines = dict(project.manual)
    for layer, found in project.manual.items():
        edits = {i: replace(found.aliases[i], **changes) for i in aliases if i in found.aliases}
        if any(edits[i] != found.aliases[i] for i in edits):
            machines[layer] = replace(found, aliases={**found.aliases, **edits})
    return replace(project, manual=machines) if machines != dict(project.manual) else project


def set_alias_states(project: Project, alias: str, states: Collection[str], on: bool = True) -> Project:
    """Let an alias stand for some states as well, or no longer."""
    found = project.alias(alias)
    if found is None:
        raise EditError(phrase("that alias is no longer in the project"))
    of = project.manual[found.layer]
    chosen = {*found.states, *states} if on else set(found.states) - set(states)
    entry = found.entry if found.entry in chosen or found.every else None
    return update_aliases(project, [alias], states=tuple(i for i in of.states if i in chosen), entry=entry)


# --- links of some states given to others


def find_links(manual: Manual, states: Collection[str], into: bool = False) -> tuple[str, ...]:
    """Return the links that leave some states or aliases, or lead to them."""
    return tuple(x.id for x in manual.links.values() if (x.target if into else x.source) in states)


def paste_copied_links(
    project: Project, layer: Layer, links: Sequence[Link], nodes: Sequence[str]
) -> Project:
    """Draw copied links again for other states or aliases, with all their settings: those that left one state
    leave each of these, those that led to one lead to each of these.

    What the links share tells which: their source, or where they have several, their target. Raises EditError
    if neither is shared, or nothing is left to draw.
    """
    found = get_machine(project, layer)
    sources, targets = Counter(x.source for x in links), Counter(x.target for x in links)
    if len(sources) > 1 and len(targets) > 1:
        raise EditError(phrase("copy links that all leave one state, or that all lead to one state"))
    there = {(x.source, x.target) for x in found.links.values()}
    out: dict[str, Link] = {}
    for node in nodes:
        for link in links:
            one = replace(link, source=node) if len(sources) == 1 else replace(link, target=node)
            if one.condition.when == "request" and len(sources) > 1:
                one = replace(one, condition=replace(one.condition, trigger=get_manual_name(found, node)))
            known = found.states.keys() | found.aliases.keys()
            joins = one.target in known and one.source != one.target and found.end(one) is not None
            if joins and (one.source, one.target) not in there:
                there.add((one.source, one.target))
                ident = ids.make_id(project, "l", layer, one.source, one.target, more=out)
                out[ident] = replace(one, id=ident)
    if not out:
        raise EditError(phrase("these links already exist"))
    after = replace(found, links={**found.links, **out})
    return project.with_manual(after)
