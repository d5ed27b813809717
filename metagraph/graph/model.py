"""The values a project is made of. All are frozen; mappings in them are never changed in place.

Ids are made once from the project's counter and never change; names are free text for people.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from types import MappingProxyType
from typing import Any

from metagraph.graph.clip_mark import ClipMark
from metagraph.graph.conversation.model import AUTO, Conversation
from metagraph.graph.life import Face, Life
from metagraph.graph.manual.machine import Alias, Link, Manual, State
from metagraph.graph.requests import Line, Performance, Point
from metagraph.graph.timeline import Timeline
from metagraph.graph.touch import Touch
from metagraph.graph.words import KINDS, LAYERS, LIMBS, MODES, PARTS, Kind, Layer, Limb, Mode, Part
from metagraph.motion.clip import Clip
from metagraph.motion.contact_spans import ContactSpan
from metagraph.motion.joint_map import JointMap
from metagraph.motion.retime import Retime
from metagraph.motion.skeleton import Skeleton

__all__ = [
    "KINDS",
    "LAYERS",
    "LIMBS",
    "MODES",
    "PARTS",
    "REACH",
    "Action",
    "BasePose",
    "ClipEntry",
    "Face",
    "Index",
    "Kind",
    "Layer",
    "Life",
    "Limb",
    "Line",
    "Markov",
    "MetaGraph",
    "Mode",
    "Part",
    "Performance",
    "Point",
    "Project",
    "Settings",
    "Stance",
    "Timing",
    "Uses",
]

# Which layer reaches which part, and how strongly: Borer et al., section 5 (weights of 1.0). The face moves
# with the head.
REACH: Mapping[Layer, Mapping[Part, float]] = {
    "body": {"legs": 1.0, "spine": 1.0, "arms": 0.0, "head": 1.0, "face": 1.0},
    "arms": {"legs": 0.0, "spine": 1.0, "arms": 1.0, "head": 1.0, "face": 1.0},
    "head": {"legs": 0.0, "spine": 1.0, "arms": 0.0, "head": 1.0, "face": 1.0},
}


@dataclass(frozen=True, slots=True)
class Timing:
    """When an action plays within its clip; seconds of the clip.

    start, end: the part that plays; `end` None is the clip's end. blend_in, blend_out: seconds of blending
    from and to the stance, within start..end (for a looping stance, blend_in is the overlap at the loop's
    seam). loop: repeats. earliest_exit: from here on the action may be left, or None to play it through.
    stroke: its most telling moment. ready, stroke_end, relax: where a gesture's preparation, stroke and hold
    end (its retraction ends with it); None as found from the motion (`playback.timing.phases`).
    """

    start: float = 0.0
    end: float | None = None
    blend_in: float = 0.2
    blend_out: float = 0.3
    loop: bool = False
    earliest_exit: float | None = None
    stroke: float | None = None
    ready: float | None = None
    stroke_end: float | None = None
    relax: float | None = None


@dataclass(frozen=True, slots=True)
class Action:
    """One use of a clip in the graph.

    stance: id of the stance it starts from (for kind "stance", the stance whose loop it is). end_stance: only
    for transitions. limb: which arm it needs; the other keeps to the stance. joints: names of the only joints
    it moves; empty means all. joint_weights: how far those move that move in part, (name, above 0 and below
    1); the rest of the way they keep to the stance. tags: free words, "positive" and "negative" among them.
    likelihood: relative, > 0. cooldown: seconds after it has ended in which it is not drawn again. spacing:
    how many other actions of its kind and stance are drawn before it may be drawn again; None as the
    settings' never_twice says. contacts: where its hands stay on the body. clip_name, clip_sha256: which
    clip it was made of, where that is not the one it has; "" otherwise (see `formats.clip_identity`).
    """

    id: str
    clip: str
    kind: Kind
    layer: Layer
    stance: str
    name: str
    end_stance: str | None = None
    timing: Timing = Timing()
    limb: Limb = "both"
    joints: tuple[str, ...] = ()
    tags: tuple[str, ...] = ()
    likelihood: float = 1.0
    cooldown: float = 0.0
    spacing: int | None = None
    contacts: tuple[ContactSpan, ...] = ()
    joint_weights: tuple[tuple[str, float], ...] = ()
    clip_name: str = ""
    clip_sha256: str = ""


@dataclass(frozen=True, slots=True)
class Stance:
    id: str
    layer: Layer
    name: str


Index = Mapping[tuple[str, Kind], tuple[Action, ...]]


@dataclass(frozen=True)
class MetaGraph:
    """One layer: its stances and actions. start: the stance a performance begins in. weights: part ->
    0..2.
    """

    layer: Layer
    stances: Mapping[str, Stance] = field(default_factory=dict)
    actions: Mapping[str, Action] = field(default_factory=dict)
    start: str | None = None
    weights: Mapping[Part, float] = field(default_factory=dict)

    def weight(self, part: Part) -> float:
        """How strongly this layer moves a body part."""
        return self.weights.get(part, REACH[self.layer][part])

    @cached_property
    def index(self) -> Index:
        """The multi-index of this layer: (stance, kind) -> actions, in the order they were placed."""
        return _grouped(self.actions.values(), _node)

    def of(self, stance: str, kind: Kind) -> tuple[Action, ...]:
        """Return the actions of a kind placed on a stance."""
        return self.index.get((stance, kind), ())

    @cached_property
    def uses(self) -> Mapping[str, tuple[Action, ...]]:
        """Clip id -> the actions of this layer that use it, in the order they were placed."""
        return _grouped(self.actions.values(), _clip)

    @cached_property
    def into(self) -> Mapping[str, tuple[Action, ...]]:
        """Transitions by the stance they end in, in the order they were placed."""
        arriving = (a for a in self.actions.values() if a.kind == "transition" and a.end_stance is not None)
        return _grouped(arriving, lambda a: a.end_stance)

    @cached_property
    def touched(self) -> Mapping[str, int]:
        """Joint -> how many contacts of actions are with it."""
        return Counter(span.to for action in self.actions.values() for span in action.contacts)

    def but(self, **changes: Any) -> MetaGraph:
        """Return the graph with fields other than its actions replaced, keeping what was derived from the
        actions.
        """
        out = replace(self, **changes)
        derived = ("index", "uses", "into", "touched")
        out.__dict__.update({name: self.__dict__[name] for name in derived if name in self.__dict__})
        return out

    def with_actions(self, changes: Mapping[str, Action | None]) -> MetaGraph:
        """Return the graph with actions added, replaced (in place) or, for None, removed.

        Index, uses and touched are patched rather than rebuilt, so that an edit costs the same in a graph of
        ten thousand.
        """
        actions = dict(self.actions)
        for ident, action in changes.items():
            if action is not None:
                actions[ident] = action
            else:
                actions.pop(ident, None)
        out = replace(self, actions=actions)
        out.__dict__["index"] = _patched(self.index, self.actions, actions, changes, _node)
        if "uses" in self.__dict__:
            out.__dict__["uses"] = _patched(self.uses, self.actions, actions, changes, _clip)
        if "touched" in self.__dict__:
            out.__dict__["touched"] = _touched(self.touched, self.actions, changes)
        return out


def _node(action: Action) -> tuple[str, Kind]:
    return action.stance, action.kind


def _clip(action: Action) -> str:
    return action.clip


def _touched(
    counts: Mapping[str, int], before: Mapping[str, Action], changes: Mapping[str, Action | None]
) -> Mapping[str, int]:
    """Return how many contacts are with each joint after changes."""
    out = Counter(counts)
    for ident, new in changes.items():
        old = before.get(ident)
        out.subtract(span.to for span in (old.contacts if old is not None else ()))
        out.update(span.to for span in (new.contacts if new is not None else ()))
    return +out


def _grouped(actions: Iterable[Action], key: Callable[[Action], Any]) -> Mapping[Any, tuple[Action, ...]]:
    buckets: dict[Any, list[Action]] = {}
    for action in actions:
        buckets.setdefault(key(action), []).append(action)
    return MappingProxyType({k: tuple(bucket) for k, bucket in buckets.items()})


def _patched(
    groups: Mapping[Any, tuple[Action, ...]],
    before: Mapping[str, Action],
    after: Mapping[str, Action],
    changes: Mapping[str, Action | None],
    key: Callable[[Action], Any],
) -> Mapping[Any, tuple[Action, ...]]:
    """Return the groups after changes, in the order in which `after` has the actions."""
    touched: dict[Any, dict[str, Action]] = {}
    moved: set[Any] = set()

    def bucket(action: Action) -> dict[str, Action]:
        k = key(action)
        if k not in touched:
            touched[k] = {a.id: a for a in groups.get(k, ())}
        return touched[k]

    for ident, new in changes.items():
        old = before.get(ident)
        if old is not None and (new is None or key(new) != key(old)):
            bucket(old).pop(ident)
        if new is not None:
            bucket(new)[ident] = new
            if old is not None and key(new) != key(old):
                moved.add(key(new))  # an action that moves in keeps its place among all
    out = dict(groups)
    for k, kept in touched.items():
        if kept:
            out[k] = tuple(after[i] for i in after if i in kept) if k in moved else tuple(kept.values())
        else:
            out.pop(k, None)
    return MappingProxyType(out)


class Uses(Mapping[str, tuple[Action, ...]]):
    """Clip id -> the actions of any layer that use it: a view of the graphs' own."""

    def __init__(self, graphs: Iterable[MetaGraph]) -> None:
        self._graphs = tuple(graph.uses for graph in graphs)

    def __getitem__(self, clip: str) -> tuple[Action, ...]:
        found = tuple(action for uses in self._graphs for action in uses.get(clip, ()))
        if not found:
            raise KeyError(clip)
        return found

    def __contains__(self, clip: object) -> bool:
        for uses in self._graphs:  # noqa: SIM110 - `any` takes thrice as long, and clips are asked by the thousand
            if clip in uses:
                return True
        return False

    def __iter__(self) -> Iterator[str]:
        return iter(dict.fromkeys(clip for uses in self._graphs for clip in uses))

    def __len__(self) -> int:
        return sum(1 for _ in self)


@dataclass(frozen=True)
class ClipEntry:
    """A clip the project knows. path: relative to the project file, `/` between folders. take: which
    animation in the file.

    digest: SHA-256 of the file, hex. frames, fps: as it plays. as_is: names of repairs that are not made
    when it is read (`formats.takes.REPAIRS`). brought_from: fingerprint of the skeleton it is retargeted
    from, "" where the file has the project's own. made_by, made_seed: the learned model that made it, and
    with what chance; "" for clips that were not generated. retime: how it is played faster, slower and held.
    motion: the loaded clip as it plays, None while the file is missing. source: as it was read, where that is
    another (see `graph.editing.retiming`).
    """

    id: str
    name: str
    path: str
    take: int = 0
    digest: str = ""
    frames: int = 0
    fps: float = 30.0
    motion: Clip | None = field(default=None, compare=False, repr=False)
    source: Clip | None = field(default=None, compare=False, repr=False)
    as_is: tuple[str, ...] = ()
    brought_from: str = ""
    made_by: str = ""
    made_seed: int = 0
    retime: Retime = field(default_factory=Retime)

    @property
    def duration(self) -> float:
        """Seconds from the first frame to the last."""
        return (self.frames - 1) / self.fps if self.frames > 1 else 0.0


@dataclass(frozen=True)
class BasePose:
    """The pose all offsets are taken against: a frame of a clip, or the skeleton's rest pose when clip is
    None.
    """

    clip: str | None = None
    frame: int = 0


@dataclass(frozen=True)
class Markov:
    """A first-order model over (limb, kind) that writes meta actions when nobody asks for any (Borer et al.,
    7.3).

    matrix: rows of probabilities, each summing to 1. gap: mean seconds of rest between two actions. positive,
    negative: share of gestures asked for with that tag, where tags are not part of the states. tags: one text
    a state, the tags (blanks between them) it asks for; empty when tags are not part of the states. lengths:
    (mean, standard deviation) seconds of each state's actions; empty where that is not known. modes: what is
    performed of what it writes while one is said to idle, to listen and to talk, a row each: shares of
    gestures, fidgets and transitions, 0..1; empty where the mode makes no difference.
    """

    layer: Layer
    states: tuple[tuple[Limb, Kind], ...]
    matrix: tuple[tuple[float, ...], ...]
    gap: float = 2.5
    positive: float = 0.0
    negative: float = 0.0
    tags: tuple[str, ...] = ()
    lengths: tuple[tuple[float, float], ...] = ()
    modes: tuple[tuple[float, ...], ...] = ()

    def tag(self, state: int) -> str:
        """Return the tags a state asks for, "" for none."""
        return self.tags[state] if self.tags else ""


@dataclass(frozen=True)
class Settings:
    """Planner constants. alpha: how quickly a used action becomes unlikely (4 in the paper). seed: 32-bit.

    never_twice: an action is not played twice in a row where there is another. shortest: seconds below which
    the remainder of a cut meta action is not worth keeping. wait: how late, in seconds, a request may start.
    memory: seconds after which a use no longer counts, 0 for never (as in the paper). rest: least seconds in
    the stance between two actions of a layer. lookahead: seconds ahead of now in which a running plan is not
    changed any more.
    """

    alpha: float = 4.0
    seed: int = 1
    never_twice: bool = True
    shortest: float = 0.4
    wait: float = 4.0
    memory: float = 0.0
    rest: float = 0.0
    lookahead: float = 0.1


def _empty_graphs() -> dict[Layer, MetaGraph]:
    return {layer: MetaGraph(layer) for layer in LAYERS}


@dataclass(frozen=True)
class Project:
    """Everything that is saved. roles: corrections, role -> joint name. parts: corrections, joint name ->
    body part.

    character: path of the GLB to draw, relative to the project file, or None for a stick figure. hidden:
    names of its meshes that are not drawn. points:
    named places to look at, metres. lines: the dialogue an agent calls by id. performances, conversations:
    those kept, by id. timelines: what is noted on theirs, by their id. tiers: annotation tier -> what it was
    last read as. notes: to read, by the id of the action they are on, "" for the project's own. marks: what
    clips are found again by, by their ids. joint_maps: how clips of other
    skeletons are retargeted, by `joint_map.fingerprint` of theirs. language: what conversations are read in,
    a code ("de"), or "auto" for what their words tell. manual: state machines drawn by hand, of
    the layers that have one. voices: line -> its analysed sound (`playback.life.voice.Voice`), as far as
    read; never saved. touch: whether contacts hold and hands are kept out of the body.
    """

    name: str = "untitled"
    skeleton: Skeleton | None = None
    clips: Mapping[str, ClipEntry] = field(default_factory=dict)
    graphs: Mapping[Layer, MetaGraph] = field(default_factory=_empty_graphs)
    base: BasePose = BasePose()
    roles: Mapping[str, str] = field(default_factory=dict)
    parts: Mapping[str, Part] = field(default_factory=dict)
    markov: Mapping[Layer, Markov] = field(default_factory=dict)
    settings: Settings = Settings()
    character: str | None = None
    hidden: tuple[str, ...] = ()
    life: Life = field(default_factory=Life)
    face: Face = field(default_factory=Face)
    points: Mapping[str, Point] = field(default_factory=dict)
    lines: Mapping[str, Line] = field(default_factory=dict)
    performances: Mapping[str, Performance] = field(default_factory=dict)
    conversations: Mapping[str, Conversation] = field(default_factory=dict)
    timelines: Mapping[str, Timeline] = field(default_factory=dict)
    language: str = AUTO
    tiers: Mapping[str, str] = field(default_factory=dict)
    labels: Mapping[str, str] = field(default_factory=dict)
    notes: Mapping[str, str] = field(default_factory=dict)
    marks: Mapping[str, ClipMark] = field(default_factory=dict)
    joint_maps: Mapping[str, JointMap] = field(default_factory=dict)
    manual: Mapping[Layer, Manual] = field(default_factory=dict)
    voices: Mapping[str, Any] = field(default_factory=dict, compare=False, repr=False)
    touch: Touch = field(default_factory=Touch)

    def actions(self) -> Iterable[Action]:
        """Every action of every layer."""
        for layer in LAYERS:
            yield from self.graphs[layer].actions.values()

    def action(self, ident: str) -> Action | None:
        """Return the action of that id, whatever its layer."""
        for layer in LAYERS:
            found = self.graphs[layer].actions.get(ident)
            if found is not None:
                return found
        return None

    @property
    def size(self) -> int:
        """How many clips, actions and states it holds."""
        actions = sum(len(graph.actions) for graph in self.graphs.values())
        return len(self.clips) + actions + sum(len(machine.states) for machine in self.manual.values())

    def has(self, ident: str) -> bool:
        """Return whether anything in the project has that id."""
        graphs, machines = self.graphs.values(), self.manual.values()
        return (
            ident in self.clips
            or any(ident in g.actions or ident in g.stances for g in graphs)
            or any(ident in m.states or ident in m.links or ident in m.aliases for m in machines)
            or ident in self.performances
            or ident in self.conversations
            or any(ident == marker.id for t in self.timelines.values() for marker in t.markers)
        )

    def stance(self, ident: str | None) -> Stance | None:
        """Return the stance of that id, whatever its layer."""
        for layer in LAYERS:
            if ident is not None and ident in self.graphs[layer].stances:
                return self.graphs[layer].stances[ident]
        return None

    def span(self, action: Action) -> tuple[float, float]:
        """Return start and end of the part that plays, seconds of its clip; the end is never before the
        start.
        """
        entry = self.clips.get(action.clip)
        length = entry.duration if entry is not None else 0.0
        timing = action.timing
        start, end = timing.start, timing.end
        if not start > 0.0:  # as with most; what is no number is 0, too
            start = 0.0
        elif start > length:
            start = length
        if end is None or end > length:
            end = length
        return start, end if end > start else start

    @cached_property
    def uses(self) -> Mapping[str, tuple[Action, ...]]:
        """Clip id -> the actions that use it."""
        return Uses(self.graphs[layer] for layer in LAYERS)

    @cached_property
    def touched(self) -> frozenset[str]:
        """The names of the joints that contacts of actions are with."""
        return frozenset(joint for layer in LAYERS for joint in self.graphs[layer].touched)

    def state(self, ident: str | None) -> State | None:
        """Return the state of a manual machine of that id, whatever its layer."""
        return (
            next((m.states[ident] for m in self.manual.values() if ident in m.states), None)
            if ident is not None
            else None
        )

    def alias(self, ident: str | None) -> Alias | None:
        """Return the alias of a manual machine of that id, whatever its layer."""
        return (
            next((m.aliases[ident] for m in self.manual.values() if ident in m.aliases), None)
            if ident is not None
            else None
        )

    def link(self, ident: str | None) -> Link | None:
        """Return the link of a manual machine of that id, whatever its layer."""
        return (
            next((m.links[ident] for m in self.manual.values() if ident in m.links), None)
            if ident is not None
            else None
        )

    def with_manual(self, manual: Manual, **more: Any) -> Project:
        """Return the project with one layer's manual machine replaced."""
        return replace(self, manual={**self.manual, manual.layer: manual}, **more)

    @cached_property
    def drawn(self) -> frozenset[str]:
        """The clips that states of manual machines use."""
        return frozenset(s.clip for m in self.manual.values() for s in m.states.values())

    def with_graph(self, graph: MetaGraph, **more: Any) -> Project:
        """Return the project with one layer's graph replaced."""
        return replace(self, graphs={**self.graphs, graph.layer: graph}, **more)
