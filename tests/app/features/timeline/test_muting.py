"""Layers muted and seen alone on the timeline: what is looked at changes, what is planned and exported does not."""

from __future__ import annotations

import numpy as np
import pytest
from PySide6.QtCore import QPointF, Qt
from PySide6.QtTest import QTest

from app.widgets.lane_geometry import place_lanes
from metagraph.graph import anatomy
from metagraph.graph.model import LAYERS

ALT = Qt.KeyboardModifier.AltModifier


@pytest.fixture
def stage(toys):
    toys.session.transport.show_plan()
    toys.wait(
        lambda: toys.performance.shown.clip is None and bool(toys.performance.shown.plan.layers["arms"].cues)
    )
    yield toys
    toys.performance.mute(())


def title(view, layer):
    return QPointF(20, place_lanes(view.height())[layer].center().y())


@pytest.mark.nightly
def test_a_click_on_a_title_mutes_a_layer_and_another_lets_it_be_seen(stage):
    view, performance = stage.timeline.lanes, stage.performance
    plan = performance.shown.plan
    before = view.grab().toImage()
    for muted in ({"arms"}, {"arms", "head"}, {"head"}, set()):
        layer = next(iter(performance.muted ^ muted))
        QTest.mouseClick(view, Qt.MouseButton.LeftButton, pos=title(view, layer).toPoint())
        assert performance.muted == muted and performance.shown.plan is plan
        assert (view.grab().toImage() == before) is (not muted)


def test_alt_and_a_click_leaves_a_layer_alone_and_again_lets_all_be_seen(stage):
    view, performance = stage.timeline.lanes, stage.performance
    QTest.mouseClick(view, Qt.MouseButton.LeftButton, ALT, title(view, "head").toPoint())
    assert performance.muted == {"body", "arms"}
    QTest.mouseClick(view, Qt.MouseButton.LeftButton, ALT, title(view, "head").toPoint())
    assert performance.muted == set()


def test_a_muted_layer_rests_while_others_play_on(stage):
    performance = stage.performance
    shown = performance.shown
    cue = next(c for c in shown.plan.layers["arms"].cues if c.action.kind == "gesture")
    seconds = (cue.start + cue.end) / 2
    parts = np.array(anatomy.project_parts(shown.project))
    playing = shown.pose(seconds)
    performance.mute({"arms"})
    resting = performance.shown.pose(seconds)
    arms = np.abs(playing.rotations - resting.rotations)[parts == "arms"].max()
    assert arms > 1e-3
    assert [len(of.cues) for of in performance.shown.moving.layers.values()][LAYERS.index("arms")] == 0
    performance.mute(())
    assert np.array_equal(performance.shown.pose(seconds).rotations, playing.rotations)


def test_the_title_s_menu_and_tip_say_what_a_click_does(stage):
    view = stage.timeline.lanes
    menu = view.titles.menu("arms")
    assert [a.text().split("\t")[0] for a in menu.actions() if not a.isSeparator()] == [
        "Mute",
        "Solo",
        "Lock",
        "Compact",
        "Normal",
        "Tall",
        "Reset the height of all lanes",
        "Unmute all layers",
    ]
    menu.actions()[1].trigger()
    assert stage.performance.muted == {"body", "head"}
    assert "is muted" in view.tip(title(view, "body")) and "is visible" in view.tip(title(view, "arms"))
    view.titles.menu("arms").actions()[-1].trigger()
    assert stage.performance.muted == set()
