"""Read an export back, into a project or in the resolved form that a runtime plays."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import msgspec
import numpy as np

from metagraph.common.budgets import TEXT_FILE
from metagraph.common.files import guard_reader, is_file, read_file
from metagraph.common.wording import phrase
from metagraph.engines import contract as c
from metagraph.engines.export_contacts import read_contact_rig, read_contacts
from metagraph.engines.export_parameters import read_parameters
from metagraph.engines.export_rig import read_rig, read_voices
from metagraph.engines.export_weight import read_weight
from metagraph.errors import FileError
from metagraph.formats.clips import digest
from metagraph.formats.project.data import decode_markov, decode_skeleton
from metagraph.formats.project.fields import DataError
from metagraph.formats.takes import REPAIRS
from metagraph.graph.face.rig import CHANNELS
from metagraph.graph.model import (
    LAYERS,
    PARTS,
    REACH,
    Action,
    BasePose,
    ClipEntry,
    Layer,
    Markov,
    MetaGraph,
    Part,
    Project,
    Settings,
    Stance,
    Timing,
)
from metagraph.graph.parameter import CharacterParameter
from metagraph.graph.requests import RequestError
from metagraph.graph.touch import Touch
from metagraph.motion.clip import Clip
from metagraph.motion.skeleton import Skeleton
from metagraph.playback.life.body import LIFELESS, Body
from metagraph.playback.planning.markov import DEFAULTS
from metagraph.playback.posing.rigs import ResolvedProject


@guard_reader
def read_export(path: str | Path, motions: bool = True, resolved: bool = False) -> Project:
    """Read an export back into a project with the same graph, ids and constants. motions: load the clips from
    its GLB. resolved: take gestures' phases, the base pose and the rig as the export has them, as a runtime
    does, instead of finding them again.

    Raises FileError naming the field that is wrong as a path into the JSON.
    """
    path = Path(path)
    document = _decoded(path)
    try:
        return _project(path, document, motions, resolved)
    except DataError as error:
        raise FileError(path, str(error), error.where, "Export it again.") from None


def find_export_glb(path: Path) -> Path:
    """Return the GLB of an export's JSON. Raises FileError as `read_export` and `find_glb_beside`."""
    return find_glb_beside(path, _decoded(path))


def _decoded(path: Path) -> c.Export:
    try:
        return msgspec.json.decode(read_file(path, TEXT_FILE), type=c.Export)
    except (msgspec.MsgspecError, RecursionError, UnicodeDecodeError) as error:
        cause, _, where = str(error).partition(" - at ")
        where = where.strip("`") or "$"
        remedy = "Update Metagraph, or export it again." if where == "$.metagraph" else "Export it again."
        raise FileError(path, cause[:1].lower() + cause[1:], where, remedy) from None


def _project(path: Path, document: c.Export, motions: bool, resolved: bool) -> Project:
    """Return the project of a decoded export. Raises DataError for what its types alone cannot say."""
    if missing := [layer for layer in LAYERS if layer not in document.layers]:
        raise DataError("$.layers", f"layer '{missing[0]}' is missing")
    if "/" in document.glb or "\\" in document.glb:
        raise DataError("$.glb", "should be the name of a file beside this one")
    skeleton = _skeleton(document.joints)
    clips = _clips(path, document, motions, skeleton, resolved)
    p = document.planner
    base = BasePose(document.base.clip, document.base.frame)
    rigs: dict[str, Any] = {}
    touch = document.touch
    if resolved:
        clips[BASE] = _base(document, skeleton)
        base = BasePose(BASE)
        rigs["body"] = _body(document.rig, skeleton) if document.rig is not None else LIFELESS
        rigs["weight"] = read_weight(document.weight_rig, document.clips, skeleton)
        rigs["vigours"] = {a.id: a.vigour for layer in document.layers.values() for a in layer.actions}
        touch = Touch(False, False)
        if document.contact_rig is not None:
            rigs["contact_rig"] = found = read_contact_rig(document.contact_rig, skeleton)
            touch = Touch(found.contacts, found.guard)
    graphs: dict[Layer, MetaGraph] = {
        layer: _graph(layer, document.layers[layer], resolved) for layer in LAYERS
    }
    return (ResolvedProject if resolved else Project)(
        **rigs,
        name=document.name,
        skeleton=skeleton,
        clips=clips,
        graphs=graphs,
        base=base,
        roles=dict(document.roles),
        parts=dict(document.parts),
        markov={  # what is reported is played; `own_markov` says that it was edited
            layer: model
            for layer in LAYERS
            if (model := _markov(layer, document.layers[layer].markov)) != DEFAULTS[layer]
            or document.layers[layer].own_markov
        },
        settings=Settings(
            p.alpha, p.seed, p.never_twice, p.shortest, p.wait, p.memory, p.rest, p.lookahead, p.variety
        ),
        life=document.life,
        touch=touch,
        face=document.face,
        points=dict(document.points),
        lines=dict(document.lines),
        performances=dict(document.performances),
        voices=read_voices(document.voices),
        parameters=_parameters(document),
    )


def _parameters(document: c.Export) -> dict[str, CharacterParameter]:
    try:
        return read_parameters(document.parameters)
    except (RequestError, msgspec.ValidationError) as error:
        raise DataError("$.parameters", str(error)) from None


def _clips(
    path: Path, document: c.Export, motions: bool, skeleton: Skeleton, resolved: bool
) -> dict[str, ClipEntry]:
    """Return the clips by id. motions: with what the GLB beside the JSON has of them. resolved: straight
    lines join their keys, as in runtimes, even the few of an old export. Raises DataError.
    """
    takes: list[Clip] = []
    if motions:
        from metagraph.formats.gltf.reader import read_gltf_clips

        takes = read_gltf_clips(find_glb_beside(path, document), REPAIRS)  # as other runtimes read it
    # Clips of one frame are read behind the longer ones.
    every = [x.animation for x in document.clips]
    longer = sorted(x.animation for x in document.clips if x.frames > 1) or every
    order = [*longer, *sorted(set(every).difference(longer))]
    clips: dict[str, ClipEntry] = {}
    for n, clip in enumerate(document.clips):
        if clip.id in clips:
            raise DataError(f"$.clips[{n}].id", f"'{clip.id}' is used twice")
        if motions and clip.animation >= len(takes):
            raise DataError(
                f"$.clips[{n}].animation", f"the GLB has {len(takes)} animations, no number {clip.animation}"
            )
        motion = takes[clip.animation] if motions else None
        if motion is not None and motion.skeleton.names == skeleton.names:
            motion = replace(motion, skeleton=skeleton)
        if motion is not None and resolved:
            motion = replace(motion, straight=True)
        clips[clip.id] = ClipEntry(
            clip.id,
            clip.name,
            document.glb,
            order.index(clip.animation),
            clip.sha256,
            clip.frames,
            clip.fps,
            motion,
            made_by=clip.made_by,
            made_seed=clip.made_seed,
        )
    return clips


def find_glb_beside(path: Path, document: c.Export) -> Path:
    """Return the GLB of an export's JSON. Raises FileError if it is not the one that the JSON was written
    with: an export that was interrupted, or files copied one by one, leave two that do not belong together.
    """
    glb = path.parent / document.glb
    if document.glb_sha256 is not None and is_file(glb) and digest(glb) != document.glb_sha256:
        raise FileError(
            glb,
            phrase("is not the GLB that {name} was written with", name=path.name),
            phrase("its content"),
            phrase("Export again, and copy both files."),
        )
    return glb


BASE = "base pose"  # id of a clip of one frame that stands for the exported base pose


def _base(document: c.Export, skeleton: Skeleton) -> ClipEntry:
    """Return a clip of the base pose as the export has it; that of the GLB's clip is rounded."""
    base, joints = document.base, len(skeleton)
    for field, rows in (("rotations", base.rotations), ("translations", base.translations)):
        if len(rows) != joints:
            raise DataError(f"$.base.{field}", f"should be {joints} rows, one for each joint")
    motion = Clip(
        BASE, skeleton, 30.0, np.array([base.rotations]), np.array([base.translations]), tuple(range(joints))
    )
    return ClipEntry(BASE, BASE, document.glb, 0, "", 1, 30.0, motion)


def _body(rig: c.Rig, skeleton: Skeleton) -> Body:
    """Return the body of an export's rig. Raises DataError if it does not fit the joints."""
    faces = {len(rig.face.joints)} | {len(row) for row in (*rig.face.turns, *rig.face.shifts)}
    joints = [
        *rig.chain,
        *rig.face.joints,
        *rig.face.lid_joints,
        *(s.joint for s in rig.shoulders),
        *(e.joint for e in rig.eyes),
    ]
    places = [rig.trunk, *(x.place for x in rig.lookers)]
    fits = (
        rig.chain
        and len(rig.breath) == len(rig.chain)
        and len(rig.bowed) in (0, len(rig.chain))
        and len(rig.thrust) in (0, len(rig.chain))
        and max(joints) < len(skeleton)
        and max(places) < len(rig.chain)
    )
    if not fits or len(faces) > 1 or {len(rig.face.turns), len(rig.face.shifts)} != {len(CHANNELS)}:
        raise DataError("$.rig", "does not fit the joints")
    return read_rig(rig)


def _skeleton(joints: list[c.Joint]) -> Skeleton:
    rows = [{"name": j.name, "parent": j.parent, "at": j.translation, "turn": j.rotation} for j in joints]
    try:
        found = decode_skeleton(rows, "$.joints")
    except DataError as error:
        where = error.where.replace(".at", ".translation").replace(".turn", ".rotation")
        raise DataError(where, str(error)) from None
    if found is None:
        raise DataError("$.joints", "should not be empty")
    return found


def _markov(layer: Layer, model: c.ExportedMarkov) -> Markov:
    if model.tags and len(model.tags) != len(model.states):
        raise DataError(
            f"$.layers.{layer}.markov.tags", f"should be {len(model.states)} texts, one for each state"
        )
    states = [
        f"{limb} {kind} {tag}".rstrip()
        for (limb, kind), tag in zip(model.states, model.tags or [""] * len(model.states), strict=True)
    ]
    more = {
        "gap": model.gap,
        "positive": model.positive,
        "negative": model.negative,
        "lengths": model.lengths,
        "modes": model.modes,
    }
    return decode_markov(
        layer, {"states": states, "matrix": model.matrix, **more}, f"$.layers.{layer}.markov"
    )


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
        timing = Timing(
            a.start,
            None if a.whole_end else a.end,
            a.blend_in,
            a.blend_out,
            a.loop,
            a.earliest_exit,
            stroke,
            own[0],
            own[1],
            own[2],
            0.0 if a.repeat is msgspec.UNSET else a.repeat,
        )
        actions[a.id] = Action(
            a.id,
            a.clip,
            a.kind,
            layer,
            a.stance,
            a.name,
            a.end_stance,
            timing,
            a.limb,
            tuple(a.joints),
            tuple(a.tags),
            a.likelihood,
            a.cooldown,
            a.spacing,
            read_contacts(a.contacts),
            tuple((joint, weight) for joint, weight in a.joint_weights.items() if weight < 1),
            prominence=a.prominence if resolved else a.own_prominence,
        )
    if unknown := [part for part in data.own_weights if part not in data.weights]:
        raise DataError(f"{where}.own_weights", f"weights say nothing of '{unknown[0]}'")
    return MetaGraph(layer, stances, actions, data.start, _weights(layer, data))


def _weights(layer: Layer, data: c.ExportedLayer) -> Mapping[Part, float]:
    """Return the weights of a layer that a project has to hold to play as the export says: those set by the
    user, and whatever is not the usual one. A part that is not listed is not moved.
    """
    told = {part: data.weights.get(part, 0.0) for part in PARTS}
    own = (*data.own_weights, *(part for part in PARTS if told[part] != REACH[layer][part]))
    return {part: told[part] for part in dict.fromkeys(own)}
