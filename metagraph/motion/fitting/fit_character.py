"""Put a character on a skeleton whose joints have other names and other measures."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.motion import rotation
from metagraph.motion.character_mesh import CharacterMesh, explain_no_character
from metagraph.motion.fitting.bind import Bind, bind_pose
from metagraph.motion.fitting.fit import Fit
from metagraph.motion.fitting.footing import Footing
from metagraph.motion.fitting.sculpture import make_sculpture
from metagraph.motion.joint_map import NEEDED, find_known_roles
from metagraph.motion.skeleton import Skeleton

Array = NDArray[Any]

STEP = 1e-4  # metres along a surface, to see how it is turned
ALIKE = 0.9  # share of the joints of trunk and limbs whose names must be the same to bind a character by them
FEW = 0.01  # weights below this are left out


def fit_character(body: CharacterMesh, skeleton: Skeleton, footing: Footing | None = None) -> CharacterMesh:
    """Return a character on a skeleton, joint by joint of the same role, in the skeleton's measures. Its
    skeleton has the joints of the given one, at rest in the pose in which the character was made. footing:
    how the skeleton stands; by default as it rests. Raises ValueError, with the reason in words that follow
    "its mesh".
    """
    made = make_sculpture(body)
    bind = bind_pose(skeleton, made.at, footing)
    if isinstance(bind, str):
        raise ValueError(f"cannot be fitted ({bind})")
    fit = Fit(skeleton, bind, made, None if footing is None else footing.ankle)
    carriers, weights = fit.slots()
    joints, shares = _strongest(np.array(carriers), weights)
    held = {s.held for s in body.surfaces} - {-1}
    carrier = {joint: _main_joint(body, joint, joints, shares) for joint in held}
    morphs = made.character.morph_positions
    return replace(
        made.character,
        skeleton=_rest_as(skeleton, bind),
        positions=fit.positions.astype(np.float32),
        normals=_carry_normals(fit, made.character).astype(np.float32),
        joints=joints,
        weights=shares,
        morph_positions=None if morphs is None else (morphs * fit.broad).astype(np.float32),
        surfaces=tuple(replace(s, held=carrier.get(s.held, -1)) for s in body.surfaces),
    )


def explain_no_fit(body: CharacterMesh, skeleton: Skeleton | None) -> str | None:
    """Return why a character cannot be drawn on a skeleton (its own, if none is given) whatever its clips
    are, in words that follow "its mesh"; None if it can.
    """
    why = explain_no_character(body)
    if why is not None or skeleton is None:
        return why
    named = explain_no_character(body, skeleton)
    if named is None:
        return None
    try:
        make_sculpture(body)
    except ValueError:
        return named
    known = find_known_roles(skeleton, None)
    return None if all(role in known for role in NEEDED) else named


def put_on_skeleton(
    body: CharacterMesh, skeleton: Skeleton | None, footing: Footing | None = None
) -> tuple[CharacterMesh, str | None]:
    """Return a character as it is drawn on a skeleton (its own, if none is given), and why it is none there,
    in words that follow "its mesh"; None if it is one. It is bound by the names of its joints where they are
    the skeleton's, else fitted.
    """
    why = explain_no_character(body, skeleton)
    if skeleton is None or explain_no_character(body) is not None:
        return body, why
    if why is None and is_named_alike(body, skeleton):
        return body, None
    try:
        return fit_character(body, skeleton, footing), None
    except ValueError as reason:
        return body, why and f"{why} and {reason}"


def is_named_alike(body: CharacterMesh, skeleton: Skeleton) -> bool:
    """Return whether the joints of a character are those of a skeleton by their names, as far as they do the
    same.
    """
    own, roles = find_known_roles(body.skeleton, None), find_known_roles(skeleton, None)
    both = [role for role in NEEDED if role in own and role in roles]
    alike = [role for role in both if body.skeleton.names[own[role]] == skeleton.names[roles[role]]]
    return len(both) == 0 or len(alike) >= ALIKE * len(both)


def _carry_normals(fit: Fit, body: CharacterMesh) -> Array:
    """Return unit normals `[V, 3]` of the carried surface: across two steps along it."""
    points, normals = np.asarray(body.positions, float), np.asarray(body.normals, float)
    side = np.where(np.abs(normals[:, :1]) < 0.9, [[1.0, 0, 0]], [[0, 1.0, 0]])
    one = np.cross(normals, side)
    one /= np.maximum(np.linalg.norm(one, axis=1, keepdims=True), 1e-12)
    other = np.cross(normals, one)
    a = fit.carry(points + STEP * one) - fit.positions
    b = fit.carry(points + STEP * other) - fit.positions
    out = np.cross(a, b)
    return np.asarray(out / np.maximum(np.linalg.norm(out, axis=1, keepdims=True), 1e-12))


def _strongest(carriers: Array, weights: Array) -> tuple[Array, Array]:
    """Return the four joints that carry each point most, and how much, `[V, 4]` each."""
    most = np.argsort(-weights, axis=1, kind="stable")[:, :4]
    shares = np.take_along_axis(weights, most, 1)
    shares = np.where(shares < FEW, 0, shares)
    shares /= np.maximum(shares.sum(1, keepdims=True), 1e-9)
    return np.where(shares > 0, carriers[most], 0).astype(np.int64), shares.astype(np.float32)


def _main_joint(body: CharacterMesh, joint: int, joints: Array, shares: Array) -> int:
    """Return the joint of the skeleton that carries what one joint of the body held whole."""
    of = (body.joints == joint) & (body.weights > 0)
    rows = np.flatnonzero(of.any(1))
    return int(joints[rows[0], int(np.argmax(shares[rows[0]]))]) if len(rows) else -1


def _rest_as(skeleton: Skeleton, bind: Bind) -> Skeleton:
    """Return a skeleton whose rest pose is another."""
    rotations, places = np.array(bind.rotations, float), np.array(bind.positions, float)
    local, offsets = rotations.copy(), places.copy()
    for joint, parent in enumerate(skeleton.parents):
        if parent >= 0:
            back = rotation.conjugate(rotations[parent])
            local[joint] = rotation.multiply(back, rotations[joint])
            offsets[joint] = rotation.rotate_vectors(back, places[joint] - places[parent])
    return Skeleton(skeleton.names, skeleton.parents, local, offsets)
