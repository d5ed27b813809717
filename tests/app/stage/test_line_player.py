"""Sound follows the playhead; without a device it is silent, says why once, and nothing else suffers."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import soundfile

from app.project.document import Document
from app.project.jobs import Jobs
from app.stage.line_player import RATE, Sound
from app.stage.performance import StagePerformance
from app.stage.session import StageSession
from metagraph.graph import requests as a


class Stream:
    """What the sound library would give: asks for samples when the test says so."""

    def __init__(self, fill: Any) -> None:
        self.fill, self.active, self.latency = fill, False, 0.0

    def start(self) -> None:
        self.active = True

    def stop(self) -> None:
        self.active = False

    def close(self) -> None:
        self.active = False

    def ask(self, frames: int) -> np.ndarray:
        out = np.zeros((frames, 1), np.float32)
        self.fill(out, frames, None, None)
        return out[:, 0]


@pytest.fixture
def stage(qapp, qtbot, toy, tmp_path):
    soundfile.write(tmp_path / "one.wav", 0.5 * np.sin(np.arange(16000) * 0.2), 16000)
    document, jobs = Document(), Jobs()
    session = StageSession(document)
    performance = StagePerformance(document, session, jobs)
    sound = Sound(document, session, performance, jobs)
    session.transport.set_playing(False)
    project = replace(toy.project(), lines={"1": a.Line(audio="one.wav", duration=1.0)})
    document.load(project, tmp_path / "talk.metagraph.yaml")
    performance.requests.ask(a.Say(line="1", at=2.0))
    qtbot.waitUntil(lambda: bool(sound.parts))
    yield sound
    sound.stop()
    jobs.stop()
    document.close_journal()


def connected(sound: Sound) -> Stream:
    sound._stream = Stream(sound.fill)
    return sound._stream


def test_a_line_is_heard_where_it_is_said(stage):
    stream = connected(stage)
    stage.session.transport.seek(1.9)
    assert not stream.active
    stage.session.transport.set_playing(True)
    assert stream.active
    samples = stream.ask(round(0.3 * RATE))
    loud = np.flatnonzero(np.abs(samples) > 0.1) / RATE
    assert loud.min() == pytest.approx(0.1, abs=0.01)


def test_it_goes_on_by_itself_and_is_set_right_only_when_it_is_off(stage):
    stream = connected(stage)
    stage.session.transport.seek(1.0)
    stage.session.transport.set_playing(True)
    stream.ask(1024)
    stage.session.transport.seek(1.0 + 1024 / RATE + 0.03)
    assert stage.place == RATE + 1024, "a little apart is not heard"
    stage.session.transport.seek(5.0)
    assert stage.place == 5 * RATE


@pytest.mark.parametrize("change", ["pause", "slow", "mute", "clip"])
def test_it_falls_silent_with_the_picture(stage, change):
    stream = connected(stage)
    stage.session.transport.set_playing(True)
    stage.session.transport.seek(2.0)
    assert stream.active
    if change == "pause":
        stage.session.transport.set_playing(False)
    elif change == "mute":
        stage.set_muted(True)
    elif change == "slow":
        stage.session.transport.speed = 0.5
        stage.session.transport.seek(2.1)
    else:
        stage.session.transport.show_clip(next(iter(stage.document.project.clips)))
    assert not stream.active


def test_without_a_device_it_says_so_once(stage, monkeypatch):
    import sounddevice

    def nothing(**kwargs):
        raise sounddevice.PortAudioError("no device")

    told = []
    stage.told.connect(told.append)
    monkeypatch.setattr(sounddevice, "OutputStream", nothing)
    stage.session.transport.set_playing(True)
    for seconds in (1.0, 2.0, 3.0):
        stage.session.transport.seek(seconds)
    assert len(told) == 1 and "No sound: no device" in told[0]


def test_lines_that_go_are_not_heard_any_more(stage, qtbot):
    from metagraph.graph.editing import performances as performance_edits

    stage.document.edit("Remove", lambda p: performance_edits.set_line(p, "1", None))
    qtbot.waitUntil(lambda: not stage.parts)


def test_what_is_still_on_its_way_to_the_ear_is_mixed_that_much_earlier(stage):
    stream = connected(stage)
    stream.latency = 0.1
    stage.session.transport.seek(1.0)
    stage.session.transport.set_playing(True)
    assert stage.place == round(1.1 * RATE)
