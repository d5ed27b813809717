"""What of a body breathes and looks, found on skeletons whose rest pose is a heap on the floor."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from metagraph.formats.clips import read_clips
from metagraph.graph import edits
from metagraph.graph.model import Project
from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.motion.skeleton import Skeleton
from metagraph.playback.life.body import find_body

CLIP = Path(__file__).parents[3] / "sample_clips" / "clips" / "body_weight_both__stance.glb"


def heap(clip: Clip) -> Clip:
    """The same motion on a skeleton that lies at rest, its head turned aside."""
    skeleton = clip.skeleton
    rotations = skeleton.rest_rotations.copy()
    rotations[0] = rotation.from_axis_angle(np.array([1.0, 0, 0]), np.pi / 2)
    head = skeleton.index("Head")
    rotations[head] = rotation.from_axis_angle(np.array([0, 1.0, 0]), 1.2)
    lying = Skeleton(skeleton.names, skeleton.parents, rotations, skeleton.rest_translations)
    return replace(clip, skeleton=lying)


def project(clip: Clip) -> Project:
    return edits.add_clips(Project(), [("stand.glb", 0, "", clip)])


def test_a_head_looks_ahead_as_it_does_where_the_first_clip_begins():
    clip = read_clips(CLIP)[0]
    wanted, found = (find_body(project(c)) for c in (clip, heap(clip)))
    assert np.allclose(found.head_ahead, wanted.head_ahead, atol=0.1)
    assert np.allclose(found.trunk_ahead, wanted.trunk_ahead, atol=0.1)


def test_a_base_pose_that_was_chosen_counts():
    clip = heap(read_clips(CLIP)[0])
    made = project(clip)
    base = replace(made, base=replace(made.base, clip=next(iter(made.clips)), frame=0))
    assert find_body(base).head_ahead == pytest.approx(find_body(made).head_ahead, abs=1e-6)
