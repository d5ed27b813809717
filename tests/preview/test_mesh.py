import numpy as np
import pytest

import sample_clips
from metagraph.formats.gltf.reader import read_character
from preview.figure import SkinnedFigure
from preview.mesh import VERTEX, SkinnedMesh, arrange_vertices, cut_at_bones


def test_an_arranged_mesh_has_the_same_triangles_in_each_batch():
    mesh = SkinnedFigure(read_character(sample_clips.__path__[0] + "/mannequin.glb")).mesh
    order, triangles = arrange_vertices(mesh)
    assert sorted(order.tolist()) == np.unique(mesh.triangles).tolist()
    for batch in mesh.batches:
        part = slice(batch.first, batch.first + batch.count)
        assert sorted(order[triangles[part]].tolist()) == sorted(mesh.triangles[part].tolist())
    blocks = [np.array_split(t.reshape(-1), t.size // 1000) for t in (mesh.triangles, triangles)]
    before, after = (sum(len(set(b.tolist())) for b in some) for some in blocks)
    assert after < 0.95 * before  # how many are skinned, a thousand corners at a time


@pytest.mark.parametrize("count", [0, 3])
def test_a_mesh_without_triangles_or_extent_is_arranged_too(count):
    triangles = np.zeros((count and 1, 3), np.uint32)
    order, after = arrange_vertices(SkinnedMesh(np.zeros(count, VERTEX), triangles, (), 1))
    assert after.shape == triangles.shape and len(order) == (count and 1)


def test_pieces_hold_the_triangles_of_their_bones_as_tightly_as_the_margin_lets_them():
    figure = SkinnedFigure(read_character(sample_clips.__path__[0] + "/mannequin.glb"))
    mesh, length, margin = figure.mesh, 0.06 * figure.height, 0.012 * figure.height
    matrices, corners = cut_at_bones(mesh, length, margin)
    low, high = corners.min(1), corners.max(1)
    held = {m: [] for m in range(mesh.matrices)}
    for triangle in mesh.triangles:
        heavy = mesh.vertices["weights"][triangle] >= 0.25
        for bone in set(mesh.vertices["bones"][triangle][heavy].tolist()):
            held[bone].append(mesh.vertices["position"][triangle])
    for bone in sorted(set(matrices.tolist())):
        own, places = matrices == bone, np.array(held[bone])
        np.testing.assert_allclose(low[own].min(0), places.min((0, 1)) - margin, atol=1e-6)
        np.testing.assert_allclose(high[own].max(0), places.max((0, 1)) + margin, atol=1e-6)
        inside = (places[:, None] >= low[own][:, None] - 1e-9) & (
            places[:, None] <= high[own][:, None] + 1e-9
        )
        assert inside.all((-1, -2)).any(-1).all()
    assert set(matrices.tolist()) == {m for m, places in held.items() if places}
    sides = np.sort(high - low - 2 * margin)[:, -1]
    assert np.median(sides) < 2 * length
