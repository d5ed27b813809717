"""Acts in time: lanes, sides, zoom, and what is under the pointer."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QPoint, QPointF, QRectF, Qt
from PySide6.QtGui import QWheelEvent
from PySide6.QtWidgets import QApplication

from app.project.document import Document
from app.stage.session import StageSession
from app.widgets.act_strip import LEFT, ActStrip, format_clock, place_act
from metagraph.playback.learning.learn import Act

ACTS = {
    "arms": (
        Act(0, 2, "left", "gesture", ("positive",)),
        Act(1.5, 3, "right", "fidget"),
        Act(5, 8, "both", "transition"),
    ),
    "head": (Act(4, 5, "both", "gesture", ("negative",)),),
}


@pytest.fixture
def strip(qtbot):
    session = StageSession(Document())
    widget = ActStrip(session, None)
    qtbot.addWidget(widget)
    widget.resize(LEFT + 8 + 500, 100)
    widget.show_acts(ACTS, 10.0)
    yield widget


def test_seconds_are_told_as_clocks_do():
    assert [format_clock(s) for s in (0, 0.5, 12, 60, 65, 3600, 3725)] == [
        "0 s",
        "0.5 s",
        "12 s",
        "1:00",
        "1:05",
        "1:00:00",
        "1:02:05",
    ]


def test_only_arms_have_sides():
    lane = QRectF(0, 10, 100, 30)
    assert place_act(lane, ACTS["arms"][0], "arms") == (10, 14)
    assert place_act(lane, ACTS["arms"][1], "arms") == (26, 14)
    assert place_act(lane, ACTS["arms"][2], "arms") == (10, 30)
    assert place_act(lane, ACTS["arms"][0], "head") == (10, 30)


def test_what_is_under_the_pointer_is_found_on_its_side(strip):
    lane = strip.lane(0)
    assert strip.act_at(QPointF(strip.x_at(1.7), lane.top() + 3)) == ("arms", ACTS["arms"][0])
    assert strip.act_at(QPointF(strip.x_at(1.7), lane.bottom() - 3)) == ("arms", ACTS["arms"][1])
    assert strip.act_at(QPointF(strip.x_at(6), lane.center().y())) == ("arms", ACTS["arms"][2])
    assert strip.act_at(QPointF(strip.x_at(4.5), strip.lane(1).center().y())) == ("head", ACTS["head"][0])
    assert strip.act_at(QPointF(strip.x_at(9), lane.center().y())) is None


def wheel(strip, x: float, notches: int) -> None:
    at, none = QPointF(x, 40), QPoint()
    event = QWheelEvent(at, strip.mapToGlobal(at), none, QPoint(0, 120 * notches), Qt.MouseButton.NoButton,
                        Qt.KeyboardModifier.NoModifier, Qt.ScrollPhase.NoScrollPhase, False)  # fmt: skip
    QApplication.sendEvent(strip, event)


def test_the_wheel_zooms_where_the_pointer_is_and_never_beyond_the_ends(strip):
    x = strip.x_at(6.0)
    wheel(strip, x, 3)
    assert strip.zoom > 1.5
    assert strip.x_at(6.0) == pytest.approx(x)
    wheel(strip, x, 40)
    assert strip.zoom == 2.5, "no closer than four seconds"
    assert 0 <= strip.first <= 10 - 10 / strip.zoom
    wheel(strip, x, -60)
    assert (strip.zoom, strip.first) == (1.0, 0.0)


def test_dragging_moves_along_once_zoomed(strip, qtbot):
    wheel(strip, strip.x_at(0), 40)
    qtbot.mousePress(strip, Qt.MouseButton.LeftButton, pos=QPoint(300, 40))
    qtbot.mouseMove(strip, QPoint(175, 40))
    qtbot.mouseRelease(strip, Qt.MouseButton.LeftButton, pos=QPoint(175, 40))
    assert strip.first == pytest.approx(125 / strip.each())
    strip.show_acts(ACTS, 20.0)
    assert (strip.first, strip.zoom) == (0.0, 1.0), "another length begins anew"


@pytest.mark.parametrize(
    "acts",
    [
        {},
        {"arms": ()},
        ACTS,
        {"body": tuple(Act(n / 50, n / 50 + 0.01, "both", "fidget") for n in range(3000))},
    ],
)
@pytest.mark.parametrize("size", [(20, 20), (900, 140)])
def test_anything_is_drawn_at_any_size(strip, acts, size):
    strip.resize(*size)
    strip.show_acts(acts)
    assert not strip.grab().isNull()
    assert strip.seconds > 0
