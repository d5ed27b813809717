"""What stances look like."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from metagraph.graph import anatomy, edits
from metagraph.graph.model import Project
from metagraph.mimicry.keypoint_layouts import PLACE, POINTS
from metagraph.mimicry.pose_measures import COUNT, SHARP
from metagraph.mimicry.signatures import BodySignature, compute_signatures
from tests.mimicry import people


@pytest.fixture(scope="module")
def somebody(toy: Any) -> Project:
    return people.somebody(toy.skeleton)


def test_without_clips_there_is_nobody_to_mimic_with() -> None:
    with pytest.raises(ValueError, match="no clips"):
        BodySignature(Project())


def test_what_is_no_human_is_told_what_it_lacks(somebody: Project) -> None:
    with pytest.raises(ValueError, match="left_hand, left_lower_arm"):
        BodySignature(
            edits.set_role(edits.set_role(somebody, "left_hand", "Nothing"), "left_lower_arm", "Nothing")
        )


def test_points_are_where_the_joints_are(somebody: Project) -> None:
    body = BodySignature(somebody)
    base = anatomy.get_base_pose(somebody)
    _, at = somebody.skeleton.globals(base)  # type: ignore[union-attr]
    points = body.points(base)
    assert (points[PLACE["left_wrist"]] == at[somebody.skeleton.index("LeftHand")]).all()  # type: ignore[union-attr]
    assert body.confidence.sum() == len(POINTS)


def test_the_face_looks_ahead_and_turns_with_the_head(somebody: Project) -> None:
    straight, tilted = people.standing(somebody, "down"), people.standing(somebody, "down", tilt=20.0)
    ears = straight[PLACE["left_ear"]] - straight[PLACE["right_ear"]]
    assert ears[0] > 0.1 and abs(ears[1]) < 1e-6 and abs(ears[2]) < 1e-6
    assert straight[PLACE["nose"]][2] > straight[PLACE["left_ear"]][2] + 0.08
    line = tilted[PLACE["left_ear"]] - tilted[PLACE["right_ear"]]
    assert np.degrees(np.arctan2(line[1], line[0])) == pytest.approx(20.0, abs=0.1)


def test_every_stance_of_the_sample_is_told_from_the_others(sample: Project) -> None:
    found, width = compute_signatures(sample, BodySignature(sample))
    assert 0.6 < width < 0.8
    for layer, signature in found.items():
        assert signature.stances == tuple(sample.graphs[layer].stances)
        apart = signature.measures[:, None] - signature.measures[None]
        far = np.sqrt((apart**2 * SHARP[layer]).sum((2, 3)) / COUNT[layer].sum())
        other = signature.of[:, None] != signature.of[None]
        assert far[other].min() > 0.6, layer
    assert len(found["arms"].of) == 2 * len(found["arms"].stances)  # either hand
    assert len(found["head"].of) == len(found["head"].stances)


def test_only_layers_that_are_wanted_and_have_loops_are_looked_at(somebody: Project) -> None:
    assert set(compute_signatures(somebody, BodySignature(somebody))[0]) == {"arms", "head"}
    assert set(compute_signatures(somebody, BodySignature(somebody), ["head"])[0]) == {"head"}


def test_stances_whose_clips_are_missing_are_left_out(somebody: Project) -> None:
    graph = somebody.graphs["arms"]
    lost = next(
        a for a in graph.actions.values() if a.kind == "stance" and graph.stances[a.stance].name == "hips"
    )
    clips = {**somebody.clips, lost.clip: replace(somebody.clips[lost.clip], motion=None)}
    found, _ = compute_signatures(replace(somebody, clips=clips), BodySignature(somebody))
    names = [graph.stances[s].name for s in found["arms"].stances]
    assert names == ["down", "raised", "ahead"]
