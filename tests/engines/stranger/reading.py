"""An export as a stranger reads it: JSON and GLB, from the words of docs/reference alone."""

import json
import struct
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from tests.engines.stranger.rotating import Numbers, slerp, unit

# glTF 2.0, "Accessor data types"
NUMBERS = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
SIZES = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}


@dataclass
class Clip:
    """Local `rotations` [F, J, 4] and `translations` [F, J, 3] of all frames, `fps` a second; `morphs`: name
    of a morph target -> its weights [F].
    """

    fps: float
    rotations: Numbers
    translations: Numbers
    morphs: dict[str, Numbers]


@dataclass
class Character:
    """What poses are composed from: `data` is the export's JSON, arrays go by its `joints`."""

    data: dict[str, Any]
    names: list[str]
    parents: list[int]
    parts: list[str]
    sides: list[str]
    rotations: Numbers
    translations: Numbers
    clips: dict[str, Clip]
    actions: dict[str, dict[str, Any]]


def read_character(path: Path) -> Character:
    data = json.loads(path.read_text("utf-8"))
    names = [joint["name"] for joint in data["joints"]]
    parents = [
        names.index(joint["parent"]) if joint["parent"] is not None else -1 for joint in data["joints"]
    ]
    gltf, binary = read_glb(path.with_name(data["glb"]))
    return Character(
        data,
        names,
        parents,
        [joint["part"] for joint in data["joints"]],
        [joint["side"] for joint in data["joints"]],
        np.array(data["base"]["rotations"], float),
        np.array(data["base"]["translations"], float),
        {clip["id"]: read_clip(gltf, binary, clip, data["joints"]) for clip in data["clips"]},
        {action["id"]: action for layer in data["layers"].values() for action in layer["actions"]},
    )


def read_glb(path: Path) -> tuple[dict[str, Any], bytes]:
    """The JSON chunk and the binary chunk."""
    whole = path.read_bytes()
    length = struct.unpack_from("<I", whole, 12)[0]
    return json.loads(whole[20 : 20 + length]), whole[20 + length + 8 :]


def numbers(gltf: dict[str, Any], binary: bytes, at: int) -> Numbers:
    """An accessor [count, size]; normalised signed integers become c / max, at least -1."""
    accessor = gltf["accessors"][at]
    view = gltf["bufferViews"][accessor["bufferView"]]
    kind = np.dtype(NUMBERS[accessor["componentType"]])
    size = SIZES[accessor["type"]]
    begin = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
    stride = view.get("byteStride", size * kind.itemsize)
    found = np.ndarray((accessor["count"], size), kind, binary, begin, (stride, kind.itemsize)).astype(float)
    return np.maximum(found / np.iinfo(kind).max, -1.0) if accessor.get("normalized") else found


def read_clip(
    gltf: dict[str, Any], binary: bytes, clip: dict[str, Any], joints: list[dict[str, Any]]
) -> Clip:
    """docs/reference, "The GLB": keys become frames; what has no channel stays in the rest pose."""
    seconds = np.arange(clip["frames"]) / clip["fps"]
    rotations = np.tile(np.array([joint["rotation"] for joint in joints], float), (len(seconds), 1, 1))
    translations = np.tile(np.array([joint["translation"] for joint in joints], float), (len(seconds), 1, 1))
    morphs: dict[str, Numbers] = {}
    animation = gltf["animations"][clip["animation"]]
    for channel in animation["channels"]:
        node, path = channel["target"]["node"], channel["target"]["path"]
        sampler = animation["samplers"][channel["sampler"]]
        times = numbers(gltf, binary, sampler["input"])[:, 0]
        keys = numbers(gltf, binary, sampler["output"])
        low = np.clip(np.searchsorted(times, seconds, "right") - 1, 0, max(len(times) - 2, 0))
        high = np.minimum(low + 1, len(times) - 1)
        gap = np.where(high > low, times[high] - times[low], 1.0)
        share = np.clip((seconds - times[low]) / gap, 0.0, 1.0)[:, None]
        if path == "rotation":
            rotations[:, node] = slerp(unit(keys[low]), unit(keys[high]), share)
        elif path == "translation":
            translations[:, node] = keys[low] + share * (keys[high] - keys[low])
        else:
            names = gltf["meshes"][gltf["nodes"][node]["mesh"]]["extras"]["targetNames"]
            keys = keys.reshape(len(times), len(names))
            frames = keys[low] + share * (keys[high] - keys[low])
            morphs = dict(zip(names, frames.T, strict=True))
    return Clip(clip["fps"], rotations, translations, morphs)
