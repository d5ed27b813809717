"""Where handles come to rest, and the reason that is shown."""

from __future__ import annotations

import numpy as np
import pytest

from metagraph.graph import edits
from metagraph.playback.timing.speed_curves import measure_action_speed
from metagraph.suggest.jumps.found import Measured, compute_stance_curves
from metagraph.suggest.jumps.seen_jumps import SeenJumps
from metagraph.suggest.jumps.snapping import Snap, find_nearest_snap, find_turning_frames, list_snaps


@pytest.fixture(scope="module")
def wide(toy):
    """A wave so wide that it is far from its stance in the middle, ended there."""
    project = edits.add_clips(toy.project(), [("wide.glb", 0, "", toy.clip("wide", 2.4, swing=2.4))])
    project = edits.place_clips(
        project, [toy.id(project, "wide")], "arms", "gesture", toy.id(project, "rest")
    )
    return edits.update_actions(project, [toy.id(project, "wide")], timing={"end": 1.5, "blend_out": 0.05})


@pytest.fixture
def action(toy, wide):
    return wide.action(toy.id(wide, "wide"))


def test_an_end_rests_where_it_is_proposed_and_says_so(wide, action):
    seen = SeenJumps(action, compute_stance_curves(wide, Measured(wide, "arms"), action))
    found = list_snaps(wide, action, "end", seen)
    assert found[0] == Snap(seen.proposed.end, "proposed: it ends without a jump")
    assert "the clip's last frame" in [s.why for s in found]
    assert [s.why for s in list_snaps(wide, action, "start")] == ["the clip's first frame"]


def test_a_blend_rests_where_it_is_long_enough_for_its_way(wide, action):
    whys = [s.why for s in list_snaps(wide, action, "out")]
    assert any("cm to the stance" in why for why in whys), whys
    found = next(s for s in list_snaps(wide, action, "out") if "cm" in s.why)
    blended = edits.update_actions(wide, [action.id], timing={"blend_out": round(1.5 - found.at, 3)})
    from metagraph.graph.checks import end_gaps

    after = end_gaps.find_end_gaps(blended, blended.graphs["arms"], blended.action(action.id))
    assert not next(g for g in after if g.edge == "ends").far


def test_a_stroke_rests_where_the_hand_is_fastest(wide, action):
    speeds, _ = measure_action_speed(wide, action)
    found = list_snaps(wide, action, "stroke", speeds=speeds)
    assert found[0].why == "as detected from the motion"
    fastest = [s for s in found if s.why.startswith("fastest here, ")]
    assert fastest and all(0 <= s.at <= 1.5 for s in fastest), "what is outside the action is no place"


def test_stresses_and_the_playhead_are_places_for_every_handle(wide, action):
    for handle in ("start", "in", "stroke", "hold", "exit"):
        whys = [s.why for s in list_snaps(wide, action, handle, stresses=[0.7, 99.0], playhead=0.4)]
        assert whys.count("the line has a stress here") == 1 and "the playhead" in whys


def test_the_nearest_is_taken_only_within_reach(wide):
    snaps = [Snap(1.0, "a"), Snap(1.0, "b"), Snap(2.0, "c")]
    assert find_nearest_snap(snaps, 1.04, 0.05) == Snap(1.0, "a")
    assert find_nearest_snap(snaps, 1.06, 0.05) is None
    assert find_nearest_snap([], 1.0, 9.0) is None


def test_peaks_that_do_not_stand_out_are_passed_over():
    x = np.linspace(0, 4 * np.pi, 200)
    curve = np.abs(np.sin(x / 2)) + 0.01 * np.sin(40 * x)
    assert len(find_turning_frames(curve, True)) == 2
    assert len(find_turning_frames(curve, False)) == 1
    assert find_turning_frames(np.zeros(10), True) == find_turning_frames(np.zeros(2), True) == []
