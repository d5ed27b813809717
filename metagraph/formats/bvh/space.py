"""Find what BVH does not state: the unit of length, which axis points up, and where the skeleton stands at
rest.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.common.wording import phrase
from metagraph.motion import rotation
from metagraph.motion.skeleton import Pose, Skeleton

Array = NDArray[Any]

_HUMAN = (1.2, 2.5)  # metres: how tall a unit must make the skeleton
USUAL = 0.01  # metres per unit in most files
_BURIED = 0.25  # of the figure's height: a foot that is deeper on average is under the floor
_ON_FLOOR = 0.12  # of it: a foot that is nearer to the floor on average stands there
_COLLAPSED = 0.3  # of their length: bones that are shorter on average have lost it
_UNITS = (
    (1.0, phrase("metres")),
    (0.01, phrase("centimetres")),
    (0.0254, phrase("inches")),
    (0.001, phrase("millimetres")),
    (0.0254 / 0.45, phrase("the CMU database's units (5.64 cm)")),
    (0.1, phrase("decimetres")),
)


def stand_up(offsets: Array, parents: Array, rest_rotations: Array, placed: set[int]) -> None:
    """Move the rest pose, in place, over the origin, with its lowest joint on the ground.

    Exporters leave the first frame's position in the OFFSET of a root, so without this the files of one actor
    would seem to have different skeletons.
    """
    line, joint = [0], 0
    while True:
        children = np.flatnonzero(parents == joint)
        if len(children) != 1 or int(children[0]) not in placed:
            break
        joint = int(children[0])
        line.append(joint)
    if (parents < 0).sum() > 1:
        return
    offsets[line] = 0
    unplaced = Skeleton(
        tuple(map(str, range(len(parents)))), parents.copy(), rest_rotations.copy(), offsets.copy()
    )
    _, positions = unplaced.globals(unplaced.rest)
    # The lift must survive the rotations above the last joint of the line, which are the root's rest
    # rotation.
    lift = np.array([0.0, -float(positions[:, 1].min()), 0.0])
    offsets[line[-1]] = (
        rotation.rotate_vectors(rotation.conjugate(rest_rotations[0]), lift) if len(line) > 1 else lift
    )


def find_relative_joints(
    skeleton: Skeleton, roles: dict[str, int], rotations: Array, placed: dict[int, Array]
) -> list[int]:
    """Return the joints whose positions are relative to their OFFSET, as some programs for the web write BVH;
    in most files positions replace it.

    The root's are where its feet are far below the floor as they stand, and on it with the OFFSET added; the
    other joints' where half of their bones would lose most of their length. skeleton: at rest, Y up; placed:
    positions `[F, 3]`; both metres. rotations `[F, J, 4]`.
    """
    offsets = skeleton.rest_translations
    lengths = np.linalg.norm(offsets, axis=-1)
    inner = [i for i in placed if skeleton.parents[i] >= 0 and lengths[i] > 1e-3]
    shares = [float(np.linalg.norm(placed[i], axis=-1).mean()) / lengths[i] for i in inner]
    out = [i for i in placed if skeleton.parents[i] >= 0] if inner and np.median(shares) < _COLLAPSED else []
    feet = [roles[r] for r in ("left_foot", "right_foot", "left_toes", "right_toes") if r in roles]
    if not feet or "head" not in roles or skeleton.parents[0] >= 0:
        return out
    some = np.unique(np.linspace(0, len(rotations) - 1, 24).astype(int))
    translations = np.tile(offsets, (len(some), 1, 1))
    for i, p in placed.items():
        translations[:, i] = p[some] + (offsets[i] if i in out else 0)
    _, places = skeleton.globals(Pose(rotations[some].astype(float), translations))
    tall = float(np.ptp(skeleton.globals(skeleton.rest)[1][:, 1]))
    lowest = float(np.median(places[:, feet, 1].min(1)))
    if lowest < -_BURIED * tall and abs(lowest + offsets[0, 1]) < _ON_FLOOR * tall:
        out.append(0)
    return sorted(out)


def find_unit(skeleton: Skeleton, roles: dict[str, int]) -> tuple[float, str]:
    """Return the metres per unit, and a note that says how they were found."""
    bones = np.linalg.norm(skeleton.rest_translations, axis=1)

    def length(top: int, bottom: int) -> float:
        chain = skeleton.chain(bottom)
        return float(sum(bones[j] for j in chain if j not in skeleton.chain(top)))

    tall = 0.0
    if "hips" in roles and "head" in roles:
        legs = [length(roles["hips"], roles[r]) for r in ("left_foot", "right_foot") if r in roles]
        if legs:
            tall = (
                max(legs) + length(roles["hips"], roles["head"])
            ) * 1.12  # soles and the top of the head are farther out
    known = tall > 0
    tall = tall or skeleton.height
    for scale, name in _UNITS if known else _UNITS[:4]:
        if _HUMAN[0] <= tall * scale <= _HUMAN[1]:
            return (
                scale,
                phrase(
                    "units read as {unit}: the figure is then {height:.2f} m tall"
                    if known
                    else "units read as {unit}: the skeleton is then {height:.2f} m tall",
                    unit=name,
                    height=tall * scale,
                ),
            )
    return (
        USUAL,
        phrase(
            "units read as centimetres, though the skeleton is then {height:.3g} m tall; give the scale to "
            "change it",
            height=tall * 0.01,
        ),
    )


def is_z_up(
    skeleton: Skeleton, roles: dict[str, int], rotations: Array, placed: dict[int, Array], offsets: Array
) -> tuple[bool, bool]:
    """Return whether Z points up, and whether it also does so in the rest pose. `offsets` and `placed` are in
    metres.
    """
    feet = [roles[r] for r in ("left_foot", "right_foot") if r in roles]
    if "head" not in roles or not feet:
        return False, False
    some = np.unique(np.linspace(0, len(rotations) - 1, 24).astype(int))
    translations = np.tile(offsets, (len(some), 1, 1))
    for i, p in placed.items():
        translations[:, i] = p[some]
    _, moving = skeleton.globals(Pose(rotations[some].astype(float), translations))
    _, resting = skeleton.globals(Pose(skeleton.rest_rotations, offsets))

    def upward(positions: Array) -> Array:
        way = positions[..., roles["head"], :] - positions[..., feet, :].mean(-2)
        return np.asarray(way / np.maximum(np.linalg.norm(way, axis=-1, keepdims=True), 1e-9))

    now = upward(moving).mean(0)
    rest = upward(resting)
    if now[2] < 0.8 or np.abs(now[1]) > 0.5:
        return False, bool(rest[2] > 0.8)
    if rest[2] > 0.8:
        return True, True
    # A Y-up figure whose head lies towards Z: either it lies on its back, or the world has Z up. Standing
    # hips tell.
    tall = float(np.linalg.norm(resting[roles["head"]] - resting[feet].mean(0)))
    hips = moving[:, roles.get("hips", 0)]
    ground = hips[:, 2].mean() / max(tall, 1e-9)
    return bool(0.3 < ground < 0.85 and hips[:, 2].std() < 0.2 * tall), False
