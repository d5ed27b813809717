"""What happens to clips on their way: how they are recorded, cut, cleaned and turned round."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache, lru_cache

import numpy as np

from metagraph.formats.takes import drop_stray_poses
from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.motion.mirror import find_joint_twins, mirror
from metagraph.motion.skeleton import Skeleton
from tests.label_zoo.source import FPS, Array, joint, skeleton, turn


@dataclass(frozen=True)
class Recording:
    """How clips were recorded.

    fps: frames a second. noise: degrees joints tremble. drift: metres a hand is off its stance at most at
    the end of a clip (half as much at its beginning). warp: 0..1, how unevenly time goes. sizes: least and
    greatest factor on how far movements go. trim: frames lost at each end at most. strewn: whether each clip
    stands elsewhere and faces elsewhere. bind: frames of the rest pose "before" or "after" (or both) that a
    tool left there. mirrored: all left-right. size: a factor on all lengths, as a wrong unit has it.
    """

    fps: float = 30.0
    noise: float = 0.0
    drift: float = 0.0
    warp: float = 0.0
    sizes: tuple[float, float] = (1.0, 1.0)
    trim: int = 0
    strewn: bool = False
    bind: tuple[str, ...] = ()
    mirrored: bool = False
    size: float = 1.0


def recorded(clip: Clip, how: Recording, draw: np.random.Generator, loop: bool = False) -> Clip:
    """Return a clip of the sample character as it was recorded. loop: a resting loop, whose movements keep
    their size.
    """
    turns, root = clip.rotations.astype(np.float64), clip.root.astype(np.float64)
    if how.mirrored:
        turned = mirror(clip, _pairs())
        turns, root = turned.rotations.astype(np.float64), turned.root.astype(np.float64)
    if how.sizes != (1.0, 1.0) and not loop:
        turns, root = _sized(turns, root, float(draw.uniform(*how.sizes)))
    if how.drift:
        turns = _drifted(turns, how.drift, draw)
    if how.noise:
        turns = _trembling(turns, how.noise, draw)
    if how.strewn:
        yaw = turn("y", draw.uniform(-180, 180))
        root = rotation.rotate_vectors(yaw, root) + np.array(
            [*draw.uniform(-2, 2, 1), 0, *draw.uniform(-2, 2, 1)]
        )
        turns[:, 0] = rotation.multiply(yaw, turns[:, 0])
    out = Clip(clip.name, skeleton(), FPS, rotation.make_continuous(turns), root[:, None])
    if how.trim:
        first, last = (int(x) for x in draw.integers(0, how.trim + 1, 2))
        out = out.trimmed(first, out.frames - last) if out.frames > 20 + first + last else out
    return _sampled(out, how.fps, how.warp, draw)


@cache
def _pairs() -> tuple[int, ...]:
    return find_joint_twins(skeleton())


def with_bind(clip: Clip, how: Recording) -> Clip:
    """Return a clip with the bind poses a tool left in it, as far as reading leaves them there."""
    if not how.bind:
        return clip
    pose, rest = clip.skeleton.rest_rotations[None], clip.skeleton.rest_translations[list(clip.translated)]
    turns, places = clip.rotations, clip.translations
    if "before" in how.bind:
        turns, places = np.concatenate([pose, turns]), np.concatenate([rest[None], places])
    if "after" in how.bind:
        turns, places = np.concatenate([turns, pose]), np.concatenate([places, rest[None]])
    turns = rotation.make_continuous(np.asarray(turns, np.float64))
    return drop_stray_poses([replace(clip, rotations=turns, translations=places, weights=None)])[0]


def scaled(clip: Clip, size: float) -> Clip:
    """Return a clip all of whose lengths are longer by a factor: as where a unit was not understood."""
    if size == 1.0:
        return clip
    return replace(clip, skeleton=_larger(clip.skeleton, size), translations=clip.translations * size)


@lru_cache(maxsize=32)
def _larger(skeleton_: Skeleton, size: float) -> Skeleton:
    return replace(skeleton_, rest_translations=skeleton_.rest_translations * size)


def _sized(turns: Array, root: Array, size: float) -> tuple[Array, Array]:
    """Return a movement that goes farther or less far from the way between its ends."""
    part = np.linspace(0, 1, len(turns))
    part = part * part * (3 - 2 * part)
    shape = turns.shape
    way = rotation.slerp(
        np.broadcast_to(turns[:1], shape),
        np.broadcast_to(turns[-1:], shape),
        np.broadcast_to(part[:, None], shape[:2]),
    )
    away = rotation.multiply(rotation.conjugate(way), turns)
    line = root[:1] + (root[-1:] - root[:1]) * part[:, None]
    grown = rotation.scale_rotation(away, np.full(shape[:2], size))
    return rotation.multiply(way, grown), line + (root - line) * size


def _drifted(turns: Array, most: float, draw: np.random.Generator) -> Array:
    """Return a movement whose arms do not quite begin, and do not quite end, where they stand."""
    out = turns.copy()
    way = np.linspace(0, 1, len(turns))
    for side in ("Left", "Right"):
        begin, end = draw.uniform(0, most / 2), draw.uniform(0, most)
        first, last = (x / np.linalg.norm(x) for x in draw.normal(size=(2, 3)))
        # An arm is about half a metre: so many radians about its shoulder.
        angles = (first * begin * (1 - way)[:, None] + last * end * way[:, None]) / 0.5
        j = joint(f"{side}UpperArm")
        out[:, j] = rotation.multiply(rotation.exp(angles), out[:, j])
    return out


def _trembling(turns: Array, degrees: float, draw: np.random.Generator) -> Array:
    """Return a movement with what is left of the noise of cameras: smooth over about a quarter of a second,
    less in the hips and legs, whose feet stay, and in the fingers.
    """
    shares = np.exp(-0.5 * (np.arange(-9, 10) / 3.5) ** 2)
    shares /= np.linalg.norm(shares)  # so that it stays as large
    raw = draw.normal(size=(len(turns) + len(shares), turns.shape[1], 3))
    smooth = np.zeros((len(turns), turns.shape[1], 3))
    for k, part in enumerate(shares):
        smooth += part * raw[k : k + len(turns)]
    names = skeleton().names
    share = [0.3 if "Leg" in n or n == "Hips" else 0.5 if n[-1].isdigit() else 1.0 for n in names]
    tremble = rotation.exp(np.radians(degrees) / np.sqrt(3) * smooth * np.array(share)[None, :, None])
    return rotation.normalize(rotation.multiply(tremble, turns))


def _sampled(clip: Clip, fps: float, warp: float, draw: np.random.Generator) -> Clip:
    """Return a clip at another rate, its time going faster here and slower there."""
    if fps == clip.fps and not warp:
        return clip
    length = clip.duration * (draw.uniform(1 - 0.35 * warp, 1 + 0.35 * warp) if warp else 1.0)
    count = max(2, round(length * fps) + 1)
    s = np.linspace(0, 1, count)
    bent = s + warp * 0.12 * np.sin(2 * np.pi * s) * draw.uniform(-1, 1) if warp else s
    poses = clip.pose_at(np.clip(bent, 0, 1) * clip.duration)
    return replace(
        clip,
        fps=fps,
        rotations=rotation.make_continuous(poses.rotations.astype(np.float64)),
        translations=poses.translations[:, list(clip.translated)],
        weights=None,
    )
