"""The line over an action: where it lies along its clip, and what it stresses."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from app.features.timing_editor.axis import Axis
from app.features.timing_editor.line_heard import Waves, find_line_heard, find_line_stresses, lay_line
from app.stage.line_player import RATE
from app.stage.playback_source import ShownPlayback
from metagraph.graph.requests import Line
from metagraph.playback.life.track import Speech, Track
from metagraph.playback.plan import MetaRequest
from metagraph.playback.planner import make_plan


@pytest.fixture(scope="module")
def project(toy):
    return replace(toy.project(), lines={"l1": Line(text="hello over there", duration=1.2)})


@pytest.fixture
def performed(toy, project):
    """A wave from 1 s on, while something is said from 1.3 s on."""
    action = project.action(toy.id(project, "rest wave rt"))
    request = MetaRequest("r", "arms", "gesture", 1.0, action=action.id)
    plan = make_plan(project, 6.0, (request,), idle=False)
    track = Track(speeches=(Speech("s", 1.3, 2.5, "l1", "hello over there"),))
    return action, ShownPlayback(project, replace(plan, track=track), 6.0)


def test_what_is_said_lies_along_the_clip_where_it_is_heard(project, performed):
    action, shown = performed
    cue = next(c for c in shown.plan.layers["arms"].cues if c.action.id == action.id)
    said = find_line_heard(shown, action)
    assert said.speech.line == "l1"
    assert said.offset == pytest.approx(cue.entry + 1.3 - cue.start, abs=0.002)
    assert all(said.offset <= t <= said.offset + 1.3 for t in find_line_stresses(project, said))


def test_an_action_without_words_has_none(toy, project, performed):
    _, shown = performed
    other = project.action(toy.id(project, "rest long"))
    assert find_line_heard(shown, other) is None and find_line_stresses(project, None) == ()
    assert lay_line(project, "gone", other, 0.5) is None


def test_a_line_laid_by_hand_is_stressed_on_the_stroke(toy, project):
    action = project.action(toy.id(project, "rest long"))
    said = lay_line(project, "l1", action, 0.8)
    assert find_line_stresses(project, said)[0] == pytest.approx(0.8, abs=0.002)


def test_the_wave_stands_where_the_sound_is(toy, project):
    said = replace(lay_line(project, "l1", project.action(toy.id(project, "rest long")), 0.8), offset=0.5)
    sound = np.zeros(RATE)
    sound[RATE // 2 :] = 0.25  # loud from half a second on
    axis = Axis(80, 400, 2.0, 0.0, 200.0)
    low, high = Waves().columns(project, said, {"l1": sound}, axis)
    assert len(low) == 400 and high[250] == pytest.approx(1.0, abs=0.01), "as high as the row"
    assert high[150] == pytest.approx(0.0) and high[50] < low[50], "nothing before it begins"
    guessed = Waves().columns(project, said, {}, axis)
    assert np.nanmax(guessed[1][np.isfinite(guessed[1])]) > 0.3, "without a sound its syllables are seen"
