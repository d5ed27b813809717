"""Define the values that a project is made of. All are frozen, and their mappings never change in place.

Ids are made once from the content they are for and never change. Names are free text for people.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from types import MappingProxyType
from typing import Any

from metagraph.graph.backdrop import Backdrop
from metagraph.graph.clip_mark import ClipMark
from metagraph.graph.conversation.model import AUTO, Conversation
from metagraph.graph.life import Face, Life
from metagraph.graph.manual.machine import Alias, Link, Manual, State
from metagraph.graph.parameter import CharacterParameter
from metagraph.graph.prop import Prop
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
    """When an action plays within its clip. All times are seconds of the clip.

    `start` and `end` bound the part that plays; an `end` of None is the clip's end. `blend_in` and
    `blend_out` are the seconds of blending from and to the stance, inside that part. For a looping stance,
    `blend_in` is the overlap at the loop's seam. `loop` repeats the part. From `earliest_exit` on, the next
    action may start; None plays the action to its end. `stroke` is its most expressive moment. `ready`,
    `stroke_end` and `relax` are the ends of a gesture's preparation, stroke and hold; its retraction ends
    with the action. None takes the times found from the motion (`playback.timing.phases`). `repeat` is the
    number of seconds for which a gesture or fidget repeats its part if no request says how long; it plays the
    nearest whole number of times. 0 plays it once.
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
    repeat: float = 0.0


@dataclass(frozen=True, slots=True)
class Action:
    """One use of a clip in the graph.

    `stance` is the id of the stance it starts from; for kind "stance", of the stance whose loop it is. Only
    transitions have an `end_stance`. `limb` is the arm it needs; the other arm stays in the stance. `joints`
    names the only joints it moves; empty means all. `joint_weights` has pairs of a name and a weight, above 0
    and below 1, for joints that it moves in part; the rest of their motion is the stance's. `tags` are free
    words, "positive" and "negative" among them. `likelihood` is relative, above 0. `cooldown` is the number
    of seconds after its end in which it is not chosen again. `spacing` is the number of other actions of its
    kind and stance that are chosen before it may be chosen again; None follows the setting `never_twice`.
    `prominence` says how much it stands out, 0..1; None takes what its motion and name say. `contacts` are
    the times when its hands stay on the body. `clip_name` and `clip_sha256` name the clip it was made from if
    it has another clip now, else "" (see `formats.clip_identity`).
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
    prominence: float | None = None


@dataclass(frozen=True, slots=True)
class Stance:
    id: str
    layer: Layer
    name: str


Index = Mapping[tuple[str, Kind], tuple[Action, ...]]


@dataclass(frozen=True)
class MetaGraph:
    """One layer: its stances and actions.

    A performance begins in the stance `start`. `weights` gives a factor, 0 to 2, for each body part.
    """

    layer: Layer
    stances: Mapping[str, Stance] = field(default_factory=dict)
    actions: Mapping[str, Action] = field(default_factory=dict)
    start: str | None = None
    weights: Mapping[Part, float] = field(default_factory=dict)

    def weight(self, part: Part) -> float:
        """Return how strongly this layer moves a body part, 0 to 2."""
        return self.weights.get(part, REACH[self.layer][part])

    @cached_property
    def index(self) -> Index:
        """Return the multi-index of this layer: (stance, kind) -> actions, in the order they were placed."""
        return _grouped(self.actions.values(), _node)

    def of(self, stance: str, kind: Kind) -> tuple[Action, ...]:
        """Return the actions of a kind placed on a stance."""
        return self.index.get((stance, kind), ())

    @cached_property
    def uses(self) -> Mapping[str, tuple[Action, ...]]:
        """Return the actions of this layer that use each clip, by clip id, in the order they were placed."""
        return _grouped(self.actions.values(), _clip)

    @cached_property
    def into(self) -> Mapping[str, tuple[Action, ...]]:
        """Return the transitions by the stance they end in, in the order they were placed."""
        arriving = (a for a in self.actions.values() if a.kind == "transition" and a.end_stance is not None)
        return _grouped(arriving, lambda a: a.end_stance)

    @cached_property
    def touched(self) -> Mapping[str, int]:
        """Return the number of contacts that actions have with each joint."""
        return Counter(span.to for action in self.actions.values() for span in action.contacts)

    def but(self, **changes: Any) -> MetaGraph:
        """Return the graph with fields replaced, but not its actions. Everything derived from the actions is
        kept.
        """
        out = replace(self, **changes)
        derived = ("index", "uses", "into", "touched")
        out.__dict__.update({name: self.__dict__[name] for name in derived if name in self.__dict__})
        return out

    def with_actions(self, changes: Mapping[str, Action | None]) -> MetaGraph:
        """Return the graph with actions added, replaced (in place) or, for None, removed.

        The index, `uses` and `touched` are patched, not rebuilt, so an edit takes no longer in a graph of ten
        thousand actions.
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
    """Return the number of contacts with each joint after the changes."""
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
    """Return the groups after the changes, in the order in which `after` has the actions."""
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
                moved.add(key(new))  # an action that moves in keeps its place in the order of all
    out = dict(groups)
    for k, kept in touched.items():
        if kept:
            out[k] = tuple(after[i] for i in after if i in kept) if k in moved else tuple(kept.values())
        else:
            out.pop(k, None)
    return MappingProxyType(out)


class Uses(Mapping[str, tuple[Action, ...]]):
    """A view of several graphs: the actions of any layer that use a clip, by clip id."""

    def __init__(self, graphs: Iterable[MetaGraph]) -> None:
        self._graphs = tuple(graph.uses for graph in graphs)

    def __getitem__(self, clip: str) -> tuple[Action, ...]:
        found = tuple(action for uses in self._graphs for action in uses.get(clip, ()))
        if not found:
            raise KeyError(clip)
        return found

    def __contains__(self, clip: object) -> bool:
        for uses in self._graphs:  # noqa: SIM110 - `any` takes 3 times as long, and is called for each clip
            if clip in uses:
                return True
        return False

    def __iter__(self) -> Iterator[str]:
        return iter(dict.fromkeys(clip for uses in self._graphs for clip in uses))

    def __len__(self) -> int:
        return sum(1 for _ in self)


@dataclass(frozen=True)
class ClipEntry:
    """A clip of the project.

    `path` is relative to the project file, with `/` between folders. `take` is the number of the animation in
    the file. `digest` is the file's SHA-256 in hex. `frames` and `fps` are those of the clip as it plays.
    `as_is` names repairs that reading leaves out (`formats.takes.REPAIRS`). `brought_from` is the fingerprint
    of the skeleton it is retargeted from, "" if the file has the project's own. `made_by` and `made_seed` are
    the learned model that generated it and the seed; `made_by` is "" for other clips. `retime` says how it is
    played faster, slower or held. `in_place` removes the distance that its hips have moved by its end.
    `turned` and `moved_x`, `moved_z` are radians about the vertical and metres to the left and ahead by which
    it stands elsewhere than it was recorded.
    `timed_on` is the length of the clip in seconds when its actions were timed, if its file has another
    length now; else 0. `motion` is the loaded clip as it plays, None while the file is missing. `source` is
    the clip as it was read, if that differs (see `graph.editing.retiming`).
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
    in_place: bool = False
    turned: float = 0.0
    moved_x: float = 0.0
    moved_z: float = 0.0
    timed_on: float = 0.0

    @property
    def duration(self) -> float:
        """Return the seconds from the first frame to the last."""
        return (self.frames - 1) / self.fps if self.frames > 1 else 0.0


@dataclass(frozen=True)
class BasePose:
    """The pose that all offsets are relative to: a frame of a clip, or the skeleton's rest pose if `clip` is
    None.
    """

    clip: str | None = None
    frame: int = 0


@dataclass(frozen=True)
class Markov:
    """A first-order model over (limb, kind). It writes meta actions when there are no requests (Borer et al.,
    7.3).

    `matrix` has rows of probabilities, each of which sums to 1. `gap` is the mean rest between two actions,
    in seconds. `positive` and `negative` are the shares of gestures that request that tag, if tags are not
    part of the states. `tags` has one text for each state: the tags it requests, with blanks between them; it
    is empty if tags are not part of the states. `lengths` has the mean and standard deviation of each state's
    actions, in seconds; it is empty if they are unknown. `modes` has one row for each mode, in the order of
    `words.MODES`: the shares, 0 to 1, of the written gestures, fidgets and transitions that are performed in
    that mode. Without the last two rows, thinking and reacting are as listening. It is empty if the mode
    makes no difference.
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
        """Return the tags that a state requests, "" for none."""
        return self.tags[state] if self.tags else ""


@dataclass(frozen=True)
class Settings:
    """The planner's constants.

    `alpha` says how quickly a used action becomes unlikely (4 in the paper). `seed` has 32 bits. With
    `never_twice`, an action is not played twice in a row if there is another. `shortest` is the minimum
    length, in seconds, of a remainder that is kept when a meta action is cut. `wait` is how many seconds late
    a request may start. `memory` is the number of seconds after which a use no longer counts, 0 for never (as
    in the paper). `rest` is the least number of seconds in the stance between two actions of a layer. A
    running plan is not changed for the next `lookahead` seconds. `variety`, 0..4, multiplies the times of
    `planning.director`, which decide how rarely actions repeat and stances change; 0 is as in the paper.
    """

    alpha: float = 4.0
    seed: int = 1
    never_twice: bool = True
    shortest: float = 0.4
    wait: float = 4.0
    memory: float = 0.0
    rest: float = 0.0
    lookahead: float = 0.1
    variety: float = 1.0


def _empty_graphs() -> dict[Layer, MetaGraph]:
    return {layer: MetaGraph(layer) for layer in LAYERS}


@dataclass(frozen=True)
class Project:
    """Everything that a project file holds.

    `roles` (role -> joint name) and `parts` (joint name -> body part) are corrections. `character` is the
    path of the GLB to draw, relative to the project file, or None for the default body; `hidden` names
    its meshes that are not drawn. `points` are named places to look at, in metres. `props` are things
    drawn beside the character, by id. `lines` is the dialogue that an agent calls by id. `performances`
    and `conversations` are kept by id, and `timelines` holds their markers and other notes by the same
    ids. `tiers` says how each annotation tier was last read. `notes` are texts by the id of their action,
    "" for the project's own. `marks` identify clips so that they are found again, by clip id.
    `joint_maps` say how clips of other skeletons are retargeted, by the `joint_map.make_fingerprint` of
    those. `language` is the code of the language that conversations are read in ("de"), or "auto" to
    detect it from their words. `manual` has the state machines drawn by hand, by layer. `voices` has the
    analysed sound (`playback.life.voice.Voice`) of each line read so far; it is never saved. `touch` says
    whether contacts hold and hands stay outside the body. `parameters` are the named values that a game sets,
    in the order in which they are shown. `backdrop` is what is behind the character.
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
    props: Mapping[str, Prop] = field(default_factory=dict)
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
    parameters: Mapping[str, CharacterParameter] = field(default_factory=dict)
    backdrop: Backdrop = field(default_factory=Backdrop)

    def actions(self) -> Iterable[Action]:
        """Yield every action of every layer."""
        for layer in LAYERS:
            yield from self.graphs[layer].actions.values()

    def action(self, ident: str) -> Action | None:
        """Return the action with an id in any layer, or None."""
        for layer in LAYERS:
            found = self.graphs[layer].actions.get(ident)
            if found is not None:
                return found
        return None

    @property
    def size(self) -> int:
        """Return how many clips, actions and states the project has."""
        actions = sum(len(graph.actions) for graph in self.graphs.values())
        return len(self.clips) + actions + sum(len(machine.states) for machine in self.manual.values())

    def has(self, ident: str) -> bool:
        """Return whether anything in the project has this id."""
        graphs, machines = self.graphs.values(), self.manual.values()
        return (
            ident in self.clips
            or any(ident in g.actions or ident in g.stances for g in graphs)
            or any(ident in m.states or ident in m.links or ident in m.aliases for m in machines)
            or ident in self.performances
            or ident in self.conversations
            or ident in self.props
            or any(ident == marker.id for t in self.timelines.values() for marker in t.markers)
        )

    def stance(self, ident: str | None) -> Stance | None:
        """Return the stance with an id in any layer, or None."""
        for layer in LAYERS:
            if ident is not None and ident in self.graphs[layer].stances:
                return self.graphs[layer].stances[ident]
        return None

    def span(self, action: Action) -> tuple[float, float]:
        """Return start and end of the part that plays, in seconds of its clip. The end is never before the
        start.
        """
        entry = self.clips.get(action.clip)
        length = entry.duration if entry is not None else 0.0
        timing = action.timing
        start, end = timing.start, timing.end
        if not start > 0.0:  # most actions start at 0; NaN becomes 0, too
            start = 0.0
        elif start > length:
            start = length
        if end is None or end > length:
            end = length
        return start, end if end > start else start

    @cached_property
    def uses(self) -> Mapping[str, tuple[Action, ...]]:
        """Return the actions that use each clip, by clip id."""
        return Uses(self.graphs[layer] for layer in LAYERS)

    @cached_property
    def touched(self) -> frozenset[str]:
        """Return the names of the joints that have contacts of actions."""
        return frozenset(joint for layer in LAYERS for joint in self.graphs[layer].touched)

    def state(self, ident: str | None) -> State | None:
        """Return the state of a manual machine with an id in any layer, or None."""
        return (
            next((m.states[ident] for m in self.manual.values() if ident in m.states), None)
            if ident is not None
            else None
        )

    def alias(self, ident: str | None) -> Alias | None:
        """Return the alias of a manual machine with an id in any layer, or None."""
        return (
            next((m.aliases[ident] for m in self.manual.values() if ident in m.aliases), None)
            if ident is not None
            else None
        )

    def link(self, ident: str | None) -> Link | None:
        """Return the link of a manual machine with an id in any layer, or None."""
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
        """Return the clips that states of manual machines use."""
        return frozenset(s.clip for m in self.manual.values() for s in m.states.values())

    def with_graph(self, graph: MetaGraph, **more: Any) -> Project:
        """Return the project with one layer's graph replaced."""
        return replace(self, graphs={**self.graphs, graph.layer: graph}, **more)
