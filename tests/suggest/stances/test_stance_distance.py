"""The strip of distances to the stance: the same measure, and the same verdict, as everywhere."""

from __future__ import annotations

import numpy as np
import pytest

from metagraph.graph import edits
from metagraph.graph.checks import end_gaps
from metagraph.suggest.jumps.found import Measured, compute_stance_curves
from metagraph.suggest.jumps.seen_jumps import SeenJumps
from metagraph.suggest.stances.stance_distance import measure_stance_distances


@pytest.fixture(scope="module")
def wide(toy):
    project = edits.add_clips(toy.project(), [("wide.glb", 0, "", toy.clip("wide", 2.4, swing=2.4))])
    return edits.place_clips(project, [toy.id(project, "wide")], "arms", "gesture", toy.id(project, "rest"))


def seen_of(project, action):
    return SeenJumps(action, compute_stance_curves(project, Measured(project, action.layer), action))


@pytest.mark.parametrize("known", [False, True])
def test_the_ends_are_as_far_as_the_problems_say(toy, wide, known):
    ident = toy.id(wide, "wide")
    ends = edits.update_actions(wide, [ident], timing={"end": 1.2, "blend_out": 0.1})
    action = ends.action(ident)
    found = measure_stance_distances(ends, action, seen_of(ends, action) if known else None)
    gap = next(g for g in end_gaps.find_end_gaps(ends, ends.graphs["arms"], action) if g.edge == "ends")
    at = int(np.argmin(np.abs(found.times - 1.2)))
    assert gap.far and found.shows[at]
    assert found.metres[at] == pytest.approx(gap.metres, rel=0.05)
    assert not found.shows[0] and not found.shows[-1]
    assert found.limits[1] == pytest.approx(gap.most)


def test_words_name_the_stance_that_is_left_and_the_one_that_is_entered(toy, wide):
    action = wide.action(toy.id(wide, "rest to up"))
    found = measure_stance_distances(wide, action, seen_of(wide, action))
    assert "cm from 'rest'" in found.words(0.0) and "cm from 'up'" in found.words(99.0)


def test_what_has_no_motion_has_no_distance(toy, wide):
    from dataclasses import replace

    action = wide.action(toy.id(wide, "wide"))
    gone = replace(wide, clips={**wide.clips, action.clip: replace(wide.clips[action.clip], motion=None)})
    found = measure_stance_distances(gone, action, None)
    assert len(found.times) == 0 and found.words(0.5) == ""
