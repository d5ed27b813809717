"""Phases are found where a clip was made to have them, and are in order whatever the clip."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from metagraph.graph import edits
from metagraph.graph.model import Project
from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.playback.timing.phase_times import Phases
from metagraph.playback.timing.phases import find_phases


def swung(toy: Any, name: str, angles: list[float], fps: float = 30) -> Clip:
    """A clip whose arms go through angles, one a frame."""
    turns = np.tile(toy.skeleton.rest_rotations, (len(angles), 1, 1))
    for joint, axis in (("LeftUpperArm", (0, 0, 1.0)), ("RightUpperArm", (0, 0, -1.0))):
        turns[:, toy.skeleton.index(joint)] = rotation.from_axis_angle(np.array(axis), np.array(angles))
    return Clip(
        name, toy.skeleton, fps, turns, np.tile(toy.skeleton.rest_translations[:1], (len(angles), 1, 1))
    )


def eased(a: float, b: float, seconds: float, fps: float = 30) -> list[float]:
    x = np.linspace(0, 1, round(seconds * fps) + 1)[1:]
    return list(a + (b - a) * (10 * x**3 - 15 * x**4 + 6 * x**5))


def placed(toy: Any, clip: Clip, **timing: Any) -> tuple[Project, Any]:
    project = edits.add_clips(toy.project(), [("new.glb", 0, "", clip)])
    ident = next(e.id for e in project.clips.values() if e.name == clip.name)
    project = edits.place_clips(project, [ident], "arms", "gesture", toy.id(project, "rest"))
    action = next(a for a in project.actions() if a.clip == ident)
    if timing:
        project = edits.update_actions(project, [action.id], timing=timing)
    return project, project.action(action.id)


def test_preparation_stroke_hold_and_retraction_are_where_they_were_made(toy: Any) -> None:
    """0.4 s up, 0.3 s of rest, a fast beat of 0.3 s, a hold of 0.6 s, 0.5 s back."""
    angles = (
        [0.0] * 4
        + eased(0, 0.8, 0.4)
        + [0.8] * 9
        + eased(0.8, 1.7, 0.3)
        + [1.7] * 18
        + eased(1.7, 0, 0.5)
        + [0.0] * 4
    )
    found = find_phases(*placed(toy, swung(toy, "made", angles)))
    before = 3 / 30
    assert found.ready == pytest.approx(before + 0.7, abs=0.1)
    assert found.stroke == pytest.approx(before + 0.85, abs=0.07)
    assert found.stroke_end == pytest.approx(before + 1.0, abs=0.1)
    assert found.relax == pytest.approx(before + 1.6, abs=0.1)


def test_out_and_back_holds_for_hardly_any_time_where_it_is_farthest(toy: Any) -> None:
    x = np.linspace(0, 1, 46)
    found = find_phases(*placed(toy, swung(toy, "single", list(0.9 * np.sin(np.pi * x) ** 2))))
    assert found.stroke_end <= 0.75 <= found.relax <= found.stroke_end + 0.15
    assert found.ready < found.stroke_end


def test_a_still_clip_and_a_missing_one_have_phases_in_their_middle(toy: Any) -> None:
    project, action = placed(toy, swung(toy, "still", [0.3] * 31))
    assert find_phases(project, action).relax == pytest.approx(0.5)
    gone = edits.add_clips(project, [])
    clips = {i: edits.replace(e, motion=None) for i, e in gone.clips.items()}
    found = find_phases(edits.replace(gone, clips=clips), action)
    assert (found.start, found.ready, found.relax, found.end) == (0.0, 0.5, 0.5, 1.0)


def test_what_the_timing_says_wins_and_stays_in_order(toy: Any) -> None:
    angles = eased(0, 1, 0.5) + [1.0] * 15 + eased(1, 0, 0.5)
    project, action = placed(toy, swung(toy, "own", angles), ready=0.2, stroke=0.3, stroke_end=0.6, relax=0.9)
    found = find_phases(project, action)
    assert (found.ready, found.stroke, found.stroke_end, found.relax) == (0.2, 0.3, 0.6, 0.9)
    project, action = placed(toy, swung(toy, "mixed", angles), stroke=1.2, relax=0.1)
    found = find_phases(project, action)
    assert found.ready <= found.stroke <= found.stroke_end <= found.relax <= found.end


@pytest.mark.nightly
@settings(max_examples=40)
@given(st.lists(st.floats(-2, 2), min_size=2, max_size=60), st.floats(0, 2), st.floats(0, 2))
def test_phases_are_always_in_order(toy: Any, angles: list[float], start: float, end: float) -> None:
    found = find_phases(*placed(toy, swung(toy, "any", angles), start=start, end=end))
    order = (found.start, found.ready, found.stroke, found.stroke_end, found.relax, found.end)
    assert all(a <= b + 1e-9 for a, b in pairwise(order)), order


def test_holds_of_the_sample_gestures_are_found(sample: Project) -> None:
    """Our arm gestures were made with holds of 0.1 to 0.7 s, and the hold comes before the hands go home."""
    gestures = [a for a in sample.actions() if a.kind == "gesture" and a.layer == "arms"]
    holds = [find_phases(sample, a) for a in gestures]
    assert np.mean([p.relax - p.stroke_end > 0.1 for p in holds]) == 1.0
    assert all(0.3 < (p.relax - p.start) / (p.end - p.start) < 0.8 for p in holds)


def test_skipping_leaves_time_to_blend() -> None:
    assert Phases(0.5, 1.5, 1.7, 1.8, 2.0, 3.0).skip(0.1) == 1.25
    assert Phases(0.5, 1.5, 1.7, 1.8, 2.0, 3.0).skip(0.6) == pytest.approx(0.9)
    assert Phases(0.5, 0.6, 0.7, 0.8, 1.0, 3.0).skip(0.1) == 0.5
