"""Blends as long as their way, and actions that begin to repeat, or end it."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from metagraph.graph import edits
from metagraph.graph.check import check_project
from metagraph.graph.checks.end_gaps import LONG, TALL, UNHURRIED, measure_distances_to_stance
from metagraph.graph.model import Project
from metagraph.motion import rotation
from metagraph.suggest.jumps.soft_blends import repeat_actions, soften_blends


@pytest.fixture
def project(toy: Any) -> Project:
    """A wave of the stance "rest" that is cut to 0.4 s amid its swing."""
    project = toy.project()
    timing = {"start": 0.4, "end": 0.8, "blend_in": 0.1, "blend_out": 0.1}
    return edits.update_actions(project, [toy.id(project, "rest wave rt")], timing=timing)


def test_what_begins_to_repeat_does_for_a_while_and_comes_and_goes_slowly(project: Project, toy: Any) -> None:
    wave = toy.id(project, "rest wave rt")
    timing = repeat_actions(project, [wave]).action(wave).timing  # type: ignore[union-attr]
    assert 1.5 <= timing.repeat <= 3.0 and timing.repeat / 0.4 == pytest.approx(round(timing.repeat / 0.4))
    assert timing.blend_in > 0.2 and timing.blend_in + timing.blend_out < 0.8 * timing.repeat


def test_only_gestures_and_fidgets_begin_to_repeat_and_what_does_is_left(project: Project, toy: Any) -> None:
    others = [toy.id(project, "rest to up"), toy.id(project, "rest loop"), "gone"]
    assert repeat_actions(project, others) is project
    wave = toy.id(project, "rest wave rt")
    own = edits.update_actions(project, [wave], timing={"repeat": 7.0})
    assert repeat_actions(own, [wave]) is own


def test_what_plays_once_again_has_blends_that_fit_its_part(project: Project, toy: Any) -> None:
    wave = toy.id(project, "rest wave rt")
    after = repeat_actions(repeat_actions(project, [wave]), [wave], False)
    timing = after.action(wave).timing  # type: ignore[union-attr]
    assert timing.repeat == 0.0 and timing.blend_in + timing.blend_out <= 0.4


def test_blends_of_other_actions_stay(project: Project, toy: Any) -> None:
    wave = toy.id(project, "rest wave rt")
    after = repeat_actions(project, [wave])
    assert [a for a in after.actions() if a.id != wave] == [a for a in project.actions() if a.id != wave]
    assert soften_blends(project, [wave]).action(wave) == project.action(wave)


def test_a_gap_that_shows_is_blended_as_a_movement_of_its_own(project: Project, toy: Any) -> None:
    wave = toy.id(project, "rest wave rt")
    off = edits.update_actions(project, [wave], timing={"start": 0.25, "end": None})
    codes = lambda p: {x.code for x in check_project(p) if x.action == wave}  # noqa: E731
    assert "far-start" in codes(off)
    after = soften_blends(off)
    assert "far-start" not in codes(after)
    assert after.action(wave).timing.blend_in == pytest.approx(LONG)  # type: ignore[union-attr]


@pytest.mark.parametrize(("metres", "longer"), [(0.03, False), (0.1, True), (2.0, False)])
def test_hips_over_another_spot_get_time_to_come_back_unless_that_is_far(
    toy: Any, metres: float, longer: bool
) -> None:
    project = toy.project("body")
    wave = project.action(toy.id(project, "rest wave rt"))
    clip = project.clips[wave.clip].motion
    places = clip.translations.copy()
    places[:, 0, 2] += metres * np.linspace(0, 1, clip.frames)
    moved = replace(project.clips[wave.clip], motion=replace(clip, translations=places))
    project = replace(project, clips={**project.clips, wave.clip: moved})
    before = wave.timing.blend_out
    after = soften_blends(project).action(wave.id).timing.blend_out
    assert (after > before + 0.05) == longer


def test_blends_of_a_short_gesture_leave_something_to_be_seen(project: Project, toy: Any) -> None:
    wave = toy.id(project, "rest wave rt")
    after = soften_blends(edits.update_actions(project, [wave], timing={"start": 0.45, "end": 0.85}))
    timing = after.action(wave).timing  # type: ignore[union-attr]
    assert max(timing.blend_in, timing.blend_out) > 0.1
    assert not [x for x in check_project(after) if x.action == wave and x.code == "hardly-seen"]


def test_a_blend_covers_where_a_clip_swings_while_it_blends(toy: Any) -> None:
    project = toy.project()
    wave = project.action(toy.id(project, "rest wave rt"))
    assert wave is not None
    entry = project.clips[wave.clip]
    assert entry.motion is not None
    first = entry.motion.rotations[:1]
    turned = rotation.multiply(rotation.conjugate(first), entry.motion.rotations)
    wide = rotation.multiply(first, rotation.scale_rotation(turned, np.full(turned.shape[:-1], 4.0)))
    fps = entry.fps / 3
    motion = replace(entry.motion, fps=fps, rotations=wide.astype(np.float32))
    project = replace(project, clips={**project.clips, entry.id: replace(entry, motion=motion, fps=fps)})
    cut = edits.update_actions(project, [wave.id], timing={"start": 0.6, "blend_in": 0.1})
    action = soften_blends(cut).action(wave.id)
    assert action is not None
    at_the_cut, farthest = (
        float(measure_distances_to_stance(cut, action, np.linspace(0.6, 0.6 + reach, 20))[0].max())
        for reach in (0.0, action.timing.blend_in)
    )
    assert farthest > 1.2 * at_the_cut, "it goes on outwards"
    pace = UNHURRIED * cut.skeleton.height / TALL  # type: ignore[union-attr]
    most = 0.45 * (cut.span(action)[1] - 0.6)
    assert action.timing.blend_in == pytest.approx(min(most, farthest / pace), abs=0.05)
