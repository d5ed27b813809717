"""Unity's animation clips as text assets.

Unity is left-handed. Its importers mirror the X axis of what is right-handed, so that is what is done to
clips, too: positions become `(-x, y, z)`, rotations `(x, -y, -z, w)`.
"""

from __future__ import annotations

import zlib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import islice, pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.engines.targets.unity_yaml import (
    CLIP,
    NOTHING,
    Inline,
    Written,
    find_joint_path,
    format_yaml_number,
    format_yaml_text,
    main_id,
    make_object_fields,
    write_asset,
)
from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.motion.skeleton import Pose

Array = NDArray[Any]

# How far thinned curves may be off: length of a quaternion's error (0.09 degrees), metres.
TURN, SHIFT = 8e-4, 4e-4

_CURVE = """  - curve:
      serializedVersion: 2
      m_Curve:
%s      m_PreInfinity: 2
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


def format_clip_asset(
    clip: Clip, name: str, moving: Moving, base: Pose, loop: bool, reference: Inline | None
) -> bytes:
    """Return an AnimationClip. base: where joints stand that the clip does not shift. reference: the clip of
    the pose that is subtracted in an additive layer, None for other layers.
    """
    skeleton, last = clip.skeleton, clip.frames - 1
    turns = rotation.make_continuous(clip.rotations[:, list(moving.joints)].astype(np.float64)) * [
        1,
        -1,
        -1,
        1,
    ]
    curves: dict[int, list[str]] = {1: [], 2: []}  # 1: position, 2: rotation
    bound: list[str] = []

    def add(kind: int, joints: Sequence[int], values: Array, tolerance: float) -> None:
        """Add the curves `[C, F, n]` of joints."""
        if not joints:
            return
        slopes = np.gradient(values, axis=1)
        kept = _keys(values, slopes, tolerance)
        still = [keys == [0] for keys in kept]
        slopes[still] = 0
        if still[0] and kind == 2:  # the clip's length is in the first joint that it turns
            kept[0] = [0, last]
        counts = [len(keys) for keys in kept]
        frames = np.array([frame for keys in kept for frame in keys])
        rows = np.repeat(np.arange(len(kept)), counts), frames
        into, away = _tangents(values, slopes, *rows)
        numbers = [frames[:, None] / clip.fps, values[rows], into * clip.fps, away * clip.fps]
        written = _write_keys(np.concatenate(numbers, 1), values.shape[2])
        for joint, count in zip(joints, counts, strict=True):
            path = find_joint_path(skeleton, joint)
            curves[kind].append(_CURVE % ("".join(islice(written, count)), format_yaml_text(path)))
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
    whole = make_object_fields(
        0, name, serializedVersion=6, m_Legacy=0, m_Compressed=0, m_UseHighQualityCurve=1
    )
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
    whole |= {"m_SampleRate": max(1, round(clip.fps)), "m_WrapMode": 0}
    whole |= {"m_Bounds": {"m_Center": zero, "m_Extent": zero}}
    whole |= {"m_ClipBindingConstant": {"genericBindings": Written("\n".join(bound)), "pptrCurveMapping": []}}
    whole |= {"m_AnimationClipSettings": _settings(clip.duration, loop, reference)}
    whole |= {
        "m_EditorCurves": [],
        "m_EulerEditorCurves": [],
        "m_HasGenericRootTransform": 0,
        "m_HasMotionFloatCurves": 0,
    }
    return write_asset((CLIP, main_id(CLIP), "AnimationClip", whole | {"m_Events": []}))


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


def _key(axes: str) -> str:
    """Return how a key is written: seconds, value, slopes into and out of it. Version 2 is that of Unity 5.5
    to 2017, which newer ones read: half the size, for it has no tangents' weights.
    """
    vector = "{" + ", ".join(f"{axis}: %s" for axis in axes) + "}"
    return (
        f"      - serializedVersion: 2\n        time: %s\n        value: {vector}\n"
        f"        inSlope: {vector}\n        outSlope: {vector}\n        tangentMode: 0\n"
    )


_KEY = {3: _key("xyz"), 4: _key("xyzw")}


def _write_keys(rows: Array, size: int) -> Iterator[str]:
    """Yield the text of each key `[K, 1 + 3 * size]`: seconds and values to 6 digits, slopes to 4."""
    digits, key = [6] * (1 + size) + [4] * (2 * size), _KEY[size]
    for row in rows.tolist():
        yield key % tuple(map(format_yaml_number, row, digits))


def _keys(values: Array, slopes: Array, tolerance: float) -> list[list[int]]:
    """Return for each of several curves `values [C, F, n]` the frames to keep, so that cubics through them
    with their `slopes` (a frame) are within the tolerance of the straight lines between all frames; a stretch
    of one frame is a straight line. It starts with the ends and is split at the worst frame; only the first
    is kept where all are the same. Stretches of one length are looked at together, of all curves.
    """
    count, frames, _ = values.shape
    moves = np.linalg.norm(values - values[:, :1], axis=2).max(1) > tolerance
    halves = np.repeat(values, 2, axis=1)
    halves[:, 1:-1:2] = (values[:, 1:] + values[:, :-1]) / 2
    corners = np.concatenate([values, slopes], 1).reshape(2 * count * frames, -1)
    halves = halves.reshape(2 * count * frames, -1)
    kept = np.zeros((count, frames), bool)
    kept[:, 0] = kept[moves, -1] = True
    # Of stretches: where their curve begins in all frames, and how far from there and how long they are.
    begins = np.flatnonzero(moves) * frames
    firsts, lengths = np.zeros_like(begins), np.full_like(begins, frames - 1)
    while len(begins):
        order = np.argsort(lengths, kind="stable")[np.count_nonzero(lengths < 2) :]
        begins, firsts, lengths = begins[order], firsts[order], lengths[order]
        worst = np.zeros_like(firsts)  # none
        for a, b in pairwise([*np.flatnonzero(np.diff(lengths, prepend=0)).tolist(), len(lengths)]):
            length, at = int(lengths[a]), begins[a:b, None] * 2 + firsts[a:b, None]
            apart = _cubic(length) @ corners.take(at + [0, length, frames, frames + length], 0)
            apart -= halves.take(at + firsts[a:b, None] + np.arange(1, 2 * length), 0)
            off = np.einsum("sij,sij->si", apart, apart)
            places = off.argmax(1)
            split = np.minimum(np.maximum((2 + places) // 2, 1), length - 1)
            worst[a:b] = split * (off.max(1) > tolerance**2)
        (some,) = worst.nonzero()
        begins, firsts, lengths, worst = begins[some], firsts[some], lengths[some], worst[some]
        middles = firsts + worst
        kept.ravel()[begins + middles] = True
        begins = np.concatenate([begins, begins])
        lengths = np.concatenate([worst, lengths - worst])
        firsts = np.concatenate([firsts, middles])
    return [np.flatnonzero(row).tolist() for row in kept]


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


def _tangents(values: Array, slopes: Array, curves: Array, frames: Array) -> tuple[Array, Array]:
    """Return the slopes (a frame) into and out of the keys of curves `[K]` at frames `[K]`, `[K, n]`."""
    into = slopes[curves, frames]
    away = into.copy()
    (near,) = ((np.diff(frames) == 1) & (np.diff(curves) == 0)).nonzero()
    straight = values[curves[near], frames[near] + 1] - values[curves[near], frames[near]]
    away[near] = into[near + 1] = straight
    return into, away
