import numpy as np
import pytest

import sample_clips
from metagraph.formats.gltf import read_character
from preview.figure import SkinnedFigure
from preview.mesh import VERTEX, Mesh, arranged


def test_an_arranged_mesh_has_the_same_triangles_in_each_batch():
    mesh = SkinnedFigure(read_character(sample_clips.__path__[0] + "/mannequin.glb")).mesh
    order, triangles = arranged(mesh)
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
    order, after = arranged(Mesh(np.zeros(count, VERTEX), triangles, (), 1))
    assert after.shape == triangles.shape and len(order) == (count and 1)
