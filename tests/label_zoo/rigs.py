"""Other characters: the sample character's motion on other figures, under other joints and names."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cache
from typing import Literal

import numpy as np

from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.motion.skeleton import Skeleton
from tests.label_zoo.joint_words import CONVENTIONS, called
from tests.label_zoo.source import Array, joint, skeleton, turn

FINGERS = ("Thumb", "Index", "Middle", "Ring", "Little")
FACE = ("Jaw", "Eye", "Lid", "Brow")
LIMBS: Mapping[str, tuple[str, ...]] = {
    "arms": ("LowerArm", "Hand"),
    "shoulders": ("Shoulder", "UpperArm"),
    "legs": ("LowerLeg", "Foot"),
    "trunk": ("Spine", "Chest", "UpperChest", "Neck"),
    "head": ("Head", *FACE),
}
Rest = Literal["A", "T", "I", "turned"]
Axes = Literal["world", "bones", "random", "none"]


@dataclass(frozen=True)
class Figure:
    """A character. names: one of CONVENTIONS. limbs: factors on the lengths of LIMBS. rest: how it stands at
    rest. axes: how its joints' axes lie: as the world's at the sample's rest, along the bones, by chance, or
    without any turn at rest, as BVH has it. missing: of "fingers", "face", "toes", "shoulders", "upper
    chest", "legs". extra: of "twist", "props", "root".
    """

    names: str = "sample"
    limbs: tuple[tuple[str, float], ...] = ()
    rest: Rest = "A"
    axes: Axes = "world"
    missing: tuple[str, ...] = ()
    extra: tuple[str, ...] = ()
    seed: int = 0


def on(clip: Clip, figure: Figure) -> Clip:
    """Return a clip of the sample character on another figure."""
    rig = _rig(figure)
    turns = clip.rotations.astype(np.float64)
    for gone in rig.gone:
        below = [c for c in range(len(skeleton())) if rig.above[c] == gone]
        turns[:, below] = rotation.multiply(turns[:, gone : gone + 1], turns[:, below])
    turns = turns[:, rig.kept]
    turns = rotation.multiply(
        rotation.conjugate(rig.axes_above), rotation.multiply(turns, np.broadcast_to(rig.axes, turns.shape))
    )
    root = (clip.root.astype(np.float64) - rig.hips_before) * rig.legs + rig.hips
    rest, count = rig.skeleton.rest_rotations, len(rig.skeleton)
    full = np.repeat(rest[None], clip.frames, 0)
    full[:, rig.placed] = turns
    places = root[:, None]
    translated: tuple[int, ...] = (0,)
    if rig.placed[0] != 0:
        own = np.repeat(rig.skeleton.rest_translations[None, :1], clip.frames, 0)
        places, translated = np.concatenate([own, places], 1), (0, 1)
    for j in rig.swinging:  # what hangs on it swings a little behind
        sway = 0.12 * np.sin(np.arange(clip.frames) / clip.fps * 5.0 + j)
        full[:, j] = rotation.multiply(rotation.exp(sway[:, None] * np.array([1.0, 0, 0.4])), full[:, j])
    assert full.shape[1] == count
    return replace(
        clip,
        skeleton=rig.skeleton,
        rotations=rotation.make_continuous(rotation.normalize(full)),
        translations=places,
        translated=translated,
    )


@dataclass(frozen=True, eq=False)
class _Rig:
    skeleton: Skeleton
    gone: tuple[int, ...]  # joints of the sample that are left out with what hangs on them kept
    above: Array  # the parents of the sample, as they are while joints go
    kept: Array  # joints of the sample that stay
    placed: Array  # where they are in the skeleton
    axes: Array
    axes_above: Array
    hips_before: Array
    hips: Array
    legs: float
    swinging: tuple[int, ...]


def _missing(name: str, missing: tuple[str, ...]) -> bool:
    part = name.removeprefix("Left").removeprefix("Right")
    return (
        ("fingers" in missing and part[:-1] in FINGERS)
        or ("face" in missing and any(word in part for word in FACE))
        or ("toes" in missing and part == "Toes")
        or ("legs" in missing and part in ("UpperLeg", "LowerLeg", "Foot", "Toes"))
    )


@cache
def _rig(figure: Figure) -> _Rig:
    source = skeleton()
    draw = np.random.default_rng([5, figure.seed])
    offsets, parents = source.rest_translations.copy(), source.parents.copy()
    factors = dict(figure.limbs)
    for limb, parts in LIMBS.items():
        for j, name in enumerate(source.names):
            part = name.removeprefix("Left").removeprefix("Right").removeprefix("Upper").removeprefix("Lower")
            whole = name.removeprefix("Left").removeprefix("Right")
            if j and (whole in parts or (limb == "head" and part in parts)):
                offsets[j] *= factors.get(limb, 1.0)
    legs = factors.get("legs", 1.0)
    offsets[0] *= legs
    rests = np.repeat(rotation.make_identity_rotations()[None], len(source), 0)
    if figure.rest in ("T", "I"):
        for side, way in (("Left", 1.0), ("Right", -1.0)):
            rests[joint(f"{side}UpperArm")] = turn("z", way * (42.0 if figure.rest == "T" else -45.0))
    if figure.rest == "turned":  # as in the first frame of some clip: bent and turned a little everywhere
        rests = rotation.exp(draw.normal(size=(len(source), 3)) * 0.15)
    gone = [joint(n) for n in ("UpperChest",) if "upper chest" in figure.missing]
    gone += [joint(f"{s}Shoulder") for s in ("Left", "Right") if "shoulders" in figure.missing]
    above = parents.copy()
    for j in gone:
        for c in np.flatnonzero(parents == j):
            offsets[c] = offsets[j] + rotation.rotate_vectors(rests[j], offsets[c])
            rests[c] = rotation.multiply(rests[j], rests[c])
            parents[c] = parents[j]
    stay = [j for j, name in enumerate(source.names) if j not in gone and not _missing(name, figure.missing)]
    place = {j: i for i, j in enumerate(stay)}
    mine = [place[int(parents[j])] if j else -1 for j in stay]
    rests, offsets = rests[stay], offsets[stay]
    axes = _axes(figure, mine, rests, offsets, draw)
    over = np.where(np.array(mine)[:, None] >= 0, axes[mine], rotation.make_identity_rotations())
    rests = rotation.multiply(rotation.conjugate(over), rotation.multiply(rests, axes))
    offsets[1:] = rotation.rotate_vectors(rotation.conjugate(over), offsets)[1:]
    names = [called(figure.names, source.names[j]) for j in stay]
    rows = [(n, p, r, o) for n, p, r, o in zip(names, mine, rests, offsets, strict=True)]
    placed = np.arange(len(stay))
    if "root" in figure.extra:
        rows = [(n, p + 1, r, o) for n, p, r, o in rows]
        rows.insert(0, (CONVENTIONS[figure.names].root, -1, rotation.make_identity_rotations(), np.zeros(3)))
        placed = placed + 1
    swinging = _add_extras(figure, rows, stay, placed)
    shape = Skeleton(
        tuple(n for n, *_ in rows),
        np.array([p for _, p, _, _ in rows]),
        np.stack([r for _, _, r, _ in rows]),
        np.stack([o for _, _, _, o in rows]),
    )
    hips = source.rest_translations[0]
    return _Rig(
        shape,
        tuple(gone),
        above,
        np.array(stay),
        placed,
        axes,
        over,
        hips,
        hips * legs,
        legs,
        swinging,
    )


def _add_extras(
    figure: Figure, rows: list[tuple[str, int, Array, Array]], stay: list[int], placed: Array
) -> tuple[int, ...]:
    """Add joints that no body has; return those that swing."""
    at = {skeleton().names[j]: int(placed[i]) for i, j in enumerate(stay)}
    for side in ("Left", "Right"):
        for part, below in (("LowerArm", "Hand"), ("UpperArm", "LowerArm")):
            if "twist" in figure.extra:
                name = called(figure.names, f"{side}{part}") + "_twist"
                rows.append(
                    (
                        name,
                        at[f"{side}{part}"],
                        rotation.make_identity_rotations(),
                        rows[at[f"{side}{below}"]][3] / 2,
                    )
                )
        if "props" in figure.extra:
            rows.append(
                (
                    f"weapon_{side[0]}",
                    at[f"{side}Hand"],
                    rotation.make_identity_rotations(),
                    np.array([0, 0.05, 0]),
                )
            )
    swinging = []
    if "props" in figure.extra:
        above = at["Head"]
        for k in range(3):
            rows.append((f"hair_{k}", above, rotation.make_identity_rotations(), np.array([0, 0.08, -0.04])))
            above = len(rows) - 1
            swinging.append(above)
    return tuple(swinging)


def _axes(
    figure: Figure, parents: list[int], rests: Array, offsets: Array, draw: np.random.Generator
) -> Array:
    """Return how each joint's axes are turned against what they were."""
    count = len(parents)
    if figure.axes == "random":
        return rotation.normalize(draw.normal(size=(count, 4)))
    if figure.axes == "bones":
        out = np.repeat(rotation.make_identity_rotations()[None], count, 0)
        for j in range(count):
            below = [c for c in range(count) if parents[c] == j]
            along = offsets[below[0]] if below else None
            if along is not None and np.linalg.norm(along) > 1e-6:
                out[j] = rotation.find_rotation_between(np.array([0.0, 1, 0]), along / np.linalg.norm(along))
            elif parents[j] >= 0:
                out[j] = out[parents[j]]
        return out
    if figure.axes == "none":
        whole = np.repeat(rotation.make_identity_rotations()[None], count, 0)
        for j in range(count):
            whole[j] = rotation.multiply(whole[parents[j]], rests[j]) if parents[j] >= 0 else rests[j]
        return rotation.conjugate(whole)
    return np.repeat(rotation.make_identity_rotations()[None], count, 0)
