"""What Unity needs to carry a character's poses over to any humanoid avatar: its bones, and its T pose."""

from __future__ import annotations

import re

import msgspec
import numpy as np

from metagraph.engines.export_error import ExportError
from metagraph.engines.targets.vrm import find_vrm_bones, find_vrm_pose
from metagraph.graph import anatomy
from metagraph.graph.model import Project

THUMB = {"Metacarpal": "Proximal", "Proximal": "Intermediate", "Distal": "Distal"}
FINGER = re.compile(r"(left|right)(Thumb|Index|Middle|Ring|Little)(Metacarpal|Proximal|Intermediate|Distal)")


def spell_human_bone(bone: str) -> str:
    """Return what Unity calls one of VRM's bones: `Left Index Proximal`."""
    found = FINGER.fullmatch(bone)
    if found is None:
        return bone[0].upper() + bone[1:]
    side, finger, part = found.groups()
    return f"{side.capitalize()} {finger} {THUMB[part] if finger == 'Thumb' else part}"


def write_humanoid(project: Project) -> bytes | None:
    """Return bones and T pose of a project's figure as JSON; None if it is not a humanoid that faces +Z."""
    skeleton = project.skeleton
    assert skeleton is not None
    roles = anatomy.project_roles(project)
    try:
        stand = find_vrm_pose(skeleton, roles)
    except ExportError:
        return None
    bones = find_vrm_bones(skeleton, roles)
    made = {
        "bones": {spell_human_bone(bone): skeleton.names[joint] for bone, joint in bones.items()},
        "rotations": np.round(np.asarray(stand.rotations, float), 6).ravel().tolist(),
        "translations": np.round(np.asarray(stand.translations, float), 6).ravel().tolist(),
    }
    return msgspec.json.encode(made)
