"""A press for each kind of problem: it is offered, and the problem is gone."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from app.stage.fixes import Fix
from app.stage.remedies import fix_clips
from metagraph.graph import edits
from metagraph.graph.check import check_project
from metagraph.graph.model import Project
from metagraph.graph.problem import Problem
from metagraph.playback.rehearsal import rehearse
from tests.playback.test_rehearsal import changed, lifted

Wrong = Callable[[Project, str], Project]


def timed(**timing: Any) -> Wrong:
    return lambda project, action: edits.update_actions(project, [action], timing=timing)


def set_to(**fields: Any) -> Wrong:
    return lambda project, action: edits.update_actions(project, [action], **fields)


def found_of(project: Project, code: str, action: str | None) -> list[Problem]:
    return [p for p in check_project(project) if p.code == code and p.action == action]


CASES: dict[str, tuple[str, Wrong, str]] = {  # code: the action, what is wrong with it, the button
    "far-start": ("rest long", timed(start=0.5, blend_in=0.05), "Blend 0."),
    "far-end": ("rest long", timed(end=1.9, blend_out=0.05), "Blend 0."),
    "open-loop": ("rest loop", timed(start=0.0, end=1.0, blend_in=0.0), "Blend 0."),
    "blend": ("rest wave rt", timed(blend_in=0.9, blend_out=0.9), "Shorten its blends"),
    "exit": ("rest wave rt", timed(earliest_exit=5.0), "Clear the exit"),
    "trim": ("rest wave rt", timed(end=9.0), "Move inside the clip"),
    "empty": ("rest wave rt", timed(start=0.5, end=0.2), "Move inside the clip"),
    "likelihood": ("rest wave rt", set_to(likelihood=0.0), "Set it to 1"),
    "mask": ("rest wave rt", set_to(joints=("Tail",)), "Move all joints"),
    "no-end": ("rest to up", set_to(end_stance=None), "Leave it out"),
    "hardly-seen": ("rest wave rt", timed(start=0.4, end=0.7, blend_in=0.13, blend_out=0.13), "Repeat it"),
    "short-cycle": (
        "rest wave rt",
        timed(start=0.4, end=0.45, blend_in=0, blend_out=0, repeat=2.0),
        "Play it",
    ),
    "long-repeat": ("rest wave rt", timed(repeat=90.0), "Repeat 60 s"),
    "moment": ("rest wave rt", timed(stroke=3.0), "Clear the stroke"),
}


@pytest.mark.parametrize("code", CASES)
def test_a_press_takes_away_what_is_wrong_with_an_action(toy: Any, code: str) -> None:
    name, spoil, words = CASES[code]
    project = toy.project()
    action = toy.id(project, name)
    if code == "open-loop":  # cut in the middle of a wide swing
        wide = edits.add_clips(project, [("swing.glb", 0, "", toy.clip("swing", 2.0, swing=2.0))])
        project = edits.update_actions(wide, [action], clip=toy.id(wide, "swing"))
    wrong = spoil(project, action)
    (problem,) = found_of(wrong, code, action)
    fix = fix_clips(wrong, check_project(wrong))[problem]
    assert fix.words.startswith(words)
    assert not found_of(fix(wrong), code, action)
    assert fix(edits.remove_actions(wrong, [action])) == edits.remove_actions(wrong, [action])


def test_a_transition_to_its_own_stance_becomes_a_gesture(toy: Any) -> None:
    project = toy.project()
    action = toy.id(project, "rest to up")
    wrong = edits.update_actions(project, [action], end_stance=toy.id(project, "rest"))
    (problem,) = found_of(wrong, "circle", action)
    mended = fix_clips(wrong, check_project(wrong))[problem](wrong)
    assert not found_of(mended, "circle", action)
    assert mended.action(action).kind == "gesture"  # type: ignore[union-attr]


def test_a_gap_too_far_for_a_blend_moves_to_the_stance_that_fits_or_is_left_out(toy: Any) -> None:
    project = toy.project()
    action = toy.id(project, "up beat")
    wrong = edits.to_stance(project, [action], toy.id(project, "rest"))
    (problem,) = found_of(wrong, "far-start", action)
    fix = fix_clips(wrong, check_project(wrong))[problem]
    assert fix.words == "Move to 'up'" and fix.instead is not None and fix.instead.alone
    assert not found_of(fix(wrong), "far-start", action)
    without = fix.instead(wrong)
    assert without.action(action) is None and wrong.action(action).clip in without.clips  # type: ignore[union-attr]


def test_a_stance_without_gestures_that_looks_like_another_is_merged_into_it(toy: Any) -> None:
    project = edits.add_clips(toy.project(), [("twin.glb", 0, "", toy.clip("twin", 2.0, 0.05, swing=0.05))])
    project = edits.add_stance(project, "arms", "twin", [toy.id(project, "twin")])
    twin = toy.id(project, "twin")
    fixes = fix_clips(project, check_project(project))
    words = {fix.words for problem, fix in fixes.items() if problem.stance == twin}
    assert words == {"Merge into 'rest'"}
    (fix,) = {fix.args: fix for problem, fix in fixes.items() if problem.stance == twin}.values()
    assert fix.alone and fix(project).stance(twin) is None
    far = [
        p for p in check_project(project) if p.code == "no-gestures" and p.stance == toy.id(project, "far")
    ]
    assert far and far[0] not in fixes, "another pose is no twin"


def seen_fixes(project: Project, code: str, seconds: float = 4.0) -> dict[Problem, Fix]:
    return {p: fix for p, fix in fix_clips(project, rehearse(project, seconds)).items() if p.code == code}


def test_what_blends_too_fast_as_it_plays_blends_for_longer(toy: Any) -> None:
    project = toy.project()
    wave = toy.id(project, "rest long")
    rough = edits.update_actions(
        project, [wave], timing={"start": 1.0, "end": None, "blend_in": 0.02, "blend_out": 0.02}
    )
    ((problem, fix),) = seen_fixes(rough, "play-fast").items()
    assert problem.action == wave and fix.words.startswith("Blend 0.")
    assert not seen_fixes(fix(rough), "play-fast")


def test_a_figure_in_the_air_can_be_left_out(toy: Any) -> None:
    project = changed(toy.project("body"), lifted(0.6))
    for problem, fix in seen_fixes(project, "play-in-air", 20.0).items():
        assert fix.alone and fix(project).action(problem.action or "") is None


def test_arms_inside_the_body_turn_on_the_guard(toy: Any) -> None:
    project = toy.project()
    action = toy.id(project, "rest long")
    inside = Problem("warning", "play-arm-inside", "", "", "arms", action=action)
    fix = fix_clips(project, [inside])[inside]
    assert not project.touch.guard and fix.words == "Keep hands out" and fix(project).touch.guard
    on = fix(project)
    assert fix_clips(on, [inside])[inside].words == "Leave it out"


def test_a_stance_that_is_never_reached_is_led_to_more_often(toy: Any) -> None:
    project = toy.project()
    far, way = toy.id(project, "far"), toy.id(project, "up to far")
    never = Problem("hint", "play-never", "", "", "arms", far)
    after = fix_clips(project, [never])[never](project)
    assert after.action(way).likelihood == 4 * project.action(way).likelihood  # type: ignore[union-attr]
