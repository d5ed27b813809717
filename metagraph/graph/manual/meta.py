"""The meta-graph that a manual state machine amounts to, and how far the two differ: so that both export to
the same files.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

from metagraph.graph import ids
from metagraph.graph.expand import list_connections
from metagraph.graph.manual.machine import ANY, Link, Manual, State, expand_links
from metagraph.graph.manual.timing import find_exit_moment
from metagraph.graph.model import Action, Kind, MetaGraph, Project, Stance, Timing

Pairs = frozenset[tuple[str, str]]
ALIKE = 0.5  # share of what two loops lead to that must be the same for them to be loops of one stance


def as_meta(project: Project) -> tuple[Project, Pairs, Pairs]:
    """Return the project with the meta-graphs its manual machines amount to, the connections those imply that
    were not drawn, and the drawn ones they do not imply; both as (source state, target state).

    Loop states that lead to each other and to the same things are loops of one stance. A state entered from a
    stance and going back to it is its gesture, or its fidget where it is only entered by finished links; one
    that goes to another stance is a transition. States that nothing joins to a stance are left out. Layers
    without a manual machine stay as they are.
    """
    missing: set[tuple[str, str]] = set()
    extra: set[tuple[str, str]] = set()
    out = replace(project, manual={})
    for manual in project.manual.values():
        if not manual.states:
            continue
        graph, names = _graph(out, manual)
        out = out.with_graph(graph)
        implied = {(names[c.source], names[c.target]) for c in list_connections(out, graph)}
        drawn = expand_links(manual)
        missing |= implied - drawn
        extra |= drawn - implied
    return out, frozenset(missing), frozenset(extra)


def describe_meta_differences(project: Project) -> list[str]:
    """Say in words how the meta-graph differs from the manual machines it is made of; nothing if it
    does not.
    """
    made, missing, extra = as_meta(project)
    drawn = sum(len(m.states) for m in project.manual.values())
    left = drawn - sum(len(made.graphs[layer].actions) for layer, m in project.manual.items() if m.states)
    out = []
    if left:
        out.append(f"{_many(left, 'state')} that no link joins to a loop: left out")
    if missing:
        out.append(
            f"{_many(len(missing), 'connection')} not drawn but possible there: the actions of a stance may "
            "follow each other"
        )
    if extra:
        out.append(
            f"{_many(len(extra), 'connection')} drawn but lost there: what ends in a stance leads to what "
            "begins in it, no further"
        )
    return out


def _many(count: int, noun: str) -> str:
    return f"{count:,} {noun}{'' if count == 1 else 's'}"


def _graph(project: Project, manual: Manual) -> tuple[MetaGraph, Mapping[str, str]]:
    """Return a machine's meta-graph, and its states by their actions' ids."""
    pairs = expand_links(manual)
    loops = [s.id for s in manual.states.values() if s.loop]
    if not loops and manual.start in manual.states:
        loops = [manual.start or ""]
    groups = _stances(loops, pairs)
    of = {loop: n for n, group in enumerate(groups) for loop in group}
    into, out = _ends(manual, pairs, of)
    stances: list[Stance] = []
    for group in groups:
        name, taken = manual.states[group[0]].name, [s.id for s in stances]
        stances.append(Stance(ids.make_id(project, "s", manual.layer, name, more=taken), manual.layer, name))
    actions: dict[str, Action] = {}
    names: dict[str, str] = {}
    for state in manual.states.values():
        found = _placed(manual, state, of, into.get(state.id, Counter()), out.get(state.id, Counter()))
        if found is None:
            continue
        kind, start, end = found
        ident = ids.make_id(project, "a", manual.layer, kind, state.id, more=actions)
        names[ident] = state.id
        actions[ident] = Action(
            ident,
            state.clip,
            kind,
            manual.layer,
            stances[start].id,
            state.name,
            stances[end].id if kind == "transition" else None,
            _timing(project, manual, state, kind, of),
            state.limb,
            state.joints,
            _tags(manual, state),
            _likelihood(manual, state, kind),
            joint_weights=state.joint_weights,
        )
    begin = of.get(manual.start or "")
    if begin is None and manual.start is not None:  # a start that is no loop leads to one
        begin = next(iter(out.get(manual.start, Counter())), 0 if stances else None)
    graph = replace(
        project.graphs[manual.layer],
        stances={},
        actions={},
        start=stances[begin].id if begin is not None else None,
    )
    return replace(graph, stances={s.id: s for s in stances}, actions=actions), names


def _stances(loops: Sequence[str], pairs: Pairs) -> list[list[str]]:
    """Group loops into stances: such as lead to each other, and mostly to the same things."""
    leads: dict[str, set[str]] = {loop: set() for loop in loops}
    for source, target in pairs:
        if source in leads and target not in leads:
            leads[source].add(target)
    groups: list[list[str]] = []
    for loop in loops:
        for group in groups:
            first = group[0]
            both = leads[first] | leads[loop]
            same = len(leads[first] & leads[loop]) / len(both) if both else 1.0
            if (first, loop) in pairs and (loop, first) in pairs and same >= ALIKE:
                group.append(loop)
                break
        else:
            groups.append([loop])
    return groups


def _ends(
    manual: Manual, pairs: Pairs, of: Mapping[str, int]
) -> tuple[dict[str, Counter[int]], dict[str, Counter[int]]]:
    """Return for each state that is no loop from how many loops of each stance it is entered, and to how many
    it leads.

    States that only touch other such states take theirs from them, from near to far.
    """
    into: dict[str, Counter[int]] = {}
    out: dict[str, Counter[int]] = {}
    before: dict[str, list[str]] = {}
    after: dict[str, list[str]] = {}
    wide = {ANY, *(a.id for a in manual.aliases.values() if a.every)}
    drawn = {
        pair
        for pair, links in manual.ways.items()
        if any(manual.links[x.id].source not in wide for x in links)
    }
    for source, target in sorted(pairs):
        weight = (
            len(of) + 1 if (source, target) in drawn else 1
        )  # a link of its own, or of some states, says more than all from any state
        if source in of and target not in of:
            into.setdefault(target, Counter())[of[source]] += weight
        elif source not in of and target in of:
            out.setdefault(source, Counter())[of[target]] += weight
        elif source not in of and (source, target) in drawn:
            before.setdefault(target, []).append(source)
            after.setdefault(source, []).append(target)
    for known, neighbours in ((into, before), (out, after)):
        changed = True
        while changed:
            found = {
                s: known[n] for s, near in neighbours.items() if s not in known for n in near if n in known
            }
            known.update({s: Counter(c) for s, c in found.items()})
            changed = bool(found)
    return into, out


def _placed(
    manual: Manual, state: State, of: Mapping[str, int], into: Counter[int], out: Counter[int]
) -> tuple[Kind, int, int] | None:
    """Return kind, stance and end stance of a state; None if no stance is joined to it."""
    if state.id in of:
        return "stance", of[state.id], of[state.id]
    if not into and not out:
        return None
    both = {n: into[n] + out[n] for n in into if n in out}
    if both:
        home = max(sorted(both), key=lambda n: both[n])
        return ("fidget" if _unasked(manual, state) else "gesture"), home, home
    if not into or not out:
        home = max(sorted(into or out), key=lambda n: (into or out)[n])
        return ("fidget" if _unasked(manual, state) else "gesture"), home, home
    return "transition", max(sorted(into), key=lambda n: into[n]), max(sorted(out), key=lambda n: out[n])


def _entering(manual: Manual, state: State) -> tuple[Link, ...]:
    return manual.entering(state.id)


def _unasked(manual: Manual, state: State) -> bool:
    links = _entering(manual, state)
    return bool(links) and all(x.condition.when == "finished" for x in links)


def _timing(project: Project, manual: Manual, state: State, kind: Kind, of: Mapping[str, int]) -> Timing:
    """Return an action's timing: blends and exit of the links that join it to its stances, the first of
    each.
    """
    if kind == "stance":
        return Timing(state.start, state.end, 0.0, 0.0, True)
    leaving = tuple(manual.leaving(state.id))
    first = _first(_entering(manual, state), lambda x: _from_rest(manual, x, of))
    last = _first(leaving, lambda x: x.target in of)
    blends = [x.blend if x is not None else Timing().blend_in for x in (first, last)]
    return Timing(
        state.start,
        state.end,
        blends[0],
        blends[1],
        earliest_exit=_exit(project, state, last) if last is not None else None,
    )


def _from_rest(manual: Manual, link: Link, of: Mapping[str, int]) -> bool:
    alias = manual.aliases.get(link.source)
    return link.source in of if alias is None else any(s in of for s in manual.members(alias))


def _exit(project: Project, state: State, link: Link) -> float | None:
    """Return the clip seconds at which a link may be taken, None for at the state's end or at once."""
    if link.exit_time is not None or link.exit_part is None or link.exit_part >= 1:
        return link.exit_time
    at = find_exit_moment(project, state, link)
    return round(at, 6) if at is not None else None


def _first(links: Sequence[Link], fits: Callable[[Link], bool]) -> Link | None:
    """Return the first link that fits, else the first."""
    return next((x for x in links if fits(x)), links[0] if links else None)


def _tags(manual: Manual, state: State) -> tuple[str, ...]:
    """Return triggers that are not the state's name: what an agent asks for by it."""
    asked = dict.fromkeys(
        x.condition.trigger for x in _entering(manual, state) if x.condition.when == "request"
    )
    return tuple(t for t in asked if t and t != state.name)


def _likelihood(manual: Manual, state: State, kind: Kind) -> float:
    weights = [
        x.condition.weight
        for x in _entering(manual, state)
        if x.condition.when == "finished" and x.condition.weight > 0
    ]
    return weights[0] if weights and kind == "fidget" else 1.0


def is_only_manual(project: Project) -> bool:
    """Whether all that a project plays was drawn by hand."""
    return any(m.states for m in project.manual.values()) and not any(True for _ in project.actions())


def make_exportable(project: Project, manual: bool | None = None) -> tuple[Project, list[str]]:
    """Return what is exported of a project, and in words how far it differs from what was drawn.

    manual: its manual machines, as what they amount to, rather than its meta-graph; None for if there is
    nothing else.
    """
    if is_only_manual(project) if manual is None else manual:
        return as_meta(project)[0], describe_meta_differences(project)
    return replace(project, manual={}) if project.manual else project, []
