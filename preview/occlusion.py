"""Find which parts of a body keep ambient light from which others: an arm from the flank it hangs beside,
thighs from each other, a chin from the neck.

A body is ten rounded rods. Each vertex looks at the nine rods that it is not on. A rod takes as much light as
a ball of its radius at the nearest point of its middle line would: (r / d)^2 of it where the surface faces
the ball, less towards the horizon.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.motion.roles import find_roles, is_humanoid
from metagraph.motion.skeleton import Skeleton

Array = NDArray[Any]

NONE = 255  # the limb of a vertex that is on no limb
# Name, roles where it begins (the first one present), roles where it ends, and the limb it hangs on.
LIMBS: tuple[tuple[str, tuple[str, ...], tuple[str, ...], str], ...] = (
    ("trunk", ("hips",), ("neck", "upper_chest", "chest"), ""),
    ("head", ("head",), (), "trunk"),
    ("left arm", ("left_upper_arm",), ("left_lower_arm",), "trunk"),
    ("right arm", ("right_upper_arm",), ("right_lower_arm",), "trunk"),
    ("left forearm", ("left_lower_arm",), ("left_hand",), "left arm"),
    ("right forearm", ("right_lower_arm",), ("right_hand",), "right arm"),
    ("left thigh", ("left_upper_leg",), ("left_lower_leg",), "trunk"),
    ("right thigh", ("right_upper_leg",), ("right_lower_leg",), "trunk"),
    ("left shin", ("left_lower_leg",), ("left_foot",), "left thigh"),
    ("right shin", ("right_lower_leg",), ("right_foot",), "right thigh"),
)
# How a rod counts for a vertex: not at all (it is the vertex's own), fully, or less near its beginning or its
# end, where the two limbs are joined and would darken one another in any pose.
OWN, WHOLE, FROM_START, FROM_END = range(4)


def tabulate_occlusion() -> Array:
    """Return how rod c counts for a vertex on limb v, `[v, c]`."""
    names = [name for name, *_ in LIMBS]
    out = np.full((len(LIMBS), len(LIMBS)), WHOLE)
    np.fill_diagonal(out, OWN)
    for n, (_, _, _, on) in enumerate(LIMBS):
        if on:
            above = names.index(on)
            out[above, n] = FROM_START
            # The trunk's rod begins between the thighs, ends below the head, and passes by the arms.
            out[n, above] = {"head": FROM_END}.get(names[n], FROM_START if "thigh" in names[n] else WHOLE)
            if on != "trunk":
                out[n, above] = FROM_END
    return out


@dataclass(frozen=True, eq=False)
class Rods:
    """The rods of a figure. `matrices` `[L, 2]` are those of the palette that each rod's ends move with.
    `ends` `[L, 2, 3]` are in rest pose. `radii` `[L]` are metres, 0 if there is no such limb. `limbs` `[M]`
    uint8 holds the limb that each matrix moves, or NONE.
    """

    matrices: Array
    ends: Array
    radii: Array
    limbs: Array

    def of(self, vertices: Array) -> Array:
        """Return the limb of each of `vertices [V]` (see mesh.VERTEX), uint8."""
        return np.asarray(self.limbs[main_matrices(vertices)])

    def placed(self, palette: Array) -> tuple[Array, Array]:
        """Return the rods in a pose, `palette [M, 3, 4]`: beginnings with radii, and ends, both `[L, 4]`."""
        moved = palette[self.matrices]
        points = np.einsum("leij,lej->lei", moved[..., :3], self.ends) + moved[..., 3]
        return (
            np.concatenate([points[:, 0], self.radii[:, None]], 1),
            np.concatenate([points[:, 1], (self.radii > 0)[:, None]], 1),
        )


def main_matrices(vertices: Array) -> Array:
    """Return the matrix that moves each vertex most `[V]`."""
    most = vertices["weights"].argmax(1)[:, None]
    return np.asarray(np.take_along_axis(vertices["bones"], most, 1)[:, 0])


def find_rods(skeleton: Skeleton, sources: Array, vertices: Array, rest: Array) -> Rods | None:
    """Return the rods of a mesh, None if the skeleton is not that of a person.

    `sources` `[M]` is the joint that each matrix follows. `vertices` `[V]` are at rest (see mesh.VERTEX), as
    `rest` `[J, 3]`, the joints' positions, is.
    """
    roles = find_roles(skeleton)
    if not is_humanoid(roles) or not len(vertices):
        return None
    positions = vertices["position"]
    limb = np.full(len(skeleton), 0)
    begins: dict[int, int] = {}
    for n, (_, starts, _, _) in enumerate(LIMBS):
        found = next((roles[r] for r in starts if r in roles), None)
        if found is not None:
            begins[found] = n
    for joint, parent in enumerate(skeleton.parents):
        limb[joint] = begins.get(joint, limb[parent] if parent >= 0 else 0)
    limbs = np.where(sources >= 0, limb[sources], NONE).astype(np.uint8)
    of = limbs[main_matrices(vertices)]
    matrix_of = {int(joint): m for m, joint in reversed(list(enumerate(sources)))}
    matrices, ends = np.zeros((len(LIMBS), 2), int), np.zeros((len(LIMBS), 2, 3))
    radii = np.zeros(len(LIMBS))
    for joint, n in begins.items():
        points = positions[of == n].astype(float)
        if joint not in matrix_of or not len(points):
            continue
        to = next((roles[r] for r in LIMBS[n][2] if r in roles and roles[r] in matrix_of), joint)
        # The rod of a head ends in its middle.
        last = rest[to] if to != joint else points.mean(0)
        matrices[n] = matrix_of[joint], matrix_of[to] if n == 0 else matrix_of[joint]
        ends[n] = rest[joint], last
        along = last - rest[joint]
        share = np.clip((points - rest[joint]) @ along / max(float(along @ along), 1e-12), 0, 1)
        away = np.linalg.norm(points - rest[joint] - share[:, None] * along, axis=1)
        radii[n] = np.quantile(away, 0.4)
    return Rods(matrices, ends, radii, limbs)
