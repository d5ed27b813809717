"""How the default body is sculpted: half of it, mended, mirrored, and bound to its joints."""

from __future__ import annotations

import numpy as np
import pytest

from preview.default_body.sculpture import read_sculpture
from sample_clips.make.default_body import make
from sample_clips.make.default_body.forms import whole
from sample_clips.make.default_body.joints import default_skeleton
from sample_clips.make.sculpt import ellipsoid
from tests.unchanged import only_when_changed

pytestmark = only_when_changed("sample clips")


def borders(triangles: np.ndarray) -> np.ndarray:
    edges = np.sort(np.concatenate([triangles[:, [k, (k + 1) % 3]] for k in range(3)]), 1)
    _, count = np.unique(edges, axis=0, return_counts=True)
    return np.bincount(count, minlength=3)


def test_half_a_ball_becomes_a_whole_one(monkeypatch):
    monkeypatch.setattr(make, "edge_length", lambda p: np.full(len(p), 0.05))
    half = make.cut_in_middle(*make.sculpt_half(ellipsoid((0, 0.8, 0), (0.12, 0.12, 0.12)), 0.02))
    assert (half[0][:, 0] >= 0).all()
    positions, triangles = make.mirror_half(half[0], make.mend(*half))
    assert borders(triangles).tolist()[:2] == [0, 0] and len(borders(triangles)) == 3
    assert np.allclose(positions.min(0)[0], -positions.max(0)[0])


def test_a_gap_at_the_middle_is_closed_and_a_fold_taken_out():
    positions = np.array([[0, 0, 0], [0, 1.0, 0], [1, 0.5, 0], [1, 1.5, 0], [1, -0.5, 0]])
    gap = np.array([[4, 2, 0], [2, 3, 1], [4, 3, 2]])  # between 0, 2 and 1 there is none
    closed = make.mend(positions, gap)
    assert len(closed) == 4 and sorted(closed[-1].tolist()) == [0, 1, 2]
    pinched = np.concatenate([closed, [[2, 3, 4], [3, 2, 4]]])
    assert len(borders(make.mend(positions, pinched))) <= 3


def test_the_file_is_what_the_forms_are():
    body = read_sculpture().character
    assert body.skeleton == default_skeleton() or np.allclose(
        body.skeleton.rest_translations, default_skeleton().rest_translations, atol=1e-4
    )
    assert body.skeleton.names == default_skeleton().names
    away = np.abs(whole()(np.asarray(body.positions, float)[::7]))
    assert np.percentile(away, 99) < 5e-4, "make it again: python -m sample_clips.make.default_body"


@pytest.mark.nightly
def test_it_is_made_the_same_again():
    positions, _, triangles = make.sculpt_body()
    body = read_sculpture().character
    assert len(triangles) == len(body.triangles)
    assert np.abs(np.sort(positions[:, 1]) - np.sort(body.positions[:, 1])).max() < 1e-3
