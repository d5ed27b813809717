"""Machines in normal form: what was authored, by meta-graph or by hand, as states and connections that can be
compared.

States are known by their clips, not by names or ids: by file, take, and which use of it. A meta-graph is
expanded; a machine drawn by hand is taken as it is; which of its states rest and what is a gesture of what is
read from its links.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import PurePosixPath

from metagraph.graph.expand import find_end_stance
from metagraph.graph.expand import list_connections as expanded
from metagraph.graph.manual.machine import Link, Manual, State
from metagraph.graph.manual.meta import as_meta
from metagraph.graph.manual.timing import find_exit_moment, find_state_span
from metagraph.graph.model import LAYERS, ClipEntry, Kind, Layer, Limb, MetaGraph, Project

AT_ITS_END = 1e-3  # seconds: as near to its end a state is left at its end

Pair = tuple[str, str]


@dataclass(frozen=True, slots=True)
class NormalState:
    """A use of a clip. clip: its file's name, with the take where it is not the first. kind: None if nothing
    tells. stance, ends: the stances it begins and ends in, as the machine calls them; None if nothing tells.
    start, end: seconds of the clip. limb, joints: what it moves; joint_weights: how far those that it moves
    in part, by name.
    """

    key: str
    clip: str
    layer: Layer
    kind: Kind | None
    stance: str | None
    ends: str | None
    loop: bool
    start: float
    end: float
    limb: Limb
    joints: tuple[str, ...]
    joint_weights: tuple[tuple[str, float], ...] = ()


@dataclass(frozen=True, slots=True)
class NormalConnection:
    """leave: seconds of the source's clip at which it may be left, None for at any time. blend: seconds."""

    leave: float | None
    blend: float


@dataclass(frozen=True)
class NormalMachine:
    """One layer. states: by key. connections: by (source, target). stances: id -> name, of no meaning
    elsewhere. derived: kinds and stances were not said, but follow from the connections.
    """

    layer: Layer
    states: Mapping[str, NormalState]
    connections: Mapping[Pair, NormalConnection]
    stances: Mapping[str, str]
    derived: bool = False

    def resting(self, stance: str) -> frozenset[str]:
        """Return the keys of the loops of a stance."""
        return frozenset(s.key for s in self.states.values() if s.kind == "stance" and s.stance == stance)


def is_manual(project: Project) -> bool:
    """Return whether a project was authored by hand: it has states of a manual machine."""
    return any(m.states for m in project.manual.values())


def normalize_machines(project: Project, manual: bool | None = None) -> dict[Layer, NormalMachine]:
    """Return the machines of the layers that have any states. manual: which of both is meant, if not what the
    project has.
    """
    names = name_clips(project)
    by_hand = is_manual(project) if manual is None else manual
    meant = as_meta(project)[0] if by_hand else project
    out = {}
    for layer in LAYERS:
        if by_hand:
            found = _of_manual(
                project, project.manual.get(layer) or Manual(layer), meant.graphs[layer], names
            )
        else:
            found = _of_graph(project, project.graphs[layer], names)
        if found.states:
            out[layer] = found
    return out


def name_clips(project: Project) -> dict[str, str]:
    """Return clip id -> its file's name, with its folder where two files are called alike, and its take where
    it is not the first.
    """
    paths = {i: PurePosixPath(e.path.replace("\\", "/")) for i, e in project.clips.items()}
    alike = Counter(path.name for path in {str(p): p for p in paths.values()}.values())
    return {i: _clip_name(paths[i], e, alike[paths[i].name] > 1) for i, e in project.clips.items()}


def _clip_name(path: PurePosixPath, entry: ClipEntry, alike: bool) -> str:
    name = "/".join(path.parts[-2:]) if alike else path.name
    return f"{name}:{entry.take}" if entry.take else name


def _keys(uses: Mapping[str, str], names: Mapping[str, str]) -> dict[str, str]:
    """Return id -> key. uses: id of an action or state -> clip id; the second use of a clip is its #2."""
    seen: Counter[str] = Counter()
    out = {}
    for ident, clip in uses.items():
        name = names.get(clip, clip)
        seen[name] += 1
        out[ident] = name if seen[name] == 1 else f"{name}#{seen[name]}"
    return out


def _of_graph(project: Project, graph: MetaGraph, names: Mapping[str, str]) -> NormalMachine:
    keys = _keys({a.id: a.clip for a in graph.actions.values()}, names)
    states = {}
    for a in graph.actions.values():
        start, end = project.span(a)
        loop = a.kind == "stance" or a.timing.loop
        joints = tuple(sorted(a.joints))
        key = keys[a.id]
        states[key] = NormalState(
            key,
            names.get(a.clip, a.clip),
            graph.layer,
            a.kind,
            a.stance,
            find_end_stance(a),
            loop,
            start,
            end,
            a.limb,
            joints,
            tuple(sorted(a.joint_weights)),
        )
    found = {
        (keys[c.source], keys[c.target]): NormalConnection(c.leave, c.blend) for c in expanded(project, graph)
    }
    return NormalMachine(graph.layer, states, found, {i: s.name for i, s in graph.stances.items()})


# --- by hand


def _of_manual(project: Project, manual: Manual, meant: MetaGraph, names: Mapping[str, str]) -> NormalMachine:
    keys = _keys({s.id: s.clip for s in manual.states.values()}, names)
    spans = {s.id: find_state_span(project, s) for s in manual.states.values()}
    roles = _roles(manual, meant)
    states = {}
    for s in manual.states.values():
        kind, stance, ends = roles[s.id]
        key = keys[s.id]
        states[key] = NormalState(
            key,
            names.get(s.clip, s.clip),
            manual.layer,
            kind,
            stance,
            ends,
            s.loop,
            *spans[s.id],
            s.limb,
            tuple(sorted(s.joints)),
            tuple(sorted(s.joint_weights)),
        )
    found = {}
    for (source, target), links in sorted(manual.ways.items()):
        if source == target and manual.states[source].loop:
            continue  # what loops already follows itself
        link = links[0]
        found[keys[source], keys[target]] = NormalConnection(
            _leave(project, manual.states[source], link), link.blend
        )
    return NormalMachine(manual.layer, states, found, {i: s.name for i, s in meant.stances.items()}, True)


def _leave(project: Project, state: State, link: Link) -> float | None:
    """Return when a link leaves its source, as a meta-graph counts: where its blend would end with the
    source, at the source's end.
    """
    at, end = find_exit_moment(project, state, link), find_state_span(project, state)[1]
    return end if at is not None and at + link.blend >= end - AT_ITS_END else at


Role = tuple[Kind | None, str | None, str | None]


def _roles(manual: Manual, meant: MetaGraph) -> dict[str, Role]:
    """Return state -> (kind, stance, end stance) in the meta-graph that a machine amounts to, which has them
    in the same order except for those it leaves out.
    """
    out: dict[str, Role] = {}
    actions = iter(meant.actions.values())
    action = next(actions, None)
    for state in manual.states.values():
        if action is not None and (action.clip, action.name) == (state.clip, state.name):
            out[state.id] = action.kind, action.stance, find_end_stance(action)
            action = next(actions, None)
        else:
            out[state.id] = None, None, None
    return out
