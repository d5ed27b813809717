"""VRM 1.0: the character as an avatar that programs for avatars load, with the clips as glTF's animations.

The nodes stand in a T, as VRM asks for; the skin stays bound to the rest pose, so the mesh is not touched
and clips, whose rotations are local and whole, need no change. What may be done with it is written as it
stands in `vrm_meta.json` beside the project (VRM's own names, `meta`); without, as little as VRM knows.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import msgspec
import numpy as np

from metagraph.common.files import read_file
from metagraph.common.wording import phrase, plural_phrase
from metagraph.engines.engine_machine import count_unrepeated, make_clip_as_played
from metagraph.engines.export_error import ExportError
from metagraph.engines.targets.losses import PERFORMANCES, PROPS
from metagraph.engines.targets.meshes import find_ordered_mesh
from metagraph.engines.targets.target import ExportedFiles, ExportOrder, ExportTarget, Loss
from metagraph.engines.targets.vrm_springs import EXTENSION as SPRINGS
from metagraph.engines.targets.vrm_springs import read_spring_bones
from metagraph.errors import FileError
from metagraph.formats.gltf.writer import ForEngine, write_glb
from metagraph.graph import anatomy
from metagraph.graph.face.curves import fit_curves_to_face
from metagraph.graph.face.expression_presets import make_presets
from metagraph.graph.face.rig import find_body_axes
from metagraph.graph.model import Project
from metagraph.motion.joint_map import find_known_roles
from metagraph.motion.roles import REQUIRED
from metagraph.motion.skeleton import Pose, Skeleton, make_names_unique
from metagraph.motion.t_pose import make_t_pose

META = "vrm_meta.json"
LICENCE = "https://vrm.dev/licenses/1.0/"
_LARGEST = 1 << 20
# What VRM's `meta` may hold: texts, lists of texts, truth values, and words to choose from.
_TEXTS = ("name", "version", "copyrightInformation", "contactInformation", "thirdPartyLicenses",
          "otherLicenseUrl")  # fmt: skip
_LISTS = ("authors", "references")
_FLAGS = (
    "allowExcessivelyViolentUsage", "allowExcessivelySexualUsage", "allowPoliticalOrReligiousUsage",
    "allowAntisocialOrHateUsage", "allowRedistribution",
)  # fmt: skip
_WORDS = {
    "avatarPermission": ("onlyAuthor", "onlySeparatelyLicensedPerson", "everyone"),
    "commercialUsage": ("personalNonProfit", "personalProfit", "corporation"),
    "creditNotation": ("required", "unnecessary"),
    "modification": ("prohibited", "allowModification", "allowModificationRedistribution"),
}
_FINGER = {"thumb": ("Metacarpal", "Proximal", "Distal")}
_USUAL = ("Proximal", "Intermediate", "Distal")
# Degrees an eye turns for one that looks aside by 90, as life turns them at most.
_EYE_REACH = 30.0


def find_vrm_bones(skeleton: Skeleton, roles: Mapping[str, int]) -> dict[str, int]:
    """Return VRM's bone -> joint. A bone without the one VRM wants above it is left out."""
    out: dict[str, int] = {}
    for role, joint in find_known_roles(skeleton, roles).items():
        parts = role.split("_")
        if len(parts) == 3 and parts[2].isdigit():
            side, finger, number = parts
            if int(number) <= 3:
                out[f"{side}{finger.capitalize()}{_FINGER.get(finger, _USUAL)[int(number) - 1]}"] = joint
        elif "lid" not in parts:
            out[parts[0] + "".join(p.capitalize() for p in parts[1:])] = joint
    if "chest" not in out:
        out.pop("upperChest", None)
    for side in ("left", "right"):
        for finger in ("Thumb", "Index", "Middle", "Ring", "Little"):
            names = [f"{side}{finger}{part}" for part in _FINGER.get(finger.lower(), _USUAL)]
            if not all(name in out for name in names):
                for name in names:
                    out.pop(name, None)
    known = {
        *(r.split("_")[0] + "".join(p.capitalize() for p in r.split("_")[1:]) for r in _BONES),
        *(n for n in out if n.endswith(("Metacarpal", *_USUAL))),
    }
    return {bone: joint for bone, joint in out.items() if bone in known}


_BONES = (
    "hips", "spine", "chest", "upper_chest", "neck", "head", "jaw",
    *(f"{s}_{r}" for s in ("left", "right") for r in (
        "eye", "shoulder", "upper_arm", "lower_arm", "hand", "upper_leg", "lower_leg", "foot", "toes")),
)  # fmt: skip


def meta_of(project: Project, folder: Path | None) -> tuple[dict[str, Any], bool]:
    """Return VRM's `meta`, and whether anybody said what may be done. Raises FileError."""
    meta: dict[str, Any] = {"name": project.name or "character", "authors": ["unknown"]}
    usual = {word: choices[0] for word, choices in _WORDS.items()} | dict.fromkeys(_FLAGS, False)
    path = folder / META if folder is not None else None
    if path is None or not path.is_file():
        return {**meta, **usual, "licenseUrl": LICENCE}, False
    try:
        said = msgspec.json.decode(read_file(path, _LARGEST), type=dict[str, Any])
    except msgspec.MsgspecError as error:
        raise FileError(
            path,
            phrase("the file is not a JSON object ({error})", error=error),
            phrase("its content"),
            _remedy(),
        ) from None
    for key, value in said.items():
        fits = (
            (key in _TEXTS and isinstance(value, str))
            or (key in _LISTS and isinstance(value, list) and all(isinstance(v, str) and v for v in value))
            or (key in _FLAGS and isinstance(value, bool))
            or (key in _WORDS and value in _WORDS[key])
        )
        if not fits or (key == "authors" and not value):
            allowed = f"one of {', '.join(_WORDS[key])}" if key in _WORDS else "known to VRM"
            raise FileError(
                path,
                phrase("the value is not {allowed}", allowed=allowed),
                phrase("field '{key}'", key=key),
                _remedy(),
            )
    return {**meta, **usual, **said, "licenseUrl": LICENCE}, True


def _remedy() -> str:
    fields = (*_TEXTS, *_LISTS, *_WORDS, *_FLAGS)
    return f"Its fields are VRM 1.0's: {', '.join(fields)}."


def make_vrm_extension(
    project: Project, bones: Mapping[str, int], targets: tuple[str, ...], mesh: int, meta: dict[str, Any]
) -> dict[str, Any]:
    """Return `VRMC_vrm`. targets: the mesh's; mesh: its node."""
    presets: dict[str, Any] = {}
    for name, mix in make_presets(targets, project.face.channels).items():
        binds = [{"node": mesh, "index": targets.index(t), "weight": w} for t, w in mix.items()]
        presets[name] = {"morphTargetBinds": binds, "isBinary": False}
        presets[name] |= dict.fromkeys(("overrideBlink", "overrideLookAt", "overrideMouth"), "none")
    out: dict[str, Any] = {
        "specVersion": "1.0",
        "meta": meta,
        "humanoid": {"humanBones": {bone: {"node": joint} for bone, joint in bones.items()}},
        "firstPerson": {"meshAnnotations": [{"node": mesh, "type": "auto"}]},
    }
    if presets:
        out["expressions"] = {"preset": presets}
    eyes = [bones[b] for b in ("leftEye", "rightEye") if b in bones]
    if len(eyes) == 2 or "lookUp" in presets:
        ranges = {"inputMaxValue": 90.0, "outputScale": _EYE_REACH if eyes else 1.0}
        out["lookAt"] = {
            "type": "bone" if len(eyes) == 2 else "expression",
            "offsetFromHeadBone": _between_eyes(project, bones, eyes),
            **{
                f"rangeMap{way}": ranges
                for way in ("HorizontalInner", "HorizontalOuter", "VerticalDown", "VerticalUp")
            },
        }
    return out


def _between_eyes(project: Project, bones: Mapping[str, int], eyes: list[int]) -> list[float]:
    if len(eyes) < 2 or project.skeleton is None:
        return [0.0, 0.06, 0.0]
    _, at = project.skeleton.globals(project.skeleton.rest)
    return [round(float(x), 6) for x in at[eyes].mean(0) - at[bones["head"]]]


def find_vrm_pose(skeleton: Skeleton, roles: Mapping[str, int]) -> Pose:
    """Return the T in which VRM wants a humanoid to stand, on its feet. Raises ExportError for one without
    the bones that VRM needs, or that does not face +Z.
    """
    lacking = [role for role in REQUIRED if role not in roles]
    if lacking:
        raise ExportError(
            phrase(
                "VRM needs a humanoid: no joint was found for {names}. Assign the joints in 'Skeleton'",
                names=", ".join(lacking[:3]),
            )
        )
    _, at = skeleton.globals(skeleton.rest)
    axes = find_body_axes(skeleton, roles, at)
    if axes[2] @ [0, 0, 1] < 0.95:
        raise ExportError(phrase("a VRM character must face +Z in its rest pose, and this one does not"))
    return _grounded(make_t_pose(skeleton, roles, axes[0]), skeleton, roles)


def _write(order: ExportOrder) -> ExportedFiles:
    project, skeleton = order.project, order.project.skeleton
    assert skeleton is not None
    roles = anatomy.project_roles(project)
    stand = find_vrm_pose(skeleton, roles)
    body, notes = find_ordered_mesh(order)
    if body is None:
        raise ExportError(
            phrase("VRM needs a character: choose a mesh that fits the clips, then export again")
        )
    order.tell(0, 2, "clips")
    bones = find_vrm_bones(skeleton, roles)
    meta, said = meta_of(project, order.contents.base)
    mesh = len(skeleton) + (sum(int(p) < 0 for p in skeleton.parents) > 1)
    used = [project.clips[c] for c in project.uses if c in project.clips]
    played = [make_clip_as_played(project, entry) for entry in used]
    clips = [fit_curves_to_face(project, motion) for motion in played if motion is not None]
    names = make_names_unique([clip.name for clip in clips])
    path = order.folder / f"{order.stem}.vrm"
    extensions = {"VRMC_vrm": make_vrm_extension(project, bones, body.morphs, mesh, meta)}
    source = order.contents.character
    if isinstance(source, Path):
        springs, lost = read_spring_bones(source, skeleton)
        if springs is not None:
            extensions[SPRINGS] = springs
        if lost:
            notes = (
                *notes,
                plural_phrase(
                    "{count} joint of the spring bones is left out: the skeleton of the clips lacks it",
                    "{count} joints of the spring bones are left out: the skeleton of the clips lacks them",
                    lost,
                ),
            )
    write_glb(
        path,
        [replace(c.renamed(n), skeleton=skeleton) for c, n in zip(clips, names, strict=True)],
        body,
        engine=ForEngine(
            stand=stand,
            extensions=extensions,
        ),
    )
    order.tell(2, 2, "done")
    if not said:
        notes = (*notes, f"nobody said what may be done with it: the strictest terms stand in it ({META})")
    return ExportedFiles((path,), notes)


def _grounded(pose: Pose, skeleton: Skeleton, roles: Mapping[str, int]) -> Pose:
    """Return the pose with its feet as high as they are at rest."""
    feet = [roles["left_foot"], roles["right_foot"]]
    _, was = skeleton.globals(skeleton.rest)
    _, now = skeleton.globals(pose)
    translations = np.array(pose.translations)
    translations[0, 1] += float((was[feet, 1] - now[feet, 1]).mean())
    return Pose(pose.rotations, translations)


UNREPEATED = plural_phrase(
    "{count} clip that an action repeats plays once: other actions use it, too",
    "{count} clips that an action repeats play once: other actions use them, too",
    0,
)
TARGETS = (
    ExportTarget(
        "vrm",
        phrase("VRM 1.0 avatar"),
        phrase(
            "a VRM file: the character in T-pose, its bones, expressions and licence, and the "
            "clips as animations"
        ),
        _write,
        (
            Loss(phrase("no meta-graph: the avatar's program moves it and finds the clips by name")),
            Loss(phrase("no life layers: the avatar's program does breathing, gaze, blinks and lip sync")),
            Loss(UNREPEATED, count_unrepeated),
            PERFORMANCES,
            PROPS,
        ),
    ),
)
