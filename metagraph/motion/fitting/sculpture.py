"""A body whose surface is brought to other skeletons: any character that stands, has limbs, and faces
somewhere.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.motion import rotation
from metagraph.motion.character_mesh import CharacterMesh
from metagraph.motion.fitting.bind import explain_no_standing, turn_to_front
from metagraph.motion.joint_map import NEEDED, SIDES, find_known_roles
from metagraph.motion.skeleton import Skeleton

Array = NDArray[Any]

FACE = (
    "jaw",
    *(f"{side}_eye" for side in SIDES),
)  # what the head carries where a skeleton has no joint for it
HEAD = 1.578  # metres above the ground of the head's joint in the default body, the body of usual size
NECK = 0.35  # share of the way from the shoulders to the head at which a neck begins that has no joint


@dataclass(frozen=True, eq=False)
class Sculpture:
    """A body as it was made: upright on the ground, facing +Z. `at` are its joints' places by role, `weights`
    `[V, J]` what each point follows, `column` the column of each role in it. `unit` is how large the body is
    beside one of usual size.
    """

    character: CharacterMesh
    at: dict[str, Array]
    weights: Array
    column: dict[str, int]
    unit: float = 1.0

    def share(self, *roles: str) -> Array:
        """Return how much each point follows some roles, `[V]`; nothing follows a role that is not there."""
        return np.asarray(self.weights[:, [self.column[r] for r in roles if r in self.column]].sum(1))

    def middle(self, part: str) -> Array:
        return np.asarray((self.at[f"left_{part}"] + self.at[f"right_{part}"]) / 2)

    @property
    def neck(self) -> Array:
        """Where the neck begins `[3]`."""
        if "neck" in self.at:
            return self.at["neck"]
        low = self.middle("upper_arm")
        return np.asarray(low + NECK * (self.at["head"] - low))


def make_sculpture(character: CharacterMesh) -> Sculpture:
    """Return a character as a body that other skeletons can carry. Raises ValueError, with the reason in
    words that follow "its mesh", for one that is no standing person.
    """
    skeleton = character.skeleton
    roles = {r: j for r, j in find_known_roles(skeleton, None).items() if "_twist" not in r}
    missing = [role.replace("_", " ") for role in NEEDED if role not in roles]
    if missing:
        raise ValueError(f"has no {missing[0]}")
    turned, places = skeleton.globals(skeleton.rest)
    why = explain_no_standing(places, roles)
    if why is not None:
        raise ValueError("does not stand at rest")
    facing, placed = turn_to_front(turned, places, roles)
    turn = rotation.multiply(facing[0], rotation.conjugate(turned[0]))
    used = np.unique(character.triangles)
    points = rotation.rotate_vectors(turn, np.asarray(character.positions, float))
    shift = -np.array([placed[roles["hips"]][0], points[used, 1].min(), 0.0])  # the trunk is halved at X = 0
    morphs = character.morph_positions
    moved = replace(
        character,
        positions=points + shift,
        normals=rotation.rotate_vectors(turn, np.asarray(character.normals, float)),
        morph_positions=None if morphs is None else rotation.rotate_vectors(turn, morphs),
    )
    at = {role: placed[joint] + shift for role, joint in roles.items()}
    column = {role: n for n, role in enumerate(roles)}
    return Sculpture(moved, at, _follow_roles(character, roles, column), column, float(at["head"][1]) / HEAD)


def _follow_roles(character: CharacterMesh, roles: dict[str, int], column: dict[str, int]) -> Array:
    """Return how much each point follows each role, `[V, R]`. Joints without one count for that above."""
    of = _roles_of_joints(character.skeleton, {joint: role for role, joint in roles.items()})
    out = np.zeros((len(character.positions), len(column)))
    columns = np.array([column[role] for role in of])
    for k in range(character.joints.shape[1]):
        np.add.at(out, (np.arange(len(out)), columns[character.joints[:, k]]), character.weights[:, k])
    total = out.sum(1, keepdims=True)
    out[total[:, 0] < 1e-6, column["hips"]] = 1
    return np.asarray(out / np.maximum(out.sum(1, keepdims=True), 1e-9))


def _roles_of_joints(skeleton: Skeleton, roles: dict[int, str]) -> list[str]:
    out: list[str] = []
    for joint, parent in enumerate(skeleton.parents):
        above = out[parent] if parent >= 0 else "hips"
        out.append(roles.get(joint, above))
    return out
