"""The guard's capsules, measured from a skinned body, judged by trimesh's distances to its skin."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh
from numpy.typing import NDArray

from metagraph.formats.gltf.reader import read_character
from metagraph.formats.store import open_project
from metagraph.graph import anatomy
from metagraph.graph.model import Project
from metagraph.motion import rotation
from metagraph.motion.body_capsules import BodyPart
from metagraph.suggest.find_contacts import with_measured_body

SAMPLES = Path(__file__).resolve().parents[2] / "sample_clips"
Array = NDArray[Any]
LIMBS = ("UpperArm", "LowerArm", "Hand", "Index", "Ring", "Thumb")
TRUNK = ("Hips", "Spine", "Chest", "UpperChest")


@cache
def sample() -> Project:
    return open_project(SAMPLES / "sample.metagraph.yaml").project


@cache
def measured(name: str) -> tuple[tuple[BodyPart, ...], Array, Array]:
    """The capsules of a body, and the corners `[N, 3, 3]` of its triangles as it stands, and their owners."""
    character, project = read_character(SAMPLES / name), sample()
    skeleton = project.skeleton
    assert skeleton is not None
    turned, at = skeleton.globals(anatomy.get_base_pose(project))
    rest_turned, rest_at = skeleton.globals(skeleton.rest)
    turn = rotation.multiply(turned, rotation.conjugate(rest_turned))
    points = np.zeros((len(character.positions), 3))
    for k in range(4):
        j = character.joints[:, k]
        moved = at[j] + rotation.rotate_vectors(turn[j], character.positions - rest_at[j])
        points += character.weights[:, k, None] * moved
    owner = character.joints[np.arange(len(points)), character.weights.argmax(1)]
    parts = with_measured_body(project, character).touch.parts
    return parts, points[character.triangles], owner[character.triangles[:, 0]]


def place(part: BodyPart) -> tuple[Array, Array]:
    """The ends of a capsule's line as the body stands."""
    skeleton = sample().skeleton
    assert skeleton is not None
    turned, at = skeleton.globals(anatomy.get_base_pose(sample()))
    ends = [
        at[skeleton.index(joint)] + rotation.rotate_vectors(turned[skeleton.index(joint)], np.array(end))
        for joint, end in ((part.joint, part.a), (part.to, part.b))
    ]
    return ends[0], ends[1]


def measure_depth(part: BodyPart, points: Array) -> Array:
    """How deep points are in a capsule, metres; negative outside."""
    a, b = place(part)
    line = b - a
    share = np.clip((points - a) @ line / max(float(line @ line), 1e-12), 0, 1)
    return part.radius - np.linalg.norm(points - a - share[:, None] * line, axis=1)


def take_surface(part: BodyPart, count: int = 40) -> Array:
    """Points round a capsule's line, on its surface."""
    a, b = place(part)
    line = b - a
    length = float(np.linalg.norm(line))
    rng = np.random.default_rng(3)
    ways = rng.normal(size=(count, 3))
    if length > 1e-6:
        ways -= (ways @ line)[:, None] * line / length**2
    return a + rng.uniform(0.15, 0.85, count)[:, None] * line + part.radius * trimesh.unitize(ways)


def measure_to_skin(points: Array, triangles: Array) -> Array:
    """How far points are from a surface, metres, by trimesh."""
    middles, out = triangles.mean(1), []
    for point in points:
        near = triangles[np.argsort(np.linalg.norm(middles - point, axis=1))[:80]]
        closest = trimesh.triangles.closest_point(near, np.repeat(point[None], len(near), 0))
        out.append(float(np.linalg.norm(closest - point, axis=1).min()))
    return np.array(out)


@pytest.mark.parametrize(
    "name", ["ada.glb", *(pytest.param(n, marks=pytest.mark.nightly) for n in ("ben.glb", "mannequin.glb"))]
)
@pytest.mark.parametrize("group", [LIMBS, TRUNK], ids=["limbs", "trunk"])
def test_capsules_lie_on_the_skin(name: str, group: tuple[str, ...]) -> None:
    parts, triangles, _ = measured(name)
    chosen = [p for p in parts if any(p.joint.endswith(word) or word in p.joint for word in group)]
    assert len(chosen) >= 4
    away = []
    for part in chosen:
        surface = take_surface(part)
        others = [p for p in parts if p is not part]
        outer = surface[np.max([measure_depth(p, surface) for p in others], axis=0) < 0.002]
        if len(outer):
            away += measure_to_skin(outer, triangles).tolist()
    median, most = np.percentile(away, (50, 90)) * 1000
    assert median < (5 if group is LIMBS else 16), median
    assert most < (12 if group is LIMBS else 50), most


@pytest.mark.parametrize("name", ["ada.glb", "ben.glb", "mannequin.glb"])
def test_the_skin_of_the_trunk_and_arms_is_covered(name: str) -> None:
    parts, triangles, owner = measured(name)
    skeleton = sample().skeleton
    assert skeleton is not None
    for word, most in (("UpperArm", 20), ("LowerArm", 22), ("Spine", 35), ("Chest", 35)):
        joints = [n for n, joint in enumerate(skeleton.names) if joint.endswith(word)]
        points = triangles[np.isin(owner, joints)].reshape(-1, 3)
        out = -np.max([measure_depth(part, points) for part in parts], axis=0) * 1000
        assert np.percentile(out, 95) < most, (word, np.percentile(out, 95))
        assert abs(np.median(out)) < 16, (word, np.median(out))
