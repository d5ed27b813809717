"""How far ends of clips may be from stances: alike for figures of any size, more where it is blended long."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from metagraph.graph import edits
from metagraph.graph.checks import end_gaps
from metagraph.graph.checks.end_gaps import (
    FAR,
    LONG,
    TALL,
    UNHURRIED,
    find_slow_distances,
    measure_hidden_gap,
)
from metagraph.graph.model import Project

heights = st.floats(0.01, 200)


@given(heights, st.floats(0, LONG, exclude_max=True))
def test_a_short_blend_covers_no_more_than_none(height: float, blend: float) -> None:
    assert (
        measure_hidden_gap(height, blend)
        == measure_hidden_gap(height, 0.0)
        == pytest.approx(FAR * height / TALL)
    )
    assert not find_slow_distances(np.zeros(3), height, blend).any()


@given(heights, st.floats(LONG, 5), st.floats(0, 5))
def test_from_there_on_it_grows_with_the_blend(height: float, blend: float, more: float) -> None:
    assert measure_hidden_gap(height, blend) == pytest.approx(UNHURRIED * blend * height / TALL)
    assert measure_hidden_gap(height, blend + more) >= measure_hidden_gap(height, blend)


def test_a_project_without_clips_has_no_distances(toy: Any) -> None:
    project = toy.project()
    action = project.action(toy.id(project, "rest beat lf"))
    bare = edits.remove_clips(project, [*project.clips])
    assert end_gaps.find_end_gaps(bare, bare.graphs["arms"], action) == []
    assert end_gaps.measure_seam(bare, bare.graphs["arms"], action) is None
    assert np.isinf(end_gaps.measure_distances_to_stance(bare, action, np.zeros(2))).all()
    assert end_gaps.find_end_gaps(Project(), Project().graphs["arms"], action) == []


def test_distances_over_time_are_the_gaps_at_its_ends(toy: Any) -> None:
    project = toy.project()
    action = project.action(toy.id(project, "up to far"))
    found = end_gaps.find_end_gaps(project, project.graphs["arms"], action)
    times = np.array(project.span(action))
    leaves, enters = end_gaps.measure_distances_to_stance(project, action, times)
    assert [g.edge for g in found] == ["begins", "ends"] and leaves[1] > 0.2 < enters[0]
    assert [leaves[0], enters[1]] == pytest.approx([g.metres for g in found])
