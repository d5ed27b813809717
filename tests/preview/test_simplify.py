"""Fewer triangles: what goes, and what has to stay."""

from __future__ import annotations

import numpy as np
import pytest

from preview.figure import SkinnedFigure
from preview.mesh import VERTEX, Morphs, SkinnedMesh, TriangleBatch, make_ball, turn_profile
from preview.simplify import simplify


def mesh_of(positions, triangles, batches=None, uvs=None, bones=None, morphs=None) -> SkinnedMesh:
    vertices = np.zeros(len(positions), VERTEX)
    vertices["position"] = positions
    vertices["weights"][:, 0] = 1
    if uvs is not None:
        vertices["uv"] = uvs
    if bones is not None:
        vertices["bones"][:, 0] = bones
    triangles = np.asarray(triangles, np.uint32)
    return SkinnedMesh(vertices, triangles, batches or (TriangleBatch(0, len(triangles)),), 2, morphs)


def grid(size: int) -> tuple[np.ndarray, np.ndarray]:
    """A flat square of a metre."""
    x, z = np.meshgrid(*[np.linspace(0, 1, size)] * 2, indexing="ij")
    at = np.arange(size * size).reshape(size, size)
    a, b, c, d = (q.ravel() for q in (at[:-1, :-1], at[1:, :-1], at[1:, 1:], at[:-1, 1:]))
    triangles = np.concatenate([np.stack([a, d, c], 1), np.stack([a, c, b], 1)])
    return np.stack([x.ravel(), np.zeros(size * size), z.ravel()], 1), triangles


def area(mesh: SkinnedMesh) -> float:
    corner = mesh.vertices["position"].astype(float)[mesh.triangles]
    across = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    return float(np.linalg.norm(across, axis=1).sum() / 2)


def test_a_mesh_without_triangles_stays_one():
    empty = SkinnedMesh(np.zeros(0, VERTEX), np.zeros((0, 3), np.uint32), (), 1)
    assert [len(fewer.of(empty).triangles) for fewer in simplify(empty, [0.1, 0.2])] == [0, 0]


def test_of_a_flat_square_little_more_than_its_corners_is_left_and_it_covers_the_same():
    mesh = mesh_of(*grid(20))
    less = next(simplify(mesh, [1e-3])).of(mesh)
    assert len(less.triangles) < 0.06 * len(mesh.triangles)
    assert area(less) == pytest.approx(1.0, rel=1e-6)
    corner = less.vertices["position"][less.triangles]
    up = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])[:, 1]
    assert (np.sign(up) == np.sign(up[0])).all(), "none is turned over"


def test_a_ball_stays_round_within_the_error_and_closed():
    positions, _, triangles = make_ball(0.5, 48, 32)
    mesh = mesh_of(positions, triangles)
    fine, rough = (fewer.of(mesh) for fewer in simplify(mesh, [0.002, 0.02]))
    assert len(rough.triangles) < len(fine.triangles) < len(mesh.triangles)
    for less, error in ((fine, 0.002), (rough, 0.02)):
        middle = np.linalg.norm(less.vertices["position"][less.triangles].mean(1), axis=1)
        assert middle.min() > 0.5 - 4 * error and middle.max() < 0.5 + 1e-6
        place = np.unique(less.vertices["position"], axis=0, return_inverse=True)[1].ravel()[less.triangles]
        edges = np.sort(np.concatenate([place[:, [0, 1]], place[:, [1, 2]], place[:, [2, 0]]]), 1)
        assert (np.unique(edges, axis=0, return_counts=True)[1] == 2).all()


def test_a_tube_keeps_rings_where_it_bends():
    positions, _, triangles = turn_profile([(y, 0.05) for y in np.linspace(0, 1, 41)], 12)
    bend = np.clip((positions[:, 1] - 0.45) / 0.1, 0, 1)
    mesh = mesh_of(positions, triangles)
    mesh.vertices["bones"][:, 1] = 1
    mesh.vertices["weights"][:, :2] = np.stack([1 - bend, bend], 1)
    less = next(simplify(mesh, [0.002])).of(mesh)
    y = less.vertices["position"][:, 1]
    assert len(less.triangles) < 0.5 * len(mesh.triangles)
    assert ((y > 0.44) & (y < 0.56)).sum() >= 12, "a bare tube has none there"


def test_seams_of_the_texture_and_batches_keep_their_course():
    positions, triangles = grid(12)
    left = positions[triangles][..., 0].mean(1) < 5.5 / 11
    # The two halves share places along the middle, not vertices: each has its own texture.
    other = triangles[~left] + len(positions)
    uvs = np.concatenate([positions[:, [0, 2]], positions[:, [0, 2]] + 3])
    batches = (
        TriangleBatch(0, int(left.sum()), b"one"),
        TriangleBatch(int(left.sum()), int((~left).sum()), b"two"),
    )
    mesh = mesh_of(np.tile(positions, (2, 1)), np.concatenate([triangles[left], other]), batches, uvs)
    less = next(simplify(mesh, [0.05])).of(mesh)
    assert [b.image for b in less.batches] == [b"one", b"two"]
    assert less.batches[1].first == less.batches[0].count
    assert less.batches[0].count + less.batches[1].count == len(less.triangles) < len(mesh.triangles) / 2
    for batch, low, high in zip(less.batches, (0, 3), (2, 6), strict=True):
        used = less.triangles[batch.first : batch.first + batch.count]
        uv = less.vertices["uv"][used]
        assert uv.min() >= low and uv.max() <= high, "no triangle mixes two textures"
    assert area(less) == pytest.approx(1.0, rel=1e-6), "and there is no gap"


def test_vertices_are_the_meshs_own_with_their_morph_targets():
    positions, _, triangles = make_ball(0.5, 24, 16)
    offsets = np.arange(len(positions) * 3, dtype=np.float32).reshape(1, -1, 3)
    offsets[:, ::3] = 0
    moved = np.flatnonzero(offsets.any((0, 2)))
    mesh = mesh_of(positions, triangles, morphs=Morphs(moved, offsets[:, moved]))
    fewer = next(simplify(mesh, [0.01]))
    less = fewer.of(mesh)
    assert np.array_equal(less.vertices, mesh.vertices[fewer.used])
    rest = less.vertices["position"]
    shaped = less.morphs.positions(rest, np.ones(1, np.float32))
    assert np.allclose(shaped, rest + offsets[0, fewer.used])


def test_it_ends_once_it_is_cancelled():
    mesh = mesh_of(*grid(20))
    assert list(simplify(mesh, [1e-3, 1e-2], lambda: True)) == []


@pytest.mark.nightly
def test_the_sample_character_is_less_with_each_level_and_as_wide_and_tall(mannequin):
    mesh = SkinnedFigure(mannequin).mesh
    counts = [len(mesh.triangles)]
    extent = np.stack([mesh.vertices["position"].min(0), mesh.vertices["position"].max(0)])
    for fewer in simplify(mesh, [0.003, 0.007, 0.014]):
        less = fewer.of(mesh)
        counts.append(len(less.triangles))
        place = less.vertices["position"]
        assert np.abs(np.stack([place.min(0), place.max(0)]) - extent).max() < 0.01
    assert counts[1] < 0.7 * counts[0] and counts[2] < 0.7 * counts[1] and counts[3] < 0.7 * counts[2]


@pytest.mark.parametrize("seed", range(12))
def test_whatever_a_mesh_is_like_what_is_left_is_a_mesh(seed):
    """Triangles through one another, without area, twice, with three to an edge; vertices nobody uses."""
    random = np.random.default_rng(seed)
    count = int(random.integers(3, 60))
    positions = random.choice([0.0, 0.25, 0.5, 1.0], (count, 3)) + random.normal(
        0, 1e-3 * (seed % 3), (count, 3)
    )
    triangles = random.integers(0, count, (int(random.integers(1, 200)), 3))
    half = len(triangles) // 2
    batches = (TriangleBatch(0, half, b"one"), TriangleBatch(half, len(triangles) - half, None, True))
    uvs = random.choice([0.0, 0.5, np.nan, 3.0], (count, 2))
    mesh = mesh_of(positions, triangles, batches, uvs, random.integers(0, 2, count))
    before = len(triangles)
    for fewer in simplify(mesh, [1e-3, 0.1, 10.0]):
        less = fewer.of(mesh)
        assert len(less.triangles) <= before
        assert not len(less.triangles) or less.triangles.max() < len(less.vertices)
        assert sum(b.count for b in less.batches) == len(less.triangles)
        assert [(b.image, b.double_sided) for b in less.batches] == [(b"one", False), (None, True)]
        before = len(less.triangles)
