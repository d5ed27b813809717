"""Timing handles: where they stand, and what moving them changes."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from metagraph.graph import edits
from metagraph.playback.timing.handles import HANDLES, PHASES, handle_times, move_handle, set_timing_field
from metagraph.playback.timing.speed_curves import measure_action_speed


@pytest.fixture(scope="module")
def project(toy):
    project = toy.project()
    return edits.update_actions(
        project,
        [toy.id(project, "rest wave rt")],
        timing={"start": 0.2, "end": 1.0, "blend_in": 0.1, "blend_out": 0.2},
    )


@pytest.fixture
def wave(toy, project):
    return project.action(toy.id(project, "rest wave rt"))


def test_handles_stand_where_the_timing_says(project, wave):
    found = {name: at for name, at in handle_times(project, wave).items() if name not in PHASES}
    assert found == {
        "start": 0.2,
        "end": 1.0,
        "in": pytest.approx(0.3),
        "out": 0.8,
        "exit": None,
        "stroke": None,
    }


def test_blends_longer_than_the_action_stand_at_its_ends(project, wave):
    long = replace(wave, timing=replace(wave.timing, blend_in=9, blend_out=9))
    at = handle_times(project, long)
    assert (at["in"], at["out"]) == (1.0, 0.2)


@pytest.mark.parametrize(
    ("handle", "seconds", "fields"),
    [
        ("start", -1, {"start": 0.0}),
        ("start", 5, {"start": round(1.0 - 1 / 30, 3)}),
        ("end", -1, {"end": round(0.2 + 1 / 30, 3)}),
        ("end", 1.2, {"end": None}),
        ("end", 99, {"end": None}),
        ("end", 1.1, {"end": 1.1}),
        ("in", 0.0, {"blend_in": 0.0}),
        ("in", 0.35, {"blend_in": 0.15}),
        ("in", 99, {"blend_in": 0.8}),
        ("out", 99, {"blend_out": 0.0}),
        ("out", 0.0, {"blend_out": 0.8}),
        ("exit", 0.0, {"earliest_exit": 0.2}),
        ("exit", 99, {"earliest_exit": 1.0}),
        ("stroke", 0.5, {"stroke": 0.5}),
    ],
)
def test_a_handle_stays_in_its_clip_and_in_order(project, wave, handle, seconds, fields):
    assert move_handle(project, wave, handle, seconds) == fields


def test_moments_that_would_lie_outside_follow_a_dragged_end(project, wave):
    timing = replace(wave.timing, earliest_exit=0.9, stroke=0.3)
    action = replace(wave, timing=timing)
    assert move_handle(project, action, "end", 0.6) == {"end": 0.6, "earliest_exit": 0.6}
    assert move_handle(project, action, "start", 0.5) == {"start": 0.5, "stroke": 0.5}


@settings(max_examples=150, deadline=None)
@given(
    handle=st.sampled_from(HANDLES),
    seconds=st.floats(-1e6, 1e6),
    then=st.sampled_from(HANDLES),
    more=st.floats(-3, 3),
)
def test_whatever_is_dragged_wherever_the_action_stays_playable(toy, project, handle, seconds, then, more):
    ident = toy.id(project, "rest wave rt")
    for name, to in ((handle, seconds), (then, more)):
        project = edits.update_actions(
            project, [ident], timing=move_handle(project, project.action(ident), name, to)
        )
    action = project.action(ident)
    start, end = project.span(action)
    assert 0 <= start < end <= project.clips[action.clip].duration
    t = action.timing
    assert t.blend_in >= 0
    assert t.blend_out >= 0


def test_numbers_typed_for_many_are_kept_within_each_clip(toy, project):
    short, long = toy.id(project, "rest short"), toy.id(project, "rest long")
    after = set_timing_field(project, [short, long], "end", 1.5)
    assert after.action(short).timing.end is None, "the short clip ends before"
    assert after.action(long).timing.end == 1.5
    after = set_timing_field(project, [short, long], "blend_in", 1.0)
    assert after.action(short).timing.blend_in == pytest.approx(0.6)
    assert after.action(long).timing.blend_in == 1.0
    assert set_timing_field(project, ["gone"], "start", 1.0) is project


def test_the_plot_shows_the_hand_the_head_or_the_body(toy, project, wave):
    speeds, words = measure_action_speed(project, wave)
    assert words == "hand speed"
    assert speeds.shape == (project.clips[wave.clip].frames,)
    assert speeds.max() > 0.1
    assert measure_action_speed(project, replace(wave, layer="head"))[1] == "head speed"
    assert measure_action_speed(project, replace(wave, layer="body"))[1] == "body speed"


def test_a_missing_file_has_no_speed(project, wave):
    clips = {**project.clips, wave.clip: replace(project.clips[wave.clip], motion=None)}
    speeds, words = measure_action_speed(replace(project, clips=clips), wave)
    assert isinstance(speeds, np.ndarray)
    assert len(speeds) == 0
    assert words == ""
