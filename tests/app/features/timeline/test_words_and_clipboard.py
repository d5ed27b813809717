"""Words under their times with the voice's waveform, and requests carried from one performance to another."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import soundfile
from PySide6.QtCore import QPointF, Qt
from PySide6.QtGui import QGuiApplication
from PySide6.QtTest import QTest

from app.widgets.lane_geometry import place_lanes
from metagraph.graph import requests as a

GRID = (
    'File type = "ooTextFile"\nObject class = "TextGrid"\n\n0\n1\n<exists>\n1\n'
    '"IntervalTier"\n"words"\n0\n1\n3\n0\n0.2\n""\n0.2\n0.6\n"so"\n0.6\n1\n"what"\n'
)
CONTROL = Qt.KeyboardModifier.ControlModifier


@pytest.fixture
def spoken(drive, toy, tmp_path):
    soundfile.write(tmp_path / "one.wav", 0.5 * np.sin(np.arange(16000) * 0.2), 16000)
    (tmp_path / "one.TextGrid").write_text(GRID)
    project = replace(
        toy.project(),
        lines={"1": a.Line(audio="one.wav", phones="one.TextGrid", text="so what", duration=1.0)},
    )
    drive.document.load(project, tmp_path / "talk.metagraph.yaml")
    drive.files.opened.emit()
    drive.wait(lambda: drive.performance.skeleton() is not None)
    drive.session.transport.set_playing(False)
    yield drive


def test_words_stand_under_their_times_with_the_voice(spoken):
    view = spoken.timeline.lanes
    assert "words" not in view.sizes.names
    spoken.performance.requests.ask(a.Say(line="1", at=2.0))
    spoken.wait(lambda: len(view.words()) == 2)
    assert view.words() == [
        (pytest.approx(2.2), pytest.approx(2.6), "so"),
        (pytest.approx(2.6), pytest.approx(3.0), "what"),
    ]
    view.resize(view.width(), 200)
    assert "words" not in view.sizes.names, "where there is no room they stand on the lane of speech"
    view.resize(view.width(), 400)
    assert "words" in view.sizes.names and spoken.timeline.voices.of("1").wave is not None
    view.each, view.first = 100.0, 0.0
    lane = place_lanes(view.height(), view.sizes)["words"]
    assert view.tip(QPointF(view.scale().x(2.4), lane.center().y())) == "'so', 2.20 to 2.60 s"
    picture = view.grab().toImage()
    at = lambda seconds: picture.pixelColor(int(view.scale().x(seconds)), int(lane.top() + 6))  # noqa: E731
    assert at(2.5) != at(1.5), "where it is said its waveform is seen"
    assert any(line.what == "'what'" for line in view.snap_lines(()))


def test_requests_are_cut_and_pasted_into_another_performance_with_their_gaps(spoken):
    requests, session = spoken.performance.requests, spoken.session
    spoken.timeline.new()
    for ask in (a.Nod(at=1.0), a.Gesture(at=3.5)):
        requests.ask(ask)
    session.onstage.select_requests(tuple(x.id for x in spoken.performance.asks))
    view = spoken.timeline.lanes
    view.setFocus()
    QTest.keyClick(view, Qt.Key.Key_X, CONTROL)
    assert spoken.performance.asks == () and "requests" in QGuiApplication.clipboard().text()[:60]
    spoken.timeline.new()
    session.transport.seek(10.0)
    QTest.keyClick(view, Qt.Key.Key_V, CONTROL)
    assert [x.at for x in spoken.performance.asks] == [10.0, 12.5]
    assert session.onstage.requests == tuple(x.id for x in spoken.performance.asks)
    spoken.document.undo()
    assert spoken.performance.asks == ()


def test_what_the_clipboard_has_not_is_told(spoken):
    QGuiApplication.clipboard().setText("a shopping list")
    spoken.performance.requests.paste()
    assert len(spoken.told) == 1 and "clipboard" in spoken.told[0]
    spoken.timeline.new()
    action = next(iter(spoken.document.project.actions()))
    spoken.performance.requests.ask(a.Play(action=action.id, at=1.0))
    spoken.performance.requests.to_clipboard(tuple(x.id for x in spoken.performance.asks))
    text = QGuiApplication.clipboard().text()
    spoken.told.clear()
    QGuiApplication.clipboard().setText(
        text.replace(action.name, "juggle").replace(f'"{action.id}"', '"a999"')
    )
    spoken.performance.requests.paste()
    assert len(spoken.told) == 1 and "'juggle'" in spoken.told[0]
    spoken.told.clear()
