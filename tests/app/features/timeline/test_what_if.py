"""Other seeds as rows under the lanes: planned apart, seen, and taken over by a click that can be undone."""

from __future__ import annotations

from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest

from app.features.timeline.what_if import SEEDS, get_ghost_seed, plan_with
from app.widgets.lane_geometry import place_lanes


def test_other_seeds_are_shown_and_a_click_takes_one_over(toys):
    toys.session.transport.set_playing(False)
    toys.session.transport.show_plan()
    view, what_if = toys.timeline.lanes, toys.timeline.what_if
    before = toys.document.project.settings.seed
    toys.timeline.ghosts.setChecked(True)
    toys.wait(lambda: len(what_if.plans) == SEEDS)
    names = [n for n in place_lanes(view.height(), view.sizes) if get_ghost_seed(n) is not None]
    assert [get_ghost_seed(n) for n in names] == [before + 1, before + 2, before + 3]
    row = place_lanes(view.height(), view.sizes)[names[1]]
    assert row.bottom() <= view.height() + 1, "rows are not cut off"
    seconds = next(c for c in what_if.plans[before + 2].layers["arms"].cues).start + 0.1
    assert "would play" in what_if.tip(before + 2, seconds, 0.5) and "\n" in what_if.tip(
        before + 2, seconds, 0.5
    )
    QTest.mouseClick(view, Qt.MouseButton.LeftButton, pos=QPoint(300, round(row.center().y())))
    assert toys.document.project.settings.seed == before + 2
    wanted = plan_with(toys.document.project, None, toys.performance.length, before + 2, "talking")
    toys.wait(lambda: toys.performance.shown.plan.layers["arms"].cues == wanted.layers["arms"].cues)
    toys.wait(lambda: set(what_if.plans) == {before + 3, before + 4, before + 5})
    toys.document.undo()
    assert toys.document.project.settings.seed == before
    what_if.others()
    toys.wait(lambda: set(what_if.plans) == {before + 4, before + 5, before + 6})
    toys.timeline.ghosts.setChecked(False)
    assert view.sizes.names == type(view.sizes)().names
