"""VRM animations (VRMC_vrm_animation 1.0): a file for each action, which any VRM avatar plays.

The nodes stand in a T, and the extension says which is which bone of the humanoid. Each expression has a node
whose x is the expression's weight, and where the eyes look is the rotation of the node `lookAt`.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from metagraph.common.file_names import make_file_stems
from metagraph.common.wording import phrase
from metagraph.engines.engine_machine import count_unrepeated, make_clip_as_played
from metagraph.engines.export_error import ExportError
from metagraph.engines.targets.losses import PERFORMANCES, PROPS
from metagraph.engines.targets.target import ExportedFiles, ExportOrder, ExportTarget, Loss
from metagraph.engines.targets.vrm import UNREPEATED, find_vrm_bones, find_vrm_pose
from metagraph.formats.atomic import write_atomically
from metagraph.formats.gltf.writer import ForEngine, write_glb
from metagraph.graph import anatomy
from metagraph.graph.face.expression_presets import make_presets, measure_presets
from metagraph.graph.model import Action, Project
from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.motion.skeleton import Pose, Skeleton

Array = NDArray[Any]

EXTENSION = "VRMC_vrm_animation"
_EYES = ("leftEye", "rightEye")  # these are moved by `lookAt` alone
_SEEN = 0.01  # of an expression, at least, or of a quaternion's part: less is nothing


def cut_action(project: Project, action: Action) -> Clip | None:
    """Return the part of its clip that an action plays, in a time that begins at 0. None without the clip's
    file.
    """
    entry = project.clips[action.clip]
    if entry.motion is None:
        return None
    if action.timing.repeat > 0 and len(project.uses[entry.id]) == 1:
        return make_clip_as_played(project, entry)
    motion = entry.motion.dense
    start, end = project.span(action)
    first, last = round(start * motion.fps), round(end * motion.fps)
    return motion.trimmed(first, min(motion.frames, max(last, first + 1) + 1))


def add_face(clip: Clip, bones: Mapping[str, int], stand: Pose) -> tuple[Clip, Pose, dict[str, Any]]:
    """Return a clip with a joint for each expression that it shows and one for where its eyes look, the pose
    in which the joints stand, and the extension's words about them.
    """
    names: list[str] = []
    places: list[Array] = []
    turns: list[Array] = []
    still = np.tile(rotation.IDENTITY, (clip.frames, 1))
    stated: dict[str, Any] = {}
    if clip.morphs and clip.weights is not None:
        weights = {name: clip.weights[:, n] for n, name in enumerate(clip.morphs)}
        presets: dict[str, Any] = {}
        for preset, values in measure_presets(make_presets(clip.morphs), weights).items():
            if float(np.max(values)) >= _SEEN:
                presets[preset] = {"node": len(clip.skeleton) + len(names)}
                names.append(f"expression {preset}")
                places.append(np.stack([values, 0 * values, 0 * values], axis=1))
                turns.append(still)
        if presets:
            stated["expressions"] = {"preset": presets}
    looks = _looks(clip, bones, stand)
    if looks is not None:
        stated["lookAt"] = {"node": len(clip.skeleton) + len(names), "offsetFromHeadBone": [0.0, 0.06, 0.0]}
        names.append("lookAt")
        places.append(np.zeros((clip.frames, 3)))
        turns.append(looks)
    if not names:
        return replace(clip, morphs=(), weights=None), stand, stated
    return _with_nodes(clip, names, places, turns), _with_still_nodes(stand, len(names)), stated


def _with_nodes(clip: Clip, names: list[str], places: list[Array], turns: list[Array]) -> Clip:
    """Return a clip without morph targets and with more joints, which have no parent."""
    old, count = clip.skeleton, len(names)
    skeleton = Skeleton(
        (*old.names, *_free_names(old.names, names)),
        np.concatenate([old.parents, np.full(count, -1)]),
        np.concatenate([old.rest_rotations, np.tile(rotation.IDENTITY, (count, 1))]),
        np.concatenate([old.rest_translations, np.zeros((count, 3))]),
    )
    return replace(
        clip,
        skeleton=skeleton,
        rotations=np.concatenate([clip.rotations, np.stack(turns, 1)], axis=1).astype(np.float32),
        translations=np.concatenate([clip.translations, np.stack(places, 1)], axis=1).astype(np.float32),
        translated=(*clip.translated, *range(len(old), len(old) + count)),
        morphs=(),
        weights=None,
    )


def _free_names(taken: tuple[str, ...], names: list[str]) -> list[str]:
    return [name if name not in taken else f"{name} (VRM)" for name in names]


def _with_still_nodes(pose: Pose, count: int) -> Pose:
    return Pose(
        np.concatenate([pose.rotations, np.tile(rotation.IDENTITY, (count, 1))]),
        np.concatenate([pose.translations, np.zeros((count, 3))]),
    )


def _looks(clip: Clip, bones: Mapping[str, int], stand: Pose) -> Array | None:
    """Return where the eyes look within the head, `[F, 4]` from the T-pose; None while they do not move."""
    if any(eye not in bones for eye in _EYES) or "head" not in bones:
        return None
    skeleton, head = clip.skeleton, bones["head"]
    standing, _ = skeleton.globals(stand)
    moved, _ = skeleton.globals(clip.poses())
    turned = []
    for eye in _EYES:
        joint = bones[eye]
        own = rotation.multiply(moved[:, joint], rotation.conjugate(standing[joint]))
        above = rotation.multiply(moved[:, head], rotation.conjugate(standing[head]))
        turned.append(rotation.multiply(rotation.conjugate(above), own))
    turned[1] = np.where((turned[0] * turned[1]).sum(-1, keepdims=True) < 0, -turned[1], turned[1])
    looks = rotation.normalize(turned[0] + turned[1])
    return looks if float(np.abs(looks[:, :3]).max()) >= _SEEN else None


def _write(order: ExportOrder) -> ExportedFiles:
    project, skeleton = order.project, order.project.skeleton
    assert skeleton is not None
    roles = anatomy.project_roles(project)
    stand = find_vrm_pose(skeleton, roles)
    bones = find_vrm_bones(skeleton, roles)
    stated = {bone: {"node": joint} for bone, joint in bones.items() if bone not in _EYES}
    actions = list(project.actions())
    made, listed = [], []
    for n, (action, stem) in enumerate(zip(actions, _name_files(project, actions), strict=True)):
        order.tell(n, len(actions), "clips")
        clip = cut_action(project, action)
        if clip is None:
            continue
        faced, pose, face = add_face(clip, bones, stand)
        said = {"specVersion": "1.0", "humanoid": {"humanBones": stated}, **face}
        path = order.folder / f"{stem}.vrma"
        write_glb(
            path, [faced.renamed(action.name)], engine=ForEngine(stand=pose, extensions={EXTENSION: said})
        )
        made.append(path)
        listed.append(_describe(project, action, path.name, clip.duration))
    if not made:
        raise ExportError(phrase("there is no action whose clip could be read"))
    index = order.folder / f"{order.stem}.animations.json"
    write_atomically(index, msgspec.json.format(msgspec.json.encode(listed)) + b"\n")
    order.tell(len(actions), len(actions), "done")
    return ExportedFiles((*made, index))


def _name_files(project: Project, actions: Sequence[Action]) -> list[str]:
    """Return the name of each action's file: the action's own, with its stance if another is called so."""
    count = Counter(action.name for action in actions)
    return make_file_stems(
        f"{action.name} ({_name_stance(project, action.stance)})" if count[action.name] > 1 else action.name
        for action in actions
    )


def _name_stance(project: Project, ident: str | None) -> str:
    stance = project.stance(ident or "")
    return stance.name if stance is not None else ""


def _describe(project: Project, action: Action, file: str, seconds: float) -> dict[str, Any]:
    """Return what the list of the files says about one: what it is, and from where it leads where."""
    return {
        "file": file,
        "action": action.name,
        "kind": action.kind,
        "layer": action.layer,
        "stance": _name_stance(project, action.stance),
        **({"end_stance": _name_stance(project, action.end_stance)} if action.end_stance else {}),
        "seconds": round(seconds, 3),
        **({"tags": list(action.tags)} if action.tags else {}),
    }


TARGETS = (
    ExportTarget(
        "vrma",
        phrase("VRM animations"),
        phrase("a VRM animation (.vrma) for each action, which any VRM avatar can play"),
        _write,
        (
            Loss(phrase("no meta-graph: the avatar's program chooses which file it plays")),
            Loss(phrase("no blends: an action begins and ends in its stance, and the program blends")),
            Loss(phrase("no life layers: the avatar's program does breathing, gaze, blinks and lip sync")),
            Loss(UNREPEATED, count_unrepeated),
            PERFORMANCES,
            PROPS,
        ),
    ),
)
