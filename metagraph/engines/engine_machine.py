"""The expanded machine with names, numbers and conditions, as engines' own state machines want it.

Every layer becomes one machine: a state for each action, an arrow for each implied connection. What asks for
an arrow:

    "done"    the source has come to its end (or to where it may be left)
    "action"  the layer's number `<layer>_action` is the target's, and the trigger `<layer>_play` was pulled
    "stance"  the layer's number `<layer>_stance` is that of a stance whose shortest way leads over the target
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from metagraph.engines.engine_names import assign_numbers, name_apart, write_word
from metagraph.graph import anatomy
from metagraph.graph.expand import find_chain, find_end_stance, list_connections
from metagraph.graph.model import LAYERS, REACH, Action, ClipEntry, Layer, MetaGraph, Project
from metagraph.graph.repeating import cycle_of, seconds_played
from metagraph.motion.character_mesh import CharacterMesh
from metagraph.motion.clip import Clip
from metagraph.playback.plan import Cue
from metagraph.playback.posing.layers import keep_to, sample_cue

Array = NDArray[Any]


@dataclass(frozen=True, slots=True)
class EngineState:
    """An action as a state. number: from 1 on, unique in its layer. name: unique in the whole export,
    letters, digits and "_"; its animation bears it, too. Both stay the action's own. seconds: how long it
    plays. loop: whether it repeats until something else is asked.
    """

    number: int
    name: str
    action: Action
    seconds: float
    loop: bool


@dataclass(frozen=True, slots=True)
class Arrow:
    """A connection between states `source` and `target`. leave: seconds of the source's animation from which
    it may be taken, None for at any time. blend: seconds. values: of `<layer>_action` or `<layer>_stance`,
    one of which must be set.
    """

    source: EngineState
    target: EngineState
    leave: float | None
    blend: float
    on: Literal["done", "action", "stance"]
    values: tuple[int, ...] = ()


@dataclass(frozen=True)
class Machine:
    """One layer. stances: id -> number, from 1 on, the start's first. joints: the names of those it moves."""

    layer: Layer
    graph: MetaGraph
    states: tuple[EngineState, ...]
    arrows: tuple[Arrow, ...]
    stances: Mapping[str, int]
    joints: tuple[str, ...]

    @cached_property
    def stance_words(self) -> Mapping[str, str]:
        """Stance -> what it is called in events: its name, made of letters, digits and "_"."""
        names = {ident: self.graph.stances[ident].name for ident in self.stances}
        return name_apart({ident: write_word(name) or write_word(ident) for ident, name in names.items()})

    def hop(self, here: str, goal: str) -> EngineState | None:
        """Return the first transition of the shortest way between two stances, None if there is none."""
        way = find_chain(self.graph, here, goal)
        actions = (s for s in self.states if s.action.kind == "transition" and s.action.stance == here)
        return next((s for s in actions if s.action.end_stance == way[0]), None) if way else None

    @property
    def start(self) -> EngineState:
        """The loop it begins in."""
        return self.rest(next(iter(self.stances)))

    def rest(self, stance: str) -> EngineState:
        """Return the loop that plays of itself in a stance: the first that was placed."""
        return next(s for s in self.states if s.action.kind == "stance" and s.action.stance == stance)

    @cached_property
    def leaving(self) -> Mapping[str, tuple[Arrow, ...]]:
        """State name -> the arrows that leave it."""
        out: dict[str, list[Arrow]] = {s.name: [] for s in self.states}
        for arrow in self.arrows:
            out[arrow.source.name].append(arrow)
        return {name: tuple(arrows) for name, arrows in out.items()}


def list_machines(project: Project, spell: Callable[[Action, str], str] | None = None) -> tuple[Machine, ...]:
    """Return the machines of the layers that have a stance with a loop, in the layers' order. spell: returns
    how an engine spells the name of an action's state.
    """
    playing = {a.id: a for layer in LAYERS for a in _playing(project.graphs[layer])}
    texts = _tell_apart(project, playing)
    named = name_apart(
        texts if spell is None else {ident: spell(playing[ident], text) for ident, text in texts.items()}
    )
    found = (_machine(project, project.graphs[layer], named) for layer in LAYERS)
    return tuple(m for m in found if m is not None)


def _tell_apart(project: Project, actions: Mapping[str, Action]) -> dict[str, str]:
    """Return what to call each action: by its layer and name; those of one name by their stances, too, and of
    one stance by their ids. None has such a name to itself, so whichever is removed, no other takes it over.
    """
    plain = {a.id: f"{a.layer}_{write_word(a.name) or write_word(a.id)}" for a in actions.values()}
    longer = {
        a.id: f"{plain[a.id]}{'_from' if a.kind == 'transition' else ''}_"
        f"{write_word(project.graphs[a.layer].stances[a.stance].name) or write_word(a.stance)}"
        for a in actions.values()
    }
    alike, close = Counter(plain.values()), Counter((plain[ident], longer[ident]) for ident in actions)
    out: dict[str, str] = {}
    for ident in actions:
        text = plain[ident] if alike[plain[ident]] == 1 else longer[ident]
        out[ident] = text if close[plain[ident], longer[ident]] == 1 else f"{text}_{write_word(ident)}"
    return out


def _playing(graph: MetaGraph) -> Iterator[Action]:
    """Yield the actions that can play: their stances have loops."""
    for action in graph.actions.values():
        ends = find_end_stance(action)
        if ends is not None and graph.of(action.stance, "stance") and graph.of(ends, "stance"):
            yield action


def _machine(project: Project, graph: MetaGraph, named: Mapping[str, str]) -> Machine | None:
    resting = [s for s in graph.stances if graph.of(s, "stance")]
    begin = graph.start if graph.start in resting else next(iter(resting), None)
    if begin is None or project.skeleton is None:
        return None
    stances = assign_numbers(sorted(resting, key=lambda s: s != begin))
    playing = {action.id: action for action in _playing(graph)}
    states: dict[str, EngineState] = {}
    for (ident, number), action in zip(assign_numbers(playing).items(), playing.values(), strict=True):
        start, end = project.span(action)
        seconds = seconds_played(action.kind, action.timing, start, end)
        states[ident] = EngineState(number, named[ident], action, seconds, action.kind == "stance")
    part = anatomy.project_parts(project)
    joints = tuple(
        n
        for n, p in zip(project.skeleton.names, part, strict=True)
        if p in REACH[graph.layer] and graph.weight(p) > 0
    )
    machine = Machine(graph.layer, graph, tuple(states.values()), (), stances, joints)
    arrows = tuple(arrow for arrow in _arrows(project, machine, states))
    return replace(machine, arrows=arrows)


def _arrows(project: Project, machine: Machine, states: Mapping[str, EngineState]) -> Iterator[Arrow]:
    graph = machine.graph
    first: dict[tuple[str, str], str] = {}  # the transition that stands for all between two stances
    for state in states.values():
        if state.action.kind == "transition":
            first.setdefault((state.action.stance, str(state.action.end_stance)), state.action.id)
    goals: dict[tuple[str, str], list[int]] = {}  # (stance, next on the way) -> the goals it leads to
    for here in machine.stances:
        for goal, number in machine.stances.items():
            way = find_chain(graph, here, goal)
            if way:
                goals.setdefault((here, way[0]), []).append(number)
    for row in list_connections(project, graph):
        if row.source not in states or row.target not in states:
            continue
        source, target = states[row.source], states[row.target]
        begin = project.span(source.action)[0]
        leave = None if row.leave is None else min(max(0.0, row.leave - begin), source.seconds)
        if (
            target.action.kind == "stance"
            and source.action.kind != "stance"
            and target is machine.rest(target.action.stance)
        ):
            last = max(
                0.0, source.seconds - source.action.timing.blend_out
            )  # so that the blend ends with the action
            yield Arrow(source, target, last, row.blend, "done")
            continue
        ends = (target.action.stance, str(target.action.end_stance))
        if target.action.kind == "transition" and first[ends] == target.action.id and ends in goals:
            yield Arrow(source, target, leave, row.blend, "stance", tuple(goals[ends]))
        yield Arrow(source, target, leave, row.blend, "action", (target.number,))


def make_animations(project: Project, machines: tuple[Machine, ...]) -> list[Clip]:
    """Return an animation for every state: the part of its clip that plays; joints that the action does not
    move stand as its stance begins. Actions whose clip is missing stand in it, too.
    """
    return [_animation(project, machine, state) for machine in machines for state in machine.states]


def _animation(project: Project, machine: Machine, state: EngineState) -> Clip:
    assert project.skeleton is not None
    rest = machine.rest(find_end_stance(state.action) or "").action
    loop, motion = project.clips[rest.clip].motion, project.clips[state.action.clip].motion
    playing = state.action if motion is not None else rest
    clip = motion if motion is not None else loop
    if clip is None:
        raise ValueError(f"the file of clip '{project.clips[state.action.clip].name}' is missing")
    clip = clip.dense
    start, end = project.span(playing)
    seconds = seconds_played(playing.kind, playing.timing, start, end)
    frames = max(2, round(seconds * clip.fps) + 1)
    rotations, translations = _played(playing, clip, start, end, np.linspace(0.0, seconds, frames))
    mask = anatomy.make_action_mask(project, state.action)
    if mask is not None and loop is not None:
        stance = loop.pose_at(project.span(rest)[0])
        shape = rotations.shape[:-1]
        rests = (
            np.broadcast_to(stance.rotations, (*shape, 4)),
            np.broadcast_to(stance.translations, (*shape, 3)),
        )
        keep_to((rotations, translations), rests, mask)
    moved = np.flatnonzero(
        np.abs(translations - anatomy.get_base_pose(project).translations).max((0, 2)) > 1e-6
    )
    translated = tuple(sorted({0, *moved.tolist()}))
    fps = (frames - 1) / max(seconds, 1e-3) if end > start else clip.fps
    return Clip(state.name, project.skeleton, fps, rotations, translations[:, list(translated)], translated)


def _played(action: Action, clip: Clip, start: float, end: float, times: Array) -> tuple[Array, Array]:
    """Return rotations `[F, J, 4]` and translations `[F, J, 3]` of the part from start to end of a clip, at
    `times` `[F]` from its beginning, again and again where its action repeats it.
    """

    def sample(seconds: Array) -> tuple[Array, Array]:
        pose = clip.pose_at(seconds)
        return np.array(pose.rotations), np.array(pose.translations)

    if cycle_of(action.kind, action.timing, start, end) <= 0:
        return sample(start + times)
    cue = Cue(action, 0.0, float(times[-1]), start, 0.0, 0.0, "", "", "", cycle_from=start, cycle_to=end)
    return sample_cue(cue, times, sample)


def make_clip_as_played(project: Project, entry: ClipEntry) -> Clip | None:
    """Return a clip's motion, with dense keys; where its only action repeats a part of it, that part as often
    as it plays. None if its file is missing.
    """
    if entry.motion is None:
        return None
    motion, uses = entry.motion.dense, project.uses.get(entry.id, ())
    if len(uses) == 1:
        action = uses[0]
        start, end = project.span(action)
        if cycle_of(action.kind, action.timing, start, end) <= 0:
            return motion
        seconds = seconds_played(action.kind, action.timing, start, end)
        times = np.arange(round(seconds * motion.fps) + 1) / motion.fps
        rotations, translations = _played(action, motion, start, end, times)
        weights = motion.weights_at(start + np.mod(times, end - start))
        moved = translations[:, list(motion.translated)]
        return replace(motion, rotations=rotations, translations=moved, weights=weights)
    return motion


def count_unrepeated(project: Project) -> int:
    """Return how many clips `make_clip_as_played` leaves as they are though an action repeats a part of
    them.
    """
    shared = [some for some in project.uses.values() if len(some) > 1]
    return sum(any(cycle_of(a.kind, a.timing, *project.span(a)) > 0 for a in some) for some in shared)


def write_machine_glb(
    project: Project,
    machines: tuple[Machine, ...],
    path: Path,
    character: CharacterMesh | None,
    base: Path | None,
) -> tuple[str, ...]:
    """Write the GLB engines' own state machines play: the joints' nodes stand in the base pose, against which
    additive layers are taken, and every state has an animation of its name. Return what to say of props that
    cannot be read. base: the folder that their paths are relative to, None to leave them out. Raises
    FileError.
    """
    from metagraph.engines.placed_props import place_props
    from metagraph.formats.gltf.writer import ForEngine, write_glb

    assert project.skeleton is not None
    props, notes = place_props(project, base)
    engine = ForEngine(stand=anatomy.get_base_pose(project), props=props)
    write_glb(path, make_animations(project, machines), character, engine=engine)
    return notes
