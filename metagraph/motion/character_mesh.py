"""A skinned mesh on a skeleton, as read from a GLB: what the preview draws."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.motion import rotation
from metagraph.motion.skeleton import Skeleton

Array = NDArray[Any]

FEWEST = 12  # triangles of a character's mesh: exporters put one or two into a file that has to have a mesh
SMALL = 0.2  # of the skeleton's height: below that a mesh must be where the joints are
INSIDE = 0.25  # share of the joints that are within a small mesh that is a part of a body


@dataclass(frozen=True, eq=False)
class MeshMaterial:
    """color: linear RGBA 0..1. image: encoded PNG or JPEG bytes of the base colour texture, or None.
    grain: the same of a normal map in the mesh's second texture coordinates, such as a weave over cloth.
    """

    name: str
    color: tuple[float, float, float, float] = (0.8, 0.8, 0.8, 1.0)
    image: bytes | None = None
    roughness: float = 0.8
    double_sided: bool = False
    grain: bytes | None = None


@dataclass(frozen=True, eq=False)
class Surface:
    """A run of triangles with one material: `first` and `count` are in triangles. mesh: the name of the mesh
    it is of. held: the joint that carries it whole, -1 where its vertices follow several.
    """

    first: int
    count: int
    material: int
    mesh: str = ""
    held: int = -1


@dataclass(frozen=True, eq=False)
class CharacterMesh:
    """positions, normals `[V, 3]` in model space in the skeleton's rest pose, metres; uvs `[V, 2]`;
    grain_uvs `[V, 2]` are the second texture coordinates, None if no material has a grain;
    joints `[V, 4]` and weights `[V, 4]` summing to 1; triangles `[N, 3]`;
    morph_positions `[K, V, 3]` are offsets for the morph targets named in `morphs`. meshes: the names of all
    its meshes, of those that were left out, too.
    """

    name: str
    skeleton: Skeleton
    positions: Array
    normals: Array
    uvs: Array
    joints: Array
    weights: Array
    triangles: Array
    materials: tuple[MeshMaterial, ...]
    surfaces: tuple[Surface, ...]
    morphs: tuple[str, ...] = ()
    morph_positions: Array | None = None
    notes: tuple[str, ...] = ()
    meshes: tuple[str, ...] = ()
    grain_uvs: Array | None = None

    def __post_init__(self) -> None:
        count = len(self.positions)
        shapes = {
            "positions": (count, 3),
            "normals": (count, 3),
            "uvs": (count, 2),
            "joints": (count, 4),
            "weights": (count, 4),
            **({} if self.grain_uvs is None else {"grain_uvs": (count, 2)}),
        }
        for field, shape in shapes.items():
            if getattr(self, field).shape != shape:
                raise ValueError(
                    f"character '{self.name}': {field} are {getattr(self, field).shape}, expected {shape}"
                )
        if len(self.triangles) and int(np.max(self.triangles)) >= count:
            raise ValueError(
                f"character '{self.name}': a triangle names vertex {int(np.max(self.triangles))} of {count}"
            )
        if count and int(np.max(self.joints)) >= len(self.skeleton):
            raise ValueError(
                f"character '{self.name}': a vertex names joint {int(np.max(self.joints))} of "
                f"{len(self.skeleton)}"
            )

    def without(self, meshes: Collection[str]) -> CharacterMesh:
        """Return the character without the meshes of some names; names that it has not are passed over."""
        kept = [surface for surface in self.surfaces if surface.mesh not in meshes]
        if len(kept) == len(self.surfaces):
            return self
        runs = [self.triangles[s.first : s.first + s.count] for s in kept]
        starts = np.cumsum([0, *(len(run) for run in runs)])
        return replace(
            self,
            triangles=np.concatenate(runs) if runs else self.triangles[:0],
            surfaces=tuple(replace(s, first=int(at)) for s, at in zip(kept, starts, strict=False)),
        )


def explain_no_character(body: CharacterMesh, skeleton: Skeleton | None = None) -> str | None:
    """Return why a mesh is no character to draw on a skeleton (its own, if none is given), in words that
    follow "its mesh"; None if it is one.

    Files of animations often hold a stand-in, since a skin needs a mesh. What is asked is whether there is
    something to see, of the size of the skeleton or where its joints are, that moves with it; not what it is
    called.
    """
    skeleton = body.skeleton if skeleton is None else skeleton
    count = len(body.triangles)
    if count < FEWEST:
        return "has no surface" if not count else f"is {count} triangle{'s' if count > 1 else ''}, a stand-in"
    corners = body.positions[body.triangles].astype(float)
    areas = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    low, high = corners.reshape(-1, 3).min(0), corners.reshape(-1, 3).max(0)
    size, height = float((high - low).max()), body.skeleton.height
    if not areas.sum() > 1e-6 * size * size:
        return "has no surface"
    used = np.unique(body.triangles)
    own = np.unique(body.joints[used][body.weights[used] > 0])
    if size < SMALL * height:
        _, rest = body.skeleton.globals(body.skeleton.rest)
        room = 0.1 * size
        inside = ((rest >= low - room) & (rest <= high + room)).all(1)
        if inside.mean() < INSIDE and not inside[own].all():
            return f"is {size:.2g} m large on a skeleton of {height:.2g} m, a stand-in"
    followed = {_followed(body.skeleton, skeleton, int(joint)) for joint in own} - {-1}
    if not followed:
        return "is bound to none of the skeleton's joints"
    if len(followed) == 1 and len(skeleton) > 2 and not body.morphs:
        return "moves with one joint alone"
    return None


def find_followers(own: Skeleton, skeleton: Skeleton) -> tuple[Array, Array]:
    """Return which of its own joints each joint of a mesh moves with `[J]`, and that one's place in a
    skeleton `[J]`: the joint of its name, or of its nearest ancestor that there is one for, else of the first
    that there is one for; -1 where none is.
    """
    found = np.array([skeleton.index(n) if n in skeleton else -1 for n in own.names])
    follow = np.arange(len(own))
    first = int(np.argmax(found >= 0))
    for i in range(len(own)):
        if found[i] < 0:
            follow[i] = follow[own.parents[i]] if own.parents[i] >= 0 else first
    return follow, found[follow]


def bind_character(body: CharacterMesh, skeleton: Skeleton) -> CharacterMesh:
    """Return a character on a skeleton that is not its own, its joints matched by name as `find_followers`
    says, and its surface as that skeleton's rest pose moves it. Raises ValueError if no joint matches.
    """
    follow, places = find_followers(body.skeleton, skeleton)
    if places.min() < 0:
        raise ValueError(f"character '{body.name}' has no joint of the skeleton")
    own_r, own_p = body.skeleton.globals(body.skeleton.rest)
    rest_r, rest_p = skeleton.globals(skeleton.rest)
    turns = rotation.multiply(rest_r[places], rotation.conjugate(own_r[follow]))
    shifts = rest_p[places] - rotation.rotate_vectors(turns, own_p[follow])
    weights = body.weights[..., None].astype(float)
    matrix = (weights[..., None] * rotation.to_matrix(turns)[body.joints]).sum(1)
    moved = np.einsum("vij,vj->vi", matrix, body.positions) + (weights * shifts[body.joints]).sum(1)
    normals = np.einsum("vij,vj->vi", matrix, body.normals)
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
    morphs = body.morph_positions
    joints, shares = _merged(places[body.joints], body.weights)
    return replace(
        body,
        skeleton=skeleton,
        positions=moved.astype(body.positions.dtype),
        normals=normals.astype(body.normals.dtype),
        joints=joints.astype(body.joints.dtype),
        weights=shares,
        morph_positions=None if morphs is None else np.einsum("vij,kvj->kvi", matrix, morphs),
        surfaces=tuple(replace(s, held=int(places[s.held]) if s.held >= 0 else -1) for s in body.surfaces),
    )


def is_bound_to(body: CharacterMesh, skeleton: Skeleton) -> bool:
    """Return whether a character's joints are a skeleton's, at rest in whatever pose."""
    own = body.skeleton
    return own is skeleton or (
        own.names == skeleton.names and bool(np.array_equal(own.parents, skeleton.parents))
    )


def _merged(joints: Array, weights: Array) -> tuple[Array, Array]:
    """Return joints and weights `[V, 4]` in which no joint holds a vertex twice; joint 0 where the weight is
    0.
    """
    joints, weights = joints.copy(), weights.copy()
    for n in range(1, joints.shape[1]):
        for before in range(n):
            same = joints[:, n] == joints[:, before]
            weights[same, before] += weights[same, n]
            weights[same, n] = 0
    joints[weights == 0] = 0
    return joints, weights


def _followed(own: Skeleton, skeleton: Skeleton, joint: int) -> int:
    """Return the joint of a skeleton that has the name of one's own joint, or of its nearest ancestor that
    there is one for; -1 for none.
    """
    while joint >= 0:
        if own.names[joint] in skeleton:
            return skeleton.index(own.names[joint])
        joint = int(own.parents[joint])
    return -1
