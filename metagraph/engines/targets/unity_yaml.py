"""Unity's text assets: its YAML, its ids and `.meta` files, and animation clips.

Unity is left-handed. Its importers mirror the X axis of what is right-handed, so that is what is done to
clips, too: positions become `(-x, y, z)`, rotations `(x, -y, -z, w)`.
"""

from __future__ import annotations

import hashlib
import math
import re
import zlib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import groupby, pairwise
from operator import itemgetter
from typing import Any

import numpy as np
import yaml
from numpy.typing import NDArray

from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.motion.skeleton import Pose, Skeleton

Array = NDArray[Any]

# Unity's numbers for its classes. An asset's main object has the id `klass * 100000`.
CLIP, CONTROLLER, MASK, TRANSITION, STATE, STATES = 74, 91, 319, 1101, 1102, 1107
TURN, SHIFT = (
    4e-4,
    2e-4,
)  # how far thinned curves may be off: length of a quaternion's error (0.05 degrees), metres


class Inline(dict[str, Any]):
    """A mapping that is written on one line."""


class Written(str):
    """The items of a list, written already."""


NOTHING = Inline(fileID=0)
_HEAD = {"m_CorrespondingSourceObject": NOTHING, "m_PrefabInstance": NOTHING, "m_PrefabAsset": NOTHING}


def main_id(klass: int) -> int:
    """Return the id of an asset's main object."""
    return klass * 100000


def local_id(*words: str) -> int:
    """Return an object's id in its file; the same words give the same id in every export."""
    return 1 + (int.from_bytes(hashlib.sha256("\n".join(words).encode()).digest()[:8], "big") >> 1)


def guid(project: str, file: str) -> str:
    """Return a file's id in Unity's project."""
    return hashlib.md5(f"{project}\n{file}".encode(), usedforsecurity=False).hexdigest()


def to(klass: int, project: str, file: str) -> Inline:
    """Return a reference to a file's main object."""
    return Inline(fileID=main_id(klass), guid=guid(project, file), type=2)


def asset(*objects: tuple[int, int, str, Mapping[str, Any]]) -> bytes:
    """Return a file of objects: class, id, type and fields."""
    lines = ["%YAML 1.1", "%TAG !u! tag:unity3d.com,2011:"]
    for klass, ident, kind, fields in objects:
        lines += [f"--- !u!{klass} &{ident}", f"{kind}:", *_block(fields, "  ")]
    return ("\n".join(lines) + "\n").encode()


def fields(hidden: int, name: str, version: int = 0, **more: Any) -> dict[str, Any]:
    """Return the fields that all objects begin with, and their own."""
    first = {"serializedVersion": version} if version else {}
    return {**first, "m_ObjectHideFlags": hidden, **_HEAD, "m_Name": name, **more}


def meta(ident: str, klass: int | None) -> bytes:
    """Return the `.meta` of a file: of an asset with a main object, of a text where None."""
    native = "" if klass is None else f"  mainObjectFileID: {main_id(klass)}\n"
    kind = "TextScriptImporter" if klass is None else "NativeFormatImporter"
    rest = "  userData: \n  assetBundleName: \n  assetBundleVariant: \n"
    return f"fileFormatVersion: 2\nguid: {ident}\n{kind}:\n  externalObjects: {{}}\n{native}{rest}".encode()


def _block(mapping: Mapping[str, Any], pad: str) -> Iterator[str]:
    for key, value in mapping.items():
        if isinstance(value, Written):
            yield f"{pad}{key}:\n{value}" if value else f"{pad}{key}: []"
        elif isinstance(value, list) and value:
            yield f"{pad}{key}:"
            for item in value:
                first, *rest = [_scalar(item)] if isinstance(item, Inline) else _block(item, "")
                yield f"{pad}- {first}"
                yield from (f"{pad}  {line}" for line in rest)
        elif isinstance(value, dict) and not isinstance(value, Inline):
            yield f"{pad}{key}:"
            yield from _block(value, pad + "  ")
        else:
            yield f"{pad}{key}: {_scalar(value)}"


def _scalar(value: Any) -> str:
    if isinstance(value, Inline):
        return "{" + ", ".join(f"{key}: {_scalar(v)}" for key, v in value.items()) + "}"
    if isinstance(value, str):
        return text(value)
    return "[]" if isinstance(value, list) else number(value)


@lru_cache(maxsize=4096)  # paths of joints come back in every clip
def text(value: str) -> str:
    """Return a text as YAML on one line: plain where it can be, even where it looks like a number, for Unity
    reads by type.
    """
    if re.fullmatch(r"\w*", value, re.ASCII):
        return value
    written = yaml.safe_dump(value, width=math.inf, default_style=None if value.isprintable() else '"')
    return written.removesuffix("...\n").rstrip("\n")


def number(value: float, digits: int = 6) -> str:
    """Return a number without an exponent, which YAML 1.1 reads as a text where there is no point."""
    if isinstance(value, int):
        return str(int(value))
    short = f"{value:.{digits}f}".rstrip("0").rstrip(".")
    return "0" if short == "-0" else short


def joint_path(skeleton: Skeleton, joint: int) -> str:
    """Return the way to a joint from the object that the skeleton's roots are in."""
    return "/".join(skeleton.names[at] for at in skeleton.chain(joint))


# --- clips

_CURVE = """  - curve:
      serializedVersion: 2
      m_Curve:
%s
      m_PreInfinity: 2
      m_PostInfinity: 2
      m_RotationOrder: 4
    path: %s"""
_BOUND = """    - serializedVersion: 2
      path: %d
      attribute: %d
      script: {fileID: 0}
      typeID: 4
      customType: 0
      isPPtrCurve: 0"""


@dataclass(frozen=True)
class Moving:
    """What a clip moves. joints, shifted: those that it turns and those that it also shifts."""

    joints: tuple[int, ...]
    shifted: tuple[int, ...]


def clip_asset(
    clip: Clip, name: str, moving: Moving, base: Pose, loop: bool, reference: Inline | None
) -> bytes:
    """Return an AnimationClip. base: where joints stand that the clip does not shift. reference: the clip of
    the pose that is subtracted in an additive layer, None for other layers.
    """
    skeleton, last = clip.skeleton, clip.frames - 1
    turns = rotation.continuous(clip.rotations[:, list(moving.joints)].astype(np.float64)) * [1, -1, -1, 1]
    curves: dict[int, list[str]] = {1: [], 2: []}  # 1: position, 2: rotation
    bound: list[str] = []

    def add(kind: int, joints: Sequence[int], values: Array, tolerance: float) -> None:
        """Add the curves `[C, F, n]` of joints."""
        slopes = np.gradient(values, axis=1) if len(joints) else values
        for joint, own, sloped, keys in zip(
            joints, values, slopes, _keys(values, slopes, tolerance) if len(joints) else (), strict=True
        ):
            if keys == [0]:
                sloped = np.zeros_like(sloped)
                keys = [0, last] if kind == 2 and joint == moving.joints[0] else keys  # the clip's length
            path = joint_path(skeleton, joint)
            into, away = _tangents(own, sloped, keys)
            times = np.array(keys)[:, None] / clip.fps
            written = _written(np.hstack([times, own[keys], into * clip.fps, away * clip.fps]))
            curves[kind].append(_CURVE % (written, text(path)))
            bound.append(_BOUND % (zlib.crc32(path.encode()), kind))

    shifts = np.broadcast_to(
        base.translations[list(moving.shifted)][:, None], (len(moving.shifted), clip.frames, 3)
    ).copy()
    for place, joint in enumerate(moving.shifted):
        if joint in clip.translated:
            shifts[place] = clip.translations[:, clip.translated.index(joint)]
    add(1, moving.shifted, shifts * np.array([-1.0, 1, 1]), SHIFT)
    add(2, moving.joints, np.ascontiguousarray(turns.swapaxes(0, 1)), TURN)
    zero = Inline(x=0, y=0, z=0)
    whole = fields(0, name, serializedVersion=6, m_Legacy=0, m_Compressed=0, m_UseHighQualityCurve=1)
    whole |= {
        "m_RotationCurves": Written("\n".join(curves[2])),
        "m_CompressedRotationCurves": [],
        "m_EulerCurves": [],
    }
    whole |= {
        "m_PositionCurves": Written("\n".join(curves[1])),
        "m_ScaleCurves": [],
        "m_FloatCurves": [],
        "m_PPtrCurves": [],
    }
    whole |= {"m_SampleRate": clip.fps, "m_WrapMode": 0, "m_Bounds": {"m_Center": zero, "m_Extent": zero}}
    whole |= {"m_ClipBindingConstant": {"genericBindings": Written("\n".join(bound)), "pptrCurveMapping": []}}
    whole |= {"m_AnimationClipSettings": _settings(clip.duration, loop, reference)}
    whole |= {
        "m_EditorCurves": [],
        "m_EulerEditorCurves": [],
        "m_HasGenericRootTransform": 0,
        "m_HasMotionFloatCurves": 0,
    }
    return asset((CLIP, main_id(CLIP), "AnimationClip", whole | {"m_Events": []}))


def _settings(seconds: float, loop: bool, reference: Inline | None) -> dict[str, Any]:
    out: dict[str, Any] = {
        "serializedVersion": 2,
        "m_AdditiveReferencePoseClip": reference or NOTHING,
        "m_AdditiveReferencePoseTime": 0,
    }
    out |= {
        "m_StartTime": 0,
        "m_StopTime": seconds,
        "m_OrientationOffsetY": 0,
        "m_Level": 0,
        "m_CycleOffset": 0,
    }
    out |= {
        "m_HasAdditiveReferencePose": int(reference is not None),
        "m_LoopTime": int(loop),
        "m_LoopBlend": 0,
    }
    out |= dict.fromkeys(
        (
            "m_LoopBlendOrientation",
            "m_LoopBlendPositionY",
            "m_LoopBlendPositionXZ",
            "m_KeepOriginalOrientation",
        ),
        0,
    )
    return out | {
        "m_KeepOriginalPositionY": 1,
        "m_KeepOriginalPositionXZ": 0,
        "m_HeightFromFeet": 0,
        "m_Mirror": 0,
    }


def _written(keys: Array) -> str:
    """Return keys `[K, 1 + 3 n]`: seconds, value, slopes into and out of it, as lines. All their numbers are
    written at once, as `number` would each. Version 2 is that of Unity 5.5 to 2017, which newer ones read:
    half the size, for it has no tangents' weights.
    """
    count, size = len(keys), (keys.shape[1] - 1) // 3
    vector = "{" + ", ".join(f"{axis}: %s" for axis in "xyzw"[:size]) + "}"
    line = (
        f"      - serializedVersion: 2\n        time: %s\n        value: {vector}\n"
        f"        inSlope: {vector}\n        outSlope: {vector}\n        tangentMode: 0\n"
    )
    plain = ("%.6f " * (1 + size) + "%.4f " * (2 * size)) * count % tuple(keys.ravel().tolist())
    short = re.sub(r"\.?0+ ", " ", plain).replace("-0 ", "0 ")
    return ((line * count) % tuple(short.split(" ")[:-1]))[:-1]


def _keys(values: Array, slopes: Array, tolerance: float) -> list[list[int]]:
    """Return for each of several curves `values [C, F, n]` the frames to keep, so that cubics through them
    with their `slopes` (a frame) are within the tolerance of the straight lines between all frames; a stretch
    of one frame is a straight line. It starts with the ends and is split at the worst frame; only the first
    is kept where all are the same. Stretches of one length are looked at together, of all curves.
    """
    frames = values.shape[1]
    moves = np.linalg.norm(values - values[:, :1], axis=2).max(1) > tolerance
    halves = np.repeat(values, 2, axis=1)
    halves[:, 1:-1:2] = (values[:, 1:] + values[:, :-1]) / 2
    corners = np.concatenate([values, slopes], 1)
    kept: list[set[int]] = [{0, frames - 1} if moving else {0} for moving in moves.tolist()]
    stretches = [(frames - 1, curve, 0) for curve in np.flatnonzero(moves).tolist()]
    while stretches:
        stretches.sort()
        split: list[tuple[int, int, int]] = []
        for length, group in groupby(stretches, itemgetter(0)):
            if length < 2:
                continue
            curves, firsts = np.array([stretch[1:] for stretch in group]).T
            lasts = firsts + length
            ends = np.stack([firsts, lasts, frames + firsts, frames + lasts], 1)
            apart = _cubic(length) @ corners[curves[:, None], ends]
            apart -= halves[curves[:, None], 2 * firsts[:, None] + np.arange(1, 2 * length)]
            off = np.einsum("sij,sij->si", apart, apart)
            places = off.argmax(1)
            for row in np.flatnonzero(off[np.arange(len(off)), places] > tolerance**2).tolist():
                curve, first = int(curves[row]), int(firsts[row])
                worst = (2 * first + 2 + int(places[row])) // 2
                worst = min(max(worst, first + 1), first + length - 1)
                kept[curve].add(worst)
                split += [(worst - first, curve, first), (first + length - worst, curve, worst)]
        stretches = split
    return [sorted(frames_of) for frames_of in kept]


@lru_cache(maxsize=1024)
def _cubic(frames: int) -> Array:
    """Return the weights `[2 * frames - 1, 4]` of two values and two slopes at all half frames between
    them.
    """
    u = np.linspace(0, 1, 2 * frames + 1)[1:-1]
    return np.stack(
        [
            2 * u**3 - 3 * u**2 + 1,
            3 * u**2 - 2 * u**3,
            (u**3 - 2 * u**2 + u) * frames,
            (u**3 - u**2) * frames,
        ],
        1,
    )


def _tangents(values: Array, slopes: Array, keys: list[int]) -> tuple[Array, Array]:
    """Return the slopes (a frame) into and out of the keys `[K, n]`."""
    into, away = slopes[keys].copy(), slopes[keys].copy()
    for place, (key, after) in enumerate(pairwise(keys)):
        if after == key + 1:
            away[place] = into[place + 1] = values[after] - values[key]
    return into, away
