"""Other seeds as rows where one talks with others, and while agents play live."""

from __future__ import annotations

from typing import Any

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest

from app.features.timeline.what_if import SEEDS, get_ghost_seed
from app.widgets.lane_geometry import place_lanes
from metagraph.graph.requests import Gesture
from metagraph.live.server import Options
from tests.app.features.timeline.test_cameras import talking  # noqa: F401 - a fixture

pytestmark = [pytest.mark.window, pytest.mark.gl]


def rows(drive: Any) -> dict[int, Any]:
    """Where the rows of seeds lie, in their order."""
    view = drive.timeline.lanes
    found = {get_ghost_seed(n): r for n, r in place_lanes(view.height(), view.sizes).items()}
    return {seed: row for seed, row in found.items() if seed is not None}


def cues(plan: Any) -> list[tuple[str, float]]:
    return [(cue.action.id, cue.start) for of in plan.layers.values() for cue in of.cues]


def test_in_a_conversation_rows_are_of_the_side_on_stage_and_a_click_takes_one_over(talking: Any) -> None:  # noqa: F811
    drive = talking
    what_if, onstage = drive.timeline.what_if, drive.session.onstage
    onstage.set_side(0)
    now = lambda: drive.document.project.conversations[onstage.conversation].seed  # noqa: E731
    seed = now()
    drive.timeline.ghosts.setChecked(True)
    drive.wait(lambda: set(what_if.plans) == {seed + 1, seed + 2, seed + 3}, 60)
    assert list(rows(drive)) == [seed + 1, seed + 2, seed + 3]
    first = {n: cues(plan) for n, plan in what_if.plans.items()}
    assert len({tuple(c) for c in first.values()}) > 1, "seeds differ"
    onstage.set_side(1 - onstage.side)
    drive.wait(lambda: {n: cues(plan) for n, plan in what_if.plans.items()} != first, 60)
    other = {n: cues(plan) for n, plan in what_if.plans.items()}
    row = rows(drive)[seed + 2]
    assert "would play" in what_if.tip(seed + 2, 0.5, 0.5)
    view = drive.timeline.lanes
    QTest.mouseClick(view, Qt.MouseButton.LeftButton, pos=QPoint(300, round(row.center().y())))
    assert now() == seed + 2
    drive.wait(lambda: cues(drive.performance.shown.plan) == other[seed + 2], 60)
    drive.document.undo()
    assert now() == seed
    drive.timeline.ghosts.setChecked(False)


@pytest.mark.nightly
def test_live_rows_follow_what_agents_ask_and_a_click_is_for_the_next_session(toys: Any) -> None:
    what_if, live = toys.timeline.what_if, toys.performance.live
    seed = toys.document.project.settings.seed
    toys.timeline.ghosts.setChecked(True)
    live.begin(Options(port=0, osc=None))
    try:
        toys.wait(lambda: live.stage is not None and len(what_if.plans) == SEEDS)
        live.stage.ask(Gesture(id="wave", stroke=live.stage.now + 2.0))
        toys.wait(
            lambda: any(
                m.request.id.endswith("wave")
                for plan in what_if.plans.values()
                for m in plan.layers["arms"].metas
            ),
            60,
        )
        assert list(rows(toys)) == [seed + 1, seed + 2, seed + 3]
        assert "would have played" in what_if.tip(seed + 1, 0.5, 0.5)
        played = live.stage.session.plan.seed
        row = rows(toys)[seed + 1]
        view = toys.timeline.lanes
        QTest.mouseClick(view, Qt.MouseButton.LeftButton, pos=QPoint(300, round(row.center().y())))
        assert toys.document.project.settings.seed == seed + 1
        assert live.stage.session.plan.seed == played == what_if.seed, "its record is of one seed"
    finally:
        live.end()
    toys.wait(lambda: what_if.seed == seed + 1)
    toys.timeline.ghosts.setChecked(False)
