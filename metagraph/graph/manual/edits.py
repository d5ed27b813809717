"""Edits of manual state machines: pure functions `Project -> Project`, as `graph.edits` has for the
meta-graph.

An edit that cannot be done raises EditError, whose words are meant for the user; the project is then
unchanged.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from metagraph.common.wording import phrase
from metagraph.graph import ids
from metagraph.graph.edit_error import EditError
from metagraph.graph.edits import find_free_name, guess_limb
from metagraph.graph.manual.machine import ANY, Alias, Condition, Link, Manual, State, remove_from_machine
from metagraph.graph.model import BasePose, Layer, Project

WIDE, HIGH = 240.0, 96.0  # how far apart states that are dropped together stand, in units of the editor


def get_machine(project: Project, layer: Layer) -> Manual:
    """Return a layer's machine, an empty one where it has none yet."""
    return project.manual.get(layer) or Manual(layer)


def find_state_refusal(project: Project, clips: Sequence[str]) -> str | None:
    """Return in words why clips cannot become states, or None when they can."""
    if not clips:
        return phrase("nothing to place")
    for clip in clips:
        entry = project.clips.get(clip)
        if entry is None:
            return phrase("a clip that is not in this project")
        if (
            entry.motion is not None
            and project.skeleton is not None
            and entry.motion.skeleton != project.skeleton
        ):
            return phrase("'{name}' has a different skeleton from this project", name=entry.name)
    return None


def add_states(
    project: Project, clips: Sequence[str], layer: Layer, x: float = 0.0, y: float = 0.0
) -> Project:
    """Make a state of each clip, in a grid whose left upper corner is at x, y. The first state of a layer is
    its start; in the layer of the arms a clip's name says which one it moves, as for the meta-graph.

    The first state of the whole project also gives the base pose, as the first stance does (`edits.place`).
    Raises EditError.
    """
    why = find_state_refusal(project, clips)
    if why is not None:
        raise EditError(why)
    found = get_machine(project, layer)
    columns = next(n for n in range(1, len(clips) + 1) if n * n >= len(clips))
    taken = {s.name for s in found.states.values()}
    states = dict(found.states)
    for n, clip in enumerate(clips):
        name = find_free_name(project.clips[clip].name, taken)
        ident = ids.make_id(project, "m", layer, clip, name, more=states)
        taken.add(name)
        states[ident] = State(
            ident,
            clip,
            name,
            layer,
            limb=guess_limb(project.clips[clip].name) if layer == "arms" else "both",
            x=_whole(x + n % columns * WIDE),
            y=_whole(y + n // columns * HIGH),
        )
    first = (
        project.base.clip is None
        and not any(m.states for m in project.manual.values())
        and not any(True for _ in project.actions())
    )
    base = BasePose(clips[0], 0) if first else project.base
    start = found.start or next(iter(states))
    return project.with_manual(replace(found, states=states, start=start), base=base)


def explain_link_refusal(project: Project, layer: Layer, source: str, target: str) -> str | None:
    """Return in words why a link cannot be drawn, or None when it can."""
    found = get_machine(project, layer)
    if target == ANY:
        return phrase("a link cannot lead to 'any state': draw it the other way round")
    group = found.aliases.get(target)
    if group is not None and found.end(Link("", source, target)) is None:
        return phrase("'{name}' has no entry state: choose one first", name=group.name)
    known = found.states.keys() | found.aliases.keys()
    if target not in known or (source != ANY and source not in known):
        return phrase("a link joins two states of one layer")
    return None


def add_link(project: Project, layer: Layer, source: str, target: str) -> Project:
    """Draw a link, taken when its source has finished. One from any state waits for a request named after its
    target; so does one from an alias, and for the end of what plays.

    Raises EditError with the words of `explain_link_refusal`.
    """
    why = explain_link_refusal(project, layer, source, target)
    if why is not None:
        raise EditError(why)
    found = get_machine(project, layer)
    return project.with_manual(
        replace(found, links={**found.links, **_new(project, found, [(source, target)])})
    )


def add_links(project: Project, layer: Layer, sources: Sequence[str], targets: Sequence[str]) -> Project:
    """Draw a link from each of several sources to each of several targets, as `add_link` does; none from a
    state to itself, and none where one is drawn already.

    Raises EditError with the words of `explain_link_refusal`, or when there is none to draw.
    """
    for source in sources:
        for target in targets:
            if (why := explain_link_refusal(project, layer, source, target)) is not None:
                raise EditError(why)
    found = get_machine(project, layer)
    there = {(x.source, x.target) for x in found.links.values()}
    pairs = [(a, b) for a in sources for b in targets if a != b and (a, b) not in there]
    if not pairs:
        raise EditError(phrase("these links already exist"))
    links = {**found.links, **_new(project, found, pairs)}
    return project.with_manual(replace(found, links=links))


def _new(project: Project, found: Manual, pairs: Sequence[tuple[str, str]]) -> dict[str, Link]:
    out: dict[str, Link] = {}
    for source, target in pairs:
        ident = ids.make_id(project, "l", found.layer, source, target, more=out)
        waits = source == ANY or source in found.aliases
        condition = Condition("request", get_manual_name(found, target)) if waits else Condition()
        part = 1.0 if source in found.aliases else None
        out[ident] = Link(ident, source, target, condition, exit_part=part)
    return out


def get_manual_name(manual: Manual, ident: str) -> str:
    """Return how a state or alias is called, or its id where it is gone."""
    found = manual.states.get(ident) or manual.aliases.get(ident)
    return found.name if found is not None else ident


def update_states(project: Project, states: Collection[str], **changes: Any) -> Project:
    """Set fields of states; the same project when nothing differs. Raises EditError for a name without a
    letter.
    """
    if "name" in changes:
        changes["name"] = _clean(changes["name"])
    return _updated(project, "states", dict.fromkeys(states, changes))


def update_links(project: Project, links: Collection[str], **changes: Any) -> Project:
    """Set fields of links; `condition` takes a mapping of the Condition fields to change, or a whole
    Condition.

    A link that becomes a request is named after its target until it is renamed. Raises EditError
    for a trigger without a letter.
    """
    condition = changes.get("condition")
    if isinstance(condition, Mapping):
        condition = {k: _clean(v) if k == "trigger" else v for k, v in condition.items()}
        each: dict[str, Mapping[str, Any]] = {}
        for ident in links:
            link = project.link(ident)
            if link is not None:
                now = replace(link.condition, **condition)
                if now.when == "request" and not now.trigger:
                    target = project.state(link.target) or project.alias(link.target)
                    now = replace(now, trigger=target.name if target is not None else link.target)
                each[ident] = {**changes, "condition": now}
        return _updated(project, "links", each)
    return _updated(project, "links", dict.fromkeys(links, changes))


def move_nodes(project: Project, layer: Layer, places: Mapping[str, tuple[float, float]]) -> Project:
    """Put nodes elsewhere: states and aliases by id, and the node for any state as ANY."""
    found = get_machine(project, layer)
    if ANY in places:
        found = replace(found, any_x=_whole(places[ANY][0]), any_y=_whole(places[ANY][1]))
    moved = {
        i: replace(found.states[i], x=_whole(x), y=_whole(y))
        for i, (x, y) in places.items()
        if i in found.states
    }
    states = {**found.states, **moved} if moved else found.states
    aliases = {
        i: replace(a, x=_whole(places[i][0]), y=_whole(places[i][1])) if i in places else a
        for i, a in found.aliases.items()
    }
    return project.with_manual(replace(found, states=states, aliases=aliases))


def set_start_state(project: Project, state: str) -> Project:
    """Let the layer begin in a state. Raises EditError."""
    found = project.state(state)
    if found is None:
        raise EditError(phrase("that state is no longer in the project"))
    return project.with_manual(replace(project.manual[found.layer], start=state))


def remove_states(project: Project, states: Collection[str] = (), links: Collection[str] = ()) -> Project:
    """Remove states and aliases with the links that touch them, and links; clips stay in the library."""
    machines = dict(project.manual)
    for layer, found in project.manual.items():
        if any(i in found.states or i in found.aliases for i in states) or any(
            i in found.links for i in links
        ):
            machines[layer] = remove_from_machine(found, states, links)
    return (
        replace(project, manual=machines)
        if any(machines[x] is not project.manual[x] for x in machines)
        else project
    )


@dataclass(frozen=True)
class CopiedPiece:
    """What was copied: states and aliases, and the links among them."""

    states: tuple[State, ...]
    links: tuple[Link, ...]
    aliases: tuple[Alias, ...] = ()


def copy_states(project: Project, states: Collection[str]) -> CopiedPiece:
    """Return states and aliases with the links among them, to be pasted. Their order is the machine's."""
    chosen = [s for m in project.manual.values() for s in m.states.values() if s.id in states]
    aliases = tuple(a for m in project.manual.values() for a in m.aliases.values() if a.id in states)
    inside = {*(s.id for s in chosen), *(a.id for a in aliases)}
    links = [
        x
        for m in project.manual.values()
        for x in m.links.values()
        if x.target in inside and x.source in inside
    ]
    return CopiedPiece(tuple(chosen), tuple(links), aliases)


def paste_states(
    project: Project, layer: Layer, piece: CopiedPiece, x: float, y: float
) -> tuple[Project, tuple[str, ...]]:
    """Return the project with copies of states and aliases and of the links among them, and the copies' ids.
    x, y: their left upper corner. A copied alias stands for the copies of its states, and for those of its
    states that are still there and were not copied.

    Raises EditError when a clip is no longer there.
    """
    nodes: list[State | Alias] = [*piece.states, *piece.aliases]
    if not nodes:
        return project, ()
    why = find_state_refusal(project, [s.clip for s in piece.states]) if piece.states else None
    if why is not None:
        raise EditError(why)
    found = get_machine(project, layer)
    left, top = min(s.x for s in nodes), min(s.y for s in nodes)
    states, links = dict(found.states), dict(found.links)
    taken = {s.name for s in states.values()}
    made: dict[str, str] = {}
    for state in piece.states:
        name = find_free_name(state.name, taken)
        ident = made[state.id] = ids.make_id(project, "m", layer, state.clip, name, more=states)
        taken.add(name)
        states[ident] = replace(
            state, id=ident, name=name, layer=layer, x=_whole(x + state.x - left), y=_whole(y + state.y - top)
        )
    aliases = dict(found.aliases)
    called = {a.name for a in aliases.values()}
    for alias in piece.aliases:
        members = tuple(made.get(i, i) for i in alias.states if i in made or i in states)
        ident = ids.make_id(project, "g", layer, *members, more=aliases)
        entry = made.get(alias.entry or "", alias.entry)
        aliases[ident] = replace(
            alias,
            id=ident,
            name=find_free_name(alias.name, called),
            layer=layer,
            states=members,
            entry=entry if entry in states else None,
            x=_whole(x + alias.x - left),
            y=_whole(y + alias.y - top),
        )
        called.add(aliases[ident].name)
        made[alias.id] = ident
    names = {s.id: s.name for s in nodes}
    new_names = {i: s.name for i, s in states.items()} | {i: a.name for i, a in aliases.items()}
    for link in piece.links:
        ident = ids.make_id(project, "l", layer, made[link.source], made[link.target], more=links)
        condition = link.condition
        if (
            condition.when == "request" and condition.trigger == names[link.target]
        ):  # named after its target, as the copy's is
            condition = replace(condition, trigger=new_names[made[link.target]])
        links[ident] = replace(
            link, id=ident, source=made[link.source], target=made[link.target], condition=condition
        )
    start = found.start or next(iter(states), None)
    after = replace(found, states=states, links=links, start=start, aliases=aliases)
    return project.with_manual(after), tuple(made.values())


def paste_settings(project: Project, links: Collection[str], settings: Link) -> Project:
    """Give links another one's condition, exit time and blend; where it waits for its target's name, they
    wait for theirs.
    """
    target = project.state(settings.target) or project.alias(settings.target)
    own = target is not None and settings.condition.trigger == target.name
    each: dict[str, Mapping[str, Any]] = {}
    for ident in links:
        link = project.link(ident)
        if link is None:
            continue
        to = project.state(link.target) or project.alias(link.target)
        condition = (
            replace(settings.condition, trigger=to.name) if own and to is not None else settings.condition
        )
        each[ident] = {
            "condition": condition,
            "exit_time": settings.exit_time,
            "exit_part": settings.exit_part,
            "blend": settings.blend,
        }
    return _updated(project, "links", each)


def _updated(project: Project, what: str, changes: Mapping[str, Mapping[str, Any]]) -> Project:
    machines = dict(project.manual)
    for layer, found in project.manual.items():
        now = getattr(found, what)
        edits = {
            i: after
            for i, fields in changes.items()
            if i in now and (after := replace(now[i], **fields)) != now[i]
        }
        if edits:
            both: dict[str, Any] = {what: {**now, **edits}}
            machines[layer] = replace(found, **both)
    return (
        replace(project, manual=machines)
        if any(machines[x] is not project.manual[x] for x in machines)
        else project
    )


def _whole(place: float) -> float:
    return float(round(place))


def _clean(name: str) -> str:
    name = " ".join(name.split())
    if not name:
        raise EditError(phrase("a name needs at least one letter"))
    return name
