"""What moves when: joints that turn, and those that do not."""

from __future__ import annotations

import numpy as np
import pytest

from metagraph.motion.dope import STILL, make_dope_sheet


def test_only_what_turns_has_a_line(toy):
    clip = toy.clip("wave", 2.0, swing=1.0)
    sheet = make_dope_sheet(clip)
    assert 0 < len(sheet.names) < len(clip.skeleton)
    assert sheet.degrees.shape == sheet.parts.shape == (clip.frames, len(sheet.names))
    assert (sheet.degrees.max(0) >= STILL).all() and sheet.parts.min() >= 0 and sheet.parts.max() <= 1
    assert make_dope_sheet(toy.clip("still", 2.0, swing=0.0)).names == ()


def test_how_fast_is_told_in_degrees_a_second(toy):
    from dataclasses import replace

    from metagraph.motion import rotation

    clip = toy.clip("turn", 2.0)
    rotations = np.array(clip.rotations)
    turns = np.radians(90) * np.arange(clip.frames) / clip.fps
    rotations[:, 1] = rotation.from_axis_angle(np.array([[0.0, 1, 0]]), turns)
    sheet = make_dope_sheet(replace(clip, rotations=rotations))
    place = sheet.names.index(clip.skeleton.names[1])
    assert sheet.degrees[:, place] == pytest.approx(np.full(clip.frames, 90.0), abs=0.1)


def test_groups_are_as_fast_as_the_fastest_of_them_and_others_are_left_out(toy):
    clip = toy.clip("wave", 2.0, swing=1.0)
    every = make_dope_sheet(clip)
    sheet = make_dope_sheet(clip, dict.fromkeys(every.names, "all"))
    assert sheet.names == ("all",)
    assert sheet.degrees[:, 0] == pytest.approx(every.degrees.max(1))
    assert make_dope_sheet(clip, {}).names == ()


def test_a_clip_of_one_frame_moves_nothing(toy):
    assert make_dope_sheet(toy.clip("one", 2.0).trimmed(0, 1)).names == ()
