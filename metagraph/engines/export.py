"""Export: one JSON and one GLB that hold all a runtime needs, and their reading back."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import msgspec
import numpy as np

from metagraph.engines import contract as c
from metagraph.engines.rig import LIFELESS, read_rig, read_voices, rig_of, voices_of
from metagraph.errors import FileError
from metagraph.formats.atomic import write_atomically
from metagraph.formats.data import above, markov_from, skeleton_from
from metagraph.formats.fields import DataError
from metagraph.graph import anatomy
from metagraph.graph.check import check
from metagraph.graph.expand import connections
from metagraph.graph.face import CHANNELS
from metagraph.graph.model import (
    KINDS,
    LAYERS,
    REACH,
    Action,
    BasePose,
    ClipEntry,
    Layer,
    Markov,
    MetaGraph,
    Project,
    Settings,
    Stance,
    Timing,
)
from metagraph.motion.character import Character
from metagraph.motion.clip import Clip
from metagraph.motion.skeleton import Skeleton, unique_names
from metagraph.playback import choice, markov
from metagraph.playback.life.body import Body
from metagraph.playback.phases import LEAST_BLEND, phases
from metagraph.playback.pick import HURRY, LOOP_FADE
from metagraph.playback.planner import WINDOW


class ExportError(ValueError):
    """The project cannot be exported; the message says what to mend first."""


@dataclass(frozen=True)
class Exported:
    """What was written. warnings: problems that do not stop an export, in words. sounds: of lines."""

    json: Path
    glb: Path
    clips: int
    warnings: tuple[str, ...] = ()
    sounds: tuple[Path, ...] = ()


def export(
    project: Project,
    folder: str | Path,
    expanded: bool = False,
    mesh: bool = True,
    character: Path | Character | None = None,
    progress: Callable[[int, int, str], None] | None = None,
) -> Exported:
    """Write `<name>.json` and `<name>.glb` into a folder.

    expanded: list the expanded state machine as well. mesh: put the character's mesh into the GLB; `character` is it,
    or its file. Raises ExportError while the project has errors, FileError when a file cannot be written.
    """
    warnings = sound(project)
    made = write(project, folder, expanded, character if mesh else None, progress)
    return replace(made, warnings=(*made.warnings, *warnings))


def sound(project: Project) -> tuple[str, ...]:
    """Return the warnings about a project that can be exported, in words. Raises ExportError with what must be mended first."""
    problems = check(project)
    errors = [p for p in problems if p.severity == "error"]
    if errors:
        more = f" (and {len(errors) - 1} more)" if len(errors) > 1 else ""
        raise ExportError(f"{errors[0].message}. {errors[0].remedy}{more}")
    if project.skeleton is None or not any(True for _ in project.actions()):
        raise ExportError("no action is placed yet: there is nothing to export")
    return tuple(f"{p.message}. {p.remedy}" for p in problems if p.severity == "warning")


def stem_of(project: Project) -> str:
    """Return what a project's exported files are called."""
    return re.sub(r"[^\w.-]+", "_", project.name).strip("._") or "metagraph"


def write(
    project: Project,
    folder: str | Path,
    expanded: bool = False,
    character: Path | Character | None = None,
    progress: Callable[[int, int, str], None] | None = None,
    base: Path | None = None,
) -> Exported:
    """Write a project that has clips without asking whether it is sound. Arguments as for `export`. base: the folder its lines' sounds are
    relative to; they are copied into `lines/`, where it is given.
    """
    tell = progress or (lambda done, total, words: None)
    assert project.skeleton is not None
    used = _used(project)
    stem, target = stem_of(project), Path(folder)
    glb, json = target / f"{stem}.glb", target / f"{stem}.json"
    names = unique_names([entry.name for entry in used])
    tell(0, 3, "clips")
    clips = [e.motion.renamed(name) for e, name in zip(used, names, strict=True) if e.motion is not None]
    notes = _write_glb(glb, clips, project.skeleton, character)
    tell(1, 3, "graph")
    document = to_document(project, glb.name, names, expanded)
    sounds, missing = _sounds(document, target, base) if base is not None else ((), ())
    tell(2, 3, "writing")
    write_atomically(json, msgspec.json.format(msgspec.json.encode(document), indent=1))
    tell(3, 3, "done")
    return Exported(json, glb, len(used), (*notes, *missing), sounds)


def _sounds(document: c.Export, folder: Path, base: Path) -> tuple[tuple[Path, ...], tuple[str, ...]]:
    """Copy the sounds of a document's lines beside it, and name them there; return the files, and what is missing, in words."""
    lines = [(ident, line) for ident, line in document.lines.items() if line.audio]
    names = unique_names([Path(str(line.audio)).stem for _, line in lines])
    files, missing = [], []
    for (ident, line), name in zip(lines, names, strict=True):
        source = base / str(line.audio)
        inside = f"lines/{name}{source.suffix}"
        try:
            content = source.read_bytes()
        except OSError as error:
            missing.append(f"the sound of line '{ident}' is left out: {source.name} cannot be read ({error.strerror})")
            continue
        write_atomically(folder / inside, content)
        document.lines[ident] = msgspec.structs.replace(line, audio=inside)
        files.append(folder / inside)
    return tuple(files), tuple(missing)


def _write_glb(path: Path, clips: list[Clip], skeleton: Skeleton, character: Path | Character | None) -> list[str]:
    """Write the GLB; return what is not in it, in words."""
    from metagraph.formats.gltf import read_character
    from metagraph.formats.gltf_writer import write_glb

    try:
        path.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise FileError(
            path.parent, f"cannot be made ({error.strerror})", "on making the folder", "Choose a folder you may write to."
        ) from None
    notes = []
    body = read_character(character) if isinstance(character, Path) else character
    if body is not None and character is not None and body.skeleton != skeleton:
        body = None  # it would not move with these clips
        notes.append(f"the mesh of '{character.name}' is left out: it has another skeleton than the clips")
    write_glb(path, [replace(clip, skeleton=skeleton) for clip in clips], body)
    return notes


def _used(project: Project) -> list[ClipEntry]:
    """Return the clips that are placed, and the base pose's, in the project's order."""
    return [e for e in project.clips.values() if e.id in project.uses or e.id == project.base.clip]


def to_document(project: Project, glb: str, names: tuple[str, ...], expanded: bool = False) -> c.Export:
    """Return the JSON's content; `names`: of the used clips' animations in the GLB."""
    skeleton = project.skeleton
    assert skeleton is not None
    parts, sides = anatomy.parts(project), anatomy.sides(project)
    joints = [
        c.Joint(
            name,
            skeleton.names[skeleton.parents[i]] if skeleton.parents[i] >= 0 else None,
            parts[i],
            sides[i],  # type: ignore[arg-type]
            [float(x) for x in skeleton.rest_translations[i]],
            [float(x) for x in skeleton.rest_rotations[i]],
        )
        for i, name in enumerate(skeleton.names)
    ]
    pose = anatomy.base_pose(project)
    base = c.Base(project.base.clip, project.base.frame, pose.rotations.tolist(), pose.translations.tolist())
    clips = [
        c.ExportedClip(e.id, name, n, e.fps, e.frames, e.duration, e.digest)
        for n, (e, name) in enumerate(zip(_used(project), names, strict=True))
    ]
    return c.Export(
        metagraph=c.FORMAT,
        name=project.name,
        glb=glb,
        height=skeleton.height,
        order=list(LAYERS),
        joints=joints,
        base=base,
        clips=clips,
        layers={layer: _layer(project, project.graphs[layer]) for layer in LAYERS},
        planner=_planner(project.settings),
        randomness=c.Randomness(
            "fnv1a32-mix", choice.OFFSET, choice.PRIME, [16, choice.MIX[0], 13, choice.MIX[1], 16], choice.key32(1, "a", "b")
        ),
        roles=dict(project.roles),
        parts=dict(project.parts),
        expanded={layer: _expanded(project, project.graphs[layer]) for layer in LAYERS} if expanded else None,
        life=project.life,
        face=project.face,
        points=dict(project.points),
        lines=dict(project.lines),
        performances=dict(project.performances),
        rig=rig_of(project),
        voices=voices_of(project),
    )


def _planner(s: Settings) -> c.Planner:
    return c.Planner(
        s.seed & 0xFFFFFFFF, s.alpha, s.never_twice, s.shortest, s.wait, WINDOW, LOOP_FADE, "3x^2-2x^3",
        s.memory, s.rest, s.lookahead, HURRY, LEAST_BLEND,
    )  # fmt: skip


def _layer(project: Project, graph: MetaGraph) -> c.ExportedLayer:
    index: dict[str, dict[c.KindName, list[str]]] = {}
    for stance in graph.stances:
        for kind in KINDS:
            if actions := graph.of(stance, kind):
                index.setdefault(stance, {})[kind] = [a.id for a in actions]
    ways: dict[tuple[str, str], list[str]] = {}
    for action in graph.actions.values():
        if action.kind == "transition" and action.end_stance is not None:
            ways.setdefault((action.stance, action.end_stance), []).append(action.id)
    model = markov.model(project, graph.layer)
    return c.ExportedLayer(
        start=graph.start,
        weights={part: graph.weight(part) for part in REACH[graph.layer]},
        own_weights=list(graph.weights),
        stances=[c.ExportedStance(s.id, s.name) for s in graph.stances.values()],
        actions=[_action(project, a) for a in graph.actions.values()],
        index=index,
        transitions=[c.Transition(a, b, ids) for (a, b), ids in ways.items()],
        markov=c.ExportedMarkov(
            list(model.states),
            [list(row) for row in model.matrix],
            model.gap,
            model.positive,
            model.negative,
            list(model.tags),
            [list(pair) for pair in model.lengths],
        ),
        own_markov=graph.layer in project.markov,
    )


def _action(project: Project, action: Action) -> c.ExportedAction:
    start, end = project.span(action)
    t = action.timing
    return c.ExportedAction(
        action.id,
        action.name,
        action.clip,
        action.kind,
        action.stance,
        action.end_stance,
        start,
        end,
        t.end is None,
        max(0.0, t.blend_in),
        max(0.0, t.blend_out),
        t.loop,
        t.earliest_exit,
        t.stroke,
        action.limb,
        list(action.joints),
        list(action.tags),
        action.likelihood,
        *_phases(project, action),
        max(0.0, action.cooldown),
        action.spacing,
    )


def _phases(project: Project, action: Action) -> tuple[list[float], list[float | None]]:
    """Return a gesture's phases as they are, and as the user set them."""
    if action.kind != "gesture":
        return [], []
    found, t = phases(project, action), action.timing
    own = [t.ready, t.stroke_end, t.relax]
    return [found.ready, found.stroke, found.stroke_end, found.relax], own if any(x is not None for x in own) else []


def _expanded(project: Project, graph: MetaGraph) -> c.Expanded:
    states = list(graph.actions)
    place = {ident: n for n, ident in enumerate(states)}
    rows = list(connections(project, graph))
    return c.Expanded(
        states,
        [place[r.source] for r in rows],
        [place[r.target] for r in rows],
        [-1.0 if r.leave is None else r.leave for r in rows],
        [r.blend for r in rows],
    )


def read_export(path: str | Path, motions: bool = True, resolved: bool = False) -> Project:
    """Read an export back into a project with the same graph, ids and constants. motions: load the clips from its GLB. resolved: take
    gestures' phases, the base pose and the rig as the export has them, as a runtime does, instead of finding them anew.

    Raises FileError naming the field that is wrong as a path into the JSON.
    """
    path = Path(path)
    try:
        document = msgspec.json.decode(path.read_bytes(), type=c.Export)
    except OSError as error:
        raise FileError(path, f"cannot be read ({error.strerror})", "on opening it", "Check that it is there.") from None
    except (msgspec.MsgspecError, RecursionError, UnicodeDecodeError) as error:
        cause, _, where = str(error).partition(" - at ")
        where = where.strip("`") or "$"
        remedy = "Update Metagraph, or export it again." if where == "$.metagraph" else "Export it again."
        raise FileError(path, cause[:1].lower() + cause[1:], where, remedy) from None
    try:
        return _project(path, document, motions, resolved)
    except DataError as error:
        raise FileError(path, str(error), error.where, "Export it again.") from None


def _project(path: Path, document: c.Export, motions: bool, resolved: bool) -> Project:
    """Return the project of a decoded export. Raises DataError for what its types alone cannot say."""
    if missing := [layer for layer in LAYERS if layer not in document.layers]:
        raise DataError("$.layers", f"layer '{missing[0]}' is missing")
    if "/" in document.glb or "\\" in document.glb:
        raise DataError("$.glb", "should be the name of a file beside this one")
    skeleton = _skeleton(document.joints)
    takes: list[Clip] = []
    if motions:
        from metagraph.formats.gltf import read_gltf_clips

        takes = read_gltf_clips(path.parent / document.glb)
    # Clips of one frame are passed over where a file has longer ones, so they do not count as takes.
    longer = sorted(x.animation for x in document.clips if x.frames > 1) or [x.animation for x in document.clips]
    clips: dict[str, ClipEntry] = {}
    for n, clip in enumerate(document.clips):
        if clip.id in clips:
            raise DataError(f"$.clips[{n}].id", f"'{clip.id}' is used twice")
        if motions and clip.animation >= len(takes):
            raise DataError(f"$.clips[{n}].animation", f"the GLB has {len(takes)} animations, no number {clip.animation}")
        motion = takes[clip.animation] if motions else None
        motion = replace(motion, skeleton=skeleton) if motion is not None and motion.skeleton.names == skeleton.names else motion
        take = longer.index(clip.animation) if clip.animation in longer else len(longer) + n
        clips[clip.id] = ClipEntry(clip.id, clip.name, document.glb, take, clip.sha256, clip.frames, clip.fps, motion)
    p = document.planner
    base = BasePose(document.base.clip, document.base.frame)
    body = None
    if resolved:
        clips[BASE] = _base(document, skeleton)
        base = BasePose(BASE)
        body = _body(document.rig, skeleton) if document.rig is not None else LIFELESS
    graphs: dict[Layer, MetaGraph] = {layer: _graph(layer, document.layers[layer], resolved) for layer in LAYERS}
    return Project(
        name=document.name,
        skeleton=skeleton,
        clips=clips,
        graphs=graphs,
        base=base,
        roles=dict(document.roles),
        parts=dict(document.parts),
        markov={layer: _markov(layer, document.layers[layer].markov) for layer in LAYERS if document.layers[layer].own_markov},
        settings=Settings(p.alpha, p.seed, p.never_twice, p.shortest, p.wait, p.memory, p.rest, p.lookahead),
        life=document.life,
        body=body,
        face=document.face,
        points=dict(document.points),
        lines=dict(document.lines),
        performances=dict(document.performances),
        voices=read_voices(document.voices),
        next_id=above(*clips, *(i for g in graphs.values() for i in (*g.stances, *g.actions))),
    )


BASE = "base pose"  # id of a clip of one frame that stands for the exported base pose


def _base(document: c.Export, skeleton: Skeleton) -> ClipEntry:
    """Return a clip of the base pose as the export has it; that of the GLB's clip is rounded."""
    base, joints = document.base, len(skeleton)
    for field, rows in (("rotations", base.rotations), ("translations", base.translations)):
        if len(rows) != joints:
            raise DataError(f"$.base.{field}", f"should be {joints} rows, one for each joint")
    motion = Clip(BASE, skeleton, 30.0, np.array([base.rotations]), np.array([base.translations]), tuple(range(joints)))
    return ClipEntry(BASE, BASE, document.glb, 0, "", 1, 30.0, motion)


def _body(rig: c.Rig, skeleton: Skeleton) -> Body:
    """Return the body of an export's rig. Raises DataError where it does not fit the joints."""
    faces = {len(rig.face.joints)} | {len(row) for row in (*rig.face.turns, *rig.face.shifts)}
    joints = [*rig.chain, *rig.face.joints, *rig.face.lid_joints, *(s.joint for s in rig.shoulders), *(e.joint for e in rig.eyes)]
    places = [rig.trunk, *(x.place for x in rig.lookers)]
    fits = rig.chain and len(rig.breath) == len(rig.chain) and max(joints) < len(skeleton) and max(places) < len(rig.chain)
    if not fits or len(faces) > 1 or {len(rig.face.turns), len(rig.face.shifts)} != {len(CHANNELS)}:
        raise DataError("$.rig", "does not fit the joints")
    return read_rig(rig)


def _skeleton(joints: list[c.Joint]) -> Skeleton:
    rows = [{"name": j.name, "parent": j.parent, "at": j.translation, "turn": j.rotation} for j in joints]
    try:
        found = skeleton_from(rows, "$.joints")
    except DataError as error:
        where = error.where.replace(".at", ".translation").replace(".turn", ".rotation")
        raise DataError(where, str(error)) from None
    if found is None:
        raise DataError("$.joints", "should not be empty")
    return found


def _markov(layer: Layer, model: c.ExportedMarkov) -> Markov:
    if model.tags and len(model.tags) != len(model.states):
        raise DataError(f"$.layers.{layer}.markov.tags", f"should be {len(model.states)} texts, one for each state")
    states = [
        f"{limb} {kind} {tag}".rstrip() for (limb, kind), tag in zip(model.states, model.tags or [""] * len(model.states), strict=True)
    ]
    more = {"gap": model.gap, "positive": model.positive, "negative": model.negative, "lengths": model.lengths}
    return markov_from(layer, {"states": states, "matrix": model.matrix, **more}, f"$.layers.{layer}.markov")


def _graph(layer: Layer, data: c.ExportedLayer, resolved: bool) -> MetaGraph:
    where = f"$.layers.{layer}"
    stances: dict[str, Stance] = {}
    for n, s in enumerate(data.stances):
        if s.id in stances:
            raise DataError(f"{where}.stances[{n}].id", f"'{s.id}' is used twice")
        stances[s.id] = Stance(s.id, layer, s.name)
    actions: dict[str, Action] = {}
    for n, a in enumerate(data.actions):
        if a.id in actions:
            raise DataError(f"{where}.actions[{n}].id", f"'{a.id}' is used twice")
        own: list[float | None] = list(a.own_phases) if len(a.own_phases) == 3 else [None] * 3
        stroke = a.stroke
        if resolved and len(a.phases) == 4:
            (own[0], stroke), own[1:] = a.phases[:2], a.phases[2:]
        elif resolved and a.kind == "gesture":  # an export that does not tell them yet
            stroke = (a.start + a.end) / 2 if stroke is None else stroke
            own = [stroke] * 3
        timing = Timing(a.start, None if a.whole_end else a.end, a.blend_in, a.blend_out, a.loop, a.earliest_exit, stroke, *own)
        actions[a.id] = Action(
            a.id, a.clip, a.kind, layer, a.stance, a.name, a.end_stance, timing, a.limb, tuple(a.joints), tuple(a.tags), a.likelihood,
            a.cooldown, a.spacing,
        )  # fmt: skip
    if unknown := [part for part in data.own_weights if part not in data.weights]:
        raise DataError(f"{where}.own_weights", f"weights say nothing of '{unknown[0]}'")
    return MetaGraph(layer, stances, actions, data.start, {part: data.weights[part] for part in data.own_weights})


def schema_text() -> bytes:
    """Return the published schema's text."""
    return msgspec.json.format(msgspec.json.encode(c.schema()), indent=1) + b"\n"
