"""Actions of clips that were cut amid a swing begin and end where it turns."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from metagraph.graph import edits
from metagraph.graph.model import Action, Project
from metagraph.motion import rotation
from metagraph.suggest.jumps.cut_swings import LONGEST, begin_at_turns

SECONDS, TURN = 4.0, 0.15  # of a clip; into it, and before its end, the arm turns


@pytest.fixture
def project(toy: Any) -> Project:
    """A wave with the arm up, whose clip begins and ends amid a swing of 0.6 s."""
    project: Project = toy.project()
    wave = project.action(toy.id(project, "rest wave rt"))
    assert wave is not None
    clip = project.clips[wave.clip].motion
    assert clip is not None and project.skeleton is not None
    frames = round(SECONDS * clip.fps) + 1
    turns = np.repeat(clip.skeleton.rest_rotations[None], frames, 0)
    swing = np.cos(2 * np.pi * (np.arange(frames) / clip.fps - TURN) / 0.6)
    arm = project.skeleton.names.index("RightUpperArm")
    angles = np.zeros((frames, 3))
    angles[:, 2] = np.radians(-60 + 25 * swing)
    turns[:, arm] = rotation.multiply(rotation.exp(angles), turns[:, arm])
    places = np.repeat(clip.translations[:1], frames, 0)
    cut = replace(clip, rotations=turns.astype(np.float32), translations=places, weights=None)
    entry = replace(project.clips[wave.clip], motion=cut, frames=frames)
    project = replace(project, clips={**project.clips, wave.clip: entry})
    return edits.update_actions(project, [wave.id], timing={"start": 0.0, "end": None, "stroke": None})


def wave(project: Project, toy: Any) -> Action:
    action = project.action(toy.id(project, "rest wave rt"))
    assert action is not None
    return action


def test_a_wave_that_is_cut_amid_its_swing_begins_and_ends_where_the_arm_turns(
    project: Project, toy: Any
) -> None:
    after = wave(begin_at_turns(project), toy).timing
    assert after.start == pytest.approx(TURN, abs=0.05)
    assert after.end is not None and 0 < SECONDS - after.end <= LONGEST
    phase = (after.end - TURN) / 0.3  # in half swings
    assert phase == pytest.approx(round(phase), abs=0.15)


def test_what_is_marked_is_still_played_and_other_actions_stay(project: Project, toy: Any) -> None:
    marked = edits.update_actions(project, [wave(project, toy).id], timing={"stroke": 0.05})
    assert wave(begin_at_turns(marked), toy).timing.start == 0.0
    assert begin_at_turns(project, [a.id for a in project.actions()]) is project
    others = [a for a in begin_at_turns(project).actions() if a.id != wave(project, toy).id]
    assert others == [a for a in project.actions() if a.id != wave(project, toy).id]
