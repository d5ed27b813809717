"""Humanoids for the web element, made of a sample character: its joints renamed as other programs name them,
in another rest pose, unit, size and direction.
"""

from __future__ import annotations

import json
import struct
from pathlib import Path
from typing import Any

import numpy as np

from metagraph.engines.targets.vrm import find_vrm_bones
from metagraph.formats.gltf.reader import read_character
from metagraph.motion import rotation
from metagraph.motion.joint_map import find_known_roles
from metagraph.motion.skeleton import Pose, Skeleton
from metagraph.motion.t_pose import make_t_pose

SAMPLES = Path(__file__).parents[2] / "sample_clips"
_FINGERS = ("thumb", "index", "middle", "ring", "little")
_PLAIN = ("shoulder", "upper_arm", "lower_arm", "hand", "upper_leg", "lower_leg", "foot", "toes", "eye")
_TRUNK = ("hips", "spine", "chest", "upper_chest", "neck", "head")
# Families of names: the trunk, the parts of a limb, and how a side, a part and a finger become a name.
FAMILIES: dict[str, tuple[tuple[str, ...], tuple[str, ...], str, str]] = {
    "mixamo": (
        tuple(f"mixamorig:{n}" for n in ("Hips", "Spine", "Spine1", "Spine2", "Neck", "Head")),
        ("Shoulder", "Arm", "ForeArm", "Hand", "UpLeg", "Leg", "Foot", "ToeBase", "Eye"),
        "mixamorig:{Side}{part}",
        "mixamorig:{Side}Hand{Finger}{n}",
    ),
    "unreal": (
        ("pelvis", "spine_01", "spine_02", "spine_03", "neck_01", "head"),
        ("clavicle", "upperarm", "lowerarm", "hand", "thigh", "calf", "foot", "ball", "eye"),
        "{part}_{s}",
        "{finger}_0{n}_{s}",
    ),
    "rigify": (
        ("spine", "spine.001", "spine.002", "spine.003", "spine.004", "spine.006"),
        ("shoulder", "upper_arm", "forearm", "hand", "thigh", "shin", "foot", "toe", "eye"),
        "{part}.{S}",
        "f_{finger}.0{n}.{S}",
    ),
    "biped": (
        tuple(f"Bip01 {n}" for n in ("Pelvis", "Spine", "Spine1", "Spine2", "Neck", "Head")),
        ("Clavicle", "UpperArm", "Forearm", "Hand", "Thigh", "Calf", "Foot", "Toe0", "Eye"),
        "Bip01 {S} {part}",
        "Bip01 {S} Finger{k}{m}",
    ),
    "vroid": (
        tuple(f"J_Bip_C_{n}" for n in ("Hips", "Spine", "Chest", "UpperChest", "Neck", "Head")),
        ("Shoulder", "UpperArm", "LowerArm", "Hand", "UpperLeg", "LowerLeg", "Foot", "ToeBase", "FaceEye"),
        "J_Bip_{S}_{part}",
        "J_Bip_{S}_{Finger}{n}",
    ),
}


def name_in_family(family: str, role: str) -> str | None:
    """Return what a family calls the joint of a role; None for one that it does not know."""
    trunk, parts, limb, finger = FAMILIES[family]
    if role in _TRUNK:
        return trunk[_TRUNK.index(role)]
    side, _, part = role.partition("_")
    words: dict[str, Any] = {"Side": side.capitalize(), "S": side[0].upper(), "s": side[0]}
    if part in _PLAIN:
        return limb.format(part=parts[_PLAIN.index(part)], **words)
    if part[:-2] not in _FINGERS:
        return None
    bare = "pinky" if part.startswith("little") and family in ("mixamo", "unreal", "rigify") else part[:-2]
    number = int(part[-1])
    words |= {"finger": bare, "Finger": bare.capitalize(), "n": number, "k": _FINGERS.index(part[:-2])}
    return finger.format(m=number - 1 or "", **words).replace("f_thumb", "thumb")


def make_avatar(
    path: Path,
    family: str = "mixamo",
    *,
    source: Path = SAMPLES / "ben.glb",
    unit: float = 1.0,
    tall: float = 1.0,
    legs: float = 1.0,
    turned: bool = False,
    shrunk: bool = False,
    vrm: int | None = None,
    loose: tuple[str, ...] = (),
    bare: bool = False,
) -> Path:
    """Write a sample character as another program would: in a T, with joints that are turned as that program
    turns its own.

    unit: metres to the file's. tall: of all. legs: of the bones below the hips alone. turned: half a turn, to
    face -Z. shrunk: a node above makes the file's unit metres. vrm: 0 or 1, its humanoid in the way of that
    version, and joints without a meaning in their names. loose: roles whose joints hang on nothing, as in
    rigs with IK. bare: without pictures, which Node cannot decode.
    """
    skeleton = read_character(source).skeleton
    roles = find_known_roles(skeleton, None)
    document, data = _read(source)
    joints = document["skins"][0]["joints"]
    assert [document["nodes"][j]["name"] for j in joints] == list(skeleton.names)
    stand = make_t_pose(skeleton, roles, np.array([1.0, 0, 0]))
    below = {j for r in ("left_lower_leg", "right_lower_leg", "left_foot", "right_foot") for j in [roles[r]]}
    grown = np.array(stand.translations) * tall
    for joint in below:
        grown[joint] *= legs
    pose = Pose(stand.rotations, grown)
    _, places = skeleton.globals(pose)
    low = places[[roles["left_foot"], roles["right_foot"]], 1].mean()
    grown[roles["hips"], 1] += 0.08 * tall - low
    turns, places = skeleton.globals(pose)
    rng = np.random.default_rng(5)
    frames = rotation.normalize(rng.normal(size=(len(skeleton), 4)))
    own = rotation.multiply(turns, frames)
    parents = [-1 if n in [roles[r] for r in loose] else int(p) for n, p in enumerate(skeleton.parents)]
    for n in (roles[r] for r in loose):
        above = document["nodes"][joints[int(skeleton.parents[n])]]
        above["children"].remove(joints[n])
        if not above["children"]:
            above.pop("children")
        document["scenes"][0]["nodes"].append(joints[n])
    for n, joint in enumerate(joints):
        parent = parents[n]
        over = own[parent] if parent >= 0 else rotation.IDENTITY
        away = places[n] - (places[parent] if parent >= 0 else 0)
        back = rotation.conjugate(over)
        node = document["nodes"][joint]
        node["translation"] = (rotation.rotate_vectors(back, away) * unit).tolist()
        node["rotation"] = rotation.normalize(rotation.multiply(back, own[n])).tolist()
    data = _rebind(document, data, frames, unit * tall)
    called = {joint: name for role, joint in roles.items() if (name := name_in_family(family, role))}
    for n, joint in enumerate(joints):
        document["nodes"][joint]["name"] = f"joint {n}" if vrm is not None else called.get(n, f"extra {n}")
    if turned or shrunk:
        top = {"name": "Armature", "children": document["scenes"][0]["nodes"]}
        top["rotation"] = [0, 1, 0, 0] if turned else [0, 0, 0, 1]
        top["scale"] = [1 / unit] * 3 if shrunk else [1, 1, 1]
        document["nodes"].append(top)
        document["scenes"][0]["nodes"] = [len(document["nodes"]) - 1]
    if vrm is not None:
        _tell_humanoid(document, skeleton, roles, joints, vrm)
    if bare:
        for key in ("materials", "images", "textures", "samplers"):
            document.pop(key, None)
        for mesh in document["meshes"]:
            for primitive in mesh["primitives"]:
                primitive.pop("material", None)
    path.write_bytes(_written(document, data))
    return path


def read_rest(path: Path, unit: float) -> Skeleton:
    """Return the skeleton of an avatar as its nodes stand, in metres. unit: metres to the file's."""
    document, _ = _read(path)
    nodes, joints = document["nodes"], document["skins"][0]["joints"]
    above = {child: n for n, node in enumerate(nodes) for child in node.get("children", ())}
    parents = [joints.index(above[j]) if above.get(j) in joints else -1 for j in joints]
    own = [nodes[j] for j in joints]
    return Skeleton(
        tuple(node["name"] for node in own),
        np.array(parents),
        np.array([node["rotation"] for node in own]),
        np.array([node["translation"] for node in own]) / unit,
    )


def without_skeleton(path: Path) -> Path:
    """Write a sample character as a statue: its mesh bound to nothing."""
    document, data = _read(SAMPLES / "mannequin.glb")
    document.pop("skins")
    for node in document["nodes"]:
        node.pop("skin", None)
    path.write_bytes(_written(document, data))
    return path


def without_legs(path: Path) -> Path:
    """Write a sample character whose legs' joints nobody knows by their names."""
    document, data = _read(SAMPLES / "mannequin.glb")
    for node in document["nodes"]:
        if "Leg" in node["name"] or "Foot" in node["name"]:
            node["name"] = "Tentacle" + node["name"].replace("Leg", "").replace("Foot", "")
    path.write_bytes(_written(document, data))
    return path


def _rebind(document: dict[str, Any], data: bytes, frames: Any, size: float) -> bytes:
    """Return the data with bind matrices after which the skin looks the same on the new joints."""
    accessor = document["accessors"][document["skins"][0]["inverseBindMatrices"]]
    view = document["bufferViews"][accessor["bufferView"]]
    at = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
    count = accessor["count"]
    old = np.frombuffer(data, "<f4", 16 * count, at).reshape(count, 4, 4).transpose(0, 2, 1)
    turn = np.zeros((count, 4, 4))
    turn[:, 3, 3] = 1
    for n in range(3):
        axis = np.eye(3)[n]
        turn[:, :3, n] = rotation.rotate_vectors(
            rotation.conjugate(frames), np.broadcast_to(axis, (count, 3))
        )
    new = np.diag([size, size, size, 1.0]) @ turn @ old
    out = new.transpose(0, 2, 1).astype("<f4").tobytes()
    accessor.pop("min", None)
    accessor.pop("max", None)
    return data[:at] + out + data[at + len(out) :]


def _tell_humanoid(
    document: dict[str, Any], skeleton: Skeleton, roles: dict[str, int], joints: list[int], version: int
) -> None:
    bones = {bone: joints[joint] for bone, joint in find_vrm_bones(skeleton, roles).items()}
    mesh = next(n for n, node in enumerate(document["nodes"]) if "mesh" in node)
    names = document["meshes"][document["nodes"][mesh]["mesh"]].get("extras", {}).get("targetNames", [])
    shapes = {"aa": "jawOpen", "oh": "mouthFunnel", "blink": "eyeBlinkLeft"}
    places = {preset: names.index(name) for preset, name in shapes.items() if name in names}
    for one in document["meshes"]:
        for part in (one, *one["primitives"]):
            part.pop("extras", None)  # only the expressions tell what they are
    if version == 1:
        binds = {
            p: {"morphTargetBinds": [{"node": mesh, "index": n, "weight": 1}]} for p, n in places.items()
        }
        document["extensions"] = {
            "VRMC_vrm": {
                "specVersion": "1.0",
                "humanoid": {"humanBones": {b: {"node": n} for b, n in bones.items()}},
                "expressions": {"preset": binds},
            }
        }
        document["extensionsUsed"] = ["VRMC_vrm"]
        return
    older = {"aa": "a", "oh": "o", "blink": "blink"}
    groups = [
        {"presetName": older[p], "binds": [{"mesh": 0, "index": n, "weight": 100}]} for p, n in places.items()
    ]
    thumb = {"Metacarpal": "Proximal", "Proximal": "Intermediate"}
    listed = []
    for bone, node in bones.items():
        for new, old in thumb.items():
            if "Thumb" in bone and bone.endswith(new):
                bone = bone.removesuffix(new) + old
                break
        listed.append({"bone": bone, "node": node, "useDefaultValues": True})
    document["extensions"] = {
        "VRM": {"humanoid": {"humanBones": listed}, "blendShapeMaster": {"blendShapeGroups": groups}}
    }
    document["extensionsUsed"] = ["VRM"]


def _read(path: Path) -> tuple[dict[str, Any], bytes]:
    raw = path.read_bytes()
    size = struct.unpack_from("<I", raw, 12)[0]
    return json.loads(raw[20 : 20 + size]), raw[28 + size :]


def _written(document: dict[str, Any], data: bytes) -> bytes:
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    total = 28 + len(text) + len(data)
    head = struct.pack("<4sIII4s", b"glTF", 2, total, len(text), b"JSON")
    return head + text + struct.pack("<I4s", len(data), b"BIN\0") + data
