"""Forward kinematics of all poses at once say to the bit what joint after joint says."""

from __future__ import annotations

import numpy as np
import pytest

from metagraph.motion import rotation
from metagraph.motion.forward import AT_ONCE
from metagraph.motion.skeleton import Pose, Skeleton


def joint_after_joint(skeleton: Skeleton, pose: Pose) -> tuple[np.ndarray, np.ndarray]:
    turns, places = pose.rotations.copy(), pose.translations.copy()
    for joint, parent in enumerate(skeleton.parents.tolist()):
        if parent >= 0:
            above = turns[..., parent, :]
            moved = rotation.rotate_vectors(above, pose.translations[..., joint, :])
            turns[..., joint, :] = rotation.multiply(above, pose.rotations[..., joint, :])
            places[..., joint, :] = places[..., parent, :] + moved
    return turns, places


def trees() -> dict[str, list[int]]:
    drawn = np.random.default_rng(5)
    return {
        "one joint": [-1],
        "a chain": [-1, 0, 1, 2, 3, 4],
        "two roots, children not beside each other": [-1, 0, 0, 1, -1, 4, 2, 4, 3],
        "any": [-1, *(int(drawn.integers(-1, n)) for n in range(1, 40))],
    }


@pytest.mark.parametrize("shape", [(), (0,), (1,), (3,), (2, 5), (AT_ONCE,), (AT_ONCE + 1,), (3 * AT_ONCE,)])
@pytest.mark.parametrize("types", [("f4", "f4"), ("f8", "f8"), ("f4", "f8"), ("f8", "f4")])
@pytest.mark.parametrize("tree", trees().values(), ids=trees())
def test_whatever_the_tree_the_types_and_how_many_poses(
    tree: list[int], types: tuple[str, str], shape: tuple[int, ...]
) -> None:
    drawn, count = np.random.default_rng(len(tree)), len(tree)
    skeleton = Skeleton(
        tuple(f"j{n}" for n in range(count)),
        np.array(tree),
        rotation.make_identity_rotations((count,)),
        np.zeros((count, 3)),
    )
    turns = rotation.normalize(drawn.normal(size=(*shape, count, 4))).astype(types[0])
    pose = Pose(turns, drawn.normal(size=(*shape, count, 3)).astype(types[1]))
    before = pose.rotations.copy(), pose.translations.copy()
    for found, wanted in zip(skeleton.globals(pose), joint_after_joint(skeleton, pose), strict=True):
        assert found.dtype == wanted.dtype and found.shape == wanted.shape
        assert np.array_equal(found, wanted)
    assert np.array_equal(pose.rotations, before[0]) and np.array_equal(pose.translations, before[1])
