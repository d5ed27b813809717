"""Baked motion is what the preview shows."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from metagraph.formats.bvh.file import read_bvh, write_bvh
from metagraph.formats.gltf.reader import read_gltf_clips, write_glb
from metagraph.formats.gltf.writer import Keys
from metagraph.formats.store import open_project
from metagraph.graph.model import Project
from metagraph.playback.bake import bake
from metagraph.playback.evaluator import Evaluator
from metagraph.playback.plan import Plan
from metagraph.playback.planner import make_plan
from tests.posing import pose_at

SAMPLE = Path(__file__).resolve().parents[2] / "sample_clips" / "sample.metagraph.yaml"


def test_a_project_without_clips_cannot_be_baked():
    with pytest.raises(ValueError, match="without clips"):
        bake(Evaluator(Plan(1, 0.0), Project()), Project(), 1.0)


@pytest.mark.parametrize("suffix", [".glb", ".bvh"])
def test_a_baked_performance_read_back_has_its_joints_where_the_preview_has_them(tmp_path, suffix):
    project = open_project(SAMPLE).project
    plan = make_plan(project, 6.0)
    clip = bake(Evaluator(plan, project), project, 6.0)
    path = tmp_path / f"baked{suffix}"
    if suffix == ".bvh":
        write_bvh(clip, path)
        again = read_bvh(path, scale=0.01)
    else:
        write_glb(path, [clip], keys=Keys(quantize=False))
        again = read_gltf_clips(path)[0]
    times = np.arange(clip.frames) / clip.fps
    _, shown = project.skeleton.globals(pose_at(plan, project, times))
    _, read = again.skeleton.globals(again.poses())
    order = [again.skeleton.index(name) for name in project.skeleton.names]
    offset = read[:, order] - shown
    assert np.abs(offset - offset[:, :1]).max() < 2e-3, "each joint relative to the root"
