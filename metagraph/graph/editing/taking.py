"""Take stances and actions, with their clips, from one project into another: what is taken and what it
becomes is worked out first, so that a person can see it, and then done in one edit.

A stance joins the one of the same name in its layer. A clip of the same content is the same clip. What is
there already is not added again.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Literal

from metagraph.common.wording import join_phrases, phrase, plural_phrase
from metagraph.errors import describe_error
from metagraph.graph import ids
from metagraph.graph.clip_source import get_source_clip, with_source
from metagraph.graph.editing.retargeting import Bringing
from metagraph.graph.edits import find_free_name
from metagraph.graph.face.takes import is_face_take
from metagraph.graph.model import LAYERS, Action, ClipEntry, Kind, Layer, MetaGraph, Project, Stance
from metagraph.motion.adopt import SkeletonMismatchError, adopt
from metagraph.motion.clip import Clip, ClipError
from metagraph.motion.joint_map import JointMap, RetargetError, make_fingerprint

Becomes = Literal["new", "joined", "there", "renamed", "left out"]
_NEW: dict[Kind, str] = {
    "stance": phrase("a new loop"),
    "gesture": phrase("a new gesture"),
    "fidget": phrase("a new fidget"),
    "transition": phrase("a new transition"),
}


@dataclass(frozen=True)
class TakenItem:
    """One thing that is taken, or why it is not. layer: None for a clip. name: in the other project. words:
    what becomes of it here.
    """

    kind: Literal["stance", "action", "clip"]
    layer: Layer | None
    name: str
    becomes: Becomes
    words: str


@dataclass(frozen=True)
class Taking:
    """project: this one with everything taken. things: what was taken, in the order of the other project."""

    project: Project
    things: tuple[TakenItem, ...]

    def count(self, kind: str, becomes: Collection[Becomes] = ("new", "renamed")) -> int:
        """Return how many things of a kind became that."""
        return sum(x.kind == kind and x.becomes in becomes for x in self.things)


def take_piece(project: Project, actions: Collection[str] = (), stances: Collection[str] = ()) -> Project:
    """Return a project that holds some actions alone, with what they need: their stances, each with its
    loops, their clips, and the joint maps those were brought by.

    stances: those that are taken with all that is placed on them.
    """
    graphs = {}
    for layer, graph in project.graphs.items():
        chosen = {a.id for a in graph.actions.values() if a.id in actions or a.stance in stances}
        needed = {i for a in graph.actions.values() if a.id in chosen for i in (a.stance, a.end_stance) if i}
        needed |= {i for i in graph.stances if i in stances}
        kept = {
            i: a
            for i, a in graph.actions.items()
            if i in chosen or (a.kind == "stance" and a.stance in needed)
        }
        start = graph.start if graph.start in needed else next(iter(needed), None)
        graphs[layer] = replace(
            graph, stances={i: s for i, s in graph.stances.items() if i in needed}, actions=kept, start=start
        )
    used = {a.clip for graph in graphs.values() for a in graph.actions.values()}
    return Project(
        name=project.name,
        skeleton=project.skeleton,
        clips={i: e for i, e in project.clips.items() if i in used},
        graphs=graphs,
        roles=project.roles,
        parts=project.parts,
        joint_maps=project.joint_maps,
        base=project.base if project.base.clip in used else Project().base,
    )


def take(
    project: Project,
    other: Project,
    actions: Collection[str] | None = None,
    retarget: bool = True,
) -> Taking:
    """Return the project with what another one holds, and what became of each thing.

    other: with the motion of its clips, its paths relative to the same folder as the project's (see
    `store.moved`). actions: those that are wanted; of the others only loops of stances that are new here are
    taken. None: all, and clips that nothing uses, too. retarget: bring clips of another skeleton onto the
    project's; else they are left out.
    """
    clips = _Clips(project, other, retarget)
    things: list[TakenItem] = []
    graphs = {layer: _take_layer(project, other, layer, actions, clips, things) for layer in LAYERS}
    if actions is None:
        for ident in other.clips:
            clips.of(ident)
    after = replace(
        project,
        graphs=graphs,
        clips=clips.entries,
        skeleton=project.skeleton or other.skeleton,
        joint_maps={**project.joint_maps, **clips.joint_maps},
    )
    if project.skeleton is None:
        base = replace(other.base, clip=clips.given.get(other.base.clip or ""))
        after = replace(after, base=base, roles=other.roles, parts=other.parts, character=other.character)
    return Taking(after, (*things, *clips.things))


def _take_layer(
    project: Project,
    other: Project,
    layer: Layer,
    actions: Collection[str] | None,
    clips: _Clips,
    things: list[TakenItem],
) -> MetaGraph:
    """Return a layer's graph with what the other project has in that layer; say in `things` what became of
    it.
    """
    source, graph = other.graphs[layer], project.graphs[layer]
    known = {stance.name: i for i, stance in graph.stances.items()}
    places: dict[str, str] = {}  # stances of the other project -> of this one
    new: dict[str, Stance] = {}  # by their ids in the other project
    for ident, stance in source.stances.items():
        if stance.name not in known:
            made = ids.make_id(project, "s", layer, stance.name, more=known.values())
            new[ident] = Stance(made, layer, stance.name)
            known[stance.name] = made
        places[ident] = known[stance.name]
    added: dict[str, Action | None] = {}
    there = {_same(a): a for a in graph.actions.values()}
    taken: list[TakenItem] = []
    for action in source.actions.values():
        if actions is not None and action.id not in actions and action.stance not in new:
            continue  # a loop that only comes along with a stance that is new
        thing, here = _action(project, action, places, clips, there, added)
        taken.append(replace(thing, layer=layer))
        if here is not None:
            added[here.id] = here
            there[_same(here)] = here
    needed = {i for a in added.values() if a is not None for i in (a.stance, a.end_stance)}
    empty = {i for i in new if not any(a.stance == i for a in source.actions.values())}
    stances = dict(graph.stances)
    for ident, stance in source.stances.items():
        if ident not in new:
            things.append(
                TakenItem(
                    "stance", layer, stance.name, "joined", phrase("is added to the stance with that name")
                )
            )
        elif places[ident] in needed or ident in empty:
            stances[places[ident]] = new[ident]
            things.append(TakenItem("stance", layer, stance.name, "new", phrase("a new stance")))
        else:
            words = phrase("none of its actions can be copied")
            things.append(TakenItem("stance", layer, stance.name, "left out", words))
    things += taken
    if not graph.stances:
        graph = graph.but(weights=source.weights)
    begin = places.get(source.start or "")
    start = graph.start or (begin if begin in stances else next(iter(stances), None))
    graph = graph.but(stances=stances, start=start)
    return graph.with_actions(added) if added else graph


def _same(action: Action) -> tuple[object, ...]:
    """Return by what two actions of a layer are the same."""
    return action.clip, action.kind, action.stance, action.end_stance, action.timing


def _action(
    project: Project,
    action: Action,
    places: Mapping[str, str],
    clips: _Clips,
    there: Mapping[tuple[object, ...], Action],
    added: Mapping[str, Action | None],
) -> tuple[TakenItem, Action | None]:
    """Return what becomes of an action, and the action as it is added, None if it is not."""

    def thing(becomes: Becomes, words: str) -> TakenItem:
        return TakenItem("action", None, action.name, becomes, words)

    clip = clips.of(action.clip)
    if clip is None:
        return thing("left out", clips.why(action.clip)), None
    stance, end = places.get(action.stance), places.get(action.end_stance or "")
    if stance is None or (action.kind == "transition" and end is None):
        return thing("left out", phrase("its stance is not in the other project")), None
    made, words = clips.fitted_action(replace(action, clip=clip, stance=stance, end_stance=end))
    if made is None:
        return thing("left out", words), None
    same = there.get(_same(made))
    if same is not None:
        return thing("there", phrase("is already here, as '{name}'", name=same.name)), None
    ident = ids.make_id(project, "a", action.layer, action.kind, stance, end or "", clip, more=added)
    return thing("new", words or _NEW[action.kind]), replace(made, id=ident)


@dataclass
class _Clips:
    """The clips that come along, each once, when something needs it. given: ids there -> ids here."""

    project: Project
    other: Project
    retarget: bool
    given: dict[str, str] = field(default_factory=dict)
    lost: dict[str, str] = field(default_factory=dict)  # why a clip is left out
    things: list[TakenItem] = field(default_factory=list)
    joint_maps: dict[str, JointMap] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.entries: dict[str, ClipEntry] = dict(self.project.clips)
        self.known = {_content(e): e.id for e in self.entries.values()}
        self.names = {e.name for e in self.entries.values()}
        self.bringing = Bringing(self.project)

    @cached_property
    def joints(self) -> Mapping[str, str] | None:
        """Joints of the other project -> those here; None if both call them alike."""
        skeleton, own = self.other.skeleton, self.project.skeleton
        if skeleton is None or own is None or set(skeleton.names) <= set(own.names):
            return None
        return {pair.source: pair.target for pair in self.bringing.propose(skeleton).pairs}

    def fitted_action(self, action: Action) -> tuple[Action | None, str]:
        """Return an action with the joints of this project, None if it moves none of them; and what was
        changed, in words.
        """
        joints = self.joints
        if joints is None:
            return action, ""
        named = tuple(joints[name] for name in action.joints if name in joints)
        weights = tuple((joints[name], weight) for name, weight in action.joint_weights if name in joints)
        if action.joints and not named:
            return None, phrase("this skeleton has none of the joints that it moves")
        words = ""
        if action.contacts:
            words = phrase("{what}; its contacts are not copied: find them again", what=_NEW[action.kind])
        return replace(action, joints=named, joint_weights=weights, contacts=()), words

    def why(self, ident: str) -> str:
        return self.lost.get(ident, phrase("its clip is not in the other project"))

    def of(self, ident: str) -> str | None:
        """Return the id here of a clip of the other project; None if it cannot be taken."""
        if ident in self.given or ident in self.lost or ident not in self.other.clips:
            return self.given.get(ident)
        entry = self.other.clips[ident]
        same = self.known.get(_content(entry))
        if same is not None:
            self.given[ident] = same
            words = phrase("is already here, as '{name}'", name=self.entries[same].name)
            self.things.append(TakenItem("clip", None, entry.name, "there", words))
            return same
        try:
            entry = self._fitted(entry)
        except (RetargetError, ClipError, SkeletonMismatchError) as error:
            self.lost[ident] = why = describe_error(error)
            self.things.append(TakenItem("clip", None, entry.name, "left out", why))
            return None
        name = find_free_name(entry.name, self.names)
        made = ids.make_id(self.project, "c", entry.path, entry.take, name, more=self.entries)
        self.names.add(name)
        self.entries[made] = replace(entry, id=made, name=name)
        self.known[_content(entry)] = made
        self.given[ident] = made
        if name != entry.name:
            self.things.append(
                TakenItem("clip", None, entry.name, "renamed", phrase("a new clip named '{name}'", name=name))
            )
        else:
            self.things.append(TakenItem("clip", None, name, "new", phrase("a new clip")))
        return made

    def _fitted(self, entry: ClipEntry) -> ClipEntry:
        """Return a clip on this skeleton. Raises RetargetError, ClipError, SkeletonMismatchError."""
        source, skeleton = get_source_clip(entry), self.project.skeleton
        if source is None or skeleton is None or is_face_take(source) or source.skeleton == skeleton:
            return entry  # a clip whose file is missing is taken as such, and `check` reports it
        try:
            return with_source(entry, adopt(source, skeleton))
        except SkeletonMismatchError:
            if not self.retarget:
                raise
        return self._brought(entry, source)

    def _brought(self, entry: ClipEntry, source: Clip) -> ClipEntry:
        if entry.brought_from:
            raise RetargetError(
                phrase(
                    "it was already retargeted in the other project: import its file ({path}) here instead",
                    path=entry.path,
                )
            )
        joint_map = self.bringing.known(source) or self.bringing.propose(source.skeleton)
        if joint_map.missing:
            raise RetargetError(joint_map.missing[0])
        motion = self.bringing.bring(source, joint_map)
        self.joint_maps[make_fingerprint(source.skeleton)] = joint_map
        return with_source(replace(entry, brought_from=motion.brought_from), motion)


def _content(entry: ClipEntry) -> tuple[object, ...]:
    """Return by what two clips are the same: content, or place if that is not known, and how they play."""
    stands = (entry.in_place, entry.turned, entry.moved_x, entry.moved_z)
    return (entry.digest or entry.path, entry.take, entry.as_is, entry.retime, *stands)


def describe_taking(taking: Taking) -> str:
    """Say in a line what was taken."""
    counts = [
        plural_phrase("{count:,} new stance", "{count:,} new stances", taking.count("stance")),
        plural_phrase("{count:,} new action", "{count:,} new actions", taking.count("action")),
        plural_phrase("{count:,} new clip", "{count:,} new clips", taking.count("clip")),
    ]
    counts = [x for x in counts if x.values["count"]]
    words = join_phrases(counts, ", ") if counts else phrase("Nothing new")
    if there := taking.count("action", ["there"]):
        words = plural_phrase(
            "{taken}; {count:,} action is already here",
            "{taken}; {count:,} actions are already here",
            there,
            taken=words,
        )
    if left := taking.count("action", ["left out"]):
        words = plural_phrase(
            "{taken}; {count:,} action skipped", "{taken}; {count:,} actions skipped", left, taken=words
        )
    elif left := taking.count("clip", ["left out"]):
        words = plural_phrase(
            "{taken}; {count:,} clip skipped", "{taken}; {count:,} clips skipped", left, taken=words
        )
    return words
