"""Define figures, which are drawn for a skeleton. They turn global joint transforms into the palette of a
mesh, for any number of instances at once.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.motion import rotation
from metagraph.motion.character_mesh import CharacterMesh, MeshMaterial, find_followers
from metagraph.motion.skeleton import Skeleton
from preview import joints as rules
from preview.levels import Level, make_levels
from preview.mesh import (
    VERTEX,
    Morphs,
    SkinnedMesh,
    TriangleBatch,
    cut_at_bones,
    make_ball,
    make_capsule,
    make_egg,
)
from preview.occlusion import Rods, find_rods, main_matrices

Array = NDArray[Any]

LEFT_COLOR, MIDDLE_COLOR, RIGHT_COLOR = (
    (222, 226, 232),
    (190, 193, 198),
    (150, 154, 163),
)  # neutral: only light tells the sides apart


SKIN = re.compile(r"(?<![a-z])skin(?![a-z])", re.IGNORECASE)  # in the names of materials that are skin


class MeshFigure:
    """A mesh that follows a skeleton.

    `skeleton` is the one whose global transforms the figure takes. `bound` are the global rotations `[J, 4]`
    and positions `[J, 3]` of its joints where `mesh` is at rest: in the rest pose, unless the mesh was made
    on another skeleton or in another pose. `sources` `[M]` holds for each matrix of the palette the joint of
    `skeleton` that it follows (-1: none). `shadow`
    holds the joints `[S]` of the bones that darken the ground, and the joints `[S]` those bones start at.
    `meshes` are the names of the character's meshes, including hidden ones. `instead` says in words why this
    figure is drawn in place of the character's mesh, "" if it is not. `levels` are meshes with fewer
    triangles, finer ones first; none before `simplify`.
    """

    morphs: tuple[str, ...] = ()  # names of the mesh's morph targets
    meshes: tuple[str, ...] = ()
    instead: str = ""
    levels: tuple[Level, ...] = ()

    def __init__(
        self,
        skeleton: Skeleton,
        mesh: SkinnedMesh,
        sources: Array,
        bound: tuple[Array, Array] | None = None,
    ) -> None:
        self.skeleton, self.mesh, self.sources = skeleton, mesh, sources
        self.bound = skeleton.globals(skeleton.rest) if bound is None else bound
        self.drawn = rules.find_drawn_joints(skeleton)
        self.height = max(1e-3, float(np.ptp(self.bound[1][self.drawn], axis=0).max()))
        self._above = rules.find_nearest_above(skeleton, self.drawn)
        self.lines = np.flatnonzero(self.drawn & (self._above >= 0))
        self.line_starts = self._above[self.lines]
        body = [k for k, i in enumerate(self.lines) if not rules.is_finger(skeleton.names[i])]
        self.shadow = (self.lines[body], self.line_starts[body])
        self._head = rules.find_head(skeleton)

    def simplify(self, cancelled: Callable[[], bool] = lambda: False) -> None:
        """Make the `levels`, or read those that were made earlier. Making them takes a second or two for ten
        thousand triangles.

        May be called from any thread. Only figures that are small in the picture change.
        """
        if not self.levels:
            self.levels = make_levels(self.mesh, self.height, cancelled)

    def finest(self, error: float) -> SkinnedMesh:
        """Return the mesh with the fewest triangles whose surface is off by at most `error` metres."""
        return next((a.mesh for a in reversed(self.levels) if a.error <= error), self.mesh)

    @cached_property
    def rods(self) -> Rods | None:
        """The rods by which limbs keep light from each other, None for a figure that is no person."""
        return find_rods(self.skeleton, self.sources, self.mesh.vertices, self.bound[1])

    def palette(self, rotations: Array, positions: Array) -> Array:
        """Return the matrices from rest pose to posed, `[..., M, 3, 4]` float32, for global `rotations [...,
        J, 4]` and `positions [..., J, 3]`.
        """
        raise NotImplementedError

    def morph_weights(self, values: Mapping[str, float]) -> Array | None:
        """Return weights `[K]` in the order of `morphs`, 0 for names without a value. None for a figure
        without morphs.
        """
        return np.array([values.get(name, 0.0) for name in self.morphs], np.float32) if self.morphs else None

    def bounds(self, positions: Array) -> tuple[Array, Array]:
        """Return the lowest and the highest corner of a box round the figure in all poses `positions [..., J,
        3]`.
        """
        box = self._balls(positions)
        if box is None:
            return np.zeros(3), np.ones(3)
        below, above = self._slack
        return np.minimum(box[0] + below, box[1]), np.maximum(box[1] - above, box[0])

    def posed_bounds(
        self, rotations: Array, positions: Array, joint: int | None = None
    ) -> tuple[Array, Array]:
        """Return the same box if rotations `[..., J, 4]` are known, too.

        They turn the mesh: a thing held in a hand reaches farther than a ball round the hand's joint. With
        `joint`, the box is only round the part of the mesh that follows this joint.
        """
        matrix, corners = self.boxes
        if joint is not None:
            its = self.sources[matrix] == joint
            matrix, corners = matrix[its], corners[its]
        moved = self.palette(rotations, positions)[..., matrix, :, :].astype(float)
        points = (corners @ moved[..., :3].swapaxes(-1, -2) + moved[..., None, :, 3]).reshape(-1, 3)
        points = points[np.isfinite(points).all(1)]
        return (points.min(0), points.max(0)) if len(points) else self.bounds(positions)

    def _balls(self, positions: Array) -> tuple[Array, Array] | None:
        """Return the box round balls about the joints, None if no position is a number."""
        joints, radii = self._reach
        points = np.asarray(positions, float)[..., joints, :]
        low, high = (points - radii[:, None]).reshape(-1, 3), (points + radii[:, None]).reshape(-1, 3)
        whole = np.isfinite(low).all(1)
        return (low[whole].min(0), high[whole].max(0)) if whole.any() else None

    @cached_property
    def boxes(self) -> tuple[Array, Array]:
        """The mesh in pieces: the matrix each moves with `[B]`, and the corners of a box round it in rest
        pose `[B, 8, 3]`, enlarged by what skinning and faces may move it.
        """
        return cut_at_bones(self.mesh, 0.06 * self.height, 0.012 * self.height)

    @cached_property
    def _slack(self) -> tuple[Array, Array]:
        """How much the box of balls is too large at rest, below and above. Large ears, for example, make a
        large ball round the head.
        """
        box, mesh = self._balls(self.bound[1]), self.mesh.vertices["position"]
        if box is None or not len(mesh):
            return np.zeros(3), np.zeros(3)
        return np.maximum(mesh.min(0) - box[0], 0), np.maximum(box[1] - mesh.max(0), 0)

    @cached_property
    def _reach(self) -> tuple[Array, Array]:
        """Joints `[N]` and how far the mesh is from them `[N]`, in metres; from the bones below them if there
        are any.
        """
        _, rest = self.bound
        vertices = self.mesh.vertices
        main = main_matrices(vertices) if len(vertices) else np.zeros(0, int)
        owner = self.sources[main]
        for joint in reversed(range(len(self.skeleton))):  # hidden joints count for the joint above
            if not self.drawn[joint]:
                owner[owner == joint] = self._above[joint]
        radii = np.zeros(len(self.skeleton))
        for joint in np.flatnonzero(self.drawn).tolist():
            points = vertices["position"][owner == joint].astype(float)
            if not len(points):
                continue
            away = np.linalg.norm(points - rest[joint], axis=1)
            ends = self.lines[self.line_starts == joint]
            for end in ends:
                bone = rest[end] - rest[joint]
                along = np.clip((points - rest[joint]) @ bone / max(float(bone @ bone), 1e-12), 0, 1)
                away = np.minimum(away, np.linalg.norm(points - rest[joint] - along[:, None] * bone, axis=1))
            radii[joint] = away.max()
            radii[ends] = np.maximum(radii[ends], np.minimum(away.max(), 0.05 * self.height))
        joints = np.flatnonzero(self.drawn)
        return joints, radii[joints]

    def head(self, rotations: Array, positions: Array) -> Array:
        """Return the middle of the head `[..., 3]`: a little above its joint, or the top of the figure if it
        has none.
        """
        if self._head is None:
            top = np.argmax(np.asarray(positions)[..., 1], -1)
            return np.take_along_axis(np.asarray(positions), top[..., None, None], -2)[..., 0, :]
        up = rotation.rotate_vectors(
            rotation.conjugate(self.bound[0][self._head]), np.array([0, 0.05 * self.height, 0])
        )
        return np.asarray(
            positions[..., self._head, :] + rotation.rotate_vectors(rotations[..., self._head, :], up)
        )


class SkinnedFigure(MeshFigure):
    """A character's mesh on a project's skeleton, which may differ from the mesh's own.

    Joints are matched by name. A joint without a match follows its nearest matched ancestor, or the first
    matched joint if there is no such ancestor. `matched` counts the joints found.
    """

    def __init__(self, character: CharacterMesh, skeleton: Skeleton | None = None) -> None:
        own = character.skeleton
        skeleton = own if skeleton is None else skeleton
        rest_r, rest_p = own.globals(own.rest)
        self.matched = sum(name in skeleton for name in own.names)
        follow, sources = find_followers(own, skeleton)  # the character's joint whose matrix each joint uses
        self._inverse_rotations = rotation.conjugate(rest_r)[follow].astype(np.float32)
        self._rest_positions = rest_p[follow].astype(np.float32)
        bound_r, bound_p = (x.copy() for x in skeleton.globals(skeleton.rest))
        for joint, place in enumerate(sources):
            if place >= 0 and follow[joint] == joint:
                bound_r[place], bound_p[place] = rest_r[joint], rest_p[joint]
        super().__init__(skeleton, _character_mesh(character), sources, (bound_r, bound_p))
        self.morphs, self.meshes = character.morphs, character.meshes

    def palette(self, rotations: Array, positions: Array) -> Array:
        sources = np.maximum(self.sources, 0)
        turn = rotation.multiply(np.asarray(rotations, np.float32)[..., sources, :], self._inverse_rotations)
        out = np.empty((*turn.shape[:-1], 3, 4), np.float32)
        out[..., :3] = rotation.to_matrix(turn)
        out[..., 3] = np.asarray(positions, np.float32)[..., sources, :] - rotation.rotate_vectors(
            turn, self._rest_positions
        )
        out[..., self.sources < 0, :, :] = np.eye(3, 4, dtype=np.float32)
        return out


class StickFigure(MeshFigure):
    """Tapered bones, joint balls and a head for any skeleton, scaled to it. The left side is a little lighter
    than the right.
    """

    def __init__(self, skeleton: Skeleton) -> None:
        # Matrix j moves with joint j; matrix J + j stretches from the drawn joint above to joint j.
        count = len(skeleton)
        self._parts: list[tuple[tuple[Array, Array, Array], int, Array, tuple[int, int, int]]] = []
        super().__init__(
            skeleton,
            SkinnedMesh(np.zeros(0, VERTEX), np.zeros((0, 3), np.uint32), (), 2 * count),
            np.tile(np.arange(count), 2),
        )
        rest_r, rest_p = skeleton.globals(skeleton.rest)
        self._rest_rotations, self._rest_positions = rest_r.astype(np.float32), rest_p.astype(np.float32)
        self._above_of = np.arange(count)
        self._above_of[self.lines] = self.line_starts
        self.sources[count:] = self._above_of  # a bone is moved by the joint where it starts
        self._build(rest_p)
        self.mesh = join_parts(self._parts, 2 * count)

    def palette(self, rotations: Array, positions: Array) -> Array:
        rotations, positions = np.asarray(rotations, np.float32), np.asarray(positions, np.float32)
        turn = rotation.multiply(rotations, rotation.conjugate(self._rest_rotations))
        count = turn.shape[-2]
        out = np.empty((*turn.shape[:-2], 2 * count, 3, 4), np.float32)
        out[..., :count, :, :3] = rotation.to_matrix(turn)
        out[..., :count, :, 3] = positions - rotation.rotate_vectors(turn, self._rest_positions)
        # Bones lead from joint to joint, also if a file moves the joints, and stretch with them.
        above = self._above_of
        before = (self._rest_positions - self._rest_positions[above]).astype(np.float32)
        now = positions - positions[..., above, :]
        carried = rotation.rotate_vectors(turn[..., above, :], before)
        aim = rotation.multiply(
            rotation.find_rotation_between(carried, now).astype(np.float32), turn[..., above, :]
        )
        length = np.maximum(np.linalg.norm(before, axis=-1), 1e-6)
        axis = before / length[..., None]
        stretch = np.clip(np.linalg.norm(now, axis=-1) / length, 0.0, 20.0) - 1
        matrix = rotation.to_matrix(aim)
        along = np.einsum("...ij,...j->...i", matrix, np.broadcast_to(axis, now.shape))
        out[..., count:, :, :3] = matrix + stretch[..., None, None] * along[..., :, None] * axis[..., None, :]
        out[..., count:, :, 3] = positions[..., above, :] - np.einsum(
            "...ij,...j->...i",
            out[..., count:, :, :3],
            np.broadcast_to(self._rest_positions[above], now.shape),
        )
        return out

    def _build(self, rest: Array) -> None:
        skeleton, height = self.skeleton, self.height
        side = rules.find_side_signs(skeleton)
        colors = {1: LEFT_COLOR, 0: MIDDLE_COLOR, -1: RIGHT_COLOR}
        finger = [rules.is_finger(n) for n in skeleton.names]
        radius = np.full(len(skeleton), 0.006 * height)
        for child, parent in zip(self.lines, self.line_starts, strict=True):
            offset = rest[child] - rest[parent]
            length = float(np.linalg.norm(offset))
            if length < 1e-5:
                continue
            small = finger[child] or length < 0.02 * height
            thick = min(0.15 * length, 0.022 * height) if not small else min(0.2 * length, 0.0055 * height)
            thin = thick * (0.62 if not small else 0.85)
            radius[child], radius[parent] = (
                max(radius[child], thin),
                max(radius[parent], thick if not finger[child] else 0),
            )
            sides, rings = (6, 2) if small else (12, 3)
            turn = rotation.find_rotation_between(np.array([0.0, 1, 0]), offset)
            self._add(
                make_capsule(length, thick, thin, sides, rings),
                len(skeleton) + int(child),
                rest[parent],
                colors[int(side[child])],
                turn,
            )
        for joint in np.flatnonzero(self.drawn):
            if joint == self._head or finger[joint]:
                continue
            size = radius[joint] * 1.16
            self._add(make_ball(size), int(joint), rest[joint], (128, 131, 138))
        if self._head is not None:
            self._add_head(rest, self._head, colors[0])
        elif len(self.lines) == 0:
            self._add(
                make_ball(0.08 if height <= 2e-3 else 0.05 * height),
                int(np.flatnonzero(self.drawn)[0]),
                rest[int(np.flatnonzero(self.drawn)[0])],
                colors[0],
            )

    def _add_head(self, rest: Array, joint: int, color: tuple[int, int, int]) -> None:
        """Add an egg above the head's joint, upright in the rest pose."""
        tall = 0.135 * self.height
        self._add(make_egg(tall, tall * 0.42), joint, rest[joint] + [0, -0.1 * tall, 0.06 * tall], color)

    def _add(
        self,
        shape: tuple[Array, Array, Array],
        matrix: int,
        at: Array,
        color: tuple[int, int, int],
        turn: Array = rotation.IDENTITY,
    ) -> None:
        positions, normals, triangles = shape
        self._parts.append(
            (
                (
                    rotation.rotate_vectors(turn, positions) + at,
                    rotation.rotate_vectors(turn, normals),
                    triangles,
                ),
                matrix,
                at,
                color,
            )
        )


def join_parts(parts: list[Any], matrices: int) -> SkinnedMesh:
    """Return one mesh of rigid parts."""
    vertices, triangles, count = [], [], 0
    for (positions, normals, corners), matrix, _, color in parts:
        v = np.zeros(len(positions), VERTEX)
        v["position"], v["normal"] = positions, normals
        v["bones"][:, 0], v["weights"][:, 0] = matrix, 1
        v["color"] = (*color, 90)
        vertices.append(v)
        triangles.append(corners + count)
        count += len(v)
    if not parts:
        return SkinnedMesh(np.zeros(0, VERTEX), np.zeros((0, 3), np.uint32), (), matrices)
    indices = np.concatenate(triangles).astype(np.uint32)
    return SkinnedMesh(np.concatenate(vertices), indices, (TriangleBatch(0, len(indices)),), matrices)


def _character_mesh(character: CharacterMesh) -> SkinnedMesh:
    """Collect a character's surfaces by texture, so that a model with many plain materials is drawn with one
    call.
    """
    groups: dict[tuple[bytes | None, bool, bytes | None], list[tuple[Array, MeshMaterial]]] = {}
    for surface in character.surfaces:
        material = (
            character.materials[surface.material]
            if surface.material < len(character.materials)
            else MeshMaterial("")
        )
        grain = None if character.grain_uvs is None else material.grain
        run = np.asarray(character.triangles[surface.first : surface.first + surface.count])
        groups.setdefault((material.image, material.double_sided, grain), []).append((run, material))
    if not character.surfaces and len(character.triangles):
        groups[(None, False, None)] = [(np.asarray(character.triangles), MeshMaterial(""))]
    vertices, triangles, batches, origins = [], [], [], []
    count = first = 0
    for (image, double_sided, grain), runs in groups.items():
        start = first
        for run, material in runs:
            used, corners = np.unique(run, return_inverse=True)
            v = np.zeros(len(used), VERTEX)
            v["position"], v["normal"], v["uv"] = (
                character.positions[used],
                character.normals[used],
                character.uvs[used],
            )
            weights = np.maximum(np.nan_to_num(character.weights[used]), 0)
            total = weights.sum(1, keepdims=True)
            v["weights"] = np.where(total > 1e-6, weights / np.maximum(total, 1e-6), [1.0, 0, 0, 0])
            v["bones"] = character.joints[used]
            v["color"] = (*_srgb8(material.color[:3]), encode_shininess(material))
            vertices.append(v)
            triangles.append(corners.reshape(-1, 3) + count)
            origins.append(used)
            count, first = count + len(used), first + len(run)
        batches.append(TriangleBatch(start, first - start, image, double_sided, grain))
    if not batches:
        return SkinnedMesh(np.zeros(0, VERTEX), np.zeros((0, 3), np.uint32), (), len(character.skeleton))
    morphs = None
    if character.morph_positions is not None:
        offsets, origin = character.morph_positions, np.concatenate(origins)
        moved = np.flatnonzero((offsets != 0).any((0, 2))[origin])
        morphs = Morphs(moved, np.take(offsets, origin[moved], 1).astype(np.float32, copy=False))
    return SkinnedMesh(
        np.concatenate(vertices),
        np.concatenate(triangles).astype(np.uint32),
        tuple(batches),
        len(character.skeleton),
        morphs,
        None if character.grain_uvs is None else character.grain_uvs[np.concatenate(origins)],
    )


def encode_shininess(material: MeshMaterial) -> int:
    """Return how shiny a material is, 0..255: odd for skin, which light goes into, even for all else."""
    shiny = 2 * round(127 * (1 - min(1.0, max(0.0, material.roughness))))
    return shiny + (SKIN.search(material.name) is not None)


def _srgb8(linear: tuple[float, ...]) -> list[int]:
    """Convert linear colours 0..1 to sRGB 0..255."""
    c = np.clip(np.asarray(linear, float), 0, 1)
    return [
        int(x) for x in np.round(255 * np.where(c <= 0.0031308, 12.92 * c, 1.055 * c ** (1 / 2.4) - 0.055))
    ]
