# SPDX-License-Identifier: GPL-3.0-or-later
"""An export as Blender's data: armature, mesh, an action for each action of the graph, stances as NLA tracks;
and the way back.
"""

from __future__ import annotations

import hashlib
import json
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import bpy
import numpy as np

from . import labels
from .glb import Take, glb
from .space import Figure, continuous

JOINTS, STANCES, SOURCE = "metagraph_joints", "metagraph_stances", "metagraph_export"
_GAP = 10  # frames between two strips of a track


# --- in


def load(context: Any, path: Path) -> Any:
    """Read an export into the scene; return its armature. Raises ValueError."""
    document = labels.read_export(path)
    model = path.with_name(document["glb"])
    if not model.is_file():
        raise ValueError(f"{model.name} is missing: it belongs beside {path.name}")
    if document.get("glb_bytes") not in (None, model.stat().st_size):
        raise ValueError(f"{model.name} does not belong to {path.name}: export again, and copy both files")
    rates = Counter(clip["fps"] for clip in document["clips"]) or Counter([30.0])
    set_rate(context.scene, rates.most_common(1)[0][0])
    known = set(bpy.data.objects), set(bpy.data.actions)
    bpy.ops.import_scene.gltf(filepath=str(model), bone_heuristic="TEMPERANCE", disable_bone_shape=True)
    armature = next((o for o in bpy.data.objects if o not in known[0] and o.type == "ARMATURE"), None)
    if armature is None:
        raise ValueError(f"{model.name} has no skeleton that Blender reads")
    figure = Figure(document["joints"])
    lost = [name for name in figure.names if name not in armature.data.bones]
    if lost:
        raise ValueError(f"Blender reads no bones for {', '.join(lost[:5])}: rename these joints first")
    armature.name = document.get("name") or "Metagraph"
    armature[JOINTS] = json.dumps(
        [{k: joint[k] for k in ("name", "parent", "rotation", "translation")} for joint in document["joints"]]
    )
    armature[STANCES] = json.dumps(labels.stances_of(document))
    armature[SOURCE] = str(path)
    came = {action.name: action for action in bpy.data.actions if action not in known[1]}
    _clear(armature)
    _complete(list(came.values()))
    _label(document, came)
    _tracks(document, armature)
    return armature


def set_rate(scene: Any, fps: float) -> None:
    """Let the scene's frames be the clips'."""
    scene.render.fps = max(1, round(fps))
    scene.render.fps_base = scene.render.fps / fps


def rate(scene: Any) -> float:
    """Return the scene's frames a second."""
    return float(scene.render.fps / scene.render.fps_base)


def _clear(armature: Any) -> None:
    """Take away the tracks that the glTF importer makes, one for each clip."""
    for owner in (armature, *_keys_of(armature)):
        if owner.animation_data is not None:
            while owner.animation_data.nla_tracks:
                owner.animation_data.nla_tracks.remove(owner.animation_data.nla_tracks[0])


def meshes_of(armature: Any) -> list[Any]:
    """Return the meshes that an armature moves."""
    return [
        o
        for o in bpy.data.objects
        if o.type == "MESH"
        and (o.parent == armature or any(m.type == "ARMATURE" and m.object == armature for m in o.modifiers))
    ]


def _keys_of(armature: Any) -> list[Any]:
    return [o.data.shape_keys for o in meshes_of(armature) if o.data.shape_keys is not None]


def _complete(actions: list[Any]) -> None:
    """Key bones at rest in actions that leave them out, where another moves them: Blender would leave them as
    the action before had them.
    """
    moved = {(c.data_path, c.array_index) for a in actions for c in curves(a) if "bones" in c.data_path}
    for action in actions:
        bags = [bag for bag in _bags(action) if any("bones" in c.data_path for c in bag.fcurves)]
        if not bags:
            continue
        start = action.frame_range[0]
        for path, index in sorted(moved - {(c.data_path, c.array_index) for c in bags[0].fcurves}):
            curve = bags[0].fcurves.new(path, index=index)
            one = path.endswith("scale") or (path.endswith("rotation_quaternion") and index == 0)
            curve.keyframe_points.insert(start, float(one))


def _label(document: dict[str, Any], came: dict[str, Any]) -> None:
    """Put what the export says onto the actions, a copy for each use of a clip beyond the first."""
    seen: set[str] = set()
    rates = {clip["name"]: clip["fps"] for clip in document["clips"]}
    for name, action in came.items():
        action.use_fake_user = True  # else what no strip plays is lost on saving
        action.metagraph.clip, action.metagraph.fps = name, rates.get(name, 0.0)
        action.metagraph.digest = digest(action)
    for label in labels.labels_of(document):
        action = came.get(label["clip"])
        if action is None:
            continue
        if label["clip"] in seen:
            fps, own = action.metagraph.fps, action.metagraph.digest
            action = action.copy()
            action.use_fake_user = True
            action.metagraph.clip, action.metagraph.fps, action.metagraph.digest = label["clip"], fps, own
        seen.add(label["clip"])
        put(action, label)
        action.metagraph.before = json.dumps(label)


def put(action: Any, label: dict[str, Any]) -> None:
    """Write a label into an action's properties."""
    to = action.metagraph
    to.labelled = True
    for key in (*labels.TEXTS, *labels.NUMBERS, "loop"):
        setattr(to, key, label[key])
    for key in labels.MAYBE:
        setattr(to, key, -1.0 if label[key] is None else label[key])
    to.tags, to.joints = ", ".join(label["tags"]), ", ".join(label.get("joints", ()))


def label(action: Any) -> dict[str, Any]:
    """Return the label in an action's properties."""
    own = action.metagraph
    out: dict[str, Any] = {key: getattr(own, key) for key in (*labels.TEXTS, "loop")}
    out |= {key: round(getattr(own, key), 6) for key in labels.NUMBERS}
    out |= {key: None if getattr(own, key) < 0 else round(getattr(own, key), 6) for key in labels.MAYBE}
    if out["kind"] != "transition":
        out["end_stance"] = ""
    return out | {"tags": labels.split_tags(own.tags)}


def before(action: Any) -> dict[str, Any] | None:
    """Return what an action's label was when it was imported."""
    return json.loads(action.metagraph.before) if action.metagraph.before else None


def _tracks(document: dict[str, Any], armature: Any) -> None:
    """Lay each stance's actions one after the other on a muted track, and let the first loop play."""
    armature.animation_data_create()
    at: dict[tuple[str, str], Any] = {}
    body = document["layers"].get("body", {})
    start = next((s["name"] for s in body.get("stances", ()) if s["id"] == body.get("start")), None)
    first = None
    placed = [a for a in bpy.data.actions if a.metagraph.labelled and a.metagraph.before]
    for action in sorted(placed, key=lambda a: labels.KINDS.index(a.metagraph.kind)):
        own = action.metagraph
        if own.kind == "stance" and own.layer == "body" and (first is None or own.stance == start):
            first = action
        track = at.get((own.layer, own.stance))
        if track is None:
            track = at[own.layer, own.stance] = armature.animation_data.nla_tracks.new()
            track.name, track.mute = f"{own.layer}: {own.stance}", True
        begin = max((s.frame_end for s in track.strips), default=-_GAP) + _GAP
        strip = track.strips.new(action.name, round(begin), action)
        strip.name = own.name
    if first is not None:
        play(armature, first)


def play(armature: Any, action: Any) -> None:
    """Let the armature, and the face that goes with it, show an action."""
    for owner in (armature, *_keys_of(armature)):
        data = owner.animation_data or owner.animation_data_create()
        if owner is not armature and not hasattr(data, "action_slot"):
            continue  # before 4.4 an action is of one thing alone
        data.action = action
        if hasattr(data, "action_slot") and data.action_slot is None and action is not None:
            fit = [slot for slot in action.slots if slot.target_id_type == owner.id_type]
            if fit:
                data.action_slot = fit[0]
            elif owner is not armature:
                data.action = None


def _bags(action: Any) -> Iterator[Any]:
    """Yield what holds an action's curves, in Blender 4 and 5."""
    if hasattr(action, "layers") and action.layers:
        for layer in action.layers:
            for strip in layer.strips:
                yield from strip.channelbags
    elif hasattr(action, "fcurves"):
        yield action


def curves(action: Any) -> Iterator[Any]:
    """Yield an action's curves."""
    for bag in _bags(action):
        yield from bag.fcurves


def digest(action: Any) -> str:
    """Return what tells whether an action's keys are what they were."""
    out = hashlib.sha1()
    for curve in sorted(curves(action), key=lambda c: (c.data_path, c.array_index)):
        values = np.zeros(2 * len(curve.keyframe_points), np.float32)
        curve.keyframe_points.foreach_get("co", values)
        out.update(f"{curve.data_path}{curve.array_index}".encode() + np.round(values, 5).tobytes())
    return out.hexdigest()


# --- out


def figure_of(armature: Any) -> Figure:
    """Return the joints that an armature was made of. Raises ValueError."""
    if armature is None or JOINTS not in armature:
        raise ValueError("choose the armature of an imported export first")
    return Figure(json.loads(armature[JOINTS]))


def corrections(armature: Any, figure: Figure) -> Any:
    """Return how bones differ from joints at rest, `[J, 4]`."""
    rest = [armature.data.bones[name].matrix_local.to_quaternion() for name in figure.names]
    return figure.corrections(np.array([[q.x, q.y, q.z, q.w] for q in rest]))


def take_of(context: Any, armature: Any, action: Any, name: str) -> Take:
    """Return an action as it moves the armature, constraints and all, at its clip's rate. The scene is as it
    was afterwards.
    """
    figure, scene = figure_of(armature), context.scene
    own, fps = corrections(armature, figure), action.metagraph.fps or rate(scene)
    start, end = action.frame_range
    count = max(1, round((end - start) / rate(scene) * fps) + 1)
    keys = _keys_of(armature)
    shown, frame = armature.animation_data and armature.animation_data.action, scene.frame_current_final
    muted = {t: t.mute for o in (armature, *keys) if o.animation_data for t in o.animation_data.nla_tracks}
    turns, places = np.zeros((count, len(figure.names), 4)), np.zeros((count, len(figure.names), 3))
    morphs = tuple(dict.fromkeys(b.name for k in keys for b in k.key_blocks[1:]))
    weights = np.zeros((count, len(morphs)))
    bones = [armature.pose.bones[name] for name in figure.names]
    for track in muted:
        track.mute = True
    for bone in bones:
        bone.matrix_basis.identity()  # what an action does not move stands still
    for block in (b for k in keys for b in k.key_blocks[1:]):
        block.value = 0.0
    play(armature, action)
    try:
        for n in range(count):
            at = start + n / fps * rate(scene)
            scene.frame_set(int(np.floor(at)), subframe=float(at - np.floor(at)))
            for j, bone in enumerate(bones):
                q = bone.matrix.to_quaternion()
                turns[n, j], places[n, j] = (q.x, q.y, q.z, q.w), bone.matrix.translation
            for k in keys:
                for block in k.key_blocks[1:]:
                    weights[n, morphs.index(block.name)] = block.value
    finally:
        play(armature, shown or None)
        for track, mute in muted.items():
            track.mute = mute
        scene.frame_set(int(np.floor(frame)), subframe=float(frame - np.floor(frame)))
    rotations, translations = figure.from_bones(own, turns, places)
    moving = np.flatnonzero((np.abs(weights) > 1e-6).any(0))
    return Take(
        name,
        fps,
        continuous(rotations),
        translations,
        tuple(morphs[m] for m in moving),
        weights[:, moving] if len(moving) else None,
    )


def send(context: Any, armature: Any, folder: Path, everything: bool = False) -> tuple[list[Path], list[str]]:
    """Write the clips and labels that are new or changed, all where `everything`; return the files, and what
    there is to say. Raises ValueError.
    """
    figure = figure_of(armature)
    rows, takes, notes = [], [], []
    for action in bpy.data.actions:
        if not action.metagraph.labelled:
            continue
        now, was = label(action), before(action)
        moved = everything or was is None or digest(action) != action.metagraph.digest
        start, end = action.frame_range
        wrong = labels.faults(now, (end - start) / rate(context.scene))
        if wrong:
            notes.append(f"{action.name} is left out: {'; '.join(wrong)}")
            continue
        if not (moved or labels.changed(was or {}, now)):
            continue
        if moved:
            takes.append(take_of(context, armature, action, action.name))
        rows.append(labels.row_of(action.name if moved else action.metagraph.clip, was, now))
    if not rows:
        return [], [*notes, "nothing is new or changed"]
    folder.mkdir(parents=True, exist_ok=True)
    stem = labels.free_path(folder, "blender", (".glb", ".labels.json"))
    files = [stem.with_name(f"{stem.name}.labels.json")]
    files[0].write_text(labels.label_file(rows), encoding="utf-8")
    if takes:
        files.insert(0, stem.with_name(f"{stem.name}.glb"))
        files[0].write_bytes(glb(figure, takes))
    return files, notes


def command(files: list[Path]) -> str:
    """Return the line that takes files into a project."""
    clips = " ".join(f'"{path}"' for path in files if path.suffix == ".glb")
    return f'metagraph import PROJECT {clips}{" " if clips else ""}--labels "{files[-1]}"'


# --- live


def show(armature: Any, figure: Figure, own: Any, joints: list[str], morphs: list[str], pose: Any) -> None:
    """Stand the armature in a pose of a live session. own: its corrections."""
    rotations, translations = figure.rest_rotations.copy(), figure.rest_translations.copy()
    place = {name: n for n, name in enumerate(figure.names)}
    for name, value in zip(joints, pose["rotations"], strict=False):
        if name in place:
            rotations[place[name]] = value
    translations[0] = pose["root"]
    turns, moves = figure.to_bones(own, rotations, translations)
    for n, name in enumerate(figure.names):
        bone = armature.pose.bones[name]
        bone.rotation_mode = "QUATERNION"
        x, y, z, w = turns[n]
        bone.rotation_quaternion = (w, x, y, z)
        bone.location = moves[n]
    weights = pose.get("weights") or {}
    for keys in _keys_of(armature):
        for name in morphs:
            block = keys.key_blocks.get(name)
            if block is not None:
                block.value = weights.get(name, 0.0)
